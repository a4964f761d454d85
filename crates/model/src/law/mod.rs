//! A law of the user's: a force across a member as an expression in the model file.

mod check;
mod expression;
pub(crate) mod file;
mod parse;
mod text;

use serde::{Deserialize, Serialize};

pub use expression::{Expression, Function, Operation, Symbol};

/// A force across a member as an expression of displacement, velocity and time.
///
/// ```text
/// F = force(d, v, t; parameters)
/// ```
///
/// | Symbol | Meaning | Unit |
/// |---|---|---|
/// | d | displacement of the first node from the second | m or rad |
/// | v | rate of d | m/s or rad/s |
/// | t | time of the record | s |
/// | F | force that resists a positive d, as that of a spring `k d` and a damper `c v`: it pushes the first node with −F, the second with +F | N or N m |
///
/// The model carries it as it is written; the catalogue of effects one floor up gives it a meaning.
///
/// ```
/// use simgap_model::{Law, LawParameter};
///
/// let law = Law {
///     name: "grease".into(),
///     summary: None,
///     between: vec![],
///     force: "c * tanh(v / v0)".into(),
///     parameters: vec![
///         LawParameter::of_size("c", "N", 20.0),
///         LawParameter::of_size("v0", "m/s", 0.05),
///     ],
/// };
/// assert!(law.expression().is_ok());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// The kind that an effect of it has: a lower-case letter, then lower-case letters, digits and `_`; unique among laws.
    pub name: String,
    /// What it is, in one sentence for reports.
    pub summary: Option<String>,
    /// The places where it may sit, pairs of nodes; empty for every member.
    pub between: Vec<[String; 2]>,
    /// The expression of the force, N or N m.
    pub force: String,
    /// Its parameters, each of which the expression reads.
    pub parameters: Vec<LawParameter>,
}

/// A parameter of a law, and what is known of it before any data: `usual`, `value` with `uncertainty`, or `lower` with
/// `upper`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawParameter {
    /// Name in the expression and in effects: letters, digits and `_`.
    pub name: String,
    /// Unit, as reports write it; `1` for a pure number.
    pub unit: String,
    /// Usual size, not zero: the median of a log-normal prior, 95 % of which lies within a factor of twenty. The parameter has
    /// the sign of it, unless `lower` or `upper` say otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usual: Option<f64>,
    /// Likeliest value, not zero: the mean of a normal prior.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// How well `value` is known: relative standard deviation, above 0 and up to 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// Smallest value. With `upper` and neither `usual` nor `value`, the prior is even between the two.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// Largest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
}

/// What is known of a parameter of a law before any data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Known {
    /// Its usual size, with the sign it usually has.
    Usual(f64),
    /// A value with its standard deviation.
    Value {
        /// Likeliest value.
        mean: f64,
        /// Standard deviation, in the unit of the value.
        std: f64,
    },
    /// No more than the range.
    Range,
}

impl LawParameter {
    /// A parameter of which the usual size is known.
    #[must_use]
    pub fn of_size(name: &str, unit: &str, usual: f64) -> LawParameter {
        LawParameter {
            name: name.into(),
            unit: unit.into(),
            usual: Some(usual),
            ..LawParameter::default()
        }
    }

    /// What is known of it; the range where its keys say nothing else.
    #[must_use]
    pub fn known(&self) -> Known {
        match (self.usual, self.value, self.uncertainty) {
            (Some(usual), ..) => Known::Usual(usual),
            (_, Some(mean), Some(uncertainty)) => Known::Value {
                mean,
                std: uncertainty * mean.abs(),
            },
            _ => Known::Range,
        }
    }

    /// Smallest and largest value: as stated; else, of a usual size, on its side of zero; else without an end.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        let side = match self.usual {
            Some(usual) if usual > 0.0 => [0.0, f64::INFINITY],
            Some(_) => [f64::NEG_INFINITY, 0.0],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        };
        [self.lower.unwrap_or(side[0]), self.upper.unwrap_or(side[1])]
    }
}
