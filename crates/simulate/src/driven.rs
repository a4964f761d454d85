//! What drives a simulator in a run.

use std::borrow::Cow;

use simgap_effects::Sampled;
use simgap_model::{BetweenSamples, Input, InputKind, Node};

use crate::drive::{Coupling, Drive, DriveKey, derivative, steps_apart, straighten};
use crate::{Run, SimulateError, Simulator};

impl Simulator {
    pub(crate) fn drive_key(&self) -> Result<DriveKey<'_>, SimulateError> {
        Ok(DriveKey {
            input_effects: &self.input_effects,
            between_samples: self
                .model
                .inputs
                .iter()
                .map(Input::between_samples)
                .collect(),
            mapped_inputs: self.input_maps.iter().map(|(input, _)| *input).collect(),
            input_terms: {
                let inputs = 0..self.model.inputs.len();
                let terms = inputs.map(|i| self.model.input_terms(i));
                terms.collect::<Result<_, _>>()?
            },
            loads: &self.loads,
            couplings: self.couplings()?,
        })
    }

    /// The inputs of a run through their maps.
    pub(crate) fn inputs<'a>(&self, run: &'a Run) -> Vec<Cow<'a, [f64]>> {
        let mut inputs: Vec<Cow<'_, [f64]>> = run
            .inputs
            .iter()
            .map(|signal| signal.as_slice().into())
            .collect();
        for (input, map) in &self.input_maps {
            let signal = Sampled {
                values: &inputs[*input],
                time_step_s: run.time_step_s,
                first_index: run.first_index,
                start_s: run.start_s,
                measured: None,
            };
            inputs[*input] = map.apply(signal).into();
        }
        inputs
    }

    /// Forces on the masses and motion of the bases, sample by sample; `key` is that of the simulator.
    pub(crate) fn drive(&self, run: &Run, key: &DriveKey<'_>) -> Drive {
        let n = self.model.dof_count();
        let inputs = self.inputs(run);
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
        let parts: Vec<Vec<(BetweenSamples, Cow<'_, [f64]>)>> = inputs
            .iter()
            .zip(&key.between_samples)
            .map(|(signal, between)| match between {
                BetweenSamples::Stepped => {
                    let [rest, steps] = steps_apart(signal);
                    vec![
                        (BetweenSamples::Smooth, rest.into()),
                        (BetweenSamples::Held, steps.into()),
                    ]
                }
                between => vec![(*between, Cow::Borrowed(&**signal))],
            })
            .collect();
        let add = |drive: &mut Drive, wanted: BetweenSamples| {
            for (parts, terms) in parts.iter().zip(&key.input_terms) {
                for (_, signal) in parts.iter().filter(|(between, _)| *between == wanted) {
                    for &(dof, weight) in terms {
                        drive.add(wanted, (dof, n), (signal, weight), run.time_step_s);
                    }
                }
            }
        };
        add(&mut drive, BetweenSamples::Smooth);
        let motion: Vec<[Vec<f64>; 3]> = base_inputs
            .iter()
            .map(|&i| {
                let velocity = derivative(&inputs[i], run.time_step_s);
                let acceleration = derivative(&velocity, run.time_step_s);
                [inputs[i].to_vec(), velocity, acceleration]
            })
            .collect();
        let interleave = |k: usize| -> Vec<f64> {
            let samples = if motion.is_empty() { 0 } else { run.len };
            (0..samples)
                .flat_map(|s| motion.iter().map(move |base| base[k][s]))
                .collect()
        };
        drive.base_displacement = interleave(0);
        drive.base_velocity = interleave(1);
        drive.base_acceleration = interleave(2);
        for coupling in &key.couplings {
            let motion = &motion[coupling.base][coupling.order];
            for (sample, value) in motion.iter().enumerate() {
                drive.dof_force[sample * n + coupling.dof] += coupling.coefficient * value;
            }
        }
        drive.beyond = straighten(&mut drive.dof_force, n);
        add(&mut drive, BetweenSamples::Linear);
        add(&mut drive, BetweenSamples::Held);
        drive
    }

    /// Springs, dampers and beams to moving bases: they do k b + c ḃ − m b̈ to the coordinates.
    fn couplings(&self) -> Result<Vec<Coupling>, SimulateError> {
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
        let mut couplings = Vec::new();
        for (between, order, coefficient) in springs.chain(dampers) {
            let pair = self.model.resolve_pair(between, || "member".into())?;
            let ([other, Node::Base(base)] | [Node::Base(base), other]) = pair else {
                continue;
            };
            couplings.extend(other.terms().map(|(dof, weight)| Coupling {
                dof,
                base,
                order,
                coefficient: weight * coefficient,
            }));
        }
        let inertia = self.model.base_inertia().into_iter();
        couplings.extend(inertia.map(|(dof, base, mass)| Coupling {
            dof,
            base,
            order: 2,
            coefficient: -mass,
        }));
        Ok(couplings)
    }
}
