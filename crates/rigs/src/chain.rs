//! What becomes of a reading between the machine and the file.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::rng::Rng;

/// Faults of one channel. Amplitudes are in SI.
#[derive(Debug, Clone, Default)]
pub struct Chain {
    /// s.
    pub lag_s: Option<f64>,
    /// s.
    pub delay_s: f64,
    /// Share by which the clock runs fast.
    pub skew: f64,
    /// Every other sample at another time: tau in s, share on the even ones.
    pub alternating_timing: Option<(f64, f64)>,
    /// Factor.
    pub gain: Option<f64>,
    /// Foreign: y + a y |y|.
    pub curve: Option<f64>,
    /// Every other sample with another gain: g, share on the even ones.
    pub alternating_gain: Option<(f64, f64)>,
    /// Constant.
    pub bias: f64,
    /// Per second.
    pub drift: f64,
    /// Amplitude, frequency, phase.
    pub tones: Vec<(f64, f64, f64)>,
    /// Lower and upper end; whether noise comes after.
    pub clip: Option<(f64, f64, bool)>,
    /// Step and level.
    pub steps: Option<(f64, f64)>,
    /// Share of samples at which a loss begins, longest loss, whether zero is stored.
    pub losses: Option<(f64, usize, bool)>,
    /// Share of samples that are struck, and size.
    pub spikes: Option<(f64, f64)>,
    /// Not connected: noise only.
    pub dead: bool,
}

/// Noise of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Root mean square, SI.
    pub rms: f64,
    /// Correlation from one sample to the next.
    pub ar1: f64,
}

impl Noise {
    /// A stretch of it.
    #[must_use]
    pub fn draw(&self, rng: &mut Rng, samples: usize) -> Vec<f64> {
        let fresh = (1.0 - self.ar1 * self.ar1).sqrt();
        let mut state = rng.normal();
        let mut list = Vec::with_capacity(samples);
        for _ in 0..samples {
            list.push(self.rms * state);
            state = self.ar1 * state + fresh * rng.normal();
        }
        list
    }
}

impl Chain {
    /// The samples of a channel from its readings on a fine grid; `noise` empty for none.
    ///
    /// `rng` decides which samples are lost or struck.
    #[must_use]
    pub fn sample(
        &self,
        reading: &Grid,
        samples: usize,
        step_s: f64,
        noise: &[f64],
        rng: &mut Rng,
    ) -> Vec<f64> {
        let lagged = self.lag_s.map(|lag| reading.lagged(lag, step_s));
        let source = lagged.as_ref().unwrap_or(reading);
        let noise_at = |n: usize| noise.get(n).copied().unwrap_or(0.0);
        let mut values: Vec<f64> = (0..samples)
            .map(|n| {
                let value = match self.dead {
                    true => 0.0,
                    false => self.undisturbed(source, n, step_s),
                };
                match self.clip {
                    Some((low, high, true)) => value.clamp(low, high) + noise_at(n),
                    Some((low, high, false)) => (value + noise_at(n)).clamp(low, high),
                    None => value + noise_at(n),
                }
            })
            .collect();
        if let Some((step, level)) = self.steps {
            for value in &mut values {
                *value = level + step * ((*value - level) / step).round();
            }
        }
        if let Some((share, longest, zero)) = self.losses {
            lose(&mut values, share, longest, zero, rng);
        }
        if let Some((share, size)) = self.spikes {
            for value in values.iter_mut().skip(4) {
                if rng.chance(share) {
                    *value += size * rng.sign() * rng.uniform(0.7, 1.5);
                }
            }
        }
        values
    }

    fn undisturbed(&self, source: &Grid, n: usize, step_s: f64) -> f64 {
        let even = n.is_multiple_of(2);
        let mut time = n as f64 * (1.0 + self.skew) - self.delay_s / step_s;
        if let Some((tau, share)) = self.alternating_timing {
            time += match even {
                true => 2.0 * share * tau / step_s,
                false => -2.0 * (1.0 - share) * tau / step_s,
            };
        }
        let mut y = source.smooth(time);
        if let Some(a) = self.curve {
            y += a * y * y.abs();
        }
        y *= self.gain.unwrap_or(1.0);
        if let Some((g, share)) = self.alternating_gain {
            y *= match even {
                true => 1.0 + 2.0 * share * g,
                false => 1.0 - 2.0 * (1.0 - share) * g,
            };
        }
        let t = n as f64 * step_s;
        let tone = |&(a, f, phase): &(f64, f64, f64)| a * (2.0 * PI * f * t + phase).sin();
        y + self.bias + self.drift * t + self.tones.iter().map(tone).sum::<f64>()
    }
}

fn lose(values: &mut [f64], share: f64, longest: usize, zero: bool, rng: &mut Rng) {
    let mut left = 0;
    let mut held = values[0];
    for value in values.iter_mut().skip(1) {
        if left == 0 && rng.chance(share) {
            left = rng.whole(1, longest);
        }
        if left > 0 {
            left -= 1;
            *value = if zero { 0.0 } else { held };
        } else {
            held = *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Grid {
        Grid {
            values: (0..480).map(|k| f64::from(k) / 4.0 - 10.0).collect(),
            start: -10.0,
            per: 4.0,
            hold: false,
        }
    }

    fn read(chain: &Chain) -> Vec<f64> {
        chain.sample(&ramp(), 100, 0.5, &[], &mut Rng::new("chain"))
    }

    #[test]
    fn verify_each_fault_is_its_formula() {
        // The reading is y(n) = n, the time t = n / 2.
        let close = |chain: Chain, formula: fn(f64) -> f64| {
            for (n, y) in read(&chain).iter().enumerate() {
                assert!((y - formula(n as f64)).abs() < 1e-9, "{chain:?}: {n} {y}");
            }
        };
        let none = Chain::default;
        close(none(), |n| n);
        close(
            Chain {
                delay_s: 0.75,
                ..none()
            },
            |n| n - 1.5,
        );
        close(
            Chain {
                skew: 0.01,
                ..none()
            },
            |n| 1.01 * n,
        );
        close(
            Chain {
                gain: Some(-2.0),
                bias: 3.0,
                ..none()
            },
            |n| 3.0 - 2.0 * n,
        );
        close(
            Chain {
                drift: 0.2,
                ..none()
            },
            |n| n + 0.1 * n,
        );
        close(
            Chain {
                clip: Some((5.0, 60.0, false)),
                ..none()
            },
            |n| n.clamp(5.0, 60.0),
        );
        close(
            Chain {
                steps: Some((4.0, 1.0)),
                ..none()
            },
            |n| 1.0 + 4.0 * ((n - 1.0) / 4.0).round(),
        );
        close(
            Chain {
                tones: vec![(2.0, 0.3, 0.4)],
                ..none()
            },
            |n| n + 2.0 * (2.0 * PI * 0.3 * 0.5 * n + 0.4).sin(),
        );
        close(
            Chain {
                alternating_gain: Some((0.1, 0.0)),
                ..none()
            },
            |n| if n % 2.0 == 1.0 { 0.8 * n } else { n },
        );
        close(
            Chain {
                alternating_timing: Some((0.25, 1.0)),
                ..none()
            },
            |n| if n % 2.0 == 0.0 { n + 1.0 } else { n },
        );
    }

    #[test]
    fn verify_a_lag_of_a_ramp_is_a_shift() {
        let chain = Chain {
            lag_s: Some(1.0),
            ..Chain::default()
        };
        // The ramp began 10 samples = 5 lags earlier: e⁻⁵ of the start is left of 2 samples.
        let y = read(&chain);
        assert!((y[50] - 48.0).abs() < 1e-6, "{}", y[50]);
    }

    #[test]
    fn verify_coloured_noise_has_its_size_and_correlation() {
        let noise = Noise { rms: 2.0, ar1: 0.8 };
        let e = noise.draw(&mut Rng::new("noise"), 40_000);
        let power = e.iter().map(|v| v * v).sum::<f64>() / 40_000.0;
        let next = e.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / 40_000.0;
        assert!((power - 4.0).abs() < 0.25, "{power}");
        assert!((next / power - 0.8).abs() < 0.02, "{next}");
    }

    #[test]
    fn verify_lost_samples_hold_or_are_zero() {
        let lossy = |zero| Chain {
            losses: Some((0.1, 2, zero)),
            ..Chain::default()
        };
        let held = read(&lossy(false));
        assert!(held.windows(2).any(|w| w[0] == w[1]));
        assert!(held.windows(2).all(|w| w[1] >= w[0]));
        assert!(read(&lossy(true)).iter().filter(|v| **v == 0.0).count() > 2);
    }
}
