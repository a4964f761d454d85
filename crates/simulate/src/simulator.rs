//! The model with its effects, ready to be marched through runs.

use simgap_effects::{Action, Placed, Sampled, SignalMap};
use simgap_integrate::exact::{Element, ExactPropagator, Excitation, ForceLaw, MemberMotion};
use simgap_model::{InputKind, Location, Model, Node};

use crate::outputs::{BaseMotion, OutputPlan, across, output_plans};
use crate::{Run, SimulateError};

/// A model with its effects.
pub struct Simulator {
    model: Model,
    elements: Vec<Element>,
    input_maps: Vec<(usize, Box<dyn SignalMap>)>,
    output_maps: Vec<(usize, Box<dyn SignalMap>)>,
    outputs: Vec<OutputPlan>,
    loads: Vec<f64>,
    substeps: usize,
}

/// Displacement and velocity across a location, one value a sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MemberPath {
    /// m.
    pub displacement: Vec<f64>,
    /// m/s.
    pub velocity: Vec<f64>,
    /// Acceleration of the two ends' difference, m/s².
    pub acceleration: Vec<f64>,
}

/// Gravity on an arm, F = value sin(angle).
struct Gravity(f64);

impl ForceLaw for Gravity {
    fn force(&self, motion: MemberMotion) -> f64 {
        self.0 * motion.displacement.sin()
    }
}

impl Simulator {
    /// Puts the effects on the nominal model. `substeps` is used where nonlinear forces act
    /// (see [`crate::substeps_for`]); effects written in the model file are not added here.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when an effect's place is not in the model.
    pub fn new(
        nominal: &Model,
        effects: &[Placed],
        substeps: usize,
    ) -> Result<Simulator, SimulateError> {
        let mut model = nominal.clone();
        let mut laws = Vec::new();
        let (mut input_maps, mut output_maps) = (Vec::new(), Vec::new());
        let mut sampling_maps = Vec::new();
        for placed in effects {
            match (placed.action(), &placed.at) {
                (Action::Model(change), at) => change(&mut model, at),
                (Action::Force(law), at) => laws.push((at, law)),
                (Action::Input(map), Location::Input(channel)) => {
                    let of = model.inputs.iter().position(|i| &i.channel == channel);
                    input_maps.extend(of.map(|i| (i, map)));
                }
                (Action::Output(map), Location::Channel(channel)) => {
                    let of = model.outputs.iter().position(|o| &o.channel == channel);
                    output_maps.extend(of.map(|i| (i, map)));
                }
                (Action::Sampling(map), Location::Channel(channel)) => {
                    let of = model.outputs.iter().position(|o| &o.channel == channel);
                    sampling_maps.extend(of.map(|i| (i, map)));
                }
                (Action::Input(_) | Action::Output(_) | Action::Sampling(_), _) => {}
            }
        }
        // What happens while sampling comes after what happens before, however they are listed.
        output_maps.extend(sampling_maps);
        let mut elements = Vec::new();
        // Gravity and forces on a mass push from outside: no member carries them.
        let mut carried = Vec::new();
        for pendulum in &model.pendulums {
            let [a, b] = ends(&model, &Location::Mass(pendulum.at.clone()))?;
            elements.push(Element {
                a,
                b,
                law: Box::new(Gravity(pendulum.value)),
            });
            carried.push(false);
        }
        for (at, law) in laws {
            let [a, b] = ends(&model, at)?;
            elements.push(Element { a, b, law });
            carried.push(matches!(at, Location::Between(_)));
        }
        Ok(Simulator {
            outputs: output_plans(&model, &elements, &carried)?,
            loads: model.load_vector(),
            substeps: if elements.is_empty() {
                1
            } else {
                substeps.max(1)
            },
            model,
            elements,
            input_maps,
            output_maps,
        })
    }

    /// A model file with the effects it lists.
    ///
    /// # Errors
    /// [`SimulateError::Effect`] when an effect of the file cannot be used.
    pub fn of_file(model: &Model, runs: &[Run]) -> Result<Simulator, SimulateError> {
        let effects = model
            .effects
            .iter()
            .map(|entry| Placed::from_entry(model, entry))
            .collect::<Result<Vec<_>, _>>()?;
        Simulator::new(model, &effects, crate::substeps_for(model, runs)?)
    }

    /// Length of the initial state: displacements, then velocities.
    #[must_use]
    pub fn state_len(&self) -> usize {
        2 * self.model.dof_count()
    }

    /// Predicts every output along a run from an initial state (displacements, then velocities;
    /// missing entries are zero). One signal for each output, in model units.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when the model cannot be propagated.
    pub fn predict(&self, run: &Run, initial: &[f64]) -> Result<Vec<Vec<f64>>, SimulateError> {
        let mut predicted: Vec<Vec<f64>> = self
            .outputs
            .iter()
            .map(|_| Vec::with_capacity(run.len))
            .collect();
        let mut acceleration = vec![0.0; self.model.dof_count()];
        let needs_acceleration = self.outputs.iter().any(OutputPlan::needs_acceleration);
        self.march(run, initial, |propagator, at, base| {
            if needs_acceleration {
                propagator.acceleration(at, &mut acceleration);
            }
            for (signal, plan) in predicted.iter_mut().zip(&self.outputs) {
                signal.push(plan.read(at, &acceleration, base));
            }
        })?;
        for (output, map) in &self.output_maps {
            let signal = Sampled {
                values: &predicted[*output],
                time_step_s: run.time_step_s,

                first_index: run.first_index,
            };
            predicted[*output] = map.apply(signal);
        }
        Ok(predicted)
    }

    /// Motion across a location along a run: between its two nodes, or of a mass.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when the place is not in the model.
    pub fn path(
        &self,
        run: &Run,
        initial: &[f64],
        at: &Location,
    ) -> Result<MemberPath, SimulateError> {
        let ends = ends(&self.model, at)?;
        let mut path = MemberPath::default();
        let mut acceleration = vec![0.0; self.model.dof_count()];
        self.march(run, initial, |propagator, at, base| {
            propagator.acceleration(at, &mut acceleration);
            let across = |dofs: &[f64], bases: &[f64]| across(ends, dofs, bases);
            path.displacement
                .push(across(at.displacement, base.displacement));
            path.velocity.push(across(at.velocity, base.velocity));
            path.acceleration
                .push(across(&acceleration, base.acceleration));
        })?;
        Ok(path)
    }

    fn march(
        &self,
        run: &Run,
        initial: &[f64],
        mut observe: impl FnMut(
            &ExactPropagator,
            &simgap_integrate::exact::Snapshot<'_>,
            &BaseMotion<'_>,
        ),
    ) -> Result<(), SimulateError> {
        let n = self.model.dof_count();
        let matrices = self.model.matrices()?;
        let step = run.time_step_s / self.substeps as f64;
        let propagator = ExactPropagator::new(&matrices, step)?;
        let drive = self.drive(run)?;
        let bases = drive.base_count;
        let value = |i: usize| initial.get(i).copied().unwrap_or(0.0);
        let displacement: Vec<f64> = (0..n).map(value).collect();
        let velocity: Vec<f64> = (n..2 * n).map(value).collect();
        let excitation = Excitation {
            dof_force: &drive.dof_force,
            base_displacement: &drive.base_displacement,
            base_velocity: &drive.base_velocity,
            base_count: bases,
            sample_count: run.len,
            start_s: run.start_s,
            substeps: self.substeps,
        };
        propagator.march(
            &self.elements,
            &excitation,
            &displacement,
            &velocity,
            &mut |at| {
                let range = at.sample * bases..(at.sample + 1) * bases;
                let base = BaseMotion {
                    displacement: &drive.base_displacement[range.clone()],
                    velocity: &drive.base_velocity[range.clone()],
                    acceleration: &drive.base_acceleration[range],
                };
                observe(&propagator, at, &base);
            },
        );
        Ok(())
    }

    /// Forces on the masses and motion of the bases, sample by sample.
    fn drive(&self, run: &Run) -> Result<Drive, SimulateError> {
        let n = self.model.dof_count();
        let mut inputs: Vec<std::borrow::Cow<'_, [f64]>> = run
            .inputs
            .iter()
            .map(|signal| signal.as_slice().into())
            .collect();
        for (input, map) in &self.input_maps {
            let signal = Sampled {
                values: &inputs[*input],
                time_step_s: run.time_step_s,

                first_index: run.first_index,
            };
            inputs[*input] = map.apply(signal).into();
        }
        let mut drive = Drive {
            dof_force: Vec::with_capacity(run.len * n),
            ..Drive::default()
        };
        for _ in 0..run.len {
            drive.dof_force.extend_from_slice(&self.loads);
        }
        let base_inputs: Vec<usize> = (0..inputs.len())
            .filter(|&i| self.model.inputs[i].kind == InputKind::Displacement)
            .collect();
        drive.base_count = base_inputs.len();
        for (i, signal) in inputs.iter().enumerate() {
            let Some(Node::Dof(dof)) = self.model.node(&self.model.inputs[i].at) else {
                continue;
            };
            for (sample, value) in signal.iter().enumerate() {
                drive.dof_force[sample * n + dof] += value;
            }
        }
        let motion: Vec<[Vec<f64>; 3]> = base_inputs
            .iter()
            .map(|&i| {
                let velocity = derivative(&inputs[i], run.time_step_s);
                let acceleration = derivative(&velocity, run.time_step_s);
                [inputs[i].to_vec(), velocity, acceleration]
            })
            .collect();
        let interleave = |k: usize| -> Vec<f64> {
            (0..run.len)
                .flat_map(|s| motion.iter().map(move |base| base[k][s]))
                .collect()
        };
        drive.base_displacement = interleave(0);
        drive.base_velocity = interleave(1);
        drive.base_acceleration = interleave(2);
        self.couple_bases(&motion, &mut drive.dof_force, n)?;
        Ok(drive)
    }

    /// Adds what springs and dampers to moving bases do to the masses: k b + c ḃ.
    fn couple_bases(
        &self,
        motion: &[[Vec<f64>; 3]],
        dof_force: &mut [f64],
        n: usize,
    ) -> Result<(), SimulateError> {
        let springs = self
            .model
            .springs
            .iter()
            .map(|s| (&s.between, 0, s.stiffness));
        let dampers = self
            .model
            .dampers
            .iter()
            .map(|d| (&d.between, 1, d.damping));
        for (between, order, coefficient) in springs.chain(dampers) {
            let pair = self.model.resolve_pair(between, || "member".into())?;
            if let [Node::Dof(dof), Node::Base(base)] | [Node::Base(base), Node::Dof(dof)] = pair {
                for (sample, value) in motion[base][order].iter().enumerate() {
                    dof_force[sample * n + dof] += coefficient * value;
                }
            }
        }
        Ok(())
    }
}

#[derive(Default)]
struct Drive {
    dof_force: Vec<f64>,
    base_displacement: Vec<f64>,
    base_velocity: Vec<f64>,
    base_acceleration: Vec<f64>,
    base_count: usize,
}

fn ends(model: &Model, at: &Location) -> Result<[Node; 2], SimulateError> {
    let ground = simgap_model::GROUND.to_string();
    let pair = match at {
        Location::Between(pair) => pair.clone(),
        Location::Mass(mass) => [mass.clone(), ground],
        Location::Input(_) | Location::Channel(_) => [ground.clone(), ground],
    };
    Ok(model.resolve_pair(&pair, || at.to_string())?)
}

/// First derivative of a sampled signal by five-point central differences,
///
/// ```text
/// y'_n = (y_(n−2) − 8 y_(n−1) + 8 y_(n+1) − y_(n+2)) / (12 h)
/// ```
///
/// and one-sided formulas of the same order at the ends.
fn derivative(signal: &[f64], step: f64) -> Vec<f64> {
    let n = signal.len();
    if n < 5 {
        return (0..n)
            .map(|i| {
                let (left, right) = (i.saturating_sub(1), (i + 1).min(n - 1));
                let span = (right - left).max(1) as f64;
                (signal[right] - signal[left]) / (span * step)
            })
            .collect();
    }
    const EDGE: [[f64; 5]; 2] = [
        [-25.0, 48.0, -36.0, 16.0, -3.0],
        [-3.0, -10.0, 18.0, -6.0, 1.0],
    ];
    let edge = |row: usize, mirrored: bool| -> f64 {
        let sum: f64 = (0..5)
            .map(|j| {
                EDGE[row][j]
                    * if mirrored {
                        -signal[n - 1 - j]
                    } else {
                        signal[j]
                    }
            })
            .sum();
        sum / (12.0 * step)
    };
    (0..n)
        .map(|i| match (i, n - 1 - i) {
            (0 | 1, _) => edge(i, false),
            (_, 0 | 1) => edge(n - 1 - i, true),
            _ => {
                let s = signal;
                (s[i - 2] - 8.0 * s[i - 1] + 8.0 * s[i + 1] - s[i + 2]) / (12.0 * step)
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::derivative;

    #[test]
    fn verify_derivative_is_exact_for_degree_four() {
        let values: Vec<f64> = (0..9).map(|i| (f64::from(i) * 0.5).powi(4)).collect();
        for (i, slope) in derivative(&values, 0.5).iter().enumerate() {
            assert!(
                (slope - 4.0 * (i as f64 * 0.5).powi(3)).abs() < 1e-10,
                "sample {i}"
            );
        }
    }
}
