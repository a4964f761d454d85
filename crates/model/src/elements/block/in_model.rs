//! What blocks add to the model.

use super::{Block, Signal};
use crate::element::{Element, Table};
use crate::refuse::item;
use crate::{CoordinateKind, Drawing, InputKind, Model, ModelError, Node, StructuralMatrices};

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
        self.elements.blocks.push(block);
        Ok(())
    }

    pub(crate) fn block(&self, name: &str) -> Option<&Block> {
        self.elements.blocks.iter().find(|block| block.name == name)
    }

    /// The output y of a block, (2).
    pub(crate) fn output_of(&self, block: &Block) -> Result<Signal, ModelError> {
        self.output_along(block, &mut vec![])
    }

    /// As [`Model::output_of`]; `path` holds the blocks that ask for it without a state between.
    fn output_along(&self, block: &Block, path: &mut Vec<String>) -> Result<Signal, ModelError> {
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
            return self.output_along(block, path);
        }
        let mut signal = Signal::default();
        match (self.node(name), self.coordinate_kind(name)) {
            (Some(Node::Dof(i)), Some(CoordinateKind::Rate { unit })) => {
                signal.rate.push((i, unit))
            }
            (Some(node @ (Node::Dof(_) | Node::Point(_))), _) => {
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
        let blocks = self.elements.blocks.iter().map(|block| block.name.clone());
        let masses = self.masses.iter().map(|mass| mass.name.clone());
        masses.chain(self.point_names()).chain(blocks).collect()
    }

    /// The signals that push coordinates: coordinate, weight, signal.
    fn actions(&self) -> Result<Vec<(usize, f64, Signal)>, ModelError> {
        let each = self.elements.each().map(|element| element.actions(self));
        let each = each.collect::<Result<Vec<_>, _>>()?;
        Ok(each.into_iter().flatten().collect())
    }

    /// Adds to C and K what signals do to coordinates.
    pub(crate) fn add_signal_matrices(
        &self,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
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

impl Table for Block {
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        model.add_block(self)
    }

    fn all_of(model: &Model) -> Vec<Block> {
        model.elements.blocks.clone()
    }
}

impl Element for Block {
    fn table(&self) -> &'static str {
        "block"
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn coordinates(&self) -> Vec<(String, CoordinateKind)> {
        let rate = CoordinateKind::Rate { unit: 1.0 };
        let states = 1..=self.order();
        states.map(|state| (self.state_name(state), rate)).collect()
    }

    fn check(&self, model: &Model) -> Result<(), ModelError> {
        model.output_of(self)?;
        match &self.force {
            Some(node) => model.check_mass(node, &item("block", &self.name)),
            None => Ok(()),
        }
    }

    /// Adds the states, (3).
    fn add_matrices(
        &self,
        model: &Model,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let states = self.states();
        let dof = |k: usize| model.dof(&self.state_name(k + 1));
        for k in 0..self.order() {
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
        Ok(())
    }

    /// What goes into the last state, and the force on a node.
    fn actions(&self, model: &Model) -> Result<Vec<(usize, f64, Signal)>, ModelError> {
        let mut actions = vec![];
        if self.order() > 0 {
            let last = model.dof(&self.state_name(self.order()));
            let sum = model.sum_into(self, &mut vec![])?;
            actions.extend(last.map(|i| (i, self.states().rate, sum)));
        }
        let pushed = self.force.as_ref().and_then(|name| model.node(name));
        if let Some(node) = pushed {
            let output = model.output_of(self)?;
            actions.extend(node.terms().map(|(i, weight)| (i, weight, output.clone())));
        }
        Ok(actions)
    }

    fn joined(&self, _: &Model) -> Vec<[String; 2]> {
        let signals = self.plus.iter().chain(&self.minus).chain(&self.force);
        signals
            .map(|signal| [self.name.clone(), signal.clone()])
            .collect()
    }

    fn drawing(&self, _: &Model) -> Drawing {
        let plus = self.plus.iter().map(|name| ("+", name.clone()));
        let minus = self.minus.iter().map(|name| ("\u{2212}", name.clone()));
        let force = self.force.iter();
        Drawing::Box {
            signals: plus.chain(minus).collect(),
            lines: force.map(|node| format!("force on {node}")).collect(),
            measured: vec![],
            is_last: false,
        }
    }

    fn values(&self, _: &Model) -> Vec<(&'static str, f64)> {
        vec![("gain", 1.0)]
    }

    /// A factor on the numerator.
    fn scale(&mut self, _: &str, factor: f64) {
        self.numerator.iter_mut().for_each(|c| *c *= factor);
    }
}
