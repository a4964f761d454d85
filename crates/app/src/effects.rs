//! The catalogue, from its own entries.

use serde::Serialize;
use simgap_effects::{Effect, Family, catalogue, catalogue_of};
use simgap_model::Model;

use crate::AppError;

/// The schema of the catalogue as JSON.
const SCHEMA: &str = "simgap-effects/1";
/// Kinds that are offered for one that is not known.
const OFFERED: usize = 3;

/// The kinds that are known: the catalogue, and the laws of a model if there is one.
#[must_use]
pub fn kinds(model: Option<&Model>) -> Vec<&'static dyn Effect> {
    model.map_or_else(|| catalogue().to_vec(), catalogue_of)
}

/// The entry of a kind, or the kinds that look like it; `option` stands before the message.
///
/// # Errors
/// [`AppError::UnknownKind`].
pub fn known(
    option: &'static str,
    kind: &str,
    model: Option<&Model>,
) -> Result<&'static dyn Effect, AppError> {
    let all = kinds(model);
    let found = all.iter().find(|effect| effect.kind() == kind);
    found.copied().ok_or_else(|| unknown(option, kind, &all))
}

fn unknown(option: &'static str, kind: &str, all: &[&'static dyn Effect]) -> AppError {
    let kinds = all.iter().map(|effect| effect.kind());
    let mut near: Vec<(f64, &str)> = kinds.map(|known| (likeness(kind, known), known)).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let near: Vec<&str> = near.iter().take(OFFERED).map(|(_, kind)| *kind).collect();
    AppError::UnknownKind {
        option,
        found: kind.to_string(),
        near: near.join(", "),
    }
}

/// How much a word looks like a kind, as a whole or like one of its words.
fn likeness(word: &str, kind: &str) -> f64 {
    let word = word.to_lowercase().replace(['-', ' '], "_");
    let parts = kind.split('_').chain([kind]);
    let whole = strsim::normalized_damerau_levenshtein(&word, kind);
    parts
        .map(|part| 0.9 * strsim::normalized_damerau_levenshtein(&word, part))
        .fold(whole, f64::max)
}

/// What it is taken for, and what is taken for it.
#[must_use]
pub fn confused(effect: &dyn Effect) -> Vec<(&'static str, &'static str)> {
    let mut found = effect.confused_with().to_vec();
    for other in catalogue() {
        let back = other.confused_with().iter();
        let mine = back.filter(|(kind, _)| *kind == effect.kind());
        found.extend(mine.map(|(_, because)| (other.kind(), *because)));
    }
    // What both say is said once, in the entry's own words.
    let mut kept: Vec<(&str, &str)> = vec![];
    for pair in found {
        if kept.iter().all(|(kind, _)| *kind != pair.0) {
            kept.push(pair);
        }
    }
    kept
}

/// Entries of the catalogue, as `--format json` tells them.
#[derive(Debug, Serialize)]
pub struct Catalogue {
    /// `simgap-effects/1`.
    pub schema: &'static str,
    /// One for each kind.
    pub effects: Vec<Entry>,
}

/// What an entry says of itself.
#[derive(Debug, Serialize)]
pub struct Entry {
    /// Name in the catalogue.
    pub kind: &'static str,
    /// `nominal_parameter`, `force`, `dynamics` or `measurement`.
    pub family: &'static str,
    /// What it does, in a sentence.
    pub summary: &'static str,
    /// The law.
    pub equation: &'static str,
    /// Where it can sit, in words.
    pub site: &'static str,
    /// Where it can sit, as a model file writes it.
    pub place: &'static str,
    /// Its parameters.
    pub parameters: Vec<ParameterEntry>,
    /// What shows it best.
    pub experiment: &'static str,
    /// What it is taken for, and what is taken for it.
    pub confused_with: Vec<Confusion>,
    /// Kinds that are special cases of it.
    pub contains: &'static [&'static str],
    /// Key of its source in `docs/references.md`.
    pub reference: Option<&'static str>,
}

/// A parameter of a kind. Bounds are `null` where there is none, `no_effect_at` where a parameter only shapes the effect
/// or is a limit that is never reached.
#[derive(Debug, Serialize)]
pub struct ParameterEntry {
    /// Name with the unit in it.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Least value.
    pub lower: Option<f64>,
    /// Largest value.
    pub upper: Option<f64>,
    /// The value at which it does nothing.
    pub no_effect_at: Option<f64>,
    /// Whether each record has its own value.
    pub per_record: bool,
}

/// A kind that is taken for another.
#[derive(Debug, Serialize)]
pub struct Confusion {
    /// Name in the catalogue.
    pub kind: &'static str,
    /// Why.
    pub because: &'static str,
}

impl Catalogue {
    /// What some entries say of themselves.
    #[must_use]
    pub fn of(entries: &[&dyn Effect]) -> Catalogue {
        Catalogue {
            schema: SCHEMA,
            effects: entries.iter().map(|effect| entry(*effect)).collect(),
        }
    }
}

fn entry(effect: &dyn Effect) -> Entry {
    let finite = |value: f64| value.is_finite().then_some(value);
    let parameters = effect.parameters().iter().map(|p| ParameterEntry {
        name: p.name,
        unit: p.unit,
        lower: finite(p.lower),
        upper: finite(p.upper),
        no_effect_at: p.neutral.and_then(finite),
        per_record: p.per_record,
    });
    let confused = confused(effect).into_iter();
    Entry {
        kind: effect.kind(),
        family: match effect.family() {
            Family::NominalParameter => "nominal_parameter",
            Family::Force => "force",
            Family::Dynamics => "dynamics",
            Family::Measurement => "measurement",
        },
        summary: effect.summary(),
        equation: effect.equation(),
        site: effect.site().words(),
        place: effect.site().place(),
        parameters: parameters.collect(),
        experiment: effect.experiment(),
        confused_with: confused
            .map(|(kind, because)| Confusion { kind, because })
            .collect(),
        contains: effect.contains(),
        reference: effect.reference(),
    }
}
