//! The truths are opened and the answers held against them.

use std::path::Path;

use rayon::prelude::*;
use serde_json::Value;
use simgap_blind::{Answer, Named, SealedCase, Signals, Status, Truth, score};
use simgap_effects::Placed;
use simgap_estimate::{FitOptions, Problem, fit_initial_states};
use simgap_model::{Location, Model};
use simgap_record::read_csv;
use simgap_simulate::Run;

use super::BlindCheckError;
use super::ask::Answered;
use super::draw::{Sealed, digests};
use super::files::{CHECK, MODEL, Places, read, write};
use super::judged::Judged;
use super::page::detail;
use super::plan::Planned;
use super::worker::Reply;

/// Opens the truths, if neither they nor the files of the cases have changed, and scores.
pub(super) fn open(
    sealed: &Sealed,
    planned: &[Planned],
    answers: &[Answered],
    places: &Places,
) -> Result<Vec<Judged>, BlindCheckError> {
    let truths = simgap_blind::open(&sealed.text, &sealed.digest)?;
    if let Some(path) = &places.opened {
        write(path, &sealed.text)?;
    }
    truths
        .par_iter()
        .zip(planned)
        .zip(answers)
        .map(|((case, plan), answered)| judge(case, plan, answered, places))
        .collect()
}

fn judge(
    case: &SealedCase,
    plan: &Planned,
    answered: &Answered,
    places: &Places,
) -> Result<Judged, BlindCheckError> {
    let folder = places.of_case(&case.name);
    unchanged(case, &folder)?;
    let model = Model::from_toml(&String::from_utf8_lossy(&read(&folder.join(MODEL))?))?;
    let best = if case.truth.is_closable() {
        best(&case.truth, &model, &folder)
    } else {
        None
    };
    let (answer, reply) = match answered {
        Answered::Reply(reply) => (answer(reply), Ok(reply.as_ref())),
        Answered::Failed(why) => (Answer::nothing(), Err(why.as_str())),
    };
    let score = score(&case.name, &case.truth, &answer, best.as_ref());
    Ok(Judged {
        detail: detail(case, plan, &model, &score, &answer, reply),
        is_failed: reply.is_err(),
        seconds: reply.map_or(f64::NAN, |reply| reply.seconds),
        score,
    })
}

fn unchanged(case: &SealedCase, folder: &Path) -> Result<(), BlindCheckError> {
    let now = digests(folder)?;
    for (file, needed) in &case.files {
        let found = now.get(file).cloned().unwrap_or_default();
        if found != *needed {
            return Err(BlindCheckError::Changed {
                path: folder.join(file).display().to_string(),
                found,
                needed: needed.clone(),
            });
        }
    }
    Ok(())
}

/// Predictions of the check record by the true effects and parameters, at the rate of the record;
/// only how the record begins is fitted. `None` when the true model cannot be propagated so.
fn best(truth: &Truth, model: &Model, folder: &Path) -> Option<Signals> {
    let hidden = truth.deviations.iter().chain(&truth.effects);
    let effects: Option<Vec<Placed>> = hidden.map(|hidden| hidden.placed()).collect();
    let record = read_csv(&folder.join(CHECK)).ok()?;
    let run = Run::with_outputs(model, &record).ok()?;
    let problem = Problem::new(model, vec![run]).ok()?;
    let weights = FitOptions::white(model.outputs.len());
    let fit = fit_initial_states(&problem, &effects?, &weights).ok()?;
    let runs = problem.runs.iter().zip(&fit.discrepancy);
    let predicted = |(run, rest): (&Run, &Vec<Vec<f64>>)| -> Vec<Vec<f64>> {
        let channels = run.measured.iter().zip(rest);
        channels
            .map(|(measured, rest)| {
                let measured = measured.iter().flatten();
                measured.zip(rest).map(|(y, r)| y - r).collect()
            })
            .collect()
    };
    Some(runs.map(predicted).collect())
}

/// The answer of a worker in the words of the score.
fn answer(reply: &Reply) -> Answer {
    let diagnosis = &reply.diagnosis;
    let verdict = &diagnosis["verdict"];
    let effects = verdict["effects"].as_array();
    let is_complete = verdict["complete"].as_bool().unwrap_or(true);
    let named = |effect: &Value| named(effect, is_complete);
    Answer {
        status: match verdict["status"].as_str() {
            Some("parameters") => Status::Parameters,
            Some("effect") => Status::Effect,
            Some("unknown") => Status::Unknown,
            _ => Status::None,
        },
        named: effects.into_iter().flatten().filter_map(named).collect(),
        closed: diagnosis["gap"]["closed"].as_f64().unwrap_or(f64::NAN),
        nominal: reply.nominal.clone(),
        corrected: reply.corrected.clone(),
    }
}

fn named(effect: &Value, is_complete: bool) -> Option<Named> {
    let (kind, at) = kind_at(effect)?;
    let rivals = effect["indistinguishable"].as_array();
    Some(Named {
        kind,
        at,
        probability: effect["probability"].as_f64().unwrap_or(0.0),
        indistinguishable: rivals.into_iter().flatten().filter_map(kind_at).collect(),
        is_incomplete: !is_complete,
    })
}

fn kind_at(value: &Value) -> Option<(String, Location)> {
    let at: Location = serde_json::from_value(value["at"].clone()).ok()?;
    Some((value["kind"].as_str()?.to_string(), at))
}
