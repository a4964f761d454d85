//! Which columns of Φ, Γ₀ and Γ₁ do anything.

use simgap_model::Node;

use super::law::Element;
use super::propagator::ExactPropagator;

/// The columns that do anything. The others hold zeros or stand for what is never pushed: the integral of a pressure moves
/// nothing, most coordinates of a hydraulic axis are driven by no input and no element.
pub(super) struct Columns {
    /// Entries of the state that move something.
    pub(super) moving: Vec<usize>,
    /// Coordinates that an input or an element pushes.
    pub(super) pushed: Vec<usize>,
    /// Those that an element pushes.
    pub(super) joined: Vec<usize>,
}

impl Columns {
    /// Of propagators with elements at the same ports, under forces on the coordinates (samples × n, row-major).
    pub(super) fn new(
        propagators: &[&ExactPropagator],
        elements: &[Element],
        forces: &[&[f64]],
    ) -> Columns {
        let n = propagators.first().map_or(0, |p| p.dof_count);
        let mut is_joined = vec![false; n];
        let nodes = elements.iter().flat_map(|element| element.port.force);
        for (i, _) in nodes.flat_map(Node::terms) {
            is_joined[i] = true;
        }
        let mut is_pushed = is_joined.clone();
        for (k, force) in forces.iter().enumerate() {
            // Sets of a batch share what drives them.
            if n == 0 || forces[..k].iter().any(|known| std::ptr::eq(*known, *force)) {
                continue;
            }
            for row in force.chunks_exact(n) {
                for (pushed, force) in is_pushed.iter_mut().zip(row) {
                    *pushed |= *force != 0.0;
                }
            }
        }
        let moves = |p: &ExactPropagator, j: usize| (0..2 * n).any(|i| p.phi[i * 2 * n + j] != 0.0);
        let moving = (0..2 * n).filter(|j| propagators.iter().any(|p| moves(p, *j)));
        let list = |is: &[bool]| -> Vec<usize> { (0..n).filter(|i| is[*i]).collect() };
        Columns {
            moving: moving.collect(),
            pushed: list(&is_pushed),
            joined: list(&is_joined),
        }
    }

    /// Entry of [Γ₀ Γ₁ Φ] over the columns of `pushed`, of `pushed` again and of `moving`.
    pub(super) fn step_entry(&self, of: &ExactPropagator, row: usize, column: usize) -> f64 {
        let (n, k) = (of.dof_count, self.pushed.len());
        if column < k {
            of.gamma0[row * n + self.pushed[column]]
        } else if column < 2 * k {
            of.gamma1[row * n + self.pushed[column - k]]
        } else {
            of.phi[row * 2 * n + self.moving[column - 2 * k]]
        }
    }
}
