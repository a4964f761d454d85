//! Robust estimates of the white measurement noise on a record.

use std::f64::consts::LN_2;

use crate::spectrum::periodogram;
use crate::{SignalError, Trend, Window, check};

/// Fewest samples of a noise estimate: below that a median over the upper band means little.
const FEWEST: usize = 64;
/// Order of the differences in [`white_noise_std`].
const ORDER: usize = 6;
/// Standard deviation over median absolute value of a normal variable, 1 / Φ⁻¹(3/4).
const MEDIAN_TO_STD: f64 = 1.482_602_218_505_602;

/// Two estimates of the standard deviation of white noise, and the one to use.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WhiteNoise {
    /// From sixth differences.
    pub by_differences: f64,
    /// From the median of the spectrum in the upper half of the band.
    pub by_spectrum: f64,
    /// The smaller of the two: what each mistakes for noise only makes it larger.
    pub std: f64,
}

/// Standard deviation of the white noise on an oversampled smooth signal, or of a residual.
///
/// | Estimate | Holds when | Fooled (too large) by |
/// |---|---|---|
/// | [`noise_std_by_differences`] | nearly all of the signal lies below fs/10 | a line near fs/2; kinks and spikes in more than about one sample in fifty |
/// | [`noise_std_by_spectrum`] | the signal leaves half of the bins above fs/4 free | spikes, steps, broadband motion |
///
/// Both are too small when the noise itself is low-pass filtered (an anti-alias filter well below
/// fs/2) or less than a step of quantisation.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 64 samples, [`SignalError::NonFinite`].
///
/// # Examples
///
/// ```
/// use simgap_signal::noise::white_noise_std;
/// let mut state = 1u64;
/// let x: Vec<f64> = (0..4000)
///     .map(|n| {
///         state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
///         let uniform = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
///         5.0 * (0.05 * n as f64).sin() + 0.01 * 12f64.sqrt() * uniform
///     })
///     .collect();
/// // Uniform noise of standard deviation 0.01; its sixth differences are close to normal.
/// assert!((white_noise_std(&x)?.std / 0.01 - 1.0).abs() < 0.1);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn white_noise_std(values: &[f64]) -> Result<WhiteNoise, SignalError> {
    let by_differences = noise_std_by_differences(values, ORDER)?;
    let by_spectrum = noise_std_by_spectrum(values)?;
    Ok(WhiteNoise {
        by_differences,
        by_spectrum,
        std: by_differences.min(by_spectrum),
    })
}

/// Noise from the differences of a given order, by their median.
///
/// ```text
/// d_n = Σ_j (-1)^j C(p,j) x_{n+j},    var d = C(2p,p) σ²  for white noise
/// σ   = 1.4826 · median|d| / √C(2p,p)
/// ```
///
/// A line at f is damped by (2 sin(π f/fs))^p / √C(2p,p): 3·10⁻⁵ at fs/20 and 2·10⁻³ at fs/10 with
/// p = 6. The median stands for normal noise: with quantisation coarser than the noise it is wrong, and
/// zero when most differences vanish.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 64 samples, [`SignalError::NonFinite`], [`SignalError::OutOfRange`] for
/// an order outside 1 … 12.
///
/// # Examples
///
/// ```
/// use simgap_signal::noise::noise_std_by_differences;
/// let parabola: Vec<f64> = (0..100).map(|n| (n * n) as f64).collect();
/// assert_eq!(noise_std_by_differences(&parabola, 3)?, 0.0);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn noise_std_by_differences(values: &[f64], order: usize) -> Result<f64, SignalError> {
    check::finite("values", values, FEWEST)?;
    if !(1..=12).contains(&order) {
        return Err(SignalError::OutOfRange {
            what: "order",
            value: order as f64,
            needed: "a whole number from 1 to 12",
        });
    }
    let mut d = values.to_vec();
    for _ in 0..order {
        for i in 0..d.len() - 1 {
            d[i] = d[i + 1] - d[i];
        }
        d.pop();
    }
    d.iter_mut().for_each(|v| *v = v.abs());
    // C(2p,p) = Π (p+i)/i
    let gain: f64 = (1..=order).map(|i| (order + i) as f64 / i as f64).product();
    Ok(MEDIAN_TO_STD * check::median(&mut d) / gain.sqrt())
}

/// Noise from the median of the periodogram (Hann window, straight line removed) between fs/4 and fs/2.
///
/// ```text
/// σ² = fs/2 · median(P) / ln 2       (P of noise is exponentially distributed: median = ln 2 · mean)
/// ```
///
/// Lines in less than half of those bins do not matter, wherever they lie.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 64 samples, [`SignalError::NonFinite`].
///
/// # Examples
///
/// ```
/// use simgap_signal::noise::noise_std_by_spectrum;
/// let smooth: Vec<f64> = (0..1000).map(|n| (0.1 * n as f64).sin()).collect();
/// assert!(noise_std_by_spectrum(&smooth)? < 1e-6);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn noise_std_by_spectrum(values: &[f64]) -> Result<f64, SignalError> {
    check::finite("values", values, FEWEST)?;
    let psd = periodogram(values, 1.0, Window::Hann, Trend::Linear)?;
    // The last bin has one degree of freedom where the others have two.
    let last = psd.density.len() - 1;
    let mut upper = psd.density[last / 2..last].to_vec();
    Ok((0.5 * check::median(&mut upper) / LN_2).sqrt())
}

/// How far the spectrum falls towards fs/2: median of the periodogram (Hann window, straight line removed)
/// in fs/8 … fs/4 and in fs/4 … 3 fs/8, each over that in 3 fs/8 … fs/2.
///
/// Both are near one where the upper band holds white noise and nothing else; low-pass filtered noise that fills
/// the band gives more, and [`white_noise_std`] takes its end for noise.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 64 samples, [`SignalError::NonFinite`].
///
/// # Examples
///
/// ```
/// use simgap_signal::noise::fall_of_spectrum;
/// let mut state = 1u64;
/// let mut uniform = || {
///     state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
///     (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
/// };
/// let white: Vec<f64> = (0..4000).map(|_| uniform()).collect();
/// assert!(fall_of_spectrum(&white)?.iter().all(|fall| (fall - 1.0).abs() < 0.3));
/// // Through a filter of the first order, x[n] = 0.7 x[n-1] + w[n].
/// let mut x = 0.0;
/// let filtered: Vec<f64> = white.iter().map(|w| { x = 0.7 * x + w; x }).collect();
/// assert!(fall_of_spectrum(&filtered)?[0] > 2.0);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn fall_of_spectrum(values: &[f64]) -> Result<[f64; 2], SignalError> {
    check::finite("values", values, FEWEST)?;
    let psd = periodogram(values, 1.0, Window::Hann, Trend::Linear)?;
    let last = psd.density.len() - 1;
    let between = |from: usize, to: usize| {
        let mut band = psd.density[from * last / 4..to * last / 4].to_vec();
        check::median(&mut band)
    };
    let top = between(3, 4);
    Ok([between(1, 2) / top, between(2, 3) / top])
}
