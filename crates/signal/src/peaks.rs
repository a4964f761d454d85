//! Lines that stand out of the noise of a [`Spectrum`], located between the bins.

use std::f64::consts::{LN_2, PI};

use crate::spectrum::Spectrum;
use crate::{Complex64, SignalError, check};

/// How peaks are found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PeakOptions {
    /// Probability that a record of pure white noise yields any peak at all, between 0 and 1.
    pub false_alarm_probability: f64,
    /// Bins on each side of a peak from which the local noise level is taken.
    pub noise_reach_bins: usize,
    /// Peaks smaller than this are left out, whatever the noise (unit of the values).
    pub min_amplitude: f64,
}

impl Default for PeakOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 1e-3,
            noise_reach_bins: 64,
            min_amplitude: 0.0,
        }
    }
}

/// One spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Peak {
    /// Bin of the local maximum.
    pub bin: usize,
    /// Frequency between the bins, Hz.
    pub freq_hz: f64,
    /// Amplitude of the line (half peak to peak), unit of the values.
    pub amplitude: f64,
    /// Phase of the cosine at the first sample, rad.
    pub phase_rad: f64,
    /// Standard error of the frequency of this estimator, Hz.
    pub freq_std_hz: f64,
    /// Standard error of the amplitude of this estimator, unit of the values.
    pub amplitude_std: f64,
    /// Cramér-Rao bound of the frequency (no unbiased estimator does better), Hz.
    pub freq_bound_hz: f64,
    /// Cramér-Rao bound of the amplitude, unit of the values.
    pub amplitude_bound: f64,
    /// Standard deviation of white noise with the density found around the line.
    pub local_noise_std: f64,
}

/// Finds the lines of a spectrum, in order of frequency.
///
/// 1. Local noise: amplitudes of pure noise obey E\[A²\] = 4 σ² B / N (B: noise-equivalent bandwidth
///    in bins) and A² is exponentially distributed, so that over the bins around the peak
///
/// ```text
/// σ² = N / (4 B) · median(A²) / ln 2
/// ```
///
/// 2. Threshold: K bins of noise stay below with probability 1 - p when A² > E\[A²\] L, L = ln(K/p). The
///    median of M bins scatters, with relative variance c² = B / (M ln² 2), which lets more noise
///    through by e^{L²c²/2}; so L (1 + L c²/2) is used.
/// 3. A peak is the largest bin within a main lobe, and must exceed twice the summed side lobes of
///    the larger peaks, so that leakage is not reported as lines.
/// 4. Place δ between bins from the three bins around the maximum, with the time origin in the
///    middle of the window, where the lobe W is real ([`crate::Window::lobe`]):
///
/// ```text
/// y_j = Re(Y_{k+j} conj Y_k) / |Y_k|,   (y_1 - y_-1) / y_0 = (W(1-δ) - W(1+δ)) / W(δ)
/// A   = 2/N Σ_j y_j W(j-δ) / Σ_j W(j-δ)²
/// ```
///
/// 5. `freq_std_hz`, `amplitude_std`: first-order propagation of white noise of variance σ² in the three
///    (correlated) bins through step 4. The Cramér-Rao bounds (RifeBoorstyn1974) are
///
/// ```text
/// std f ≥ fs/(2π) √( 24 σ² / (A² N (N²-1)) ),   std A ≥ σ √(2/N)
/// ```
///
/// The standard errors stay above the bounds, since only three bins are used and a window throws
/// information away: averaged over δ, the frequency scatters by 1.25 (rectangular), 1.96 (Hann) and
/// 2.62 (Blackman-Harris) times the bound. Beside a rectangular window the side lobes of the line
/// pass for noise, so that its standard errors come out too large.
///
/// Lines within a main lobe of 0 Hz or of fs/2 are not reported: there a line cannot be told from what
/// is left of the mean, or from its own mirror image. Valid for lines at least a main lobe away
/// from each other; the leakage of the mirror line at -f is not corrected.
///
/// # Errors
///
/// [`SignalError::OutOfRange`] for a probability outside 0 … 1 or a negative `min_amplitude`;
/// [`SignalError::TooShort`] for fewer bins than a main lobe and its noise need.
///
/// # Examples
///
/// ```
/// use simgap_signal::{Trend, Window, peaks::{PeakOptions, find_peaks}, spectrum::spectrum};
/// let x: Vec<f64> = (0..1000)
///     .map(|n| {
///         let t = n as f64 / 100.0;
///         let dither = ((n * 7919) % 101) as f64 / 101.0 - 0.5;
///         2.0 * (std::f64::consts::TAU * 3.14 * t).cos() + 0.01 * dither
///     })
///     .collect();
/// let s = spectrum(&x, 100.0, Window::Hann, Trend::Mean)?;
/// let peaks = find_peaks(&s, &PeakOptions::default())?;
/// let largest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
/// let line = largest.ok_or("no line")?;
/// assert!((line.freq_hz - 3.14).abs() < 1e-3 && (line.amplitude - 2.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_peaks(spectrum: &Spectrum, options: &PeakOptions) -> Result<Vec<Peak>, SignalError> {
    check_options(options)?;
    let half_width = spectrum.window.main_lobe_half_width_bins();
    let power: Vec<f64> = spectrum.amplitude.iter().map(|a| a * a).collect();
    let needed = 4 * half_width + 4;
    check::finite("spectrum", &power, needed)?;

    let log_odds = (power.len() as f64 / options.false_alarm_probability).ln();
    let bandwidth = spectrum.window.noise_bandwidth_bins();
    let mut candidates: Vec<(usize, f64)> = Vec::new();
    for k in half_width..power.len() - half_width {
        if spectrum.amplitude[k] < options.min_amplitude || !is_local_maximum(&power, k, half_width)
        {
            continue;
        }
        let (noise, count) = local_noise_power(&power, k, half_width, options.noise_reach_bins);
        let scatter = bandwidth / (count as f64 * LN_2 * LN_2);
        if power[k] > noise * log_odds * (1.0 + 0.5 * log_odds * scatter) {
            candidates.push((k, noise));
        }
    }
    candidates.sort_by(|a, b| power[b.0].total_cmp(&power[a.0]).then(a.0.cmp(&b.0)));

    let mut peaks: Vec<Peak> = Vec::new();
    for (k, noise) in candidates {
        let leakage: f64 = peaks
            .iter()
            .map(|p| {
                let offset = p.freq_hz / spectrum.bin_width_hz() - k as f64;
                p.amplitude * spectrum.window.leakage_envelope(offset)
            })
            .sum();
        if spectrum.amplitude[k] > 2.0 * leakage {
            peaks.push(refine(spectrum, k, noise));
        }
    }
    peaks.sort_by(|a, b| a.freq_hz.total_cmp(&b.freq_hz));
    Ok(peaks)
}

fn check_options(options: &PeakOptions) -> Result<(), SignalError> {
    let p = options.false_alarm_probability;
    if !(p > 0.0 && p < 1.0) {
        return Err(SignalError::OutOfRange {
            what: "false_alarm_probability",
            value: p,
            needed: "a number between 0 and 1",
        });
    }
    if !(options.min_amplitude >= 0.0 && options.min_amplitude.is_finite()) {
        return Err(SignalError::OutOfRange {
            what: "min_amplitude",
            value: options.min_amplitude,
            needed: "zero or a positive finite number",
        });
    }
    Ok(())
}

/// Largest bin within a main lobe; of equal bins the first.
fn is_local_maximum(power: &[f64], k: usize, half_width: usize) -> bool {
    let from = k.saturating_sub(half_width);
    let to = (k + half_width).min(power.len() - 1);
    (from..=to).all(|j| {
        if j < k {
            power[j] < power[k]
        } else {
            power[j] <= power[k]
        }
    })
}

/// E[A²] of the noise around bin `k` from the median over `reach` bins a side, the main lobe left out; and
/// the number of bins used.
fn local_noise_power(power: &[f64], k: usize, half_width: usize, reach: usize) -> (f64, usize) {
    let reach = reach.max(2 * half_width);
    let (from, to) = (
        k.saturating_sub(reach).max(1),
        (k + reach).min(power.len() - 2),
    );
    let mut around: Vec<f64> = (from..=to)
        .filter(|&j| j.abs_diff(k) > half_width)
        .map(|j| power[j])
        .collect();
    (check::median(&mut around) / LN_2, around.len())
}

/// Steps 4 and 5 of [`find_peaks`].
fn refine(spectrum: &Spectrum, k: usize, noise_power: f64) -> Peak {
    let window = spectrum.window;
    let n = spectrum.sample_count as f64;
    let (y, phase_mid) = centred_bins(spectrum, k);
    let (offset, amplitude) = locate(spectrum, y);

    // Covariance of the real parts of the centred bins in units of the amplitude spectrum:
    // y_j = 2/(N a_0) Re Y_j, and cov(Re Y_i, Re Y_j) = ½ σ² N q_{|i-j|}.
    let sigma2 = n * noise_power / (4.0 * window.noise_bandwidth_bins());
    let scale = 2.0 * sigma2 / (n * window.coherent_gain().powi(2));
    let step = 1e-4 * y[1];
    let mut gradient = [[0.0; 3]; 2];
    for j in 0..3 {
        let (mut up, mut down) = (y, y);
        up[j] += step;
        down[j] -= step;
        let (d_up, a_up) = locate(spectrum, up);
        let (d_down, a_down) = locate(spectrum, down);
        gradient[0][j] = (d_up - d_down) / (2.0 * step);
        gradient[1][j] = (a_up - a_down) / (2.0 * step);
    }
    let std = |g: [f64; 3]| -> f64 {
        let mut sum = 0.0;
        for i in 0..3 {
            for j in 0..3 {
                sum += g[i] * g[j] * window.squared_term(i.abs_diff(j));
            }
        }
        (scale * sum).max(0.0).sqrt()
    };
    let width = spectrum.bin_width_hz();
    let freq_hz = (k as f64 + offset) * width;
    let mid_time_s = 0.5 * n / spectrum.sample_rate_hz;
    Peak {
        bin: k,
        freq_hz,
        amplitude,
        phase_rad: wrap(phase_mid - 2.0 * PI * freq_hz * mid_time_s),
        freq_std_hz: width * std(gradient[0]),
        amplitude_std: std(gradient[1]),
        freq_bound_hz: spectrum.sample_rate_hz / (2.0 * PI)
            * (24.0 * sigma2 / (amplitude * amplitude * n * (n * n - 1.0))).sqrt(),
        amplitude_bound: (2.0 * sigma2 / n).sqrt(),
        local_noise_std: sigma2.sqrt(),
    }
}

/// The three bins around `k` with the time origin moved to sample N/2, projected on the phase of
/// bin `k`; and that phase.
fn centred_bins(spectrum: &Spectrum, k: usize) -> ([f64; 3], f64) {
    let n = spectrum.sample_count;
    let centred = |j: usize| -> Complex64 {
        // Ends of the one-sided spectrum carry half of what their neighbours do.
        let full = if j == 0 || 2 * j == n { 2.0 } else { 1.0 };
        let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        Complex64::from_polar(full * spectrum.amplitude[j], spectrum.phase_rad[j]) * sign
    };
    let middle = centred(k);
    let unit = middle / middle.norm();
    let project = |j: usize| (centred(j) * unit.conj()).re;
    (
        [project(k - 1), middle.norm(), project(k + 1)],
        middle.arg(),
    )
}

/// Offset from the middle bin (in bins) and amplitude of the line through three centred bins.
fn locate(spectrum: &Spectrum, y: [f64; 3]) -> (f64, f64) {
    let window = spectrum.window;
    let target = (y[2] - y[0]) / y[1];
    let ratio = |d: f64| (window.lobe(1.0 - d) - window.lobe(1.0 + d)) / window.lobe(d);
    // The ratio rises with δ; noise may push the target a little beyond half a bin.
    let (mut low, mut high) = (-0.75, 0.75);
    for _ in 0..60 {
        let mid = 0.5 * (low + high);
        if ratio(mid) < target {
            low = mid;
        } else {
            high = mid;
        }
    }
    let offset = 0.5 * (low + high);
    let (mut cross, mut square) = (0.0, 0.0);
    for (j, value) in y.iter().enumerate() {
        let w = window.lobe(j as f64 - 1.0 - offset);
        cross += value * w;
        square += w * w;
    }
    (offset, window.coherent_gain() * cross / square)
}

/// Angle in (-π, π].
fn wrap(angle: f64) -> f64 {
    let turns = (angle / (2.0 * PI)).round();
    angle - 2.0 * PI * turns
}
