//! Which rows and columns of Φ, Γ₀ and Γ₁ do anything.

use simgap_model::Node;

use super::law::Element;
use super::propagator::ExactPropagator;

/// The rows and columns that do anything. The integral of a pressure moves nothing but itself and is read by nobody, and most
/// coordinates of a hydraulic axis are driven by no input and no element.
pub(super) struct Columns {
    /// Entries of the state that are computed; the others stay where they are.
    pub(super) rows: Vec<usize>,
    /// Entries of the state that move something.
    pub(super) moving: Vec<usize>,
    /// Coordinates that an input or an element pushes.
    pub(super) pushed: Vec<usize>,
    /// Those that an element pushes.
    pub(super) joined: Vec<usize>,
}

impl Columns {
    /// Of propagators with elements at the same ports, under forces on the coordinates (samples × n, row-major), where
    /// `is_read` says of which coordinates the displacement is looked at.
    pub(super) fn new(
        propagators: &[&ExactPropagator],
        elements: &[Element],
        forces: &[&[f64]],
        is_read: &dyn Fn(usize) -> bool,
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
        let sees = |j: usize| {
            let nodes = elements
                .iter()
                .flat_map(|element| element.port.displacement);
            is_read(j) || nodes.flat_map(Node::terms).any(|(i, _)| i == j)
        };
        let moves = |j: usize, i: usize| {
            let entry = |p: &&ExactPropagator| p.phi[i * 2 * n + j] != 0.0;
            propagators.iter().any(entry)
        };
        let moves_others = |j: usize| (0..2 * n).any(|i| i != j && moves(j, i));
        let is_kept = |j: &usize| *j >= n || sees(*j) || moves_others(*j);
        let rows: Vec<usize> = (0..2 * n).filter(is_kept).collect();
        let moving = rows.iter().copied();
        let moving = moving.filter(|j| moves(*j, *j) || moves_others(*j));
        let list = |is: &[bool]| -> Vec<usize> { (0..n).filter(|i| is[*i]).collect() };
        Columns {
            moving: moving.collect(),
            rows,
            pushed: list(&is_pushed),
            joined: list(&is_joined),
        }
    }

    /// Entry of [Γ₀ Γ₁ Φ] over `rows` and the columns of `pushed`, of `pushed` again and of `moving`.
    pub(super) fn step_entry(&self, of: &ExactPropagator, row: usize, column: usize) -> f64 {
        let (n, k, row) = (of.dof_count, self.pushed.len(), self.rows[row]);
        if column < k {
            of.gamma0[row * n + self.pushed[column]]
        } else if column < 2 * k {
            of.gamma1[row * n + self.pushed[column - k]]
        } else {
            of.phi[row * 2 * n + self.moving[column - 2 * k]]
        }
    }

    /// Entry of Γ₁ over `rows` and the columns of `joined`.
    pub(super) fn end_entry(&self, of: &ExactPropagator, row: usize, column: usize) -> f64 {
        of.gamma1[self.rows[row] * of.dof_count + self.joined[column]]
    }

    /// As [`Columns::end_entry`] of Γ₀ + Γ₁.
    pub(super) fn held_entry(&self, of: &ExactPropagator, row: usize, column: usize) -> f64 {
        let at = self.rows[row] * of.dof_count + self.joined[column];
        of.gamma0[at] + of.gamma1[at]
    }
}
