//! Gains that are slips of units or of the sign.
//!
//! With a channel in another unit a record begins elsewhere. From the angle that degrees taken for radians say a pendulum
//! turns over, and no fit of the gain finds the way back from there. So every slip begins from initial states that are found with it.

use rayon::prelude::*;
use simgap_effects::{Placed, Prior, SLIPS};
use simgap_estimate::{Candidate, Start, fit_initial_states};

use crate::candidate_model::{CandidateModel, add, straight};
use crate::search::Search;

/// Share of the mean square of a channel that a model leaves at least which is off by a slip: the smallest are 2π and the sign.
const LEFT: f64 = 0.5;

impl Search<'_> {
    /// Each gain with its likeliest slip in the place of what it is, where `base` leaves most of a channel.
    pub(crate) fn slips(&self, base: &CandidateModel) -> Vec<CandidateModel> {
        let channels = base.fit.variance.iter().zip(self.problem.output_std());
        let mut channels = channels.map(|(left, std)| left / (std * std));
        if !channels.any(|left| left > LEFT) {
            return vec![];
        }
        let candidates = self.space.candidates.iter();
        let gains = candidates.filter(|(candidate, scale)| {
            let prior = candidate.effect.prior(0, scale);
            matches!(prior, Prior::Factor { slips: true, .. }) && self.may_hold(base, candidate)
        });
        let gains: Vec<&Candidate> = gains.map(|(candidate, _)| candidate).collect();
        let found = self.try_each(&gains, |gain| self.slip(base, gain));
        found.into_iter().flatten().collect()
    }

    /// A gain with the slip that leaves least, fitted.
    fn slip(&self, base: &CandidateModel, gain: &Candidate) -> Option<CandidateModel> {
        let beside = Start {
            nominal: straight(base),
            ..base.fit.estimate.clone()
        };
        let of_slip = |factor: f64| {
            let slip = Placed::new(gain.effect, gain.at.clone(), vec![factor]);
            let mut start = add(&beside, slip);
            let placed: Vec<Placed> = start.placed().cloned().collect();
            let found = fit_initial_states(self.problem, &placed, &self.options).ok()?;
            start.initial.clone_from(&found.estimate.initial);
            Some((found.misfit, start))
        };
        let found: Vec<(f64, Start)> = SLIPS
            .par_iter()
            .filter_map(|slip| of_slip(slip.factor))
            .collect();
        let least = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        self.fit(&least?.1).ok()
    }
}
