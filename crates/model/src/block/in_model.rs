//! What blocks add to the model.

use super::{Block, Signal};
use crate::hydraulics::PRESSURE_UNIT_PA;
use crate::refuse::item;
use crate::{InputKind, Model, ModelError, Node, StructuralMatrices};

impl Model {
    /// Adds a block: its states become coordinates at the end of [`Model::masses`].
    ///
    /// # Errors
    /// [`ModelError::Shape`] for a transfer function that is not proper.
    pub fn add_block(&mut self, block: Block) -> Result<(), ModelError> {
        block.check()?;
        for state in 1..=block.order() {
            self.push_coordinate(block.state_name(state));
        }
        self.blocks.push(block);
        Ok(())
    }

    /// Whether a coordinate is a state of a block.
    pub(crate) fn is_block_state(&self, coordinate: &str) -> bool {
        self.blocks.iter().any(|block| {
            let mut states = 1..=block.order();
            states.any(|state| block.state_name(state) == coordinate)
        })
    }

    fn block(&self, name: &str) -> Option<&Block> {
        self.blocks.iter().find(|block| block.name == name)
    }

    /// Checks what the blocks are joined to.
    pub(crate) fn check_blocks(&self) -> Result<(), ModelError> {
        for block in &self.blocks {
            self.output_of(block, &mut vec![])?;
            if let Some(node) = &block.force {
                self.check_mass(node, &item("block", &block.name))?;
            }
        }
        let orders = self
            .valves
            .iter()
            .filter_map(|valve| Some((valve, valve.from.as_ref()?)));
        for (valve, from) in orders {
            if self.block(from).is_none() {
                return Err(ModelError::Shape {
                    place: item("valve", &valve.name),
                    found: format!("from = \"{from}\""),
                    needed: "the name of a [[block]]".into(),
                });
            }
        }
        Ok(())
    }

    /// The output y of a block, (2); `path` holds the blocks that ask for it without a state between.
    fn output_of(&self, block: &Block, path: &mut Vec<String>) -> Result<Signal, ModelError> {
        if path.contains(&block.name) {
            return Err(ModelError::Shape {
                place: item("block", &block.name),
                found: format!("a loop of blocks without a state: {}", path.join(", ")),
                needed:
                    "a block in the loop whose numerator is of lower degree than its denominator"
                        .into(),
            });
        }
        path.push(block.name.clone());
        let states = block.states();
        let mut output = Signal::default();
        for (k, value) in states.output.iter().enumerate() {
            let state = self.dof(&block.state_name(k + 1));
            output.rate.extend(state.map(|i| (i, *value)));
        }
        if states.through != 0.0 {
            output.add(&self.sum_into(block, path)?, states.through);
        } else {
            // The names are checked even where the sum is not needed.
            for name in block.plus.iter().chain(&block.minus) {
                if self.block(name).is_none() {
                    self.signal(block, name, &mut vec![])?;
                }
            }
        }
        path.pop();
        Ok(output)
    }

    /// The sum e into a block, (1).
    fn sum_into(&self, block: &Block, path: &mut Vec<String>) -> Result<Signal, ModelError> {
        let mut sum = Signal::default();
        let inputs = self.inputs.iter().enumerate();
        let own = inputs.filter(|(_, i)| i.kind == InputKind::SetPoint && i.at == block.name);
        sum.input.extend(own.map(|(i, _)| (i, 1.0)));
        for (names, sign) in [(&block.plus, 1.0), (&block.minus, -1.0)] {
            for name in names {
                sum.add(&self.signal(block, name, path)?, sign);
            }
        }
        Ok(sum)
    }

    /// The signal of a name: a block, a pressure, the displacement of a node.
    fn signal(
        &self,
        asks: &Block,
        name: &str,
        path: &mut Vec<String>,
    ) -> Result<Signal, ModelError> {
        if let Some(block) = self.block(name) {
            return self.output_of(block, path);
        }
        let mut signal = Signal::default();
        match self.node(name) {
            Some(Node::Dof(i)) if self.chamber(name).is_some() => {
                signal.rate.push((i, PRESSURE_UNIT_PA));
            }
            Some(node @ (Node::Dof(_) | Node::Point(_))) => {
                signal.displacement.extend(node.terms());
            }
            _ => {
                return Err(ModelError::UnknownNode {
                    place: item("block", &asks.name),
                    found: name.into(),
                    known: self.signal_names().join(", "),
                });
            }
        }
        Ok(signal)
    }

    fn signal_names(&self) -> Vec<String> {
        let blocks = self.blocks.iter().map(|block| block.name.clone());
        let masses = self.masses.iter().map(|mass| mass.name.clone());
        masses.chain(self.point_names()).chain(blocks).collect()
    }

    /// What acts on a coordinate with a signal: coordinate, weight, signal.
    fn actions(&self) -> Result<Vec<(usize, f64, Signal)>, ModelError> {
        let mut actions = vec![];
        for block in &self.blocks {
            if block.order() > 0 {
                let last = self.dof(&block.state_name(block.order()));
                let sum = self.sum_into(block, &mut vec![])?;
                actions.extend(last.map(|i| (i, block.states().rate, sum)));
            }
            let pushed = block.force.as_ref().and_then(|name| self.node(name));
            if let Some(node) = pushed {
                let output = self.output_of(block, &mut vec![])?;
                actions.extend(node.terms().map(|(i, weight)| (i, weight, output.clone())));
            }
        }
        for valve in &self.valves {
            let from = valve.from.as_ref().and_then(|name| self.block(name));
            if let (Some(block), Some(spool)) = (from, self.dof(&valve.spool())) {
                actions.push((spool, 1.0, self.output_of(block, &mut vec![])?));
            }
        }
        Ok(actions)
    }

    /// Adds the states of the blocks, (3), and what their outputs do.
    pub(crate) fn add_block_matrices(
        &self,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        for block in &self.blocks {
            let states = block.states();
            let dof = |k: usize| self.dof(&block.state_name(k + 1));
            for k in 0..block.order() {
                let Some(i) = dof(k) else {
                    continue;
                };
                matrices.mass_matrix[(i, i)] = 1.0;
                if let Some(next) = dof(k + 1) {
                    matrices.damping_matrix[(i, next)] -= states.rate;
                    continue;
                }
                for (k, value) in states.feedback.iter().enumerate() {
                    if let Some(j) = dof(k) {
                        matrices.damping_matrix[(i, j)] += states.rate * value;
                    }
                }
            }
        }
        for (i, weight, signal) in self.actions()? {
            for (j, value) in signal.displacement {
                matrices.stiffness_matrix[(i, j)] -= weight * value;
            }
            for (j, value) in signal.rate {
                matrices.damping_matrix[(i, j)] -= weight * value;
            }
        }
        Ok(())
    }

    /// What a set point does to the coordinates, by its place among the inputs: coordinate and weight.
    pub(crate) fn set_point_terms(&self, input: usize) -> Result<Vec<(usize, f64)>, ModelError> {
        let mut terms = vec![];
        for (i, weight, signal) in self.actions()? {
            let own = signal.input.iter().filter(|(k, _)| *k == input);
            terms.extend(own.map(|(_, value)| (i, weight * value)));
        }
        Ok(terms)
    }
}
