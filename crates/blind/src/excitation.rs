//! Excitations as functions of time, so that truth and record can be sampled at different rates.

use std::f64::consts::TAU;

use crate::random::Random;

/// What is known of a plant before it is excited.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    /// Lowest frequency worth exciting, Hz.
    pub(crate) from_hz: f64,
    /// Highest, Hz.
    pub(crate) to_hz: f64,
    /// Peak of the excitation, unit of the input.
    pub(crate) amplitude: f64,
    /// Length, s.
    pub(crate) duration_s: f64,
}

#[derive(Debug, Clone, Copy)]
struct Line {
    amplitude: f64,
    freq_hz: f64,
    phase: f64,
}

impl Line {
    fn at(&self, t: f64) -> f64 {
        self.amplitude * (TAU * self.freq_hz * t + self.phase).sin()
    }
}

/// A smooth function of time.
#[derive(Debug, Clone)]
pub(crate) enum Signal {
    /// Linear sine sweep.
    Sweep {
        amplitude: f64,
        from_hz: f64,
        slope_hz_per_s: f64,
        phase: f64,
    },
    /// Sum of sines under an envelope that grows linearly from `start` to 1.
    Lines {
        lines: Vec<(f64, f64, f64)>,
        start: f64,
        duration_s: f64,
    },
    /// Levels with raised-cosine transitions centred at the given times.
    Levels {
        changes: Vec<(f64, f64)>,
        rise_s: f64,
    },
    /// Raised-cosine pulses: centre and height.
    Pulses {
        pulses: Vec<(f64, f64)>,
        width_s: f64,
    },
    /// One sine after the other, faded into each other.
    Points {
        points: Vec<(f64, f64, f64)>,
        dwell_s: f64,
        fade_s: f64,
    },
}

impl Signal {
    /// Value at a time on the clock of the excitation, s.
    pub(crate) fn at(&self, t: f64) -> f64 {
        match self {
            Signal::Sweep {
                amplitude,
                from_hz,
                slope_hz_per_s,
                phase,
            } => amplitude * (TAU * (from_hz * t + 0.5 * slope_hz_per_s * t * t) + phase).sin(),
            Signal::Lines {
                lines,
                start,
                duration_s,
            } => {
                let growth = start + (1.0 - start) * (t / duration_s).clamp(0.0, 1.0);
                growth * lines.iter().map(|&line| of(line).at(t)).sum::<f64>()
            }
            Signal::Levels { changes, rise_s } => changes
                .iter()
                .map(|&(at, change)| change * ramp((t - at) / rise_s + 0.5))
                .sum(),
            Signal::Pulses { pulses, width_s } => pulses
                .iter()
                .map(|&(at, height)| height * ramp(1.0 - (2.0 * (t - at) / width_s).abs()))
                .sum(),
            Signal::Points {
                points,
                dwell_s,
                fade_s,
            } => points
                .iter()
                .enumerate()
                .map(|(i, &point)| {
                    let begins = i as f64 * dwell_s;
                    let into = if i == 0 {
                        1.0
                    } else {
                        ramp((t - begins) / fade_s + 0.5)
                    };
                    let out = if i + 1 == points.len() {
                        0.0
                    } else {
                        ramp((t - begins - dwell_s) / fade_s + 0.5)
                    };
                    let weight = into - out;
                    if weight == 0.0 {
                        0.0
                    } else {
                        weight * of(point).at(t)
                    }
                })
                .sum(),
        }
    }
}

fn of((amplitude, freq_hz, phase): (f64, f64, f64)) -> Line {
    Line {
        amplitude,
        freq_hz,
        phase,
    }
}

/// Raised cosine from 0 at x ≤ 0 to 1 at x ≥ 1.
fn ramp(x: f64) -> f64 {
    0.5 - 0.5 * (std::f64::consts::PI * x.clamp(0.0, 1.0)).cos()
}

/// Number of different excitations.
pub(crate) const STYLES: usize = 6;

/// Draws an excitation of a style (0 to [`STYLES`] − 1).
pub(crate) fn draw(random: &mut Random, style: usize, range: &Range) -> Signal {
    let Range {
        from_hz,
        to_hz,
        amplitude,
        duration_s,
    } = *range;
    match style {
        0 => {
            let (low, high) = if random.chance(0.5) {
                (from_hz, to_hz)
            } else {
                (to_hz, from_hz)
            };
            Signal::Sweep {
                amplitude,
                from_hz: low,
                slope_hz_per_s: (high - low) / duration_s,
                phase: random.uniform(0.0, TAU),
            }
        }
        1 => lines(random, range, 12, 1.0),
        2 => lines(random, range, 36, 0.2),
        3 => {
            let rise_s = 0.6 / to_hz;
            let count = ((duration_s * from_hz) as usize).clamp(3, 12);
            let mut level = 0.0;
            let changes = (0..count)
                .map(|i| {
                    let at = duration_s * (i as f64 + random.uniform(0.2, 0.8)) / count as f64;
                    let next =
                        if level > 0.0 { -1.0 } else { 1.0 } * amplitude * random.uniform(0.3, 1.0);
                    let change = next - level;
                    level = next;
                    (at, change)
                })
                .collect();
            Signal::Levels { changes, rise_s }
        }
        4 => {
            let count = ((duration_s * from_hz * 0.5) as usize).clamp(3, 10);
            let pulses = (0..count)
                .map(|i| {
                    let at = duration_s * (i as f64 + random.uniform(0.2, 0.8)) / count as f64;
                    (at, random.sign() * amplitude * random.uniform(0.6, 2.0))
                })
                .collect();
            Signal::Pulses {
                pulses,
                width_s: 1.0 / to_hz,
            }
        }
        _ => {
            let count = 3 + random.below(2);
            let dwell_s = duration_s / count as f64;
            let points = (0..count)
                .map(|_| {
                    let freq_hz = random.log_uniform(from_hz, to_hz);
                    let size = amplitude * random.uniform(0.3, 1.0);
                    (size, freq_hz, random.uniform(0.0, TAU))
                })
                .collect();
            Signal::Points {
                points,
                dwell_s,
                fade_s: 0.1 * dwell_s,
            }
        }
    }
}

/// Sines of random frequency and phase, as many as given, one in each equal part of the band:
/// a multisine, or band-limited noise when they are many.
fn lines(random: &mut Random, range: &Range, count: usize, start: f64) -> Signal {
    let width = (range.to_hz - range.from_hz) / count as f64;
    let amplitude = range.amplitude * (2.0 / count as f64).sqrt();
    let lines = (0..count)
        .map(|i| {
            let freq_hz = range.from_hz + width * (i as f64 + random.unit());
            (amplitude, freq_hz, random.uniform(0.0, TAU))
        })
        .collect();
    Signal::Lines {
        lines,
        start,
        duration_s: range.duration_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_excitations_are_bounded_smooth_and_alive() {
        let range = Range {
            from_hz: 1.0,
            to_hz: 5.0,
            amplitude: 3.0,
            duration_s: 20.0,
        };
        for style in 0..STYLES {
            for seed in 0..20 {
                let mut random = Random::new(seed);
                let signal = draw(&mut random, style, &range);
                let step = 1.0 / (400.0 * range.to_hz);
                let values: Vec<f64> = (0..40_000).map(|i| signal.at(i as f64 * step)).collect();
                let peak = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                assert!((0.5..30.0).contains(&peak), "style {style}: {peak}");
                // A sine of the highest frequency and the peak's amplitude is no steeper; pulses of
                // one period of it and levels of two peaks within 0.6 of it are, by less than 2.
                let steepest = TAU * range.to_hz * peak * step * 2.0;
                let jump = values
                    .windows(2)
                    .fold(0.0_f64, |m, w| m.max((w[1] - w[0]).abs()));
                assert!(jump <= steepest, "style {style}: {jump} {steepest}");
            }
        }
    }

    #[test]
    fn verify_levels_settle() {
        let signal = Signal::Levels {
            changes: vec![(1.0, 2.0), (3.0, -5.0)],
            rise_s: 0.5,
        };
        assert_eq!(signal.at(0.5), 0.0);
        assert!((signal.at(1.0) - 1.0).abs() < 1e-12);
        assert_eq!(signal.at(2.0), 2.0);
        assert_eq!(signal.at(4.0), -3.0);
    }
}
