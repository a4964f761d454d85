//! What a set of effects leaves, and whether a law of any shape at one place would explain it.
//!
//! ```text
//! excess = Σ_c ρ_c (1 − N_c / V_c) / Σ_c ρ_c                             (1)
//! share  = (bᵀâ / rᵀWr) / excess                                         (2)
//! over   = √(mean_c V_c / N_c)                                           (3)
//! ```
//!
//! V_c is the squared discrepancy of a channel, N_c its white noise and what the noise of the inputs does to it, ρ_c the share of its samples
//! that are independent; bᵀâ / rᵀWr is what the free law explains past all that the fit adjusts
//! (`simgap_estimate::score`). True effects leave noise, which no law explains. An effect that
//! stands in for a foreign one leaves the difference of the two laws, which the free law of its
//! place explains. What a real machine has besides, many small things at many places, it does not.

use rayon::prelude::*;
use simgap_effects::{Effect, free_laws, sites};
use simgap_estimate::{Candidate, EstimateError, linearise_at, score};
use simgap_model::Location;

use crate::diagnosis::Remains;
use crate::gap::{noise_variance, stepped};
use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// What a set leaves.
pub(crate) struct Remainder {
    /// rms over that of the noise, (3). Every channel counts alike: one that is left with a swing has few
    /// independent samples, and would hardly count in (1).
    pub(crate) over_noise: f64,
    /// The free law that explains most.
    pub(crate) law: Option<FreeLaw>,
}

/// A law of any shape at the place where it explains most.
pub(crate) struct FreeLaw {
    pub(crate) effect: &'static dyn Effect,
    pub(crate) at: Location,
    /// (2).
    pub(crate) share: f64,
}

impl Remainder {
    pub(crate) fn told(&self) -> Remains {
        Remains {
            over_noise: self.over_noise,
            law_at: self.law.as_ref().map(|law| law.at.clone()),
            law_share: self.law.as_ref().map_or(0.0, |law| law.share),
        }
    }
}

/// What a set leaves, by (1) to (3).
pub(crate) fn remainder(search: &Search<'_>, set: &Hypothesis) -> Result<Remainder, EstimateError> {
    let stepped = stepped(search.problem, set.effects());
    let noise = noise_variance(&set.fit.discrepancy, &stepped);
    let independence = &search.weights.independence;
    let (mut excess, mut over) = (0.0, 0.0);
    let noise: Vec<f64> = noise
        .iter()
        .zip(&search.input_noise)
        .map(|(white, driven)| white + driven.beyond(*white))
        .collect();
    for ((left, noise), independence) in set.fit.variance.iter().zip(&noise).zip(independence) {
        let ratio = left.max(f64::MIN_POSITIVE) / noise.max(f64::MIN_POSITIVE);
        excess += independence * (1.0 - ratio.recip()).max(0.0);
        over += ratio;
    }
    excess /= independence.iter().sum::<f64>();
    Ok(Remainder {
        over_noise: (over / noise.len().max(1) as f64).sqrt(),
        law: best_law(search, set, excess)?,
    })
}

fn best_law(
    search: &Search<'_>,
    set: &Hypothesis,
    excess: f64,
) -> Result<Option<FreeLaw>, EstimateError> {
    let linear = linearise_at(search.problem, &set.fit, &search.weights)?;
    let places: Vec<(&'static dyn Effect, Location)> = free_laws()
        .into_iter()
        .flat_map(|law| {
            let places = sites(&search.problem.model, law.site());
            places.into_iter().map(move |at| (law, at))
        })
        .collect();
    let scored = places
        .into_par_iter()
        .filter_map(|(effect, at)| {
            let scale = search.scale_at(&at)?;
            let candidate = Candidate { effect, at };
            let best = score(&linear, &candidate, &scale)
                .ok()?
                .into_iter()
                .next()?;
            Some((candidate, best))
        })
        .collect::<Vec<_>>();
    let earned = scored.into_iter().filter_map(|(candidate, best)| {
        let factors = candidate.effect.parameters().iter();
        let count = factors.filter(|p| p.neutral.is_some()).count() as f64;
        let penalty = 0.5 * count * search.effective_samples.ln();
        (best.gain > penalty).then(|| FreeLaw {
            effect: candidate.effect,
            at: candidate.at,
            share: (best.share / excess.max(f64::MIN_POSITIVE)).min(1.0),
        })
    });
    Ok(earned.max_by(|a, b| a.share.total_cmp(&b.share)))
}
