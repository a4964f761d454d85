//! The truth of a case, one line of JSON.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::plan::Role;

/// Another name that no data could tell from the true one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Twin {
    /// Kind.
    pub kind: String,
    /// Place in the form of the contract.
    pub at: Value,
}

/// A true effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Named {
    /// Kind.
    pub kind: String,
    /// Place in the form of the contract.
    pub at: Value,
    /// True values, SI.
    pub parameters: Map<String, Value>,
    /// Other names.
    #[serde(default)]
    pub accept: Vec<Twin>,
}

/// Noise of the records.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TruthNoise {
    /// As a share of the deviation of each channel.
    pub rms_share: f64,
    /// Correlation from sample to sample.
    pub ar1: f64,
    /// Noise of the recorded inputs, as a share of their root mean square.
    pub input_share: f64,
}

/// What is withheld of a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Folder of the case.
    pub name: String,
    /// What the case is about.
    pub role: Role,
    /// `none`, `parameters`, `effect` or `unknown`.
    pub status: String,
    /// True effects of the catalogue.
    pub effects: Vec<Named>,
    /// True causes that the catalogue lacks.
    pub foreign: Vec<Named>,
    /// Small errors of nominal parameters.
    pub deviations: Vec<Named>,
    /// Noise.
    pub noise: TruthNoise,
    /// Gap of the channel that shows the cause most, on the check record.
    pub gap: f64,
    /// Gap of each channel there.
    pub gaps: Vec<f64>,
    /// Kind of machine.
    pub plant: String,
    /// Whether a controller ran.
    pub closed_loop: bool,
    /// Kind of slip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip: Option<String>,
    /// Excitation of each record, the check record last.
    pub excitations: Vec<String>,
}
