//! Filters that take from discrepancies what noise of the inputs has left in them.
//!
//! On a plant without a spring, noise of a force makes a random walk: over a record it leads the true model far away from the
//! machine, and the squares of that say little of anything else. What every sample adds to what those before it let expect
//! is white again, and the best estimate is that of white residuals:
//!
//! ```text
//! r′_n = r_n + Σ_k a_k r_{n−k},   k = 1 … p                               (1)
//! ```
//!
//! a_k are the coefficients of the autoregressive process that has the autocovariance of the noise for p lags, by the
//! recursion of Levinson and Durbin. They are those of the discrepancy and of every sensitivity alike, so that everything
//! that is told of white residuals holds.
//!
//! References: \[Ljung1999\], chapter 3 (noise models and prediction errors); \[Durbin1960\].

/// One filter (1) for each channel; none where there are no coefficients.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Whitening(Vec<Vec<f64>>);

/// Part of the variance at lag zero that is added to it: keeps the recursion sound where a walk is all there is.
const LEAST_WHITE: f64 = 1e-9;

impl Whitening {
    /// The filters of noise of which realisations are known: for each channel some signals, in which that part of the noise
    /// shows that has a colour, and the variance of the rest, which is white.
    #[must_use]
    pub fn of_noise(coloured: &[Vec<&[f64]>], white_variance: &[f64], order: usize) -> Whitening {
        let channels = coloured.iter().zip(white_variance);
        let filter = |(signals, white): (&Vec<&[f64]>, &f64)| {
            let mut covariance = autocovariance(signals, order);
            covariance[0] += white.max(LEAST_WHITE * covariance[0]);
            levinson_durbin(&covariance)
        };
        Whitening(channels.map(filter).collect())
    }

    /// Samples at the beginning of a channel for which the filter lacks some of those before.
    #[must_use]
    pub fn order(&self, channel: usize) -> usize {
        self.0.get(channel).map_or(0, Vec::len)
    }

    /// What the samples before let expect of the next one, −Σ a_k r_{n−k} of (1).
    pub(crate) fn expected(&self, channel: usize, before: &[f64]) -> f64 {
        let coefficients = self.0.get(channel).map_or(&[][..], Vec::as_slice);
        let products = before.iter().rev().zip(coefficients).map(|(r, a)| a * r);
        -products.sum::<f64>()
    }

    /// Filters a signal of a channel, (1), with zeros before its beginning.
    pub fn apply(&self, channel: usize, signal: &mut [f64]) {
        let Some(coefficients) = self.0.get(channel).filter(|a| !a.is_empty()) else {
            return;
        };
        // From the end: what is still to come has not been filtered.
        for n in (0..signal.len()).rev() {
            let before = signal[..n].iter().rev().zip(coefficients);
            signal[n] += before.map(|(r, a)| a * r).sum::<f64>();
        }
    }
}

/// c_k = mean of r_n r_{n+k} over all samples of all signals, k up to `order`.
fn autocovariance(signals: &[&[f64]], order: usize) -> Vec<f64> {
    let count: usize = signals.iter().map(|signal| signal.len()).sum();
    let at = |lag: usize| {
        let products = signals.iter().map(|signal| {
            let later = signal.get(lag..).unwrap_or_default();
            signal.iter().zip(later).map(|(a, b)| a * b).sum::<f64>()
        });
        products.sum::<f64>() / count.max(1) as f64
    };
    (0..=order).map(at).collect()
}

/// The coefficients a_1 … a_p of the autoregressive process with an autocovariance c_0 … c_p. The recursion ends early where
/// nothing is left to be explained.
fn levinson_durbin(covariance: &[f64]) -> Vec<f64> {
    let mut a: Vec<f64> = vec![];
    let mut left = covariance[0];
    for k in 1..covariance.len() {
        let known: f64 = a
            .iter()
            .enumerate()
            .map(|(i, a)| a * covariance[k - 1 - i])
            .sum();
        let reflection = -(covariance[k] + known) / left;
        // Not a number where nothing is left.
        if reflection.is_nan() || reflection.abs() >= 1.0 {
            break;
        }
        let mirrored: Vec<f64> = a.iter().rev().map(|a| reflection * a).collect();
        a.iter_mut().zip(mirrored).for_each(|(a, m)| *a += m);
        a.push(reflection);
        left *= 1.0 - reflection * reflection;
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    /// r_n = 1.5 r_{n−1} − 0.7 r_{n−2} + e: c_1 = c_0 1.5 / 1.7, and the recursion of the process beyond.
    #[test]
    fn verify_an_autoregressive_process_is_found_by_its_autocovariance() {
        let mut covariance = vec![1.0, 1.5 / 1.7];
        for k in 2..6 {
            covariance.push(1.5 * covariance[k - 1] - 0.7 * covariance[k - 2]);
        }
        let found = levinson_durbin(&covariance);
        let needed = [-1.5, 0.7, 0.0, 0.0, 0.0];
        assert_eq!(found.len(), needed.len());
        for (found, needed) in found.iter().zip(needed) {
            assert!((found - needed).abs() < 1e-9, "{found} for {needed}");
        }
    }

    fn noise(len: usize) -> Vec<f64> {
        let mut word = 5_u64;
        let mut next = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..len).map(|_| next()).collect()
    }

    /// A walk beside white noise is white after the filter of another such walk.
    #[test]
    fn a_walk_beside_noise_of_the_sensor_becomes_white() {
        let walk = |seed: &[f64]| -> Vec<f64> {
            let mut at = 0.0;
            seed.iter()
                .map(|step| {
                    at += step;
                    at
                })
                .collect()
        };
        let all = noise(30_000);
        let (model, rest) = all.split_at(10_000);
        let (steps, sensor) = rest.split_at(10_000);
        let walked = walk(model);
        // Uniform noise of width w has the variance w²/12.
        let whitening = Whitening::of_noise(&[vec![&walked]], &[4.0 / 12.0], 24);
        let mut left: Vec<f64> = walk(steps)
            .iter()
            .zip(sensor)
            .map(|(x, e)| x + 2.0 * e)
            .collect();
        let first = left.clone();
        whitening.apply(0, &mut left);
        let correlation = |signal: &[f64]| {
            let product: f64 = signal.windows(2).map(|pair| pair[0] * pair[1]).sum();
            product / signal.iter().map(|r| r * r).sum::<f64>()
        };
        assert!(correlation(&first) > 0.99);
        let whitened = correlation(&left[whitening.order(0)..]);
        assert!(whitened.abs() < 0.03, "{whitened}");
        // Where there are no coefficients nothing is filtered.
        let mut same = first.clone();
        Whitening::default().apply(0, &mut same);
        assert_eq!(same, first);
    }
}
