//! A lumped model: its parts, its nodes, and the checks that make it one.

use std::collections::BTreeSet;

use faer::Mat;

use crate::{
    Damper, EffectEntry, GROUND, Input, InputKind, Load, Location, Mass, ModelError, Output,
    OutputKind, Pendulum, Spring, StructuralMatrices,
};

/// A lumped model of any number of degrees of freedom, none included.
///
/// ```text
/// M ẍ + C ẋ + K x = F(t) + loads − pendulums − Kb b(t) − Cb ḃ(t)
/// ```
///
/// x are the displacements of the masses in the order of `masses`, b those of the moving base
/// nodes in the order of [`Model::base_nodes`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// Name of the model.
    pub name: String,
    /// One per degree of freedom.
    pub masses: Vec<Mass>,
    /// Linear springs.
    pub springs: Vec<Spring>,
    /// Linear dampers.
    pub dampers: Vec<Damper>,
    /// What drives the plant.
    pub inputs: Vec<Input>,
    /// What is compared.
    pub outputs: Vec<Output>,
    /// Known constant forces.
    pub loads: Vec<Load>,
    /// Gravity on arms.
    pub pendulums: Vec<Pendulum>,
    /// Effects added to the nominal model.
    pub effects: Vec<EffectEntry>,
}

/// A node of the model, resolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Node {
    /// Never moves.
    Ground,
    /// Degree of freedom, index into `masses`.
    Dof(usize),
    /// Moving base, index into [`Model::base_nodes`].
    Base(usize),
}

impl Model {
    /// Names of the moving base nodes, in the order of the inputs that drive them.
    #[must_use]
    pub fn base_nodes(&self) -> Vec<&str> {
        self.inputs
            .iter()
            .filter(|input| input.kind == InputKind::Displacement)
            .map(|input| input.at.as_str())
            .collect()
    }

    /// The node of a name, if there is one.
    #[must_use]
    pub fn node(&self, name: &str) -> Option<Node> {
        if name == GROUND {
            return Some(Node::Ground);
        }
        if let Some(i) = self.masses.iter().position(|mass| mass.name == name) {
            return Some(Node::Dof(i));
        }
        self.base_nodes()
            .iter()
            .position(|&base| base == name)
            .map(Node::Base)
    }

    /// Number of degrees of freedom.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.masses.len()
    }

    /// The distinct pairs of nodes that a spring or a damper joins, in the order of the file.
    /// A pair counts once, whichever way round it is written.
    #[must_use]
    pub fn members(&self) -> Vec<[String; 2]> {
        let mut members: Vec<[String; 2]> = Vec::new();
        let springs = self.springs.iter().map(|s| &s.between);
        let dampers = self.dampers.iter().map(|d| &d.between);
        for pair in springs.chain(dampers) {
            if !members.iter().any(|known| same_pair(known, pair)) {
                members.push(pair.clone());
            }
        }
        members
    }

    /// M, C and K, and the coupling of the moving base nodes.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`] when a member names a node that does not exist.
    pub fn matrices(&self) -> Result<StructuralMatrices, ModelError> {
        let n = self.dof_count();
        let mut matrices = StructuralMatrices {
            mass_matrix: Mat::zeros(n, n),
            damping_matrix: Mat::zeros(n, n),
            stiffness_matrix: Mat::zeros(n, n),
        };
        for (i, mass) in self.masses.iter().enumerate() {
            matrices.mass_matrix[(i, i)] = mass.value;
        }
        for spring in &self.springs {
            let pair = self.resolve_pair(&spring.between, || item("spring", &spring.name))?;
            add_member(&mut matrices.stiffness_matrix, pair, spring.stiffness);
        }
        for damper in &self.dampers {
            let pair = self.resolve_pair(&damper.between, || item("damper", &damper.name))?;
            add_member(&mut matrices.damping_matrix, pair, damper.damping);
        }
        Ok(matrices)
    }

    /// Displacements under constant forces, `K x = F`, m.
    ///
    /// `forces_n` holds one force for each mass; [`Model::load_vector`] gives the known loads.
    ///
    /// # Errors
    /// [`ModelError::Singular`] when a mass can move freely, [`ModelError::Shape`] for a wrong
    /// number of forces.
    pub fn static_deflection(&self, forces_n: &[f64]) -> Result<Vec<f64>, ModelError> {
        let stiffness = self.matrices()?.stiffness_matrix;
        if forces_n.len() != self.dof_count() {
            return Err(ModelError::Shape {
                place: "static deflection".into(),
                found: format!("{} forces", forces_n.len()),
                needed: format!("{} forces, one for each mass", self.dof_count()),
            });
        }
        crate::dense::solve(&stiffness, forces_n).ok_or_else(|| ModelError::Singular {
            matrix: "stiffness matrix",
            context: "a mass is free to move".into(),
        })
    }

    /// Sum of the known constant forces on each mass, N.
    #[must_use]
    pub fn load_vector(&self) -> Vec<f64> {
        let mut loads = vec![0.0; self.dof_count()];
        for load in &self.loads {
            if let Some(Node::Dof(i)) = self.node(&load.at) {
                loads[i] += load.value;
            }
        }
        loads
    }

    /// Resolves two node names; `place` says where they stand, for the error.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`].
    pub fn resolve_pair(
        &self,
        pair: &[String; 2],
        place: impl Fn() -> String,
    ) -> Result<[Node; 2], ModelError> {
        let resolve = |name: &String| {
            self.node(name).ok_or_else(|| ModelError::UnknownNode {
                place: place(),
                found: name.clone(),
                known: self.node_names().join(", "),
            })
        };
        Ok([resolve(&pair[0])?, resolve(&pair[1])?])
    }

    fn node_names(&self) -> Vec<String> {
        let masses = self.masses.iter().map(|mass| mass.name.clone());
        let bases = self.base_nodes().into_iter().map(String::from);
        masses.chain(bases).chain([GROUND.to_string()]).collect()
    }

    /// Checks that the parts make a model; [`Model::from_toml`] has done so.
    ///
    /// # Errors
    /// The first fault found, with its place.
    pub fn check(&self) -> Result<(), ModelError> {
        self.check_masses()?;
        self.check_members()?;
        self.check_inputs()?;
        self.check_outputs()?;
        self.check_forces()?;
        for (i, effect) in self.effects.iter().enumerate() {
            let place = format!("[[effect]] {} \"{}\"", i + 1, effect.kind);
            self.check_location(&effect.at, &place)?;
            for (name, &value) in &effect.parameters {
                finite(&place, name, value)?;
            }
        }
        Ok(())
    }

    fn check_masses(&self) -> Result<(), ModelError> {
        unique(
            "mass",
            self.masses
                .iter()
                .map(|m| m.name.as_str())
                .chain(self.base_nodes()),
        )?;
        for mass in &self.masses {
            let place = item("mass", &mass.name);
            node_name(&place, &mass.name)?;
            if !(mass.value.is_finite() && mass.value > 0.0) {
                return Err(ModelError::Value {
                    place,
                    quantity: "value".into(),
                    found: mass.value,
                    needed: "a positive mass",
                });
            }
        }
        Ok(())
    }

    fn check_members(&self) -> Result<(), ModelError> {
        unique("spring", self.springs.iter().map(|s| s.name.as_str()))?;
        unique("damper", self.dampers.iter().map(|d| d.name.as_str()))?;
        for spring in &self.springs {
            let place = item("spring", &spring.name);
            self.check_pair(&spring.between, &place)?;
            finite(&place, "stiffness", spring.stiffness)?;
        }
        for damper in &self.dampers {
            let place = item("damper", &damper.name);
            self.check_pair(&damper.between, &place)?;
            finite(&place, "damping", damper.damping)?;
        }
        Ok(())
    }

    fn check_pair(&self, pair: &[String; 2], place: &str) -> Result<(), ModelError> {
        self.resolve_pair(pair, || place.to_string())?;
        if pair[0] == pair[1] {
            return Err(ModelError::Shape {
                place: place.into(),
                found: format!("both ends are \"{}\"", pair[0]),
                needed: "two different nodes".into(),
            });
        }
        Ok(())
    }

    fn check_inputs(&self) -> Result<(), ModelError> {
        unique("input", self.inputs.iter().map(|i| i.channel.as_str()))?;
        for input in &self.inputs {
            let place = item("input", &input.channel);
            check_gain(&place, input.gain)?;
            match input.kind {
                InputKind::Force => self.check_mass(&input.at, &place)?,
                InputKind::Displacement => node_name(&place, &input.at)?,
            }
        }
        Ok(())
    }

    fn check_outputs(&self) -> Result<(), ModelError> {
        if self.outputs.is_empty() {
            return Err(ModelError::Shape {
                place: format!("model \"{}\"", self.name),
                found: "no [[output]]".into(),
                needed: "at least one output to compare".into(),
            });
        }
        unique("output", self.outputs.iter().map(|o| o.channel.as_str()))?;
        for output in &self.outputs {
            let place = item("output", &output.channel);
            check_gain(&place, output.gain)?;
            let force = output.kind == OutputKind::Force;
            match (&output.at, &output.between) {
                (Some(at), None) if !force => {
                    self.resolve_pair(&[at.clone(), at.clone()], || place.clone())?;
                }
                (None, Some(pair)) if force => self.check_pair(pair, &place)?,
                _ => {
                    return Err(ModelError::Shape {
                        place,
                        found: "a place that does not go with the kind".into(),
                        needed: "at = \"node\" for a motion, between = [\"a\", \"b\"] for a force"
                            .into(),
                    });
                }
            }
        }
        Ok(())
    }

    fn check_forces(&self) -> Result<(), ModelError> {
        for load in &self.loads {
            let place = item("load", &load.at);
            self.check_mass(&load.at, &place)?;
            finite(&place, "value", load.value)?;
        }
        for pendulum in &self.pendulums {
            let place = item("pendulum", &pendulum.at);
            self.check_mass(&pendulum.at, &place)?;
            finite(&place, "value", pendulum.value)?;
        }
        Ok(())
    }

    fn check_mass(&self, name: &str, place: &str) -> Result<(), ModelError> {
        if self.masses.iter().any(|mass| mass.name == name) {
            return Ok(());
        }
        Err(ModelError::UnknownNode {
            place: place.into(),
            found: name.into(),
            known: self
                .masses
                .iter()
                .map(|mass| mass.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })
    }

    /// Checks that a location names what the model has.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`] or [`ModelError::UnknownChannel`], with `place` in front.
    pub fn check_location(&self, at: &Location, place: &str) -> Result<(), ModelError> {
        let channel = |found: &String, known: Vec<&str>| {
            if known.contains(&found.as_str()) {
                return Ok(());
            }
            Err(ModelError::UnknownChannel {
                place: place.into(),
                found: found.clone(),
                known: known.join(", "),
            })
        };
        match at {
            Location::Between(pair) => self.check_pair(pair, place),
            Location::Mass(mass) => self.check_mass(mass, place),
            Location::Input(name) => channel(
                name,
                self.inputs.iter().map(|i| i.channel.as_str()).collect(),
            ),
            Location::Channel(name) => channel(
                name,
                self.outputs.iter().map(|o| o.channel.as_str()).collect(),
            ),
        }
    }
}

/// Whether two pairs of nodes are the same, whichever way round they are written.
#[must_use]
pub fn same_pair(a: &[String; 2], b: &[String; 2]) -> bool {
    a == b || (a[0] == b[1] && a[1] == b[0])
}

fn add_member(matrix: &mut Mat<f64>, [a, b]: [Node; 2], value: f64) {
    if let Node::Dof(i) = a {
        matrix[(i, i)] += value;
    }
    if let Node::Dof(j) = b {
        matrix[(j, j)] += value;
    }
    if let (Node::Dof(i), Node::Dof(j)) = (a, b) {
        matrix[(i, j)] -= value;
        matrix[(j, i)] -= value;
    }
}

fn item(table: &str, name: &str) -> String {
    format!("[[{table}]] \"{name}\"")
}

fn unique<'a>(table: &str, names: impl Iterator<Item = &'a str>) -> Result<(), ModelError> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(ModelError::DuplicateName {
                place: item(table, name),
            });
        }
    }
    Ok(())
}

fn node_name(place: &str, name: &str) -> Result<(), ModelError> {
    if name == GROUND || name.trim().is_empty() {
        return Err(ModelError::BadName {
            place: place.into(),
            found: name.into(),
            needed: "\"ground\" is the node that never moves, and a name is not empty",
        });
    }
    Ok(())
}

fn finite(place: &str, quantity: &str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(ModelError::Value {
        place: place.into(),
        quantity: quantity.into(),
        found: value,
        needed: "a finite number",
    })
}

fn check_gain(place: &str, gain: Option<f64>) -> Result<(), ModelError> {
    match gain {
        Some(value) if !value.is_finite() || value == 0.0 => Err(ModelError::Value {
            place: place.into(),
            quantity: "gain".into(),
            found: value,
            needed: "a finite number that is not zero",
        }),
        _ => Ok(()),
    }
}
