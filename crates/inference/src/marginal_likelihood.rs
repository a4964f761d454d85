//! The log marginal likelihood of a set of effects.
//!
//! About the estimate θ̂ of a fit the log-likelihood is quadratic, the prior of every parameter normal in a coordinate u
//! of its own ([`simgap_effects::Prior`]). With x = u − û,
//!
//! ```text
//! −ln L(x) = M + gᵀx + ½ xᵀ H x                                                    (1)
//! ln Z = ln w − M − ½ dᵀS⁻¹d + ½ bᵀA⁻¹b − ½ ln det(S A)                            (2)
//! A = H + S⁻¹,   d = m − û,   b = S⁻¹ d − g
//! ```
//!
//! (2) is the integral of (1) over the prior N(m, S), with the weight w. M and H are those of the fit
//! ([`simgap_estimate::Fit::misfit`], [`simgap_estimate::Curvature`]); g balances the
//! prior, under which the fit was made. A direction that the data do not see has H = 0 and costs nothing but the distance of its
//! estimate from the mean of the prior; one that they see costs ½ ln(S H). Initial states have the same prior in all sets, about
//! zero and as wide as the motion goes ([`simgap_estimate::Problem::state_std_of`]): a law that holds in a record only from far
//! outside of its motion has that against it.
//!
//! Reference: \[Kass1995\], section 4.1.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::{LocalPrior, Placed, Prior, SiteScale};
use simgap_estimate::{Coordinate, Fit, Owner};
use simgap_model::Location;

use crate::candidate_model::{NominalPrior, is_nominal};

/// ln Z of (2), with the weights of values taken together ([`simgap_effects::Effect::weight`]); minus infinity where an effect has
/// vanished, since the set is then a smaller one, and where its prior has no support.
pub(crate) fn log_marginal_likelihood(
    fit: &Fit,
    scale_at: impl Fn(&Location) -> Option<SiteScale>,
    nominal: NominalPrior,
) -> f64 {
    let effects = &fit.estimate.effects;
    let is_outside = |placed: &Placed| {
        let scale = scale_at(&placed.at);
        scale.is_some_and(|scale| !placed.effect.has_support(&placed.values, &scale))
    };
    if effects
        .iter()
        .any(|placed| has_vanished(placed) || is_outside(placed))
    {
        return f64::NEG_INFINITY;
    }
    let priors: Option<Vec<Term>> = fit
        .curvature
        .coordinates
        .iter()
        .enumerate()
        .filter(|(_, coordinate)| !coordinate.is_held)
        .map(|(index, coordinate)| term(index, coordinate, effects, &scale_at, nominal))
        .collect();
    let weights = effects.iter().map(|placed| {
        let scale = scale_at(&placed.at);
        scale.map_or(0.0, |scale| {
            placed.effect.weight(&placed.values, &scale).ln()
        })
    });
    let weights: f64 = weights.sum();
    priors
        .and_then(|terms| integral(fit, &terms))
        .map_or(f64::NEG_INFINITY, |integral| integral.log + weights)
}

/// A coordinate that is integrated over.
pub(crate) struct Term {
    /// Its place in the curvature.
    pub(crate) index: usize,
    /// du of one unit of its scale, inverted: H in u is H times this squared.
    pub(crate) factor: f64,
    /// d of (2).
    pub(crate) apart: f64,
    /// Standard deviation s of its prior.
    pub(crate) std: f64,
    /// ln w.
    pub(crate) log_weight: f64,
    /// s g of (1): what balances the prior of the fit.
    pub(crate) pull: f64,
}

/// The term of a coordinate under the prior of the fit.
pub(crate) fn term(
    index: usize,
    coordinate: &Coordinate,
    effects: &[Placed],
    scale_at: &impl Fn(&Location) -> Option<SiteScale>,
    nominal: NominalPrior,
) -> Option<Term> {
    let Coordinate {
        value,
        scale,
        prior_std: std,
        ..
    } = *coordinate;
    // Under the prior of the fit.
    let plain = |apart: f64| Term {
        index,
        factor: 1.0 / scale,
        apart,
        std,
        log_weight: 0.0,
        pull: apart / std,
    };
    match coordinate.owner {
        Owner::State => Some(plain(-value)),
        Owner::Nominal(..) => Some(plain(1.0 - value)),
        Owner::Effect(e, i) => {
            let placed = effects.get(e)?;
            let parameter = placed.effect.parameters().get(i)?;
            let (prior, is_balanced) = match nominal {
                NominalPrior::Stated(std) if is_nominal(placed) => {
                    (Prior::Normal { mean: 1.0, std }, false)
                }
                _ => (placed.effect.prior(i, &scale_at(&placed.at)?), true),
            };
            let local: LocalPrior = prior.local(value, parameter);
            let apart = local.mean - local.coordinate;
            Some(Term {
                index,
                factor: local.slope / scale,
                apart,
                std: local.std,
                log_weight: local.log_weight,
                pull: if is_balanced { apart / local.std } else { 0.0 },
            })
        }
    }
}

/// (2), and where the integrand is largest.
pub(crate) struct Integral {
    /// ln Z.
    pub(crate) log: f64,
    /// x = A⁻¹ b, term by term.
    pub(crate) mode: Vec<f64>,
}

/// (2), with S^½ A S^½ = I + S^½ H S^½ in the place of S A.
pub(crate) fn integral(fit: &Fit, terms: &[Term]) -> Option<Integral> {
    let count = terms.len();
    let hessian = &fit.curvature.hessian;
    let matrix = Mat::from_fn(count, count, |i, j| {
        let (a, b) = (&terms[i], &terms[j]);
        let of_data = hessian[(a.index, b.index)] * a.factor * a.std * b.factor * b.std;
        of_data + f64::from(u8::from(i == j))
    });
    // d in units of the standard deviation; b likewise.
    let apart: Vec<f64> = terms.iter().map(|term| term.apart / term.std).collect();
    let right = Mat::from_fn(count, 1, |i, _| apart[i] - terms[i].pull);
    let factor = matrix.llt(Side::Lower).ok()?;
    let solved = factor.solve(&right);
    let lower = factor.L();
    let log_determinant: f64 = (0..count).map(|i| 2.0 * lower[(i, i)].ln()).sum();
    let regained: f64 = (0..count).map(|i| right[(i, 0)] * solved[(i, 0)]).sum();
    let squared: f64 = apart.iter().map(|d| d * d).sum();
    let log_weight: f64 = terms.iter().map(|term| term.log_weight).sum();
    let log = log_weight - fit.misfit - 0.5 * squared + 0.5 * regained - 0.5 * log_determinant;
    let terms = terms.iter().enumerate();
    let mode = terms.map(|(i, term)| term.std * solved[(i, 0)]).collect();
    log.is_finite().then_some(Integral { log, mode })
}

/// Whether nothing is left of an effect: every size is where it vanishes.
fn has_vanished(placed: &Placed) -> bool {
    let parameters = placed.effect.parameters().iter().zip(&placed.values);
    let mut sizes = parameters
        .filter(|(parameter, _)| !parameter.per_record)
        .filter_map(|(parameter, value)| Some((parameter.neutral?, *value)))
        .peekable();
    sizes.peek().is_some() && sizes.all(|(neutral, value)| value == neutral)
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;
    use simgap_estimate::{Curvature, Start};

    use super::*;

    /// A fit of sensor biases with these estimates and this curvature.
    fn fit(values: &[f64], hessian: Mat<f64>) -> Fit {
        let effect = find("sensor_bias").unwrap();
        let at = Location::Channel("y".into());
        let placed = |value: &f64| Placed::new(effect, at.clone(), vec![*value]);
        let coordinate = |(e, value): (usize, &f64)| Coordinate {
            owner: Owner::Effect(e, 0),
            value: *value,
            scale: 1.0,
            prior_std: f64::INFINITY,
            is_held: false,
        };
        Fit {
            estimate: Start {
                effects: values.iter().map(placed).collect(),
                nominal: vec![],
                initial: vec![],
            },
            objective: 3.0,
            misfit: 3.0,
            variance: vec![],
            intervals: vec![],
            nominal_intervals: vec![],
            curvature: Curvature {
                hessian,
                coordinates: values.iter().enumerate().map(coordinate).collect(),
            },
            discrepancy: vec![],
            iterations: 0,
            is_finished: true,
        }
    }

    fn found(values: &[f64], hessian: Mat<f64>) -> f64 {
        let scale = SiteScale::plain(1.0, 1.0, 1.0);
        log_marginal_likelihood(&fit(values, hessian), |_| Some(scale), NominalPrior::Wrong)
    }

    /// Against the integral over a grid in the coordinates of the priors.
    #[test]
    fn verify_a_normal_integral_in_closed_form() {
        let values = [0.3, 0.8];
        let hessian = faer::mat![[40.0, 25.0], [25.0, 30.0]];
        let parameter = &find("sensor_bias").unwrap().parameters()[0];
        let scale = SiteScale::plain(1.0, 1.0, 1.0);
        let prior = find("sensor_bias").unwrap().prior(0, &scale);
        let local = values.map(|value| prior.local(value, parameter));
        let (steps, reach) = (400, 10.0);
        let mut sum = 0.0;
        for i in 0..steps {
            for j in 0..steps {
                let at =
                    [i, j].map(|k| reach * (2.0 * (f64::from(k) + 0.5) / f64::from(steps) - 1.0));
                let step = [0, 1].map(|k| at[k] * local[k].slope);
                let curved: f64 = [(0, 0), (0, 1), (1, 0), (1, 1)]
                    .iter()
                    .map(|&(a, b)| 0.5 * step[a] * hessian[(a, b)] * step[b])
                    .sum();
                let mut log = -3.0 - curved;
                for k in 0..2 {
                    // The fit balances the prior.
                    log -= (local[k].mean - local[k].coordinate) / local[k].std.powi(2) * at[k];
                    let u = (local[k].coordinate + at[k] - local[k].mean) / local[k].std;
                    log += local[k].log_weight
                        - 0.5 * u * u
                        - (local[k].std * std::f64::consts::TAU.sqrt()).ln();
                }
                sum += log.exp() * (2.0 * reach / f64::from(steps)).powi(2);
            }
        }
        let found = found(&values, hessian);
        assert!(
            (found - sum.ln()).abs() < 1e-3,
            "{found} instead of {}",
            sum.ln()
        );
    }

    #[test]
    fn verify_what_the_data_do_not_see_costs_nothing_but_its_distance() {
        let usual = find("sensor_bias").unwrap();
        let scale = SiteScale::plain(1.0, 1.0, 1.0);
        let Prior::Size { median, .. } = usual.prior(0, &scale) else {
            panic!("a bias has a size");
        };
        let unseen = found(&[median], Mat::zeros(1, 1));
        assert!((unseen - (-3.0 + 0.5_f64.ln())).abs() < 1e-12);
        let seen = found(&[median], Mat::from_fn(1, 1, |_, _| 1e6));
        assert!(seen < unseen - 4.0);
    }

    #[test]
    fn an_effect_that_has_vanished_is_no_set_of_its_own() {
        assert_eq!(found(&[0.0], Mat::zeros(1, 1)), f64::NEG_INFINITY);
    }
}
