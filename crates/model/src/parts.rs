//! The parts a lumped model is made of, as the model file names them.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// The node that never moves.
pub const GROUND: &str = "ground";

/// A point mass, kg, or an inertia, kg m². One degree of freedom each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mass {
    /// Unique node name.
    pub name: String,
    /// kg or kg m², positive.
    pub value: f64,
    /// How well the value is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// A linear spring: force `k (x_a − x_b)` between two nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Unique among springs.
    pub name: String,
    /// The two nodes a and b.
    #[serde(deserialize_with = "crate::two::two")]
    pub between: [String; 2],
    /// k, N/m or N m/rad.
    pub stiffness: f64,
    /// How well the stiffness is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// A linear damper: force `c (v_a − v_b)` between two nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damper {
    /// Unique among dampers.
    pub name: String,
    /// The two nodes a and b.
    #[serde(deserialize_with = "crate::two::two")]
    pub between: [String; 2],
    /// c, N s/m or N m s/rad.
    pub damping: f64,
    /// How well the damping is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// A known constant force, N, such as weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The mass it acts on.
    pub at: String,
    /// N or N m.
    pub value: f64,
    /// How well the value is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// Gravity on an arm: torque `−value sin(angle)`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pendulum {
    /// The inertia it acts on.
    pub at: String,
    /// m g l, N m.
    pub value: f64,
    /// How well the value is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// Where in the plant or in the measurement chain something sits.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Location {
    /// Between two nodes.
    Between([String; 2]),
    /// On one mass.
    Mass(String),
    /// In the path of an input channel.
    Input(String),
    /// In the path of an output channel.
    Channel(String),
    /// A parameter of a simulator.
    Parameter(String),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Location::Between([a, b]) => write!(f, "between {a} and {b}"),
            Location::Mass(m) => write!(f, "mass {m}"),
            Location::Input(c) => write!(f, "input {c}"),
            Location::Channel(c) => write!(f, "channel {c}"),
            Location::Parameter(p) => write!(f, "parameter {p}"),
        }
    }
}

/// An effect as the model file writes it: a kind, a place and numbers. The catalogue of effects
/// gives them meaning; this crate only carries them.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectEntry {
    /// Catalogue name, such as `coulomb_friction`.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Parameters by name, SI units.
    pub parameters: BTreeMap<String, f64>,
}

/// Relative standard deviation of a nominal value whose part states no `uncertainty`.
pub const DEFAULT_UNCERTAINTY: f64 = 0.02;

/// Largest relative standard deviation that a part may state.
pub(crate) const LARGEST_UNCERTAINTY: f64 = 10.0;
