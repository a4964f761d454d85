//! The probability that the main cause is a law which the catalogue lacks.
//!
//! ```text
//! ln odds = ln(p₀/(1−p₀)) + ½ m ln((u² + r²)/r²) + ½ n ln((u² + r²)/(u_f² + r²)) + ln B   (1)
//! ```
//!
//! u is what the best set leaves of the gap of the model as given ([`Gap`]), u_f what a free law at one place leaves. What is
//! left is no proof of another *main* cause, since no model is exact: a gap counts as few independent observations, m for a
//! cause of any kind that would explain all of it, n where a law was found that does; shares below r ([`RELEVANT_SHARE`]) do
//! not count. B is the odds of one cause behind two effects of the best set whose values agree ([`Coincidence`]), at least 1, and 1 where
//! the set leaves no share that counts without them.

use rayon::prelude::*;
use simgap_effects::{Effect, Placed, free_laws, sites};
use simgap_estimate::{Candidate, EstimateError, Fit, linearise_at, score};
use simgap_model::Location;

use crate::candidate_model::{CandidateModel, add, is_bent_from, keep};
use crate::coincidence::{Coincidence, coincidence};
use crate::gap::{Gap, RELEVANT_SHARE, over_noise};
use crate::motion;
use crate::relevance::closed;
use crate::search::Search;

/// The status is `unknown` where another cause is likelier than this, by the training records or by the check records.
pub const LIKELIER_THAN_NOT: f64 = 0.5;
/// p₀ of (1).
const PRIOR: f64 = 0.05;
/// m and n of (1).
const ANY_CAUSE: f64 = 1.3;
const FOUND_LAW: f64 = 2.0;
/// Free laws that are fitted.
const FITTED: usize = 2;

/// A free law that was fitted in the place of a set.
pub struct FreeLaw {
    /// The law with its values.
    pub placed: Placed,
    /// The fit.
    pub fit: Fit,
    /// u_f.
    pub left: f64,
}

/// What is said of a cause outside the catalogue.
pub struct Other {
    /// Its probability.
    pub probability: f64,
    /// u of the best set.
    pub left: f64,
    /// The free law that leaves least, where one was sought and leaves less than no law and re-estimated parameters do.
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
    let over_noise: Vec<f64> = over_noise(&best.fit.variance, &gap.noise).collect();
    // What moves no output by enough for a name is no cause.
    let is_cause = motion::is_enough(&over_noise, &gap.std).any(|enough| enough);
    let left = match is_cause {
        true => gap.left(&best.fit.variance),
        false => 0.0,
    };
    let law = match left > RELEVANT_SHARE {
        true => best_law(search, base, gap)?,
        false => None,
    };
    let relevant = RELEVANT_SHARE.powi(2);
    let own = left.powi(2) + relevant;
    let mut log_odds = of_any_cause(left, 0.0);
    if let Some(law) = &law {
        let of_law = law.left.powi(2) + relevant;
        log_odds += 0.5 * FOUND_LAW * (own / of_law).ln().max(0.0);
    }
    let coincidence = match coincidence(best, &search.space) {
        Some(found) if is_of_the_main_cause(&found, search, best, gap)? => Some(found),
        _ => None,
    };
    log_odds += coincidence.as_ref().map_or(0.0, |found| found.log_odds);
    Ok(Other {
        coincidence,
        probability: probability_of(log_odds),
        left,
        law,
    })
}

fn probability_of(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

/// The first two terms of (1), with odds of causes too small for a law beside p₀.
fn of_any_cause(left: f64, small: f64) -> f64 {
    let relevant = RELEVANT_SHARE.powi(2);
    (PRIOR / (1.0 - PRIOR) + small).ln() + 0.5 * ANY_CAUSE * (left.powi(2) / relevant).ln_1p()
}

/// The probability of a cause of any kind outside the catalogue by (1), where a share of what should be explained is left.
#[must_use]
pub fn other_by(left: f64) -> f64 {
    probability_of(of_any_cause(left.min(1.0), 0.0))
}

/// The probability that what an effect explains beside others has a cause of any kind outside the catalogue, by (1) with what the others
/// leave as the gap: an effect that leaves much of that follows it, and may not be it. What moves the outputs by d of their motion may also be one of
/// the small things that every lumped model misses: p₀/(1−p₀) is then larger by (r_m/d)² ([`motion::odds_of_small_cause`]).
pub(crate) fn other_of_one(
    search: &Search<'_>,
    (with, noise): (&CandidateModel, &[f64]),
    without: &CandidateModel,
) -> f64 {
    let gap = Gap {
        square: without.fit.variance.clone(),
        noise: noise.to_vec(),
        std: search.problem.output_std(),
    };
    let closed = closed(with, without).zip(&gap.std);
    let moved: f64 = closed.map(|(square, std)| square / (std * std)).sum();
    // Nominal parameters that are bent to stand for the effect do what it does.
    let small = match is_bent_from(without, with) {
        true => 0.0,
        false => motion::odds_of_small_cause(moved.sqrt()),
    };
    probability_of(of_any_cause(gap.left(&with.fit.variance).min(1.0), small))
}

/// Whether values that agree are those of what closes the gap: the set without these effects leaves a share of it that counts.
fn is_of_the_main_cause(
    found: &Coincidence,
    search: &Search<'_>,
    best: &CandidateModel,
    gap: &Gap,
) -> Result<bool, EstimateError> {
    let others = |i: usize| {
        let placed = &best.effects()[i];
        let mut effects = found.effects.iter();
        effects.all(|(kind, at)| *kind != placed.effect.kind() || *at != placed.at)
    };
    let without = search.fit(&keep(&best.fit.estimate, others, search.nominal))?;
    Ok(gap.left(&without.fit.variance) > RELEVANT_SHARE)
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
    let least = fitted.into_iter().min_by(|a, b| a.left.total_cmp(&b.left));
    let of_parameters = gap.left(&base.fit.variance).min(1.0);
    Ok(least.filter(|law| law.left < of_parameters))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_odds_are_even_where_half_is_left() {
        assert!((other_by(0.0) - PRIOR).abs() < 1e-12);
        assert!(other_by(0.45) < LIKELIER_THAN_NOT && other_by(0.5) > LIKELIER_THAN_NOT);
        // More than all is all.
        assert_eq!(other_by(3.0), other_by(1.0));
        let shares: Vec<f64> = (0..=20).map(|n| other_by(f64::from(n) / 20.0)).collect();
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
