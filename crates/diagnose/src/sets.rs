//! The sets that were fitted, as data: what a decision was made from.

use std::collections::BTreeMap;

use serde::Serialize;
use simgap_inference::{CandidateModel, ModelPosterior};
use simgap_model::Location;

/// One fitted set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedSet {
    /// Its effects.
    pub effects: Vec<FittedEffect>,
    /// ln Z.
    pub log_marginal_likelihood: f64,
    /// ln p before any data.
    pub log_prior: f64,
    /// p after the data, with that of the sets that stand for it: they hold effects besides that are not worth a name.
    pub probability: f64,
    /// Minus the log-likelihood at the estimate, but for a constant that all sets share.
    pub misfit: f64,
    /// Values that were integrated over.
    pub dimensions: usize,
    /// Mean square discrepancy of each channel.
    pub variance: Vec<f64>,
}

/// One effect of a fitted set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedEffect {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Estimates by name.
    pub parameters: BTreeMap<String, f64>,
}

/// Every set of a posterior, likeliest first.
pub(crate) fn fitted_sets(posterior: &ModelPosterior) -> Vec<FittedSet> {
    let sets = posterior.sets.iter().zip(&posterior.probabilities);
    sets.map(|(set, probability)| fitted_set(set, *probability))
        .collect()
}

fn fitted_set(set: &CandidateModel, probability: f64) -> FittedSet {
    let effects = set.effects().iter().map(|placed| {
        let entry = placed.to_entry();
        FittedEffect {
            kind: entry.kind,
            at: entry.at,
            parameters: entry.parameters,
        }
    });
    let coordinates = set.fit.curvature.coordinates.iter();
    FittedSet {
        effects: effects.collect(),
        log_marginal_likelihood: set.log_marginal_likelihood,
        log_prior: set.log_prior,
        probability,
        misfit: set.fit.misfit,
        dimensions: coordinates.filter(|c| !c.is_held).count(),
        variance: set.fit.variance.clone(),
    }
}
