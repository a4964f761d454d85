//! A generated case and what is withheld of it.

use simgap_model::{EffectEntry, Model};
use simgap_record::Record;

use crate::Equivalent;

/// What the right answer is, in the words of the contract.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Status {
    /// The gap is noise.
    None,
    /// Nominal parameters are off.
    Parameters,
    /// An effect of the catalogue, or two.
    Effect,
    /// Something the catalogue does not have.
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

/// What the diagnosis is not told.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The right kind of answer.
    pub status: Status,
    /// What was added to the model, with its values. A foreign effect goes by its own kind.
    pub effects: Vec<EffectEntry>,
    /// For each effect, what cannot be told from it on this plant whatever the data.
    pub equivalents: Vec<Vec<Equivalent>>,
    /// Small errors of nominal parameters beside the effect; naming them is no mistake.
    pub deviations: Vec<EffectEntry>,
    /// Standard deviation of the noise over that of its channel.
    pub noise_share: f64,
    /// For each effect, the gap it causes on the channel that shows it most: rms over std, over
    /// all records, beyond what another initial state would explain.
    pub gaps: Vec<f64>,
    /// Whether the catalogue can close the gap.
    pub closable: bool,
}
