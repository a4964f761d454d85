//! Initial states: a first guess, their typical sizes and their prior.

use simgap_effects::Placed;
use simgap_model::{Form, Node, OutputKind};

use crate::{EstimateError, Problem};

impl Problem {
    /// First guess of the initial state of each run, from the measured displacements and
    /// velocities of the masses where there are any, zero elsewhere.
    #[must_use]
    pub fn initial_guess(&self) -> Vec<Vec<f64>> {
        let n = self.model.dof_count();
        self.runs
            .iter()
            .map(|run| {
                let mut state = vec![0.0; 2 * n];
                for (output, measured) in self.model.outputs.iter().zip(&run.measured) {
                    let (Ok(reading), Some(values)) = (self.model.reading(output), measured) else {
                        continue;
                    };
                    let [Node::Dof(i), Node::Ground] = reading.nodes else {
                        continue;
                    };
                    let first = values.first().copied().unwrap_or(0.0);
                    let first = first / self.gain_of(&output.channel);
                    match reading.form {
                        Form::Displacement => state[i] = first,
                        Form::Velocity => state[n + i] = first,
                        Form::Rate { scale, offset } => state[n + i] = (first - offset) / scale,
                        Form::Acceleration
                        | Form::Members { .. }
                        | Form::Orifice { .. }
                        | Form::Signal => {}
                    }
                }
                state
            })
            .collect()
    }

    /// How far the prior of an initial state reaches: a record begins somewhere within the motion, as far as the model with these nominal parameters
    /// and initial states predicts it, or a typical size where that does not move.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn state_std_of(
        &self,
        nominal: &[Placed],
        initial: &[Vec<f64>],
    ) -> Result<Vec<f64>, EstimateError> {
        let mut std = state_scale(self);
        for (r, (run, state)) in self.runs.iter().zip(initial).enumerate() {
            let simulator = self.simulator(nominal, r)?;
            let largest = simulator.largest_state(run, state)?;
            for (std, largest) in std.iter_mut().zip(largest) {
                if largest.is_finite() {
                    *std = std.max(largest);
                }
            }
        }
        Ok(std)
    }
}

/// Typical size of each entry of an initial state: what the outputs allow to guess, one elsewhere.
pub(crate) fn state_scale(problem: &Problem) -> Vec<f64> {
    let n = problem.model.dof_count();
    let std = problem.motion_std();
    let mut displacement = 0.0_f64;
    for (output, std) in problem.model.outputs.iter().zip(&std) {
        if output.kind == OutputKind::Displacement {
            displacement = displacement.max(*std);
        }
    }
    let step = problem.runs.first().map_or(1.0, |run| run.time_step_s);
    let size = if displacement > 0.0 {
        displacement
    } else {
        1e-3
    };
    let velocity = size / (100.0 * step);
    // Coordinates that are no places are scaled to about one.
    let own = problem.model.masses.iter();
    let is_scaled: Vec<bool> = own.map(|m| problem.model.has_own_scale(&m.name)).collect();
    let scale = |i: usize| match i {
        i if is_scaled[i % n] => 1.0,
        i if i < n => size,
        _ => velocity,
    };
    (0..2 * n).map(scale).collect()
}
