//! Catalogue names, places and verdicts in plain words, shared by the page and the summary.

use simgap_diagnose::{Diagnosis, Gap, LIKELIER_THAN_NOT, NamedEffect, RELEVANT_SHARE, Status};
use simgap_model::Location;

use crate::number::{percent, ratio};
use crate::unit::{estimate, is_fitted};

/// Below this a named effect is called the likely cause, not the cause.
pub(crate) const SURE: f64 = 0.9;

/// A catalogue name in words: "Coulomb friction", "wrong stiffness".
pub(crate) fn kind(kind: &str) -> String {
    match kind {
        "mass_error" => "wrong mass".to_owned(),
        "stiffness_error" => "wrong stiffness".to_owned(),
        "damping_error" => "wrong damping".to_owned(),
        "input_gain" => "wrong gain".to_owned(),
        "parameter_error" => "wrong value".to_owned(),
        "coulomb_friction" => "Coulomb friction".to_owned(),
        "stribeck_friction" => "Stribeck friction".to_owned(),
        other => other.replace('_', " "),
    }
}

/// A place in words that follow an effect: "between mold and ground", "on mass mold".
pub(crate) fn place(at: &Location) -> String {
    match at {
        Location::Mass(m) => format!("on mass {m}"),
        Location::Input(c) => format!("in input {c}"),
        Location::Channel(c) => format!("in channel {c}"),
        Location::Parameter(p) => format!("of parameter {p}"),
        between @ Location::Between(_) => between.to_string(),
    }
}

/// "Coulomb friction between mold and ground".
pub(crate) fn effect_at(name: &str, at: &Location) -> String {
    format!("{} {}", kind(name), place(at))
}

/// A text of the diagnosis for a reader: catalogue names in words ("stribeck_friction" is "Stribeck
/// friction"), a true minus, no more digits than say something.
pub(crate) fn plain(text: &str) -> String {
    if let Some(worth) = text
        .strip_prefix("log evidence falls by ")
        .and_then(|rest| rest.strip_suffix(" without it"))
    {
        return format!(
            "without it these records are harder to explain (log evidence lower by {})",
            crate::number::fewer_digits(worth)
        );
    }
    let text = crate::number::fewer_digits(&in_words(text));
    text.replace(" -", " −").replace("(-", "(−")
}

fn in_words(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut rest = text;
    while let Some(start) = rest.find(is_word) {
        let (before, from) = rest.split_at(start);
        let (word, after) = from.split_at(from.find(|c| !is_word(c)).unwrap_or(from.len()));
        out.push_str(before);
        if word.contains('_') && simgap_effects::find(word).is_some() {
            out.push_str(&kind(word));
            // A place that follows needs its preposition.
            match after.trim_start().split(' ').next() {
                Some("channel" | "input") => out.push_str(" in"),
                Some("mass") => out.push_str(" on"),
                _ => {}
            }
        } else {
            out.push_str(word);
        }
        rest = after;
    }
    out + rest
}

/// First letter raised and a full stop set, if they are missing. A name stays as it is: of a file or
/// of a channel, told by what no word has.
pub(crate) fn sentence(text: &str) -> String {
    let text = text.trim();
    let mut chars = text.chars();
    let Some(first) = chars.next() else {
        return String::new();
    };
    let word = text.split(' ').next().unwrap_or_default();
    let letters = |c: char| c.is_alphabetic() || "-',".contains(c);
    let name = !word.chars().all(letters) || (word.len() == 1 && word != "a");
    let mut out: String = if name {
        text.to_owned()
    } else {
        first.to_uppercase().chain(chars).collect()
    };
    if !out.ends_with(['.', '!', '?', ':', ')']) || (out.ends_with(')') && !out.ends_with(".)")) {
        out.push('.');
    }
    out
}

/// "friction force 2.10 kN (95 % interval 2.05 to 2.15 kN)", several joined by "and".
fn parameters(effect: &NamedEffect) -> String {
    let each: Vec<String> = effect
        .parameters
        .iter()
        .map(|p| {
            let e = estimate(p);
            if !is_fitted(p) {
                return format!("{} {}", e.words, e.value);
            }
            format!(
                "{} {} (95\u{a0}% interval: {})",
                e.words, e.value, e.interval
            )
        })
        .collect();
    list(&each)
}

/// "a", "a and b", "a, b and c".
pub(crate) fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

/// The answer in one plain sentence, with the figure that matters.
pub(crate) fn headline(diagnosis: &Diagnosis) -> String {
    let effects = &diagnosis.verdict.effects;
    let gap = &diagnosis.gap;
    match diagnosis.verdict.status {
        Status::None => format!(
            "The gap of {} is measurement noise; nothing to add to the model.",
            ratio(gap.nominal)
        ),
        Status::Unknown if diagnosis.verdict.refuted => format!(
            "What explains the gap of {} best is refuted by the check records; nothing is blamed.",
            ratio(gap.nominal)
        ),
        Status::Unknown if diagnosis.verdict.other.probability <= LIKELIER_THAN_NOT => format!(
            "Nothing that was tried explains the gap of {}; nothing is blamed.",
            ratio(gap.nominal)
        ),
        Status::Unknown => format!(
            "The main cause of the gap of {} is likelier outside the catalogue than in it; nothing is blamed.",
            ratio(gap.nominal)
        ),
        Status::Parameters if effects.is_empty() => {
            "Re-estimating the model's own parameters closes the gap; no effect is missing."
                .to_owned()
        }
        Status::Parameters if diagnosis.verdict.complete => {
            explains(effects, gap.closed) + "; no effect is missing from the model."
        }
        Status::Parameters => explains(effects, gap.closed) + ".",
        Status::Effect if effects.is_empty() => "An effect is missing from the model.".to_owned(),
        Status::Effect => explains(effects, gap.closed) + &by_parameters(gap) + ".",
    }
}

/// What of it no effect was needed for, where that counts.
fn by_parameters(gap: &Gap) -> String {
    let alone = gap.closed_by_parameters();
    match alone >= RELEVANT_SHARE && gap.closed >= 0.0 {
        true => format!("; re-estimated parameters alone explain {}", percent(alone)),
        false => String::new(),
    }
}

/// "Coulomb friction of 20.4 ± 0.3 N between carriage and ground explains 94 % of the gap on data
/// it was not fitted to", without a full stop. Where that gap has grown, it is the training records that are explained.
fn explains(effects: &[NamedEffect], closed: f64) -> String {
    let names: Vec<String> = effects.iter().map(with_figure).collect();
    let alone = effects.len() == 1;
    let sure = effects.iter().all(|e| e.probability >= SURE);
    let likely = if sure { "" } else { " most likely" };
    let (verb, they) = if alone {
        ("explains", "it was")
    } else {
        ("explain", "they were")
    };
    let head = sentence(&list(&names));
    let head = head.trim_end_matches('.');
    if closed < 0.0 {
        return format!(
            "{head}{likely} {verb} the training records best, and not the gap on data {they} not fitted to"
        );
    }
    let amount = match percent(closed) {
        text if !closed.is_finite() || text.starts_with('<') => "part".to_owned(),
        text => text.replace("> ", "more than "),
    };
    format!("{head}{likely} {verb} {amount} of the gap on data {they} not fitted to")
}

/// An effect with the one figure that was fitted: "Coulomb friction of 20.4 ± 0.3 N between carriage and ground".
/// Where it has several, the list below the headline has them.
fn with_figure(effect: &NamedEffect) -> String {
    let name = kind(&effect.kind);
    let place = place(&effect.at);
    let mut fitted = effect.parameters.iter().filter(|p| is_fitted(p));
    let (Some(parameter), None) = (fitted.next(), fitted.next()) else {
        return format!("{name} {place}");
    };
    let e = estimate(parameter);
    if !parameter.value.is_finite() {
        format!("{name} {place}")
    } else if e.words.ends_with("factor") {
        format!("{name} {place} (factor {})", e.plus_minus)
    } else if e.value.contains('\u{a0}') {
        format!("{name} of {} {place}", e.plus_minus)
    } else {
        format!("{name} {place}")
    }
}

/// What stands under the headline: values with intervals and probabilities, or why nothing is
/// named. One sentence each.
pub(crate) fn particulars(diagnosis: &Diagnosis) -> Vec<String> {
    let gap = &diagnosis.gap;
    let mut out = Vec::new();
    match diagnosis.verdict.status {
        Status::None => {
            let driven = if gap.input_noise > gap.noise_floor {
                format!(", that of the inputs about {}", ratio(gap.input_noise))
            } else {
                String::new()
            };
            out.push(format!(
                "The model as given is off by {}; the noise alone leaves {}{driven}.",
                ratio(gap.nominal),
                ratio(gap.noise_floor),
            ));
        }
        Status::Unknown => {
            let said = diagnosis.verdict.description.iter();
            out.extend(said.map(|d| sentence(&plain(d))));
        }
        Status::Parameters | Status::Effect => {}
    }
    let alone = diagnosis.verdict.effects.len() == 1;
    for effect in &diagnosis.verdict.effects {
        let mut parts = vec![parameters(effect)];
        parts.push(format!("probability {}", percent(effect.probability)));
        parts.retain(|p| !p.is_empty());
        let text = parts.join(", ");
        // The headline has just named it.
        out.push(sentence(&if alone {
            text
        } else {
            format!("{}: {text}", effect_at(&effect.kind, &effect.at))
        }));
    }
    out.extend(incomplete(diagnosis));
    out
}

/// How much an answer leaves, where that is more than noise.
fn incomplete(diagnosis: &Diagnosis) -> Option<String> {
    let verdict = &diagnosis.verdict;
    let named = matches!(verdict.status, Status::Parameters | Status::Effect);
    (named && !verdict.complete).then(|| {
        format!(
            "This is the leading cause, not all of it: {} of the gap is left.",
            percent(verdict.unexplained.share)
        )
    })
}

/// What the third prediction is called in legends.
pub(crate) fn corrected_name(status: Status) -> &'static str {
    match status {
        Status::Effect => "corrected model",
        Status::Parameters | Status::None => "re-estimated model",
        // Re-estimated or as given, whichever predicts better.
        Status::Unknown => "final model",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_kinds_and_places_read_as_words() {
        let at = Location::Between(["mold".into(), "ground".into()]);
        assert_eq!(
            effect_at("coulomb_friction", &at),
            "Coulomb friction between mold and ground"
        );
        assert_eq!(
            effect_at("sensor_delay", &Location::Channel("y".into())),
            "sensor delay in channel y"
        );
        assert_eq!(place(&Location::Mass("m".into())), "on mass m");
    }

    #[test]
    fn verify_catalogue_names_in_a_text_become_words() {
        assert_eq!(
            plain("to tell coulomb_friction from input_delay: y_mold (1 mm), 5 %"),
            "to tell Coulomb friction from input delay: y_mold (1 mm), 5 %"
        );
        assert_eq!(
            plain(
                "the next best is sensor_bias channel V2 (correlation -0.94), tone_pickup mass m"
            ),
            "the next best is sensor bias in channel V2 (correlation −0.94), tone pickup on mass m"
        );
        assert_eq!(
            plain("log evidence falls by 12343.9 without it"),
            "without it these records are harder to explain (log evidence lower by 12340)"
        );
    }

    #[test]
    fn verify_sentences_are_closed_once() {
        assert_eq!(sentence("it falls by 3.2"), "It falls by 3.2.");
        assert_eq!(sentence("Done."), "Done.");
        assert_eq!(sentence("a.csv: read"), "a.csv: read.");
        assert_eq!(sentence("y is flat"), "y is flat.");
        assert_eq!(sentence("a mass"), "A mass.");
        assert_eq!(sentence("as well (needed is 3)"), "As well (needed is 3).");
        assert_eq!(sentence("  "), "");
        assert_eq!(list(&["a".into(), "b".into(), "c".into()]), "a, b and c");
    }
}
