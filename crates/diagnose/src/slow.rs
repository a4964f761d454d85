//! Effects that explain a channel which hardly counts.
//!
//! A discrepancy that is slow from end to end of a record is one observation, however many samples it has: the channel
//! hardly counts, whoever explains it gains little, and the search goes after trifles in other channels. A drift of a
//! sensor is the plainest case. But what leaves white noise of such a channel, or next to nothing, has explained
//! every sample of it.

use simgap_estimate::{EstimateError, Fit, Start, Weights};
use simgap_model::Location;

use crate::evidence::independence;
use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// Share of independent samples below which a channel hardly counts.
const SLOW: f64 = 0.02;
/// The same of what is left above which it is nearly white.
const WHITE: f64 = 0.1;
/// What is left of the squared discrepancy of the best set, at the most.
const LEFT: f64 = 0.25;
/// The same that is enough whatever its colour: parameters that are held where they are known, for want of weight, leave slow
/// trifles.
const HARDLY_LEFT: f64 = 1e-3;

impl Search<'_> {
    /// The set without effects and those that were found, best first; found anew with other weights where the first
    /// passed something over. `colour` tells the weights by what a fit leaves.
    pub(crate) fn run_weighed(
        &mut self,
        first: &Start,
        colour: impl Fn(&Fit) -> Weights,
        step: &(dyn Fn(&str) + Sync),
    ) -> Result<(Hypothesis, Vec<Hypothesis>), EstimateError> {
        let base = self.fit(first)?;
        let pool = self.run(&base, step)?;
        let Some(found) = self.passed_over(&pool) else {
            return Ok((base, pool));
        };
        self.reweigh(colour(&found.fit));
        let base = self.fit(first)?;
        let pool = self.run(&base, step)?;
        Ok((base, pool))
    }

    /// Whether a place is a channel whose discrepancy is so slow that it hardly counts.
    pub(crate) fn hardly_counts(&self, at: &Location) -> bool {
        let Location::Channel(channel) = at else {
            return false;
        };
        let output = self.problem.model.output_index(channel);
        output.is_some_and(|c| self.weights.independence[c] < SLOW)
    }

    /// The set that explains a slow channel where the best one does not: by its colour the channels are weighed aright.
    fn passed_over<'a>(&self, pool: &'a [Hypothesis]) -> Option<&'a Hypothesis> {
        let best = &pool.first()?.fit.variance;
        let worth = |set: &Hypothesis| {
            let white = independence(&set.fit, best.len());
            let channels = (0..best.len()).filter(|&c| {
                let left = set.fit.variance[c] / best[c];
                self.weights.independence[c] < SLOW
                    && ((white[c] > WHITE && left < LEFT) || left < HARDLY_LEFT)
            });
            let gains = channels.map(|c| white[c] * (best[c] / set.fit.variance[c]).ln());
            gains.sum::<f64>()
        };
        let worth = pool.iter().map(|set| (set, worth(set)));
        let most = worth.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
        Some(most.0).filter(|_| most.1 > 0.0)
    }
}
