//! The elements of the model file, and their list.

mod beam;
pub(crate) mod block;
pub(crate) mod body;
pub(crate) mod hydraulics;
mod in_model;

pub use beam::Beam;
pub use block::Block;
pub use body::{Body, Point};
pub use hydraulics::{Cylinder, Edges, PRESSURE_UNIT_PA, Valve};

/// The one list of elements: hands every kind to a macro, as its list in [`Elements`], its type, and its tables in the model file.
/// Coordinates, tables and parameters are in this order.
macro_rules! for_elements {
    ($then:ident) => {
        $then! {
            /// Rigid bodies and their points.
            bodies: Body { body: crate::elements::body::file::BodyFile, point: crate::elements::body::file::PointFile }
            /// Beams, whose static stiffness is among the springs.
            beams: Beam { beam: crate::Beam }
            /// Cylinders, whose pressures are rates of coordinates.
            cylinders: Cylinder { cylinder: crate::Cylinder }
            /// Valves, whose spools are coordinates.
            valves: Valve { valve: crate::Valve }
            /// Controllers, filters and sensors, whose states are rates of coordinates.
            blocks: Block { block: crate::Block }
        }
    };
}
pub(crate) use for_elements;

macro_rules! declare {
    ($($(#[$doc:meta])* $list:ident: $Kind:ident { $($table:ident: $File:ty),* })*) => {
        /// The elements of a model, kind by kind: what is more than masses, springs and dampers. Their coordinates are among
        /// [`Model::masses`](crate::Model::masses).
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Elements {
            $($(#[$doc])* pub $list: Vec<$Kind>,)*
        }
    };
}

for_elements!(declare);
