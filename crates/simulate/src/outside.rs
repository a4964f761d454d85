//! A model whose plant is a simulator of the user's, ready to be asked.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use simgap_integrate::exact::ForceLaw;
use simgap_model::{GROUND, Location, Model, Node, Output};

use crate::external::{ExternalPlant, lock};
use crate::plant::{Key, PlantError, PlantRun};
use crate::port_law::{Member, PortLaw};
use crate::response::Answer;
use crate::waveform::{Settled, Times, settle};
use crate::{Run, SimulateError};

/// What came out of a run, once somebody has asked.
type Place = Arc<Mutex<Option<Result<Arc<Settled>, PlantError>>>>;

/// Forces at the ports in a run, by port, where somebody knows them.
type ForcesIn = Box<dyn Fn(&Run) -> Option<Vec<Vec<f64>>> + Send + Sync>;

/// A simulator with its parameters and the laws at its ports.
pub(crate) struct Outside {
    plant: Arc<ExternalPlant>,
    /// Parameters of the nominal model, for the responses, and those of this one.
    nominal: Vec<(String, f64)>,
    parameters: Vec<(String, f64)>,
    /// Names of its inputs and of the outputs that are asked for.
    inputs: Vec<String>,
    wanted: Vec<String>,
    /// Each output of the model among these.
    compared: Vec<usize>,
    /// Name of each port, and its displacement and velocity among the outputs.
    ports: Vec<(String, [usize; 2])>,
    laws: Vec<PortLaw>,
    /// The forces of a simulator in which they are nearly those of this one.
    beside: Option<ForcesIn>,
    /// What came out of each run.
    settled: Mutex<HashMap<Key, Place>>,
}

impl Outside {
    /// The simulator of a model, and laws at places of it.
    pub(crate) fn new(
        plant: &Arc<ExternalPlant>,
        nominal: &Model,
        model: &Model,
        laws: impl Iterator<Item = ([Node; 2], Box<dyn ForceLaw>)>,
    ) -> Result<Outside, SimulateError> {
        let wanted: Vec<String> = model
            .plant_outputs()
            .into_iter()
            .map(String::from)
            .collect();
        let place = |name: &str| wanted.iter().position(|known| known == name).unwrap_or(0);
        let parameters = |model: &Model| {
            let parameters = model.plant_parameters.iter();
            parameters
                .map(|one| (one.name.clone(), one.value))
                .collect()
        };
        let springs = model
            .springs
            .iter()
            .map(|spring| (&spring.between, [spring.stiffness, 0.0]));
        let dampers = model
            .dampers
            .iter()
            .map(|damper| (&damper.between, [0.0, damper.damping]));
        let members = springs.chain(dampers).map(|(pair, [stiffness, damping])| {
            let law: Box<dyn ForceLaw> = Box::new(Member { stiffness, damping });
            Ok((model.resolve_pair(pair, || "member".into())?, law))
        });
        let members = members.collect::<Result<Vec<_>, SimulateError>>()?;
        let port = |node: Node| match node {
            Node::Port(port) => Some(port),
            _ => None,
        };
        let laws = members.into_iter().chain(laws);
        Ok(Outside {
            plant: Arc::clone(plant),
            nominal: parameters(nominal),
            parameters: parameters(model),
            inputs: model.inputs.iter().map(|input| input.at.clone()).collect(),
            compared: model
                .outputs
                .iter()
                .map(|output| place(Output::signal(output)))
                .collect(),
            ports: model
                .ports
                .iter()
                .map(|port| {
                    (
                        port.name.clone(),
                        [place(&port.displacement), place(&port.velocity)],
                    )
                })
                .collect(),
            laws: laws
                .map(|(ends, law)| PortLaw {
                    ends: ends.map(port),
                    law,
                })
                .collect(),
            wanted,
            beside: None,
            settled: Mutex::default(),
        })
    }

    pub(crate) fn has_laws(&self) -> bool {
        !self.laws.is_empty()
    }

    /// Begins where the forces of another have settled.
    pub(crate) fn begin_beside(&mut self, forces: ForcesIn) {
        self.beside = Some(forces);
    }

    /// The outputs of the model under inputs, before their maps.
    pub(crate) fn predict(
        &self,
        run: &Run,
        inputs: Vec<Vec<f64>>,
    ) -> Result<Vec<Vec<f64>>, SimulateError> {
        let answer = self.answer(run, inputs)?;
        Ok(self.compared.iter().map(|s| answer[*s].clone()).collect())
    }

    /// Displacement and velocity across a place: between ports and the ground; none elsewhere.
    pub(crate) fn path(
        &self,
        run: &Run,
        inputs: Vec<Vec<f64>>,
        at: &Location,
    ) -> Result<Option<[Vec<f64>; 2]>, SimulateError> {
        let Some(ends) = self.ends(at) else {
            return Ok(None);
        };
        let answer = self.answer(run, inputs)?;
        let signal = |k: usize| {
            let value = |end: Option<usize>, n: usize| {
                end.map_or(0.0, |port| answer[self.ports[port].1[k]][n])
            };
            (0..run.len)
                .map(|n| value(ends[0], n) - value(ends[1], n))
                .collect()
        };
        Ok(Some([0, 1].map(signal)))
    }

    /// The mass (kg, kg m²) that a force over one sample finds at the port of a place: h δ / Δv.
    pub(crate) fn inertia(
        &self,
        run: &Run,
        inputs: Vec<Vec<f64>>,
        at: &Location,
    ) -> Result<Option<f64>, SimulateError> {
        let port = self
            .ends(at)
            .and_then(|ends| ends.into_iter().flatten().next());
        let Some(port) = port else {
            return Ok(None);
        };
        let response = self.with_run(run, inputs, &self.nominal, |asked| {
            self.plant.response(asked, &self.motions())
        })?;
        let moved = response.unit[port][self.ports[port].1[1]].get(response.lag);
        Ok(moved.map(|moved| run.time_step_s / moved))
    }

    fn ends(&self, at: &Location) -> Option<[Option<usize>; 2]> {
        let port = |name: &String| self.ports.iter().position(|(known, _)| known == name);
        let ends = match at {
            Location::Between(pair) => pair
                .each_ref()
                .map(|name| (name != GROUND).then(|| port(name)).flatten()),
            Location::Mass(name) => [port(name), None],
            Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => [None; 2],
        };
        ends.iter().any(Option::is_some).then_some(ends)
    }

    fn motions(&self) -> Vec<[usize; 2]> {
        self.ports.iter().map(|(_, motion)| *motion).collect()
    }

    /// Calls with a run without forces.
    fn with_run<T>(
        &self,
        run: &Run,
        inputs: Vec<Vec<f64>>,
        parameters: &[(String, f64)],
        call: impl FnOnce(&PlantRun<'_>) -> Result<T, PlantError>,
    ) -> Result<T, SimulateError> {
        let inputs: Vec<(String, Vec<f64>)> = self.inputs.iter().cloned().zip(inputs).collect();
        let forces: Vec<(String, Vec<f64>)> = self
            .ports
            .iter()
            .map(|(name, _)| (name.clone(), vec![0.0; run.len]))
            .collect();
        let asked = PlantRun {
            parameters,
            time_step_s: run.time_step_s,
            len: run.len,
            inputs: &inputs,
            forces: &forces,
            outputs: &self.wanted,
        };
        Ok(call(&asked)?)
    }

    /// Every output that is asked for, with the forces of the laws.
    fn answer(&self, run: &Run, inputs: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, SimulateError> {
        if self.laws.is_empty() {
            let answer =
                self.with_run(run, inputs, &self.parameters, |asked| self.plant.ask(asked))?;
            return Ok(answer.to_vec());
        }
        self.settled(run, inputs)
            .map(|settled| settled.outputs.clone())
    }

    /// Forces and motion of a run with laws, brought together once.
    fn settled(&self, run: &Run, inputs: Vec<Vec<f64>>) -> Result<Arc<Settled>, SimulateError> {
        let key = self.with_run(run, inputs.clone(), &self.parameters, |asked| {
            Ok(asked.key())
        })?;
        let place = Arc::clone(lock(&self.settled).entry(key).or_default());
        // Whoever asks for the same meanwhile waits for it here.
        let mut place = lock(&place);
        let found = match place.as_ref() {
            Some(known) => known.clone(),
            None => match self.settle(run, inputs) {
                Err(SimulateError::Plant(error)) => Err(error),
                other => Ok(Arc::new(other?)),
            },
        };
        Ok(place.insert(found).clone()?)
    }

    fn settle(&self, run: &Run, inputs: Vec<Vec<f64>>) -> Result<Settled, SimulateError> {
        // The response is that of the nominal model under the inputs of the record, whatever is done to them.
        let response = self.with_run(run, run.inputs.clone(), &self.nominal, |asked| {
            self.plant.response(asked, &self.motions())
        })?;
        let times = Times {
            start_s: run.start_s,
            step_s: run.time_step_s,
            len: run.len,
        };
        let name = |port: usize| self.ports[port].0.clone();
        let from = |first: Vec<Vec<f64>>, inputs| {
            self.with_run(run, inputs, &self.parameters, |asked| {
                let ask = |forces: &[Vec<f64>]| -> Result<Answer, PlantError> {
                    let forces: Vec<(String, Vec<f64>)> = (0..forces.len())
                        .map(&name)
                        .zip(forces.iter().cloned())
                        .collect();
                    self.plant.ask(&PlantRun {
                        forces: &forces,
                        ..*asked
                    })
                };
                settle(&self.laws, &response, times, first, ask, name)
            })
        };
        // Where the other does not settle, or this one not from there, it begins without forces.
        let beside = self.beside.as_ref().and_then(|forces_in| forces_in(run));
        if let Some(Ok(settled)) = beside.map(|first| from(first, inputs.clone())) {
            return Ok(settled);
        }
        from(vec![vec![0.0; run.len]; self.ports.len()], inputs)
    }

    /// The forces at the ports in a run, where they settle.
    pub(crate) fn forces(&self, run: &Run, inputs: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
        let settled = self.settled(run, inputs).ok()?;
        Some(settled.forces.clone())
    }
}
