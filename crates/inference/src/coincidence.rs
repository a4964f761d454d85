//! Values that agree better than independent causes would have them.
//!
//! Two effects are two causes, each with a prior of its own: two sensors are late by two times, and what swings a spring has
//! another frequency than what swings a damper. Where values of one name agree, one cause that acts in both ways is likelier. By
//! how much is the ratio of the two hypotheses' marginal likelihoods, which needs no further fit,
//!
//! ```text
//! B = p(u₁ − u₂ = 0 | y) / p(u₁ − u₂ = 0)                                  (1)
//! ```
//!
//! with u the coordinate in which a prior is near normal ([`simgap_effects::Prior`]). The same holds for two values of
//! one effect whose agreement makes it another law ([`simgap_effects::Effect::coincidence`]). Values whose agreement has a well-known
//! cause, the unit of both records or the mains, say nothing.
//!
//! Reference: \[Dickey1971\], the Savage-Dickey density ratio.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::{LocalPrior, Placed};
use simgap_estimate::Owner;
use simgap_model::Location;

use crate::candidate_model::{CandidateModel, is_nominal};
use crate::model_space::ModelSpace;

/// Values of a set that agree.
#[derive(Debug, Clone)]
pub struct Coincidence {
    /// Name of the value.
    pub parameter: &'static str,
    /// Kind and place of each effect that has it: one, or two.
    pub effects: Vec<(&'static str, Location)>,
    /// ln B of (1).
    pub log_odds: f64,
}

/// The most striking coincidence of a set; none where every value is more likely one of its own.
pub(crate) fn coincidence(set: &CandidateModel, space: &ModelSpace) -> Option<Coincidence> {
    let posterior = Posterior::of(set, space)?;
    let effects = set.effects();
    let mut found: Vec<Coincidence> = vec![];
    for (i, placed) in effects.iter().enumerate() {
        let pair = placed.effect.coincidence();
        if let Some([a, b]) = pair.filter(|_| is_another_law(placed, effects)) {
            found.extend(posterior.compare((i, a), (i, b), effects));
        }
        for (j, other) in effects.iter().enumerate().skip(i + 1) {
            for (k, parameter) in placed.effect.parameters().iter().enumerate() {
                let others = other.effect.parameters().iter();
                let mut same = others
                    .enumerate()
                    .filter(|(_, of)| of.name == parameter.name);
                let pair = same.next().map(|(l, _)| ((i, k), (j, l)));
                found.extend(pair.and_then(|(one, other)| posterior.compare(one, other, effects)));
            }
        }
    }
    let found = found.into_iter().filter(|known| known.log_odds > 0.0);
    found.max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))
}

/// Whether a law whose two values agree is another one: one of its special cases, or a law about rest that took a wrong nominal value
/// at its place to make. Without these it is alike on both sides, as most machines are.
fn is_another_law(placed: &Placed, effects: &[Placed]) -> bool {
    let mut beside = effects.iter().filter(|other| other.at == placed.at);
    !placed.effect.contains().is_empty() || beside.any(is_nominal)
}

/// Normal approximations of prior and posterior in the coordinates of the prior.
struct Posterior {
    /// Owner, prior and typical size of each value of an effect that is the same in all records.
    values: Vec<(Owner, LocalPrior, bool)>,
    /// Covariance of the values.
    covariance: Mat<f64>,
}

impl Posterior {
    fn of(set: &CandidateModel, space: &ModelSpace) -> Option<Posterior> {
        let coordinates = &set.fit.curvature.coordinates;
        let free: Vec<usize> = (0..coordinates.len())
            .filter(|&i| !coordinates[i].is_held)
            .collect();
        // Of what is no value of an effect, the prior is that of the fit, in its own unit.
        let mut values = vec![];
        let mut slopes = vec![];
        let mut precision = vec![];
        for &i in &free {
            let coordinate = &coordinates[i];
            let Owner::Effect(e, k) = coordinate.owner else {
                slopes.push(1.0);
                precision.push((coordinate.scale / coordinate.prior_std).powi(2));
                continue;
            };
            let placed = set.effects().get(e)?;
            let parameter = placed.effect.parameters().get(k)?;
            let prior = placed.effect.prior(k, &space.scale_at(&placed.at)?);
            let local = prior.local(coordinate.value, parameter);
            slopes.push(local.slope / coordinate.scale);
            precision.push(local.std.powi(-2));
            if !parameter.per_record {
                let has_cause = prior.has_a_common_cause(coordinate.value);
                values.push((slopes.len() - 1, coordinate.owner, local, has_cause));
            }
        }
        let hessian = &set.fit.curvature.hessian;
        let matrix = Mat::from_fn(free.len(), free.len(), |i, j| {
            let own = if i == j { precision[i] } else { 0.0 };
            hessian[(free[i], free[j])] * slopes[i] * slopes[j] + own
        });
        let identity = Mat::from_fn(free.len(), values.len(), |i, v| {
            f64::from(u8::from(values[v].0 == i))
        });
        let solved = matrix.llt(Side::Lower).ok()?.solve(&identity);
        let count = values.len();
        Some(Posterior {
            covariance: Mat::from_fn(count, count, |v, w| solved[(values[v].0, w)]),
            values: values
                .into_iter()
                .map(|(_, owner, local, has_cause)| (owner, local, has_cause))
                .collect(),
        })
    }

    /// (1) of two values, each of an effect and one of its parameters.
    fn compare(
        &self,
        one: (usize, usize),
        other: (usize, usize),
        effects: &[Placed],
    ) -> Option<Coincidence> {
        let place = |(e, k): (usize, usize)| {
            let owner = Owner::Effect(e, k);
            self.values.iter().position(|(known, ..)| *known == owner)
        };
        let (a, b) = (place(one)?, place(other)?);
        let [(_, first, known), (_, second, also_known)] = [self.values[a], self.values[b]];
        let value = |(e, k): (usize, usize)| effects[e].values[k];
        if known || also_known || (value(one) < 0.0) != (value(other) < 0.0) {
            return None;
        }
        let of_posterior =
            self.covariance[(a, a)] + self.covariance[(b, b)] - 2.0 * self.covariance[(a, b)];
        let of_prior = first.std.powi(2) + second.std.powi(2);
        let sign = first.log_weight.max(second.log_weight);
        let log_odds = log_normal(first.coordinate - second.coordinate, of_posterior)
            - log_normal(first.mean - second.mean, of_prior)
            - sign;
        let mut places = vec![one.0, other.0];
        places.dedup();
        let placed = places.into_iter().map(|e| &effects[e]);
        Some(Coincidence {
            parameter: effects[one.0].effect.parameters()[one.1].name,
            effects: placed.map(|p| (p.effect.kind(), p.at.clone())).collect(),
            log_odds,
        })
        .filter(|found| found.log_odds.is_finite())
    }
}

/// ln N(x; 0, variance).
fn log_normal(x: f64, variance: f64) -> f64 {
    -0.5 * (x * x / variance + (std::f64::consts::TAU * variance).ln())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn local(coordinate: f64) -> LocalPrior {
        LocalPrior {
            coordinate,
            slope: 1.0,
            mean: 0.0,
            std: 1.5,
            log_weight: 0.0,
        }
    }

    fn posterior(apart: f64, std: f64) -> Posterior {
        let values = vec![
            (Owner::Effect(0, 0), local(0.0), false),
            (Owner::Effect(1, 0), local(apart), false),
        ];
        Posterior {
            values,
            covariance: Mat::from_fn(2, 2, |i, j| if i == j { std * std } else { 0.0 }),
        }
    }

    fn delays(values: [f64; 2]) -> Vec<Placed> {
        let effect = simgap_effects::find("sensor_delay").unwrap();
        let at = |name: &str| Location::Channel(name.into());
        let placed = |(name, value)| Placed::new(effect, at(name), vec![value]);
        [("x", values[0]), ("a", values[1])].map(placed).into()
    }

    #[test]
    fn verify_values_that_agree_speak_for_one_cause() {
        let log_odds = |apart: f64, std: f64| {
            let found = posterior(apart, std).compare((0, 0), (1, 0), &delays([1e-3, 1e-3]));
            found.unwrap().log_odds
        };
        // Two normals of the difference at zero: their widths apart.
        assert!((log_odds(0.0, 1.5e-3) - 1e3_f64.ln()).abs() < 1e-9);
        // Three standard deviations apart.
        let apart = 3.0 * 1.5e-3 * 2.0_f64.sqrt();
        assert!((log_odds(apart, 1.5e-3) - (1e3_f64.ln() - 4.5)).abs() < 1e-5);
        assert!(log_odds(1.0, 1.5e-3) < -1e4);
        // Values that the data do not see say nothing.
        assert!(log_odds(0.0, 1.5).abs() < 1e-9);
    }

    #[test]
    fn verify_a_lead_and_a_lag_do_not_agree() {
        let found = posterior(0.0, 1e-3).compare((0, 0), (1, 0), &delays([1e-3, -1e-3]));
        assert!(found.is_none());
    }
}
