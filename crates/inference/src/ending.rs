//! When a search ends: nothing but noise is left, or no share that counts, and no candidate promises to be worth a name.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, fit};

use crate::candidate_model::{CandidateModel, is_bent, is_nominal, least, rank};
use crate::coincidence::coincidence;
use crate::gap::{Gap, RELEVANT_SHARE, over_noise};
use crate::noise_model::{
    NOISE_KNOWN, accuracy_of_steps, noise_variance, rounding_variance, stepped,
};
use crate::search::{ADDED, Search, counts};

impl Search<'_> {
    /// Whether the best set is at its end, or holds as many effects as any and leaves no share that counts. So many effects were `tried`
    /// together.
    pub(crate) fn is_settled(
        &self,
        pool: &[CandidateModel],
        tried: usize,
    ) -> Result<bool, EstimateError> {
        let Some(best) = pool.first() else {
            return Ok(false);
        };
        if self.is_spent() || (self.is_full(best) && self.leaves_no_share(best, pool, tried)) {
            return Ok(true);
        }
        self.is_at_its_end(best)
    }

    /// As [`Search::is_settled`], once effects were tried from many values: the best set may then hold fewer effects than any where it
    /// leaves no share that counts, for no effect beside it could be worth a name, and nothing promises to make it likelier.
    ///
    /// A best set that leaves nothing but noise is not at its end where something promises to be worth a name beside it. That is added
    /// here before anything else is tried, as long as the set grows likelier by it.
    pub(crate) fn settle(
        &self,
        pool: &mut Vec<CandidateModel>,
        tried: usize,
    ) -> Result<bool, EstimateError> {
        while !self.is_settled(pool, tried)? {
            let Some(best) = pool.first().cloned() else {
                return Ok(false);
            };
            if !self.leaves_only_noise(&best) {
                let leaves_little = self.leaves_no_share(&best, pool, tried);
                return Ok(leaves_little && !self.is_promising(&best)?);
            }
            if !self.is_full(&best) {
                pool.extend(self.extend(&best, ADDED)?);
                rank(pool);
            }
            let stays = pool.first().is_none_or(|first| first.key() == best.key());
            if stays {
                break;
            }
        }
        Ok(true)
    }

    /// Whether a set leaves no share that counts of what wrong nominal parameters leave alone, so far as these were fitted. Of more
    /// effects than were tried together, beside wrong nominal parameters, that is not said: it may stand in for fewer. So it is where values
    /// of two effects agree: one cause may be behind both.
    fn leaves_no_share(&self, set: &CandidateModel, pool: &[CandidateModel], tried: usize) -> bool {
        if counts(set)[0] > tried || coincidence(set, &self.space).is_some() {
            return false;
        }
        let are_alone = |set: &&CandidateModel| set.effects().iter().all(is_nominal);
        least(pool.iter().filter(are_alone)).is_none_or(|alone| {
            let (left, noise) = (&set.fit.variance, self.noise_of(set));
            let std = self.problem.output_std();
            let gap = Gap::of(&alone.fit.variance, left, &noise, &std);
            gap.left(left) < RELEVANT_SHARE
        })
    }

    /// Whether nothing that is added to a set could make it likelier: it leaves nothing but noise or, of wrong parameters, less than
    /// what is worth a name would move, and no candidate promises to be worth one.
    pub(crate) fn is_at_its_end(&self, set: &CandidateModel) -> Result<bool, EstimateError> {
        let mut left = set.fit.variance.iter().zip(self.unexplainable(set));
        let explains_all = left.all(|(left, floor)| *left < NOISE_KNOWN * floor);
        // Nominal parameters further off than the model states are likelier wrong.
        if explains_all && !is_bent(set) {
            return Ok(true);
        }
        let noise = self.noise_of(set);
        let leaves_noise = self.leaves_noise(set, &noise);
        // An effect that is worth a name moves more than this leaves; of a law, another may leave less.
        let over_noise: Vec<f64> = over_noise(&set.fit.variance, &noise).collect();
        let are_parameters = !set.effects().is_empty() && set.effects().iter().all(is_nominal);
        let leaves_little = are_parameters && !self.is_enough(&over_noise);
        Ok((leaves_little || leaves_noise) && !self.is_promising(set)?)
    }

    /// Whether the set that leaves least leaves nothing but noise once it is fitted under the colour of that: beside a slow effect that
    /// it holds and the others do not, records have few independent samples.
    pub(crate) fn leaves_noise_by_its_colour(&self, pool: &[CandidateModel]) -> bool {
        let Some(least) = least(pool) else {
            return false;
        };
        let options = self.noise.with_colour_of(&least.fit).search_options();
        let again = fit(self.problem, &least.fit.estimate, &options);
        again.is_ok_and(|again| {
            let again = self.candidate_model(again);
            self.leaves_only_noise(&again)
        })
    }

    /// Whether a set leaves nothing but noise, where that was not told before.
    pub(crate) fn leaves_only_noise(&self, set: &CandidateModel) -> bool {
        self.leaves_noise(set, &self.noise_of(set))
    }

    /// Whether a set leaves nothing but noise ([`Search::noise_of`] it). What a converter rounds off looks like noise, and is explained by its steps.
    fn leaves_noise(&self, set: &CandidateModel, noise: &[f64]) -> bool {
        let beside = self.space.candidates.iter();
        let beside = beside.filter(|(candidate, _)| !set.holds(candidate));
        let steps = beside.filter_map(|(candidate, scale)| {
            let values = candidate.effect.starts(scale).into_iter().next()?;
            let placed = Placed::new(candidate.effect, candidate.at.clone(), values);
            placed.action().is_stepped().then_some(placed)
        });
        let rounded = rounding_variance(self.problem, &steps.collect::<Vec<_>>());
        let noise = noise.iter().zip(rounded);
        let mut channels = set.fit.variance.iter().zip(noise);
        channels.all(|(left, (noise, rounded))| *left < NOISE_KNOWN * (noise - rounded).max(0.0))
    }

    /// Noise of the sensors in what a set leaves, and how far a simulation of it may be off, mean square of each channel.
    #[must_use]
    pub fn noise_of(&self, set: &CandidateModel) -> Vec<f64> {
        let stepped = stepped(self.problem, set.effects());
        let noise = noise_variance(&set.fit.discrepancy, &stepped);
        let channels = noise.iter().zip(self.floor_of(set));
        channels.map(|(noise, floor)| noise + floor).collect()
    }

    /// What no set beyond this one is expected to explain, mean square of each channel: the accuracy of the simulation, noise
    /// of the inputs, and what the steps of the set round off.
    pub(crate) fn unexplainable(&self, set: &CandidateModel) -> Vec<f64> {
        let rounded = rounding_variance(self.problem, set.effects());
        let channels = self.floor_of(set).into_iter().zip(rounded);
        channels.map(|(floor, rounded)| floor + rounded).collect()
    }

    /// What no set is expected to explain, and what the steps of the march miss of the forces of this one, mean square of each channel.
    fn floor_of(&self, set: &CandidateModel) -> Vec<f64> {
        let std = self.problem.output_std();
        let of_all = self.options.floor.iter().zip(&std);
        let of_all = of_all.map(|(floor, std)| (floor * std).powi(2));
        // A set that cannot be simulated was not fitted.
        let of_steps = accuracy_of_steps(self.problem, &set.fit);
        let of_steps = of_steps.unwrap_or_else(|_| vec![0.0; std.len()]);
        let channels = of_all.zip(of_steps);
        channels
            .map(|(floor, steps)| floor + steps.powi(2))
            .collect()
    }
}
