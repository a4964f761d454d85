//! Effects at many values, spread over two decades about their usual ones.
//!
//! Where no single effect explains a gap, nor a pair, it may be that the right one was fitted from the wrong side of
//! a ridge, or from a size at which it does something else. Effects of the machine are then simulated at
//! many values and fitted from the best of them; a clock that leaves no line is swept over its range.

use simgap_effects::{Effect, SiteScale};
use simgap_estimate::{
    Base, Candidate, EstimateError, FitOptions, Score, Start, fit, fit_initial_states, halton,
    linearise_at, score_outright, score_shapes,
};

use crate::candidate_model::{CandidateModel, add_scored, is_bent, name, rank, straight};
use crate::search::Search;

/// Values tried of each effect at each place.
const POINTS: usize = 48;
/// The same of an effect with one value.
const POINTS_OF_ONE: usize = 16;
/// Values lie within this factor of the starting values.
const SPREAD: f64 = 10.0;
/// Sets fitted of effects with a shape, of those with one value and of swept ones, and from how many values of each
/// that is not swept.
const FITTED_OF_SHAPE: usize = 12;
const FITTED_OF_ONE: usize = 6;
const FITTED_OF_SWEPT: usize = 3;
const STARTS_OF_EACH: usize = 2;
/// Sets of these that are finished, and in how many steps: from afar it takes more.
const FINISHED: usize = 3;
const STEPS: usize = 30;

impl Search<'_> {
    /// Every effect of the machine beside those of `base`, fitted from the best of many values. Best first.
    pub(crate) fn multistart(
        &self,
        base: &CandidateModel,
        linear: &Base<'_>,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let candidates = self.space.candidates.iter();
        let free = candidates.filter(|(candidate, _)| self.may_hold(base, candidate));
        let free: Vec<&(Candidate, SiteScale)> = free.collect();
        let scored = self.try_each(&free, |(candidate, scale)| {
            let effect = candidate.effect;
            let (scores, most) = if effect.clock().is_some() {
                // The next best is beside the best.
                (score_shapes(linear, candidate, &effect.sweep(scale)), 1)
            } else if effect.family().is_law() {
                let points = points(candidate, scale);
                (score_outright(linear, candidate, &points), STARTS_OF_EACH)
            } else {
                return vec![];
            };
            let mut best = scores.unwrap_or_default();
            best.truncate(most);
            best
        });
        let best = |of: Tried, most: usize| {
            let mut best: Vec<&Score> = scored.iter().flatten().collect();
            best.retain(|score| tried(score.start.effect) == of);
            best.sort_by(|a, b| {
                let by_name = || name(&a.start).cmp(&name(&b.start));
                b.gain.total_cmp(&a.gain).then_with(by_name)
            });
            best.truncate(most);
            best
        };
        let mut best_of_all = best(Tried::Shape, FITTED_OF_SHAPE);
        best_of_all.extend(best(Tried::Size, FITTED_OF_ONE));
        best_of_all.extend(best(Tried::Clock, FITTED_OF_SWEPT));
        let starts: Vec<Start> = best_of_all
            .into_iter()
            .map(|score| add_scored(&base.fit.estimate, score.clone()))
            .collect();
        let mut fitted = self.fit_all(&starts, linear);
        let promising = fitted.iter().take(FINISHED);
        let promising: Vec<Start> = promising.map(|set| set.fit.estimate.clone()).collect();
        let finished = self.fit_steps(&promising, linear, STEPS);
        // A marginal likelihood is that of a set at its estimate, not of a fit on its way there.
        fitted.retain(|set| finished.iter().all(|known| known.key() != set.key()));
        fitted.extend(finished);
        rank(&mut fitted);
        Ok(fitted)
    }

    /// Single effects, fitted from nominal parameters as given where a large gap has bent those of `base`.
    pub(crate) fn fit_from_given(
        &self,
        base: &CandidateModel,
        most: usize,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        if !is_bent(base) {
            return Ok(vec![]);
        }
        let as_given = fit_initial_states(self.problem, &[], &self.options)?;
        let start = Start {
            effects: vec![],
            nominal: straight(base),
            initial: as_given.estimate.initial,
        };
        let held = FitOptions {
            most_steps: 0,
            ..self.options.clone()
        };
        let given = self.candidate_model(fit(self.problem, &start, &held)?);
        let linear = linearise_at(self.problem, &given.fit, &self.options)?;
        let mut fitted = self.extend_at(&given, &linear, most)?;
        fitted.extend(self.multistart(&given, &linear)?);
        Ok(fitted)
    }
}

/// What is tried of an effect.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tried {
    /// Values that shape it, and its size.
    Shape,
    /// Its size.
    Size,
    /// The frequencies of its sweep.
    Clock,
}

fn tried(effect: &dyn Effect) -> Tried {
    match effect {
        _ if effect.clock().is_some() => Tried::Clock,
        _ if has_shape(effect) => Tried::Shape,
        _ => Tried::Size,
    }
}

/// Whether an effect has, besides its size, values that shape it.
fn has_shape(effect: &dyn Effect) -> bool {
    let shared = effect.parameters().iter().filter(|p| !p.per_record);
    shared.clone().count() > 1
        && shared
            .clone()
            .any(|p| p.neutral.is_none_or(f64::is_infinite))
}

/// Values about each start of an effect in turn, by a low-discrepancy sequence in their logarithms; one size
/// that may have either sign, in both.
fn points(candidate: &Candidate, scale: &SiteScale) -> Vec<Vec<f64>> {
    let parameters = candidate.effect.parameters();
    let starts = candidate.effect.starts(scale);
    let shaped = has_shape(candidate.effect);
    let moved = |i: usize, start: &[f64]| {
        let values = parameters.iter().zip(start).enumerate();
        let mut values: Vec<f64> = values
            .map(|(k, (parameter, value))| {
                if parameter.per_record {
                    return *value;
                }
                let share = halton(i + 1, k);
                let either = !shaped && parameter.lower < 0.0 && parameter.upper > 0.0;
                // The halves of a range each have all of the spread.
                let (sign, share) = match 2.0 * share {
                    twice if !either => (1.0, 0.5 * twice),
                    twice if twice < 1.0 => (1.0, twice),
                    twice => (-1.0, twice - 1.0),
                };
                let moved = sign * value * SPREAD.powf(2.0 * share - 1.0);
                moved.clamp(parameter.lower, parameter.upper)
            })
            .collect();
        candidate.effect.make_physical(&mut values);
        values
    };
    let most = if shaped { POINTS } else { POINTS_OF_ONE };
    let count = if starts.is_empty() { 0 } else { most };
    let each = starts.iter().cycle().take(count);
    each.enumerate().map(|(i, start)| moved(i, start)).collect()
}
