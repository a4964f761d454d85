//! Every spectral line: frequency, height and phase, of every spectrum the paper shows.

use simgap_mold::TwoDof;
use simgap_signal::peaks::{Peak, PeakOptions, find_peaks};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};
use simgap_tables::PrintedValue;

use super::context::EXCITATIONS_HZ;
use super::spectra::{self, Found, LINE_TOLERANCE_HZ, near};
use super::two_masses::{RATE_HZ, models, motion_of};
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, significant};

/// Smallest line counted in the unknown force, N: the records of it are rebuilt without noise, and
/// below this there is only the third order of the timing error.
const LEAST_UNKNOWN_FORCE_N: f64 = 10.0;

/// Smallest line counted in the motion of the two-mass model, m: rounding stays far below.
const LEAST_MOTION_M: f64 = 1e-8;

/// Precision to which the paper names the lines of its 2-DOF model, Hz: printed without decimals.
const PRINTED_TO_HZ: f64 = 0.5;

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let found = spectra::find(context)?;
    let [printed, restored] = [0, 1].map(|set| two_mass_lines(context, set));
    let (printed, restored) = (printed?, restored?);
    let blocks = vec![
        Block::Text(format!(
            "Frequency, height (half peak to peak) and phase (of the cosine at the first sample) of every line of \
             every spectrum that the paper shows, from the rebuilt records and the simulated models. They are held as snapshots: a \
             change of any of them shows. Lines lie between the bins of the spectrum ([method](../theory/README.md)). \
             Tolerance of Table 2: a tenth of a bin, {} Hz; of Fig. 15: {} Hz, half a unit of the last digit printed.",
            significant(LINE_TOLERANCE_HZ, 2),
            significant(PRINTED_TO_HZ, 1),
        )),
        Block::Table(table_2(
            "Table 2, pressure: every line",
            "N",
            1.0,
            &found,
            |item| (&item.pressure, item.row.pressure.lines_hz().to_vec()),
        )),
        Block::Table(table_2(
            "Table 2, displacement: every line",
            "µm",
            1e6,
            &found,
            |item| (&item.displacement, item.displacement_lines()),
        )),
        Block::Table(unknown_force(context)?),
        Block::Table(Table::comparisons(
            "Fig. 15 and section 3.2, stiffnesses as printed: lines of m₁ from rest",
            &against_stated(context, &printed),
        )),
        Block::Table(Table::comparisons(
            "Fig. 15 and section 3.2, restored stiffnesses: lines of m₁ from rest",
            &against_stated(context, &restored),
        )),
        Block::Table(motion_table(
            "Lines of m₁, stiffnesses as printed",
            &printed,
        )),
        Block::Table(motion_table("Lines of m₁, restored stiffnesses", &restored)),
    ];
    Ok(Page {
        stem: "peaks",
        title: "Every spectral line".to_owned(),
        summary: "frequency, height and phase of every line of Table 2, Fig. 6, 12 and 15"
            .to_owned(),
        blocks,
    })
}

/// Height in a unit and phase in degrees, as cells.
fn size_cells(peak: &Peak, scale: f64) -> [Cell; 2] {
    let degrees = peak.phase_rad.to_degrees();
    // Two decimals; −180 is 180.
    let shown = (100.0 * degrees).round() / 100.0 + 0.0;
    let shown = if shown <= -180.0 { 180.0 } else { shown };
    [
        Cell::Number(scale * peak.amplitude, 5),
        Cell::text(format!("{shown:.2}")),
    ]
}

/// Every line of one channel: those printed beside those found, then the further ones.
fn table_2<'a>(
    title: &str,
    unit: &str,
    scale: f64,
    found: &'a [Found<'a>],
    channel: impl Fn(&'a Found<'a>) -> (&'a Vec<Peak>, Vec<f64>),
) -> Table {
    let height = format!("height [{unit}]");
    let mut table = Table::new(
        title,
        &[
            "f [Hz]",
            "printed [Hz]",
            "found [Hz]",
            "verdict",
            &height,
            "phase [°]",
        ],
    );
    for item in found {
        let excitation = || Cell::text(item.row.excitation.printed());
        let (peaks, printed) = channel(item);
        for line in &printed {
            let mut row = vec![excitation(), Cell::Number(*line, 3)];
            match peaks.iter().find(|peak| near(peak, *line)) {
                Some(peak) => {
                    row.extend([Cell::Number(peak.freq_hz, 6), Cell::text("reproduced")]);
                    row.extend(size_cells(peak, scale));
                }
                None => row.extend(["none", "not reproducible", "none", "none"].map(Cell::text)),
            }
            table.rows.push(row);
        }
        let is_further = |peak: &&Peak| !printed.iter().any(|line| near(peak, *line));
        for peak in peaks.iter().filter(is_further) {
            let mut row = vec![
                excitation(),
                Cell::text("none"),
                Cell::Number(peak.freq_hz, 6),
            ];
            row.push(Cell::text("further line"));
            row.extend(size_cells(peak, scale));
            table.rows.push(row);
        }
    }
    table
}

/// Lines of the unknown force of the rebuilt records, Fig. 6.
fn unknown_force(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Fig. 6, unknown force of the rebuilt records: every line",
        &["f [Hz]", "found [Hz]", "height [N]", "phase [°]"],
    );
    let rate = context.sample_rate_hz();
    let options = PeakOptions {
        min_amplitude: LEAST_UNKNOWN_FORCE_N,
        ..PeakOptions::default()
    };
    for freq in EXCITATIONS_HZ {
        let rebuilt = context.record(freq, rate, context.timing_reading())?;
        let force = context.unknown_force(&rebuilt)?;
        let settled = &force.unknown_force[context.first_second()..];
        let found = spectrum(settled, rate, Window::Hann, Trend::Mean)?;
        for peak in find_peaks(&found, &options)? {
            let mut row = vec![Cell::Number(freq, 1), Cell::Number(peak.freq_hz, 6)];
            row.extend(size_cells(&peak, 1.0));
            table.rows.push(row);
        }
    }
    Ok(table)
}

/// Lines of the motion of m₁ at one excitation, from rest.
pub(crate) struct MotionLines {
    pub(crate) excitation_hz: f64,
    pub(crate) peaks: Vec<Peak>,
}

/// Lines of m₁ for all six rows; set 0 has the printed stiffnesses, set 1 the restored ones.
pub(crate) fn two_mass_lines(
    context: &Context,
    set: usize,
) -> Result<Vec<MotionLines>, ReproduceError> {
    let of = |freq: f64| {
        Ok(MotionLines {
            excitation_hz: freq,
            peaks: lines_of_motion(context, &models(context, freq)?[set], freq)?,
        })
    };
    EXCITATIONS_HZ.into_iter().map(of).collect()
}

/// Lines of the motion of m₁ from rest, driven by a sine.
pub(crate) fn lines_of_motion(
    context: &Context,
    model: &TwoDof,
    freq_hz: f64,
) -> Result<Vec<Peak>, ReproduceError> {
    let motion = motion_of(context, model, freq_hz)?;
    let found = spectrum(&motion.mold, RATE_HZ, Window::BlackmanHarris, Trend::Mean)?;
    let options = PeakOptions {
        min_amplitude: LEAST_MOTION_M,
        ..PeakOptions::default()
    };
    Ok(find_peaks(&found, &options)?)
}

impl MotionLines {
    /// The two strongest lines beside the excitation, lower and upper, Hz.
    pub(crate) fn pair(&self) -> [f64; 2] {
        let beside = |peak: &&Peak| (peak.freq_hz - self.excitation_hz).abs() > 1.0;
        let mut found: Vec<&Peak> = self.peaks.iter().filter(beside).collect();
        found.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        let at = |i: usize| found.get(i).map_or(f64::NAN, |peak| peak.freq_hz);
        [at(0).min(at(1)), at(0).max(at(1))]
    }
}

/// The lines that section 3.2 states beside those of the simulated model.
pub(crate) fn against_stated(context: &Context, found: &[MotionLines]) -> Vec<Comparison> {
    let mut rows = Vec::new();
    for (stated, found) in context.stated.lines.iter().zip(found) {
        let mut row = |name: &str, printed: &PrintedValue, ours: f64| {
            rows.push(Comparison {
                item: format!("{name} line at {} Hz", found.excitation_hz),
                unit: "Hz",
                printed: printed.printed().to_owned(),
                published: printed.si(),
                ours: super::round_to(ours, 6),
                tolerance: PRINTED_TO_HZ,
            });
        };
        let [lower, upper] = found.pair();
        row("lower", &stated.lower, lower);
        row("upper", &stated.upper, upper);
    }
    rows
}

fn motion_table(title: &str, found: &[MotionLines]) -> Table {
    let mut table = Table::new(title, &["f [Hz]", "found [Hz]", "height [µm]", "phase [°]"]);
    for item in found {
        for peak in &item.peaks {
            let mut row = vec![
                Cell::Number(item.excitation_hz, 1),
                Cell::Number(peak.freq_hz, 6),
            ];
            row.extend(size_cells(peak, 1e6));
            table.rows.push(row);
        }
    }
    table
}
