//! `simgap effects`: the catalogue, from its own entries.

use simgap_app::effects::{Catalogue, confused, kinds, known};
use simgap_app::input;
use simgap_app::json;
use simgap_effects::{Effect, Family, Parameter};

use crate::args::{EffectsArgs, Format};
use crate::error::CliError;
use crate::stdout::{say, say_plain};
use crate::text::{FAINT, STRONG, named, styled, table};

/// Where the text of a named line begins.
const INDENT: usize = 17;

pub(crate) fn run(args: &EffectsArgs) -> Result<(), CliError> {
    let model = args.model.as_deref().map(input::model).transpose()?;
    let entries: Vec<&dyn Effect> = match &args.kind {
        None => kinds(model.as_ref()),
        Some(kind) => vec![known("", kind, model.as_ref())?],
    };
    match (args.format, &args.kind) {
        (Format::Json, _) => {
            say_plain(&json(&Catalogue::of(&entries))?)?;
        }
        (Format::Human, Some(_)) => {
            entries
                .iter()
                .try_for_each(|effect| say(&explained(*effect)))?;
        }
        (Format::Human, None) => say(&list(&entries))?,
    }
    Ok(())
}

/// A line for each kind.
fn list(entries: &[&dyn Effect]) -> String {
    let widest = entries.iter().map(|effect| effect.kind().len()).max();
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
        for effect in entries.iter().filter(|e| e.family() == family) {
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
    let stated: Vec<String> = effect
        .stated_places()
        .iter()
        .map(ToString::to_string)
        .collect();
    if stated.is_empty() {
        let (where_, key) = (effect.site().words(), effect.site().place());
        line("can sit at", &format!("{where_}: {key}"));
    } else {
        line("can sit", &stated.join(", "));
    }
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
