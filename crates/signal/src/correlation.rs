//! Autocorrelation, the number of independent samples a coloured residual is worth, and the correlation of two signals.

use rustfft::FftPlanner;

use crate::real_fft::real_fft;
use crate::{Complex64, SignalError, check};

/// Autocorrelation at lags 0 … `max_lag`, normalised to 1 at lag 0.
///
/// ```text
/// ρ_k = Σ_{n<N-k} (x_n - x̄)(x_{n+k} - x̄) / Σ_n (x_n - x̄)²
/// ```
///
/// The divisor does not shrink with the lag (the biased estimate, positive semidefinite). O(N log N).
///
/// # Errors
///
/// [`SignalError::TooShort`] unless the record is longer than `max_lag` (and than one sample),
/// [`SignalError::NonFinite`], [`SignalError::Flat`].
///
/// # Examples
///
/// ```
/// use simgap_signal::correlation::autocorrelation;
/// let rho = autocorrelation(&[1.0, -1.0, 1.0, -1.0], 2)?;
/// assert!((rho[1] + 0.75).abs() < 1e-12 && (rho[2] - 0.5).abs() < 1e-12);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn autocorrelation(values: &[f64], max_lag: usize) -> Result<Vec<f64>, SignalError> {
    check::finite("values", values, (max_lag + 1).max(2))?;
    if values.iter().all(|&v| v == values[0]) {
        return Err(SignalError::Flat { what: "values" });
    }
    // Zeros at the end keep the circular correlation from wrapping round.
    let len = (values.len() + max_lag).next_power_of_two();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let mut padded = vec![0.0; len];
    for (p, v) in padded.iter_mut().zip(values) {
        *p = v - mean;
    }
    let half = real_fft(&padded);
    let mut power: Vec<Complex64> = (0..len)
        .map(|k| Complex64::new(half[k.min(len - k)].norm_sqr(), 0.0))
        .collect();
    // Real and even: the forward transform is the backward one.
    FftPlanner::new().plan_fft_forward(len).process(&mut power);
    let at_zero = power[0].re;
    if at_zero <= 0.0 {
        return Err(SignalError::Flat { what: "values" });
    }
    Ok(power[..=max_lag].iter().map(|z| z.re / at_zero).collect())
}

/// Correlation of a signal with an earlier one of the same length at lags 0 … `max_lag`, not normalised.
///
/// ```text
/// c_k = Σ_{n<N-k} x_{n+k} y_n
/// ```
///
/// In the square of the unit of both. O(N log N).
///
/// # Errors
///
/// [`SignalError::TooShort`] unless both are longer than `max_lag`, [`SignalError::LengthMismatch`], [`SignalError::NonFinite`].
///
/// # Examples
///
/// ```
/// use simgap_signal::correlation::cross_correlation;
/// let c = cross_correlation(&[0.0, 1.0, 2.0, 3.0], &[1.0, 2.0, 3.0, 4.0], 2)?;
/// for (found, exact) in c.iter().zip([20.0, 14.0, 8.0]) {
///     assert!((found - exact).abs() < 1e-12);
/// }
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn cross_correlation(
    signal: &[f64],
    earlier: &[f64],
    max_lag: usize,
) -> Result<Vec<f64>, SignalError> {
    check::finite("signal", signal, max_lag + 1)?;
    check::finite("earlier", earlier, max_lag + 1)?;
    check::same_len("earlier", earlier.len(), "signal", signal.len())?;
    let products = cross_products(earlier, signal);
    Ok(products[..=max_lag].iter().map(|z| z.re).collect())
}

/// A signal without its mean.
pub(crate) fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|v| v - mean).collect()
}

/// Σ_i t_i c_{i+m} at index m (negative m from the end).
pub(crate) fn cross_products(t: &[f64], c: &[f64]) -> Vec<Complex64> {
    let len = (2 * t.len()).next_power_of_two();
    let mut planner = FftPlanner::new();
    let forward = planner.plan_fft_forward(len);
    let transform = |values: &[f64]| {
        let mut z = vec![Complex64::ZERO; len];
        for (z, v) in z.iter_mut().zip(values) {
            z.re = *v;
        }
        forward.process(&mut z);
        z
    };
    let t_bins = transform(t);
    let mut product = transform(c);
    for (p, t_k) in product.iter_mut().zip(&t_bins) {
        *p *= t_k.conj() / len as f64;
    }
    planner.plan_fft_inverse(len).process(&mut product);
    product
}

/// Number of independent samples with the same variance of the mean as this residual.
///
/// ```text
/// Γ_m = ρ_{2m} + ρ_{2m+1},  summed while positive (initial positive sequence)
/// τ   = -1 + 2 Σ_m Γ_m,     N_eff = N / τ,   kept between 1 and N
/// ```
///
/// White noise gives N; first-order noise of coefficient φ gives N (1-φ)/(1+φ). A residual that
/// alternates is worth no more than N here, since the number serves to discount evidence.
/// Reference: Geyer1992.
///
/// # Errors
///
/// As [`autocorrelation`], for at least 8 samples.
///
/// # Examples
///
/// ```
/// use simgap_signal::correlation::effective_sample_count;
/// let slow: Vec<f64> = (0..1000).map(|n| (0.01 * n as f64).sin()).collect();
/// assert!(effective_sample_count(&slow)? < 10.0);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn effective_sample_count(residual: &[f64]) -> Result<f64, SignalError> {
    check::finite("residual", residual, 8)?;
    let n = residual.len();
    let rho = autocorrelation(residual, n - 1)?;
    let sum: f64 = rho
        .chunks_exact(2)
        .map(|pair| pair[0] + pair[1])
        .take_while(|gamma| *gamma > 0.0)
        .sum();
    let tau = 2.0 * sum - 1.0;
    Ok((n as f64 / tau.max(1.0)).max(1.0))
}

/// Number of independent samples that the variance of a residual holds.
///
/// ```text
/// n = 4 (Σ_k P_k)² / Σ_k P_k²,   k = 1 … ⌊(N-1)/2⌋,   kept between 1 and N
/// ```
///
/// P is the periodogram without the mean. This is 2 B T with the statistical bandwidth B = (∫ G df)² / ∫ G² df of a power
/// spectral density G and the length T of the record; the square of a bin of a periodogram is twice that of its expectation, which
/// the other factor of two is for. White noise gives N, first-order noise of coefficient φ gives N (1-φ²)/(1+φ²), and a line four to
/// twelve samples, by where it lies between two bins. Other than [`effective_sample_count`], which is that of a mean, it counts what a narrow band holds wherever
/// the band lies. What alternates from sample to sample lies in none of the bins, and is worth no more than N here too.
///
/// Reference: BendatPiersol2010, chapter 8.
///
/// # Errors
///
/// [`SignalError::TooShort`] for fewer than 8 samples, [`SignalError::NonFinite`], [`SignalError::Flat`].
///
/// # Examples
///
/// ```
/// use simgap_signal::correlation::independent_sample_count;
/// let line: Vec<f64> = (0..1000).map(|n| (0.5 * n as f64).sin()).collect();
/// assert!((4.0..12.5).contains(&independent_sample_count(&line)?));
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn independent_sample_count(residual: &[f64]) -> Result<f64, SignalError> {
    check::finite("residual", residual, 8)?;
    if residual.iter().all(|&v| v == residual[0]) {
        return Err(SignalError::Flat { what: "residual" });
    }
    let count = residual.len();
    let half = real_fft(&centred(residual));
    let bins = half.iter().take(count.div_ceil(2)).skip(1);
    let (sum, square) = bins
        .map(|bin| bin.norm_sqr())
        .fold((0.0, 0.0), |(sum, square), power| {
            (sum + power, square + power * power)
        });
    // What alternates from sample to sample has no other bins.
    let independent = if square > 0.0 {
        4.0 * sum * sum / square
    } else {
        count as f64
    };
    Ok(independent.clamp(1.0, count as f64))
}
