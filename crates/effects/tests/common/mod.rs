//! A model with a site for every kind, and the actions taken apart.
#![allow(dead_code)]

use simgap_effects::{Action, Effect, Sampled, SignalMap, SiteScale, find};
use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_model::{Location, Model};

/// `carriage` has a spring but no damper to the ground, `load` a damper but no spring, and both
/// lie between the two: so each kind of site is there once at least.
pub(crate) const MODEL: &str = r#"
schema = "simgap-model/1"
name = "two masses"

[[mass]]
name = "carriage"
value = 3.0

[[mass]]
name = "load"
value = 2.0

[[spring]]
name = "drive"
between = ["carriage", "ground"]
stiffness = 4000.0

[[spring]]
name = "coupling"
between = ["carriage", "load"]
stiffness = 9000.0

[[damper]]
name = "coupling"
between = ["load", "carriage"]
damping = 20.0

[[damper]]
name = "rail"
between = ["load", "ground"]
damping = 7.0

[[load]]
at = "load"
value = -19.6

[[pendulum]]
at = "carriage"
value = 1.5

[[input]]
channel = "u"
kind = "force"
at = "carriage"

[[output]]
channel = "y"
kind = "displacement"
at = "load"
"#;

/// The model of [`MODEL`].
pub(crate) fn model() -> Model {
    Model::from_toml(MODEL).unwrap()
}

/// A cylinder and a valve beside it.
const DRIVE: &str = r#"
[[cylinder]]
name = "drive"
between = ["carriage", "ground"]
areas = [1e-3, 8e-4]
dead_volumes = [1e-4, 1e-4]
stroke = 0.1
bulk_modulus = 1.4e9
pressures = [4e6, 5e6]

[[valve]]
name = "servo"
cylinder = "drive"
rated_flow = 1e-3
rated_drop = 3.5e6
natural_freq = 80.0
damping_ratio = 0.7
supply = 1e7
"#;

/// The model of [`MODEL`], with a hydraulic drive where the place is on one.
pub(crate) fn model_at(at: &Location) -> Model {
    let plain = model();
    if plain.check_location(at, "").is_ok() {
        return plain;
    }
    match at {
        Location::Parameter(_) => simulator(),
        _ => hydraulic(),
    }
}

/// The model of [`MODEL`] with a hydraulic drive.
pub(crate) fn hydraulic() -> Model {
    Model::from_toml(&format!("{MODEL}{DRIVE}")).unwrap()
}

/// A simulator with one parameter.
pub(crate) fn simulator() -> Model {
    let text = "schema = \"simgap-model/1\"\nname = \"arm\"\n\
        [[parameter]]\nname = \"inertia\"\nvalue = 1.2\n\
        [[port]]\nname = \"joint\"\ndisplacement = \"q\"\nvelocity = \"qd\"\n\
        [[output]]\nchannel = \"q\"\nkind = \"signal\"\n";
    Model::from_toml(text).unwrap()
}

/// Typical sizes, each different from the others so that no two can be mistaken.
pub(crate) fn scale() -> SiteScale {
    SiteScale {
        signal: 0.7,
        time_step_s: 0.001,
        duration_s: 20.0,
        displacement_range_m: [-0.004, 0.005],
        travel_m: 0.009,
        signal_range: [-1.1, 1.3],
        signal_step: 0.01,
        stiffness_n_per_m: 9000.0,
        mass_kg: 2.0,
        lines_hz: [3.1, 12.7, 0.0, 0.0],
        motion_hz: [2.3, 0.0, 0.0, 0.0],
        ..SiteScale::plain(0.002, 0.03, 50.0)
    }
}

/// An effect that must be in the catalogue.
pub(crate) fn effect(kind: &str) -> &'static dyn Effect {
    find(kind).unwrap_or_else(|| panic!("{kind} is not in the catalogue"))
}

/// The force law of an effect.
pub(crate) fn law(kind: &str, values: &[f64]) -> Box<dyn ForceLaw> {
    match effect(kind).action(values) {
        Action::Force(law) => law,
        _ => panic!("{kind} is no force law"),
    }
}

/// The signal map of an effect.
pub(crate) fn map(kind: &str, values: &[f64]) -> Box<dyn SignalMap> {
    match effect(kind).action(values) {
        Action::Input(map) | Action::Output(map) | Action::Sampling(map) => map,
        _ => panic!("{kind} is no signal map"),
    }
}

/// The force of a law at a motion.
pub(crate) fn force(law: &dyn ForceLaw, displacement: f64, velocity: f64) -> f64 {
    law.force(MemberMotion {
        displacement,
        velocity,
        time_s: 0.013,
        step_s: 0.0,
    })
}

/// A signal sent through a map.
pub(crate) fn through(map: &dyn SignalMap, values: &[f64], time_step_s: f64) -> Vec<f64> {
    map.apply(Sampled::from_start(values, time_step_s))
}
