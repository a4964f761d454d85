//! Finite-difference formulas applied to a uniformly sampled record.

use crate::error::{IntegrateError, Result, check_finite, check_length, check_time_step};

/// Park's formula times h: weights of y_n, y_(n−1), y_(n−2), y_(n−3) (Park 1975).
///
/// It is the mean of the backward differentiation formulas of orders two and three.
pub const PARK_WEIGHTS: [f64; 4] = [10.0 / 6.0, -15.0 / 6.0, 1.0, -1.0 / 6.0];

/// Backward Euler times h: weights of y_n, y_(n−1).
pub const BACKWARD_EULER_WEIGHTS: [f64; 2] = [1.0, -1.0];

/// Backward differentiation of order two times h: weights of y_n, y_(n−1), y_(n−2).
pub const BDF2_WEIGHTS: [f64; 3] = [3.0 / 2.0, -4.0 / 2.0, 1.0 / 2.0];

/// Central difference of order two times h: weights of y_(n−1), y_n, y_(n+1).
pub const CENTRAL_SECOND_WEIGHTS: [f64; 3] = [-1.0 / 2.0, 0.0, 1.0 / 2.0];

/// Central difference of order four times h: weights of y_(n−2) to y_(n+2).
pub const CENTRAL_FOURTH_WEIGHTS: [f64; 5] =
    [1.0 / 12.0, -8.0 / 12.0, 0.0, 8.0 / 12.0, -1.0 / 12.0];

/// Derivative at the first of three samples, times h; exact on parabolas.
const FORWARD_SECOND_WEIGHTS: [f64; 3] = [-3.0 / 2.0, 4.0 / 2.0, -1.0 / 2.0];

/// Derivative at the first of five samples, times h; exact on quartics.
const FORWARD_FOURTH_WEIGHTS: [f64; 5] = [
    -25.0 / 12.0,
    48.0 / 12.0,
    -36.0 / 12.0,
    16.0 / 12.0,
    -3.0 / 12.0,
];

/// Derivative at the second of five samples, times h; exact on quartics.
const OFFSET_FOURTH_WEIGHTS: [f64; 5] = [
    -3.0 / 12.0,
    -10.0 / 12.0,
    18.0 / 12.0,
    -6.0 / 12.0,
    1.0 / 12.0,
];

/// A finite-difference formula for the first derivative.
///
/// | variant | formula for ẏ_n | order | least samples |
/// |---|---|---|---|
/// | `Park` | (10 y_n − 15 y_(n−1) + 6 y_(n−2) − y_(n−3)) / (6h) | 2 | 4 |
/// | `BackwardEuler` | (y_n − y_(n−1)) / h | 1 | 2 |
/// | `Bdf2` | (3 y_n − 4 y_(n−1) + y_(n−2)) / (2h) | 2 | 3 |
/// | `CentralSecond` | (y_(n+1) − y_(n−1)) / (2h) | 2 | 3 |
/// | `CentralFourth` | (y_(n−2) − 8 y_(n−1) + 8 y_(n+1) − y_(n+2)) / (12h) | 4 | 5 |
///
/// Where a formula would reach outside the record, another of the same order takes its place:
///
/// | variant | sample | formula |
/// |---|---|---|
/// | `Park` | 0 | (−3 y_0 + 4 y_1 − y_2) / (2h) |
/// | | 1 | (y_2 − y_0) / (2h) |
/// | | 2 | `Bdf2` |
/// | `BackwardEuler` | 0 | (y_1 − y_0) / h |
/// | `Bdf2` | 0, 1 | as for `Park` |
/// | `CentralSecond` | first, last | one-sided, three samples |
/// | `CentralFourth` | two at each end | one-sided, five samples |
///
/// Reference: Park 1975 (`park1975`); Hairer, Nørsett and Wanner 1993 (`hairer1993`), III.1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Differentiator {
    /// Park's stiffly stable formula, three steps back.
    Park,
    /// Backward Euler, one step back.
    BackwardEuler,
    /// Backward differentiation formula of order two.
    Bdf2,
    /// Central difference of order two.
    CentralSecond,
    /// Central difference of order four.
    CentralFourth,
}

impl Differentiator {
    /// All formulas, in the order of the table.
    pub const ALL: [Self; 5] = [
        Self::Park,
        Self::BackwardEuler,
        Self::Bdf2,
        Self::CentralSecond,
        Self::CentralFourth,
    ];

    /// FitOptions (times h) of the formula away from the ends, and the offset of each from n.
    #[must_use]
    pub fn weights(self) -> Vec<(isize, f64)> {
        let backward = |weights: &[f64]| -> Vec<(isize, f64)> {
            (0..)
                .map(|k: isize| -k)
                .zip(weights.iter().copied())
                .collect()
        };
        let centred = |weights: &[f64], reach: isize| -> Vec<(isize, f64)> {
            (-reach..=reach).zip(weights.iter().copied()).collect()
        };
        match self {
            Self::Park => backward(&PARK_WEIGHTS),
            Self::BackwardEuler => backward(&BACKWARD_EULER_WEIGHTS),
            Self::Bdf2 => backward(&BDF2_WEIGHTS),
            Self::CentralSecond => centred(&CENTRAL_SECOND_WEIGHTS, 1),
            Self::CentralFourth => centred(&CENTRAL_FOURTH_WEIGHTS, 2),
        }
    }

    /// Order of accuracy: the error falls as h to this power.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Self::BackwardEuler => 1,
            Self::Park | Self::Bdf2 | Self::CentralSecond => 2,
            Self::CentralFourth => 4,
        }
    }

    /// Least number of samples the formula and its ends need.
    #[must_use]
    pub fn least_samples(self) -> usize {
        match self {
            Self::BackwardEuler => 2,
            Self::Bdf2 | Self::CentralSecond => 3,
            Self::Park => 4,
            Self::CentralFourth => 5,
        }
    }
}

/// First derivative of a uniformly sampled series.
///
/// | symbol | argument | unit | shape |
/// |---|---|---|---|
/// | y | `values` | any | samples |
/// | h | `time_step_s` | s | |
/// | ẏ | returned | unit of y per s | samples |
///
/// Formulas and their ends: [`Differentiator`].
///
/// # Errors
///
/// [`IntegrateError::TimeStep`], [`IntegrateError::TooFewSamples`], [`IntegrateError::NotFinite`].
///
/// ```
/// use simgap_integrate::inverse::{Differentiator, differentiate};
/// let parabola: Vec<f64> = (0..6).map(|n| f64::from(n * n)).collect();
/// let slope = differentiate(Differentiator::Park, &parabola, 1.0)?;
/// assert!(slope.iter().enumerate().all(|(n, v)| (v - 2.0 * n as f64).abs() < 1e-12));
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn differentiate(
    differentiator: Differentiator,
    values: &[f64],
    time_step_s: f64,
) -> Result<Vec<f64>> {
    check_time_step(time_step_s)?;
    check_length(
        "the series to differentiate",
        values.len(),
        differentiator.least_samples(),
    )?;
    check_finite("the series to differentiate", values)?;
    let per_step = match differentiator {
        Differentiator::Park => backward(values, &PARK_WEIGHTS),
        Differentiator::BackwardEuler => backward(values, &BACKWARD_EULER_WEIGHTS),
        Differentiator::Bdf2 => backward(values, &BDF2_WEIGHTS),
        Differentiator::CentralSecond => central_second(values),
        Differentiator::CentralFourth => central_fourth(values),
    };
    Ok(per_step
        .into_iter()
        .map(|slope| slope / time_step_s)
        .collect())
}

/// First derivative by Park's formula: [`differentiate`] with [`Differentiator::Park`].
///
/// ```text
/// v_n = (10 y_n − 15 y_(n−1) + 6 y_(n−2) − y_(n−3)) / (6h)
/// ```
///
/// Apply it to displacement for velocity and once more to velocity for acceleration, as the paper
/// does. With θ = ωh a sine of angular frequency ω comes out 1 + θ²/6 too large and θ⁵/12 radians
/// late (leading terms); at the Nyquist frequency the gain is 16/(3h) where the true factor is π/h.
///
/// # Errors
///
/// As [`differentiate`]; at least four samples are needed.
///
/// ```
/// use simgap_integrate::inverse::park_derivative;
/// let line = [0.0, 0.5, 1.0, 1.5, 2.0];
/// let velocity = park_derivative(&line, 0.1)?;
/// assert!(velocity.iter().all(|v| (v - 5.0).abs() < 1e-12));
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// Reference: Park 1975 (`park1975`).
pub fn park_derivative(values: &[f64], time_step_s: f64) -> Result<Vec<f64>> {
    differentiate(Differentiator::Park, values, time_step_s)
}

/// First derivative by the central difference of order 2 or 4.
///
/// # Errors
///
/// As [`differentiate`], and [`IntegrateError::Parameter`] when `order` is neither 2 nor 4.
///
/// ```
/// use simgap_integrate::inverse::central_difference;
/// let cubic: Vec<f64> = (0..7).map(|n| f64::from(n * n * n)).collect();
/// let slope = central_difference(&cubic, 1.0, 4)?;
/// assert!((slope[3] - 27.0).abs() < 1e-12);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn central_difference(values: &[f64], time_step_s: f64, order: usize) -> Result<Vec<f64>> {
    match order {
        2 => differentiate(Differentiator::CentralSecond, values, time_step_s),
        4 => differentiate(Differentiator::CentralFourth, values, time_step_s),
        _ => Err(IntegrateError::Parameter {
            name: "order of the central difference",
            found: order as f64,
            needed: "2 or 4",
        }),
    }
}

/// Velocity and acceleration that go with a sampled displacement.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DerivedMotion {
    /// m/s, one per sample.
    pub velocity: Vec<f64>,
    /// m/s², one per sample.
    pub acceleration: Vec<f64>,
}

/// Velocity and acceleration from displacement by the same formula applied twice.
///
/// # Errors
///
/// As [`differentiate`].
///
/// ```
/// use simgap_integrate::inverse::{Differentiator, derive_motion};
/// let fall: Vec<f64> = (0..8).map(|n| 0.5 * 9.81 * f64::from(n).powi(2)).collect();
/// let motion = derive_motion(Differentiator::Park, &fall, 1.0)?;
/// assert!(motion.acceleration.iter().all(|a| (a - 9.81).abs() < 1e-9));
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn derive_motion(
    differentiator: Differentiator,
    displacement: &[f64],
    time_step_s: f64,
) -> Result<DerivedMotion> {
    let velocity = differentiate(differentiator, displacement, time_step_s)?;
    let acceleration = differentiate(differentiator, &velocity, time_step_s)?;
    Ok(DerivedMotion {
        velocity,
        acceleration,
    })
}

/// Σ w_k y_(first+k).
fn weigh(values: &[f64], first: usize, weights: &[f64]) -> f64 {
    weights
        .iter()
        .zip(&values[first..])
        .map(|(w, y)| w * y)
        .sum()
}

/// Σ −w_k y_(last−k): the mirror image of a forward formula.
fn weigh_mirrored(values: &[f64], last: usize, weights: &[f64]) -> f64 {
    weights
        .iter()
        .enumerate()
        .map(|(k, w)| -w * values[last - k])
        .sum()
}

/// Σ w_k y_(n−k).
fn weigh_backward(values: &[f64], n: usize, weights: &[f64]) -> f64 {
    weights
        .iter()
        .enumerate()
        .map(|(k, w)| w * values[n - k])
        .sum()
}

/// A backward formula everywhere it fits, the start of [`Differentiator`] before it.
fn backward(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let reach = weights.len() - 1;
    (0..values.len())
        .map(|n| match n {
            n if n >= reach => weigh_backward(values, n, weights),
            0 if reach == 1 => values[1] - values[0],
            0 => weigh(values, 0, &FORWARD_SECOND_WEIGHTS),
            1 => weigh(values, 0, &CENTRAL_SECOND_WEIGHTS),
            _ => weigh_backward(values, n, &BDF2_WEIGHTS),
        })
        .collect()
}

fn central_second(values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    (0..=last)
        .map(|n| match n {
            0 => weigh(values, 0, &FORWARD_SECOND_WEIGHTS),
            n if n == last => weigh_mirrored(values, last, &FORWARD_SECOND_WEIGHTS),
            n => weigh(values, n - 1, &CENTRAL_SECOND_WEIGHTS),
        })
        .collect()
}

fn central_fourth(values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    (0..=last)
        .map(|n| match n {
            0 => weigh(values, 0, &FORWARD_FOURTH_WEIGHTS),
            1 => weigh(values, 0, &OFFSET_FOURTH_WEIGHTS),
            n if n == last => weigh_mirrored(values, last, &FORWARD_FOURTH_WEIGHTS),
            n if n == last - 1 => weigh_mirrored(values, last, &OFFSET_FOURTH_WEIGHTS),
            n => weigh(values, n - 2, &CENTRAL_FOURTH_WEIGHTS),
        })
        .collect()
}
