//! (3) of [`super::march`] for one joint, S = φ(S), by the secant method.
//!
//! With the residual r = φ(S) − S, a step is S ← S + g r, with the gain g = −1/r′. The first step takes the gain of the step of the
//! march before: it leaves of r what the slope has changed since. With r₀ and r₁ the residuals of two points, a step of the secant
//! leaves about r₁²/r₀.

/// Evaluations of (3) after the first, at the most; smooth laws need one, a hard stop a few more.
pub(super) const SECANT_STEPS: usize = 12;
/// Relative accuracy of the forces, far below what the trapezoidal rule leaves.
pub(super) const FORCE_TOLERANCE: f64 = 1e-8;
/// Relative residual after which a step with a kept slope, or one of Newton's method, is the last: what it leaves is that
/// times the change of the slope.
pub(super) const LAST_STEP: f64 = 1e-6;
/// Gain where the force does not move itself.
pub(super) const GAIN_ALONE: f64 = 1.0;
/// A gain beyond that of a force that falls by half of what it moves itself is not kept for the next step: it is one across a kink.
pub(super) const GAIN_MOST: f64 = 2.0;

/// The points of the iteration.
pub(super) struct Secant {
    /// S as it is found.
    pub(super) smooth: f64,
    /// Where φ is to be asked, or was asked last where nothing is left to do.
    pub(super) tried: f64,
    before: f64,
    residual: f64,
    gain: f64,
    steps_left: usize,
}

impl Secant {
    /// From a first guess and φ there, with the gain of the step before.
    #[inline(always)]
    pub(super) fn begin(guess: f64, force: f64, gain: f64) -> Secant {
        let residual = force - guess;
        let smooth = guess + gain * residual;
        let is_close = residual.abs() <= LAST_STEP * force.abs();
        Secant {
            smooth,
            tried: if is_close { guess } else { smooth },
            before: guess,
            residual,
            gain,
            steps_left: if is_close { 0 } else { SECANT_STEPS },
        }
    }

    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        self.steps_left > 0
    }

    /// With φ at `tried`.
    #[inline(always)]
    pub(super) fn step(&mut self, force: f64) {
        let at = self.tried;
        let residual = force - at;
        let slope = residual - self.residual;
        if slope == 0.0 || !slope.is_finite() {
            self.smooth = at + residual;
            self.steps_left = 0;
            return;
        }
        self.gain = (self.before - at) / slope;
        self.smooth = at + self.gain * residual;
        let left = residual * residual;
        let is_near = left <= FORCE_TOLERANCE * (self.smooth * self.residual).abs();
        let is_close = residual.abs() <= FORCE_TOLERANCE * self.smooth.abs();
        if is_near || is_close {
            self.steps_left = 0;
            return;
        }
        (self.before, self.residual) = (at, residual);
        self.steps_left -= 1;
        if self.is_open() {
            self.tried = self.smooth;
        }
    }

    /// The gain for the next step of the march.
    #[inline(always)]
    pub(super) fn kept_gain(&self) -> f64 {
        if self.gain > 0.0 && self.gain <= GAIN_MOST {
            self.gain
        } else {
            GAIN_ALONE
        }
    }
}
