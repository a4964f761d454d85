//! The hydraulic drive whose signatures are drawn: a table on a cylinder with a valve under position control.

use simgap_model::{Model, ModelError};

const DRIVE: &str = r#"
schema = "simgap-model/1"
name = "drive"
[[mass]]
name = "table"
value = 100.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 400.0
[[cylinder]]
name = "drive"
between = ["table", "ground"]
areas = [5e-4, 5e-4]
dead_volumes = [5e-5, 5e-5]
stroke = 0.1
bulk_modulus = 1.4e9
leakage = 1e-12
pressures = [5e6, 5e6]
[[valve]]
name = "servo"
cylinder = "drive"
from = "controller"
rated_flow = 1e-4
rated_drop = 3.5e6
natural_freq = 60.0
damping_ratio = 0.8
supply = 1e7
[[block]]
name = "controller"
numerator = [40.0]
denominator = [1.0]
minus = ["table"]
[[input]]
channel = "r"
kind = "set_point"
at = "controller"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

pub(super) fn model() -> Result<Model, ModelError> {
    Model::from_toml(DRIVE)
}
