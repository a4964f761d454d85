//! The answer, fitted to all samples.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Fit, FitOptions, Problem, Start, fit, fit_initial_states};

/// Fits a set that was found on an excerpt to whole records.
///
/// Where they begin is taken from the model as given, unless the set itself is all that shows it. An excerpt that begins
/// where the records do has found that too, and another start may end in another valley (play, sticking, stops, a hidden
/// mass): the better fit counts.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated from either start.
pub(crate) fn fit_to_all(
    train: &Problem,
    excerpt: &Problem,
    found: &Start,
    as_given: &[Vec<f64>],
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let mut effects = found.effects.iter();
    let initial = if effects.any(|placed| train.shows_travel(placed)) {
        let all: Vec<Placed> = found.placed().cloned().collect();
        fit_initial_states(train, &all, weights)?.estimate.initial
    } else {
        as_given.to_vec()
    };
    let from_given = Start {
        initial,
        ..found.clone()
    };
    let from_given = fit(train, &from_given, weights);
    let mut runs = excerpt.runs.iter().zip(&train.runs);
    if !runs.all(|(part, run)| part.start_s == run.start_s) {
        return from_given;
    }
    match (from_given, fit(train, found, weights)) {
        (Ok(given), Ok(own)) if own.objective < given.objective => Ok(own),
        (Ok(given), _) => Ok(given),
        (Err(_), own) => own,
    }
}
