//! The search over small sets of effects.
//!
//! One effect at a time misleads: on a positioning axis friction alone fits with a negative force
//! until a constant force is in the model too. So several sets of each size survive, every set is
//! fitted on the full nonlinear simulation, and the next size starts from each survivor.

use rayon::prelude::*;
use simgap_effects::{
    Equivalent, Family, LINES, Placed, SiteScale, equivalents_beside, same_place,
};
use simgap_estimate::{
    Base, Candidate, EstimateError, Fit, Problem, Score, Start, Weights, fit, linearise_at, score,
};
use simgap_model::Location;

use crate::accuracy::accuracy;
use crate::evidence::{effective_samples, evidence, freedom};
use crate::hypothesis::{Hypothesis, add_scored, name, prior_score, pull, rank, replace};
use crate::input_noise::{InputNoise, input_noise};
use crate::out_of_sight::{spring_to_ground, without_limits};

/// Sets of each size that the next size starts from.
const SURVIVORS: [usize; 2] = [5, 3];
/// Candidates fitted on top of each survivor, by score; the first entry is for single effects.
const FITTED: [usize; 3] = [18, 6, 4];
/// Steps of a rough fit, and of one of the search that is finished.
const ROUGH_STEPS: usize = 3;
const MOST_STEPS: usize = 10;
/// The same of hidden masses as a multiple: the way of a mode to its frequency, mass and stiffness winds.
const WINDING: usize = 4;
/// Sets that are finished of those fitted roughly.
const FINISHED: usize = 12;
/// A squared discrepancy within this factor of white noise leaves no room for a relevant effect; the
/// estimate of the noise scatters by three percent.
const NOTHING_LEFT: f64 = 1.06;
/// What leaves less than this multiple of the squared noise explains the records.
const EXPLAINED: f64 = 1.15;
/// Pull of the prior above which a nominal parameter may have to be named.
const WISH: f64 = 4.0;
/// Where parameters alone close more than all but this part of a gap, the rest counts as if it were the
/// gap's tenth: what they leave may have a cause of its own.
const PARAMETERS_APART: f64 = 10.0;
/// Scores below this cannot reach the threshold of evidence after fitting.
const HOPELESS: f64 = 1.0;

/// The search: its problem, weights and candidates.
pub(crate) struct Search<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) weights: Weights,
    pub(crate) candidates: Vec<(Candidate, SiteScale)>,
    pub(crate) effective_samples: f64,
    /// rms of the discrepancy of the model as given for each channel, at most that of the motion, and
    /// a multiple of what re-estimated parameters leave.
    pub(crate) gap: Vec<f64>,
    /// How far a simulation of each channel may be off: sets whose predictions differ by less fit alike.
    pub(crate) accuracy: Vec<f64>,
    /// What the noise of the inputs does to each channel.
    pub(crate) input_noise: Vec<InputNoise>,
}

impl<'a> Search<'a> {
    /// Prepares the candidates of the catalogue, less the withheld kinds, with their typical sizes.
    pub(crate) fn new(
        problem: &'a Problem,
        weights: Weights,
        [nominal, recalibrated, baseline]: [&Fit; 3],
        withheld: &[String],
    ) -> Result<Search<'a>, EstimateError> {
        let mut scales: Vec<(Location, SiteScale)> = vec![];
        let candidates = problem
            .candidates(|_| true)
            .into_iter()
            .filter(|candidate| !withheld.iter().any(|kind| kind == candidate.effect.kind()))
            .map(|candidate| {
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
            })
            .collect::<Result<Vec<_>, EstimateError>>()?;
        let effective_samples = effective_samples(problem, &weights);
        let variances = nominal.variance.iter().zip(&recalibrated.variance);
        let gap = variances.zip(problem.output_std());
        let gap = gap.map(|((given, left), std)| {
            let most = PARAMETERS_APART * left.sqrt();
            given.sqrt().min(std).min(most)
        });
        let input_noise = input_noise(problem, &baseline.estimate.nominal, &weights, &[])?;
        Ok(Search {
            problem,
            weights,
            candidates,
            effective_samples,
            gap: gap.collect(),
            accuracy: accuracy(problem, baseline)?,
            input_noise,
        })
    }

    /// The same search for nominal parameters alone.
    pub(crate) fn of_parameters(&self) -> Search<'a> {
        let parameters = self.candidates.iter();
        Search {
            problem: self.problem,
            weights: self.weights.clone(),
            candidates: parameters
                .filter(|(candidate, _)| candidate.effect.family() == Family::NominalParameter)
                .cloned()
                .collect(),
            effective_samples: self.effective_samples,
            gap: self.gap.clone(),
            accuracy: self.accuracy.clone(),
            input_noise: self.input_noise.clone(),
        }
    }

    /// Replaces the weights, after the colour of the residual is better known.
    pub(crate) fn reweigh(&mut self, weights: Weights) {
        self.effective_samples = effective_samples(self.problem, &weights);
        self.weights = weights;
    }

    /// Fits a set from a start.
    pub(crate) fn fit(&self, start: &Start) -> Result<Hypothesis, EstimateError> {
        Ok(self.hypothesis(fit(self.problem, start, &self.weights)?))
    }

    pub(crate) fn hypothesis(&self, fit: Fit) -> Hypothesis {
        let evidence = evidence(&fit, self.effective_samples);
        Hypothesis { fit, evidence }
    }

    /// Every set worth a fit with one more effect than `base`, best first.
    pub(crate) fn extend(
        &self,
        base: &Hypothesis,
        most: usize,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let linear = linearise_at(self.problem, &base.fit, &self.weights)?;
        self.extend_at(base, &linear, most)
    }

    pub(crate) fn extend_at(
        &self,
        base: &Hypothesis,
        linear: &Base<'_>,
        most: usize,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let scores = self.scores(base, linear)?;
        let starts: Vec<Start> = self
            .pick(scores, most, base.effects().is_empty())
            .into_iter()
            .map(|score| add_scored(&base.fit.estimate, score))
            .collect();
        self.fit_all(&starts, linear)
    }

    /// The sets in which one effect has grown into one that contains it, turns into it or resembles it.
    pub(crate) fn grow(
        &self,
        base: &Hypothesis,
        index: usize,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let starts = self.grown(base, index);
        if starts.is_empty() {
            return Ok(vec![]);
        }
        let linear = linearise_at(self.problem, &base.fit, &self.weights)?;
        self.fit_all(&starts, &linear)
    }

    /// The sets in which one effect has shrunk to a special case it contains.
    pub(crate) fn shrink(
        &self,
        base: &Hypothesis,
        index: usize,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let old = &base.effects()[index];
        let special = self.candidates.iter().filter(|(candidate, _)| {
            candidate.at == old.at && old.effect.contains().contains(&candidate.effect.kind())
        });
        let starts: Vec<Start> = special
            .map(|(candidate, scale)| {
                let mut start = base.fit.estimate.clone();
                // The first values of a larger effect are those of its special case.
                let mut values = candidate.effect.starts(scale).swap_remove(0);
                values
                    .iter_mut()
                    .zip(&old.values)
                    .for_each(|(value, old)| *value = *old);
                start.effects[index] = Placed::new(candidate.effect, old.at.clone(), values);
                start
            })
            .collect();
        starts.par_iter().map(|start| self.fit(start)).collect()
    }

    /// Typical sizes at a place of a candidate.
    pub(crate) fn scale_at(&self, at: &Location) -> Option<SiteScale> {
        let known = self.candidates.iter().find(|(known, _)| known.at == *at);
        known.map(|(_, scale)| *scale)
    }

    /// What is the same thing by another name as the i-th effect of a set, on this plant, whatever the data; of
    /// the kinds that are looked for.
    pub(crate) fn same(&self, set: &Hypothesis, i: usize) -> Vec<Equivalent> {
        let mut same = equivalents_beside(set.effects(), i, &self.problem.model);
        same.retain(|other| {
            let mut candidates = self.candidates.iter();
            candidates.any(|(known, _)| {
                known.effect.kind() == other.kind && same_place(&known.at, &other.at)
            })
        });
        same
    }

    /// How much more a set is penalised than another for its parameters.
    pub(crate) fn penalty(&self, larger: &Hypothesis, smaller: &Hypothesis) -> f64 {
        let count = |set: &Hypothesis| freedom(&set.fit);
        0.5 * (count(larger) - count(smaller)) * self.effective_samples.ln()
    }

    fn grown(&self, base: &Hypothesis, index: usize) -> Vec<Start> {
        let old = &base.effects()[index];
        let kind = old.effect.kind();
        let larger = self.candidates.iter().filter_map(|(candidate, scale)| {
            let effect = candidate.effect;
            let mut smaller = effect.contains().iter().chain(effect.turns_into());
            if candidate.at == old.at && smaller.any(|known| *known == kind) {
                return Some((candidate, *scale));
            }
            // Of a mass and its spring to the ground, the spring has the sizes.
            let spring = spring_to_ground(&candidate.at, &old.at)?;
            let resembles = effect.resembles().contains(&kind);
            Some((candidate, self.scale_at(spring)?)).filter(|_| resembles)
        });
        larger
            .flat_map(|(candidate, scale)| {
                let shapes = candidate.effect.grown_from(kind, &old.values, &scale);
                shapes.into_iter().map(move |values| {
                    let grown = Placed::new(candidate.effect, candidate.at.clone(), values);
                    without_limits(replace(&base.fit.estimate, index, grown.clone()), &grown)
                })
            })
            .collect()
    }

    /// Fits sets; of the same set from several starts the best stays. Best first.
    ///
    /// Many sets are first fitted roughly; only the best of them are worth the whole way.
    pub(crate) fn fit_all(
        &self,
        starts: &[Start],
        base: &Base<'_>,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        if starts.len() <= FINISHED {
            return self.fit_steps(starts, base, MOST_STEPS);
        }
        let mut rough = self.fit_steps(starts, base, ROUGH_STEPS)?;
        let rest = rough.split_off(rough.len().min(FINISHED));
        let promising: Vec<Start> = rough.iter().map(|set| set.fit.estimate.clone()).collect();
        let mut fitted = self.fit_steps(&promising, base, MOST_STEPS)?;
        fitted.extend(rough);
        fitted.extend(rest);
        rank(&mut fitted);
        Ok(fitted)
    }

    /// Fits sets in so many steps at the most, and those with hidden masses in more as long as no other leaves nothing
    /// but noise. Best first.
    pub(crate) fn fit_steps(
        &self,
        starts: &[Start],
        base: &Base<'_>,
        most_steps: usize,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let fit = |starts: &[&Start], most_steps| {
            let weights = Weights {
                most_steps,
                ..self.weights.clone()
            };
            let fitted = starts
                .par_iter()
                // A start from which the plant runs away is no hypothesis.
                .filter_map(|start| Some(self.hypothesis(base.fit(start, &weights).ok()?)));
            fitted.collect::<Vec<_>>()
        };
        let adds_mass = |start: &&Start| start.effects.iter().any(|p| p.action().adds_mass());
        let (winding, direct): (Vec<&Start>, Vec<&Start>) = starts.iter().partition(adds_mass);
        let mut fitted = fit(&direct, most_steps);
        if !winding.is_empty() {
            let is_told = fitted.iter().any(|set| self.is_exhausted(set));
            let factor = if is_told { 1 } else { WINDING };
            fitted.extend(fit(&winding, factor * most_steps));
        }
        fitted.retain(|set| self.is_hypothesis(set));
        rank(&mut fitted);
        Ok(fitted)
    }

    /// Whether a set can be simulated and means what it says.
    pub(crate) fn is_hypothesis(&self, set: &Hypothesis) -> bool {
        let mut effects = set.effects().iter();
        set.fit.objective.is_finite()
            && effects.all(|placed| {
                self.scale_at(&placed.at)
                    .is_none_or(|scale| placed.effect.keeps_its_meaning(&placed.values, &scale))
            })
    }

    /// Scores of all candidates that are not in the set yet, shapes included, best first.
    fn scores(&self, base: &Hypothesis, linear: &Base<'_>) -> Result<Vec<Score>, EstimateError> {
        // Lines that the set leaves: where clocks and hidden modes start.
        let mut lines: Vec<(Location, [f64; LINES])> = vec![];
        for (candidate, _) in &self.candidates {
            if lines.iter().all(|(at, _)| *at != candidate.at) {
                let left = self.problem.lines_left(&base.fit, &candidate.at);
                lines.push((candidate.at.clone(), left));
            }
        }
        let sized = |candidate: &Candidate, scale: &SiteScale| {
            let left = lines.iter().find(|(at, _)| *at == candidate.at);
            SiteScale {
                lines_hz: left.map_or(scale.lines_hz, |(_, lines)| *lines),
                ..*scale
            }
        };
        let scored = self
            .candidates
            .par_iter()
            .filter(|(candidate, _)| !base.rules_out(candidate))
            .map(|(candidate, scale)| match prior_score(base, candidate) {
                // Already adjustable under its prior: its score starts from there.
                Some(score) => vec![score],
                None => score(linear, candidate, &sized(candidate, scale)).unwrap_or_default(),
            })
            .collect::<Vec<_>>();
        let mut scores: Vec<Score> = scored.into_iter().flatten().collect();
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Ok(scores)
    }

    /// The best `most` scores, each candidate in its best shape. Of single effects two shapes are picked, and every kind gets
    /// a fit at its best place (and in every channel that hardly counts): the linear score says little where the gap is large.
    fn pick(&self, scores: Vec<Score>, most: usize, every_kind: bool) -> Vec<Score> {
        let shapes = if every_kind { 2 } else { 1 };
        let mut picked: Vec<Score> = Vec::new();
        for score in scores {
            let twins = picked
                .iter()
                .filter(|p| name(&p.start) == name(&score.start))
                .count();
            // By its weight, a channel that hardly counts would have no fit at all.
            let is_own_place = self.hardly_counts(&score.start.at);
            let kin = picked.iter().any(|Score { start: p, .. }| {
                let is_kind = p.effect.kind() == score.start.effect.kind();
                is_kind && (!is_own_place || p.at == score.start.at)
            });
            let room = picked.len() < most && score.gain > HOPELESS;
            if twins < shapes && (room || (every_kind && !kin)) {
                picked.push(score);
            }
        }
        picked
    }

    /// Whether a set leaves nothing but white noise: no further effect could lower the squared
    /// discrepancy by what makes it relevant. A nominal parameter far from its value leaves a wish, a converter its steps.
    fn is_exhausted(&self, set: &Hypothesis) -> bool {
        pull(&set.fit.estimate) <= WISH
            && self.leaves_less(set, NOTHING_LEFT)
            && !self.leaves_rounding(set)
    }

    /// Whether a set leaves less than a multiple of the squared noise of every channel.
    pub(crate) fn leaves_less(&self, set: &Hypothesis, factor: f64) -> bool {
        let stepped = crate::gap::stepped(self.problem, set.effects());
        let noise = crate::gap::noise_variance(&set.fit.discrepancy, &stepped);
        let left = set.fit.variance.iter().zip(noise);
        left.into_iter()
            .all(|(variance, noise)| *variance < factor * noise)
    }

    /// Sets of one, two and three effects that were fitted, best first.
    pub(crate) fn run(
        &self,
        base: &Hypothesis,
        step: &(dyn Fn(&str) + Sync),
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        step("single effects");
        let linear = linearise_at(self.problem, &base.fit, &self.weights)?;
        let mut pool = self.extend_at(base, &linear, FITTED[0])?;
        let is_told = |pool: &[Hypothesis]| {
            let mut sets = pool.iter();
            sets.any(|set| self.is_exhausted(set) && self.shows(set))
        };
        if !is_told(&pool) {
            step("single effects from afar");
            pool.extend(self.fit_from_afar(base, &linear)?);
            pool.extend(self.fit_from_given(base, FITTED[0])?);
        }
        pool.extend(self.fit_out_of_sight(base, &pool, &linear)?);
        rank(&mut pool);
        let mut front = pool.clone();
        for (size, survivors) in SURVIVORS.iter().enumerate() {
            if is_told(&pool) {
                break;
            }
            step(["pairs of effects", "sets of three"][size]);
            let shown = front.iter().filter(|set| self.shows(set));
            let shown: Vec<&Hypothesis> = shown.take(*survivors).collect();
            let mut next: Vec<Hypothesis> = Vec::new();
            for survivor in &shown {
                next.extend(self.extend(survivor, FITTED[size + 1])?);
            }
            if size == 0 && !is_told(&next) {
                step("pairs from afar");
                next.extend(self.extend_from_afar(&shown)?);
            }
            rank(&mut next);
            pool.extend(next.iter().cloned());
            front = next;
        }
        if !pool.iter().any(|set| self.leaves_less(set, EXPLAINED)) {
            step("single effects in stretches");
            // Where stretches cannot be simulated, nothing is found in them.
            let found = self.fit_by_shooting(base).unwrap_or_default();
            let leads = |set: &Hypothesis| pool.iter().all(|known| known.evidence < set.evidence);
            let best = found
                .first()
                .filter(|set| leads(set) && !self.is_exhausted(set));
            let beside = best.map(|set| self.extend(set, FITTED[1])).transpose()?;
            pool.extend(beside.unwrap_or_default());
            pool.extend(found);
        }
        rank(&mut pool);
        if !is_told(&pool) {
            step("pairs of fitted effects");
            pool.extend(self.unite(&pool)?);
            rank(&mut pool);
        }
        Ok(pool)
    }
}
