//! What the model asks of all its elements.

use super::{Elements, for_elements};
use crate::element::Element;
use crate::{CoordinateKind, Drawing, Model, ModelError, Spring, StructuralMatrices};

/// Step of the central differences over a value: what it leaves is 1e-10 of the derivative, and rounding as much.
const STEP: f64 = 1e-5;

macro_rules! each {
    ($($(#[$doc:meta])* $list:ident: $Kind:ident { $($table:ident: $File:ty),* })*) => {
        impl Elements {
            /// Every element, kind by kind.
            pub(crate) fn each(&self) -> impl Iterator<Item = &dyn Element> {
                let all = std::iter::empty::<&dyn Element>();
                $(let all = all.chain(self.$list.iter().map(|one| one as &dyn Element));)*
                all
            }

            fn each_mut(&mut self) -> impl Iterator<Item = &mut dyn Element> {
                let all = std::iter::empty::<&mut dyn Element>();
                $(let all = all.chain(self.$list.iter_mut().map(|one| one as &mut dyn Element));)*
                all
            }
        }
    };
}

for_elements!(each);

impl Model {
    /// What a coordinate of an element is; `None` for a mass.
    #[must_use]
    pub fn coordinate_kind(&self, coordinate: &str) -> Option<CoordinateKind> {
        let mut own = self
            .elements
            .each()
            .flat_map(|element| element.coordinates());
        own.find_map(|(name, kind)| (name == coordinate).then_some(kind))
    }

    /// Whether a coordinate is the roll of a body, an angle where its other coordinates are displacements.
    #[must_use]
    pub fn is_roll(&self, coordinate: &str) -> bool {
        self.coordinate_kind(coordinate) == Some(CoordinateKind::Roll)
    }

    /// Of each coordinate whether only its rate counts: a pressure or a state of a block, an equation of first order.
    #[must_use]
    pub fn first_order(&self) -> Vec<bool> {
        let kinds = self
            .masses
            .iter()
            .map(|mass| self.coordinate_kind(&mass.name));
        kinds
            .map(|kind| matches!(kind, Some(CoordinateKind::Rate { .. })))
            .collect()
    }

    /// Whether a coordinate is no place on the machine: a mode of a beam, a pressure, a spool, a state of a block.
    #[must_use]
    pub fn is_internal(&self, coordinate: &str) -> bool {
        let kind = self.coordinate_kind(coordinate);
        kind.is_some_and(CoordinateKind::is_internal)
    }

    /// Whether a coordinate is a pressure, a spool or a state of a block, whose sizes are not those of the motion.
    #[must_use]
    pub fn has_own_scale(&self, coordinate: &str) -> bool {
        let kind = self.coordinate_kind(coordinate);
        kind.is_some_and(CoordinateKind::has_own_scale)
    }

    /// Whether the inertia of a coordinate is a value of the model file.
    pub(crate) fn has_stated_inertia(&self, coordinate: &str) -> bool {
        let kind = self.coordinate_kind(coordinate);
        kind.is_none_or(CoordinateKind::has_stated_inertia)
    }

    /// Whether a spring is part of an element, such as the static stiffness of a beam.
    #[must_use]
    pub fn is_of_element(&self, spring: &Spring) -> bool {
        let mut springs = self.elements.each().filter_map(|element| element.spring());
        springs.any(|name| name == spring.name)
    }

    /// Mass that couples each coordinate to the acceleration of each moving base through the elements, kg: coordinate, base,
    /// value.
    #[must_use]
    pub fn base_inertia(&self) -> Vec<(usize, usize, f64)> {
        let each = self.elements.each();
        each.flat_map(|element| element.base_inertia(self))
            .collect()
    }

    /// Pairs of names that move or drive each other: the ends of members, and what elements join.
    #[must_use]
    pub fn joined(&self) -> Vec<[String; 2]> {
        let each = self.elements.each();
        let joined = each.flat_map(|element| element.joined(self));
        self.members().into_iter().chain(joined).collect()
    }

    /// The name of each element and how a picture shows it.
    #[must_use]
    pub fn drawings(&self) -> Vec<(String, Drawing)> {
        let each = self.elements.each();
        each.map(|element| (element.name().to_owned(), element.drawing(self)))
            .collect()
    }

    /// The values of elements that matrices depend on and that are not zero: the place of the element among all, that of the
    /// value among its own.
    pub(crate) fn element_values(&self) -> Vec<[usize; 2]> {
        let mut found = vec![];
        for (i, element) in self.elements.each().enumerate() {
            let values = element.values(self).into_iter().enumerate();
            let values = values.filter(|(_, (_, value))| *value != 0.0);
            found.extend(values.map(|(k, _)| [i, k]));
        }
        found
    }

    /// Name and size of a value of an element, by their places; `None` where the model has no such value.
    pub(crate) fn element_value(
        &self,
        [element, value]: [usize; 2],
    ) -> Option<(&'static str, f64)> {
        let element = self.elements.each().nth(element)?;
        element.values(self).get(value).copied()
    }

    /// Table and item of a value of an element.
    pub(crate) fn element_value_name(&self, place: [usize; 2]) -> String {
        let element = self.elements.each().nth(place[0]);
        let (table, name) = element.map_or(("element", ""), |e| (e.table(), e.name()));
        let value = self.element_value(place).map_or("", |(name, _)| name);
        format!("{table} \"{name}\" {value}")
    }

    /// The model with a value of an element multiplied, by the places of [`Parameter::Element`](crate::Parameter::Element).
    #[must_use]
    pub fn with_element_value(&self, place: [usize; 2], factor: f64) -> Model {
        let mut model = self.clone();
        let own = model.elements.each_mut().nth(place[0]);
        if let (Some(own), Some((value, _))) = (own, self.element_value(place)) {
            own.scale(value, factor);
        }
        model
    }

    /// ∂M/∂p, ∂C/∂p and ∂K/∂p of a value of an element; the linearisation goes with it.
    pub(crate) fn element_derivative(
        &self,
        place: [usize; 2],
    ) -> Result<Option<StructuralMatrices>, ModelError> {
        let element = self.elements.each().nth(place[0]);
        let value = self.element_value(place).filter(|(_, at)| *at != 0.0);
        let (Some(element), Some((value, at))) = (element, value) else {
            return Ok(None);
        };
        if let Some(closed) = element.derivative(self, value) {
            return Ok(Some(closed));
        }
        let of = |factor: f64| self.with_element_value(place, factor).matrices();
        let (mut high, low) = (of(1.0 + STEP)?, of(1.0 - STEP)?);
        let scale = faer::Scale(0.5 / (STEP * at));
        for (high, low) in [
            (&mut high.mass_matrix, low.mass_matrix),
            (&mut high.damping_matrix, low.damping_matrix),
            (&mut high.stiffness_matrix, low.stiffness_matrix),
        ] {
            *high -= low;
            *high *= scale;
        }
        Ok(Some(high))
    }
}
