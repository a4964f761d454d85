//! The probability that the main cause is a law which the catalogue lacks.
//!
//! ```text
//! u² = Σ_c max(V_c − 1.1 N_c, 0) / s_c²  over  Σ_c max(G_c − 1.1 N_c, 0) / s_c²             (1)
//! ln odds = ln(p₀/(1−p₀)) + ½ m ln((u² + r²)/r²) + ½ n ln((u² + r²)/(u_f² + r²)) + ln B   (2)
//! ```
//!
//! u is what the best set leaves of the gap, u_f what a free law at one place leaves, each over noise: V_c squared
//! discrepancy, N_c noise, which is known to a tenth, G_c the gap of the model as given (at most the variance s_c² of the channel). What is left is
//! no proof of another *main* cause, since no model is exact: a gap counts as few independent observations, m for a cause
//! of any kind that would explain all of it, n where a law was found that does; shares below r do not count. B is the odds
//! of one cause behind two effects of the best set whose values agree ([`Coincidence`]), at least 1.

use rayon::prelude::*;
use simgap_effects::{Effect, Placed, free_laws, sites};
use simgap_estimate::{Candidate, EstimateError, Fit, linearise_at, score};
use simgap_model::Location;

use crate::candidate_model::{CandidateModel, add};
use crate::coincidence::{Coincidence, coincidence};
use crate::noise_model::NOISE_KNOWN;
use crate::search::Search;

/// p₀ of (2).
const PRIOR: f64 = 0.05;
/// m and n of (2).
const ANY_CAUSE: f64 = 1.3;
const FOUND_LAW: f64 = 2.0;
/// r of (2): the share of a gap below which what is left does not count.
pub const RELEVANT_SHARE: f64 = 0.05;
/// Free laws that are fitted.
const FITTED: usize = 2;

/// The gap that is to be explained, and its noise.
pub struct Gap {
    /// G_c of (1).
    pub square: Vec<f64>,
    /// N_c.
    pub noise: Vec<f64>,
    /// s_c.
    pub std: Vec<f64>,
}

impl Gap {
    /// u of (1) for what is left of each channel; zero where there is no gap.
    #[must_use]
    pub fn left(&self, variance: &[f64]) -> f64 {
        let over_noise = |square: &[f64]| -> f64 {
            let channels = square.iter().zip(&self.noise).zip(&self.std);
            channels
                .map(|((square, noise), std)| (square - NOISE_KNOWN * noise).max(0.0) / (std * std))
                .sum()
        };
        let all = over_noise(&self.square);
        let left = (over_noise(variance) / all).sqrt();
        if left.is_finite() { left } else { 0.0 }
    }
}

/// A free law that was fitted in the place of a set.
pub struct FreeLaw {
    /// The law with its values.
    pub placed: Placed,
    /// The fit.
    pub fit: Fit,
    /// u_f of (1).
    pub left: f64,
}

/// What is said of a cause outside the catalogue.
pub struct Other {
    /// Its probability.
    pub probability: f64,
    /// u of the best set.
    pub left: f64,
    /// The free law that leaves least, where one was sought.
    pub law: Option<FreeLaw>,
    /// Values of the best set that speak for one cause behind them.
    pub coincidence: Option<Coincidence>,
}

/// Weighs the best set against a law of any shape. `base` holds no effect.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn other(
    search: &Search<'_>,
    base: &CandidateModel,
    best: &CandidateModel,
    gap: &Gap,
) -> Result<Other, EstimateError> {
    let left = gap.left(&best.fit.variance);
    let law = match left > RELEVANT_SHARE {
        true => best_law(search, base, gap)?,
        false => None,
    };
    let relevant = RELEVANT_SHARE.powi(2);
    let own = left.powi(2) + relevant;
    let mut log_odds = (PRIOR / (1.0 - PRIOR)).ln() + 0.5 * ANY_CAUSE * (own / relevant).ln();
    if let Some(law) = &law {
        let of_law = law.left.powi(2) + relevant;
        log_odds += 0.5 * FOUND_LAW * (own / of_law).ln().max(0.0);
    }
    let coincidence = coincidence(best, &search.space);
    log_odds += coincidence.as_ref().map_or(0.0, |found| found.log_odds);
    Ok(Other {
        coincidence,
        probability: 1.0 / (1.0 + (-log_odds).exp()),
        left,
        law,
    })
}

fn best_law(
    search: &Search<'_>,
    base: &CandidateModel,
    gap: &Gap,
) -> Result<Option<FreeLaw>, EstimateError> {
    let linear = linearise_at(search.problem, &base.fit, &search.options)?;
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
            let scale = search.space.scale_at(&at)?;
            let candidate = Candidate { effect, at };
            score(&linear, &candidate, &scale).ok()?.into_iter().next()
        })
        .collect::<Vec<_>>();
    let mut scored = scored;
    scored.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    scored.truncate(FITTED);
    let fitted = scored.into_par_iter().filter_map(|score| {
        let start = add(&base.fit.estimate, score.start);
        let fit = linear.fit(&start, &search.options).ok()?;
        Some(FreeLaw {
            placed: fit.estimate.effects.first()?.clone(),
            left: gap.left(&fit.variance),
            fit,
        })
    });
    let fitted: Vec<FreeLaw> = fitted.collect();
    Ok(fitted.into_iter().min_by(|a, b| a.left.total_cmp(&b.left)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_shares_of_a_gap_are_over_noise() {
        let gap = Gap {
            square: vec![1.011, 0.01],
            noise: vec![0.01, 0.01],
            std: vec![2.0, 1.0],
        };
        assert!((gap.left(&[0.261, 0.01]) - 0.5).abs() < 1e-12);
        assert_eq!(gap.left(&[0.01, 0.005]), 0.0);
        let none = Gap {
            square: vec![0.01],
            noise: vec![0.01],
            std: vec![1.0],
        };
        assert_eq!(none.left(&[0.02]), 0.0);
    }
}
