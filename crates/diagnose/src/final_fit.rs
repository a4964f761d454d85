//! The answer, fitted to all samples.

use simgap_effects::{Family, Placed};
use simgap_estimate::{EstimateError, Fit, FitOptions, Problem, Start, fit, fit_initial_states};

/// Fits a set that was found on an excerpt to whole records.
///
/// Where they begin is not known then, and is taken from the model as given, unless the set itself is all that shows it.
/// Where the excerpt is all there is, the set has found where they begin: with play, sticking or stops another start may
/// end in another valley, and the better one counts.
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
    let mut runs = excerpt.runs.iter().zip(&train.runs);
    let is_all = runs.all(|(part, run)| part.len == run.len);
    let mut effects = found.effects.iter();
    let may_part = effects.any(|placed| placed.effect.family() == Family::Force);
    let initial = if found
        .effects
        .iter()
        .any(|placed| train.shows_travel(placed))
    {
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
    if !(is_all && may_part) {
        return from_given;
    }
    match (from_given, fit(train, found, weights)) {
        (Ok(given), Ok(own)) if own.objective < given.objective => Ok(own),
        (Ok(given), _) => Ok(given),
        (Err(_), own) => own,
    }
}
