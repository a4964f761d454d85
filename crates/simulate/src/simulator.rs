//! The model with its effects, ready to be marched through runs.

use faer::Mat;
use simgap_effects::{Action, Placed, Sampled, SignalMap};
use simgap_integrate::exact::{Element, ExactPropagator, Excitation, ForceLaw, MemberMotion};
use simgap_model::{Location, Model, Node};

use crate::outputs::{BaseMotion, OutputPlan, across, output_plans};
use crate::{Run, SimulateError};

/// A model with its effects.
pub struct Simulator {
    pub(crate) model: Model,
    elements: Vec<Element>,
    pub(crate) input_maps: Vec<(usize, Box<dyn SignalMap>)>,
    output_maps: Vec<(usize, Box<dyn SignalMap>)>,
    outputs: Vec<OutputPlan>,
    pub(crate) loads: Vec<f64>,
    substeps: usize,
    /// Degrees of freedom of the nominal model; those that effects add come after them.
    nominal_dofs: usize,
    /// Displacement and velocity of each added mass at the first sample beyond those with which it
    /// would follow the others.
    added: Vec<[f64; 2]>,
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
        let mut builders = Vec::new();
        let mut added = Vec::new();
        for placed in effects {
            match (placed.action(), &placed.at) {
                (Action::Model(change), at) => change(&mut model, at),
                (Action::Mode { change, start }, at) => {
                    let before = model.dof_count();
                    change(&mut model, at);
                    added.extend((before..model.dof_count()).map(|_| start));
                }
                (Action::Force(law), at) => laws.push((at, law)),
                (Action::Member(build), at) => builders.push((at, build)),
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
        // The members as all changes of the model leave them.
        laws.extend(
            builders
                .into_iter()
                .map(|(at, build)| (at, build(&model, at))),
        );
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
            nominal_dofs: nominal.dof_count(),
            added,
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

    /// Length of the initial state: displacements, then velocities of the masses of the nominal
    /// model.
    #[must_use]
    pub fn state_len(&self) -> usize {
        2 * self.nominal_dofs
    }

    /// Whether a map of an output moves in steps, so that the prediction has no derivative.
    #[must_use]
    pub fn is_stepped(&self) -> bool {
        self.output_maps.iter().any(|(_, map)| map.is_stepped())
    }

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
        for (output, map) in self
            .output_maps
            .iter()
            .filter(|(_, map)| keep(map.as_ref()))
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
        let matrices = self.model.matrices()?;
        let step = run.time_step_s / self.substeps as f64;
        let propagator = ExactPropagator::new(&matrices, step)?;
        let drive = self.drive(run)?;
        let bases = drive.base_count;
        let known = self.nominal_dofs;
        let part = |from: usize, k: usize| -> Vec<f64> {
            let value = |i: usize| initial.get(i).copied().unwrap_or(0.0);
            let values: Vec<f64> = (from..from + known).map(value).collect();
            following(
                &matrices.stiffness_matrix,
                values,
                self.added.iter().map(|s| s[k]),
            )
        };
        let displacement = part(0, 0);
        let velocity = part(known, 1);
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

fn ends(model: &Model, at: &Location) -> Result<[Node; 2], SimulateError> {
    let ground = simgap_model::GROUND.to_string();
    let pair = match at {
        Location::Between(pair) => pair.clone(),
        Location::Mass(mass) => [mass.clone(), ground],
        Location::Input(_) | Location::Channel(_) => [ground.clone(), ground],
    };
    Ok(model.resolve_pair(&pair, || at.to_string())?)
}
