//! Whether the records show of an effect what its name says.
//!
//! A hidden mass that starts far off its place rings, and its force on the host may look like a tone, a drift or a
//! step that no mode has to do with; one that is too heavy to be moved is a spring and a damper. What an effect does
//! beyond such a degenerate case of its own ([`Effect::degenerate`](simgap_effects::Effect::degenerate)) is what shows
//! it:
//!
//! ```text
//! (J_without − J_degenerate) / (J_without − J) < 0.95          (1)
//! ```
//!
//! J is the objective of the set, with everything but what a record has of its own held where it was fitted.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, fit_initial_states};

use crate::hypothesis::{Hypothesis, pull};
use crate::search::Search;

/// Largest share of what an effect brings that a degenerate case of it may bring, (1).
const DEGENERATE: f64 = 0.95;

impl Search<'_> {
    /// Whether every effect of a set does more than a degenerate case of it, (1). One that cannot be simulated
    /// does nothing.
    pub(crate) fn shows(&self, set: &Hypothesis) -> bool {
        let mut effects = 0..set.effects().len();
        effects.all(|i| self.shows_effect(set, i).unwrap_or(true))
    }

    fn shows_effect(&self, set: &Hypothesis, i: usize) -> Result<bool, EstimateError> {
        let placed = &set.effects()[i];
        let cases = placed.effect.degenerate(&placed.values);
        if cases.is_empty() {
            return Ok(true);
        }
        let own = set.fit.objective - pull(&set.fit.estimate);
        let without = self.objective_with(set, i, None)?;
        let least = without - DEGENERATE * (without - own);
        let brings_less = |values: Vec<f64>| {
            let case = Placed::new(placed.effect, placed.at.clone(), values);
            let objective = self.objective_with(set, i, Some(case));
            objective.map_or(true, |objective| objective > least)
        };
        Ok(cases.into_iter().all(brings_less))
    }

    /// The objective of a set with another effect, or none, in the place of its i-th and all shared values held.
    fn objective_with(
        &self,
        set: &Hypothesis,
        i: usize,
        instead: Option<Placed>,
    ) -> Result<f64, EstimateError> {
        let mut held = set.effects().to_vec();
        held.splice(i..=i, instead);
        held.extend(set.fit.estimate.nominal.iter().cloned());
        let fit = fit_initial_states(self.problem, &held, &self.weights)?;
        Ok(fit.objective)
    }
}
