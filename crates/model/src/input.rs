//! What drives the plant: the inputs of a model file and their kinds.
//!
//! A kind is a variant of [`InputKind`], its line in `row`, and in `input/in_model.rs` what its `at` may name and what it does to
//! the coordinates. Units of records, refusals and the picture of the model follow.

mod in_model;

use serde::{Deserialize, Serialize};

use crate::BetweenSamples;

/// What an input channel prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputKind {
    /// A force on a mass, N.
    Force,
    /// The displacement of a moving base node, m.
    Displacement,
    /// The command of a valve, share of the full opening.
    Command,
    /// A set point of a block, in the unit of its sum.
    SetPoint,
    /// An input of a simulator of the user's, in SI where the unit of the column has one.
    Signal,
}

impl InputKind {
    /// Every kind.
    pub const ALL: [InputKind; 5] = [
        InputKind::Force,
        InputKind::Displacement,
        InputKind::Command,
        InputKind::SetPoint,
        InputKind::Signal,
    ];

    /// Name in the model file, and SI unit; `1` for what has a unit of its own.
    const fn row(self) -> [&'static str; 2] {
        match self {
            InputKind::Force => ["force", "N"],
            InputKind::Displacement => ["displacement", "m"],
            InputKind::Command => ["command", "1"],
            InputKind::SetPoint => ["set_point", "1"],
            InputKind::Signal => ["signal", "1"],
        }
    }

    /// As the model file calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// SI unit, of translation where rotation uses the same kind.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        self.row()[1]
    }
}

/// What drives the plant, as measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Column of the record.
    pub channel: String,
    /// Force or base displacement.
    pub kind: InputKind,
    /// A mass or a point of a body, the name of the base node, of the valve or of the block, or of the input of a simulator.
    pub at: String,
    /// Model unit per unit of the channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// How well the gain is known: relative standard deviation;
    /// [`DEFAULT_UNCERTAINTY`](crate::DEFAULT_UNCERTAINTY) where none is stated.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_names_are_those_of_the_file() {
        for kind in InputKind::ALL {
            let text = format!("channel = \"u\"\nkind = \"{}\"\nat = \"a\"\n", kind.name());
            let read = toml::from_str::<Input>(&text).map(|input| input.kind);
            assert_eq!(read, Ok(kind));
        }
    }
}
