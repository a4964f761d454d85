//! Table 2 and Fig. 12: lines of the pressure and of the displacement.

use simgap_mold::{
    DISPLACEMENT_CHANNEL, Derivative, FORCE_CHANNEL, HARMONIC_SHARE, RebuildPlan, RebuiltRecord,
    rebuild,
};
use simgap_report::chart::{LineChart, Mark, Role, Scale, Series};
use simgap_signal::peaks::{Peak, PeakOptions, find_peaks};
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

/// Length of the records, s.
pub(crate) const DURATION_S: f64 = 20.0;

/// Frequencies of lines may be off by this, Hz: a tenth of a bin, far above what noise does to a line
/// (1e-5 Hz for the weakest one counted) and far below the distance of two lines.
pub(crate) const LINE_TOLERANCE_HZ: f64 = 0.1 / DURATION_S;

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
        duration_s: DURATION_S,
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

/// The lines found.
fn lines(
    rebuilt: &RebuiltRecord,
    channel: &str,
    min_amplitude: f64,
) -> Result<Vec<Peak>, ReproduceError> {
    let options = PeakOptions {
        min_amplitude,
        ..PeakOptions::default()
    };
    Ok(find_peaks(&channel_spectrum(rebuilt, channel)?, &options)?)
}

/// How many printed lines were found within the tolerance.
fn found_of(printed: &[f64], found: &[Peak]) -> usize {
    let is_found = |line: &&f64| found.iter().any(|peak| near(peak, **line));
    printed.iter().filter(is_found).count()
}

/// Whether a peak is a line.
pub(crate) fn near(peak: &Peak, line_hz: f64) -> bool {
    (peak.freq_hz - line_hz).abs() <= LINE_TOLERANCE_HZ
}

/// What was found in the record of one row.
pub(crate) struct Found<'a> {
    pub(crate) row: &'a LineRow,
    pub(crate) pressure: Vec<Peak>,
    pub(crate) displacement: Vec<Peak>,
}

impl Found<'_> {
    /// The lines printed for the displacement, the high one included, Hz.
    pub(crate) fn displacement_lines(&self) -> Vec<f64> {
        let high = self.row.displacement_high.as_ref();
        let printed = self.row.displacement.lines_hz().iter().copied();
        printed
            .chain(high.map(simgap_tables::PrintedValue::si))
            .collect()
    }
}

pub(crate) fn find(context: &Context) -> Result<Vec<Found<'_>>, ReproduceError> {
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
            .all(|peak| printed.iter().any(|line| near(peak, *line)));
        displacement && pressure && found.row.pressure_high.is_none()
    }))
}

fn high_line(found: &Found<'_>) -> Option<Comparison> {
    let line = found.row.displacement_high.as_ref()?;
    let off = |peak: &Peak| (peak.freq_hz - line.si()).abs();
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
        ours: super::round_to(nearest?.freq_hz, 5),
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
    for item in found {
        let Found {
            row,
            pressure,
            displacement,
        } = item;
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
                .filter(|peak| !expected.iter().any(|line| near(peak, *line)))
                .map(|peak| significant(peak.freq_hz, 3))
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
        Block::Text(format!(
            "The harmonics are in the rebuilt records because Table 2 lists them (their height, {} % of \
             the fundamental over n², is assumed): that they are found says that the detection works. \
             The line at 50 − f was **not** put in as a line. It appears because every other sample \
             is taken late by the one τ of [Table 4](table4.md), and it appears in the displacement \
             only, as in Table 2, because the displacement only is sampled so. Had the clock common to \
             both channels alternated, the pressure would show the line as well: it does not.\n\n\
             At the printed step of {} s, {} Hz is the Nyquist frequency, and 50 − f is the image of f \
             about half the sample rate. The further lines are the images 50 − n f of the harmonics; \
             the paper prints 50 − f only, so that its harmonics are lower than assumed here, or its list is \
             not complete. Tolerance: a tenth of a bin of {} s, {} Hz; the paper prints its lines to 1 Hz. A white noise of \
             {} µm on the displacement is assumed. Frequency, height and phase of every line stand on [their own page](peaks.md).",
            significant(1e2 * HARMONIC_SHARE, 2),
            context.stated.time_step.printed(),
            significant(0.5 * context.sample_rate_hz(), 2),
            significant(DURATION_S, 2),
            significant(LINE_TOLERANCE_HZ, 2),
            significant(1e6 * NOISE_M, 2),
        )),
        Block::Table(Table::comparisons(
            "Table 2, high lines of the displacement",
            &high,
        )),
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
            "Fig. 12 in kind: spectrum of the displacement at 1 Hz, rebuilt, with its line at 50 − f"
                .to_owned(),
            chart(DISPLACEMENT_CHANNEL, "amplitude [mm]", 1e3, 1e-10)?,
        ),
        Block::Figure(
            "fig12-force",
            format!(
                "Fig. 12 in kind: spectrum of the pressure force at 1 Hz, rebuilt: harmonics of the excitation and no \
                 further line (what is below {LEAST_FORCE_LINE_N} N is drawn there)"
            ),
            chart(FORCE_CHANNEL, "amplitude [N]", 1.0, LEAST_FORCE_LINE_N)?,
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
