//! A hydraulic axis of ten states: two chambers, a spool, a filter of second order on the measured position and a controller of
//! second order; both orifices are solved in every step.

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_simulate::Simulator;

const AXIS: &str = r#"schema = "simgap-model/1"
name = "axis"
[[mass]]
name = "table"
value = 1000.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 20000.0
[[cylinder]]
name = "drive"
between = ["table", "ground"]
areas = [2e-3, 1.5e-3]
dead_volumes = [1e-4, 1e-4]
stroke = 0.2
bulk_modulus = 1.4e9
leakage = 5e-12
pressures = [9e6, 12e6]
[[valve]]
name = "servo"
cylinder = "drive"
from = "controller"
rated_flow = 6.6667e-4
rated_drop = 3.5e6
natural_freq = 25.0
damping_ratio = 0.7
supply = 21e6
[[block]]
name = "filter"
numerator = [1.0]
denominator = [1e-5, 5e-3, 1.0]
plus = ["table"]
[[block]]
name = "controller"
numerator = [8.0, 4.0]
denominator = [0.005, 1.0, 0.0]
minus = ["filter"]
[[input]]
channel = "u"
kind = "set_point"
at = "controller"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

/// Amplitude of the set point, m.
pub(crate) const AMPLITUDE: f64 = 0.002;

/// A set whose bulk modulus is off by 10 % and up to 5 % of that.
pub(crate) fn set(share: f64) -> Simulator {
    let chambers = Location::Between(["drive.p1".into(), "drive.p2".into()]);
    let value = 0.9 * (1.0 + 0.05 * share);
    let air = Placed::new(find("bulk_modulus").unwrap(), chambers, vec![value]);
    Simulator::new(&Model::from_toml(AXIS).unwrap(), &[air], 1).unwrap()
}
