//! What a fit says, as plain data: to be kept, sent or compared.

use simgap_effects::Placed;
use simgap_model::Location;

use crate::{Fit, Interval};

/// What a fit says, without what it needs to go on.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FitSummary {
    /// The estimated effects.
    pub effects: Vec<EstimatedEffect>,
    /// The nominal parameters, held near their values.
    pub nominal: Vec<EstimatedEffect>,
    /// Initial state of each run: displacements, then velocities.
    pub initial: Vec<Vec<f64>>,
    /// What was minimised, nat: see [`Fit::objective`].
    pub objective: f64,
    /// Mean square discrepancy of each output, its unit squared.
    pub variance: Vec<f64>,
    /// Steps taken.
    pub iterations: usize,
}

/// One effect of a fit.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EstimatedEffect {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Its values.
    pub parameters: Vec<EstimatedParameter>,
}

/// One value of an effect.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EstimatedParameter {
    /// As the catalogue calls it.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// Lower and upper end of the 95 % interval; `None` where the data do not see the parameter.
    pub ci95: Option<[f64; 2]>,
}

impl Fit {
    /// The estimates with names, units and intervals.
    #[must_use]
    pub fn summary(&self) -> FitSummary {
        let told = |placed: &[Placed], intervals: &[Vec<Interval>]| {
            let each = placed.iter().enumerate();
            let intervals = |i: usize| intervals.get(i).map_or(&[][..], Vec::as_slice);
            each.map(|(i, effect)| estimated(effect, intervals(i)))
                .collect()
        };
        FitSummary {
            effects: told(&self.estimate.effects, &self.intervals),
            nominal: told(&self.estimate.nominal, &self.nominal_intervals),
            initial: self.estimate.initial.clone(),
            objective: self.objective,
            variance: self.variance.clone(),
            iterations: self.iterations,
        }
    }
}

fn estimated(placed: &Placed, intervals: &[Interval]) -> EstimatedEffect {
    let values = placed.effect.parameters().iter().zip(&placed.values);
    let parameters = values.enumerate().map(|(k, (parameter, value))| {
        let ci95 = intervals.get(k).map(|interval| interval.ci95);
        EstimatedParameter {
            name: parameter.name.to_owned(),
            unit: parameter.unit.to_owned(),
            value: *value,
            ci95: ci95.filter(|ends| ends.iter().all(|end| end.is_finite())),
        }
    });
    EstimatedEffect {
        kind: placed.effect.kind().to_owned(),
        at: placed.at.clone(),
        parameters: parameters.collect(),
    }
}
