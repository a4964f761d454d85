//! What the model asks of an element of the model file: the one interface between them.

use crate::elements::block::Signal;
use crate::{CoordinateKind, Drawing, Model, ModelError, StructuralMatrices};

/// A table of the model file that stands for an element or for a part of one.
pub(crate) trait Table: Sized {
    /// Adds what the table says to a model: its coordinates to the end of [`Model::masses`], itself to its list in
    /// [`Model::elements`].
    fn add_to(self, model: &mut Model) -> Result<(), ModelError>;

    /// The tables that say what a model holds.
    fn all_of(model: &Model) -> Vec<Self>;
}

/// An element in a model. What has a default is for elements that add something of it.
pub(crate) trait Element {
    /// Its table in the model file.
    fn table(&self) -> &'static str;

    fn name(&self) -> &str;

    /// Its coordinates, by their names among [`Model::masses`].
    fn coordinates(&self) -> Vec<(String, CoordinateKind)>;

    /// Checks what it is joined to, once the model is whole.
    fn check(&self, model: &Model) -> Result<(), ModelError> {
        let _ = model;
        Ok(())
    }

    /// Adds to M, C and K what the lists of masses, springs and dampers do not hold of it.
    fn add_matrices(
        &self,
        model: &Model,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let _ = (model, matrices);
        Ok(())
    }

    /// Adds its constant forces.
    fn add_loads(&self, model: &Model, loads: &mut [f64]) {
        let _ = (model, loads);
    }

    /// Mass that couples a coordinate to the acceleration of a moving base, kg: coordinate, base, value.
    fn base_inertia(&self, model: &Model) -> Vec<(usize, usize, f64)> {
        let _ = model;
        vec![]
    }

    /// The signals that push coordinates: coordinate, weight, signal.
    fn actions(&self, model: &Model) -> Result<Vec<(usize, f64, Signal)>, ModelError> {
        let _ = model;
        Ok(vec![])
    }

    /// Name of the spring among [`Model::springs`] that is part of it.
    fn spring(&self) -> Option<&str> {
        None
    }

    /// Pairs of names that move or drive each other through it.
    fn joined(&self, model: &Model) -> Vec<[String; 2]>;

    /// How a picture shows it.
    fn drawing(&self, model: &Model) -> Drawing;

    /// The values that its matrices depend on, as the model file calls them: for sensitivities.
    fn values(&self, model: &Model) -> Vec<(&'static str, f64)> {
        let _ = model;
        vec![]
    }

    /// Multiplies one of its values.
    fn scale(&mut self, value: &str, factor: f64) {
        let _ = (value, factor);
    }

    /// ∂M/∂p, ∂C/∂p and ∂K/∂p of one of its values in closed form; by differences over [`Element::scale`] where there is
    /// none.
    fn derivative(&self, model: &Model, value: &str) -> Option<StructuralMatrices> {
        let _ = (model, value);
        None
    }
}
