//! The search: which proposals are made, within a budget.
//!
//! ```text
//! wrong nominal parameters: those that are off once all are re-estimated
//! single effects: by score; from many values; dynamics of parameters; what the best ones grow into
//! effects beside nominal parameters that are re-estimated; before those from many values where the gap bends the parameters of the model
//! pairs, sets of three: from the best sets so far, by score and from many values
//! stretches of the records, each with a start of its own (multiple shooting)
//! the best set: each effect removed, exchanged, shrunk; the best sets: grown, rescaled, one more added; until it stays
//! ```
//!
//! A stage is left out where the best set leaves nothing but noise, or, if it is one of wrong parameters, less than an effect that is worth
//! a name would move, and no candidate promises to be worth a name: its score pays for its prior and for the values that it
//! adjusts, it moves an output by enough, and a fit keeps it. So it is where the best set leaves no share that counts of what wrong
//! parameters leave alone, and holds as many effects as any or, once effects were tried from many values, nothing promises; but for a set
//! of more effects than were tried together yet, which may stand in for fewer, and for one of which two values agree. What promises beside a best set that leaves nothing but
//! noise is added to it before the next stage (`ending.rs`).

use std::collections::BTreeSet;

use rayon::prelude::*;
use simgap_effects::Family;
use simgap_estimate::{
    Base, Candidate, EstimateError, Fit, FitOptions, Problem, Start, fit, linearise_at,
};

use crate::candidate_model::{
    CandidateModel, INDISTINGUISHABLE, NominalPrior, is_bent, is_nominal, name, rank,
};
use crate::extended::{Extended, Visited};
use crate::marginal_likelihood::log_marginal_likelihood;
use crate::model_space::ModelSpace;
use crate::noise_model::{NoiseModel, log_likelihood_at_range_ends};
use crate::stage::Stage;

/// Sets of each size that the next size starts from.
const SURVIVORS: [usize; 2] = [5, 3];
/// Candidates fitted on top of each survivor, by score; the first entry is for single effects.
pub(crate) const FITTED: [usize; 3] = [18, 6, 4];
/// Sets that are extended in the end: the best one may be a stand-in for a larger set that holds the next.
const LEADING: usize = 3;
/// Candidates fitted beside each of them; in the place of one of its effects as many as beside a single one.
pub(crate) const ADDED: usize = 4;
/// Effects of a set at the most; wrong nominal parameters besides.
pub(crate) const MOST_EFFECTS: usize = 3;
const MOST_PARAMETERS: usize = 3;
/// Rounds of changes to the best set.
const ROUNDS: usize = 4;

/// What counts of a set that holds so many effects of other families and so many wrong nominal parameters.
pub(crate) fn size(others: usize, parameters: usize) -> usize {
    others + parameters.saturating_sub(MOST_PARAMETERS)
}

/// Effects of other families and wrong nominal parameters of a set.
pub(crate) fn counts(set: &CandidateModel) -> [usize; 2] {
    let parameters = set.effects().iter().filter(|p| is_nominal(p)).count();
    [set.effects().len() - parameters, parameters]
}

/// The first of some ranked sets of which each holds an effect, or a wrong nominal value, that none before holds, then the first of
/// the others: a cause that leads now and stands in for another is in most of the best sets.
fn survivors_of(ranked: &[CandidateModel], most: usize) -> Vec<&CandidateModel> {
    let mut known: BTreeSet<String> = BTreeSet::new();
    let (mut new, rest): (Vec<&CandidateModel>, Vec<&CandidateModel>) =
        ranked.iter().partition(|set| {
            let names: Vec<String> = set.effects().iter().map(name).collect();
            let before = known.len();
            known.extend(names);
            known.len() > before
        });
    new.extend(rest);
    new.truncate(most);
    new
}

/// Of each set the first.
fn distinct(pool: &[CandidateModel]) -> impl Iterator<Item = &CandidateModel> {
    let mut seen = BTreeSet::new();
    pool.iter().filter(move |set| seen.insert(set.key()))
}

/// Told what is being done, and asked whether to go on.
#[derive(Clone, Copy)]
pub struct Budget<'a> {
    /// Called at the start of each stage.
    pub progress: &'a (dyn Fn(&str) + Sync),
    /// Whether the search ends here.
    pub is_spent: &'a (dyn Fn() -> bool + Sync),
}

/// A search over the sets of a model space.
pub struct Search<'a> {
    /// What is searched in.
    pub problem: &'a Problem,
    pub(crate) noise: NoiseModel,
    /// How sets are fitted.
    pub options: FitOptions,
    /// What there is.
    pub space: ModelSpace,
    /// The gap that is to be explained, rms of each channel.
    pub(crate) gap: Vec<f64>,
    pub(crate) nominal: NominalPrior,
    /// When to stop.
    pub budget: Budget<'a>,
    pub(crate) visited: Visited,
}

impl<'a> Search<'a> {
    /// A search for every kind. What is worth a name is a matter of the gap, rms of each channel.
    #[must_use]
    pub fn new(
        problem: &'a Problem,
        noise: &NoiseModel,
        space: ModelSpace,
        gap: &[f64],
        budget: Budget<'a>,
    ) -> Search<'a> {
        Search {
            problem,
            noise: noise.clone(),
            options: noise.search_options(),
            space,
            gap: gap.to_vec(),
            nominal: NominalPrior::Wrong,
            budget,
            visited: Visited::default(),
        }
    }

    /// The same search for nominal parameters alone, each as far off as the model states.
    #[must_use]
    pub fn of_stated_parameters(&self, stated_std: f64) -> Search<'a> {
        Search {
            problem: self.problem,
            noise: self.noise.clone(),
            options: self.options.clone(),
            space: self
                .space
                .of_families(|family| family == Family::NominalParameter),
            gap: self.gap.clone(),
            nominal: NominalPrior::Stated(stated_std),
            budget: self.budget,
            visited: Visited::default(),
        }
    }

    pub(crate) fn tell(&self, stage: Stage) {
        (self.budget.progress)(stage.name());
    }

    /// Whether the search ends here. Asked between stages and between parts of them that follow each other, never by one of several
    /// that run side by side: what these have done by then would depend on the threads.
    pub(crate) fn is_spent(&self) -> bool {
        (self.budget.is_spent)()
    }

    /// What comes of some proposals, in their order until the search ends. As many are tried side by side, before it is asked whether it
    /// does, as are fitted on top of a set.
    pub(crate) fn try_each<T: Sync, R: Send>(
        &self,
        proposals: &[T],
        outcome: impl Fn(&T) -> R + Sync,
    ) -> Vec<R> {
        let mut outcomes = Vec::with_capacity(proposals.len());
        for few in proposals.chunks(FITTED[1]) {
            if self.is_spent() {
                break;
            }
            outcomes.par_extend(few.par_iter().map(&outcome));
        }
        outcomes
    }

    /// Fits a set from a start.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated from the start.
    pub fn fit(&self, start: &Start) -> Result<CandidateModel, EstimateError> {
        Ok(self.candidate_model(fit(self.problem, start, &self.options)?))
    }

    pub(crate) fn candidate_model(&self, fit: Fit) -> CandidateModel {
        let scale_at = |at: &simgap_model::Location| self.space.scale_at(at);
        let at_range_ends = log_likelihood_at_range_ends(self.problem, &fit);
        CandidateModel {
            log_marginal_likelihood: log_marginal_likelihood(&fit, scale_at, self.nominal)
                + at_range_ends.unwrap_or(f64::NEG_INFINITY),
            log_prior: self.space.log_prior(&fit.estimate.effects),
            fit,
        }
    }

    /// Whether a set holds as many effects as any set.
    pub(crate) fn is_full(&self, set: &CandidateModel) -> bool {
        let [others, parameters] = counts(set);
        size(others, parameters) >= MOST_EFFECTS
    }

    /// Whether a set is no larger than any set may be.
    pub(crate) fn is_allowed(&self, set: &CandidateModel) -> bool {
        let [others, parameters] = counts(set);
        size(others, parameters) <= MOST_EFFECTS
    }

    /// Whether a candidate may be added to a set: it makes sense beside the effects of the set, which has room for it.
    pub(crate) fn may_hold(&self, set: &CandidateModel, candidate: &Candidate) -> bool {
        let [others, parameters] = counts(set);
        let size = match candidate.effect.family() {
            Family::NominalParameter => size(others, parameters + 1),
            _ => size(others + 1, parameters),
        };
        size <= MOST_EFFECTS && !set.rules_out(candidate)
    }

    /// Sets of none to three effects, best first.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn run(&mut self, base: &CandidateModel) -> Result<Vec<CandidateModel>, EstimateError> {
        let mut pool = vec![base.clone()];
        if self.is_settled(&pool, 0)? {
            return Ok(pool);
        }
        self.tell(Stage::NominalParameters);
        let recalibrated = self.recalibrated(base);
        pool.extend(self.with_parameters_named(recalibrated.clone().into_iter().collect()));
        self.tell(Stage::Singles);
        let linear = linearise_at(self.problem, &base.fit, &self.options)?;
        pool.extend(self.extend_at(base, &linear, FITTED[0])?);
        pool.extend(self.slips(base));
        rank(&mut pool);
        let is_settled = self.settle(&mut pool, 0)?;
        if is_settled || !self.leaves_noise_by_its_colour(&pool) {
            return self.run_on((base, &linear), recalibrated, pool, is_settled);
        }
        pool = self.recolour(&pool);
        let is_settled = self.settle(&mut pool, 0)?;
        let base = &self.fit(&base.fit.estimate)?;
        let linear = linearise_at(self.problem, &base.fit, &self.options)?;
        self.run_on((base, &linear), recalibrated, pool, is_settled)
    }

    /// Goes on from single effects, found by their score from a base.
    fn run_on(
        &self,
        (base, linear): (&CandidateModel, &Base<'_>),
        recalibrated: Option<CandidateModel>,
        mut pool: Vec<CandidateModel>,
        mut is_settled: bool,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        // Bent nominal parameters are likelier wrong: beside those first.
        let is_bent = is_bent(base);
        if is_bent && !is_settled {
            is_settled = self.beside(recalibrated.as_ref(), &mut pool, 0)?;
        }
        if !is_settled {
            self.tell(Stage::SinglesFromManyValues);
            pool.extend(self.multistart(base, linear)?);
            pool.extend(self.fit_from_given(base, FITTED[0])?);
        }
        pool.extend(self.fit_dynamics_of_parameters(base, &pool, linear));
        rank(&mut pool);
        // What leaves little may still be the shadow of another cause.
        let best = pool.first().map(CandidateModel::log_posterior);
        let leading = distinct(&pool).take_while(|set| {
            best.is_some_and(|best| set.log_posterior() >= best - INDISTINGUISHABLE)
        });
        let singles = leading.filter(|set| set.effects().len() == 1);
        let grown: Result<Vec<_>, _> = singles.map(|single| self.grow(single, 0)).collect();
        pool.extend(grown?.concat());
        rank(&mut pool);
        // That one effect leaves no share that counts is said once effects were tried beside parameters, too.
        is_settled = self.settle(&mut pool, usize::from(is_bent))?;
        if !is_bent && !is_settled {
            is_settled = self.beside(recalibrated.as_ref(), &mut pool, 1)?;
        }
        let mut front: Vec<CandidateModel> = pool.clone();
        front.retain(|set| !set.effects().is_empty() && !self.is_full(set));
        for (size, survivors) in SURVIVORS.iter().enumerate() {
            if is_settled {
                return Ok(pool);
            }
            self.tell([Stage::Pairs, Stage::Threes][size]);
            let best = survivors_of(&front, *survivors);
            let mut next: Vec<CandidateModel> = Vec::new();
            for survivor in &best {
                next.extend(self.extend(survivor, FITTED[size + 1])?);
            }
            if size == 0 {
                next.extend(self.unite(&pool)?);
                next.extend(self.fit_joint(base, linear));
            }
            pool.extend(next.iter().cloned());
            rank(&mut pool);
            is_settled = self.settle(&mut pool, size + 2)?;
            if size == 0 && !is_settled {
                self.tell(Stage::PairsFromManyValues);
                let far = self.extend_from_many_values(&best)?;
                next.extend(far.iter().cloned());
                pool.extend(far);
                rank(&mut pool);
                is_settled = self.settle(&mut pool, size + 2)?;
            }
            rank(&mut next);
            front = next;
            front.retain(|set| !self.is_full(set));
        }
        if !is_settled {
            self.tell(Stage::Stretches);
            // Where stretches cannot be simulated, nothing is found in them.
            let known = pool
                .first()
                .map_or(f64::NEG_INFINITY, CandidateModel::log_posterior);
            let found = self.multiple_shooting(base, known).unwrap_or_default();
            let leads = found.first().filter(|set| set.log_posterior() > known);
            if let Some(best) = leads {
                pool.extend(self.extend(best, FITTED[1])?);
            }
            pool.extend(found);
            rank(&mut pool);
        }
        Ok(pool)
    }

    /// Adds the sets of effects beside re-estimated nominal parameters, and tells whether the search is settled then.
    fn beside(
        &self,
        recalibrated: Option<&CandidateModel>,
        pool: &mut Vec<CandidateModel>,
        tried: usize,
    ) -> Result<bool, EstimateError> {
        let Some(recalibrated) = recalibrated else {
            return Ok(false);
        };
        self.tell(Stage::BesideParameters);
        pool.extend(self.beside_recalibrated(recalibrated)?);
        rank(pool);
        self.settle(pool, tried)
    }

    /// Adds to the best sets unless the best is at its end, changes the best of them by one effect, and again, as long as a better one
    /// is found and the search has not ended. What was tried stays in the pool.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn refine(&self, pool: &mut Vec<CandidateModel>) -> Result<(), EstimateError> {
        let (rescaled, grown) = (Extended::default(), Extended::default());
        for _ in 0..ROUNDS {
            if self.is_spent() {
                return Ok(());
            }
            self.tell(Stage::Changes);
            let is_settled = self.settle(pool, MOST_EFFECTS)?;
            let Some(best) = pool.first().cloned() else {
                return Ok(());
            };
            let leading = distinct(pool)
                .filter(|set| !(is_settled && self.merely_refines(set, &best)))
                .take(LEADING);
            let leading: Vec<CandidateModel> = leading.cloned().collect();
            if !is_settled {
                for set in leading.iter().filter(|set| !self.is_full(set)) {
                    pool.extend(self.extend(set, ADDED)?);
                }
            }
            for set in leading.iter().filter(|set| !grown.holds(set, 1)) {
                grown.note(set, 1);
                for i in 0..set.effects().len() {
                    pool.extend(self.grow(set, i)?);
                }
            }
            for i in 0..best.effects().len() {
                pool.extend(self.shrink(&best, i));
                if let Ok(smaller) = self.fit(&self.without(&best, i)) {
                    // Single effects of every kind are in the pool.
                    if !smaller.effects().is_empty() {
                        pool.extend(self.extend(&smaller, FITTED[1])?);
                    }
                    pool.push(smaller);
                }
            }
            for set in leading.iter().filter(|set| !rescaled.holds(set, 1)) {
                rescaled.note(set, 1);
                pool.extend(self.rescale(set));
            }
            pool.retain(|set| set.log_marginal_likelihood.is_finite());
            rank(pool);
            let stays = pool.first().is_none_or(|first| {
                let refines = is_settled && self.merely_refines(first, &best);
                refines || first.key() == best.key()
            });
            if stays {
                return Ok(());
            }
        }
        Ok(())
    }
}
