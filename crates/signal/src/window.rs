//! Cosine-sum windows, their gains and the shape of their spectral lobe.

use crate::SignalError;

/// A cosine-sum window in its periodic (DFT-even) form.
///
/// ```text
/// w_n = Σ_k (-1)^k a_k cos(2π k n / N),   n = 0 … N-1
/// ```
///
/// | Window | a_k | NENBW in bins | reference |
/// |---|---|---|---|
/// | `Rectangular` | 1 | 1 | Harris1978 |
/// | `Hann` | 0.5, 0.5 | 1.5 | Harris1978 |
/// | `Hamming` | 0.54, 0.46 | 1.3628 | Harris1978 |
/// | `BlackmanHarris` | 0.35875, 0.48829, 0.14128, 0.01168 | 2.0044 | Harris1978 |
/// | `FlatTop` | (1, 1.93, 1.29, 0.388, 0.028) / 4.636 | 3.7702 | FTSRS of Heinzel2002 |
///
/// `FlatTop` reads the amplitude of a line between bins within 0.18 %; `Hann` is the usual
/// choice for averaged spectra; `BlackmanHarris` keeps leakage below -92 dB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Window {
    /// All ones: best noise bandwidth, worst leakage.
    Rectangular,
    /// Raised cosine: leakage falls with the cube of the distance.
    #[default]
    Hann,
    /// Raised cosine on a pedestal: lowest first side lobe of the two-term windows.
    Hamming,
    /// Minimum four-term Blackman-Harris: side lobes below -92 dB.
    BlackmanHarris,
    /// Five-term flat top: the amplitude between bins is right within 0.18 %.
    FlatTop,
}

impl Window {
    /// Every window, in order of increasing noise bandwidth but for Hann and Hamming.
    pub const ALL: [Window; 5] = [
        Window::Rectangular,
        Window::Hann,
        Window::Hamming,
        Window::BlackmanHarris,
        Window::FlatTop,
    ];

    /// The coefficients a_k, all taken positive.
    #[must_use]
    pub const fn cosine_terms(self) -> &'static [f64] {
        const SUM: f64 = 4.636;
        match self {
            Window::Rectangular => &[1.0],
            Window::Hann => &[0.5, 0.5],
            Window::Hamming => &[0.54, 0.46],
            Window::BlackmanHarris => &[0.358_75, 0.488_29, 0.141_28, 0.011_68],
            Window::FlatTop => &[1.0 / SUM, 1.93 / SUM, 1.29 / SUM, 0.388 / SUM, 0.028 / SUM],
        }
    }

    /// The `len` weights of the window.
    ///
    /// # Errors
    ///
    /// [`SignalError::TooShort`] when `len` does not exceed twice the number of cosine terms less
    /// one: below that the terms alias into each other and the gains no longer hold.
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_signal::Window;
    /// let w = Window::Hann.coefficients(8)?;
    /// assert_eq!(w[0], 0.0);
    /// assert!((w[4] - 1.0).abs() < 1e-15);
    /// # Ok::<(), simgap_signal::SignalError>(())
    /// ```
    pub fn coefficients(self, len: usize) -> Result<Vec<f64>, SignalError> {
        let needed = self.min_len();
        if len < needed {
            return Err(SignalError::TooShort {
                what: "window",
                found: len,
                needed,
            });
        }
        let step = std::f64::consts::TAU / len as f64;
        let terms = self.cosine_terms();
        Ok((0..len)
            .map(|n| cosine_sum(terms, (n as f64 * step).cos()))
            .collect())
    }

    /// Fewest samples for which gain and bandwidth hold exactly.
    #[must_use]
    pub const fn min_len(self) -> usize {
        2 * self.cosine_terms().len() - 1
    }

    /// Mean of the weights, a_0: what a line is multiplied by.
    #[must_use]
    pub const fn coherent_gain(self) -> f64 {
        self.cosine_terms()[0]
    }

    /// Mean square of the weights, a_0² + ½ Σ a_k²: what noise power is multiplied by.
    #[must_use]
    pub fn power_gain(self) -> f64 {
        self.squared_term(0)
    }

    /// Noise-equivalent bandwidth N Σ w² / (Σ w)², in bins.
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_signal::Window;
    /// assert!((Window::Hann.noise_bandwidth_bins() - 1.5).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn noise_bandwidth_bins(self) -> f64 {
        self.power_gain() / self.coherent_gain().powi(2)
    }

    /// Half the width of the main lobe between its zeros, in bins.
    #[must_use]
    pub const fn main_lobe_half_width_bins(self) -> usize {
        self.cosine_terms().len()
    }

    /// Spectral lobe at a distance from the line, divided by N, for N much larger than the lobe.
    ///
    /// ```text
    /// W(δ) = sin(πδ)/π [ a_0/δ + ½ Σ_{k≥1} a_k ( 1/(δ-k) + 1/(δ+k) ) ],   W(0) = a_0,  W(±k) = ± … a_k/2
    /// ```
    ///
    /// The time origin is the middle of the window, which makes W real.
    #[must_use]
    pub fn lobe(self, offset_bins: f64) -> f64 {
        let mut sum = 0.0;
        for (k, a) in self.cosine_terms().iter().enumerate() {
            let k = k as f64;
            sum += if k == 0.0 {
                a * sinc(offset_bins)
            } else {
                0.5 * a * (sinc(offset_bins - k) + sinc(offset_bins + k))
            };
        }
        sum
    }

    /// Upper envelope of |[`lobe`](Self::lobe)| beyond the main lobe, relative to the peak.
    pub(crate) fn leakage_envelope(self, offset_bins: f64) -> f64 {
        let d = offset_bins.abs();
        if d < self.main_lobe_half_width_bins() as f64 {
            return 1.0;
        }
        let mut sum = 0.0;
        let mut sign = -1.0;
        for (k, a) in self.cosine_terms().iter().enumerate() {
            let k = k as f64;
            sign = -sign;
            // At δ = k the pole of the envelope is cut at half a bin.
            let near = (d - k).max(0.5);
            sum += sign * 0.5 * a * (1.0 / near + 1.0 / (d + k));
        }
        (sum / std::f64::consts::PI).abs() / self.coherent_gain()
    }

    /// Fourier coefficient of the squared window (centred) at `m` bins: covariance of noise in
    /// two bins `m` apart, in units of σ² N.
    pub(crate) fn squared_term(self, m: usize) -> f64 {
        let a = self.cosine_terms();
        let reach = a.len() as isize - 1;
        let c = |k: isize| -> f64 {
            let k = k.unsigned_abs();
            match k {
                0 => a[0],
                k if k < a.len() => 0.5 * a[k],
                _ => 0.0,
            }
        };
        (-reach..=reach).map(|k| c(k) * c(m as isize - k)).sum()
    }
}

/// Σ_k (-1)^k a_k cos(kθ) from c = cos θ by cos((k+1)θ) = 2c cos(kθ) - cos((k-1)θ).
fn cosine_sum(terms: &[f64], c: f64) -> f64 {
    let (mut before, mut here, mut sign, mut sum) = (c, 1.0, 1.0, 0.0);
    for a in terms {
        sum += sign * a * here;
        (before, here) = (here, 2.0 * c * here - before);
        sign = -sign;
    }
    sum
}

/// sin(πx)/(πx).
fn sinc(x: f64) -> f64 {
    let y = std::f64::consts::PI * x;
    if y.abs() < 1e-4 {
        1.0 - y * y / 6.0
    } else {
        y.sin() / y
    }
}
