//! The motion of the hydraulic drive whose signatures are drawn.

use std::f64::consts::TAU;

use simgap_effects::Placed;
use simgap_simulate::{Mended, Run, SimulateError, Simulator};

use super::machine::{Stage, times};

/// Substeps: enough for the resonance of the oil.
const SUBSTEPS: usize = 16;

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
