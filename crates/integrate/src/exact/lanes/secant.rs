//! The iteration of [`crate::exact::secant`] in eight lanes; a lane that is done keeps its answer.

use pulp::Simd;

use super::wide::{Which, Wide};
use crate::exact::secant::{FORCE_TOLERANCE, GAIN_ALONE, GAIN_MOST, LAST_STEP, SECANT_STEPS};

/// The points of the iteration.
pub(super) struct Secant<S: Simd> {
    simd: S,
    pub(super) smooth: Wide<S>,
    pub(super) tried: Wide<S>,
    before: Wide<S>,
    residual: Wide<S>,
    gain: Wide<S>,
    open: Which<S>,
    steps_left: usize,
}

impl<S: Simd> Secant<S> {
    /// Of the wanted lanes.
    #[inline(always)]
    pub(super) fn begin(
        wanted: Which<S>,
        guess: Wide<S>,
        force: Wide<S>,
        gain: Wide<S>,
    ) -> Secant<S> {
        let simd = wanted.simd();
        let residual = force - guess;
        let smooth = guess + gain * residual;
        let last = Wide::splat(simd, LAST_STEP);
        let is_close = residual.abs().is_at_most(last * force.abs());
        Secant {
            simd,
            smooth,
            tried: is_close.choose(guess, smooth),
            before: guess,
            residual,
            gain,
            open: wanted & !is_close,
            steps_left: SECANT_STEPS,
        }
    }

    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        self.steps_left > 0 && self.open.any()
    }

    /// With φ at `tried`.
    #[inline(always)]
    pub(super) fn step(&mut self, force: Wide<S>) {
        let (zero, most) = (Wide::zero(self.simd), Wide::splat(self.simd, f64::MAX));
        let tolerance = Wide::splat(self.simd, FORCE_TOLERANCE);
        let at = self.tried;
        let residual = force - at;
        let slope = residual - self.residual;
        let is_flat = slope.equals(zero) | !slope.abs().is_at_most(most);
        let gain = (self.before - at) / slope;
        let smooth = is_flat.choose(at + residual, at + gain * residual);
        self.gain = (self.open & !is_flat).choose(gain, self.gain);
        self.smooth = self.open.choose(smooth, self.smooth);
        let left = residual * residual;
        let is_near = left.is_at_most(tolerance * (smooth * self.residual).abs());
        let is_close = residual.abs().is_at_most(tolerance * smooth.abs());
        self.open = self.open & !(is_flat | is_near | is_close);
        self.before = self.open.choose(at, self.before);
        self.residual = self.open.choose(residual, self.residual);
        self.steps_left -= 1;
        if self.steps_left > 0 {
            self.tried = self.open.choose(self.smooth, self.tried);
        }
    }

    /// The gain for the next step of the march.
    #[inline(always)]
    pub(super) fn kept_gain(&self) -> Wide<S> {
        let (zero, most) = (Wide::zero(self.simd), Wide::splat(self.simd, GAIN_MOST));
        let is_kept = self.gain.is_at_most(most) & !self.gain.is_at_most(zero);
        is_kept.choose(self.gain, Wide::splat(self.simd, GAIN_ALONE))
    }
}
