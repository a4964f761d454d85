//! A lumped model: its parts, its nodes and its matrices.

use faer::Mat;

use crate::refuse::item;
use crate::{
    Damper, EffectEntry, Elements, GROUND, Input, InputKind, Law, Load, Mass, ModelError, Node,
    Output, Pendulum, PlantParameter, PlantPort, Spring, StructuralMatrices,
};

/// A lumped model of any number of degrees of freedom, none included.
///
/// ```text
/// M ẍ + C ẋ + K x = F(t) + loads − pendulums − Kb b(t) − Cb ḃ(t)
/// ```
///
/// x are the coordinates in the order of `masses`, b the displacements of the moving base nodes in the order of
/// [`Model::base_nodes`]. Every coordinate has its inertia in `masses`: a mass one, a body two (heave and roll), a
/// beam one for each mode and for a free end. A [`Node`] is a row over the coordinates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// Name of the model.
    pub name: String,
    /// The inertia of each coordinate: masses, then those of bodies and beams, then those that effects add.
    pub masses: Vec<Mass>,
    /// Bodies, beams, cylinders, valves and blocks, whose coordinates are among the masses.
    pub elements: Elements,
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
    /// Parameters of a simulator of the user's.
    pub plant_parameters: Vec<PlantParameter>,
    /// Ports of a simulator of the user's, which are nodes.
    pub ports: Vec<PlantPort>,
    /// Laws of the user's, which effects may have as their kind.
    pub laws: Vec<Law>,
    /// Effects added to the nominal model.
    pub effects: Vec<EffectEntry>,
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
        if let Some(point) = self.body_point(name) {
            return Some(point);
        }
        let bases = self.base_nodes();
        let base = bases.iter().position(|&base| base == name);
        base.map(Node::Base)
            .or_else(|| self.port(name).map(Node::Port))
    }

    /// The place of a coordinate of a name.
    pub(crate) fn dof(&self, name: &str) -> Option<usize> {
        self.masses.iter().position(|mass| mass.name == name)
    }

    /// A coordinate whose inertia follows from its element.
    pub(crate) fn push_coordinate(&mut self, name: String) {
        self.masses.push(Mass {
            name,
            value: 1.0,
            uncertainty: None,
        });
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

    /// Stiffness, N/m, and damping, N s/m, of all members between two nodes, whichever way round they are written.
    #[must_use]
    pub fn stiffness_and_damping(&self, pair: &[String; 2]) -> [f64; 2] {
        let springs = self.springs.iter().filter(|s| same_pair(&s.between, pair));
        let dampers = self.dampers.iter().filter(|d| same_pair(&d.between, pair));
        [
            springs.map(|spring| spring.stiffness).sum(),
            dampers.map(|damper| damper.damping).sum(),
        ]
    }

    /// The place of a channel among the outputs.
    #[must_use]
    pub fn output_index(&self, channel: &str) -> Option<usize> {
        let mut outputs = self.outputs.iter();
        outputs.position(|output| output.channel == channel)
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
        for element in self.elements.each() {
            element.add_matrices(self, &mut matrices)?;
        }
        self.add_signal_matrices(&mut matrices)?;
        Ok(matrices)
    }

    /// As [`Model::matrices`] with the tangent stiffness at rest: each pendulum, `value sin(angle)`, is a
    /// spring of `value` to the ground.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`] when a member or a pendulum names a node that does not exist.
    pub fn tangent_matrices(&self) -> Result<StructuralMatrices, ModelError> {
        let mut matrices = self.matrices()?;
        for pendulum in &self.pendulums {
            let pair = [pendulum.at.clone(), GROUND.to_string()];
            let pair = self.resolve_pair(&pair, || item("pendulum", &pendulum.at))?;
            add_member(&mut matrices.stiffness_matrix, pair, pendulum.value);
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
            if let Some(node) = self.node(&load.at) {
                node.push(load.value, &mut loads);
            }
        }
        for element in self.elements.each() {
            element.add_loads(self, &mut loads);
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
        let ports = self.ports.iter().map(|port| port.name.clone());
        let moving = masses.chain(self.point_names()).chain(bases).chain(ports);
        moving.chain([GROUND.to_string()]).collect()
    }
}

/// Whether two pairs of nodes are the same, whichever way round they are written.
#[must_use]
pub fn same_pair(a: &[String; 2], b: &[String; 2]) -> bool {
    a == b || (a[0] == b[1] && a[1] == b[0])
}

/// Adds `value r rᵀ` with r = row of a − row of b.
fn add_member(matrix: &mut Mat<f64>, [a, b]: [Node; 2], value: f64) {
    let row = || {
        let of_b = b.terms().map(|(i, weight)| (i, -weight));
        a.terms().chain(of_b)
    };
    for (i, of_i) in row() {
        for (j, of_j) in row() {
            matrix[(i, j)] += of_i * of_j * value;
        }
    }
}
