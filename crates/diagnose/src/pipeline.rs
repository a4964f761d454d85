//! The path from records to an answer.
//!
//! ```text
//! prepare -> noise model -> search -> posterior -> final fit -> check records -> description
//! ```
//!
//! No stage calls an earlier one. The check records come in after everything has been decided and fitted.

use std::borrow::Borrow;
use std::sync::Arc;

use simgap_effects::{Placed, catalogue_of};
use simgap_estimate::{
    Cancel, Fit, FitOptions, Problem, Start, fit, fit_initial_states, take_own_values,
};
use simgap_inference::noise_model::whitening;
use simgap_inference::{
    Budget, ModelSpace, NoiseModel, RECALIBRATION_STD, Search, Stage, read_inputs, recalibrate,
};
use simgap_model::{BetweenSamples, Model};
use simgap_record::{Defect, QualityFinding, Record};
use simgap_simulate::{ExternalPlant, Run};

use crate::check::Check;
use crate::data::{Data, divide};
use crate::decide::{Decision, decide};
use crate::diagnosis::{CheckSeries, Diagnosis, PlaceMotion, Where};
use crate::excerpt::{excerpts, first_excerpts};
use crate::final_fit::fit_to_all;
use crate::limit::Limit;
use crate::locate::Located;
use crate::outcome::{NominalEstimate, corrected_model, nominal_estimates, series};
use crate::prepared::Prepared;
use crate::sets::{FittedSet, fitted_sets};
use crate::{DiagnoseError, Status, describe, locate};

/// What is asked. Records are owned, borrowed or shared (`R`).
pub struct Request<'a, R = Record> {
    /// The nominal model.
    pub model: &'a Model,
    /// Records to learn from.
    pub train: &'a [R],
    /// Records to judge by; empty to hold back the last part of each training record.
    pub check: &'a [R],
    /// Kinds to take out of the catalogue.
    pub withheld: &'a [String],
    /// What ends the search with the best answer so far.
    pub limit: Limit<'a>,
    /// The simulator that the model stands for, where it stands for one ([`Model::is_external`]).
    pub plant: Option<Arc<ExternalPlant>>,
    /// Ends the whole work without an answer.
    pub cancel: Cancel,
}

impl<'a, R: Borrow<Record>> Request<'a, R> {
    /// A request without withheld kinds, with the usual limit.
    #[must_use]
    pub fn new(model: &'a Model, train: &'a [R], check: &'a [R]) -> Request<'a, R> {
        Request {
            model,
            train,
            check,
            withheld: &[],
            limit: Limit::default(),
            plant: None,
            cancel: Cancel::default(),
        }
    }
}

/// Told what is being done; called in order from the calling thread's pool.
pub type Progress<'a> = &'a (dyn Fn(&str) + Sync);

/// What comes out.
pub struct Outcome {
    /// The answer.
    pub diagnosis: Diagnosis,
    /// The model with recalibrated parameters and the named effects.
    pub corrected: Model,
    /// Predictions of the check records.
    pub series: Vec<CheckSeries>,
    /// The motion across each member along the check records.
    pub motions: Vec<PlaceMotion>,
    /// What the final fit says of each nominal parameter beside the named effects; empty where its values are those of
    /// something else (`unknown`).
    pub nominal: Vec<NominalEstimate>,
    /// Every set that was fitted, likeliest first, with the terms that decide: for replay and inspection.
    pub sets: Vec<FittedSet>,
}

/// Diagnoses the gap between a model and records.
///
/// The result depends on the model, the records and the withheld kinds alone, not on the number
/// of threads of the pool it runs in.
///
/// # Errors
/// [`DiagnoseError`] when the records do not fit the model, the model cannot be simulated, or the work was cancelled.
pub fn diagnose<R: Borrow<Record>>(
    request: &Request<'_, R>,
    progress: Progress<'_>,
) -> Result<Outcome, DiagnoseError> {
    known_kinds(request)?;
    let mut data = divide(request.model, request.train, request.check)?;
    progress(Stage::NominalModel.name());
    let model = read_inputs(request.model, &data.train, &request.cancel)?;
    data.notes.extend(read_otherwise(request.model, &model));
    let request = &Request {
        model: &model,
        plant: request.plant.clone(),
        cancel: request.cancel.clone(),
        ..*request
    };
    let mut prepared = prepare(request, &data)?;

    let options = FitOptions::white(request.model.outputs.len());
    let start = Start {
        effects: vec![],
        nominal: prepared.parameters.clone(),
        initial: fit_initial_states(&prepared.excerpt, &[], &options)?
            .estimate
            .initial,
    };
    let baseline = fit(&prepared.excerpt, &start, &options)?;
    let noise = NoiseModel::new(&prepared.excerpt, &baseline, &prepared.recalibrated)?;
    let noise = noise.at_rate_of(&prepared.train, &prepared.excerpt);
    let space = ModelSpace::new(&prepared.excerpt, &baseline, request.withheld)?;
    let parts = [&mut prepared.excerpt, &mut prepared.train].into_iter();
    for problem in parts.chain(&mut prepared.first_excerpt) {
        space.put_priors(problem);
    }
    let effort = prepared.train.effort.clone();
    let limit = request.limit;
    let is_spent = || limit.is_reached(&effort);
    let budget = Budget {
        progress,
        is_spent: &is_spent,
    };
    let gap = prepared.gap();
    let mut search = Search::new(&prepared.excerpt, &noise, space, &gap, budget);
    let pool = search.find(&start, prepared.first_excerpt.as_ref())?;
    let stopped_early = is_spent();
    // Sets that failed are left out of the pool, those of cancelled work too.
    request.cancel.check()?;

    progress(Stage::Posterior.name());
    let decision = decide(&search, pool, &start, &prepared)?;

    request.cancel.check()?;
    progress(Stage::FinalFit.name());
    // Intervals count the samples that what the answer leaves holds.
    let noise = match decision.posterior.best() {
        Some(best) => noise.with_colour_of(&best.fit).with_noise(&decision.noise),
        None => noise,
    };
    let final_options = noise.final_options();
    let as_given = &prepared.nominal.estimate.initial;
    let found = decision.start();
    let excerpt = &prepared.excerpt;
    let estimate = fit_to_all(&prepared.train, excerpt, found, as_given, &final_options)?;
    // A free law that leaves more of all records than re-estimated parameters is no model of them.
    let is_law = decision.status == Status::Unknown;
    let estimate = match is_law && estimate.misfit > prepared.misfit_of_parameters(&final_options) {
        true => prepared.recalibrated.clone(),
        false => estimate,
    };
    finish(
        request,
        &data,
        &prepared,
        decision,
        estimate,
        &final_options,
        progress,
        stopped_early,
    )
}

fn known_kinds<R>(request: &Request<'_, R>) -> Result<(), DiagnoseError> {
    let all = catalogue_of(request.model);
    let is_known = |kind: &String| all.iter().any(|effect| effect.kind() == kind);
    match request.withheld.iter().find(|kind| !is_known(kind)) {
        None => Ok(()),
        Some(found) => {
            let known: Vec<&str> = all.iter().map(|e| e.kind()).collect();
            Err(DiagnoseError::UnknownKind {
                found: found.clone(),
                known: known.join(", "),
            })
        }
    }
}

fn prepare<R: Borrow<Record>>(
    request: &Request<'_, R>,
    data: &Data,
) -> Result<Prepared, DiagnoseError> {
    let mut train = Problem::new(request.model, data.train.clone())?;
    train.plant.clone_from(&request.plant);
    train.leaves_out_ends = true;
    train.cancel = request.cancel.clone();
    let options = FitOptions::white(request.model.outputs.len());
    let mut nominal = fit_initial_states(&train, &[], &options)?;
    if let Some(filters) = whitening(&train, &data.check, &nominal, &options)? {
        train.whitening = filters;
        nominal = fit_initial_states(&train, &[], &options)?;
    }
    take_own_values(train.given.iter_mut(), &nominal);
    let is_withheld = |kind: &str| request.withheld.iter().any(|known| known == kind);
    let candidates = train.nominal_parameters().into_iter();
    let candidates = candidates.filter(|candidate| !is_withheld(candidate.effect.kind()));
    let parameters: Vec<Placed> = candidates
        .map(|candidate| {
            let values = vec![1.0; candidate.effect.parameters().len()];
            Placed::new(candidate.effect, candidate.at, values)
        })
        .collect();
    let start = Start {
        effects: vec![],
        nominal: parameters.clone(),
        initial: nominal.estimate.initial.clone(),
    };
    let loose = FitOptions {
        nominal_std: Some(RECALIBRATION_STD),
        ..options
    };
    let recalibrated = recalibrate(&train, &start, &loose)?;
    let part = |runs: Vec<Run>| {
        let mut part = train.with_runs(runs);
        part.leaves_out_ends = true;
        part
    };
    let left = &recalibrated.discrepancy;
    let (excerpt, first_excerpt) = match train.may_cut() {
        true => {
            let first = first_excerpts(&train.runs, left);
            (part(excerpts(&train.runs, left)), first.map(part))
        }
        false => (part(train.runs.clone()), None),
    };
    Ok(Prepared {
        train,
        excerpt,
        first_excerpt,
        nominal,
        recalibrated,
        parameters,
    })
}

#[allow(clippy::too_many_arguments)]
fn finish<R: Borrow<Record>>(
    request: &Request<'_, R>,
    data: &Data,
    prepared: &Prepared,
    decision: Decision,
    estimate: Fit,
    options: &FitOptions,
    progress: Progress<'_>,
    stopped_early: bool,
) -> Result<Outcome, DiagnoseError> {
    progress(Stage::CheckRecords.name());
    let check = Check::new(&prepared.train, &prepared.recalibrated, data.check.clone())?;
    let placed = |estimate: &Fit| -> Vec<Placed> { estimate.estimate.placed().cloned().collect() };
    let is_as_given = decision.status == Status::None;
    let checked = check.of((&estimate, options), &placed(&estimate), is_as_given)?;
    // What runs away along a check record is no model of it, whatever was measured there.
    let (estimate, checked) = match checked.runs_away() {
        true => {
            let known = prepared.recalibrated.clone();
            let of_known = check.of((&known, options), &placed(&known), is_as_given)?;
            (known, of_known.in_place_of_what_runs_away())
        }
        false => (estimate, checked),
    };
    let placed = placed(&estimate);
    let verdict = describe::verdict(request.model, &decision, &estimate, &checked, &data.units);
    let candidates = describe::candidates(&decision, &verdict, &check)?;
    let floors: Vec<f64> = checked.gap.channels.iter().map(|c| c.noise_floor).collect();
    let located = Located::new(&check.problem, &checked.predictions[0], &floors);
    let places = simgap_effects::sites(request.model, simgap_effects::SiteKind::Member);
    let motions = locate::motions(&check.problem, &checked.predictions[0], &places)?;
    let r#where = Where {
        channels: locate::channels(&located),
        locations: describe::locations(&decision, verdict.status == Status::Unknown),
        bands: locate::bands(&located),
        times: locate::times(&located),
        states: locate::states(&located, &motions),
        records: locate::records(&located),
    };
    let verdict_status = verdict.status;
    let mut notes: Vec<String> = checked.notes.clone();
    if located.is_hidden {
        let hidden = "the gap hardly stands out of the noise: where it lies is where the noise is";
        notes.push(hidden.into());
    }
    if stopped_early {
        let ended = "the search ended at its limit, before all that was promising was tried";
        notes.push(ended.into());
    }
    notes.extend(quality_notes(request, data));
    Ok(Outcome {
        corrected: corrected_model(request.model, &placed),
        series: series(
            &check.problem,
            data,
            &checked.predictions[0],
            &checked.predictions[2],
        )?,
        motions,
        nominal: match verdict_status {
            Status::Unknown => vec![],
            _ => nominal_estimates(&prepared.train, &estimate, &data.units),
        },
        sets: fitted_sets(&decision.posterior),
        diagnosis: Diagnosis {
            schema: "simgap-diagnosis/1",
            model: request.model.name.clone(),
            next_experiment: describe::next_experiment(request.model, &verdict, &checked),
            gap: checked.gap,
            r#where,
            verdict,
            turning: data.units.turning.clone(),
            candidates,
            stopped_early,
            notes,
        },
    })
}

/// Tells of the inputs that are read otherwise than the model file says.
fn read_otherwise(given: &Model, read: &Model) -> Vec<String> {
    let inputs = given.inputs.iter().zip(&read.inputs);
    let differ = inputs.filter(|(given, read)| given.between_samples != read.between_samples);
    let told = differ.map(|(_, input)| {
        let how = match input.between_samples() {
            BetweenSamples::Smooth => "a smooth curve through the samples",
            BetweenSamples::Linear => "straight lines between the samples (first-order hold)",
            BetweenSamples::Held => "held from sample to sample (zero-order hold)",
            BetweenSamples::Stepped => "a smooth curve but for its jumps, which come with their samples",
        };
        format!(
            "input \"{}\" goes in jumps and is read as {how}: so the model leaves least of the training records. State \
             `between_samples` in its [[input]] to read it otherwise",
            input.channel
        )
    });
    told.collect()
}

fn quality_notes<R: Borrow<Record>>(request: &Request<'_, R>, data: &Data) -> Vec<String> {
    let mut notes = data.notes.clone();
    for record in request.train.iter().chain(request.check) {
        let record = record.borrow();
        let findings = simgap_record::quality(record).into_iter();
        for finding in findings.filter(worth_a_note) {
            notes.push(format!("{}: {finding}", record.name()));
        }
    }
    notes
}

/// A lattice of more steps than this is how numbers are printed, not what a converter does.
const FINE_LATTICE: usize = 4096;

fn worth_a_note(finding: &QualityFinding) -> bool {
    !matches!(finding.defect, Defect::Quantised { levels, .. } if levels > FINE_LATTICE)
}
