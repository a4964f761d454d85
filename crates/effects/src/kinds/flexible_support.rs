//! What the model takes for the ground gives way.

use std::f64::consts::TAU;

use simgap_model::{Damper, GROUND, Location, Mass, Model, OutputKind, Spring, same_pair};

use super::attached_mode::{
    Hidden, RINGS, dies_away, octaves, of_pairs_of_lines, rings_on, unused_name,
};
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// What the model takes for the ground gives way: the springs and dampers between a mass and the
/// ground stand on a support with a mass, a stiffness and a damping of its own.
///
/// ```text
/// mₛ s̈ + cₛ ṡ + kₛ s = k (x − s) + c (ẋ − ṡ)          (1)
/// cₛ = 2 ζ √(kₛ mₛ)                                   (2)
/// ```
///
/// k and c are the members of the model at the place; the forces of effects at the place, and a force that is
/// measured there, go with them. A force that drives the mass acts against the ground, not against the support.
///
/// Reference: `park-mold`, equation (4), for a mold on its support.
pub(crate) struct FlexibleSupport;

/// Name of the mass of the support.
const NAME: &str = "(support)";
/// Stiffnesses over that of the spring on it that a support is looked for with.
const STIFFER: [f64; 2] = [3.0, 15.0];

/// A support of a stiffness whose own mode, with the spring on it, is at a frequency.
fn with_mode_at(freq: f64, scale: &SiteScale, stiffness: f64, damping_ratio: f64) -> Vec<f64> {
    let mass = (stiffness + scale.stiffness_n_per_m) / (TAU * freq).powi(2);
    vec![stiffness, mass, damping_ratio, 0.0, 0.0]
}

fn stand(model: &mut Model, at: &Location, [mass, stiffness, damping_ratio]: [f64; 3]) {
    let Location::Between(pair) = at else {
        return;
    };
    if !stiffness.is_finite() || mass <= 0.0 || !pair.iter().any(|node| node == GROUND) {
        return;
    }
    let name = unused_name(model, NAME);
    let reroute = |between: &mut [String; 2]| {
        if same_pair(between, pair) {
            for node in between.iter_mut().filter(|node| *node == GROUND) {
                *node = name.clone();
            }
        }
    };
    model
        .springs
        .iter_mut()
        .for_each(|s| reroute(&mut s.between));
    model
        .dampers
        .iter_mut()
        .for_each(|d| reroute(&mut d.between));
    // What they carry is still measured in them.
    let forces = model
        .outputs
        .iter_mut()
        .filter(|o| o.kind == OutputKind::Force);
    forces.filter_map(|o| o.between.as_mut()).for_each(reroute);
    let between = [name.clone(), GROUND.to_string()];
    model.masses.push(Mass {
        name: name.clone(),
        value: mass,
        uncertainty: None,
    });
    model.springs.push(Spring {
        name: name.clone(),
        between: between.clone(),
        stiffness,
        uncertainty: None,
    });
    // (2)
    model.dampers.push(Damper {
        name,
        between,
        damping: 2.0 * damping_ratio * (stiffness * mass).sqrt(),
        uncertainty: None,
    });
}

impl Effect for FlexibleSupport {
    fn kind(&self) -> &'static str {
        "flexible_support"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::GroundSpring
    }

    fn summary(&self) -> &'static str {
        "what the model takes for the ground gives way"
    }

    fn equation(&self) -> &'static str {
        "m_s s'' + c_s s' + k_s s = k (x - s) + c (x' - s'), c_s = 2 zeta sqrt(k_s m_s)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[park-mold], equation (4), for a mold on its support")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::limit("support_stiffness_n_per_m", "N/m"),
                Parameter::shape("support_mass_kg", "kg", 0.0, f64::INFINITY),
                Parameter::shape("support_damping_ratio", "1", 1e-4, 2.0),
                Parameter::size(
                    "start_displacement_m",
                    "m",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                )
                .of_record(),
                Parameter::size(
                    "start_velocity_m_per_s",
                    "m/s",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                )
                .of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mut starts = vec![];
        for stiffer in STIFFER {
            let stiffness = stiffer * scale.stiffness_n_per_m;
            for heavier in [0.1, 1.0] {
                starts.push(vec![stiffness, heavier * scale.mass_kg, 0.05, 0.0, 0.0]);
            }
            // A support whose own mode is at a line that the model leaves.
            for freq in scale.lines_hz.into_iter().take(2).filter(|f| *f > 0.0) {
                // It dies away at once, or rings on.
                for ratio in [0.05, rings_on(scale, freq)] {
                    starts.push(with_mode_at(freq, scale, stiffness, ratio));
                }
            }
        }
        for Hidden { own, coupling } in of_pairs_of_lines(scale) {
            let mass = scale.stiffness_n_per_m / (TAU * TAU * coupling);
            let stiffness = mass * TAU * TAU * own;
            starts.push(vec![stiffness, mass, rings_on(scale, own.sqrt()), 0.0, 0.0]);
        }
        starts
    }

    /// One of thousands of tons that nothing damps does not give way: it is a tone, carried by its start. One that does not ring is a damper
    /// in a row with the spring, and no mode.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        dies_away(values[2] * (values[0] / values[1]).sqrt(), scale) && values[2] < RINGS
    }

    fn turns_into(&self) -> &'static [&'static str] {
        &["stiffness_error", "damping_error"]
    }

    fn resembles(&self) -> &'static [&'static str] {
        &["attached_mode", "harmonic_force"]
    }

    /// A massless support of stiffness k q/(1 − q) behind a spring and a damper is a factor q on the
    /// spring and, well below where the damper is stiffer than the spring, q² on the damper. A hidden mass of
    /// stiffness kₐ < k on the host is a support and a stiffer spring: kₛ = k² / kₐ − k, mₛ = (k + kₛ) / ω². A force at one
    /// frequency is a support that rings on ([`rings_on`]).
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        if kind == "attached_mode" {
            let (own, omega) = (scale.stiffness_n_per_m, TAU * values[1]);
            let both = own * own / (values[0] * omega * omega);
            let stiffness = both - own;
            if !(stiffness > 0.0 && both.is_finite()) {
                return vec![];
            }
            let damping_ratio = values[2] * (both / stiffness).sqrt();
            return vec![vec![
                stiffness,
                both / (omega * omega),
                damping_ratio,
                0.0,
                0.0,
            ]];
        }
        if kind == "harmonic_force" {
            let (freq, ratio) = (values[1], rings_on(scale, values[1]));
            let stiffnesses = STIFFER.map(|stiffer| stiffer * scale.stiffness_n_per_m);
            let support = |stiffness: f64| with_mode_at(freq, scale, stiffness, ratio);
            return stiffnesses.map(support).into();
        }
        let factor = match kind {
            "damping_error" => values[0].sqrt(),
            _ => values[0],
        };
        if !(factor > 0.0 && factor < 1.0) {
            return vec![];
        }
        let own = scale.stiffness_n_per_m;
        let stiffness = own * factor / (1.0 - factor);
        let mass = |freq: f64| (own + stiffness) / (TAU * freq).powi(2);
        octaves(scale)
            .flat_map(|freq| [0.05, 0.2].map(|ratio| vec![stiffness, mass(freq), ratio, 0.0, 0.0]))
            .collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        let own = [values[1], values[0], values[2]];
        Action::Mode {
            change: Box::new(move |model, at| stand(model, at, own)),
            start: [values[3], values[4]],
        }
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "stiffness_error",
                "well below the mode of the support it is a softer spring",
            ),
            (
                "damping_error",
                "well below the mode of the support it takes more off the damping than off the stiffness",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "an accelerometer on the support, with excitation up to its natural frequency"
    }
}
