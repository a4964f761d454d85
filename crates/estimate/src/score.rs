//! What a further effect would bring, without fitting it.
//!
//! At a fit with residual r and sensitivities J, the effect at a small size ε contributes columns
//! C. Projected past everything the fit may still adjust,
//!
//! ```text
//! S = CᵀWC − CᵀWJ H⁻¹ JᵀWC,   b = CᵀWr − CᵀWJ H⁻¹ g,   â = S⁻¹ b         (1)
//! gain = −½ Σ_c ρ_c N_c ln(1 − bᵀâ / rᵀWr)                               (2)
//! ```
//!
//! (1) is the score test of the effect, â the size the data ask for and the start of its fit.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use simgap_effects::{Clock, Effect, Placed, SiteScale, Wave};

use crate::base::{Base, InCommon, Regressor, Trial};
use crate::drift::Drift;
use crate::{Candidate, EstimateError};

/// Size of the trial effect as a share of its starting values: small enough to be linear.
const TRIAL: f64 = 0.02;
/// Shapes that are simulated in one batch: their columns are as long as the records.
const SHAPES_TOGETHER: usize = 8;

/// What a further effect would bring.
#[derive(Clone)]
pub struct Score {
    /// Expected fall of the objective.
    pub gain: f64,
    /// Share of the weighted squared discrepancy it explains, bᵀâ / rᵀWr of (2).
    pub share: f64,
    /// The effect with the size the data ask for, inside its physical bounds.
    pub start: Placed,
    /// Initial states with which it brings that, where those of the fit do not do.
    pub initial: Option<Vec<Vec<f64>>>,
}

/// Scores one candidate from each of its starting shapes, best first. Shapes that would need a
/// size outside the physical bounds are left out.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn score(
    base: &Base<'_>,
    candidate: &Candidate,
    scale: &SiteScale,
) -> Result<Vec<Score>, EstimateError> {
    let mut scores = score_shapes(base, candidate, &candidate.effect.starts(scale))?;
    scores.extend(score_as_they_stand(
        base,
        candidate,
        &candidate.effect.pointed_at(scale),
    )?);
    best_first(&mut scores);
    Ok(scores)
}

/// [`score`](score()) from given shapes.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn score_shapes(
    base: &Base<'_>,
    candidate: &Candidate,
    shapes: &[Vec<f64>],
) -> Result<Vec<Score>, EstimateError> {
    let wanted = |shape: &[f64]| trials(candidate, shape);
    score_each(
        base,
        (candidate, None),
        shapes,
        wanted,
        |shape, in_common, own| base.score_shape(candidate, shape, in_common, own),
    )
}

/// Scores one candidate at values that it has no need to grow to.
fn score_as_they_stand(
    base: &Base<'_>,
    candidate: &Candidate,
    points: &[Vec<f64>],
) -> Result<Vec<Score>, EstimateError> {
    score_whole(base, (candidate, None), points)
}

/// Scores one candidate at values that it has no need to grow to, in the place of an effect of the set: what it explains of what that one
/// leaves, whatever that one's values are. Best first.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn score_in_place_of(
    base: &Base<'_>,
    index: usize,
    candidate: &Candidate,
    points: &[Vec<f64>],
) -> Result<Vec<Score>, EstimateError> {
    score_whole(base, (candidate, Some(index)), points)
}

fn score_whole(
    base: &Base<'_>,
    what: (&Candidate, Option<usize>),
    points: &[Vec<f64>],
) -> Result<Vec<Score>, EstimateError> {
    let wanted = |values: &[f64]| as_it_stands(what.0, values);
    score_each(base, what, points, wanted, |values, in_common, own| {
        base.score_as_it_stands(what.0, values, in_common, own)
    })
}

/// The effect with all of its values, from all that it may begin a record with.
fn as_it_stands(candidate: &Candidate, values: &[f64]) -> Vec<Trial> {
    let begun = candidate.effect.own_starts(values).into_iter();
    begun.map(|values| (values, 1.0)).collect()
}

/// Scores of one candidate at many values, in the place of an effect of the set if one is given, best first: the trials that each wants are simulated a few at a time, and scored by what they
/// have in common with the base and with each other.
pub(crate) fn score_each(
    base: &Base<'_>,
    (candidate, in_place_of): (&Candidate, Option<usize>),
    points: &[Vec<f64>],
    trials: impl Fn(&[f64]) -> Vec<Trial>,
    scored: impl Fn(&[f64], &InCommon, Range<usize>) -> Option<Score>,
) -> Result<Vec<Score>, EstimateError> {
    let mut scores = Vec::new();
    for few in points.chunks(SHAPES_TOGETHER) {
        let wanted: Vec<Vec<Trial>> = few.iter().map(|values| trials(values)).collect();
        let in_common = base.in_common(&base.columns(candidate, &wanted.concat(), in_place_of)?);
        let mut first = 0;
        for (values, wanted) in few.iter().zip(wanted) {
            let own = first..first + wanted.len();
            first = own.end;
            scores.extend(scored(values, &in_common, own));
        }
    }
    best_first(&mut scores);
    Ok(scores)
}

fn best_first(scores: &mut [Score]) {
    scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
}

/// How the instances of a shape are scored.
pub(crate) enum Way {
    /// By each size alone (places of the parameters): the prediction is linear in them.
    BySize(Vec<usize>),
    /// By the whole of what it does: it has no size to grow from (a limit).
    AsItStands,
    /// By a sine and a cosine.
    ByClock(Clock),
}

pub(crate) fn way(candidate: &Candidate, shape: &[f64]) -> Way {
    if let Some(clock) = candidate.effect.clock() {
        return Way::ByClock(clock);
    }
    let parameters = candidate.effect.parameters();
    // What a record has of its own is left to the fit.
    let sizes: Vec<usize> = (0..parameters.len())
        .filter(|&i| !parameters[i].per_record)
        .filter(|&i| parameters[i].neutral.is_some_and(f64::is_finite))
        .collect();
    let stepped = candidate.effect.action(shape).is_stepped();
    // A limit, or a map that moves in steps, does not grow in proportion to anything.
    let grows = candidate.effect.grows_in_proportion();
    if sizes.is_empty() || stepped || !grows {
        Way::AsItStands
    } else {
        Way::BySize(sizes)
    }
}

/// What has to be simulated to score a shape.
pub(crate) fn trials(candidate: &Candidate, shape: &[f64]) -> Vec<Trial> {
    match way(candidate, shape) {
        Way::BySize(sizes) => sizes
            .into_iter()
            .map(|k| (sized(candidate.effect, shape, Some(k), TRIAL), TRIAL))
            .collect(),
        Way::AsItStands => as_it_stands(candidate, shape),
        Way::ByClock(clock) => [0.0, FRAC_PI_2]
            .map(|phase| {
                let mut values = shape.to_vec();
                values[clock.amplitude] *= TRIAL;
                values[clock.phase] = phase;
                (values, TRIAL)
            })
            .into(),
    }
}

/// The values of a shape with its k-th sized parameter at a share of its start and the other sized
/// parameters at the values where the effect vanishes; `None` for all sized parameters together.
pub(crate) fn sized(
    effect: &dyn Effect,
    shape: &[f64],
    only: Option<usize>,
    share: f64,
) -> Vec<f64> {
    let sized = effect.parameters().iter().zip(shape).enumerate();
    sized
        .map(|(i, (parameter, &value))| match parameter.neutral {
            // A limit of a shape stays where it is.
            Some(neutral) if !neutral.is_finite() || parameter.per_record => value,
            Some(neutral) if only.is_none_or(|k| k == i) => neutral + share * (value - neutral),
            Some(neutral) => neutral,
            None => value,
        })
        .collect()
}

impl Base<'_> {
    /// Scores a shape from its own trials.
    fn score_shape(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        in_common: &InCommon,
        own: Range<usize>,
    ) -> Option<Score> {
        match way(candidate, shape) {
            Way::BySize(sizes) => {
                if let Some(drift) = self.problem.drift(candidate.effect, &candidate.at) {
                    return self.score_drift(candidate, shape, &drift, in_common, own);
                }
                let everywhere = own.map(|trial| Regressor { trial, run: None });
                let solution = self.amplitudes(in_common, &everywhere.collect::<Vec<_>>())?;
                self.score_sizes(candidate, shape, &sizes, solution)
            }
            // Without a size to grow from (a limit): by the whole of what it does.
            Way::AsItStands => self.score_as_it_stands(candidate, shape, in_common, own),
            Way::ByClock(clock) => self.score_clock(candidate, shape, clock, in_common, own),
        }
    }

    /// By the whole of what it does; where there are several ways to begin a record, by the best of them in each.
    fn score_as_it_stands(
        &self,
        candidate: &Candidate,
        values: &[f64],
        in_common: &InCommon,
        own: Range<usize>,
    ) -> Option<Score> {
        let everywhere = |trial| Regressor { trial, run: None };
        if own.len() == 1 {
            let (amplitude, energy) = self.amplitudes(in_common, &[everywhere(own.start)])?;
            return (amplitude[0] > 0.0).then(|| self.scored(candidate, values.to_vec(), energy));
        }
        let begun = candidate.effect.own_starts(values);
        let best_of = |run: usize| {
            let alone = own.clone().zip(&begun).filter_map(|(trial, begun)| {
                let column = Regressor {
                    trial,
                    run: Some(run),
                };
                let (amplitude, energy) = self.amplitudes(in_common, &[column])?;
                (amplitude[0] > 0.0).then_some((column, begun, energy))
            });
            alone.max_by(|a, b| a.2.total_cmp(&b.2))
        };
        // A record in which the effect shows from nowhere tells nothing of where it begins.
        let best: Vec<Option<(Regressor, &Vec<f64>, f64)>> =
            (0..self.problem.runs.len()).map(best_of).collect();
        let columns: Vec<Regressor> = best.iter().flatten().map(|(column, ..)| *column).collect();
        if columns.is_empty() {
            return None;
        }
        let (amplitudes, energy) = self.amplitudes(in_common, &columns)?;
        if amplitudes.iter().any(|amplitude| *amplitude <= 0.0) {
            return None;
        }
        let of_run = |best: &Option<(Regressor, &Vec<f64>, f64)>| {
            best.map_or_else(|| values.to_vec(), |(_, begun, _)| begun.clone())
        };
        let mut score = self.scored(candidate, of_run(best.first()?), energy);
        let places = score.start.own_places();
        let own = best.iter().map(|best| {
            let values = of_run(best);
            places.iter().map(|&i| values[i]).collect()
        });
        score.start.of_record = own.collect();
        Some(score)
    }

    fn score_sizes(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        sizes: &[usize],
        (amplitude, energy): (Vec<f64>, f64),
    ) -> Option<Score> {
        let parameters = candidate.effect.parameters();
        let mut values = shape.to_vec();
        let mut absent = false;
        for (&k, a) in sizes.iter().zip(&amplitude) {
            let neutral = parameters[k].neutral.unwrap_or(0.0);
            let wanted = neutral + a * (shape[k] - neutral);
            values[k] = wanted.clamp(parameters[k].lower, parameters[k].upper);
            if values[k] == neutral || !wanted.is_finite() {
                absent = true;
            }
        }
        if absent && sizes.len() == 1 {
            return None;
        }
        candidate.effect.make_physical(&mut values);
        Some(self.scored(candidate, values, energy))
    }

    pub(crate) fn scored(&self, candidate: &Candidate, values: Vec<f64>, energy: f64) -> Score {
        let share = (energy / self.energy).clamp(0.0, 1.0 - 1e-9);
        Score {
            gain: -0.5 * self.observations * (1.0 - share).ln(),
            share,
            start: Placed::new(candidate.effect, candidate.at.clone(), values),
            initial: None,
        }
    }

    /// What a sine and a cosine of its own for each run are of the trials, and the energy they explain.
    fn turns(&self, in_common: &InCommon, phases: Range<usize>) -> Option<(Vec<[f64; 2]>, f64)> {
        let runs = self.problem.runs.len();
        let columns = phases.flat_map(|trial| {
            let of_run = move |run| Regressor {
                trial,
                run: Some(run),
            };
            (0..runs).map(of_run)
        });
        let (parts, energy) = self.amplitudes(in_common, &columns.collect::<Vec<_>>())?;
        let (sines, cosines) = parts.split_at(runs);
        let each = sines.iter().zip(cosines).map(|(s, c)| [*s, *c]);
        Some((each.collect(), energy))
    }

    /// An effect with a clock: a sine and a cosine of its own for each run.
    fn score_clock(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        clock: Clock,
        in_common: &InCommon,
        phases: Range<usize>,
    ) -> Option<Score> {
        let (parts, energy) = self.turns(in_common, phases)?;
        let mean = mean_size(&parts);
        let mut values = shape.to_vec();
        values[clock.amplitude] *= mean;
        if !values.iter().all(|value| value.is_finite()) || mean == 0.0 {
            return None;
        }
        let mut score = self.scored(candidate, values, energy);
        let own = score.start.own_places();
        let of_run = |[sine, cosine]: &[f64; 2]| {
            let phase = cosine.atan2(*sine);
            let value = |place: &usize| match *place {
                place if place == clock.phase => phase,
                place => shape[place],
            };
            own.iter().map(value).collect()
        };
        score.start.of_record = parts.iter().map(of_run).collect();
        Some(score)
    }

    /// A wave along a travel that each run begins where it does: one sine, and the places.
    fn score_drift(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        drift: &Drift,
        in_common: &InCommon,
        phases: Range<usize>,
    ) -> Option<Score> {
        let (mut parts, energy) = self.turns(in_common, phases)?;
        let Wave { sine, cosine, .. } = drift.wave;
        for part in &mut parts {
            *part = [part[0] * shape[sine], part[1] * shape[cosine]];
        }
        let mut values = shape.to_vec();
        (values[sine], values[cosine]) = (mean_size(&parts), 0.0);
        let is_found = values[sine].is_finite() && values[sine] > 0.0;
        is_found.then(|| {
            let begin = parts.iter().zip(&self.fit.estimate.initial);
            let begin = begin.map(|([s, c], state)| drift.ahead(state, &values, c.atan2(*s)));
            let initial = Some(begin.collect());
            Score {
                initial,
                ..self.scored(candidate, values.clone(), energy)
            }
        })
    }
}

/// Root mean square over the runs of what they hold of a sine and a cosine together.
fn mean_size(parts: &[[f64; 2]]) -> f64 {
    let squares: f64 = parts.iter().flatten().map(|part| part * part).sum();
    (squares / parts.len().max(1) as f64).sqrt()
}
