//! An answer of the program, as far as the score needs it.

use serde::Deserialize;
use serde_json::Value;

/// `diagnosis.json`.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Diagnosis {
    /// Gap figures.
    #[serde(default)]
    pub gap: Gap,
    /// What is said.
    pub verdict: Verdict,
}

/// Gap figures.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
pub struct Gap {
    /// As given.
    pub nominal: Option<f64>,
    /// Parameters re-estimated.
    pub recalibrated: Option<f64>,
    /// Corrected.
    pub corrected: Option<f64>,
    /// Noise.
    pub noise_floor: Option<f64>,
}

/// What is said.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Verdict {
    /// `none`, `parameters`, `effect` or `unknown`.
    pub status: String,
    /// Whether nothing but noise is left.
    #[serde(default)]
    pub complete: Option<bool>,
    /// What is named.
    #[serde(default)]
    pub effects: Vec<Said>,
}

/// A named effect.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Said {
    /// Kind.
    pub kind: String,
    /// Place.
    pub at: Value,
    /// Stated probability.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Values.
    #[serde(default)]
    pub parameters: Vec<Parameter>,
    /// What these data cannot tell from it.
    #[serde(default)]
    pub indistinguishable: Vec<Other>,
}

/// A value with its interval.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Value.
    pub value: Option<f64>,
    /// Interval.
    #[serde(default)]
    pub ci95: Option<[Option<f64>; 2]>,
}

/// Another name.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct Other {
    /// Kind.
    pub kind: String,
    /// Place.
    pub at: Value,
}

/// Whether two places are the same, the order of nodes aside.
#[must_use]
pub fn same_place(a: &Value, b: &Value) -> bool {
    let sorted = |v: &Value| -> Option<Vec<String>> {
        let pair = v.get("between")?.as_array()?;
        let mut names: Vec<String> = pair
            .iter()
            .map(|n| n.as_str().unwrap_or("").to_owned())
            .collect();
        names.sort();
        Some(names)
    };
    match (sorted(a), sorted(b)) {
        (Some(a), Some(b)) => a == b,
        _ => a == b,
    }
}
