//! A plant that this crate knows from outside only: what a simulator of the user's takes and gives.
//!
//! The model file names the signals of the simulator (inputs and outputs of the kind `signal`), its parameters and the ports where
//! forces can act. There are no masses then: the motion is the simulator's answer.

mod in_model;

use serde::{Deserialize, Serialize};

/// A parameter of the simulator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantParameter {
    /// As the simulator calls it; unique among parameters.
    pub name: String,
    /// Nominal value, in the unit of the simulator; finite.
    pub value: f64,
    /// How well the value is known: relative standard deviation;
    /// [`DEFAULT_UNCERTAINTY`](crate::DEFAULT_UNCERTAINTY) where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// A place of the simulator where a force can act, and whose motion it tells. It is a node of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantPort {
    /// As the simulator calls the force there, N or N m; unique among nodes.
    pub name: String,
    /// The output of the simulator that is the displacement of the port, m or rad. It need not be measured.
    pub displacement: String,
    /// The output of the simulator that is its velocity, m/s or rad/s.
    pub velocity: String,
}
