//! Spectra as `ndarray` views, behind the feature `ndarray`. Nothing is copied; a function of this crate takes an array
//! as `array.as_slice()`.

use ndarray::ArrayView1;
use rustfft::num_complex::Complex64;

use crate::frf::Frf;
use crate::spectrum::{Psd, Spectrum};

impl Spectrum {
    /// Frequency, Hz, of each bin; shape: bins.
    #[must_use]
    pub fn freq_hz_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.freq_hz)
    }

    /// Amplitude of each bin, unit of the values; shape: bins.
    ///
    /// ```
    /// use simgap_signal::{Trend, Window, spectrum::spectrum};
    /// let tone: Vec<f64> = (0..64).map(|n| (std::f64::consts::TAU * 0.125 * f64::from(n)).cos()).collect();
    /// let tone = ndarray::Array1::from(tone);
    /// let values = tone.as_slice().ok_or("not contiguous")?;
    /// let found = spectrum(values, 64.0, Window::Rectangular, Trend::Keep)?;
    /// assert!((found.amplitude_view()[8] - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn amplitude_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.amplitude)
    }

    /// Phase of each bin, rad; shape: bins.
    #[must_use]
    pub fn phase_rad_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.phase_rad)
    }
}

impl Psd {
    /// Frequency, Hz, of each bin; shape: bins.
    #[must_use]
    pub fn freq_hz_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.freq_hz)
    }

    /// Density of each bin, unit² per Hz; shape: bins.
    #[must_use]
    pub fn density_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.density)
    }
}

impl Frf {
    /// Frequency, Hz, of each bin; shape: bins.
    #[must_use]
    pub fn freq_hz_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.freq_hz)
    }

    /// H1 of each bin, unit of the output per unit of the input; shape: bins.
    #[must_use]
    pub fn h1_view(&self) -> ArrayView1<'_, Complex64> {
        ArrayView1::from(&self.h1)
    }
}
