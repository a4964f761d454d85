//! A generated case and what is withheld of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use simgap_effects::{Effect, Placed, find};
use simgap_model::{Location, Model};
use simgap_record::Record;

use crate::{Level, foreign_effects};

/// What the right answer is, in the words of the contract.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The gap is noise.
    None,
    /// Nominal parameters are off.
    Parameters,
    /// An effect of the catalogue, or two.
    Effect,
    /// Something the catalogue does not have, or a kind that is taken out of it.
    Unknown,
}

/// A plant, its records, and what is withheld.
#[derive(Debug, Clone)]
pub struct Case {
    /// Number only, such as `case-0017`: it says nothing of the effect.
    pub name: String,
    /// The nominal model, as told to the diagnosis.
    pub model: Model,
    /// Records to learn from.
    pub train: Vec<Record>,
    /// Records to judge by.
    pub check: Vec<Record>,
    /// What is withheld.
    pub truth: Truth,
}

/// An effect of the truth with its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Catalogue name; a foreign effect goes by its own.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Parameters by name, SI units; of those that every record has of its own, that of the first.
    pub parameters: BTreeMap<String, f64>,
    /// For each record, the values of its own parameters; empty where there are none.
    pub of_record: Vec<Vec<f64>>,
}

impl Hidden {
    /// Notes an effect at its place.
    #[must_use]
    pub fn of(placed: &Placed) -> Hidden {
        let entry = placed.to_entry();
        Hidden {
            kind: entry.kind,
            at: entry.at,
            parameters: entry.parameters,
            of_record: placed.of_record.clone(),
        }
    }

    /// The effect at its place again; `None` for a kind or a parameter that there is none of.
    #[must_use]
    pub fn placed(&self) -> Option<Placed> {
        let effect = known(&self.kind)?;
        let values = effect.parameters().iter();
        let values: Option<Vec<f64>> = values
            .map(|parameter| self.parameters.get(parameter.name).copied())
            .collect();
        Some(Placed {
            of_record: self.of_record.clone(),
            ..Placed::new(effect, self.at.clone(), values?)
        })
    }
}

/// An effect of the catalogue or a foreign one.
pub(crate) fn known(kind: &str) -> Option<&'static dyn Effect> {
    let foreign = || {
        let mut all = foreign_effects().into_iter();
        all.find(|effect| effect.kind() == kind)
    };
    find(kind).or_else(foreign)
}

/// What cannot be told from an effect on the plant of a case, whatever the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Equivalent {
    /// Catalogue name.
    pub kind: String,
    /// Where it would act.
    pub at: Location,
    /// Why the two are the same.
    pub because: String,
}

impl From<simgap_effects::Equivalent> for Equivalent {
    fn from(same: simgap_effects::Equivalent) -> Equivalent {
        Equivalent {
            kind: same.kind.to_string(),
            at: same.at,
            because: same.because.to_string(),
        }
    }
}

/// What the diagnosis is not told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// The right kind of answer.
    pub status: Status,
    /// How hard the case is meant to be.
    pub level: Level,
    /// The kind of the effect is taken out of the catalogue of the diagnosis.
    pub withheld: bool,
    /// What was added to the model.
    pub effects: Vec<Hidden>,
    /// For each effect, what cannot be told from it on this plant whatever the data.
    pub equivalents: Vec<Vec<Equivalent>>,
    /// Small errors of nominal parameters beside the effect; naming them is no mistake.
    pub deviations: Vec<Hidden>,
    /// Standard deviation of the noise over that of its channel.
    pub noise_share: f64,
    /// For each effect, the gap it causes on the channel that shows it most: rms over std, over
    /// all records, beyond what another initial state would explain.
    pub gaps: Vec<f64>,
    /// For each check record, each output without noise, in model units.
    pub signals: Vec<Vec<Vec<f64>>>,
}

impl Truth {
    /// The same with the kind of its effect out of the catalogue: the right answer is `unknown`.
    #[must_use]
    pub fn with_kind_withheld(self) -> Truth {
        Truth {
            status: Status::Unknown,
            withheld: true,
            ..self
        }
    }

    /// Whether the catalogue can close the gap.
    #[must_use]
    pub fn is_closable(&self) -> bool {
        matches!(self.status, Status::Parameters | Status::Effect)
    }
}
