//! Rounding looks like noise.
//!
//! A converter of step q adds an error of variance q²/12 that is white where the signal passes from step to
//! step. A set that leaves no more than that leaves nothing but noise, and yet something that can be named.

use simgap_effects::SiteScale;
use simgap_estimate::Candidate;
use simgap_model::Location;

use crate::hypothesis::{Hypothesis, same};
use crate::search::Search;

/// Part of what is left of a channel from which it is rounding.
const ROUNDED: f64 = 0.5;

impl Search<'_> {
    /// Whether what a set leaves of some channel is mostly the rounding of a converter, which it could name and does not.
    pub(crate) fn leaves_rounding(&self, set: &Hypothesis) -> bool {
        self.candidates.iter().any(|(candidate, scale)| {
            let Location::Channel(channel) = &candidate.at else {
                return false;
            };
            let of = self.problem.model.output_index(channel);
            let left = of.map_or(f64::INFINITY, |c| set.fit.variance[c]);
            scale.signal_step.powi(2) / 12.0 > ROUNDED * left
                && rounds(candidate, scale)
                && !set.effects().iter().any(|placed| same(placed, candidate))
        })
    }
}

fn rounds(candidate: &Candidate, scale: &SiteScale) -> bool {
    let starts = candidate.effect.starts(scale);
    let mut starts = starts.iter();
    starts.any(|values| candidate.effect.action(values).is_stepped())
}
