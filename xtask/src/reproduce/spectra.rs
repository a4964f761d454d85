//! Table 2 and Fig. 12: lines of the pressure and of the displacement.

use simgap_mold::{
    DISPLACEMENT_CHANNEL, Derivative, FORCE_CHANNEL, HARMONIC_SHARE, RebuildPlan, RebuiltRecord,
    rebuild,
};
use simgap_report::chart::{LineChart, Mark, Role, Scale, Series};
use simgap_signal::peaks::{PeakOptions, find_peaks};
use simgap_signal::spectrum::{Spectrum, spectrum};
use simgap_signal::{Trend, Window};
use simgap_tables::LineRow;

use super::context::{mean, samples};
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, Verdict, significant};

/// Noise put on the rebuilt displacement, m: a tenth of a micrometre, so that the detection of
/// lines has a floor to work against. The paper prints none.
const NOISE_M: f64 = 1e-7;

/// Smallest line counted in the pressure force, N: the force is rebuilt without noise, and below
/// this there is only rounding.
const LEAST_FORCE_LINE_N: f64 = 1e-3;

/// Frequencies of lines may be off by this, Hz: a tenth of a bin of 20 s.
const LINE_TOLERANCE_HZ: f64 = 0.005;

/// The record of one row of Table 2, with the one timing error of Table 4. Table 3 has no row for
/// 7 Hz: there the mean a₀ and no stroke are assumed.
fn record(context: &Context, row: &LineRow) -> Result<RebuiltRecord, ReproduceError> {
    let freq = row.excitation.si();
    let force = context
        .table3
        .rows
        .iter()
        .find(|force| force.excitation.si() == freq);
    let centres: Vec<f64> = context
        .table3
        .rows
        .iter()
        .map(|row| row.centre.si())
        .collect();
    let plan = RebuildPlan {
        excitation_freq_hz: freq,
        amplitude: context.amplitude(),
        harmonic_share: HARMONIC_SHARE,
        lines_hz: row.displacement.lines_hz().to_vec(),
        centre_force: force.map_or_else(|| mean(&centres), |force| force.centre.si()),
        stroke_force: force.map_or(0.0, |force| force.peak_to_peak.si()),
        derivative: Derivative::Park {
            time_step_s: context.time_step_s(),
        },
        sample_rate_hz: context.sample_rate_hz(),
        duration_s: 20.0,
        reading: context.timing_reading(),
        noise_rms: NOISE_M,
        seed: 2,
    };
    Ok(rebuild(&context.mold, plan)?)
}

/// Amplitude spectrum of a channel, Hann window.
pub(crate) fn channel_spectrum(
    rebuilt: &RebuiltRecord,
    channel: &str,
) -> Result<Spectrum, ReproduceError> {
    let values = samples(rebuilt, channel)?;
    let rate = rebuilt.record.sample_rate_hz();
    Ok(spectrum(&values, rate, Window::Hann, Trend::Mean)?)
}

/// Frequencies of the lines found, Hz.
fn lines(
    rebuilt: &RebuiltRecord,
    channel: &str,
    min_amplitude: f64,
) -> Result<Vec<f64>, ReproduceError> {
    let options = PeakOptions {
        min_amplitude,
        ..PeakOptions::default()
    };
    let peaks = find_peaks(&channel_spectrum(rebuilt, channel)?, &options)?;
    Ok(peaks.iter().map(|peak| peak.freq_hz).collect())
}

/// How many printed lines were found within the tolerance.
fn found_of(printed: &[f64], found: &[f64]) -> usize {
    let near = |line: &f64| {
        found
            .iter()
            .any(|freq| (freq - line).abs() <= LINE_TOLERANCE_HZ)
    };
    printed.iter().filter(|line| near(line)).count()
}

/// What was found in the record of one row.
struct Found<'a> {
    row: &'a LineRow,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
}

fn find(context: &Context) -> Result<Vec<Found<'_>>, ReproduceError> {
    let of = |row| {
        let rebuilt = record(context, row)?;
        Ok(Found {
            row,
            pressure: lines(&rebuilt, FORCE_CHANNEL, LEAST_FORCE_LINE_N)?,
            displacement: lines(&rebuilt, DISPLACEMENT_CHANNEL, 0.0)?,
        })
    };
    context.table2.rows.iter().map(of).collect()
}

/// Whether each displacement has the high line printed, and no pressure has a line that is not
/// printed.
pub(crate) fn high_lines_as_printed(context: &Context) -> Result<bool, ReproduceError> {
    Ok(find(context)?.iter().all(|found| {
        let displacement =
            high_line(found).is_some_and(|line| line.verdict() == Verdict::Reproduced);
        let printed = found.row.pressure.lines_hz();
        let pressure = found
            .pressure
            .iter()
            .all(|line| found_of(&[*line], printed) == 1);
        displacement && pressure && found.row.pressure_high.is_none()
    }))
}

fn high_line(found: &Found<'_>) -> Option<Comparison> {
    let line = found.row.displacement_high.as_ref()?;
    let off = |freq: &f64| (freq - line.si()).abs();
    let nearest = found
        .displacement
        .iter()
        .min_by(|a, b| off(a).total_cmp(&off(b)));
    Some(Comparison {
        item: format!(
            "displacement, high line at {} Hz",
            found.row.excitation.printed()
        ),
        unit: "Hz",
        printed: line.printed().to_owned(),
        published: line.si(),
        ours: super::round_to(*nearest?, 5),
        tolerance: LINE_TOLERANCE_HZ,
    })
}

fn line_table(found: &[Found<'_>]) -> Table {
    let mut table = Table::new(
        "Table 2, lines found in the rebuilt records",
        &[
            "f [Hz]",
            "channel",
            "published [Hz]",
            "printed lines found",
            "further lines found [Hz]",
        ],
    );
    for Found {
        row,
        pressure,
        displacement,
    } in found
    {
        for (channel, printed, found, high) in [
            ("pressure", &row.pressure, pressure, None),
            (
                "displacement",
                &row.displacement,
                displacement,
                row.displacement_high.as_ref(),
            ),
        ] {
            let mut expected = printed.lines_hz().to_vec();
            expected.extend(high.map(simgap_tables::PrintedValue::si));
            let further: Vec<String> = found
                .iter()
                .filter(|freq| found_of(&[**freq], &expected) == 0)
                .map(|freq| significant(*freq, 3))
                .collect();
            let published = match high {
                Some(line) => format!("{} and {}", printed.printed(), line.printed()),
                None => printed.printed().to_owned(),
            };
            table.rows.push(vec![
                Cell::text(row.excitation.printed()),
                Cell::text(channel),
                Cell::text(published),
                Cell::text(format!(
                    "{} of {}",
                    found_of(&expected, found),
                    expected.len()
                )),
                Cell::text(if further.is_empty() {
                    "none".to_owned()
                } else {
                    further.join(" ")
                }),
            ]);
        }
    }
    table
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let found = find(context)?;
    let high: Vec<Comparison> = found.iter().filter_map(high_line).collect();
    let mut blocks = vec![
        Block::Text(
            "The harmonics are in the rebuilt records because Table 2 lists them (their height, 1 % of \
             the fundamental over n², is assumed): that they are found says that the detection works. \
             The line at 50 − f was **not** put in as a line. It appears because every other sample \
             is taken late by the one τ of [Table 4](table4.md), and it appears in the displacement \
             only, as in Table 2, because the displacement only is sampled so. Had the clock common to \
             both channels alternated, the pressure would show the line as well: it does not.\n\n\
             At the printed step of 0.01 s, 50 Hz is the Nyquist frequency, and 50 − f is the image of f \
             about half the sample rate. The further lines are the images 50 − n f of the harmonics; \
             the paper prints 50 − f only, so that its harmonics are lower than assumed here, or its list is \
             not complete. Tolerance: a tenth of a bin of 20 s, 0.005 Hz. A white noise of 0.1 µm on the \
             displacement is assumed."
                .to_owned(),
        ),
        Block::Table(Table::comparisons("Table 2, high lines of the displacement", &high)),
        Block::Table(line_table(&found)),
    ];
    if let Some(row) = context.table2.rows.first() {
        blocks.extend(charts(&record(context, row)?)?);
    }
    Ok(Page {
        stem: "table2",
        title: "Table 2: spectral lines".to_owned(),
        summary: "lines of pressure and displacement for 1 to 7 Hz; 50 − f from one timing error"
            .to_owned(),
        blocks,
    })
}

fn charts(rebuilt: &RebuiltRecord) -> Result<Vec<Block>, ReproduceError> {
    let chart = |channel: &str, y_label: &str, scale: f64, floor: f64| {
        let spectrum = channel_spectrum(rebuilt, channel)?;
        // Rounding noise below the floor differs between machines and says nothing.
        let amplitude: Vec<f64> = spectrum
            .amplitude
            .iter()
            .map(|a| scale * a.max(floor))
            .collect();
        let mut chart = LineChart::new(
            format!("Spectrum of {channel} at 1 Hz"),
            "frequency [Hz]",
            y_label,
        )
        .with(Series::new(
            "rebuilt record",
            Role::Measured,
            spectrum.freq_hz,
            amplitude,
        ));
        chart.y_scale = Scale::Log;
        Ok::<_, ReproduceError>(chart)
    };
    Ok(vec![
        Block::Figure(
            "fig12-displacement",
            "Fig. 12 in kind: spectrum of the displacement at 1 Hz, rebuilt, with the line at 49 Hz"
                .to_owned(),
            chart(DISPLACEMENT_CHANNEL, "amplitude [mm]", 1e3, 1e-10)?,
        ),
        Block::Figure(
            "fig12-force",
            "Fig. 12 in kind: spectrum of the pressure force at 1 Hz, rebuilt. No line at 2.499 Hz \
             and none at 49 Hz (what is below 1e-3 N is drawn there)"
                .to_owned(),
            chart(FORCE_CHANNEL, "amplitude [N]", 1.0, 1e-3)?,
        ),
    ])
}

/// Ends of an ordinate that holds the values, symmetric about zero, at 1, 2 or 5 times a power of
/// ten, so that the chart has ticks to label.
pub(crate) fn symmetric_range(values: &[f64]) -> [f64; 2] {
    let largest = values
        .iter()
        .fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let power = 10_f64.powf(largest.log10().floor());
    let end = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|end| *end >= largest)
        .unwrap_or(largest);
    [-end, end]
}

/// A line spectrum for a chart.
pub(crate) fn stems(
    name: &'static str,
    role: Role,
    freq_hz: Vec<f64>,
    amplitude: Vec<f64>,
) -> Series<'static> {
    Series::new(name, role, freq_hz, amplitude).with_mark(Mark::Stems)
}
