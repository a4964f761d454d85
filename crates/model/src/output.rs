//! What is compared: the outputs of a model file and their kinds.
//!
//! A kind is a variant of [`OutputKind`], its line in `row`, and in `output/in_model.rs` the row over the state that it reads
//! ([`Reading`](crate::Reading)). Units of records, frequency responses, simulation, initial states and force plots follow.

mod in_model;

use serde::{Deserialize, Serialize};

use crate::Node;

/// What an output channel measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
    /// An output of a simulator of the user's, in SI where the unit of the column has one.
    Signal,
}

impl OutputKind {
    /// Every kind.
    pub const ALL: [OutputKind; 9] = [
        OutputKind::Displacement,
        OutputKind::Velocity,
        OutputKind::Acceleration,
        OutputKind::Force,
        OutputKind::Roll,
        OutputKind::Pressure,
        OutputKind::Spool,
        OutputKind::Flow,
        OutputKind::Signal,
    ];

    /// Name in the model file, and SI unit.
    const fn row(self) -> [&'static str; 2] {
        match self {
            OutputKind::Displacement => ["displacement", "m"],
            OutputKind::Velocity => ["velocity", "m/s"],
            OutputKind::Acceleration => ["acceleration", "m/s^2"],
            OutputKind::Force => ["force", "N"],
            OutputKind::Roll => ["roll", "rad"],
            OutputKind::Pressure => ["pressure", "Pa"],
            OutputKind::Spool => ["spool", "1"],
            OutputKind::Flow => ["flow", "m^3/s"],
            OutputKind::Signal => ["signal", "1"],
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

/// What is compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Column of the record.
    pub channel: String,
    /// The measured quantity.
    pub kind: OutputKind,
    /// The node whose motion is measured, the body, the chamber or the valve; the output of a simulator, where it has another
    /// name than the channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
    /// For a force: the nodes between which the members carry it.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "crate::two::two_or_none"
    )]
    pub between: Option<[String; 2]>,
    /// Model unit per unit of the channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// How well the gain is known: relative standard deviation;
    /// [`DEFAULT_UNCERTAINTY`](crate::DEFAULT_UNCERTAINTY) where none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

/// How an output is read off the state of the plant: what it does with the difference of two nodes,
///
/// ```text
/// x = x_a − x_b,   v = ẋ                                                                              (1)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// a and b of (1).
    pub nodes: [Node; 2],
    /// What is made of x.
    pub form: Form,
}

/// What a [`Reading`] makes of x of (1), unit of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// x.
    Displacement,
    /// v.
    Velocity,
    /// dv/dt.
    Acceleration,
    /// k x + c v, and the force of every law between the two nodes.
    Members {
        /// k, N/m.
        stiffness: f64,
        /// c, N s/m.
        damping: f64,
    },
    /// scale v + offset.
    Rate {
        /// Unit of the output per m/s.
        scale: f64,
        /// Unit of the output.
        offset: f64,
    },
    /// gain x, and what the orifice of the valve with this spool adds at a chamber.
    Orifice {
        /// m³/s per full opening.
        gain: f64,
        /// The pressure of the chamber.
        chamber: Node,
    },
    /// What the simulator answers; nothing of x.
    Signal,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_names_are_those_of_the_file() {
        for kind in OutputKind::ALL {
            let text = format!("channel = \"y\"\nkind = \"{}\"\n", kind.name());
            let read = toml::from_str::<Output>(&text).map(|output| output.kind);
            assert_eq!(read, Ok(kind));
        }
    }
}
