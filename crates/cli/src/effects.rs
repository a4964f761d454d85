//! `simgap effects`: the catalogue, from its own entries.

use serde::Serialize;
use simgap_effects::{Effect, Family, Parameter, catalogue, find};

use crate::args::{EffectsArgs, Format};
use crate::error::CliError;
use crate::text::{FAINT, STRONG, named, styled, table};
use crate::{say, say_plain};

/// The schema of `--format json`.
const SCHEMA: &str = "simgap-effects/1";
/// Where the text of a named line begins.
const INDENT: usize = 17;
/// Kinds that are offered for one that is not known.
const OFFERED: usize = 3;

pub(crate) fn run(args: &EffectsArgs) -> Result<(), CliError> {
    let entries: Vec<&dyn Effect> = match &args.kind {
        None => catalogue().to_vec(),
        Some(kind) => vec![known("", kind)?],
    };
    match (args.format, &args.kind) {
        (Format::Json, _) => {
            let effects = entries.iter().map(|effect| entry(*effect)).collect();
            let schema = SCHEMA;
            say_plain(&crate::json(&Catalogue { schema, effects })?)?;
        }
        (Format::Human, Some(_)) => {
            entries
                .iter()
                .try_for_each(|effect| say(&explained(*effect)))?;
        }
        (Format::Human, None) => say(&list())?,
    }
    Ok(())
}

/// The entry of a kind, or the kinds that look like it.
pub(crate) fn known(option: &'static str, kind: &str) -> Result<&'static dyn Effect, CliError> {
    find(kind).ok_or_else(|| unknown(option, kind))
}

fn unknown(option: &'static str, kind: &str) -> CliError {
    let kinds = catalogue().iter().map(|effect| effect.kind());
    let mut near: Vec<(f64, &str)> = kinds.map(|known| (likeness(kind, known), known)).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let near: Vec<&str> = near.iter().take(OFFERED).map(|(_, kind)| *kind).collect();
    CliError::UnknownKind {
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

/// A line for each kind.
fn list() -> String {
    let widest = catalogue().iter().map(|effect| effect.kind().len()).max();
    let widest = widest.unwrap_or(0);
    let mut text = String::new();
    for family in [
        Family::NominalParameter,
        Family::Force,
        Family::Dynamics,
        Family::Measurement,
    ] {
        text.push_str(&styled(STRONG, &heading(family)));
        text.push('\n');
        for effect in catalogue().iter().filter(|e| e.family() == family) {
            let pad = " ".repeat(widest - effect.kind().len());
            text.push_str(&format!("  {}{pad}  {}\n", effect.kind(), effect.summary()));
        }
        text.push('\n');
    }
    text.push_str("simgap effects KIND explains one of them.\n");
    text
}

fn heading(family: Family) -> String {
    let words = family_words(family);
    let first = words.chars().take(1).flat_map(char::to_uppercase);
    first.chain(words.chars().skip(1)).collect()
}

fn family_words(family: Family) -> &'static str {
    match family {
        Family::NominalParameter => "a nominal parameter with another value",
        Family::Force => "a force the model lacks",
        Family::Dynamics => "dynamics the model lacks",
        Family::Measurement => "the measurement chain, not the machine",
    }
}

/// Everything an entry says of itself.
fn explained(effect: &dyn Effect) -> String {
    let mut text = format!("{}\n", styled(STRONG, effect.kind()));
    let mut line = |name: &str, words: &str| named(&mut text, name, words, INDENT);
    line("what it does", effect.summary());
    line("belongs to", family_words(effect.family()));
    line("law", effect.equation());
    let (where_, key) = (effect.site().words(), effect.site().place());
    line("can sit at", &format!("{where_}: {key}"));
    line("shown best by", effect.experiment());
    for (kind, because) in confused(effect) {
        line("confused with", &format!("{kind}: {because}"));
    }
    let special = effect.contains().join(", ");
    if !special.is_empty() {
        line("contains", &special);
    }
    if let Some(reference) = effect.reference() {
        line("source", &format!("{reference} (docs/references.md)"));
    }
    text.push('\n');
    let head = ["parameter", "unit", "range", "no effect at", "records"];
    let rows: Vec<Vec<String>> = effect.parameters().iter().map(parameter_row).collect();
    table(&mut text, &head, &rows, &[]);
    text.push_str(&format!(
        "\n  {}\n{}",
        styled(FAINT, "in a model file"),
        example(effect)
    ));
    text
}

/// What it is taken for, and what is taken for it.
fn confused(effect: &dyn Effect) -> Vec<(&'static str, &'static str)> {
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

fn parameter_row(parameter: &Parameter) -> Vec<String> {
    let neutral = match parameter.neutral {
        None => "shape only".to_string(),
        Some(value) if value.is_infinite() => "never reached".to_string(),
        Some(value) => value.to_string(),
    };
    let records = if parameter.per_record {
        "each its own"
    } else {
        "one for all"
    };
    vec![
        parameter.name.to_string(),
        parameter.unit.to_string(),
        range(parameter),
        neutral,
        records.to_string(),
    ]
}

fn range(parameter: &Parameter) -> String {
    let (lower, upper) = (parameter.lower, parameter.upper);
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => format!("{lower} to {upper}"),
        (true, false) => format!("{lower} or more"),
        (false, true) => format!("{upper} or less"),
        (false, false) => "any".to_string(),
    }
}

/// The lines that put it into a model file, to be filled in.
fn example(effect: &dyn Effect) -> String {
    let mut text = format!(
        "    [[effect]]\n    kind = \"{}\"\n    {}\n",
        effect.kind(),
        effect.site().place()
    );
    let widest = effect.parameters().iter().map(|p| p.name.len()).max();
    let widest = widest.unwrap_or(0);
    for Parameter { name, unit, .. } in effect.parameters() {
        text.push_str(&format!("    {name:widest$} = ...    # {unit}\n"));
    }
    text
}

#[derive(Serialize)]
struct Catalogue {
    schema: &'static str,
    effects: Vec<Entry>,
}

#[derive(Serialize)]
struct Entry {
    kind: &'static str,
    family: &'static str,
    summary: &'static str,
    equation: &'static str,
    site: &'static str,
    place: &'static str,
    parameters: Vec<ParameterEntry>,
    experiment: &'static str,
    confused_with: Vec<Confusion>,
    contains: &'static [&'static str],
    reference: Option<&'static str>,
}

/// Bounds are `null` where there is none, `no_effect_at` where a parameter only shapes the effect
/// or is a limit that is never reached.
#[derive(Serialize)]
struct ParameterEntry {
    name: &'static str,
    unit: &'static str,
    lower: Option<f64>,
    upper: Option<f64>,
    no_effect_at: Option<f64>,
    per_record: bool,
}

#[derive(Serialize)]
struct Confusion {
    kind: &'static str,
    because: &'static str,
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
