//! Frequency response from measured input and output, with coherence and random error.

use crate::welch::{WelchOptions, cross_spectra};
use crate::{Complex64, SignalError};

/// Estimated frequency response, bin by bin.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frf {
    /// Frequency of each bin, Hz.
    pub freq_hz: Vec<f64>,
    /// H1 estimate: unbiased by noise on the output, too small with noise on the input.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial"))]
    pub h1: Vec<Complex64>,
    /// H2 estimate: unbiased by noise on the input, too large with noise on the output.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial"))]
    pub h2: Vec<Complex64>,
    /// Coherence γ², 0 … 1: part of the output power that is linear in the input.
    pub coherence: Vec<f64>,
    /// Relative random standard error of |H1|; infinite where nothing is coherent.
    pub magnitude_error: Vec<f64>,
    /// Random standard error of the phase of H1, rad (no more than that of an unknown angle, π/√3).
    pub phase_error_rad: Vec<f64>,
    /// Independent segments averaged.
    pub effective_averages: f64,
}

/// H1 and H2 estimates of the response of `output` to `input`.
///
/// ```text
/// H1 = S_xy / S_xx,    H2 = S_yy / S_yx,    γ² = |S_xy|² / (S_xx S_yy)
/// std|H1| / |H1| ≈ std arg H1 ≈ √(1 - γ²) / ( |γ| √(2 n) )
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | x | `input` | any | N |
/// | y | `output` | any | N |
/// | H | `h1`, `h2` | unit of y per unit of x | `segment_len`/2 + 1 |
/// | n | `effective_averages` | 1 | |
///
/// Random errors hold for errors up to about 0.3; bias from leakage (a resonance narrower than a few
/// bins, a delay not short against a segment) is not in them. A bin without input power gets H1 = H2 = 0,
/// coherence 0 and an infinite error. Reference: BendatPiersol2010, chapters 6 and 9.
///
/// # Errors
///
/// As [`crate::welch::cross_spectra`]; also [`SignalError::OutOfRange`] for fewer than two segments, whose
/// coherence is 1 whatever the data.
///
/// # Examples
///
/// ```
/// use simgap_signal::{frf::frf, welch::WelchOptions};
/// let x: Vec<f64> = (0..1000).map(|n| (((n * n) % 101) as f64).sin()).collect();
/// let y: Vec<f64> = x.iter().map(|v| 3.0 * v).collect();
/// let response = frf(&x, &y, 100.0, &WelchOptions::new(100))?;
/// assert!((response.h1[20].re - 3.0).abs() < 1e-9 && response.coherence[20] > 0.999_999);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn frf(
    input: &[f64],
    output: &[f64],
    sample_rate_hz: f64,
    options: &WelchOptions,
) -> Result<Frf, SignalError> {
    let s = cross_spectra(input, output, sample_rate_hz, options)?;
    if s.segments < 2 {
        return Err(SignalError::OutOfRange {
            what: "number of segments",
            value: s.segments as f64,
            needed: "2 or more",
        });
    }
    let bins = s.freq_hz.len();
    let mut out = Frf {
        freq_hz: s.freq_hz,
        h1: Vec::with_capacity(bins),
        h2: Vec::with_capacity(bins),
        coherence: Vec::with_capacity(bins),
        magnitude_error: Vec::with_capacity(bins),
        phase_error_rad: Vec::with_capacity(bins),
        effective_averages: s.effective_averages,
    };
    for k in 0..bins {
        let (xx, yy, xy) = (s.xx[k], s.yy[k], s.xy[k]);
        let coherent = xy.norm_sqr() > 0.0;
        let coherence = if coherent {
            (xy.norm_sqr() / (xx * yy)).min(1.0)
        } else {
            0.0
        };
        let error = if coherent {
            ((1.0 - coherence) / (2.0 * coherence * s.effective_averages)).sqrt()
        } else {
            f64::INFINITY
        };
        out.h1
            .push(if coherent { xy / xx } else { Complex64::ZERO });
        out.h2.push(if coherent {
            yy / xy.conj()
        } else {
            Complex64::ZERO
        });
        out.coherence.push(coherence);
        out.magnitude_error.push(error);
        out.phase_error_rad
            .push(error.min(std::f64::consts::PI / 3f64.sqrt()));
    }
    Ok(out)
}
