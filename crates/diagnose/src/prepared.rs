//! What is known before effects are looked for.

use simgap_effects::Placed;
use simgap_estimate::{Fit, FitOptions, Problem, fit};

/// Everything that is known before effects are looked for.
pub(crate) struct Prepared {
    /// All training records.
    pub(crate) train: Problem,
    /// The part of them that is searched in.
    pub(crate) excerpt: Problem,
    /// The part of them that is searched in first, where they are long.
    pub(crate) first_excerpt: Option<Problem>,
    /// The model as given.
    pub(crate) nominal: Fit,
    /// With its nominal parameters re-estimated.
    pub(crate) recalibrated: Fit,
    /// Nominal parameters at their nominal values.
    pub(crate) parameters: Vec<Placed>,
}

impl Prepared {
    /// The gap that re-estimated parameters leave, of the model as given at most, and of the motion at most: rms of each channel.
    pub(crate) fn gap(&self) -> Vec<f64> {
        let std = self.excerpt.output_std();
        let left = self
            .recalibrated
            .variance
            .iter()
            .zip(&self.nominal.variance);
        left.zip(std)
            .map(|((left, given), std)| left.min(*given).min(std * std).sqrt())
            .collect()
    }

    /// Minus the log-likelihood of re-estimated parameters under the given options.
    pub(crate) fn misfit_of_parameters(&self, options: &FitOptions) -> f64 {
        let held = FitOptions {
            most_steps: 0,
            ..options.clone()
        };
        let fitted = fit(&self.train, &self.recalibrated.estimate, &held);
        fitted.map_or(f64::INFINITY, |fit| fit.misfit)
    }
}
