//! The hydraulic drive whose signatures are drawn: a table on a cylinder with a valve under position control.

use std::f64::consts::TAU;

use simgap_effects::Placed;
use simgap_model::{Model, ModelError};
use simgap_simulate::{Mended, Run, SimulateError, Simulator};

use super::machine::{Stage, times};

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

/// Substeps: enough for the resonance of the oil.
const SUBSTEPS: usize = 16;

pub(super) fn model() -> Result<Model, ModelError> {
    Model::from_toml(DRIVE)
}

/// Displacement of the table while it follows two sines, m, with effects.
pub(super) fn follows(stage: &Stage, effects: &[Placed]) -> Result<Vec<f64>, SimulateError> {
    let time = times();
    let wave = |t: &f64| 0.008 * (1.0 - (TAU * t).cos()) + 0.002 * (TAU * 2.3 * t).sin();
    let run = Run {
        name: "two sines".into(),
        start_s: 0.0,
        time_step_s: time[1] - time[0],
        len: time.len(),
        first_index: 0,
        mended: Mended::default(),
        inputs: vec![time.iter().map(wave).collect()],
        measured: vec![None],
    };
    let mut outputs = Simulator::new(&stage.model, effects, SUBSTEPS)?.predict(&run, &[])?;
    Ok(outputs.swap_remove(0))
}
