//! Every line of the page of peaks beside a closed form of its frequency, height and phase.
#![allow(unreachable_pub)]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde_json::Value;
use simgap_alpha::force_gain;
use simgap_model::undamped_modes;
use simgap_mold::{HARMONIC_SHARE, TwoDof};
use xtask::reproduce::{Context, PARK};

/// A line: of a cosine of this phase (rad) at the first sample, driven at `excitation`.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    pub excitation: f64,
    pub freq_hz: f64,
    pub height: f64,
    pub phase: f64,
}

/// What a line may be off.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Of the height, in its unit.
    pub height: f64,
    /// Length of the record, s.
    pub duration_s: f64,
}

/// Half a unit of the last digit shown, relative at worst: heights have five, frequencies six.
const HEIGHT_SHOWN: f64 = 5e-5;
const FREQ_SHOWN: f64 = 5e-6;
/// The same of a phase, which has two decimals, rad.
const PHASE_SHOWN: f64 = 0.005 * PI / 180.0;

/// Four standard errors of a line in 0.1 µm of white noise, 2000 samples and a Hann window, µm.
pub const DISPLACEMENT: Tolerance = Tolerance {
    height: 4.0 * 5.5e-3,
    duration_s: 20.0,
};

/// No noise; whole numbers of periods, so that nothing leaks: what is above 1e-6 N is rounding in the sums.
pub const PRESSURE: Tolerance = Tolerance {
    height: 1e-6,
    duration_s: 20.0,
};

/// No noise; side lobes of the strongest line, 2000 µm, lie 92 dB below it.
pub const MOTION: Tolerance = Tolerance {
    height: 2000.0 * 2.5e-5,
    duration_s: 20.0,
};

fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str()?.parse().ok())
}

/// The lines found in a table of a page.
pub fn found(page: &Value, title: &str) -> Vec<Line> {
    let tables = page["tables"].as_array().unwrap();
    let table = tables
        .iter()
        .find(|table| table["title"].as_str().unwrap().starts_with(title))
        .unwrap();
    let line = |row: &Value| {
        let object = row.as_object().unwrap();
        let height = object.iter().find(|(name, _)| name.starts_with("height"));
        Some(Line {
            excitation: number(&row["f [Hz]"])?,
            freq_hz: number(&row["found [Hz]"])?,
            height: number(height.unwrap().1)?,
            phase: number(&row["phase [°]"])?.to_radians(),
        })
    };
    table["rows"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(line)
        .collect()
}

/// What of the lines found is not as it should be: no such line, or frequency, height or phase beyond the tolerance. An
/// error of the height of a line is one of its phase in the same proportion, twice as much at the end of a record as in its
/// middle, and of its frequency over the length of the record.
pub fn off(found: &[Line], expected: &[Line], tolerance: Tolerance) -> Vec<String> {
    let mut all = vec![];
    for line in found {
        let same = expected.iter().filter(|e| e.excitation == line.excitation);
        let near = same.min_by(|a, b| {
            let distance = |e: &Line| (e.freq_hz - line.freq_hz).abs();
            distance(a).total_cmp(&distance(b))
        });
        let Some(near) = near else {
            all.push(format!("{line:?}: no such excitation"));
            continue;
        };
        let share = tolerance.height / near.height;
        let turned = (line.phase - near.phase + PI).rem_euclid(TAU) - PI;
        for (what, off, most) in [
            (
                "frequency",
                line.freq_hz - near.freq_hz,
                share / tolerance.duration_s + FREQ_SHOWN * near.freq_hz,
            ),
            (
                "height",
                line.height - near.height,
                tolerance.height + HEIGHT_SHOWN * near.height,
            ),
            ("phase", turned, 2.5 * share + PHASE_SHOWN),
        ] {
            if off.is_nan() || off.abs() > most {
                all.push(format!(
                    "{what} of {line:?} is off by {off:e}, at most {most:e}"
                ));
            }
        }
    }
    all
}

/// Adds a sine to the lines: `sine` and `cosine` at a frequency, one line for each frequency.
fn add(lines: &mut Vec<(f64, [f64; 2])>, freq: f64, sine: f64, cosine: f64) {
    match lines
        .iter_mut()
        .find(|(other, _)| (other - freq).abs() < 1e-9)
    {
        Some((_, sum)) => *sum = [sum[0] + sine, sum[1] + cosine],
        None => lines.push((freq, [sine, cosine])),
    }
}

fn line(excitation: f64, (freq_hz, [sine, cosine]): (f64, [f64; 2]), unit: f64) -> Line {
    Line {
        excitation,
        freq_hz,
        height: sine.hypot(cosine) / unit,
        phase: (-sine).atan2(cosine),
    }
}

/// Excitation, and frequency and height of what the mold does, m: the fundamental and the harmonics of Table 2.
fn motions(context: &Context) -> Vec<(f64, Vec<(f64, f64)>)> {
    let amplitude = context.stated.amplitude.si();
    let rows = context.table2.rows.iter();
    rows.map(|row| {
        let base = row.excitation.si();
        let height = |line: f64| {
            if line == base {
                amplitude
            } else {
                amplitude * HARMONIC_SHARE / (line / base).powi(2)
            }
        };
        let lines = row.displacement.lines_hz().iter();
        (base, lines.map(|line| (*line, height(*line))).collect())
    })
    .collect()
}

/// `y_n = Σ A sin ω(t + (−1)ⁿ τ) = Σ A cos ωτ sin ωt + A sin ωτ cos(2π(50 − f)t)` at 100 Hz, µm.
pub fn displacement(context: &Context) -> Vec<Line> {
    let late = context.timing.value;
    let base = context.stated.image_base.si();
    let mut all = vec![];
    for (excitation, motions) in motions(context) {
        let mut lines = vec![];
        for (freq, height) in motions {
            let turned = TAU * freq * late;
            add(&mut lines, freq, height * turned.cos(), 0.0);
            add(&mut lines, base - freq, 0.0, height * turned.sin());
        }
        all.extend(lines.into_iter().map(|found| line(excitation, found, 1e-6)));
    }
    all
}

/// `F = Σ A (Re G sin ωt + Im G cos ωt) − ½ Δα cos ωt` with G of Eq. (3) through Park's formula, N.
pub fn pressure(context: &Context) -> Vec<Line> {
    let step = context.stated.time_step.si();
    let mut all = vec![];
    for (excitation, motions) in motions(context) {
        let mut rows = context.table3.rows.iter();
        let row = rows.find(|row| row.excitation.si() == excitation);
        let stroke = row.map_or(0.0, |row| row.peak_to_peak.si());
        for (freq, height) in motions {
            let gain = force_gain(&context.plant, PARK, freq, step).unwrap();
            let less = if freq == excitation {
                0.5 * stroke
            } else {
                0.0
            };
            let parts = [height * gain.re, height * gain.im - less];
            all.push(line(excitation, (freq, parts), 1.0));
        }
    }
    all
}

/// m₁ from rest under F sin ωt: `Σ_r φ² F/(ω_r² − ω²) (sin ωt − ω/ω_r sin ω_r t)`, µm.
pub fn motion(context: &Context, model: impl Fn(f64) -> TwoDof) -> Vec<Line> {
    let mut all = vec![];
    for row in &context.table5.rows {
        let freq = row.excitation.si();
        let model = model(freq);
        let amplitude = context.stated.amplitude.si();
        let force = model.force_amplitude(amplitude, freq).unwrap();
        let modes = undamped_modes(&model.model().unwrap().matrices().unwrap()).unwrap();
        let own = |freq_hz: f64, height: f64, phase: f64| Line {
            excitation: freq,
            freq_hz,
            height: 1e6 * height,
            phase,
        };
        all.push(own(freq, amplitude, -FRAC_PI_2));
        for (r, natural) in modes.natural_freq_rad.iter().enumerate() {
            let omega = TAU * freq;
            let shape = modes.mode_shape[(0, r)].powi(2);
            let height = shape * force / (natural * natural - omega * omega) * omega / natural;
            all.push(own(natural / TAU, height, FRAC_PI_2));
        }
    }
    all
}
