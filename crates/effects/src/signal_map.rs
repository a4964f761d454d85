//! Maps of sampled signals: what a sensor, a cable or a clock does to a channel.

use std::ops::Range;

/// Share of a record at either end that a map may leave out as beyond its reach: leaving out n samples
/// moves a log-likelihood by about √(n/2) at random.
const MOST_BEYOND: f64 = 0.01;
/// Samples that a short stretch may leave out all the same, up to a tenth of it.
const FEW: usize = 8;

/// Samples at either end of a record that a map may leave out as beyond its reach.
#[must_use]
pub fn most_beyond(len: usize) -> usize {
    ((MOST_BEYOND * len as f64) as usize).max(FEW.min(len / 10))
}

/// A uniformly sampled signal.
#[derive(Debug, Clone, Copy)]
pub struct Sampled<'a> {
    /// Values, one a sample.
    pub values: &'a [f64],
    /// Sampling interval, s.
    pub time_step_s: f64,
    /// Number of the first value on the clock of the converter: a stretch cut out of a record keeps
    /// the even and odd samples of the record.
    pub first_index: usize,
    /// Time of the first value on the clock of the record, s.
    pub start_s: f64,
    /// What was measured of this signal, where it was: a chain that loses samples shows in the
    /// record which ones.
    pub measured: Option<&'a [f64]>,
}

impl<'a> Sampled<'a> {
    /// A signal that begins with its record.
    #[must_use]
    pub fn from_start(values: &'a [f64], time_step_s: f64) -> Sampled<'a> {
        Sampled {
            values,
            time_step_s,
            first_index: 0,
            start_s: 0.0,
            measured: None,
        }
    }
}

/// Turns the true signal into what the chain delivers, sample by sample.
pub trait SignalMap: Send + Sync {
    /// The delivered signal, as long as the true one.
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64>;

    /// The samples that are made of the signal alone, not of what was before or comes after the record; at
    /// either end no more than a hundredth of the record is left out, of a short one eight samples. Of `values`
    /// only the length counts.
    fn reach(&self, signal: Sampled<'_>) -> Range<usize> {
        0..signal.values.len()
    }

    /// Whether it is the last of the maps before sampling: it takes its start from what was measured. Lags,
    /// gains, biases and delays may change places.
    fn ends_the_chain(&self) -> bool {
        false
    }

    /// The step of a map that moves in steps (rounding).
    fn step(&self) -> Option<f64> {
        None
    }

    /// The ends of the range of a sensor, beyond which it shows nothing of its signal.
    fn range(&self) -> Option<[f64; 2]> {
        None
    }

    /// Whether the map moves in steps, so that it has no derivative to go by.
    fn is_stepped(&self) -> bool {
        self.step().is_some()
    }

    /// Whether it takes from samples what they held, so that what it does hangs on single values: rounding, limits, losses,
    /// spikes.
    fn is_lossy(&self) -> bool {
        false
    }

    /// Whether it lives in single samples as the converter took them (alternations, losses, spikes, another
    /// clock): where samples were moved to an even time base there is nothing of it.
    fn lives_in_single_samples(&self) -> bool {
        false
    }

    /// Whether samples are taken between those of the signal: interpolation smooths the noise on it.
    fn interpolates(&self) -> bool {
        false
    }
}

/// A map that takes every sample at another time: what lies beyond the record is out of its reach.
pub(crate) trait Retiming: Send + Sync {
    /// Where on the true signal the i-th sample is taken, in samples.
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64;

    /// See [`SignalMap::lives_in_single_samples`].
    fn counts_samples(&self) -> bool {
        false
    }
}

impl<T: Retiming> SignalMap for T {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        signal.moved(|i| self.position(&signal, i))
    }

    fn reach(&self, signal: Sampled<'_>) -> Range<usize> {
        signal.on_record(|i| self.position(&signal, i))
    }

    fn lives_in_single_samples(&self) -> bool {
        self.counts_samples()
    }

    fn interpolates(&self) -> bool {
        true
    }
}

impl Sampled<'_> {
    /// The values at a position for each sample.
    fn moved(&self, position: impl Fn(usize) -> f64) -> Vec<f64> {
        (0..self.values.len())
            .map(|i| self.at(position(i)))
            .collect()
    }

    /// The samples whose positions are on the record, see [`SignalMap::reach`].
    pub(crate) fn on_record(&self, position: impl Fn(usize) -> f64) -> Range<usize> {
        let len = self.values.len();
        let most = most_beyond(len);
        let is_off = |i: &usize| !(0.0..=(len as f64 - 1.0)).contains(&position(*i));
        let start = (0..most).rev().find(is_off).map_or(0, |i| i + 1);
        let end = (len - most..len).find(is_off).unwrap_or(len);
        start..end
    }

    /// Value at a fractional sample position, by Lagrange interpolation through the six nearest
    /// samples.
    ///
    /// ```text
    /// y(p) = Σᵢ yᵢ Πⱼ≠ᵢ (p − j) / (i − j),   i, j = ⌊p⌋ − 2 … ⌊p⌋ + 3
    /// ```
    ///
    /// Exact for polynomials of degree 5. Away from the ends of the record, a sine of amplitude A
    /// and frequency f is off by at most
    ///
    /// ```text
    /// A (5/1024) (2π f Δt)⁶
    /// ```
    ///
    /// which is 0.1 % at a quarter and 0.6 % at a third of the Nyquist frequency. Outside the
    /// record the nearest value is held.
    #[must_use]
    pub fn at(&self, position: f64) -> f64 {
        let Some(last) = self.values.len().checked_sub(1) else {
            return 0.0;
        };
        let position = position.clamp(0.0, last as f64);
        if last < 5 {
            let left = (position.floor() as usize).min(last.saturating_sub(1));
            let right = (left + 1).min(last);
            let fraction = position - left as f64;
            return self.values[left] + fraction * (self.values[right] - self.values[left]);
        }
        let first = (position.floor() as usize).saturating_sub(2).min(last - 5);
        let p = position - first as f64;
        let d: [f64; 6] = std::array::from_fn(|j| p - j as f64);
        // Πⱼ≠ᵢ (i − j) for six equidistant points.
        const DENOMINATOR: [f64; 6] = [-120.0, 24.0, -12.0, 12.0, -24.0, 120.0];
        let mut sum = 0.0;
        for i in 0..6 {
            let mut product = 1.0;
            for (j, factor) in d.iter().enumerate() {
                if j != i {
                    product *= factor;
                }
            }
            // The weight first: at a sample it is exactly 0 or 1.
            sum += self.values[first + i] * (product / DENOMINATOR[i]);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_interpolation_is_exact_for_degree_five() {
        let poly = |x: f64| 1.0 - 2.0 * x + 0.3 * x.powi(2) - 0.02 * x.powi(4) + 0.001 * x.powi(5);
        let values: Vec<f64> = (0..12).map(|i| poly(f64::from(i))).collect();
        let signal = Sampled::from_start(&values, 1.0);
        for k in 0..=110 {
            let p = f64::from(k) * 0.1;
            assert!((signal.at(p) - poly(p)).abs() < 1e-10, "{p}");
        }
        assert_eq!(signal.at(-3.0), values[0]);
        assert_eq!(signal.at(30.0), values[11]);
    }

    /// The remainder of the interpolation, |y⁽⁶⁾| Π|p − j| / 6!, is largest midway between the two
    /// middle samples, where Π|p − j| = (½ · 3/2 · 5/2)².
    #[test]
    fn verify_interpolation_error_of_a_sine() {
        const ROUNDING: f64 = 1e-13;
        let mut largest: f64 = 0.0;
        for share_of_nyquist in [0.05, 0.1, 0.25, 1.0 / 3.0] {
            let w = std::f64::consts::PI * share_of_nyquist;
            let bound = 5.0 / 1024.0 * w.powi(6);
            let values: Vec<f64> = (0..100).map(|i| (w * f64::from(i)).sin()).collect();
            let signal = Sampled::from_start(&values, 1.0);
            for k in 100..900 {
                let p = f64::from(k) * 0.1;
                let error = (signal.at(p) - (w * p).sin()).abs();
                assert!(
                    error <= bound + ROUNDING,
                    "{share_of_nyquist}: {error} at {p}"
                );
                largest = largest.max(error / bound);
            }
        }
        // The bound is no larger than it must be.
        assert!(largest > 0.8, "{largest}");
    }
}
