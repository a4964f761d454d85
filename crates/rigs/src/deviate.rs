//! Nominal values that are a little off, or far off.

use crate::effect::Effect;
use crate::plant::{Place, Plant};
use crate::rng::Rng;

/// Relative deviation of true from nominal values.
pub(crate) const SPREAD: f64 = 0.02;
/// The same of a machine that is known less well than its model file says.
pub(crate) const WIDE: f64 = 0.05;

/// Multiplies a nominal value by the factor of an error.
pub(crate) fn apply(plant: &mut Plant, e: &Effect) {
    let factor = |name| e.get(name);
    match (e.kind, e.at) {
        ("mass_error", Place::Mass(i)) => plant.masses[i] *= factor("mass_factor"),
        ("stiffness_error", Place::Between(a, b)) => {
            let members = plant.springs.iter_mut();
            let at = members.filter(|m| crate::plant::joins(m, a, b));
            at.for_each(|m| m.value *= factor("stiffness_factor"));
        }
        ("damping_error", Place::Between(a, b)) => {
            let members = plant.dampers.iter_mut();
            let at = members.filter(|m| crate::plant::joins(m, a, b));
            at.for_each(|m| m.value *= factor("damping_factor"));
        }
        _ => {}
    }
}

/// The parameter of an error.
pub(crate) fn parameter(kind: &str) -> &'static str {
    match kind {
        "mass_error" => "mass_factor",
        "stiffness_error" => "stiffness_factor",
        "damping_error" => "damping_factor",
        _ => "gain_factor",
    }
}

/// An error of a nominal parameter.
pub(crate) fn error(kind: &'static str, at: Place, factor: f64) -> Effect {
    Effect {
        kind,
        at,
        values: vec![(parameter(kind), factor)],
        phases: vec![],
    }
}

/// The true plant: every mass, spring and damper a little off in most cases.
pub(crate) fn deviated(nominal: &Plant, spread: f64, rng: &mut Rng) -> (Plant, Vec<Effect>) {
    let mut plant = nominal.clone();
    let mut errors = Vec::new();
    if rng.chance(0.2) {
        return (plant, errors);
    }
    for kind in ["mass_error", "stiffness_error", "damping_error"] {
        for at in crate::kinds::sites(nominal, kind) {
            let factor = 1.0 + spread * rng.normal().clamp(-3.0, 3.0);
            errors.push(error(kind, at, factor));
        }
    }
    errors.iter().for_each(|e| apply(&mut plant, e));
    for (_, value) in &mut plant.pendulum {
        *value *= 1.0 + spread * rng.normal().clamp(-3.0, 3.0);
    }
    (plant, errors)
}
