//! What a coordinate of an element is.

/// What a coordinate of an element is to those who ask for places, sizes and states. A coordinate of no element is a mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoordinateKind {
    /// The displacement of a body: its inertia is stated.
    Place,
    /// The angle of a body: its moment of inertia is stated.
    Roll,
    /// A place whose inertia follows from the element, as that of the free end of a beam.
    End,
    /// A shape: no place on the machine, in the sizes of its motion.
    Shape,
    /// No place, in a size of its own: the position of a spool.
    Signal,
    /// A state of first order, of which only the rate counts: `unit` times the rate is the pressure or the signal.
    Rate {
        /// SI.
        unit: f64,
    },
}

impl CoordinateKind {
    /// Whether its inertia is a value of the model file.
    #[must_use]
    pub fn has_stated_inertia(self) -> bool {
        matches!(self, Self::Place | Self::Roll)
    }

    /// Whether it is no place on the machine.
    #[must_use]
    pub fn is_internal(self) -> bool {
        matches!(self, Self::Shape | Self::Signal | Self::Rate { .. })
    }

    /// Whether its sizes are not those of the motion.
    #[must_use]
    pub fn has_own_scale(self) -> bool {
        matches!(self, Self::Signal | Self::Rate { .. })
    }
}
