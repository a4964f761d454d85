//! Sets with other nominal parameters wrong than those of a fit, by the quadratic of that fit: Bayesian model reduction.
//!
//! About its estimate a fit tells −ln L(x) = M + gᵀx + ½ xᵀHx whatever the prior ([`crate::marginal_likelihood`]). Where a nominal
//! parameter gets another prior, that of a wrong one or that of what the model states, ln Z is the integral there with that prior, and
//! the posterior is largest at
//!
//! ```text
//! x = A⁻¹ b                                                                    (1)
//! ```
//!
//! One that returns to what the model states takes the others along. Data often see a combination of parameters alone: a frequency, k/m,
//! however large both are, and without that move a fit begins in another valley of the objective. A combination that is a product of
//! powers is straight in the logarithms of its factors, in which values move, so that (1) holds however far. Nor does a parameter
//! return further than the data let it: friction that sticks makes many small valleys, and a fit that begins beyond them stays
//! there.
//!
//! Reference: \[Friston2011\].

use simgap_effects::{LocalPrior, Placed, SiteScale};
use simgap_estimate::{Coordinate, Fit, Owner, Start};
use simgap_model::Location;

use crate::candidate_model::{NominalPrior, add, is_nominal};
use crate::marginal_likelihood::{Term, integral, term};
use crate::search::Search;

/// Standard deviation of a nominal parameter that is held at its value.
const HELD: f64 = 1e-6;

/// A set of which some nominal parameters are wrong, and the others as the model states.
pub(crate) struct Reduced {
    /// ln Z, by the quadratic.
    pub(crate) log_marginal_likelihood: f64,
    /// The set, its values where the posterior is largest.
    pub(crate) start: Start,
}

impl Search<'_> {
    /// The set of a fit with these nominal parameters wrong and the others as the model states; nothing where the quadratic does not
    /// tell.
    pub(crate) fn reduced(&self, fit: &Fit, is_wrong: impl Fn(&Placed) -> bool) -> Option<Reduced> {
        let scale_at = |at: &Location| self.space.scale_at(at);
        match self.nominal {
            NominalPrior::Wrong => {
                let stated_std = |placed: &Placed| self.problem.stated_std(placed);
                reduced(fit, scale_at, is_wrong, stated_std)
            }
            NominalPrior::Stated(_) => {
                let mut held = reduced(fit, scale_at, is_wrong, |_| HELD)?;
                held.start.nominal.clear();
                Some(held)
            }
        }
    }
}

fn reduced(
    fit: &Fit,
    scale_at: impl Fn(&Location) -> Option<SiteScale>,
    is_wrong: impl Fn(&Placed) -> bool,
    stated_std: impl Fn(&Placed) -> f64,
) -> Option<Reduced> {
    let prior = |coordinate: &Coordinate, placed: &Placed, k: usize| -> Option<LocalPrior> {
        if !is_wrong(placed) {
            return stated(coordinate.value, stated_std(placed));
        }
        let prior = placed.effect.prior(k, &scale_at(&placed.at)?);
        Some(prior.local(coordinate.value, placed.effect.parameters().get(k)?))
    };
    let of_coordinate = |(index, coordinate): (usize, &Coordinate)| -> Option<Term> {
        let effects = &fit.estimate.effects;
        let own = term(index, coordinate, effects, &scale_at, NominalPrior::Wrong)?;
        let Some((placed, k)) = nominal_of(&fit.estimate, coordinate.owner) else {
            return Some(own);
        };
        let prior = prior(coordinate, placed, k)?;
        let factor = prior.slope / coordinate.scale;
        Some(Term {
            index,
            factor,
            // Along the value, as the curvature is.
            apart: coordinate.value.signum() * (prior.mean - prior.coordinate),
            std: prior.std,
            log_weight: prior.log_weight,
            pull: own.pull * (factor / own.factor) * (prior.std / own.std),
        })
    };
    let coordinates = fit.curvature.coordinates.iter().enumerate();
    let used = coordinates.filter(|(_, coordinate)| !coordinate.is_held);
    let terms: Vec<Term> = used.map(of_coordinate).collect::<Option<_>>()?;
    let integral = integral(fit, &terms)?;
    let mut moved = fit.estimate.clone();
    let mut of_states = vec![];
    let mut steps = terms.iter().zip(&integral.mode).peekable();
    for (index, coordinate) in fit.curvature.coordinates.iter().enumerate() {
        let step = steps.next_if(|(term, _)| term.index == index);
        let [slope, x] = step.map_or([0.0; 2], |(term, x)| [term.factor * coordinate.scale, *x]);
        match coordinate.owner {
            Owner::State => of_states.push(x * slope),
            _ if x == 0.0 => {}
            _ => move_value(&mut moved, coordinate, slope, x),
        }
    }
    for (state, step) in moved.initial.iter_mut().flatten().zip(of_states) {
        *state += step;
    }
    let (back, kept): (Vec<Placed>, Vec<Placed>) = moved
        .effects
        .into_iter()
        .partition(|placed| is_nominal(placed) && !is_wrong(placed));
    let (wrong, stated): (Vec<Placed>, Vec<Placed>) =
        moved.nominal.into_iter().partition(|p| is_wrong(p));
    let start = Start {
        effects: kept,
        nominal: stated.into_iter().chain(back).collect(),
        initial: moved.initial,
    };
    Some(Reduced {
        log_marginal_likelihood: integral.log,
        start: wrong
            .into_iter()
            .fold(start, |start, placed| add(&start, placed)),
    })
}

/// The prior of a value that the model states to within a standard deviation; none where it has another sign.
fn stated(value: f64, std: f64) -> Option<LocalPrior> {
    let (coordinate, slope) = match value {
        v if v > 0.0 => (v.ln(), v),
        0.0 => (-1.0, 1.0),
        _ => return None,
    };
    Some(LocalPrior {
        coordinate,
        slope,
        mean: 0.0,
        std,
        log_weight: 0.0,
    })
}

/// The nominal parameter that a coordinate is a value of, and which of its values.
fn nominal_of(estimate: &Start, owner: Owner) -> Option<(&Placed, usize)> {
    let (placed, k) = match owner {
        Owner::Effect(e, k) => (estimate.effects.get(e)?, k),
        Owner::Nominal(n, k) => (estimate.nominal.get(n)?, k),
        Owner::State => return None,
    };
    is_nominal(placed).then_some((placed, k))
}

/// Moves a value by x, of which a unit is `slope` of it: along the logarithm of its distance from nothing where that is its coordinate,
/// and of a nominal parameter always. Values that records have of their own stay.
fn move_value(start: &mut Start, coordinate: &Coordinate, slope: f64, x: f64) {
    let (placed, k) = match coordinate.owner {
        Owner::Effect(e, k) => (start.effects.get_mut(e), k),
        Owner::Nominal(n, k) => (start.nominal.get_mut(n), k),
        Owner::State => return,
    };
    let Some(placed) = placed else {
        return;
    };
    let Some(parameter) = placed.effect.parameters().get(k) else {
        return;
    };
    let value = coordinate.value;
    let neutral = parameter.neutral.filter(|neutral| neutral.is_finite());
    let mut origins = [0.0, neutral.unwrap_or(0.0)].into_iter();
    let is_logarithm = |origin: &f64| {
        let distance = (value - origin).abs();
        distance > 0.0 && (is_nominal(placed) || (distance / slope - 1.0).abs() < 1e-9)
    };
    let moved = match origins.find(is_logarithm) {
        Some(origin) => origin + (value - origin) * (x * slope / (value - origin)).exp(),
        None => value + x * slope,
    };
    if !parameter.per_record && moved.is_finite() {
        placed.values[k] = moved;
        placed.effect.make_physical(&mut placed.values);
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;
    use simgap_effects::find;
    use simgap_estimate::Curvature;

    use super::*;
    use crate::marginal_likelihood::log_marginal_likelihood;

    fn at() -> Location {
        Location::Mass("m".into())
    }

    fn placed(kind: &str, value: f64) -> Placed {
        Placed::new(find(kind).unwrap(), at(), vec![value])
    }

    fn scale_at(_: &Location) -> Option<SiteScale> {
        Some(SiteScale::plain(1.0, 1.0, 1.0))
    }

    /// A fit of a start with this curvature, in logarithms of the values, effects before nominal parameters.
    fn fit(start: Start, misfit: f64, hessian: impl Fn(usize, usize) -> f64) -> Fit {
        let effects = start.effects.iter().enumerate();
        let effects = effects.map(|(e, placed)| (Owner::Effect(e, 0), placed.values[0]));
        let nominal = start.nominal.iter().enumerate();
        let nominal = nominal.map(|(n, placed)| (Owner::Nominal(n, 0), placed.values[0]));
        let coordinates: Vec<Coordinate> = effects
            .chain(nominal)
            .map(|(owner, value)| Coordinate {
                owner,
                value,
                scale: 1.0,
                prior_std: 0.5,
                is_held: false,
            })
            .collect();
        let value = |i: usize| coordinates[i].value;
        let count = coordinates.len();
        let hessian = Mat::from_fn(count, count, |i, j| hessian(i, j) / value(i) / value(j));
        Fit {
            estimate: start,
            objective: 0.0,
            variance: vec![],
            intervals: vec![],
            nominal_intervals: vec![],
            misfit,
            curvature: Curvature {
                hessian,
                coordinates,
            },
            discrepancy: vec![],
            iterations: 0,
            is_finished: true,
        }
    }

    /// Data that see m/k and c/k alone, as of a free decay, from an estimate with all three off: with the stiffness as the
    /// model states, the mass is m/k times that.
    #[test]
    fn verify_a_ratio_is_kept_however_far_a_parameter_returns() {
        let start = Start {
            effects: vec![],
            nominal: vec![
                placed("mass_error", 1.7),
                placed("stiffness_error", 0.8),
                placed("damping_error", 0.81),
            ],
            initial: vec![],
        };
        let rows = [[1.0, -1.0, 0.0], [0.0, -1.0, 1.0]];
        let fit = fit(start, 0.0, |i, j| {
            rows.iter().map(|row| 1e6 * row[i] * row[j]).sum()
        });
        let is_wrong = |placed: &Placed| placed.effect.kind() != "stiffness_error";
        let start = reduced(&fit, scale_at, is_wrong, |_| 1e-5).unwrap().start;
        let found = |kind: &str| {
            let found = start.placed().find(|p| p.effect.kind() == kind);
            found.unwrap().values[0]
        };
        assert!((found("stiffness_error") - 1.0).abs() < 1e-4);
        let ratio = found("mass_error") / (1.7 / 0.8);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        let ratio = found("damping_error") / (0.81 / 0.8);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        assert_eq!((start.effects.len(), start.nominal.len()), (2, 1));
    }

    /// Where the data curve the log-likelihood evenly, a fit made under the other prior says the same.
    #[test]
    fn verify_the_marginal_likelihood_is_that_of_a_fit_under_the_other_prior() {
        let (curvature, estimate, least) = (30.0, 1.5_f64, -40.0);
        let alone = |value: f64| Start {
            effects: vec![placed("mass_error", value)],
            nominal: vec![],
            initial: vec![],
        };
        // The log-likelihood is largest where the prior of the first fit, about one in the value, is balanced.
        let pull = estimate * (estimate - 1.0) / 0.5_f64.powi(2);
        let largest = estimate.ln() + pull / curvature;
        let misfit = |u: f64| least + 0.5 * curvature * (u - largest).powi(2);
        let narrow = Start {
            effects: vec![],
            nominal: vec![placed("mass_error", estimate)],
            initial: vec![],
        };
        let narrow = fit(narrow, misfit(estimate.ln()), |_, _| curvature);
        let found = reduced(&narrow, scale_at, |_| true, |_| 0.02).unwrap();
        let std = std::f64::consts::LN_2;
        let u = largest * curvature / (curvature + std.powi(-2));
        assert!((found.start.effects[0].values[0] - u.exp()).abs() < 1e-12);
        let again = fit(alone(u.exp()), misfit(u), |_, _| curvature);
        let needed = log_marginal_likelihood(&again, scale_at, NominalPrior::Wrong);
        let found = found.log_marginal_likelihood;
        assert!((found - needed).abs() < 1e-9, "{found} for {needed}");
    }

    #[test]
    fn a_parameter_of_another_sign_is_none_that_the_model_states() {
        let start = Start {
            effects: vec![placed("input_gain", -1.0)],
            nominal: vec![],
            initial: vec![],
        };
        let fit = fit(start, 0.0, |_, _| 1.0);
        assert!(reduced(&fit, scale_at, |_| false, |_| 0.02).is_none());
        assert!(reduced(&fit, scale_at, |_| true, |_| 0.02).is_some());
    }
}
