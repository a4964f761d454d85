//! What the search has been at: it comes by the same set more than once.

use std::sync::{Mutex, PoisonError};

use crate::candidate_model::CandidateModel;

/// Share of what a fit leaves below which another of the same set leaves notably less.
const NOTABLY_LESS: f64 = 0.98;

/// What a search knows of itself, under the colour that sets are fitted with.
#[derive(Default)]
pub(crate) struct Visited {
    /// Sets that were extended.
    pub(crate) extended: Extended,
    /// Sets beside which nothing promises.
    pub(crate) unpromising: Extended,
    /// The set that the colour is of; none at first.
    pub(crate) coloured_by: Option<Vec<String>>,
}

/// Which sets have been extended, or changed in another way.
#[derive(Default)]
pub(crate) struct Extended(Mutex<Vec<Extension>>);

/// A set that was extended by so many of the best scores, or changed so often.
struct Extension {
    key: Vec<String>,
    /// What it left of each channel.
    variance: Vec<f64>,
    most: usize,
}

impl Extended {
    pub(crate) fn note(&self, set: &CandidateModel, most: usize) {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.push(Extension {
            key: set.key(),
            variance: set.fit.variance.clone(),
            most,
        });
    }

    /// Whether the set was extended by as many where it left no more.
    pub(crate) fn holds(&self, set: &CandidateModel, most: usize) -> bool {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.iter().any(|known| {
            let mut channels = known.variance.iter().zip(&set.fit.variance);
            let is_as_good = channels.all(|(before, now)| *now > NOTABLY_LESS * before);
            known.most >= most && is_as_good && known.key == set.key()
        })
    }
}
