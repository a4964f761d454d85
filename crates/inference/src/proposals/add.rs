//! A set with one more effect, from the scores of all candidates.

use std::collections::BTreeSet;

use rayon::prelude::*;
use simgap_effects::SiteScale;
use simgap_estimate::{
    Base, Candidate, EstimateError, FitOptions, Score, Start, linearise_at, score,
};
use simgap_model::Location;

use crate::candidate_model::{
    CandidateModel, INDISTINGUISHABLE, add_scored, is_bent, is_nominal, is_of, name, prior_score,
    rank,
};
use crate::motion;
use crate::search::{FITTED, Search};

/// Steps of a rough fit.
pub(crate) const ROUGH_STEPS: usize = 3;
/// Steps of a hidden mass as a multiple: the way of a mode to its frequency, mass and stiffness winds.
const WINDING: usize = 4;
/// How often the last effect of a start is halved from which the plant runs away.
const HALVINGS: usize = 5;
/// Sets that are finished of more: those of the best starts, and those of the others that are the best once they are fitted roughly.
pub(crate) const FINISHED: [usize; 2] = [4, 8];

impl Search<'_> {
    /// Every set worth a fit with one more effect than `base`, best first; none where it has been asked before.
    pub(crate) fn extend(
        &self,
        base: &CandidateModel,
        most: usize,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        if self.visited.extended.holds(base, most) {
            return Ok(vec![]);
        }
        let linear = linearise_at(self.problem, &base.fit, &self.options)?;
        self.extend_at(base, &linear, most)
    }

    pub(crate) fn extend_at(
        &self,
        base: &CandidateModel,
        linear: &Base<'_>,
        most: usize,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        self.visited.extended.note(base, most);
        let scores = self.scores(base, linear);
        let starts: Vec<Start> = pick(scores, most, base.effects().is_empty())
            .into_iter()
            .map(|score| add_scored(&base.fit.estimate, score))
            .collect();
        Ok(self.fit_all(&starts, linear))
    }

    /// Whether a further effect promises to make a set likelier, and to be worth a name: its gain is above its prior and what its
    /// values cost that the gain lets them be known by, ½ ln(1 + 2 gain) each, it moves an output by enough, and a fit keeps it.
    pub(crate) fn is_promising(&self, set: &CandidateModel) -> Result<bool, EstimateError> {
        if self.visited.unpromising.holds(set, 0) {
            return Ok(false);
        }
        let linear = linearise_at(self.problem, &set.fit, &self.options)?;
        let least = set.log_posterior() + INDISTINGUISHABLE;
        for few in self.worth_a_name(set, &linear).chunks(FITTED[1]) {
            let fitted = self.fit_steps(few, &linear, self.options.most_steps);
            for with in fitted.iter().filter(|with| with.log_posterior() > least) {
                if self.is_last_relevant(with, set)? {
                    return Ok(true);
                }
            }
        }
        self.visited.unpromising.note(set, 0);
        Ok(false)
    }

    /// Whether the last effect of a set, which another does not hold, is worth a name.
    fn is_last_relevant(
        &self,
        with: &CandidateModel,
        without: &CandidateModel,
    ) -> Result<bool, EstimateError> {
        let Some(last) = with.effects().len().checked_sub(1) else {
            return Ok(false);
        };
        // Of several wrong parameters that the others are bent by, one alone leaves them bent.
        if is_bent(without) && is_nominal(&with.effects()[last]) {
            return Ok(true);
        }
        let moves = self.moves_enough(with, last)?;
        Ok(self.is_relevant(with, without, moves))
    }

    /// Starts of a set with one more effect, each of which pays for itself by its score and moves an output by enough.
    fn worth_a_name(&self, set: &CandidateModel, linear: &Base<'_>) -> Vec<Start> {
        let runs = self.problem.runs.len();
        let pays = |score: &Score| {
            let effect = score.start.effect;
            let parameters = effect.parameters().iter().enumerate();
            let adjusted = parameters.filter(|(k, _)| !effect.is_chosen(*k));
            let values: usize = adjusted
                .map(|(_, parameter)| if parameter.per_record { runs } else { 1 })
                .sum();
            let known = 0.5 * values as f64 * (2.0 * score.gain.max(0.0)).ln_1p();
            score.gain + self.space.log_prior_of(effect) - known >= 0.0
        };
        let held = FitOptions {
            most_steps: 0,
            ..self.options.clone()
        };
        let mut paying = self.scores(set, linear);
        paying.retain(pays);
        let moving = paying.into_par_iter().filter_map(|score| {
            let may_be_small = self.may_be_small(&score.start);
            let start = add_scored(&set.fit.estimate, score);
            // From a start where the plant runs away nothing is promised.
            let with = linear.fit(&start, &held).ok()?;
            let moved = motion::between(&with, &set.fit);
            (may_be_small || self.is_enough(&moved)).then_some(start)
        });
        let mut starts: Vec<Start> = moving.collect();
        let mut asked = BTreeSet::new();
        starts.retain(|start| {
            start
                .effects
                .last()
                .is_some_and(|last| asked.insert(name(last)))
        });
        starts
    }

    /// Scores of all candidates that are not in the set yet, shapes included, best first.
    fn scores(&self, base: &CandidateModel, linear: &Base<'_>) -> Vec<Score> {
        // Lines and carriers that the set leaves, and by how much signals come late: where clocks, hidden modes and long delays start.
        let mut left: Vec<(Location, SiteScale)> = vec![];
        for (candidate, scale) in &self.space.candidates {
            let at = &candidate.at;
            if left.iter().all(|(known, _)| known != at) {
                // Of all channels together: the same at every input.
                let is_input = |at: &Location| matches!(at, Location::Input(_));
                let known = left.iter().find(|(of, _)| is_input(of) && is_input(at));
                let late_s =
                    known.map_or_else(|| self.problem.late(&base.fit, at), |(_, left)| left.late_s);
                let scale = SiteScale {
                    lines_hz: self.problem.lines_left(&base.fit, at),
                    carriers_hz: self.problem.carriers_left(&base.fit, at),
                    late_s,
                    ..*scale
                };
                left.push((at.clone(), scale));
            }
        }
        let sized = |at: &Location| left.iter().find(|(known, _)| known == at);
        let scored = self
            .space
            .candidates
            .par_iter()
            .filter(|(candidate, _)| self.may_hold(base, candidate))
            .map(|(candidate, scale)| match prior_score(base, candidate) {
                // Already adjustable under its narrow prior: its score starts from there.
                Some(score) => vec![score],
                None => {
                    let scale = sized(&candidate.at).map_or(scale, |(_, scale)| scale);
                    score(linear, candidate, scale).unwrap_or_default()
                }
            })
            .collect::<Vec<_>>();
        let mut scores: Vec<Score> = scored.into_iter().flatten().collect();
        scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        scores
    }

    /// Fits sets; of the same set from several starts, the best first, the best stays. Best first.
    ///
    /// Many sets are first fitted roughly; only the best of them are worth the whole way. So are those of the best starts, however far
    /// a few steps take them: an effect that is much of its size off has the longest way.
    pub(crate) fn fit_all(&self, starts: &[Start], base: &Base<'_>) -> Vec<CandidateModel> {
        let [of_starts, of_rough] = FINISHED;
        if starts.len() <= of_starts + of_rough {
            return self.fit_steps(starts, base, self.options.most_steps);
        }
        let (leading, others) = starts.split_at(of_starts);
        let mut fitted = self.fit_steps(leading, base, self.options.most_steps);
        let rough = self.fit_steps(others, base, ROUGH_STEPS);
        let promising = rough.iter().take(of_rough);
        let promising: Vec<Start> = promising.map(|set| set.fit.estimate.clone()).collect();
        fitted.extend(self.fit_steps(&promising, base, self.options.most_steps));
        fitted.extend(rough);
        rank(&mut fitted);
        fitted
    }

    /// Fits sets in so many steps at the most, those with hidden masses in more. Best first.
    pub(crate) fn fit_steps(
        &self,
        starts: &[Start],
        base: &Base<'_>,
        most_steps: usize,
    ) -> Vec<CandidateModel> {
        let fitted = self.try_each(starts, |start| {
            let adds_mass = start.effects.iter().any(|p| p.action().adds_mass());
            let options = FitOptions {
                most_steps: if adds_mass {
                    WINDING * most_steps
                } else {
                    most_steps
                },
                ..self.options.clone()
            };
            // A start from which the plant runs away is no candidate, nor is half of it, and so on: a spring that softens is
            // scored where the motion is small.
            let mut start = start.clone();
            let mut found = base.fit(&start, &options).ok()?;
            for _ in 0..HALVINGS {
                if found.misfit.is_finite() || !halve_last(&mut start) {
                    break;
                }
                found = base.fit(&start, &options).ok()?;
            }
            Some(self.candidate_model(found))
        });
        let mut fitted: Vec<CandidateModel> = fitted.into_iter().flatten().collect();
        fitted.retain(|set| set.log_marginal_likelihood.is_finite());
        rank(&mut fitted);
        fitted
    }
}

/// Halves the sizes of the last effect of a start; whether there are any.
fn halve_last(start: &mut Start) -> bool {
    let Some(last) = start.effects.last_mut() else {
        return false;
    };
    let parameters = last.effect.parameters().iter();
    let sizes = parameters
        .zip(&mut last.values)
        .filter_map(|(parameter, value)| {
            let neutral = parameter.neutral.filter(|neutral| neutral.is_finite())?;
            Some((neutral, value))
        });
    let mut is_smaller = false;
    for (neutral, value) in sizes {
        is_smaller |= *value != neutral;
        *value = 0.5 * (neutral + *value);
    }
    is_smaller
}

/// The best `most` scores, each candidate in its best shape. Of single effects two shapes are picked, and every kind gets
/// a fit at its best place: the linear score says little where the gap is large.
fn pick(scores: Vec<Score>, most: usize, every_kind: bool) -> Vec<Score> {
    let shapes = if every_kind { 2 } else { 1 };
    let mut picked: Vec<Score> = Vec::new();
    for score in scores {
        let twins = picked
            .iter()
            .filter(|p| name(&p.start) == name(&score.start));
        let is_new_shape = twins.count() < shapes;
        let has_kin = |p: &Score| p.start.effect.kind() == score.start.effect.kind();
        let room = picked.len() < most && score.gain > 1.0;
        if is_new_shape && (room || (every_kind && !picked.iter().any(has_kin))) {
            picked.push(score);
        }
    }
    picked
}

impl CandidateModel {
    /// Whether a candidate is one of the effects of the set.
    pub(crate) fn holds(&self, candidate: &Candidate) -> bool {
        self.effects().iter().any(|placed| is_of(placed, candidate))
    }
}

#[cfg(test)]
mod tests {
    use simgap_effects::{Placed, find};
    use simgap_estimate::{Problem, fit};
    use simgap_model::Model;
    use simgap_simulate::{Mended, Run, Simulator};

    use super::*;
    use crate::candidate_model::add;
    use crate::model_space::ModelSpace;
    use crate::noise_model::NoiseModel;
    use crate::search::Budget;

    fn problem(text: &str, time_step_s: f64, inputs: Vec<Vec<f64>>, measured: Vec<f64>) -> Problem {
        let run = Run {
            name: "run".into(),
            start_s: 0.0,
            time_step_s,
            len: measured.len(),
            first_index: 0,
            inputs,
            measured: vec![Some(measured)],
            mended: Mended::default(),
        };
        Problem::new(&Model::from_toml(text).unwrap(), vec![run]).unwrap()
    }

    /// What is asked of a search about the set of a start.
    fn asked<T>(
        problem: &mut Problem,
        start: &Start,
        ask: impl FnOnce(&Search<'_>, &CandidateModel, &Base<'_>) -> T,
    ) -> T {
        let nothing = Start {
            effects: vec![],
            ..start.clone()
        };
        let baseline = fit(problem, &nothing, &FitOptions::white(1)).unwrap();
        let noise = NoiseModel::new(problem, &baseline, &baseline).unwrap();
        let space = ModelSpace::new(problem, &baseline, &[]).unwrap();
        space.put_priors(problem);
        let std = problem.output_std();
        let budget = Budget {
            progress: &|_| {},
            is_spent: &|| false,
        };
        let search = Search::new(problem, &noise, space, &std, budget);
        let base = search.fit(start).unwrap();
        let linear = linearise_at(problem, &base.fit, &search.options).unwrap();
        ask(&search, &base, &linear)
    }

    /// A gain that swings slowly, beside a delay whose own carriers are others.
    #[test]
    fn verify_carriers_are_those_of_what_a_set_leaves() {
        let text = "schema = \"simgap-model/1\"\nname = \"stand\"\n\
            [[damper]]\nname = \"c\"\nbetween = [\"rod\", \"ground\"]\ndamping = 80.0\n\
            [[input]]\nchannel = \"u\"\nkind = \"displacement\"\nat = \"rod\"\n\
            [[output]]\nchannel = \"F\"\nkind = \"force\"\nbetween = [\"rod\", \"ground\"]\n";
        let tones = |n: usize| {
            let t = 0.013 * n as f64;
            0.02 * (2.1 * t).sin() + 0.013 * (5.2 * t + 1.0).sin() + 0.008 * (9.0 * t).cos()
        };
        let at = Location::Channel("F".into());
        let placed = |kind: &str, values: &[f64]| {
            Placed::new(find(kind).unwrap(), at.clone(), values.to_vec())
        };
        let truth = [
            placed("gain_ripple", &[0.25, 0.173, -0.3]),
            placed("sensor_delay", &[0.088]),
        ];
        let inputs = vec![(0..3000).map(tones).collect::<Vec<f64>>()];
        let mut problem = problem(text, 0.013, inputs, vec![0.0; 3000]);
        let simulator = Simulator::new(&problem.model, &truth, 1).unwrap();
        let seen = simulator.predict(&problem.runs[0], &[]).unwrap();
        problem.runs[0].measured = seen.into_iter().map(Some).collect();
        let start = Start {
            effects: vec![placed("sensor_delay", &[0.088])],
            nominal: vec![],
            initial: vec![vec![]],
        };
        let resolution_hz = 1.0 / (0.013 * 3000.0);
        asked(&mut problem, &start, |search, base, linear| {
            let scores = search.scores(base, linear);
            let best = scores
                .iter()
                .find(|s| s.start.effect.kind() == "gain_ripple");
            let freq_hz = best.unwrap().start.values[1];
            assert!((freq_hz - 0.173).abs() < 0.5 * resolution_hz, "{freq_hz}");
        });
    }

    /// A pendulum that swings far, modelled by its spring at small angles: the size that a score asks for may turn it over.
    #[test]
    fn verify_a_start_from_which_the_plant_runs_away_is_halved() {
        let linear = "schema = \"simgap-model/1\"\nname = \"bob\"\n\
            [[mass]]\nname = \"bob\"\nvalue = 1.0\n\
            [[damper]]\nname = \"c\"\nbetween = [\"bob\", \"ground\"]\ndamping = 0.03\n\
            [[output]]\nchannel = \"q\"\nkind = \"displacement\"\nat = \"bob\"\n";
        let spring =
            "[[spring]]\nname = \"k\"\nbetween = [\"bob\", \"ground\"]\nstiffness = 37.0\n";
        let far = "[[pendulum]]\nat = \"bob\"\nvalue = 37.0\n";
        let truth = problem(&format!("{linear}{far}"), 0.01, vec![], vec![0.0; 580]);
        let simulator = Simulator::new(&truth.model, &[], 4).unwrap();
        let seen = simulator.predict(&truth.runs[0], &[1.6, 0.0]).unwrap();
        let mut problem = problem(&format!("{linear}{spring}"), 0.01, vec![], seen[0].clone());
        let start = Start {
            effects: vec![],
            nominal: vec![],
            initial: vec![vec![1.6, 0.0]],
        };
        let at = Location::Between(["bob".into(), "ground".into()]);
        let cubic = Placed::new(find("cubic_stiffness").unwrap(), at, vec![-67.0]);
        asked(&mut problem, &start, |search, base, linear| {
            let away = add(&start, cubic);
            let found = search.fit_steps(&[away], linear, search.options.most_steps);
            let better = found[0].log_posterior() - base.log_posterior();
            let stiffness = found[0].effects()[0].values[0];
            assert!(
                better > 3.0 && (-7.0..-4.0).contains(&stiffness),
                "{better} {stiffness}"
            );
        });
    }
}
