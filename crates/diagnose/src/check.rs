//! The check records: what is told of them, and what a set is judged by.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Fit, Problem, Weights};
use simgap_simulate::{Run, substeps_for};

use crate::accuracy::accuracy_of_check;
use crate::data::excerpts;
use crate::gap::{Prediction, gap, predict};
use crate::hypothesis::Hypothesis;
use crate::input_noise::input_noise;
use crate::pipeline::Answer;
use crate::spread::spread_of_check;
use crate::{Gap, answer, jumps, stretches, unexplained};

/// The check records.
pub(crate) struct Check<'a> {
    /// As they are told.
    pub(crate) problem: Problem,
    /// As a set is judged by them, where noise of the inputs leads the plant away: with whitened discrepancies.
    whitened: Option<Problem>,
    train: &'a Problem,
    recalibrated: &'a Fit,
    plain: Weights,
}

/// What a set leaves of the check records.
pub(crate) struct Checked {
    /// By the model as given, with re-estimated parameters, and corrected.
    pub(crate) predictions: Vec<Prediction>,
    /// The gap that is told.
    pub(crate) gap: Gap,
    /// What the set is judged by: over all noise there is.
    pub(crate) judged: Gap,
}

impl<'a> Check<'a> {
    /// `train` is what was learned from, `recalibrated` its fit of parameters alone.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub(crate) fn new(
        train: &'a Problem,
        recalibrated: &'a Fit,
        runs: Vec<Run>,
    ) -> Result<Check<'a>, EstimateError> {
        let mut whitened = train.with_runs(runs);
        whitened.substeps = whitened
            .substeps
            .max(substeps_for(&whitened.model, &whitened.runs)?);
        Ok(Check {
            plain: Weights::independent(whitened.model.outputs.len()),
            problem: whitened.unfiltered(),
            whitened: whitened.is_whitened().then_some(whitened),
            train,
            recalibrated,
        })
    }

    /// The gap that `predictions` leave, with that at `last` as the corrected one, made with `placed`.
    pub(crate) fn gap(
        &self,
        placed: &[Placed],
        predictions: &[Prediction],
        last: usize,
    ) -> Result<Gap, EstimateError> {
        self.gap_in(&self.problem, placed, predictions, last)
    }

    fn gap_in(
        &self,
        problem: &Problem,
        placed: &[Placed],
        predictions: &[Prediction],
        last: usize,
    ) -> Result<Gap, EstimateError> {
        let driven = input_noise(problem, placed, &self.plain, &self.train.runs)?;
        let corrected = (placed, &predictions[last]);
        Ok(gap(
            problem,
            &predictions[0],
            &predictions[1],
            corrected,
            &driven,
        ))
    }

    /// What an answer, `placed` on the model, leaves.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub(crate) fn of(&self, answer: &Answer, placed: &[Placed]) -> Result<Checked, EstimateError> {
        let predictions = self.predictions(&self.problem, placed)?;
        let gap = self.gap(placed, &predictions, 2)?;
        let judged = match &self.whitened {
            None => self.judged(&self.problem, answer, placed, (&predictions, &gap))?,
            Some(whitened) => {
                let predictions = self.predictions(whitened, placed)?;
                let gap = self.gap_in(whitened, placed, &predictions, 2)?;
                self.judged(whitened, answer, placed, (&predictions, &gap))?
            }
        };
        Ok(Checked {
            predictions,
            gap,
            judged,
        })
    }

    fn predictions(
        &self,
        problem: &Problem,
        placed: &[Placed],
    ) -> Result<Vec<Prediction>, EstimateError> {
        [&[], &self.recalibrated.estimate.nominal[..], placed]
            .into_par_iter()
            .map(|effects| predict(problem, effects, &self.plain))
            .collect()
    }

    /// The gap over all noise there is, where a force jumps without the samples at which it does.
    fn judged(
        &self,
        problem: &Problem,
        answer: &Answer,
        placed: &[Placed],
        (predictions, gap): (&[Prediction], &Gap),
    ) -> Result<Gap, EstimateError> {
        let known = &self.recalibrated.estimate.nominal;
        let unknown = accuracy_of_check(&self.problem, known, &predictions[1].initial)?;
        let between = jumps::gap_between(problem, &answer.set, (placed, predictions), gap);
        let gap = between.as_ref().unwrap_or(gap);
        let judged = gap.over_all_noise(unknown);
        if !unexplained::may_be_spread(answer, &judged) {
            return Ok(judged);
        }
        let fitted = (self.train, &answer.estimate, &answer.weights);
        let spread = spread_of_check(problem, fitted, &predictions[2])?;
        Ok(gap.over_all_noise(unknown.hypot(spread)))
    }

    /// The gap where `placed` starts anew in every stretch, if it leaves nothing but noise then.
    pub(crate) fn followed_anew(&self, placed: &[Placed]) -> Option<Gap> {
        let known = &self.recalibrated.estimate.nominal;
        // A filter would see no beginning of a stretch; within one, noise of the inputs leads a plant less far.
        let anew = stretches::gap_followed_anew(&self.problem, known, placed, &self.plain);
        anew.ok().flatten()
    }

    /// What single effects leave of excerpts: as told, and as an answer is judged by it.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub(crate) fn held_back(&self, singles: &[Hypothesis]) -> Result<[Vec<f64>; 2], EstimateError> {
        let of = |problem: &Problem| {
            let short = problem.with_runs(excerpts(&problem.runs));
            answer::held_back(&short, singles, &self.plain)
        };
        let told = of(&self.problem)?;
        let judged = self
            .whitened
            .as_ref()
            .map_or_else(|| Ok(told.clone()), of)?;
        Ok([told, judged])
    }

    /// Said of records that a plant wanders in.
    pub(crate) fn note(&self) -> Option<String> {
        self.whitened.as_ref().map(|_| {
            "noise of the inputs leads this plant away from any model over a record: effects were judged by what every sample \
             adds to those before it; the gap over whole records is mostly that noise"
                .to_owned()
        })
    }
}
