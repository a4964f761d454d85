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
    pub between: [String; 2],
    /// c, N s/m or N m s/rad.
    pub damping: f64,
    /// How well the damping is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// What an input channel prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InputKind {
    /// A force on a mass, N.
    Force,
    /// The displacement of a moving base node, m.
    Displacement,
    /// The command of a valve, share of the full opening.
    Command,
    /// A set point of a block, in the unit of its sum.
    #[serde(rename = "set_point")]
    SetPoint,
}

/// What drives the plant, as measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Column of the record.
    pub channel: String,
    /// Force or base displacement.
    pub kind: InputKind,
    /// A mass or a point of a body, the name of the base node, of the valve or of the block.
    pub at: String,
    /// Model unit per unit of the channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// How well the gain is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// What it does between the samples; where nothing is stated a diagnosis decides by the records, and a simulation
    /// reads a smooth curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_samples: Option<BetweenSamples>,
}

impl Input {
    /// Whether it may jump, or bend: what moves a node may not.
    #[must_use]
    pub fn may_jump(&self) -> bool {
        self.kind != InputKind::Displacement
    }

    /// What it does between the samples, as stated or smooth.
    #[must_use]
    pub fn between_samples(&self) -> BetweenSamples {
        self.between_samples.unwrap_or(BetweenSamples::Smooth)
    }
}

/// What an input does between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BetweenSamples {
    /// It follows a smooth curve through the samples, as what was measured does.
    Smooth,
    /// It goes in straight lines from sample to sample (first-order hold).
    Linear,
    /// It keeps the value of a sample until the next one, as what a converter puts out does (zero-order hold).
    Held,
}

/// What an output channel measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OutputKind {
    /// m or rad.
    Displacement,
    /// m/s or rad/s.
    Velocity,
    /// m/s² or rad/s².
    Acceleration,
    /// The force carried by the members between two nodes, N or N m.
    Force,
    /// The angle of a body, rad.
    Roll,
    /// The pressure of a chamber, Pa.
    Pressure,
    /// The position of the spool of a valve, share of the full opening.
    Spool,
    /// The flow from the valves into a chamber, m³/s.
    Flow,
}

/// What is compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Column of the record.
    pub channel: String,
    /// The measured quantity.
    pub kind: OutputKind,
    /// The node whose motion is measured, the body, the chamber or the valve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
    /// For a force: the nodes between which the members carry it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// Model unit per unit of the channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// How well the gain is known: relative standard deviation; [`DEFAULT_UNCERTAINTY`] where none is stated.
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
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Location::Between([a, b]) => write!(f, "between {a} and {b}"),
            Location::Mass(m) => write!(f, "mass {m}"),
            Location::Input(c) => write!(f, "input {c}"),
            Location::Channel(c) => write!(f, "channel {c}"),
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
