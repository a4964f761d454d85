//! The model with its effects, ready to be marched through runs.

use std::borrow::Cow;
use std::sync::Arc;

use simgap_effects::{Action, Placed, SignalMap, own_laws};
use simgap_integrate::exact::Element;
use simgap_model::{Location, Model, Node, same_pair};

use crate::outputs::{OutputPlan, output_plans};
use crate::outside::Outside;
use crate::ports::ports;
use crate::{ExternalPlant, PlantError, Run, SimulateError};

/// A model with its effects.
pub struct Simulator {
    pub(crate) model: Model,
    pub(crate) elements: Vec<Element>,
    pub(crate) input_maps: Vec<(usize, Box<dyn SignalMap>)>,
    /// Kind and values of the effects behind the input maps.
    pub(crate) input_effects: Vec<(&'static str, Vec<f64>)>,
    pub(crate) output_maps: Vec<(usize, Box<dyn SignalMap>)>,
    pub(crate) outputs: Vec<OutputPlan>,
    pub(crate) loads: Vec<f64>,
    pub(crate) substeps: usize,
    /// The simulator of the user's in the place of the exact propagation.
    pub(crate) outside: Option<Outside>,
    /// Degrees of freedom of the nominal model; those that effects add come after them.
    pub(crate) nominal_dofs: usize,
    /// Displacement and velocity of each added mass at the first sample beyond those with which it
    /// would follow the others.
    pub(crate) added: Vec<[f64; 2]>,
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

impl Simulator {
    /// Steps that the integration takes for each sample.
    #[must_use]
    pub fn steps_per_sample(&self) -> usize {
        self.substeps
    }

    /// Forces that are solved for in each step, beside the linear part.
    #[must_use]
    pub fn force_count(&self) -> usize {
        self.elements.len()
    }

    /// Coordinates of the linear part, those of hidden masses among them.
    #[must_use]
    pub fn coordinate_count(&self) -> usize {
        self.model.dof_count()
    }

    /// Puts the effects on the nominal model: first what changes its members and masses, then what adds masses,
    /// then forces and maps. `substeps` is used where nonlinear forces act (see [`crate::substeps_for`]); effects
    /// written in the model file are not added here.
    ///
    /// # Errors
    /// [`SimulateError::Model`] when an effect's place is not in the model.
    pub fn new(
        nominal: &Model,
        effects: &[Placed],
        substeps: usize,
    ) -> Result<Simulator, SimulateError> {
        Simulator::with_plant(nominal, effects, substeps, None)
    }

    /// As [`Simulator::new`] for a model that may stand for a simulator of the user's ([`Model::is_external`]): forces act at its
    /// ports, and its parameters are those of the model.
    ///
    /// # Errors
    /// [`SimulateError::Model`] as there, [`SimulateError::Plant`] when a simulator is needed and there is none.
    pub fn with_plant(
        nominal: &Model,
        effects: &[Placed],
        substeps: usize,
        plant: Option<&Arc<ExternalPlant>>,
    ) -> Result<Simulator, SimulateError> {
        let mut model = nominal.clone();
        let mut laws = Vec::new();
        let (mut input_maps, mut output_maps) = (Vec::new(), Vec::new());
        let mut input_effects = Vec::new();
        let mut sampling_maps = Vec::new();
        let mut builders = Vec::new();
        let mut modes = Vec::new();
        for placed in effects {
            match (placed.action(), &placed.at) {
                (Action::Model(change), at) => change(&mut model, at),
                (Action::Mode { change, start }, at) => modes.push((at, change, start)),
                (Action::Force(law), at) => laws.push((at, law)),
                (Action::Member(build), at) => builders.push((at, build)),
                (Action::Input(map), Location::Input(channel)) => {
                    let of = model.inputs.iter().position(|i| &i.channel == channel);
                    input_maps.extend(of.map(|i| (i, map)));
                    input_effects.push((placed.effect.kind(), placed.values.clone()));
                }
                (Action::Output(map), Location::Channel(channel)) => {
                    let of = model.output_index(channel);
                    output_maps.extend(of.map(|i| (i, map)));
                }
                (Action::Sampling(map), Location::Channel(channel)) => {
                    let of = model.output_index(channel);
                    sampling_maps.extend(of.map(|i| (i, map)));
                }
                (Action::Input(_) | Action::Output(_) | Action::Sampling(_), _) => {}
            }
        }
        // A hidden mass may take a member from its place: what changes members has come first, and the forces at the
        // member go with it.
        let before = (!modes.is_empty()).then(|| model.clone());
        let mut added = Vec::new();
        for (at, change, start) in modes {
            let known = model.dof_count();
            change(&mut model, at);
            added.extend((known..model.dof_count()).map(|_| start));
        }
        let place = |at| match &before {
            Some(before) => moved(before, &model, at),
            None => Cow::Borrowed(at),
        };
        let laws = laws.into_iter().map(|(at, law)| (place(at), law));
        let mut laws: Vec<_> = laws.collect();
        // The members as all changes of the model leave them.
        laws.extend(builders.into_iter().map(|(at, build)| {
            let at = place(at);
            let law = build(&model, &at);
            (at, law)
        }));
        output_maps.sort_by_key(|(_, map): &(usize, Box<dyn SignalMap>)| map.ends_the_chain());
        // What happens while sampling comes after what happens before, however they are listed.
        output_maps.extend(sampling_maps);
        let mut outside = None;
        if model.is_external() {
            let plant = plant.ok_or_else(|| PlantError::NoPlant {
                model: nominal.name.clone(),
            })?;
            let laws = laws
                .drain(..)
                .map(|(at, law)| Ok((ends(&model, &at)?, law)));
            let laws = laws.collect::<Result<Vec<_>, SimulateError>>()?;
            outside = Some(Outside::new(plant, nominal, &model, laws.into_iter())?);
        }
        let mut elements = ports(&model);
        // Ports and forces on a mass push from outside: no member carries them.
        let mut carried = vec![false; elements.len()];
        for (at, law) in laws {
            let [a, b] = ends(&model, &at)?;
            elements.push(Element::between(a, b, law));
            carried.push(matches!(*at, Location::Between(_)));
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
            input_effects,
            output_maps,
            outside,
            nominal_dofs: nominal.dof_count(),
            added,
        })
    }

    /// Begins to bring forces and motion of a simulator of the user's together where they have settled in `other`, if there is one, whose
    /// values are nearly the same: it is asked less often. Nothing changes elsewhere.
    #[must_use]
    pub fn beside(mut self, other: Option<&Arc<Simulator>>) -> Simulator {
        let has_laws = |of: &Simulator| of.outside.as_ref().is_some_and(Outside::has_laws);
        let other = other.filter(|other| has_laws(other) && has_laws(&self));
        if let (Some(outside), Some(other)) = (&mut self.outside, other.cloned()) {
            outside.begin_beside(Box::new(move |run| other.forces_in(run)));
        }
        self
    }

    /// A model file with the effects it lists.
    ///
    /// # Errors
    /// [`SimulateError::Effect`] when an effect or a law of the file cannot be used.
    pub fn of_file(model: &Model, runs: &[Run]) -> Result<Simulator, SimulateError> {
        own_laws(model)?;
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
}

/// Where a force between two nodes acts once a member between them has been taken to another node.
fn moved<'a>(before: &Model, after: &Model, at: &'a Location) -> Cow<'a, Location> {
    let Location::Between(pair) = at else {
        return Cow::Borrowed(at);
    };
    let springs = before.springs.iter().zip(&after.springs);
    let springs = springs.map(|(old, new)| (&old.between, &new.between));
    let dampers = before.dampers.iter().zip(&after.dampers);
    let dampers = dampers.map(|(old, new)| (&old.between, &new.between));
    let taken = springs
        .chain(dampers)
        .find(|(old, new)| old != new && same_pair(old, pair));
    let left = taken.and_then(|(old, new)| old.iter().position(|node| !new.contains(node)));
    let (Some((old, new)), Some(left)) = (taken, left) else {
        return Cow::Borrowed(at);
    };
    let node_now = |node: &String| if *node == old[left] { &new[left] } else { node }.clone();
    Cow::Owned(Location::Between(pair.each_ref().map(node_now)))
}

pub(crate) fn ends(model: &Model, at: &Location) -> Result<[Node; 2], SimulateError> {
    let ground = simgap_model::GROUND.to_string();
    let pair = match at {
        Location::Between(pair) => pair.clone(),
        Location::Mass(mass) => [mass.clone(), ground],
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => {
            [ground.clone(), ground]
        }
    };
    Ok(model.resolve_pair(&pair, || at.to_string())?)
}
