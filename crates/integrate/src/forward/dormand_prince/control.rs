//! Choice of the step: a proportional-integral controller (Gustafsson 1991; Hairer, Nørsett and
//! Wanner 1993, II.4 and IV.2).

use crate::error::{IntegrateError, Result};

/// Exponent of the error of this step: 1/5 less three quarters of [`INTEGRAL`].
const PROPORTIONAL: f64 = 0.2 - 0.75 * INTEGRAL;
/// Exponent of the error of the step before.
const INTEGRAL: f64 = 0.04;
/// The next step aims at this fraction of what the error would allow.
const SAFETY: f64 = 0.9;
/// A step becomes at most this many times shorter ...
const SHRINK_LIMIT: f64 = 5.0;
/// ... or longer.
const GROW_LIMIT: f64 = 10.0;
/// Least error remembered, so that one lucky step does not unsettle the next.
const LEAST_ERROR: f64 = 1e-4;

/// How accurately the adaptive method works.
///
/// Each step keeps the estimated error of x and ẋ, as a root mean square over all entries, below
/// absolute + relative · |value|. The error of the whole motion is usually some ten times that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdaptiveTolerance {
    pub(super) relative: f64,
    pub(super) displacement: f64,
    pub(super) velocity: f64,
    pub(super) step_limit: usize,
}

impl AdaptiveTolerance {
    /// Relative tolerance, absolute tolerances of displacement (m) and velocity (m/s).
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`] unless 1e-14 ≤ relative < 1 and the absolute ones are finite
    /// and greater than zero.
    ///
    /// ```
    /// use simgap_integrate::AdaptiveTolerance;
    /// assert!(AdaptiveTolerance::new(1e-8, 1e-12, 1e-11).is_ok());
    /// assert!(AdaptiveTolerance::new(1e-8, 0.0, 1e-11).is_err());
    /// ```
    pub fn new(relative: f64, displacement: f64, velocity: f64) -> Result<Self> {
        if !(1e-14..1.0).contains(&relative) {
            return Err(IntegrateError::Parameter {
                name: "relative tolerance",
                found: relative,
                needed: "at least 1e-14 and less than 1",
            });
        }
        for (name, found) in [
            ("absolute tolerance of displacement", displacement),
            ("absolute tolerance of velocity", velocity),
        ] {
            if !(found.is_finite() && found > 0.0) {
                return Err(IntegrateError::Parameter {
                    name,
                    found,
                    needed: "finite and greater than 0",
                });
            }
        }
        Ok(Self {
            relative,
            displacement,
            velocity,
            step_limit: 10_000_000,
        })
    }

    /// The same with another limit on the number of steps, rejected ones included (1e7 at first).
    #[must_use]
    pub fn with_step_limit(mut self, step_limit: usize) -> Self {
        self.step_limit = step_limit;
        self
    }
}

/// What the controller remembers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Controller {
    last_error: f64,
    rejected: bool,
}

impl Controller {
    pub(super) fn new() -> Self {
        Self {
            last_error: LEAST_ERROR,
            rejected: false,
        }
    }

    /// The next step after one whose error, relative to the tolerance, was `error` ≤ 1.
    pub(super) fn after_accepted(&mut self, step: f64, error: f64) -> f64 {
        let ratio = error.powf(PROPORTIONAL) / self.last_error.powf(INTEGRAL) / SAFETY;
        let mut next = step / ratio.clamp(1.0 / GROW_LIMIT, SHRINK_LIMIT);
        if self.rejected {
            next = next.min(step);
        }
        self.last_error = error.max(LEAST_ERROR);
        self.rejected = false;
        next
    }

    /// The next try after an error above 1 or not a number.
    pub(super) fn after_rejected(&mut self, step: f64, error: f64) -> f64 {
        self.rejected = true;
        if error.is_finite() {
            step / (error.powf(PROPORTIONAL) / SAFETY).clamp(1.0, SHRINK_LIMIT)
        } else {
            step / SHRINK_LIMIT
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_controller_shrinks_and_grows_within_limits() {
        let mut controller = Controller::new();
        assert_eq!(controller.after_accepted(1.0, 0.0), GROW_LIMIT);
        assert!(controller.after_accepted(1.0, 1.0) < 1.0);
        assert_eq!(controller.after_rejected(1.0, 1e9), 1.0 / SHRINK_LIMIT);
        assert_eq!(controller.after_rejected(1.0, f64::NAN), 1.0 / SHRINK_LIMIT);
        // No growth right after a refusal.
        assert_eq!(controller.after_accepted(1.0, 1e-6), 1.0);
    }
}
