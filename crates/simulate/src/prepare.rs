//! What several simulations share: propagators of the same matrices, drives of the same run.

use std::collections::HashMap;
use std::sync::Arc;

use faer::Mat;
use simgap_integrate::exact::ExactPropagator;
use simgap_model::StructuralMatrices;

use crate::drive::{Drive, DriveKey};
use crate::prepared::Prepared;
use crate::{Run, SimulateError, Simulator};

/// What has been prepared already.
#[derive(Default)]
pub(crate) struct Workshop<'a> {
    propagators: Vec<(StructuralMatrices, f64, Arc<ExactPropagator>)>,
    /// What drives depend on beside the run, and which of these a simulator, told apart by where it is, has.
    keys: Vec<DriveKey<'a>>,
    key_of: HashMap<*const Simulator, usize>,
    /// Of each of these in a run, told apart by where it is.
    drives: HashMap<(usize, *const Run), Arc<Drive>>,
    /// Of a simulator at a step.
    systems: HashMap<(*const Simulator, u64), System>,
}

/// What simulations of one simulator share.
#[derive(Clone)]
struct System {
    stiffness: Arc<Mat<f64>>,
    propagator: Arc<ExactPropagator>,
}

impl<'a> Workshop<'a> {
    fn propagator(
        &mut self,
        matrices: &StructuralMatrices,
        step: f64,
    ) -> Result<Arc<ExactPropagator>, SimulateError> {
        let known = self.propagators.iter().find(|(known, of_step, _)| {
            *of_step == step
                && known.mass_matrix == matrices.mass_matrix
                && known.damping_matrix == matrices.damping_matrix
                && known.stiffness_matrix == matrices.stiffness_matrix
        });
        if let Some((_, _, propagator)) = known {
            return Ok(Arc::clone(propagator));
        }
        let propagator = Arc::new(ExactPropagator::new(matrices, step)?);
        let entry = (matrices.clone(), step, Arc::clone(&propagator));
        self.propagators.push(entry);
        Ok(propagator)
    }

    fn system(
        &mut self,
        simulator: &'a Simulator,
        time_step_s: f64,
    ) -> Result<System, SimulateError> {
        let key = (std::ptr::from_ref(simulator), time_step_s.to_bits());
        if let Some(system) = self.systems.get(&key) {
            return Ok(system.clone());
        }
        let matrices = simulator.model.tangent_matrices()?;
        let step = time_step_s / simulator.substeps as f64;
        let system = System {
            propagator: self.propagator(&matrices, step)?,
            stiffness: Arc::new(matrices.stiffness_matrix),
        };
        self.systems.insert(key, system.clone());
        Ok(system)
    }

    fn drive(
        &mut self,
        simulator: &'a Simulator,
        run: &'a Run,
    ) -> Result<Arc<Drive>, SimulateError> {
        let key = self.key(simulator)?;
        let place = (key, std::ptr::from_ref(run));
        if let Some(drive) = self.drives.get(&place) {
            return Ok(Arc::clone(drive));
        }
        let drive = Arc::new(simulator.drive(run, &self.keys[key]));
        self.drives.insert(place, Arc::clone(&drive));
        Ok(drive)
    }

    fn key(&mut self, simulator: &'a Simulator) -> Result<usize, SimulateError> {
        if let Some(&key) = self.key_of.get(&std::ptr::from_ref(simulator)) {
            return Ok(key);
        }
        let key = simulator.drive_key()?;
        let known = self.keys.iter().position(|known| *known == key);
        let place = known.unwrap_or_else(|| {
            self.keys.push(key);
            self.keys.len() - 1
        });
        self.key_of.insert(simulator, place);
        Ok(place)
    }

    /// Prepares a simulation from an initial state of the nominal model.
    pub(crate) fn prepare(
        &mut self,
        simulator: &'a Simulator,
        run: &'a Run,
        initial: &[f64],
    ) -> Result<Prepared, SimulateError> {
        let system = self.system(simulator, run.time_step_s)?;
        let known = simulator.nominal_dofs;
        let part = |from: usize, k: usize| -> Vec<f64> {
            let value = |i: usize| initial.get(i).copied().unwrap_or(0.0);
            let values: Vec<f64> = (from..from + known).map(value).collect();
            following(
                &system.stiffness,
                values,
                simulator.added.iter().map(|s| s[k]),
            )
        };
        Ok(Prepared {
            displacement: part(0, 0),
            velocity: part(known, 1),
            propagator: system.propagator,
            drive: self.drive(simulator, run)?,
        })
    }
}

/// Values of all masses from those of the nominal model: an added mass follows the others as the
/// springs have it at rest, K_aa x_a = −K_ak x_k, and is off by what `added` says.
fn following(
    stiffness: &Mat<f64>,
    mut values: Vec<f64>,
    added: impl ExactSizeIterator<Item = f64>,
) -> Vec<f64> {
    use faer::linalg::solvers::Solve;
    let (known, more) = (values.len(), added.len());
    if more == 0 {
        return values;
    }
    let pull = Mat::from_fn(more, 1, |i, _| {
        let row = (0..known).map(|j| stiffness[(known + i, j)] * values[j]);
        -row.sum::<f64>()
    });
    let own = Mat::from_fn(more, more, |i, j| stiffness[(known + i, known + j)]);
    let follows = own.partial_piv_lu().solve(&pull);
    values.extend(added.enumerate().map(|(i, off)| {
        let value = follows[(i, 0)];
        off + if value.is_finite() { value } else { 0.0 }
    }));
    values
}
