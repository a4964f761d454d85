//! Harmonics of a known excitation frequency, and their images about the Nyquist frequency.

use crate::lines::{Line, LineFit, fit_lines};
use crate::{SignalError, check};

/// Least-squares amplitudes and phases of the harmonics 1 … `count` of an excitation, with mean and trend.
///
/// ```text
/// v(t) = c_0 + c_1 (t - t_mid) + Σ_{k=1}^{count} a_k cos(2π k f t) + b_k sin(2π k f t)
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | t | `time_s` | s | N |
/// | v | `values` | any | N |
/// | f | `excitation_hz` | Hz | |
///
/// Valid while count · f stays below half the sample rate; above it a harmonic is fitted at its
/// alias.
///
/// # Errors
///
/// As [`fit_lines`]; [`SignalError::TooShort`] for `count` = 0.
///
/// # Examples
///
/// ```
/// use simgap_signal::orders::fit_harmonics;
/// let t: Vec<f64> = (0..200).map(|n| 0.01 * n as f64).collect();
/// let v: Vec<f64> = t.iter().map(|t| (std::f64::consts::TAU * 3.0 * t).sin().powi(3)).collect();
/// let fit = fit_harmonics(&t, &v, 1.0, 9)?;
/// // sin³ x = ¾ sin x - ¼ sin 3x
/// assert!((fit.lines[2].sine - 0.75).abs() < 1e-12 && (fit.lines[8].sine + 0.25).abs() < 1e-12);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn fit_harmonics(
    time_s: &[f64],
    values: &[f64],
    excitation_hz: f64,
    count: usize,
) -> Result<LineFit, SignalError> {
    check::positive("excitation_hz", excitation_hz)?;
    if count == 0 {
        return Err(SignalError::TooShort {
            what: "harmonics",
            found: 0,
            needed: 1,
        });
    }
    let freqs: Vec<f64> = (1..=count).map(|k| k as f64 * excitation_hz).collect();
    fit_lines(time_s, values, &freqs)
}

/// A harmonic and its image about half the Nyquist frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ImagePair {
    /// Order k of the harmonic.
    pub order: usize,
    /// The line at k f; `None` at or above fs/2.
    pub direct: Option<Line>,
    /// The line at fs/2 - k f; `None` where that is not positive or coincides with a harmonic.
    pub image: Option<Line>,
}

/// Harmonics and images fitted together.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NyquistImages {
    /// One pair per order, from 1.
    pub pairs: Vec<ImagePair>,
    /// The common fit of all lines.
    pub fit: LineFit,
}

/// Lines at fs/2 - k f beside the harmonics k f, all fitted at once.
///
/// A record whose every other sample is late by τ (or scaled otherwise) is the even record plus
/// (-1)ⁿ times a multiple of its derivative (or value), and since
///
/// ```text
/// (-1)ⁿ cos(2π f n / fs) = cos(2π (fs/2 - f) n / fs)
/// late by τ:          image amplitude / direct amplitude = tan(π f τ)
/// gain 1 ± ε:         image amplitude / direct amplitude = ε
/// ```
///
/// each line f of the motion has an image exactly at fs/2 - f. Its growth with f tells timing from gain.
/// Fitting the images without the harmonics would let leakage of the latter in, so both are fitted.
///
/// An image closer than half a line width 1/(2T) to a harmonic (fs/2 a multiple of f, say) cannot be told
/// from it and is `None`.
///
/// # Errors
///
/// As [`fit_harmonics`], and [`SignalError::FrequencyRange`] when the excitation itself is not below fs/2.
///
/// # Examples
///
/// ```
/// use simgap_signal::orders::nyquist_image_lines;
/// let (fs, f, late_s) = (100.0, 3.0, 0.002);
/// let t: Vec<f64> = (0..1000).map(|n| n as f64 / fs).collect();
/// let v: Vec<f64> = (0..1000)
///     .map(|n| {
///         let actual = n as f64 / fs + if n % 2 == 1 { late_s } else { 0.0 };
///         (std::f64::consts::TAU * f * actual).cos()
///     })
///     .collect();
/// let images = nyquist_image_lines(&t, &v, fs, f, 2)?;
/// let pair = images.pairs[0];
/// let (direct, image) = pair.direct.zip(pair.image).ok_or("no line")?;
/// let ratio = image.amplitude / direct.amplitude;
/// assert!((ratio - (std::f64::consts::PI * f * late_s).tan()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn nyquist_image_lines(
    time_s: &[f64],
    values: &[f64],
    sample_rate_hz: f64,
    excitation_hz: f64,
    count: usize,
) -> Result<NyquistImages, SignalError> {
    check::positive("sample_rate_hz", sample_rate_hz)?;
    check::positive("excitation_hz", excitation_hz)?;
    check::finite("time_s", time_s, 2)?;
    if count == 0 {
        return Err(SignalError::TooShort {
            what: "harmonics",
            found: 0,
            needed: 1,
        });
    }
    let nyquist_hz = 0.5 * sample_rate_hz;
    if excitation_hz >= nyquist_hz {
        return Err(SignalError::FrequencyRange {
            what: "excitation_hz",
            freq_hz: excitation_hz,
            limit_hz: nyquist_hz,
        });
    }
    let half_width_hz = half_line_width_hz(time_s, sample_rate_hz);
    let harmonic = |k: usize| k as f64 * excitation_hz;
    let mut freqs: Vec<f64> = Vec::new();
    let mut slots: Vec<(Option<usize>, Option<usize>)> = vec![(None, None); count];
    for k in 1..=count {
        if harmonic(k) < nyquist_hz - half_width_hz {
            slots[k - 1].0 = Some(freqs.len());
            freqs.push(harmonic(k));
        }
    }
    for k in 1..=count {
        let image = nyquist_hz - harmonic(k);
        let free = (0..=count).all(|j| (image - harmonic(j)).abs() > half_width_hz);
        if image > 0.0 && free {
            slots[k - 1].1 = Some(freqs.len());
            freqs.push(image);
        }
    }
    let fit = fit_lines(time_s, values, &freqs)?;
    let pairs = slots
        .iter()
        .enumerate()
        .map(|(i, &(direct, image))| ImagePair {
            order: i + 1,
            direct: direct.map(|j| fit.lines[j]),
            image: image.map(|j| fit.lines[j]),
        })
        .collect();
    Ok(NyquistImages { pairs, fit })
}

/// 1/(2T), with T the span of the times and one sample.
fn half_line_width_hz(time_s: &[f64], sample_rate_hz: f64) -> f64 {
    let first = time_s.iter().copied().fold(f64::INFINITY, f64::min);
    let last = time_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 / (last - first + 1.0 / sample_rate_hz)
}
