//! Excitations as functions of time, on a fine grid.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::rng::Rng;

/// Values per sample of an excitation.
pub const FINE: usize = 8;

/// Kinds of excitation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A few hammer blows.
    Impacts,
    /// A sine of rising frequency.
    Chirp,
    /// Random, falling with the frequency, as of a road.
    Noise,
    /// Random switching between two levels, edges smoothed.
    Prbs,
    /// The same, held from sample to sample.
    HeldPrbs,
    /// Ramps and plateaus.
    Trapezoids,
    /// Many lines of equal size.
    Multisine,
    /// Steps of random size, edges smoothed.
    Steps,
    /// Two to four frequencies.
    Sines,
}

impl Shape {
    /// Name in the truth.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Shape::Impacts => "impacts",
            Shape::Chirp => "chirp",
            Shape::Noise => "road_noise",
            Shape::Prbs => "prbs",
            Shape::HeldPrbs => "held_prbs",
            Shape::Trapezoids => "trapezoids",
            Shape::Multisine => "multisine",
            Shape::Steps => "steps",
            Shape::Sines => "sines",
        }
    }
}

/// What an excitation has to fit.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Samples before the record.
    pub before: usize,
    /// Samples of the record.
    pub samples: usize,
    /// s.
    pub step_s: f64,
    /// Lowest and highest frequency of interest, Hz.
    pub band_hz: (f64, f64),
    /// Whether it is zero before the record and sets in gently.
    pub from_rest: bool,
}

/// A smooth step from 0 to 1 over [0, 1].
fn smooth_step(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (s * (6.0 * s - 15.0) + 10.0)
}

/// Levels that change at times, with edges of a width, in samples.
fn levels(changes: &[(f64, f64)], edge: f64, t: f64) -> f64 {
    let after = changes.partition_point(|c| c.0 <= t);
    if after == 0 {
        return 0.0;
    }
    let before = if after >= 2 {
        changes[after - 2].1
    } else {
        0.0
    };
    let (at, level) = changes[after - 1];
    before + (level - before) * smooth_step((t - at) / edge)
}

/// Sums of sines: amplitude, cycles per sample, phase.
fn sines(lines: &[(f64, f64, f64)], t: f64) -> f64 {
    let one = |&(a, f, p): &(f64, f64, f64)| a * (2.0 * PI * f * t + p).sin();
    lines.iter().map(one).sum()
}

fn lines_of(shape: Shape, rng: &mut Rng, frame: &Frame) -> Vec<(f64, f64, f64)> {
    let (low, high) = (
        frame.band_hz.0 * frame.step_s,
        (frame.band_hz.1 * frame.step_s).min(0.125),
    );
    let count = match shape {
        Shape::Sines => rng.whole(2, 4),
        Shape::Multisine => rng.whole(10, 30),
        _ => 90,
    };
    let falling = match shape {
        Shape::Noise => rng.uniform(0.5, 1.5),
        _ => 0.0,
    };
    let (bottom, top) = match shape {
        Shape::Noise => (0.3 * low, 1.4 * high),
        Shape::Sines => (0.6 * low, high),
        _ => (0.5 * low, 1.2 * high),
    };
    (0..count)
        .map(|i| {
            let share = (i as f64 + rng.unit()) / count as f64;
            let f = match shape {
                Shape::Sines => bottom * (top / bottom).powf(share),
                _ => bottom + (top - bottom) * share,
            };
            (f.powf(-falling), f, 2.0 * PI * rng.unit())
        })
        .collect()
}

type Signal = Box<dyn Fn(f64) -> f64>;

fn pulses(rng: &mut Rng, n: f64, high: f64) -> Signal {
    let count = rng.whole(3, 9);
    let blows: Vec<(f64, f64, f64)> = (0..count)
        .map(|i| {
            let at = n * (i as f64 + rng.uniform(0.1, 0.7)) / count as f64;
            let width = (rng.uniform(0.5, 1.2) / high).max(10.0);
            (at, width, rng.sign() * rng.uniform(0.5, 1.0))
        })
        .collect();
    Box::new(move |t| {
        let one = |&(at, width, size): &(f64, f64, f64)| {
            let s = (t - at) / width;
            let inside = (0.0..1.0).contains(&s);
            if inside {
                size * (PI * s).sin().powi(4)
            } else {
                0.0
            }
        };
        blows.iter().map(one).sum()
    })
}

fn chirp(rng: &mut Rng, n: f64, low: f64, high: f64) -> Signal {
    let (f0, f1) = (0.4 * low, 1.3 * high);
    let (f0, f1) = if rng.chance(0.3) { (f1, f0) } else { (f0, f1) };
    let phase = 2.0 * PI * rng.unit();
    let falling = rng.uniform(0.0, 0.6);
    Box::new(move |t| {
        let s = (t / n).clamp(-0.2, 1.1);
        let f = f0 + (f1 - f0) * s;
        let turns = f0 * t + 0.5 * (f1 - f0) * s * t;
        (f.abs() / low).max(0.2).powf(-falling) * (2.0 * PI * turns + phase).sin()
    })
}

fn switching(shape: Shape, rng: &mut Rng, frame: &Frame, low: f64, high: f64) -> Signal {
    let n = frame.samples as f64;
    let mut t = match frame.from_rest {
        true => 0.03 * n,
        false => -(frame.before as f64),
    };
    t = t.round();
    let edge = match shape {
        Shape::Trapezoids => (rng.uniform(0.3, 0.8) / low).min(0.1 * n).max(12.0),
        _ => (0.35 / high).max(8.0),
    };
    let chip = (rng.uniform(0.25, 0.5) / high).max(edge).ceil();
    let wait = (rng.uniform(0.7, 1.5) / low).min(0.15 * n).max(1.2 * edge);
    let mut changes: Vec<(f64, f64)> = Vec::new();
    let mut level = rng.sign();
    while t < n {
        match shape {
            Shape::Prbs | Shape::HeldPrbs => {
                changes.push((t, level));
                t += chip * rng.whole(1, 6) as f64;
                level = -level;
            }
            Shape::Trapezoids => {
                let size = *rng.pick(&[0.5, 0.75, 1.0]);
                for value in [size * level, 0.0] {
                    changes.push((t, value));
                    t += edge + rng.uniform(0.2, 1.0) * wait;
                }
                level = -level;
            }
            _ => {
                changes.push((t, rng.uniform(-1.0, 1.0)));
                t += edge + rng.uniform(0.5, 2.0) * wait;
            }
        }
    }
    if shape == Shape::HeldPrbs {
        return Box::new(move |t| levels(&changes, 1e-9, t + 1e-6));
    }
    Box::new(move |t| levels(&changes, edge, t))
}

/// A signal of a shape with root mean square 1 over the record.
#[must_use]
pub fn excitation(shape: Shape, rng: &mut Rng, frame: &Frame) -> Grid {
    let n = frame.samples as f64;
    let low = frame.band_hz.0 * frame.step_s;
    let high = (frame.band_hz.1 * frame.step_s).min(0.125);
    let signal: Signal = match shape {
        Shape::Impacts => pulses(rng, n, high),
        Shape::Chirp => chirp(rng, n, low, high),
        Shape::Noise | Shape::Multisine | Shape::Sines => {
            let lines = lines_of(shape, rng, frame);
            Box::new(move |t| sines(&lines, t))
        }
        _ => switching(shape, rng, frame, low, high),
    };
    let (begin, rise) = (0.02 * n, (0.6 / low).min(0.08 * n).max(10.0));
    let per = FINE;
    let count = (frame.before + frame.samples + 8) * per;
    let start = -(frame.before as f64);
    let mut values: Vec<f64> = (0..count)
        .map(|k| {
            let t = start + k as f64 / per as f64;
            let continuous = matches!(
                shape,
                Shape::Chirp | Shape::Noise | Shape::Multisine | Shape::Sines
            );
            match frame.from_rest && continuous {
                true => signal(t) * smooth_step((t - begin) / rise),
                false => signal(t),
            }
        })
        .collect();
    let first = frame.before * per;
    let square = values[first..].iter().map(|v| v * v).sum::<f64>();
    let rms = (square / (count - first) as f64).sqrt().max(1e-12);
    values.iter_mut().for_each(|v| *v /= rms);
    Grid {
        values,
        start,
        per: per as f64,
        hold: shape == Shape::HeldPrbs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Shape; 9] = [
        Shape::Impacts,
        Shape::Chirp,
        Shape::Noise,
        Shape::Prbs,
        Shape::HeldPrbs,
        Shape::Trapezoids,
        Shape::Multisine,
        Shape::Steps,
        Shape::Sines,
    ];

    /// A grid from samples alone must give the signal back: it is band-limited.
    #[test]
    fn verify_samples_tell_the_signal() {
        let frame = Frame {
            before: 100,
            samples: 2000,
            step_s: 0.01,
            band_hz: (0.8, 4.0),
            from_rest: true,
        };
        for shape in ALL.into_iter().filter(|s| *s != Shape::HeldPrbs) {
            let grid = excitation(shape, &mut Rng::new(shape.name()), &frame);
            let coarse = Grid {
                values: grid.values.iter().step_by(FINE).copied().collect(),
                per: 1.0,
                ..grid.clone()
            };
            let mut worst = 0.0_f64;
            for k in 0..8000 {
                let t = f64::from(k) * 0.25;
                worst = worst.max((coarse.smooth(t) - grid.smooth(t)).abs());
            }
            // Ten samples over an edge, six points: below a per cent of the rms everywhere.
            assert!(worst < 0.02, "{} {worst}", shape.name());
            let still = grid.values[..100 * FINE].iter().all(|v| *v == 0.0);
            assert!(still, "{} moves before the record", shape.name());
        }
    }
}
