//! A simulator marched through one run.

use simgap_effects::{Sampled, SignalMap};
use simgap_integrate::exact::Snapshot;
use simgap_model::Location;

use crate::batch::excitation;
use crate::drive::derivative;
use crate::outputs::{BaseMotion, OutputPlan, across};
use crate::prepare::Workshop;
use crate::prepared::Prepared;
use crate::simulator::{MemberPath, Simulator, ends};
use crate::{Run, SimulateError};

impl Simulator {
    /// Predicts every output along a run from an initial state (displacements, then velocities;
    /// missing entries are zero). One signal for each output, in model units.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when the model cannot be propagated.
    pub fn predict(&self, run: &Run, initial: &[f64]) -> Result<Vec<Vec<f64>>, SimulateError> {
        self.predict_through(run, initial, |_| true)
    }

    /// As [`Simulator::predict`] without the maps that move in steps: for derivatives.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when the model cannot be propagated.
    pub fn predict_smooth(
        &self,
        run: &Run,
        initial: &[f64],
    ) -> Result<Vec<Vec<f64>>, SimulateError> {
        self.predict_through(run, initial, |map| !map.is_stepped())
    }

    fn predict_through(
        &self,
        run: &Run,
        initial: &[f64],
        keep: impl Fn(&dyn SignalMap) -> bool,
    ) -> Result<Vec<Vec<f64>>, SimulateError> {
        if let Some(outside) = &self.outside {
            let predicted = outside.predict(run, self.own_inputs(run))?;
            return Ok(self.through_maps(run, predicted, keep));
        }
        let ready = Workshop::default().prepare(self, run, initial)?;
        Ok(self.deliver(run, &ready, self.predict_raw(run, &ready), keep))
    }

    /// The outputs of the plant, before their maps.
    pub(crate) fn predict_raw(&self, run: &Run, ready: &Prepared) -> Vec<Vec<f64>> {
        let mut predicted: Vec<Vec<f64>> = self
            .outputs
            .iter()
            .map(|_| Vec::with_capacity(run.len))
            .collect();
        let mut acceleration = vec![0.0; self.model.dof_count()];
        let needs_acceleration = self.outputs.iter().any(OutputPlan::needs_acceleration);
        let is_read = |coordinate: usize| {
            let mut plans = self.outputs.iter();
            plans.any(|plan| plan.reads_displacement(coordinate, plan.stiffness != 0.0))
        };
        self.march(run, ready, &is_read, |at, base| {
            if needs_acceleration {
                ready.propagator.acceleration(at, &mut acceleration);
            }
            for (signal, plan) in predicted.iter_mut().zip(&self.outputs) {
                signal.push(plan.read(at, &acceleration, base));
            }
        });
        predicted
    }

    /// The outputs of the plant through the maps that are kept.
    pub(crate) fn deliver(
        &self,
        run: &Run,
        ready: &Prepared,
        mut predicted: Vec<Vec<f64>>,
        keep: impl Fn(&dyn SignalMap) -> bool,
    ) -> Vec<Vec<f64>> {
        self.add_beyond(ready, &mut predicted);
        self.through_maps(run, predicted, keep)
    }

    /// The forces at the ports of a simulator of the user's, where they settle.
    pub(crate) fn forces_in(&self, run: &Run) -> Option<Vec<Vec<f64>>> {
        self.outside.as_ref()?.forces(run, self.own_inputs(run))
    }

    fn own_inputs(&self, run: &Run) -> Vec<Vec<f64>> {
        let inputs = self.inputs(run).into_iter();
        inputs.map(std::borrow::Cow::into_owned).collect()
    }

    fn through_maps(
        &self,
        run: &Run,
        mut predicted: Vec<Vec<f64>>,
        keep: impl Fn(&dyn SignalMap) -> bool,
    ) -> Vec<Vec<f64>> {
        for (output, map) in self
            .output_maps
            .iter()
            .filter(|(_, map)| keep(map.as_ref()) && Simulator::has_samples_of(run, map.as_ref()))
        {
            let signal = Sampled {
                values: &predicted[*output],
                time_step_s: run.time_step_s,
                first_index: run.first_index,
                start_s: run.start_s,
                measured: run.measured.get(*output).and_then(Option::as_deref),
            };
            predicted[*output] = map.apply(signal);
        }
        predicted
    }

    /// Whether a map has the samples in a run that it lives in.
    fn has_samples_of(run: &Run, map: &dyn SignalMap) -> bool {
        !(run.mended.is_resampled && map.lives_in_single_samples())
    }

    /// Adds what the straight lines miss at a sample: `gᵀ Δf` to an acceleration, with g the output of unit forces; to an output
    /// of velocities `gᵀ Δp`, with Δp the impulse that a held force is ahead by and g the output of unit impulses.
    fn add_beyond(&self, ready: &Prepared, predicted: &mut [Vec<f64>]) {
        for (signal, plan) in predicted.iter_mut().zip(&self.outputs) {
            let beyond = match plan.needs_acceleration() {
                true => &ready.drive.beyond,
                false => &ready.drive.impulse_beyond,
            };
            if beyond.is_empty() {
                continue;
            }
            let gains = self.read_of_unit_forces(ready, plan);
            for (dof, values) in beyond {
                let g = gains[*dof];
                for (sample, value) in signal.iter_mut().zip(values) {
                    *sample += g * value;
                }
            }
        }
    }

    /// What an output reads off the acceleration by a unit force on each degree of freedom (1/kg), or off the velocity by a unit
    /// impulse.
    fn read_of_unit_forces(&self, ready: &Prepared, plan: &OutputPlan) -> Vec<f64> {
        let n = self.model.dof_count();
        let (rest, bases) = (vec![0.0; n], vec![0.0; ready.drive.base_count]);
        let base = BaseMotion {
            displacement: &bases,
            velocity: &bases,
            acceleration: &bases,
        };
        let (mut force, mut acceleration) = (vec![0.0; n], vec![0.0; n]);
        let still = Snapshot {
            sample: 0,
            displacement: &rest,
            velocity: &rest,
            dof_force: &rest,
            element_force: &vec![0.0; self.elements.len()],
        };
        let at_rest = plan.read(&still, &rest, &base);
        let mut unit = |dof: usize| {
            force.fill(0.0);
            force[dof] = 1.0;
            let pushed = Snapshot {
                dof_force: &force,
                ..still
            };
            ready.propagator.acceleration(&pushed, &mut acceleration);
            let moved = Snapshot {
                velocity: &acceleration,
                ..still
            };
            plan.read(&moved, &acceleration, &base) - at_rest
        };
        (0..n).map(&mut unit).collect()
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
        if let Some(outside) = &self.outside {
            let [displacement, velocity] = outside
                .path(run, self.own_inputs(run), at)?
                .unwrap_or_else(|| [vec![0.0; run.len], vec![0.0; run.len]]);
            return Ok(MemberPath {
                acceleration: derivative(&velocity, run.time_step_s),
                displacement,
                velocity,
            });
        }
        let ends = ends(&self.model, at)?;
        let ready = Workshop::default().prepare(self, run, initial)?;
        let mut path = MemberPath::default();
        let n = self.model.dof_count();
        let (mut acceleration, mut force) = (vec![0.0; n], vec![0.0; n]);
        self.march(run, &ready, &|_| true, |at, base| {
            force.copy_from_slice(at.dof_force);
            for (dof, forces) in &ready.drive.beyond {
                force[*dof] += forces[at.sample];
            }
            let at = &Snapshot {
                dof_force: &force,
                ..*at
            };
            ready.propagator.acceleration(at, &mut acceleration);
            let across = |dofs: &[f64], bases: &[f64]| across(ends, dofs, bases);
            path.displacement
                .push(across(at.displacement, base.displacement));
            path.velocity.push(across(at.velocity, base.velocity));
            path.acceleration
                .push(across(&acceleration, base.acceleration));
        });
        Ok(path)
    }

    /// The largest size of each entry of the state along a run: displacements of all coordinates, then velocities. None of a simulator
    /// of the user's, which has no state of ours.
    ///
    /// # Errors
    /// [`SimulateError`] when the run cannot be simulated.
    pub fn largest_state(&self, run: &Run, initial: &[f64]) -> Result<Vec<f64>, SimulateError> {
        if self.outside.is_some() {
            return Ok(vec![]);
        }
        let ready = Workshop::default().prepare(self, run, initial)?;
        let mut largest = vec![0.0; initial.len()];
        self.march(run, &ready, &|_| true, |at, _| {
            let state = at.displacement.iter().chain(at.velocity);
            for (largest, value) in largest.iter_mut().zip(state) {
                *largest = f64::max(*largest, value.abs());
            }
        });
        Ok(largest)
    }

    /// The mass (kg, kg m²) that a force finds at a port of a simulator over one sample of a run; `None` elsewhere.
    ///
    /// # Errors
    /// [`SimulateError::Plant`] when the simulator cannot be simulated or does not answer to forces.
    pub fn port_inertia(&self, run: &Run, at: &Location) -> Result<Option<f64>, SimulateError> {
        match &self.outside {
            Some(outside) => outside.inertia(run, run.inputs.clone(), at),
            None => Ok(None),
        }
    }

    fn march(
        &self,
        run: &Run,
        ready: &Prepared,
        is_read: &dyn Fn(usize) -> bool,
        mut observe: impl FnMut(&Snapshot<'_>, &BaseMotion<'_>),
    ) {
        let drive = &ready.drive;
        let bases = drive.base_count;
        ready.propagator.march_reading(
            &self.elements,
            &excitation(self, run, ready),
            [&ready.displacement, &ready.velocity],
            is_read,
            &mut |at| {
                let range = at.sample * bases..(at.sample + 1) * bases;
                let base = BaseMotion {
                    displacement: &drive.base_displacement[range.clone()],
                    velocity: &drive.base_velocity[range.clone()],
                    acceleration: &drive.base_acceleration[range],
                };
                observe(at, &base);
            },
        );
    }
}
