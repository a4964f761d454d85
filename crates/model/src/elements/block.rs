//! Linear blocks: controllers, filters, sensors.

mod in_model;

use serde::{Deserialize, Serialize};

use crate::ModelError;
use crate::refuse::{item, node_name};

/// A linear block with a transfer function from the sum of its signals to its output,
///
/// ```text
/// e = Σ set points + Σ plus − Σ minus                                                                (1)
/// y = N(s)/D(s) e,    deg N ≤ deg D                                                                  (2)
/// ```
///
/// A signal is a node (its displacement), the pressure of a chamber (in Pa, beyond the pressure at the start) or another
/// block. The output commands the valves whose `from` names the block, and pushes the node `force` where there is one.
///
/// With s = ω₀ σ, D monic in σ and N/D = d + R/D, the states are those of the controllable form (`franklin1998`,
/// section 2.2), each the rate of a coordinate `name.x1`, `name.x2`, ...:
///
/// ```text
/// ẋ₁ = ω₀ x₂, ..., ẋ_n = ω₀ (e − Σ a_k x_(k+1)),    y = Σ r_k x_(k+1) + d e                          (3)
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Unique among blocks.
    pub name: String,
    /// N, highest power first.
    pub numerator: Vec<f64>,
    /// D, highest power first.
    pub denominator: Vec<f64>,
    /// Signals that are added.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plus: Vec<String>,
    /// Signals that are subtracted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub minus: Vec<String>,
    /// A node that the output pushes with a force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
}

/// The form (3) of a block.
struct States {
    rate: f64,
    /// a₀, a₁, ...
    feedback: Vec<f64>,
    /// r₀, r₁, ...
    output: Vec<f64>,
    through: f64,
}

/// A signal over the coordinates: weights of displacements, of rates and of inputs by their place in the model.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Signal {
    displacement: Vec<(usize, f64)>,
    rate: Vec<(usize, f64)>,
    input: Vec<(usize, f64)>,
}

impl Signal {
    fn add(&mut self, other: &Signal, weight: f64) {
        let pairs = [
            (&mut self.displacement, &other.displacement),
            (&mut self.rate, &other.rate),
            (&mut self.input, &other.input),
        ];
        for (own, more) in pairs {
            own.extend(more.iter().map(|(i, value)| (*i, weight * value)));
        }
    }
}

impl Block {
    /// Number of its states: the degree of the denominator.
    #[must_use]
    pub fn order(&self) -> usize {
        self.denominator.len().saturating_sub(1)
    }

    /// Name of the coordinate of a state, from 1.
    pub(crate) fn state_name(&self, state: usize) -> String {
        format!("{}.x{state}", self.name)
    }

    fn states(&self) -> States {
        let order = self.order();
        let leading = self.denominator.first().copied().unwrap_or(1.0);
        // Coefficients of s⁰, s¹, ..., D monic.
        let rising = |values: &[f64]| -> Vec<f64> {
            let mut rising: Vec<f64> = values.iter().rev().map(|v| v / leading).collect();
            rising.resize(order + 1, 0.0);
            rising
        };
        let (denominator, numerator) = (rising(&self.denominator), rising(&self.numerator));
        // No root of D is larger than twice the largest of these.
        let roots = (0..order).map(|k| denominator[k].abs().powf(1.0 / (order - k) as f64));
        let largest = roots.fold(0.0, f64::max);
        let rate = if largest > 0.0 { largest } else { 1.0 };
        let through = numerator[order];
        let scaled = |k: usize, value: f64| value / rate.powi((order - k) as i32);
        States {
            rate,
            feedback: (0..order).map(|k| scaled(k, denominator[k])).collect(),
            output: (0..order)
                .map(|k| scaled(k, numerator[k] - through * denominator[k]))
                .collect(),
            through,
        }
    }

    fn check(&self) -> Result<(), ModelError> {
        let place = item("block", &self.name);
        node_name(&place, &self.name)?;
        let mut all = self.numerator.iter().chain(&self.denominator);
        let finite = all.all(|value| value.is_finite());
        let leading = self.denominator.first().copied().unwrap_or(0.0);
        let proper = self.numerator.len() <= self.denominator.len();
        if finite && leading != 0.0 && proper && !self.numerator.is_empty() {
            return Ok(());
        }
        Err(ModelError::Shape {
            place,
            found: format!(
                "numerator = {:?}, denominator = {:?}",
                self.numerator, self.denominator
            ),
            needed: "finite coefficients, highest power first, the denominator not below the numerator in degree and \
                     without a leading zero"
                .into(),
        })
    }
}
