//! Practical relevance: which effects are worth a name.
//!
//! An effect is not that closes less than [`RELEVANT_SHARE`] of the gap, rms, in every channel, nor one that closes no more in any than
//! a tenth of what it is rounded by ([`NOISE_KNOWN`]), for rounding follows the motion, nor one that moves no output by enough
//! ([`Search::moves_enough`]), nor one without which no more is left than no set is expected to explain; nor one beside others that
//! explains less than half of what is left above the noise.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, FitOptions, fit};

use crate::candidate_model::{
    CandidateModel, INDISTINGUISHABLE, NominalPrior, is_bent, is_bent_from, is_nominal, name,
    remove,
};
use crate::gap::RELEVANT_SHARE;
use crate::motion;
use crate::noise_model::{NOISE_KNOWN, stored_rounding_variance};
use crate::search::Search;

/// Share of what is left above the noise that an effect beside others explains at least, mean square.
const OF_REST: f64 = 0.5;

impl Search<'_> {
    /// Share of the gap that a set closes and another does not, in the channel that profits most.
    pub(crate) fn closes(&self, with: &CandidateModel, without: &CandidateModel) -> f64 {
        let channels = closed(with, without).zip(&self.gap);
        channels
            .map(|(closed, gap)| closed.sqrt() / gap)
            .fold(0.0, f64::max)
    }

    /// Whether what a set has beyond another is worth a name; `moves` whether that moves an output by enough.
    pub(crate) fn is_relevant(
        &self,
        with: &CandidateModel,
        without: &CandidateModel,
        moves: bool,
    ) -> bool {
        // Values that no prior holds are no set.
        if without.log_posterior() == f64::NEG_INFINITY {
            return true;
        }
        // Of two sets that cannot be told apart the smaller is the answer.
        if with.log_posterior() - without.log_posterior() < INDISTINGUISHABLE {
            return false;
        }
        // Nominal parameters that are bent to stand for the effect do what it does.
        if is_bent_from(without, with) {
            return true;
        }
        // What comes late in one channel may show in another: where records begin follows the late one.
        if !moves {
            return false;
        }
        let noise = self.noise_of(with).into_iter();
        let noise = noise.zip(self.unexplainable(without));
        let left = without.fit.variance.iter().zip(noise);
        let channels = closed(with, without).zip(left);
        let rounded = stored_rounding_variance(self.problem);
        let mut channels = channels.zip(self.gap.iter().zip(rounded));
        // A law in the place of a special case of it is no further name.
        let is_further =
            !without.effects().is_empty() && with.effects().len() > without.effects().len();
        channels.any(|((closed, (left, (noise, floor))), (gap, rounded))| {
            let stands_out = *left > NOISE_KNOWN * floor;
            stands_out
                && closed > (NOISE_KNOWN - 1.0) * rounded
                && closed > (RELEVANT_SHARE * gap).powi(2)
                && (!is_further || closed > OF_REST * (left - noise))
        })
    }

    /// Whether a set holds more effects than another and nothing beyond it that is worth a name. What refines bent nominal parameters may
    /// be a part of what they stand for.
    pub(crate) fn merely_refines(&self, set: &CandidateModel, other: &CandidateModel) -> bool {
        let known = other.key();
        let mut beyond = set.effects().iter().filter(|p| !known.contains(&name(p)));
        let moves =
            beyond.any(is_nominal) || self.is_enough(&motion::between(&set.fit, &other.fit));
        let is_larger = set.effects().len() > other.effects().len();
        is_larger && !is_bent(other) && !self.is_relevant(set, other, moves)
    }

    /// Whether one effect of a set, with everything else as it is, moves an output by enough for a name, or [`Search::may_be_small`].
    pub(crate) fn moves_enough(
        &self,
        set: &CandidateModel,
        index: usize,
    ) -> Result<bool, EstimateError> {
        if self.may_be_small(&set.effects()[index]) {
            return Ok(true);
        }
        let held = FitOptions {
            most_steps: 0,
            ..self.options.clone()
        };
        let rest = remove(&set.fit.estimate, index, self.nominal);
        let rest = fit(self.problem, &rest, &held)?;
        Ok(self.is_enough(&motion::between(&set.fit, &rest)))
    }

    /// Whether an effect is worth a name however little it moves. A wrong nominal parameter is: the others bend where it is kept as given.
    /// Within what the model states none bends, and none is, for what a simulation misses of a machine goes with its motion, and many samples
    /// show a parameter that is off by as much.
    pub(crate) fn may_be_small(&self, placed: &Placed) -> bool {
        is_nominal(placed) && matches!(self.nominal, NominalPrior::Wrong)
    }

    /// Whether what moves each output by so much, rms, is enough for a name.
    pub(crate) fn is_enough(&self, moved: &[f64]) -> bool {
        motion::is_enough(moved, &self.problem.output_std()).any(|enough| enough)
    }
}

/// Squared discrepancy of each channel that a set explains and another does not.
pub(crate) fn closed<'a>(
    with: &'a CandidateModel,
    without: &'a CandidateModel,
) -> impl Iterator<Item = f64> + 'a {
    let variances = without.fit.variance.iter().zip(&with.fit.variance);
    variances.map(|(poorer, better)| (poorer - better).max(0.0))
}
