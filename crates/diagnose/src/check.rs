//! The check records: how far the gap shrinks, and whether they contradict the answer.
//!
//! Nothing is chosen, started or fitted by them but how each begins.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Fit, FitOptions, Problem};
use simgap_inference::noise_model::{NOISE_KNOWN, accuracy, accuracy_of_steps, input_noise};
use simgap_inference::{CandidateModel, LIKELIER_THAN_NOT, RELEVANT_SHARE, is_a_cause, other_by};
use simgap_simulate::{MemberPath, Run, substeps_for};

use crate::excerpt::excerpts;
use crate::gap::{Prediction, closed_if_true, gap, predict, total};
use crate::multi_step;
use crate::place::place_of;
use crate::spread::spread_of_check;
use crate::{ChannelGap, Gap};

/// What is left of what the answer has to explain, rms, from which it is incomplete.
const INCOMPLETE: f64 = 0.05;

/// The check records.
pub(crate) struct Check<'a> {
    /// As they are told.
    pub(crate) problem: Problem,
    train: &'a Problem,
    recalibrated: &'a Fit,
    plain: FitOptions,
}

/// What an answer leaves of the check records.
pub(crate) struct Checked {
    /// By the model as given, with re-estimated parameters, and corrected.
    pub(crate) predictions: Vec<Prediction>,
    /// The gap that is told.
    pub(crate) gap: Gap,
    /// Share of the gap that is left above noise.
    pub(crate) left: f64,
    /// The same of each channel.
    pub(crate) left_of_channels: Vec<f64>,
    /// Nothing is left but noise and the accuracy of the simulation.
    pub(crate) is_complete: bool,
    /// Probability of another cause, by what the answer leaves of what it should close of these records.
    pub(crate) other: f64,
    /// The motion at each output along the first record, with the corrected model.
    pub(crate) paths: Vec<Vec<MemberPath>>,
    /// Sample rate of the first record, Hz.
    pub(crate) sample_rate_hz: f64,
    /// What a reader must know.
    pub(crate) notes: Vec<String>,
}

impl Checked {
    /// Whether another cause is likelier.
    pub(crate) fn is_refuted(&self) -> bool {
        self.other > LIKELIER_THAN_NOT
    }

    /// Whether the answer runs away along these records.
    pub(crate) fn runs_away(&self) -> bool {
        let [.., corrected] = &self.predictions[..] else {
            return false;
        };
        let mut left = corrected.discrepancy.iter().flatten().flatten();
        left.any(|left| !left.is_finite())
    }

    /// The same in the place of an answer that runs away: it closes nothing of these records.
    pub(crate) fn in_place_of_what_runs_away(self) -> Checked {
        Checked {
            other: other_by(1.0),
            ..self
        }
    }
}

impl<'a> Check<'a> {
    /// `train` is what was learned from, `recalibrated` its fit of parameters alone.
    pub(crate) fn new(
        train: &'a Problem,
        recalibrated: &'a Fit,
        runs: Vec<Run>,
    ) -> Result<Check<'a>, EstimateError> {
        let mut problem = train.with_runs(runs).unfiltered();
        let substeps = substeps_for(&problem.model, &problem.runs)?;
        problem.substeps = problem.substeps.max(substeps);
        Ok(Check {
            plain: FitOptions::white(problem.model.outputs.len()),
            problem,
            train,
            recalibrated,
        })
    }

    /// What an answer leaves: `placed` on the model, as it was fitted to the training records. Where the answer `is_as_given`, that the
    /// model needs no change, the model as given speaks for it beside re-estimated parameters.
    pub(crate) fn of(
        &self,
        (estimate, options): (&Fit, &FitOptions),
        placed: &[Placed],
        is_as_given: bool,
    ) -> Result<Checked, EstimateError> {
        let known = &self.recalibrated.estimate.nominal[..];
        let predictions = [&[], known, placed]
            .into_par_iter()
            .map(|effects| predict(&self.problem, effects, &self.plain))
            .collect::<Result<Vec<Prediction>, EstimateError>>()?;
        let driven = input_noise(&self.problem, placed, &self.plain, &self.train.runs)?;
        let corrected = (placed, &predictions[2]);
        let gap = gap(
            &self.problem,
            &predictions[0],
            &predictions[1],
            corrected,
            &driven,
        );
        let spread = match self.train.is_whitened() {
            // Over whole records noise of the inputs is all that is left; it is told beside the gap.
            true => 0.0,
            false => spread_of_check(
                &self.problem,
                (self.train, estimate, options),
                &predictions[2],
            ),
        };
        let of_simulation = self.accuracy(placed, &predictions[2])?;
        // What is left of each channel above all noise, over its standard deviation.
        let above_noise = |of: &dyn Fn(&ChannelGap) -> f64| -> Vec<f64> {
            let channels = gap.channels.iter().zip(&of_simulation);
            channels
                .map(|(channel, accuracy)| {
                    let noise = NOISE_KNOWN * channel.noise_floor.powi(2)
                        + channel.input_noise.powi(2)
                        + spread.powi(2)
                        + accuracy.powi(2);
                    (of(channel).powi(2) - noise).max(0.0).sqrt()
                })
                .collect()
        };
        let speaks_as_given = is_as_given && gap.nominal < gap.corrected;
        let left_of_channels = above_noise(&|channel| match speaks_as_given {
            true => channel.nominal,
            false => channel.corrected,
        });
        let left = total(&left_of_channels);
        let nominal = gap.nominal.max(f64::MIN_POSITIVE);
        // What is named beside parameters is to explain what these leave, and closes some of that where a check record can show it.
        let are_parameters = placed.iter().all(simgap_inference::is_nominal);
        let share = if are_parameters { 0.0 } else { RELEVANT_SHARE };
        let (to_explain, without, to_close) = match are_parameters || gap.nominal < gap.recalibrated
        {
            true => (gap.nominal, &predictions[0], above_noise(&|c| c.nominal)),
            false => (
                gap.recalibrated,
                &predictions[1],
                above_noise(&|c| c.recalibrated),
            ),
        };
        // No less than what noise is known to.
        let to_close = total(&to_close).max((NOISE_KNOWN - 1.0).sqrt() * gap.noise_floor);
        // What moves no output by enough for a name is no cause that parameters alone would lack. A law has to close what is there.
        let lacks_nothing =
            are_parameters && !left_of_channels.iter().any(|left| is_a_cause(*left));
        let is_complete = left <= INCOMPLETE * to_explain || lacks_nothing;
        let std = self.problem.output_std();
        let is_tested = closed_if_true(&std, (without, to_close), &predictions[2]) >= share;
        let mut notes = vec![];
        // What leaves no more than noise and the accuracy of the simulation contradicts nothing.
        let mut other = match is_complete {
            true => 0.0,
            false => other_by(left / to_close),
        };
        if other > LIKELIER_THAN_NOT
            && let Some(left) = multi_step::left(&self.problem, known, placed, &self.plain)?
            && other_by(left) < other
        {
            other = other_by(left);
            notes.push(
                "over a whole check record the corrected model departs from the measurement, in short stretches it follows: the motion \
                 depends on differences that no estimate resolves"
                    .into(),
            );
        }
        if !is_tested {
            notes.push(format!(
                "the check records hardly test the named effects: with them the model predicts these records as it does without, but for \
                 less than {:.0} % of what re-estimated parameters leave",
                100.0 * share
            ));
        }
        if gap.input_noise > gap.noise_floor {
            let judged = match self.train.is_whitened() {
                true => {
                    "; effects were judged by whitened residuals, and the gap over whole records is mostly that noise"
                }
                false => "",
            };
            notes.push(format!(
                "noise of the inputs leads this plant away: over whole check records it alone moves the model by {:.2} of the motion{judged}",
                gap.input_noise
            ));
        }
        Ok(Checked {
            is_complete,
            left: (left / nominal).min(1.0),
            left_of_channels,
            other,
            paths: vec![self.paths(&predictions[2])],
            predictions,
            gap,
            sample_rate_hz: self
                .problem
                .runs
                .first()
                .map_or(1.0, |run| 1.0 / run.time_step_s),
            notes,
        })
    }

    /// Accuracy of the simulation over the motion of each channel.
    fn accuracy(&self, placed: &[Placed], last: &Prediction) -> Result<Vec<f64>, EstimateError> {
        let mut fit = self.recalibrated.clone();
        (fit.estimate.nominal, fit.estimate.effects) = placed
            .iter()
            .cloned()
            .partition(simgap_inference::is_nominal);
        fit.estimate.initial.clone_from(&last.initial);
        let of_inputs = accuracy(&self.problem, &fit)?;
        let of_steps = accuracy_of_steps(&self.problem, &fit)?;
        let both = of_inputs.iter().zip(of_steps);
        let both = both.map(|(inputs, steps)| inputs.hypot(steps));
        let channels = both.zip(self.problem.output_std());
        Ok(channels.map(|(delta, std)| delta / std).collect())
    }

    /// The motion at each output along the first record.
    fn paths(&self, prediction: &Prediction) -> Vec<MemberPath> {
        let first = prediction.simulators.first().zip(self.problem.runs.first());
        let Some(((simulator, run), initial)) = first.zip(prediction.initial.first()) else {
            return vec![];
        };
        let outputs = self.problem.model.outputs.iter();
        let path = outputs.map(|output| {
            let place = place_of(output)?;
            simulator.path(run, initial, &place).ok()
        });
        path.map(Option::unwrap_or_default).collect()
    }

    /// What single sets leave of excerpts of the check records.
    pub(crate) fn held_back(&self, sets: &[&CandidateModel]) -> Result<Vec<f64>, EstimateError> {
        let nothing = vec![vec![]; self.problem.runs.len()];
        let short = self
            .problem
            .with_runs(excerpts(&self.problem.runs, &nothing));
        sets.par_iter()
            .map(|set| {
                let placed: Vec<Placed> = set.fit.estimate.placed().cloned().collect();
                Ok(total(&predict(&short, &placed, &self.plain)?.nrmse))
            })
            .collect()
    }
}
