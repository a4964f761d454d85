//! A node of a model: a row over its coordinates.

/// A node of the model, resolved: its displacement is a row over the coordinates of the plant.
///
/// ```text
/// x_node = rᵀ q        ẋ_node = rᵀ q̇        a force F on the node pushes the coordinates with r F       (1)
/// ```
///
/// | Node | Row r |
/// |---|---|
/// | ground | zero |
/// | a coordinate i (a mass, the heave or the roll of a body) | 1 at i |
/// | a point of a body, off its centre of mass by `arm` | 1 at the heave, `arm` at the roll |
/// | a moving base | zero over the coordinates: its displacement is prescribed |
/// | a port of a simulator | zero over the coordinates: there are none |
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Node {
    /// Never moves.
    Ground,
    /// A coordinate, index into [`crate::Model::masses`].
    Dof(usize),
    /// Moving base, index into [`crate::Model::base_nodes`].
    Base(usize),
    /// A point of a rigid body.
    Point(BodyPoint),
    /// A port of a simulator, index into [`crate::Model::ports`]: its motion is the simulator's answer.
    Port(usize),
}

/// A point of a rigid body: y = heave + arm roll, for small angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyPoint {
    /// Coordinate of the heave, index into [`crate::Model::masses`].
    pub heave: usize,
    /// Coordinate of the roll.
    pub roll: usize,
    /// The arm by its bits, so that nodes can be compared and sorted.
    arm_bits: u64,
}

impl BodyPoint {
    /// A point `arm_m` (m, finite) from the centre of mass.
    #[must_use]
    pub fn new(heave: usize, roll: usize, arm_m: f64) -> BodyPoint {
        BodyPoint {
            heave,
            roll,
            arm_bits: arm_m.to_bits(),
        }
    }

    /// Distance from the centre of mass, m, of either sign.
    #[inline(always)]
    #[must_use]
    pub fn arm_m(self) -> f64 {
        f64::from_bits(self.arm_bits)
    }
}

impl Node {
    /// The entries of the row that are not zero: coordinate and weight.
    pub fn terms(self) -> impl Iterator<Item = (usize, f64)> {
        let [first, second] = match self {
            Node::Ground | Node::Base(_) | Node::Port(_) => [None, None],
            Node::Dof(i) => [Some((i, 1.0)), None],
            Node::Point(point) => [Some((point.heave, 1.0)), Some((point.roll, point.arm_m()))],
        };
        first.into_iter().chain(second)
    }

    /// Displacement, velocity or acceleration of the node, (1), from those of the coordinates and of the bases.
    #[inline(always)]
    #[must_use]
    pub fn of(self, dofs: &[f64], bases: &[f64]) -> f64 {
        match self {
            Node::Ground | Node::Port(_) => 0.0,
            Node::Dof(i) => dofs[i],
            Node::Base(i) => bases[i],
            Node::Point(point) => dofs[point.heave] + point.arm_m() * dofs[point.roll],
        }
    }

    /// Adds what a force on the node does to the coordinates, (1).
    #[inline(always)]
    pub fn push(self, force: f64, dof_force: &mut [f64]) {
        match self {
            Node::Ground | Node::Base(_) | Node::Port(_) => {}
            Node::Dof(i) => dof_force[i] += force,
            Node::Point(point) => {
                dof_force[point.heave] += force;
                dof_force[point.roll] += point.arm_m() * force;
            }
        }
    }
}
