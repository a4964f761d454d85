//! Nominal parameters that return to their nominal values, and what the others do then.
//!
//! Data often see a combination of parameters alone: a frequency, k/m, however large both are. Where one of them
//! returns to its nominal value the others have to move along, or the fit begins in another valley of the objective. About an
//! estimate, with curvature H in coordinates u (logarithms of positive parameters),
//!
//! ```text
//! x_F = −H_FF⁻¹ H_FR x_R                                                       (1)
//! ```
//!
//! is the move of the free coordinates F that goes best with the move x_R of those that return. A combination that is a
//! product of powers is straight in u, so that (1) holds however far x_R is.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::Placed;
use simgap_estimate::{Coordinate, Fit, Owner, Start};

use crate::candidate_model::is_nominal;
use crate::marginal_likelihood::STATE_STD;

/// The estimate of a fit with some nominal parameters at their nominal values and the others where they go best with that.
pub(crate) fn compensated(fit: &Fit, returns: impl Fn(&Placed) -> bool) -> Start {
    let mut start = fit.estimate.clone();
    let of = |c: &Coordinate| parameter(&fit.estimate, c.owner);
    let is_back = |c: &Coordinate| of(c).is_some_and(&returns);
    let used = fit.curvature.coordinates.iter().enumerate();
    let used: Vec<(usize, &Coordinate)> = used.filter(|(_, c)| !c.is_held).collect();
    let (back, free): (Vec<_>, Vec<_>) = used.into_iter().partition(|(_, c)| is_back(c));
    let is_log = |c: &Coordinate| c.value > 0.0 && of(c).is_some();
    // One unit of u in units of the scale.
    let unit = |c: &Coordinate| match is_log(c) {
        true => c.value / c.scale,
        false => 1.0,
    };
    let moved = |c: &Coordinate| match is_log(c) {
        true => -c.value.ln(),
        false => (1.0 - c.value) / c.scale,
    };
    let hessian = &fit.curvature.hessian;
    let matrix = Mat::from_fn(free.len(), free.len(), |i, j| {
        let ((at, one), (beside, other)) = (free[i], free[j]);
        let of_data = hessian[(at, beside)] * unit(one) * unit(other);
        let of_prior = match one.prior_std.is_finite() {
            true => (unit(one) * one.scale / one.prior_std).powi(2),
            // Of a coordinate without a prior the data may tell nothing.
            false => STATE_STD.powi(-2),
        };
        of_data + if i == j { of_prior } else { 0.0 }
    });
    let right = Mat::from_fn(free.len(), 1, |i, _| {
        let (at, one) = free[i];
        let terms = back.iter();
        -terms
            .map(|&(beside, c)| hessian[(at, beside)] * unit(one) * unit(c) * moved(c))
            .sum::<f64>()
    });
    if let Ok(factors) = matrix.llt(Side::Lower) {
        let step = factors.solve(&right);
        for (i, (_, coordinate)) in free.iter().enumerate() {
            let value = match is_log(coordinate) {
                true => coordinate.value * step[(i, 0)].exp(),
                false => coordinate.value + step[(i, 0)] * coordinate.scale,
            };
            set(&mut start, coordinate.owner, value);
        }
    }
    for (_, coordinate) in &back {
        set(&mut start, coordinate.owner, 1.0);
    }
    start
}

/// The nominal parameter that a coordinate is a value of.
fn parameter(start: &Start, owner: Owner) -> Option<&Placed> {
    let placed = match owner {
        Owner::Effect(effect, _) => start.effects.get(effect),
        Owner::Nominal(nominal, _) => start.nominal.get(nominal),
        Owner::State => None,
    };
    placed.filter(|placed| is_nominal(placed))
}

/// Gives a nominal parameter a value; others stay.
fn set(start: &mut Start, owner: Owner, value: f64) {
    let (placed, k) = match owner {
        Owner::Effect(effect, k) => (start.effects.get_mut(effect), k),
        Owner::Nominal(nominal, k) => (start.nominal.get_mut(nominal), k),
        Owner::State => return,
    };
    let placed = placed.filter(|placed| is_nominal(placed) && value.is_finite());
    if let Some(own) = placed.and_then(|placed| placed.values.get_mut(k)) {
        *own = value;
    }
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;
    use simgap_estimate::Curvature;
    use simgap_model::Location;

    use super::*;

    /// Data that see m/k and c/k alone, as of a free decay, from an estimate with all three off: with the stiffness and the
    /// damping back at their nominal values the mass is k₀ m/k.
    #[test]
    fn verify_a_ratio_is_kept_however_far_a_parameter_returns() {
        let at = Location::Mass("m".into());
        let kinds = ["mass_error", "stiffness_error", "damping_error"];
        let values = [1.7, 0.8, 0.81];
        let nominal = kinds.iter().zip(values);
        let nominal: Vec<Placed> = nominal
            .map(|(kind, value)| Placed::new(find(kind).unwrap(), at.clone(), vec![value]))
            .collect();
        let coordinate = |k: usize| Coordinate {
            owner: Owner::Nominal(k, 0),
            value: values[k],
            scale: 1.0,
            prior_std: 0.5,
            is_held: false,
        };
        // Rows of d ln(m/k) and d ln(c/k), of the values.
        let rows = [[1.0 / 1.7, -1.0 / 0.8, 0.0], [0.0, -1.0 / 0.8, 1.0 / 0.81]];
        let fit = Fit {
            estimate: Start {
                effects: vec![],
                nominal,
                initial: vec![],
            },
            objective: 0.0,
            variance: vec![],
            intervals: vec![],
            nominal_intervals: vec![],
            misfit: 0.0,
            curvature: Curvature {
                hessian: Mat::from_fn(3, 3, |i, j| {
                    rows.iter().map(|row| 1e6 * row[i] * row[j]).sum()
                }),
                coordinates: (0..3).map(coordinate).collect(),
            },
            discrepancy: vec![],
            iterations: 0,
        };
        let start = compensated(&fit, |placed| placed.effect.kind() == "stiffness_error");
        let found = |k: usize| start.nominal[k].values[0];
        assert_eq!(found(1), 1.0);
        assert!((found(0) / (1.7 / 0.8) - 1.0).abs() < 1e-4, "{}", found(0));
        assert!((found(2) / (0.81 / 0.8) - 1.0).abs() < 1e-4, "{}", found(2));
    }
}
