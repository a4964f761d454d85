//! The sweep from 1 to 7 Hz as one record, with its spectrogram: Fig. 3 and 11.

use simgap_alpha::unknown_force;
use simgap_integrate::inverse::Differentiator;
use simgap_mold::{
    DISPLACEMENT_CHANNEL, FORCE_CHANNEL, SweepRecord, published_sweep, rebuild_sweep,
};
use simgap_report::chart::{LineChart, Mark, Role, Series};
use simgap_signal::metrics::nrmse;
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};

use super::simulated::driven_response;
use super::{Block, Cell, Context, Page, ReproduceError, Table, significant};

/// Length of a segment of the spectrogram and distance of two, s.
const SEGMENT_S: [f64; 2] = [4.0, 0.5];

/// Levels of the spectrogram, m.
const LEVELS: [(f64, Role); 3] = [
    (3e-6, Role::Recalibrated),
    (3e-5, Role::Nominal),
    (3e-4, Role::Corrected),
];

/// The sweep and what the model makes of it.
pub(crate) struct Sweep {
    rebuilt: SweepRecord,
    displacement: Vec<f64>,
    without: Vec<f64>,
    with: Vec<f64>,
}

impl Sweep {
    pub(crate) fn new(context: &Context) -> Result<Self, ReproduceError> {
        let plan = published_sweep(context.sample_rate_hz(), context.timing.value)?;
        let rebuilt = rebuild_sweep(&context.mold, &plan)?;
        let values = |channel: &str| -> Result<Vec<f64>, ReproduceError> {
            Ok(rebuilt.record.require(channel)?.values.clone())
        };
        let (displacement, pressure) = (values(DISPLACEMENT_CHANNEL)?, values(FORCE_CHANNEL)?);
        let step = context.time_step_s();
        let lacking = unknown_force(
            &context.plant,
            &displacement,
            &pressure,
            step,
            Differentiator::Park,
        )?;
        let forces = pressure.iter().zip(&lacking.unknown_force);
        let total: Vec<f64> = forces.map(|(force, lacking)| force + lacking).collect();
        Ok(Self {
            without: driven_response(&context.mold, &pressure, &displacement, step)?,
            with: driven_response(&context.mold, &total, &displacement, step)?,
            displacement,
            rebuilt,
        })
    }

    /// Error without and with the unknown force over the standard deviation, once the start has died away.
    pub(crate) fn errors(&self, context: &Context) -> Result<[f64; 2], ReproduceError> {
        let settled = 5 * context.first_second()..;
        let measured = &self.displacement[settled.clone()];
        Ok([
            nrmse(measured, &self.without[settled.clone()])?,
            nrmse(measured, &self.with[settled])?,
        ])
    }

    /// Segment by segment: time of its middle (s), frequency of the sweep there (Hz), and the amplitude spectrum.
    fn segments(
        &self,
        context: &Context,
    ) -> Result<Vec<(f64, f64, simgap_signal::spectrum::Spectrum)>, ReproduceError> {
        let rate = context.sample_rate_hz();
        let [length, hop] = SEGMENT_S.map(|seconds| (seconds * rate) as usize);
        let starts = (0..self.displacement.len().saturating_sub(length) + 1).step_by(hop);
        starts
            .map(|start| {
                let part = &self.displacement[start..start + length];
                let middle = start + length / 2;
                let found = spectrum(part, rate, Window::Hann, Trend::Mean)?;
                Ok((middle as f64 / rate, self.rebuilt.freq_hz[middle], found))
            })
            .collect()
    }
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let sweep = Sweep::new(context)?;
    let [without, with] = sweep.errors(context)?;
    let segments = sweep.segments(context)?;
    let blocks = vec![
        Block::Text(format!(
            "Section 3.1 has one record of a sweep from {} to {} Hz with {} mm; the other pages take it excitation by excitation. Here it \
             is rebuilt as one record of {} s (its length is assumed), with the one timing error of [Table 4](table4.md): \
             {}.\n\nUnder the pressure force alone the 1-DOF model misses it by {} of its standard deviation (Fig. 3); with the unknown \
             force, computed from the same record, by {} (Fig. 11).",
            context.stated_excitations()[0],
            context.stated_excitations()[1],
            context.stated.amplitude.printed(),
            significant(sweep.displacement.len() as f64 * context.time_step_s(), 3),
            sweep.rebuilt.statement,
            significant(without, 2),
            if with < super::figures::ROUNDING {
                "rounding".to_owned()
            } else {
                significant(with, 1)
            },
        )),
        spectrogram(&segments),
        Block::Table(lines(context, &segments)),
        comparison(
            &sweep,
            "fig03-sweep",
            "Fig. 3 in kind: the sweep and the 1-DOF model under its pressure force, without the unknown force",
            &sweep.without,
            ("1-DOF model", Role::Nominal),
        ),
        comparison(
            &sweep,
            "fig11-sweep",
            "Fig. 11 in kind: the sweep and the 1-DOF model with the unknown force",
            &sweep.with,
            ("1-DOF model + unknown force", Role::Corrected),
        ),
    ];
    Ok(Page {
        stem: "sweep",
        title: "The sweep from 1 to 7 Hz".to_owned(),
        summary: "one record with its spectrogram; Fig. 3 and 11".to_owned(),
        blocks,
    })
}

/// The spectrogram by levels: a dot for every bin of every segment above the level.
fn spectrogram(segments: &[(f64, f64, simgap_signal::spectrum::Spectrum)]) -> Block {
    let mut chart = LineChart::new(
        "Spectrogram of the displacement",
        "time [s]",
        "frequency [Hz]",
    );
    for (i, (level, role)) in LEVELS.into_iter().enumerate() {
        let name = format!("above {} µm", significant(1e6 * level, 1));
        let below = LEVELS.get(i + 1).map_or(f64::INFINITY, |next| next.0);
        let mut points = vec![];
        for (time, _, found) in segments {
            for (freq, amplitude) in found.freq_hz.iter().zip(&found.amplitude) {
                if (level..below).contains(amplitude) {
                    points.push((*time, *freq));
                }
            }
        }
        chart = chart.with(Series::from_points(name, role, &points).with_mark(Mark::Points));
    }
    chart.y_range = Some([0.0, 50.0]);
    Block::Figure(
        "sweep-spectrogram",
        format!(
            "Spectrogram of the rebuilt sweep by levels (segments of {} s, Hann window): the excitation rises, its image falls as 50 − f",
            SEGMENT_S[0]
        ),
        chart,
    )
}

/// Height of the excitation and of the image when the sweep passes whole frequencies.
fn lines(context: &Context, segments: &[(f64, f64, simgap_signal::spectrum::Spectrum)]) -> Table {
    let middle = 0.25 * context.sample_rate_hz();
    let (below, above) = (
        format!("strongest below {middle} Hz [Hz]"),
        format!("strongest above {middle} Hz [Hz]"),
    );
    let mut table = Table::new(
        "Lines of the sweep as it passes",
        &[
            "f [Hz]",
            &below,
            "its bin [µm]",
            &above,
            "its bin [µm]",
            "50 − f [Hz]",
            "ratio",
            "2πfτ",
        ],
    );
    let strongest = |found: &simgap_signal::spectrum::Spectrum, above: bool| {
        let bins = found.freq_hz.iter().zip(&found.amplitude);
        bins.filter(|(freq, _)| (**freq > middle) == above)
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or((f64::NAN, f64::NAN), |(freq, amplitude)| {
                (*freq, *amplitude)
            })
    };
    for row in &context.table2.rows {
        let wanted = row.excitation.si();
        let off = |freq: f64| (freq - wanted).abs();
        let Some((_, freq, found)) = segments.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)))
        else {
            continue;
        };
        let (low, high) = (strongest(found, false), strongest(found, true));
        table.rows.push(vec![
            Cell::Number(*freq, 3),
            Cell::Number(low.0, 4),
            Cell::Number(1e6 * low.1, 4),
            Cell::Number(high.0, 4),
            Cell::Number(1e6 * high.1, 3),
            Cell::Number(context.stated.image_base.si() - freq, 4),
            Cell::Number(high.1 / low.1, 2),
            Cell::Number(std::f64::consts::TAU * freq * context.timing.value, 2),
        ]);
    }
    table
}

fn comparison(
    sweep: &Sweep,
    stem: &'static str,
    caption: &str,
    predicted: &[f64],
    (name, role): (&'static str, Role),
) -> Block {
    let millimetres = |values: &[f64]| values.iter().map(|v| 1e3 * v).collect::<Vec<_>>();
    let time = sweep.rebuilt.record.time_s().to_vec();
    let chart = LineChart::new("Sweep", "time [s]", "displacement [mm]")
        .with(Series::new(
            "rebuilt record",
            Role::Measured,
            time.clone(),
            millimetres(&sweep.displacement),
        ))
        .with(Series::new(name, role, time, millimetres(predicted)).dashed());
    Block::Figure(stem, caption.to_owned(), chart)
}
