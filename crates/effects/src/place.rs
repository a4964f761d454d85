//! Effects at their places: where a kind can sit in a model, and one instance with its values.

use std::collections::BTreeMap;

use simgap_model::{EffectEntry, GROUND, Location, Model, Node, NominalQuantity, same_pair};

use crate::{Action, Effect, EffectError, Family, SiteKind, catalogue_of, find_in};

/// An effect at its place with its parameter values.
#[derive(Clone)]
pub struct Placed {
    /// The catalogue entry.
    pub effect: &'static dyn Effect,
    /// Where it sits.
    pub at: Location,
    /// Values in the order of [`Effect::parameters`]; of a parameter that every record has of its
    /// own, that of the first.
    pub values: Vec<f64>,
    /// For each record, the values of its own parameters in their order; empty where `values` holds
    /// for all.
    pub of_record: Vec<Vec<f64>>,
}

impl Placed {
    /// An effect with values that hold for every record.
    #[must_use]
    pub fn new(effect: &'static dyn Effect, at: Location, values: Vec<f64>) -> Placed {
        Placed {
            effect,
            at,
            values,
            of_record: vec![],
        }
    }

    /// The effect as it is in one record.
    #[must_use]
    pub fn in_record(&self, record: usize) -> Placed {
        let mut placed = Placed::new(self.effect, self.at.clone(), self.values.clone());
        if let Some(own) = self.of_record.get(record) {
            let places = self.own_places();
            for (place, value) in places.into_iter().zip(own) {
                placed.values[place] = *value;
            }
        }
        placed
    }

    /// Places of the parameters that every record has of its own.
    #[must_use]
    pub fn own_places(&self) -> Vec<usize> {
        let parameters = self.effect.parameters().iter().enumerate();
        parameters
            .filter_map(|(i, parameter)| parameter.per_record.then_some(i))
            .collect()
    }

    /// Gives an entry of a model file its meaning. Of several limits those that are left out are never reached.
    ///
    /// # Errors
    /// [`EffectError`] for an unknown kind or parameter, a missing parameter, a value outside its
    /// physical range, or a place that does not go with the kind or is not in the model.
    pub fn from_entry(model: &Model, entry: &EffectEntry) -> Result<Placed, EffectError> {
        let effect = find_in(model, &entry.kind, &entry.at);
        let effect = effect.ok_or_else(|| EffectError::UnknownKind {
            found: entry.kind.clone(),
            known: kinds(model),
        })?;
        let parameters = effect.parameters();
        if let Some(found) = entry
            .parameters
            .keys()
            .find(|key| parameters.iter().all(|p| p.name != key.as_str()))
        {
            return Err(EffectError::UnknownParameter {
                kind: entry.kind.clone(),
                found: found.clone(),
                known: parameters
                    .iter()
                    .map(|p| p.name)
                    .collect::<Vec<_>>()
                    .join(", "),
            });
        }
        let mut limits = parameters
            .iter()
            .filter(|p| p.neutral.is_some_and(f64::is_infinite));
        let has_limit = limits.any(|limit| entry.parameters.contains_key(limit.name));
        let mut values = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            let given = entry.parameters.get(parameter.name).copied();
            let unreached = || {
                let limit = parameter.neutral.filter(|n| n.is_infinite() && has_limit)?;
                Some(limit.signum() * f64::MAX)
            };
            let value = given
                .or_else(|| effect.left_out(parameter.name))
                .or_else(unreached);
            let value = value.ok_or_else(|| EffectError::MissingParameter {
                kind: entry.kind.clone(),
                parameter: parameter.name,
            })?;
            // An open range ends before infinity; NaN is in no range.
            let inside = (parameter.lower..=parameter.upper).contains(&value);
            if !(inside && value.is_finite()) {
                return Err(EffectError::OutOfRange {
                    kind: entry.kind.clone(),
                    parameter: parameter.name,
                    found: value,
                    lower: parameter.lower,
                    upper: parameter.upper,
                });
            }
            values.push(value);
        }
        let node = match &entry.at {
            Location::Mass(name) => model.node(name),
            _ => None,
        };
        // A point of a body has no mass of its own, a port of a simulator nothing but its motion.
        let is_massless = match node {
            Some(Node::Point(_)) => effect.nominal_quantity() == Some(NominalQuantity::Mass),
            Some(Node::Port(_)) => effect.family() != Family::Force,
            _ => false,
        };
        if is_massless || !effect.site().accepts(&entry.at) {
            return Err(EffectError::WrongPlace {
                kind: entry.kind.clone(),
                found: entry.at.to_string(),
                needed: effect.site().place().into(),
            });
        }
        let stated = effect.stated_places();
        if !stated.is_empty() && !stated.iter().any(|at| same_place(at, &entry.at)) {
            let places: Vec<String> = stated.iter().map(Location::to_string).collect();
            return Err(EffectError::WrongPlace {
                kind: entry.kind.clone(),
                found: entry.at.to_string(),
                needed: format!("a place of its [[law]]: {}", places.join(", ")),
            });
        }
        model.check_location(&entry.at, &format!("[[effect]] \"{}\"", entry.kind))?;
        Ok(Placed::new(effect, entry.at.clone(), values))
    }

    /// The entry as a model file writes it.
    #[must_use]
    pub fn to_entry(&self) -> EffectEntry {
        let names = self.effect.parameters().iter().map(|p| p.name.to_string());
        EffectEntry {
            kind: self.effect.kind().to_string(),
            at: self.at.clone(),
            parameters: names
                .zip(self.values.iter().copied())
                .collect::<BTreeMap<_, _>>(),
        }
    }

    /// What it does.
    #[must_use]
    pub fn action(&self) -> Action {
        self.effect.action(&self.values)
    }
}

const MEMBER: &str = "between = [\"a\", \"b\"]";
const MASS: &str = "mass = \"name\"";
const INPUT: &str = "input = \"channel\"";
const CHANNEL: &str = "channel = \"name\"";
const PARAMETER: &str = "parameter = \"name\"";

/// Whether two places are one, whichever way round a pair is written.
#[must_use]
pub fn same_place(a: &Location, b: &Location) -> bool {
    match (a, b) {
        (Location::Between(a), Location::Between(b)) => same_pair(a, b),
        _ => a == b,
    }
}

impl SiteKind {
    /// The key that places an effect of this kind in a model file.
    #[must_use]
    pub fn place(self) -> &'static str {
        match self {
            SiteKind::Member
            | SiteKind::Spring
            | SiteKind::GroundSpring
            | SiteKind::Damper
            | SiteKind::NoSpring
            | SiteKind::NoDamper
            | SiteKind::Chambers => MEMBER,
            SiteKind::Mass | SiteKind::Pendulum | SiteKind::Load | SiteKind::Spool => MASS,
            SiteKind::Input => INPUT,
            SiteKind::Channel => CHANNEL,
            SiteKind::Parameter => PARAMETER,
        }
    }

    /// Whether it is placed by the key of this location, whatever the model has there.
    #[must_use]
    pub fn accepts(self, at: &Location) -> bool {
        matches!(
            (at, self.place()),
            (Location::Between(_), MEMBER)
                | (Location::Mass(_), MASS)
                | (Location::Input(_), INPUT)
                | (Location::Channel(_), CHANNEL)
                | (Location::Parameter(_), PARAMETER)
        )
    }

    /// Whether it is a part of a hydraulic drive.
    #[must_use]
    pub fn is_hydraulic(self) -> bool {
        matches!(self, SiteKind::Chambers | SiteKind::Spool)
    }

    /// Whether it is found on machines of masses and members; not a place of a simulator.
    #[must_use]
    pub fn is_mechanical(self) -> bool {
        !self.is_hydraulic() && self != SiteKind::Parameter
    }

    /// The same in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            SiteKind::Member => "two nodes that a member joins, or a mass and the ground",
            SiteKind::Spring => "two nodes that a spring joins",
            SiteKind::GroundSpring => "a node and the ground that a spring joins",
            SiteKind::Damper => "two nodes that a damper joins",
            SiteKind::NoSpring => "two nodes without a spring between them",
            SiteKind::NoDamper => "two nodes without a damper between them",
            SiteKind::Mass => "a mass",
            SiteKind::Pendulum => "a mass with a pendulum",
            SiteKind::Load => "a mass with a load",
            SiteKind::Chambers => "the two chambers of a cylinder",
            SiteKind::Spool => "the spool of a valve",
            SiteKind::Input => "an input",
            SiteKind::Channel => "an output",
            SiteKind::Parameter => "a parameter of a simulator",
        }
    }
}

fn kinds(model: &Model) -> String {
    catalogue_of(model)
        .iter()
        .map(|effect| effect.kind())
        .collect::<Vec<_>>()
        .join(", ")
}

/// Every place in a model where an effect of this site kind can sit, in the order of the file.
#[must_use]
pub fn sites(model: &Model, kind: SiteKind) -> Vec<Location> {
    let sprung = |pair: &[String; 2]| model.springs.iter().any(|s| same_pair(&s.between, pair));
    let damped = |pair: &[String; 2]| model.dampers.iter().any(|d| same_pair(&d.between, pair));
    let placed = |pairs: Vec<[String; 2]>, keep: &dyn Fn(&[String; 2]) -> bool| -> Vec<Location> {
        pairs
            .into_iter()
            .filter(keep)
            .map(Location::Between)
            .collect()
    };
    let between = |keep: &dyn Fn(&[String; 2]) -> bool| placed(joints(model), keep);
    match kind {
        SiteKind::Member => between(&|_| true),
        SiteKind::Spring => between(&sprung),
        SiteKind::GroundSpring => {
            // A port has no mass that a support could be put under.
            let is_port = |node: &String| model.port(node).is_some();
            between(&|pair| {
                sprung(pair) && pair.iter().any(|node| node == GROUND) && !pair.iter().any(is_port)
            })
        }
        SiteKind::Damper => between(&damped),
        SiteKind::NoSpring => placed(pairs(model), &|pair| !sprung(pair)),
        SiteKind::NoDamper => placed(pairs(model), &|pair| !damped(pair)),
        SiteKind::Mass => masses(model, |_| true),
        SiteKind::Pendulum => masses(model, |mass| {
            model.pendulums.iter().any(|arm| arm.at == mass)
        }),
        SiteKind::Load => masses(model, |mass| {
            let mut loads = model.loads.iter();
            loads.any(|load| load.at == mass && load.value != 0.0)
        }),
        SiteKind::Chambers => {
            let cylinders = model.elements.cylinders.iter();
            cylinders
                .map(|cylinder| Location::Between(cylinder.chambers()))
                .collect()
        }
        SiteKind::Spool => {
            let valves = model.elements.valves.iter();
            valves.map(|valve| Location::Mass(valve.spool())).collect()
        }
        SiteKind::Input => model
            .inputs
            .iter()
            .map(|i| Location::Input(i.channel.clone()))
            .collect(),
        SiteKind::Channel => model
            .outputs
            .iter()
            .map(|o| Location::Channel(o.channel.clone()))
            .collect(),
        SiteKind::Parameter => {
            let parameters = model.plant_parameters.iter();
            parameters
                .map(|parameter| Location::Parameter(parameter.name.clone()))
                .collect()
        }
    }
}

/// Every place in a model where an effect can sit: those that it states; else [`sites`] of its kind, and for a force on a mass the ports of a simulator as well.
#[must_use]
pub fn places_of(model: &Model, effect: &dyn Effect) -> Vec<Location> {
    if !effect.stated_places().is_empty() {
        return effect.stated_places().to_vec();
    }
    let mut places = sites(model, effect.site());
    if effect.site() == SiteKind::Mass && effect.family() == Family::Force {
        let ports = model.ports.iter();
        places.extend(ports.map(|port| Location::Mass(port.name.clone())));
    }
    places
}

/// The masses of the names that are kept.
fn masses(model: &Model, keep: impl Fn(&str) -> bool) -> Vec<Location> {
    places(model)
        .filter(|name| keep(name))
        .map(|name| Location::Mass(name.to_owned()))
        .collect()
}

/// The coordinates that are places: a mode of a beam is a shape, a pressure a state.
fn places(model: &Model) -> impl Iterator<Item = &str> {
    let names = model.masses.iter().map(|mass| mass.name.as_str());
    names.filter(|name| !model.is_internal(name))
}

/// The points of bodies.
fn points(model: &Model) -> impl Iterator<Item = String> + '_ {
    let bodies = model.elements.bodies.iter();
    bodies.flat_map(|body| body.points.iter().map(|point| body.node_name(point)))
}

/// The members of the model, and every mass, every point of a body and every port of a simulator with the ground.
fn joints(model: &Model) -> Vec<[String; 2]> {
    let mut joints = model.members();
    let ports = model.ports.iter().map(|port| port.name.clone());
    let nodes = places(model).map(String::from).chain(points(model));
    for node in nodes.chain(ports) {
        let pair = [node, GROUND.to_string()];
        if !joints.iter().any(|known| same_pair(known, &pair)) {
            joints.push(pair);
        }
    }
    joints
}

/// The joints, and every further pair of masses or of a mass and a base: a member that the model lacks
/// may join what nothing joins. What moves along is not joined to what turns, nor a body to its own points.
fn pairs(model: &Model) -> Vec<[String; 2]> {
    let mut pairs = joints(model);
    let nodes: Vec<String> = places(model)
        .map(String::from)
        .chain(points(model))
        .collect();
    for (i, node) in nodes.iter().enumerate() {
        let others = nodes[i + 1..].iter().map(String::as_str);
        let one_body = |other: &&str| {
            let of = |node: &str| model.body_of(node).map(|body| &body.name);
            of(node).is_some() && of(node) == of(other)
        };
        let turns_alike = |other: &&str| model.is_roll(node) == model.is_roll(other);
        let others = others.filter(|other| turns_alike(other) && !one_body(other));
        let bases = model.base_nodes().into_iter();
        for other in others.chain(bases.filter(turns_alike)) {
            let pair = [node.clone(), other.to_string()];
            if !pairs.iter().any(|known| same_pair(known, &pair)) {
                pairs.push(pair);
            }
        }
    }
    pairs
}
