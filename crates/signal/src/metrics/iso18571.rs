//! Objective rating of ISO/TS 18571: corridor, phase, magnitude, slope.

use super::dtw::warped_sums;
use crate::correlation::{centred, cross_products};
use crate::{SignalError, check};

/// Half widths of the inner and outer corridor, parts of the largest measured value (a_0, b_0).
const CORRIDOR: (f64, f64) = (0.05, 0.50);
/// Exponent of the corridor score (k_Z).
const CORRIDOR_EXPONENT: i32 = 2;
/// Largest shift, part of the record (ε*_P).
const MAX_SHIFT: f64 = 0.20;
/// Magnitude error that scores zero (ε*_M).
const MAX_MAGNITUDE_ERROR: f64 = 0.50;
/// Band of the time warping, part of the shifted record.
const WARP_BAND: f64 = 0.10;
/// Slope error that scores zero (ε*_S).
const MAX_SLOPE_ERROR: f64 = 2.0;
/// Samples of the moving average of the slope.
const SLOPE_AVERAGE: usize = 9;
/// FitOptions of corridor, phase, magnitude and slope.
const WEIGHTS: [f64; 4] = [0.4, 0.2, 0.2, 0.2];
/// A correlation must exceed that of a smaller shift by this to count as larger: rounding of the
/// transforms, far below the step of a real maximum.
const CORRELATION_ROUNDING: f64 = 1e-12;
/// Fewest samples: nine must be left for the slope after the largest shift.
const FEWEST: usize = 11;

/// Grade of a total score in ISO/TS 18571.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Grade {
    /// Up to 0.58.
    Poor,
    /// Above 0.58.
    Fair,
    /// Above 0.80.
    Good,
    /// Above 0.94.
    Excellent,
}

/// Scores from 0 (no agreement) to 1 (identical curves).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Iso18571 {
    /// Corridor score Z.
    pub corridor: f64,
    /// Phase score E_P.
    pub phase: f64,
    /// Magnitude score E_M.
    pub magnitude: f64,
    /// Slope score E_S.
    pub slope: f64,
    /// Weighted total R.
    pub total: f64,
    /// Samples by which the prediction is late (negative: early) at the largest correlation.
    pub delay_samples: isize,
    /// That correlation.
    pub correlation: f64,
}

impl Iso18571 {
    /// Grade of the total score.
    #[must_use]
    pub fn grade(&self) -> Grade {
        match self.total {
            r if r > 0.94 => Grade::Excellent,
            r if r > 0.80 => Grade::Good,
            r if r > 0.58 => Grade::Fair,
            _ => Grade::Poor,
        }
    }
}

/// Rates a prediction by ISO/TS 18571:2014 (the formulas are those of the 2024 edition as well).
///
/// ```text
/// T measured, C predicted, N samples, T_norm = max|T|
/// Z   = 1/N Σ c,  c = 1 within 0.05 T_norm, 0 beyond 0.5 T_norm, ((0.5 T_norm - |T-C|)/(0.45 T_norm))² between   (1)
/// n_ε = shift up to 0.2 N with the largest correlation of T and the shifted C (the smallest of equals)            (2)
/// E_P = (0.2 N - n_ε) / (0.2 N)                                                                                  (3)
/// E_M = (0.5 - ε_M) / 0.5,  ε_M = Σ|C_w - T_w| / Σ|T_w| after shift and time warping in a band of 0.1 n           (4)
/// E_S = (2 - ε_S) / 2,      ε_S = Σ|C' - T'| / Σ|T'|, slopes of the shifted curves averaged over nine samples     (5)
/// R   = 0.4 Z + 0.2 E_P + 0.2 E_M + 0.2 E_S                                                                      (6)
/// ```
///
/// Scores below zero are zero. The technical specification is written for crash signals at 10 kHz; the
/// nine-sample average of (5) makes the slope score depend on the sample rate. Shifted parts of one curve
/// that do not vary correlate with nothing. O(N log N) for the shift, O(0.2 N²) for the warping.
/// References: ISO18571, Gehre2009.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 11 samples, [`SignalError::LengthMismatch`],
/// [`SignalError::NonFinite`], [`SignalError::Flat`] for a measurement that does not vary.
///
/// # Examples
///
/// ```
/// use simgap_signal::metrics::{Grade, iso18571};
/// let measured: Vec<f64> = (0..200).map(|n| (0.05 * n as f64).sin()).collect();
/// let rating = iso18571(&measured, &measured)?;
/// assert_eq!((rating.total, rating.grade()), (1.0, Grade::Excellent));
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn iso18571(measured: &[f64], predicted: &[f64]) -> Result<Iso18571, SignalError> {
    check::pair(measured, predicted, FEWEST)?;
    if measured.iter().all(|&v| v == measured[0]) {
        return Err(SignalError::Flat { what: "measured" });
    }
    let n = measured.len();
    let corridor = corridor_score(measured, predicted);
    // (2)
    let (delay_samples, correlation) = best_shift(measured, predicted);
    let shift = delay_samples.unsigned_abs();
    let (t, c) = if delay_samples >= 0 {
        (&measured[..n - shift], &predicted[shift..])
    } else {
        (&measured[shift..], &predicted[..n - shift])
    };
    // (3)
    let phase = score(shift as f64, MAX_SHIFT * n as f64);
    // (4)
    let radius = (WARP_BAND * t.len() as f64).ceil() as usize;
    let sums = warped_sums(c, t, radius);
    let magnitude = score(
        relative(sums.difference, sums.reference),
        MAX_MAGNITUDE_ERROR,
    );
    // (5)
    let (t_slope, c_slope) = (smooth_slope(t), smooth_slope(c));
    let difference: f64 = t_slope
        .iter()
        .zip(&c_slope)
        .map(|(a, b)| (a - b).abs())
        .sum();
    let reference: f64 = t_slope.iter().map(|v| v.abs()).sum();
    let slope = score(relative(difference, reference), MAX_SLOPE_ERROR);
    // (6)
    let total =
        WEIGHTS[0] * corridor + WEIGHTS[1] * phase + WEIGHTS[2] * magnitude + WEIGHTS[3] * slope;
    Ok(Iso18571 {
        corridor,
        phase,
        magnitude,
        slope,
        // The weights add up to one only within rounding.
        total: total.min(1.0),
        delay_samples,
        correlation,
    })
}

/// 1 at no error, 0 from the largest error on, straight between.
fn score(error: f64, largest: f64) -> f64 {
    ((largest - error) / largest).clamp(0.0, 1.0)
}

/// Quotient in which nothing over nothing is no error.
fn relative(difference: f64, reference: f64) -> f64 {
    if difference == 0.0 {
        0.0
    } else {
        difference / reference
    }
}

/// (1)
fn corridor_score(measured: &[f64], predicted: &[f64]) -> f64 {
    let largest = measured.iter().fold(0.0f64, |a, v| a.max(v.abs()));
    let (inner, outer) = (CORRIDOR.0 * largest, CORRIDOR.1 * largest);
    let sum: f64 = measured
        .iter()
        .zip(predicted)
        .map(|(t, c)| {
            ((outer - (t - c).abs()) / (outer - inner))
                .clamp(0.0, 1.0)
                .powi(CORRIDOR_EXPONENT)
        })
        .sum();
    sum / measured.len() as f64
}

/// (2): delay of the prediction in samples, and the correlation there.
///
/// The sums of products of all shifts come from one transform, means and variances of the
/// overlapping parts from running sums.
fn best_shift(measured: &[f64], predicted: &[f64]) -> (isize, f64) {
    let n = measured.len();
    let (t, c) = (centred(measured), centred(predicted));
    let products = cross_products(&t, &c);
    let (t_sum, t_square) = running_sums(&t);
    let (c_sum, c_square) = running_sums(&c);
    // Overlap of T from t0 and C from c0 over len samples, the product sum given.
    let correlation = |t0: usize, c0: usize, len: usize, product: f64| -> f64 {
        let count = len as f64;
        let (ts, cs) = (t_sum[t0 + len] - t_sum[t0], c_sum[c0 + len] - c_sum[c0]);
        let t_var = t_square[t0 + len] - t_square[t0] - ts * ts / count;
        let c_var = c_square[c0 + len] - c_square[c0] - cs * cs / count;
        // What is left of a constant stretch after cancellation is rounding.
        let varies = t_var > 1e-13 * t_square[n] && c_var > 1e-13 * c_square[n];
        if varies {
            (product - ts * cs / count) / (t_var * c_var).sqrt()
        } else {
            0.0
        }
    };
    let len = products.len();
    let mut best = (0isize, correlation(0, 0, n, products[0].re));
    for m in 1..=(MAX_SHIFT * n as f64).floor() as usize {
        // Prediction late by m first, then early by m: the order of the specification.
        let late = correlation(0, m, n - m, products[m].re);
        if late > best.1 + CORRELATION_ROUNDING {
            best = (m as isize, late);
        }
        let early = correlation(m, 0, n - m, products[len - m].re);
        if early > best.1 + CORRELATION_ROUNDING {
            best = (-(m as isize), early);
        }
    }
    best
}

/// Sums and sums of squares of the first 0, 1, … N values.
fn running_sums(values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut sums, mut squares) = (vec![0.0], vec![0.0]);
    let (mut sum, mut square) = (0.0, 0.0);
    for v in values {
        sum += v;
        square += v * v;
        sums.push(sum);
        squares.push(square);
    }
    (sums, squares)
}

/// Central differences per sample (one-sided at the ends), averaged over nine samples, over 7, 5, 3, 1
/// towards the ends.
fn smooth_slope(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let slope: Vec<f64> = (0..n)
        .map(|i| match i {
            0 => values[1] - values[0],
            i if i == n - 1 => values[i] - values[i - 1],
            i => 0.5 * (values[i + 1] - values[i - 1]),
        })
        .collect();
    (0..n)
        .map(|i| {
            let half = i.min(n - 1 - i).min(SLOPE_AVERAGE / 2);
            let part = &slope[i - half..=i + half];
            part.iter().sum::<f64>() / part.len() as f64
        })
        .collect()
}
