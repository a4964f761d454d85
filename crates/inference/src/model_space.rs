//! Which sets of effects there are, and how likely each is before any data.
//!
//! ```text
//! ln p(S) = −λ + Σ_i ln(λ w_i / (W n_i))                                   (1)
//! ```
//!
//! λ is the expected number of effects, w_i the weight of the kind of the i-th effect, W the sum over the kinds that
//! have a place, n_i the number of its places. It is the probability of a set of independent effects: more candidates
//! cost more, and a larger set costs more.

use simgap_effects::{
    Effect, Equivalent, Family, Placed, SiteScale, equivalents_beside, same_place,
};
use simgap_estimate::{Candidate, EstimateError, Fit, Problem};
use simgap_model::{Location, Model};

/// λ of (1).
const EXPECTED_EFFECTS: f64 = 1.0;

/// The candidates of the catalogue at their places.
#[derive(Clone)]
pub struct ModelSpace {
    /// Every candidate, with the typical sizes at its place.
    pub candidates: Vec<(Candidate, SiteScale)>,
    /// Standard deviation of the prior on each entry of an initial state.
    state_std: Vec<f64>,
}

impl ModelSpace {
    /// The catalogue at the places of a model, less the withheld kinds. `baseline` tells the sizes.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn new(
        problem: &Problem,
        baseline: &Fit,
        withheld: &[String],
    ) -> Result<ModelSpace, EstimateError> {
        let is_withheld = |kind: &str| withheld.iter().any(|known| known == kind);
        let candidates = problem.candidates(|_| true).into_iter();
        let candidates = candidates.filter(|candidate| !is_withheld(candidate.effect.kind()));
        Ok(ModelSpace {
            state_std: problem
                .state_std_of(&baseline.estimate.nominal, &baseline.estimate.initial)?,
            ..ModelSpace::of(problem, baseline, candidates)?
        })
    }

    /// These candidates, with the sizes that `baseline` tells; initial states have the prior of the problem.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub(crate) fn of(
        problem: &Problem,
        baseline: &Fit,
        candidates: impl Iterator<Item = Candidate>,
    ) -> Result<ModelSpace, EstimateError> {
        let mut scales: Vec<(Location, SiteScale)> = vec![];
        let sized = candidates.map(|candidate| {
            let known = scales.iter().find(|(at, _)| *at == candidate.at);
            let scale = match known {
                Some((_, scale)) => *scale,
                None => {
                    let scale = problem.site_scale(baseline, &candidate.at)?;
                    scales.push((candidate.at.clone(), scale));
                    scale
                }
            };
            Ok((candidate, scale))
        });
        Ok(ModelSpace {
            candidates: sized.collect::<Result<_, EstimateError>>()?,
            state_std: problem.state_std.clone(),
        })
    }

    /// The candidates of some families alone.
    #[must_use]
    pub fn of_families(&self, is_wanted: impl Fn(Family) -> bool) -> ModelSpace {
        let candidates = self.candidates.iter();
        let wanted = candidates.filter(|(candidate, _)| is_wanted(candidate.effect.family()));
        ModelSpace {
            candidates: wanted.cloned().collect(),
            state_std: self.state_std.clone(),
        }
    }

    /// Puts a problem under these priors: on the values of effects by the sizes at their places, and on initial states. Without those
    /// a set has no marginal likelihood.
    pub fn put_priors(&self, problem: &mut Problem) {
        problem.scales.clear();
        for (candidate, scale) in &self.candidates {
            if problem.scales.iter().all(|(at, _)| *at != candidate.at) {
                problem.scales.push((candidate.at.clone(), *scale));
            }
        }
        problem.state_std.clone_from(&self.state_std);
    }

    /// Typical sizes at a place of a candidate.
    #[must_use]
    pub fn scale_at(&self, at: &Location) -> Option<SiteScale> {
        let known = self.candidates.iter().find(|(known, _)| known.at == *at);
        known.map(|(_, scale)| *scale)
    }

    /// ln p(S) by (1).
    #[must_use]
    pub fn log_prior(&self, effects: &[Placed]) -> f64 {
        let each = effects
            .iter()
            .map(|placed| self.log_prior_of(placed.effect));
        each.sum::<f64>() - EXPECTED_EFFECTS
    }

    /// What one more effect of a kind adds to ln p.
    #[must_use]
    pub fn log_prior_of(&self, effect: &dyn Effect) -> f64 {
        let places = self.places(effect.kind()).max(1) as f64;
        (EXPECTED_EFFECTS * effect.prior_weight() / (self.total_weight() * places)).ln()
    }

    fn places(&self, kind: &str) -> usize {
        let candidates = self.candidates.iter();
        candidates
            .filter(|(known, _)| known.effect.kind() == kind)
            .count()
    }

    fn total_weight(&self) -> f64 {
        let mut kinds: Vec<&str> = vec![];
        let mut all = 0.0;
        for (candidate, _) in &self.candidates {
            let kind = candidate.effect.kind();
            if !kinds.contains(&kind) {
                kinds.push(kind);
                all += candidate.effect.prior_weight();
            }
        }
        f64::max(all, f64::MIN_POSITIVE)
    }

    /// The candidate that an effect by another name is, if it is looked for.
    pub(crate) fn candidate_of(&self, same: &Equivalent) -> Option<&Candidate> {
        let mut candidates = self.candidates.iter().map(|(candidate, _)| candidate);
        candidates.find(|known| known.effect.kind() == same.kind && same_place(&known.at, &same.at))
    }

    /// What is the same thing by another name as the i-th effect of a set, on this plant, whatever the data; of
    /// the kinds that are looked for.
    #[must_use]
    pub fn equivalents(&self, effects: &[Placed], index: usize, model: &Model) -> Vec<Equivalent> {
        let mut same = equivalents_beside(effects, index, model);
        same.retain(|other| self.candidate_of(other).is_some());
        same
    }
}
