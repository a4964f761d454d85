//! Rounding looks like noise.
//!
//! A converter of step q adds an error of variance q²/12 that is white where the signal passes from step to
//! step. A set that leaves no more than that leaves nothing but noise, and yet something that can be named.

use simgap_effects::SiteScale;
use simgap_estimate::Candidate;
use simgap_model::Location;

use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// Part of what is left of a channel from which it is rounding.
const ROUNDED: f64 = 0.5;

impl Search<'_> {
    /// Whether what a set leaves of some channel is mostly the rounding of a converter, which it could name and does not.
    pub(crate) fn leaves_rounding(&self, set: &Hypothesis) -> bool {
        let outputs = &self.problem.model.outputs;
        self.candidates.iter().any(|(candidate, scale)| {
            let Location::Channel(channel) = &candidate.at else {
                return false;
            };
            let left = outputs.iter().position(|o| o.channel == *channel);
            let left = left.map_or(f64::INFINITY, |c| set.fit.variance[c]);
            scale.signal_step.powi(2) / 12.0 > ROUNDED * left
                && rounds(candidate, scale)
                && !names(set, candidate)
        })
    }
}

fn rounds(candidate: &Candidate, scale: &SiteScale) -> bool {
    let starts = candidate.effect.starts(scale);
    let mut starts = starts.iter();
    starts.any(|values| candidate.effect.action(values).is_stepped())
}

fn names(set: &Hypothesis, candidate: &Candidate) -> bool {
    let mut effects = set.effects().iter();
    effects
        .any(|placed| placed.at == candidate.at && placed.effect.kind() == candidate.effect.kind())
}
