//! Least-squares amplitude and phase of lines at given frequencies, with standard errors.

use std::f64::consts::TAU;

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

use crate::{SignalError, check};

/// Smallest distance, relative to its length, of a column from the span of those before it. It costs the
/// coefficients six of sixteen digits, and a million times the standard error of a line alone.
const SEPARABLE: f64 = 1e-6;

/// One fitted line a cos(2πft) + b sin(2πft) = A cos(2πft + φ).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Line {
    /// Frequency f as given, Hz.
    pub freq_hz: f64,
    /// Cosine coefficient a.
    pub cosine: f64,
    /// Sine coefficient b.
    pub sine: f64,
    /// Standard error of a.
    pub cosine_std: f64,
    /// Standard error of b.
    pub sine_std: f64,
    /// Amplitude A = √(a² + b²).
    pub amplitude: f64,
    /// Standard error of the amplitude (first order).
    pub amplitude_std: f64,
    /// Phase φ = atan2(-b, a) at time zero, rad.
    pub phase_rad: f64,
    /// Standard error of the phase (first order), rad.
    pub phase_std_rad: f64,
    /// (a, b) C⁻¹ (a, b)ᵀ: about χ² with 2 degrees of freedom (mean 2) if there is no such line.
    pub chi_square: f64,
}

/// Mean, trend and lines fitted to a record.
///
/// Parameters are ordered mean, trend, a_1, b_1, a_2, b_2 …
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineFit {
    /// The lines, in the order of the frequencies given.
    pub lines: Vec<Line>,
    /// Value of the straight line at `mid_time_s`.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_std: f64,
    /// Slope of the straight line, unit per second.
    pub trend_per_s: f64,
    /// Standard error of the slope.
    pub trend_std_per_s: f64,
    /// Time about which the straight line is written, s.
    pub mid_time_s: f64,
    /// Values minus fit.
    pub residual: Vec<f64>,
    /// Standard deviation of the residual, with `degrees_of_freedom` as divisor.
    pub residual_std: f64,
    /// Samples minus parameters.
    pub degrees_of_freedom: usize,
    covariance: Vec<f64>,
}

impl LineFit {
    /// Number of parameters, 2 + 2 per line.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        2 + 2 * self.lines.len()
    }

    /// Covariance of two parameters (`None` beyond their number).
    #[must_use]
    pub fn covariance(&self, i: usize, j: usize) -> Option<f64> {
        let p = self.parameter_count();
        (i < p && j < p).then(|| self.covariance[i * p + j])
    }

    /// The fitted curve at any time.
    #[must_use]
    pub fn value_at(&self, time_s: f64) -> f64 {
        let lines: f64 = self
            .lines
            .iter()
            .map(|l| {
                let (sin, cos) = (TAU * l.freq_hz * time_s).sin_cos();
                l.cosine * cos + l.sine * sin
            })
            .sum();
        self.mean + self.trend_per_s * (time_s - self.mid_time_s) + lines
    }
}

/// Fits mean, trend and lines at known frequencies.
///
/// ```text
/// v(t) = c_0 + c_1 (t - t_mid) + Σ_k a_k cos(2π f_k t) + b_k sin(2π f_k t) + e        (1)
/// Q R = [1, t - t_mid, cos, sin, …] with columns of unit length,  R θ = Qᵀ v            (2)
/// s² = Σ e² / (N - p),   C = s² R⁻¹ R⁻ᵀ                                                (3)
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | t | `time_s` | s, need not be even | N |
/// | v | `values` | any | N |
/// | f | `freqs_hz` | Hz | K |
///
/// The standard errors are for a white residual; with a coloured one multiply them by
/// √(N / [`crate::correlation::effective_sample_count`]) or better by the ratio of the local density to
/// the white one. On even times a frequency above fs/2 fits its alias.
///
/// # Errors
///
/// [`SignalError::TooShort`] unless N exceeds 2 + 2K; [`SignalError::LengthMismatch`];
/// [`SignalError::NonFinite`]; [`SignalError::OutOfRange`] for a frequency that is not positive;
/// [`SignalError::NotSeparable`] naming the first line that adds (almost) no new direction: the same
/// frequency twice, an alias, a fraction of a period per record, or exactly fs/2.
///
/// # Examples
///
/// ```
/// use simgap_signal::lines::fit_lines;
/// let t: Vec<f64> = (0..100).map(|n| 0.01 * n as f64).collect();
/// let v: Vec<f64> = t.iter().map(|t| 1.0 + 2.0 * (40.0 * t).cos() + 0.5 * (40.0 * t).sin()).collect();
/// let fit = fit_lines(&t, &v, &[40.0 / std::f64::consts::TAU])?;
/// assert!((fit.lines[0].cosine - 2.0).abs() < 1e-9 && (fit.mean - 1.0).abs() < 1e-9);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn fit_lines(time_s: &[f64], values: &[f64], freqs_hz: &[f64]) -> Result<LineFit, SignalError> {
    let p = 2 + 2 * freqs_hz.len();
    check::finite("time_s", time_s, p + 1)?;
    check::same_len("values", values.len(), "time_s", time_s.len())?;
    check::finite("values", values, p + 1)?;
    for &f in freqs_hz {
        check::positive("freqs_hz", f)?;
    }
    let design = Design::new(time_s, freqs_hz)?;
    let n = values.len();
    // (2)
    let qr = design.columns.qr();
    let r = qr.thin_R();
    for j in 0..p {
        if r[(j, j)].abs() < SEPARABLE {
            return Err(design.not_separable(j, freqs_hz));
        }
    }
    let rhs = Mat::from_fn(n, 1, |i, _| values[i]);
    let theta = qr.solve_lstsq(&rhs);
    let residual = design.residual(values, |j| theta[(j, 0)]);
    let degrees_of_freedom = n - p;
    let variance = residual.iter().map(|e| e * e).sum::<f64>() / degrees_of_freedom as f64;
    let covariance = design.covariance(variance, |i, j| r[(i, j)]);
    let value = |j: usize| theta[(j, 0)] / design.norms[j];
    let lines = (0..freqs_hz.len())
        .map(|k| {
            let (i, j) = (2 + 2 * k, 3 + 2 * k);
            let block = [
                covariance[i * p + i],
                covariance[i * p + j],
                covariance[j * p + j],
            ];
            line(freqs_hz[k], value(i), value(j), block)
        })
        .collect();
    Ok(LineFit {
        lines,
        mean: value(0),
        mean_std: covariance[0].sqrt(),
        trend_per_s: value(1),
        trend_std_per_s: covariance[p + 1].sqrt(),
        mid_time_s: design.mid_time_s,
        residual,
        residual_std: variance.sqrt(),
        degrees_of_freedom,
        covariance,
    })
}

/// The columns of (1), each divided by its length.
struct Design {
    columns: Mat<f64>,
    norms: Vec<f64>,
    mid_time_s: f64,
}

impl Design {
    fn new(time_s: &[f64], freqs_hz: &[f64]) -> Result<Self, SignalError> {
        let n = time_s.len();
        let p = 2 + 2 * freqs_hz.len();
        let mid_time_s = time_s.iter().sum::<f64>() / n as f64;
        let mut columns = Mat::zeros(n, p);
        for (i, &t) in time_s.iter().enumerate() {
            columns[(i, 0)] = 1.0;
            columns[(i, 1)] = t - mid_time_s;
            for (k, f) in freqs_hz.iter().enumerate() {
                let (sin, cos) = (TAU * f * t).sin_cos();
                columns[(i, 2 + 2 * k)] = cos;
                columns[(i, 3 + 2 * k)] = sin;
            }
        }
        let mut norms = Vec::with_capacity(p);
        for j in 0..p {
            norms.push((0..n).map(|i| columns[(i, j)].powi(2)).sum::<f64>().sqrt());
        }
        if norms[1] == 0.0 {
            return Err(SignalError::Flat { what: "time_s" });
        }
        let design = Self {
            columns,
            norms,
            mid_time_s,
        };
        for j in 2..p {
            // A cosine or sine column whose samples all vanish: the line sits at fs/2.
            if design.norms[j] < SEPARABLE * (n as f64).sqrt() {
                return Err(design.not_separable(j, freqs_hz));
            }
        }
        Ok(design.normalised())
    }

    fn normalised(mut self) -> Self {
        for j in 0..self.columns.ncols() {
            for i in 0..self.columns.nrows() {
                self.columns[(i, j)] /= self.norms[j];
            }
        }
        self
    }

    fn residual(&self, values: &[f64], theta: impl Fn(usize) -> f64) -> Vec<f64> {
        let p = self.columns.ncols();
        values
            .iter()
            .enumerate()
            .map(|(i, v)| v - (0..p).map(|j| self.columns[(i, j)] * theta(j)).sum::<f64>())
            .collect()
    }

    /// (3), with the lengths of the columns taken out again.
    fn covariance(&self, variance: f64, r: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let p = self.columns.ncols();
        let inverse = upper_inverse(p, r);
        let mut covariance = vec![0.0; p * p];
        for i in 0..p {
            for j in 0..p {
                let sum: f64 = (i.max(j)..p)
                    .map(|k| inverse[i * p + k] * inverse[j * p + k])
                    .sum();
                covariance[i * p + j] = variance * sum / (self.norms[i] * self.norms[j]);
            }
        }
        covariance
    }

    fn not_separable(&self, column: usize, freqs_hz: &[f64]) -> SignalError {
        match column.checked_sub(2) {
            Some(j) => SignalError::NotSeparable {
                freq_hz: freqs_hz[j / 2],
            },
            None => SignalError::Flat { what: "time_s" },
        }
    }
}

/// Inverse of an upper triangular matrix, row major.
fn upper_inverse(p: usize, r: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut inverse = vec![0.0; p * p];
    for j in 0..p {
        inverse[j * p + j] = 1.0 / r(j, j);
        for i in (0..j).rev() {
            let sum: f64 = (i + 1..=j).map(|k| r(i, k) * inverse[k * p + j]).sum();
            inverse[i * p + j] = -sum / r(i, i);
        }
    }
    inverse
}

/// Amplitude, phase and their errors from the coefficients and [var a, cov ab, var b].
fn line(freq_hz: f64, a: f64, b: f64, [aa, ab, bb]: [f64; 3]) -> Line {
    let amplitude = a.hypot(b);
    let (c, s) = if amplitude > 0.0 {
        (a / amplitude, b / amplitude)
    } else {
        (1.0, 0.0)
    };
    let radial = c * c * aa + 2.0 * c * s * ab + s * s * bb;
    let tangential = s * s * aa - 2.0 * c * s * ab + c * c * bb;
    let determinant = aa * bb - ab * ab;
    let phase_std = tangential.max(0.0).sqrt() / amplitude;
    Line {
        freq_hz,
        cosine: a,
        sine: b,
        cosine_std: aa.sqrt(),
        sine_std: bb.sqrt(),
        amplitude,
        amplitude_std: radial.max(0.0).sqrt(),
        phase_rad: (-b).atan2(a),
        // An angle nothing is known of scatters by π/√3.
        phase_std_rad: phase_std.min(std::f64::consts::PI / 3f64.sqrt()),
        chi_square: (bb * a * a - 2.0 * ab * a * b + aa * b * b) / determinant,
    }
}
