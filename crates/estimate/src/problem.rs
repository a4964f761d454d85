//! What is estimated from.

use std::sync::Arc;

use simgap_effects::{
    Action, Effect, Family, Placed, Prior, Sampled, SiteScale, catalogue_of, own_laws, places_of,
};
use simgap_model::{DEFAULT_UNCERTAINTY, Location, Model, OutputKind};
use simgap_simulate::{ExternalPlant, Job, Run, Simulator, predict_all, substeps_for};

use crate::candidate::Candidate;
use crate::{Cancel, Effort, EstimateError, Whitening};

/// A nominal model and the runs it is compared with.
pub struct Problem {
    /// The nominal model.
    pub model: Model,
    /// The runs; every output measured.
    pub runs: Vec<Run>,
    /// Effects that belong to the nominal model (written in its file).
    pub given: Vec<Placed>,
    /// Steps between samples where nonlinear forces act.
    pub substeps: usize,
    /// What discrepancies and sensitivities are filtered with; nothing at first.
    pub whitening: Whitening,
    /// Typical sizes at places: effects there are fitted under the priors that follow from them, elsewhere without any.
    pub scales: Vec<(Location, SiteScale)>,
    /// Standard deviation of the prior on each entry of an initial state, about zero ([`Problem::state_std_of`]); no prior
    /// where there is none.
    pub state_std: Vec<f64>,
    /// Whether the samples at either end of a run that a late or early channel may leave out
    /// ([`simgap_effects::most_beyond`]) count for no set, so that sets are compared on the same samples; not so at first.
    pub leaves_out_ends: bool,
    /// The simulator that a model of one stands for ([`Model::is_external`]).
    pub plant: Option<Arc<ExternalPlant>>,
    /// Ends the work on it.
    pub cancel: Cancel,
    /// Counts the work on it.
    pub effort: Effort,
}

/// How a fit counts what it leaves, and when it stops.
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// Independent samples per sample of each channel, 0 to 1: correlated residuals say less than their number.
    pub effective_share: Vec<f64>,
    /// What no set is expected to explain of each channel (accuracy of the simulation, noise of the inputs), over the
    /// standard deviation of the channel.
    pub floor: Vec<f64>,
    /// What of the residuals is no noise; nothing where all samples count alike.
    pub discrepancy: Option<Discrepancy>,
    /// Standard deviation of the prior on each nominal parameter, relative to its value; `None` for what the model
    /// states of each.
    pub nominal_std: Option<f64>,
    /// A step that improves the objective by less than this, told by all samples (less where they count as a discrepancy), is the last of a
    /// fit. One parameter gains half a unit from pure noise.
    pub converged: f64,
    /// Keep the sensitivities of nominal parameters and initial states from step to step as long
    /// as the steps succeed: several times faster, with rougher intervals.
    pub keep_nuisance: bool,
    /// Steps after which a fit is left where it is, however well it still goes.
    pub most_steps: usize,
}

/// How what a model leaves beyond noise counts: no lumped model is exact, and samples of what it misses are no independent observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrepancy {
    /// Independent observations that it counts as at the most, α.
    pub observations: f64,
    /// Noise of each channel with what no set is expected to explain of it, over its standard deviation: within it every independent
    /// sample counts.
    pub noise: Vec<f64>,
}

/// Steps of a fit that is to be finished.
const MOST_STEPS: usize = 25;
/// Accuracy of a simulation over the standard deviation of a channel, where it was not measured.
const ACCURACY: f64 = 5e-4;

impl FitOptions {
    /// White noise in every channel, nominal parameters known as the model states.
    #[must_use]
    pub fn white(channels: usize) -> FitOptions {
        FitOptions {
            effective_share: vec![1.0; channels],
            floor: vec![ACCURACY; channels],
            discrepancy: None,
            nominal_std: None,
            converged: 0.02,
            keep_nuisance: false,
            most_steps: MOST_STEPS,
        }
    }
}

impl Problem {
    /// Prepares a model and its runs.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated or an effect of its file cannot be
    /// used.
    pub fn new(model: &Model, runs: Vec<Run>) -> Result<Problem, EstimateError> {
        own_laws(model)?;
        let given = model
            .effects
            .iter()
            .map(|entry| Placed::from_entry(model, entry))
            .collect::<Result<Vec<_>, _>>()?;
        let substeps = substeps_for(model, &runs)?;
        Ok(Problem {
            model: model.clone(),
            runs,
            given,
            substeps,
            whitening: Whitening::default(),
            scales: vec![],
            state_std: vec![],
            leaves_out_ends: false,
            plant: None,
            cancel: Cancel::default(),
            effort: Effort::default(),
        })
    }

    /// The same model with other runs, the same steps and filters; every sample counts. What effects have of a record's own stays
    /// with what is cut from that record.
    #[must_use]
    pub fn with_runs(&self, runs: Vec<Run>) -> Problem {
        let given = self.given.iter().map(|placed| self.in_runs(placed, &runs));
        Problem {
            model: self.model.clone(),
            given: given.collect(),
            runs,
            substeps: self.substeps,
            whitening: self.whitening.clone(),
            scales: self.scales.clone(),
            state_std: self.state_std.clone(),
            leaves_out_ends: false,
            plant: self.plant.clone(),
            cancel: self.cancel.clone(),
            effort: self.effort.clone(),
        }
    }

    /// An effect of the model with its values in other runs; those of the file where one of them is of another record.
    fn in_runs(&self, placed: &Placed, runs: &[Run]) -> Placed {
        let own = runs.iter().map(|run| {
            let of_record = self.runs.iter().position(|known| known.name == run.name)?;
            placed.of_record.get(of_record).cloned()
        });
        Placed {
            of_record: own.collect::<Option<_>>().unwrap_or_default(),
            ..placed.clone()
        }
    }

    /// The same problem with discrepancies as they are, unfiltered.
    #[must_use]
    pub fn unfiltered(&self) -> Problem {
        Problem {
            whitening: Whitening::default(),
            leaves_out_ends: self.leaves_out_ends,
            ..self.with_runs(self.runs.clone())
        }
    }

    /// Whether a record may be cut: a simulator of the user's begins every run in a state of its own, so that what lies later in a
    /// record cannot be simulated alone.
    #[must_use]
    pub fn may_cut(&self) -> bool {
        !self.model.is_external()
    }

    /// Whether discrepancies are filtered.
    #[must_use]
    pub fn is_whitened(&self) -> bool {
        self.whitening != Whitening::default()
    }

    /// Filters the signals of a run, channel by channel. At a sample that was filled nothing is known, so that the signal
    /// is there what those before it let expect, and zero after the filter.
    pub(crate) fn whiten(&self, run: usize, signals: &mut [Vec<f64>]) {
        for (channel, signal) in signals.iter_mut().enumerate() {
            for sample in self.runs[run].filled(channel) {
                signal[sample] = self.whitening.expected(channel, &signal[..sample]);
            }
            self.whitening.apply(channel, signal);
        }
    }

    /// The nominal model with effects on top of those it has, as they are in one of the runs.
    ///
    /// # Errors
    /// [`EstimateError`] when a place is not in the model, or the work was cancelled.
    pub fn simulator(&self, effects: &[Placed], run: usize) -> Result<Simulator, EstimateError> {
        self.simulator_in(self.substeps, effects, run)
    }

    /// [`Problem::simulator`] with nonlinear forces taken in steps half as long.
    ///
    /// # Errors
    /// As [`Problem::simulator`].
    pub fn simulator_in_half_steps(
        &self,
        effects: &[Placed],
        run: usize,
    ) -> Result<Simulator, EstimateError> {
        self.simulator_in(2 * self.substeps, effects, run)
    }

    fn simulator_in(
        &self,
        substeps: usize,
        effects: &[Placed],
        run: usize,
    ) -> Result<Simulator, EstimateError> {
        self.cancel.check()?;
        let all = self.given.iter().chain(effects);
        let all: Vec<Placed> = all.map(|placed| placed.in_record(run)).collect();
        Simulator::with_plant(&self.model, &all, substeps, self.plant.as_ref())
    }

    /// Whether the nominal model with effects on top differs from run to run.
    pub(crate) fn differs_by_run(&self, effects: &[Placed]) -> bool {
        let mut all = self.given.iter().chain(effects);
        all.any(|placed| !placed.of_record.is_empty())
    }

    /// [`Problem::simulator`] of every run, beside that of `others` if there are any; one for all where no effect has values of a
    /// run's own.
    pub(crate) fn simulators(
        &self,
        effects: &[Placed],
        others: &[Arc<Simulator>],
    ) -> Result<Vec<Arc<Simulator>>, EstimateError> {
        let differ = self.differs_by_run(effects);
        let mut simulators: Vec<Arc<Simulator>> = Vec::with_capacity(self.runs.len());
        for run in 0..self.runs.len() {
            let simulator = match simulators.first() {
                Some(first) if !differ => Arc::clone(first),
                _ => Arc::new(self.simulator(effects, run)?.beside(others.get(run))),
            };
            simulators.push(simulator);
        }
        Ok(simulators)
    }

    /// Predictions of all jobs together, counted as work on the problem.
    pub(crate) fn predict_all(
        &self,
        jobs: &[Job<'_>],
    ) -> Vec<Result<Vec<Vec<f64>>, EstimateError>> {
        for job in jobs {
            self.effort.add_run(job.run, job.simulator);
        }
        predict_all(jobs)
    }

    /// Length of an initial state.
    #[must_use]
    pub fn state_len(&self) -> usize {
        2 * self.model.dof_count()
    }

    /// The prior of a parameter of an effect; `None` at a place of which no sizes are known.
    #[must_use]
    pub fn prior(&self, placed: &Placed, parameter: usize) -> Option<Prior> {
        let mut scales = self.scales.iter();
        let (_, scale) = scales.find(|(at, _)| *at == placed.at)?;
        Some(placed.effect.prior(parameter, scale))
    }

    /// Standard deviation of the prior on the values of a nominal parameter, relative to them.
    #[must_use]
    pub fn stated_std(&self, placed: &Placed) -> f64 {
        let quantity = placed.effect.nominal_quantity();
        quantity.map_or(DEFAULT_UNCERTAINTY, |quantity| {
            self.model.stated_uncertainty(quantity, &placed.at)
        })
    }

    /// Every nominal parameter of the model, as catalogue entries at their places.
    #[must_use]
    pub fn nominal_parameters(&self) -> Vec<Candidate> {
        self.candidates(|family| family == Family::NominalParameter)
    }

    /// Every catalogue entry of the chosen families at every place it can sit; of those that live in single samples none
    /// where every run was resampled.
    pub fn candidates(&self, family: impl Fn(Family) -> bool) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        let resampled =
            self.runs.iter().all(|run| run.mended.is_resampled) && !self.runs.is_empty();
        let is_sought = |effect: &dyn Effect| {
            family(effect.family()) && !(resampled && lives_in_single_samples(effect))
        };
        for effect in catalogue_of(&self.model)
            .into_iter()
            .filter(|effect| is_sought(*effect))
        {
            for at in places_of(&self.model, effect) {
                candidates.push(Candidate { effect, at });
            }
        }
        candidates
    }

    /// Samples of a channel that were filled, over all runs.
    pub(crate) fn filled_count(&self, channel: usize) -> f64 {
        let runs = self.runs.iter();
        runs.map(|run| run.filled(channel).count() as f64).sum()
    }

    /// Standard deviation of each output over all runs, model units: what discrepancies are compared with, and filtered like
    /// them. About the mean of each run where nothing of the model holds the position that it shows: where an axis was left before a
    /// record, and what its encoder had counted, is no motion.
    #[must_use]
    pub fn output_std(&self) -> Vec<f64> {
        let of_channel = |channel: usize| {
            let order = self.whitening.order(channel);
            if order == 0 {
                return self.motion_std_of(channel);
            }
            let filtered: Vec<Vec<f64>> = self
                .measured(channel)
                .map(|values| {
                    let mut values = values.to_vec();
                    self.whitening.apply(channel, &mut values);
                    values.split_off(order.min(values.len()))
                })
                .collect();
            self.rms_of_motion(channel, filtered.iter().map(Vec::as_slice))
        };
        (0..self.model.outputs.len()).map(of_channel).collect()
    }

    /// Standard deviation of each output over all runs, model units, as it was measured.
    #[must_use]
    pub fn motion_std(&self) -> Vec<f64> {
        let channels = 0..self.model.outputs.len();
        channels
            .map(|channel| self.motion_std_of(channel))
            .collect()
    }

    fn motion_std_of(&self, channel: usize) -> f64 {
        self.rms_of_motion(channel, self.measured(channel))
    }

    /// Rms of what an output shows in each run, about the mean of all, or of each where it may begin anywhere.
    fn rms_of_motion<'a>(
        &self,
        channel: usize,
        runs: impl Iterator<Item = &'a [f64]> + Clone,
    ) -> f64 {
        let output = &self.model.outputs[channel];
        let at = output.at.clone().map(Location::Mass);
        let is_position = output.kind == OutputKind::Displacement;
        if is_position && at.is_some_and(|at| self.model.is_level_free(&at)) {
            return rms_about_means(runs);
        }
        rms_about_mean(|| runs.clone().flatten())
    }

    /// The values of a channel, run by run.
    pub(crate) fn measured(&self, channel: usize) -> impl Iterator<Item = &[f64]> + Clone {
        let runs = self.runs.iter();
        runs.filter_map(move |run| run.measured[channel].as_deref())
    }

    /// By how much the effects of the model file and those held beside them multiply a constant signal of a channel; what takes from
    /// samples what they held has no gain.
    pub(crate) fn gain_of(&self, channel: &str) -> f64 {
        let here = self.given.iter();
        let here = here.filter(|placed| placed.at == Location::Channel(channel.into()));
        let gains = here.filter_map(|placed| match placed.action() {
            Action::Output(map) | Action::Sampling(map) if !map.is_lossy() => {
                let of = |value: f64| map.apply(Sampled::from_start(&[value; 8], 1.0))[0];
                Some(of(1.0) - of(0.0))
            }
            _ => None,
        });
        let gain: f64 = gains.product();
        // One but for rounding, or none.
        match gain.is_normal() && (gain - 1.0).abs() > 1e-9 {
            true => gain,
            false => 1.0,
        }
    }
}

/// Whether an effect lives in single samples as the converter took them.
fn lives_in_single_samples(effect: &dyn Effect) -> bool {
    let starts = effect.starts(&SiteScale::plain(1.0, 1.0, 1.0));
    let acts = |values: &Vec<f64>| match effect.action(values) {
        Action::Output(map) | Action::Sampling(map) => map.lives_in_single_samples(),
        _ => false,
    };
    starts.first().is_some_and(acts)
}

/// Rms of some signals about the mean of each.
pub(crate) fn rms_about_means<'a>(signals: impl Iterator<Item = &'a [f64]>) -> f64 {
    let (mut count, mut square) = (0.0_f64, 0.0);
    for signal in signals {
        let len = signal.len() as f64;
        count += len;
        square += len * rms_about_mean(|| signal.iter()).powi(2);
    }
    (square / count.max(1.0)).sqrt()
}

/// Root mean square about the mean.
pub(crate) fn rms_about_mean<'a, I: Iterator<Item = &'a f64>>(values: impl Fn() -> I) -> f64 {
    let (mut count, mut sum) = (0.0_f64, 0.0);
    for value in values() {
        count += 1.0;
        sum += value;
    }
    let mean = sum / count.max(1.0);
    let square: f64 = values().map(|value| (value - mean) * (value - mean)).sum();
    (square / count.max(1.0)).sqrt()
}
