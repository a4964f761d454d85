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

    /// By how many samples all positions lie behind, where that is the same for all.
    fn behind(&self, signal: &Sampled<'_>) -> Option<f64> {
        let _ = signal;
        None
    }

    /// See [`SignalMap::lives_in_single_samples`].
    fn counts_samples(&self) -> bool {
        false
    }
}

impl<T: Retiming> SignalMap for T {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        match self.behind(&signal) {
            Some(behind) => signal.shifted(behind),
            None => signal.moved(|i| self.position(&signal, i)),
        }
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

    /// The values so many samples behind each, by [`Sampled::at`], whose weights are the same for all away from the ends.
    fn shifted(&self, behind: f64) -> Vec<f64> {
        let len = self.values.len();
        let whole = behind.ceil().clamp(-(len as f64), len as f64);
        let weights = weights(BEFORE as f64 + (whole - behind));
        // The first of the six points of the sample i is i − back.
        let back = whole as isize + BEFORE as isize;
        let on_record = |i: isize| i.clamp(0, len as isize) as usize;
        let start = on_record(back);
        let end = on_record(len as isize - POINTS as isize + 1 + back).max(start);
        let at = |i: usize| self.at(i as f64 - behind);
        let around = self.values.windows(POINTS).skip(on_record(-back));
        let inside = around
            .take(end - start)
            .map(|points| product(points, &weights));
        (0..start)
            .map(at)
            .chain(inside)
            .chain((end..len).map(at))
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
        if last + 1 < POINTS {
            let left = (position as usize).min(last.saturating_sub(1));
            let right = (left + 1).min(last);
            let fraction = position - left as f64;
            return self.values[left] + fraction * (self.values[right] - self.values[left]);
        }
        let first = (position as usize)
            .saturating_sub(BEFORE)
            .min(last + 1 - POINTS);
        let weights = weights(position - first as f64);
        product(&self.values[first..first + POINTS], &weights)
    }
}

/// Points of the polynomial between two samples.
pub(crate) const POINTS: usize = 6;
/// Those before the interval.
pub(crate) const BEFORE: usize = 2;

/// The weights of six points for a position among them, 0 that of the first: at a sample exactly 0 and 1.
fn weights(p: f64) -> [f64; POINTS] {
    let d: [f64; POINTS] = std::array::from_fn(|j| p - j as f64);
    // Πⱼ≠ᵢ (i − j) for six equidistant points.
    const DENOMINATOR: [f64; POINTS] = [-120.0, 24.0, -12.0, 12.0, -24.0, 120.0];
    std::array::from_fn(|i| {
        let others = d.iter().enumerate().filter(|(j, _)| *j != i);
        others.fold(1.0, |product, (_, factor)| product * factor) / DENOMINATOR[i]
    })
}

#[inline(always)]
fn product(points: &[f64], weights: &[f64; POINTS]) -> f64 {
    let points = points.iter().zip(weights);
    points.fold(0.0, |sum, (value, weight)| sum + value * weight)
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

    #[test]
    fn verify_a_constant_shift_is_that_of_each_sample() {
        for len in [1_usize, 4, 6, 7, 40] {
            let values: Vec<f64> = (0..len).map(|i| (0.4 * i as f64).sin() + 3.0).collect();
            let signal = Sampled::from_start(&values, 1.0);
            for behind in [0.0, 0.25, 3.0, 7.6, -0.4, -5.0, -12.3, 39.5, 500.0, -500.0] {
                let shifted = signal.shifted(behind);
                let moved = signal.moved(|i| i as f64 - behind);
                assert_eq!(shifted.len(), len);
                for (one, other) in shifted.iter().zip(&moved) {
                    assert!((one - other).abs() < 1e-13, "{len} {behind}: {one} {other}");
                }
            }
        }
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
