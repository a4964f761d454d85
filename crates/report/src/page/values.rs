//! The corrected values with their intervals, and what they mean for the machine.

use simgap_diagnose::{Diagnosis, NamedEffect, NamedParameter, Status};
use simgap_effects::find;
use simgap_model::{Location, Model, same_pair};

use super::ReportInput;
use super::answer::place_sentence;
use super::tables::table;
use crate::markup::Html;
use crate::number::{percent, significant};
use crate::unit::{Prefixed, estimate, prefixed, quantity};

/// Changes of a nominal parameter below this are not told.
const UNCHANGED: f64 = 1e-3;

/// The section; left out where there is nothing to list.
pub(super) fn values(
    html: &mut Html,
    input: &ReportInput<'_>,
    unit_at: &dyn Fn(&Location) -> String,
) {
    let diagnosis = input.diagnosis;
    let changed = match (input.nominal, input.corrected) {
        (Some(nominal), Some(corrected)) => changes(nominal, corrected),
        _ => vec![],
    };
    if diagnosis.verdict.effects.is_empty() && changed.is_empty() {
        return;
    }
    html.element("h2", &[], "The corrected values");
    for effect in &diagnosis.verdict.effects {
        let head = place_sentence(&effect.kind, &effect.at);
        html.element("h3", &[], &head);
        effect_values(html, effect, input.nominal, &unit_at(&effect.at));
    }
    if !changed.is_empty() {
        html.element("h3", &[], "Parameters of the model itself");
        html.element("p", &[], &about_changes(diagnosis));
        let head = ["Parameter", "As given", "Re-estimated", "Change"];
        table(html, &head, 1, &changed);
    }
}

fn about_changes(diagnosis: &Diagnosis) -> String {
    let with = match diagnosis.verdict.status {
        Status::Effect => "Fitted together with the named effects",
        _ => "Fitted with no effect added",
    };
    format!("{with}, as the corrected model has them; changes below 0.1 % are left out.")
}

fn effect_values(html: &mut Html, effect: &NamedEffect, nominal: Option<&Model>, unit: &str) {
    if let Some(known) = find(&effect.kind) {
        html.element("p", &[], &crate::wording::sentence(known.summary()));
    }
    if effect.parameters.is_empty() {
        return;
    }
    let rows: Vec<(bool, Vec<String>)> = effect
        .parameters
        .iter()
        .map(|p| {
            let e = estimate(p, unit);
            let sense = sense(effect, p, nominal);
            (
                false,
                vec![e.words, p.name.clone(), e.value, e.interval, sense],
            )
        })
        .collect();
    let head = [
        "Parameter",
        "Name in the model file",
        "Estimate",
        "95 % interval",
        "Sense",
    ];
    table(html, &head, 99, &rows);
}

/// What a value means: whether it is possible, whether it could be no effect at all, and what the
/// machine has in total.
fn sense(effect: &NamedEffect, parameter: &NamedParameter, nominal: Option<&Model>) -> String {
    let mut out = Vec::new();
    let value = parameter.value;
    let [low, high] = parameter.ci95;
    if parameter.name.ends_with("factor") && value.is_finite() {
        let change = percent((value - 1.0).abs());
        let way = if value > 1.0 { "above" } else { "below" };
        out.push(format!("{change} {way} the model file"));
    }
    let law =
        find(&effect.kind).and_then(|e| e.parameters().iter().find(|p| p.name == parameter.name));
    if let Some(law) = law {
        let room = 1e-9 * value.abs();
        if value <= law.lower + room && law.lower.is_finite() && law.lower != 0.0
            || value >= law.upper - room && law.upper.is_finite()
        {
            out.push("at the end of what is possible".to_owned());
        }
        if let Some(neutral) = law
            .neutral
            .filter(|n| n.is_finite() && low <= *n && *n <= high)
        {
            out.push(format!("could be {}, no effect", significant(neutral, 1)));
        }
    }
    if let Some(total) = nominal.and_then(|model| total(effect, parameter, model)) {
        out.push(total);
    }
    crate::wording::sentence(&out.join("; "))
}

/// What the member has with the model's own part.
fn total(effect: &NamedEffect, parameter: &NamedParameter, model: &Model) -> Option<String> {
    let Location::Between(pair) = &effect.at else {
        return None;
    };
    let unit = quantity(&parameter.name).unit;
    let own: f64 = match unit.as_str() {
        "N s/m" => {
            let here = model.dampers.iter().filter(|d| same_pair(&d.between, pair));
            here.map(|d| d.damping).sum()
        }
        "N/m" => {
            let here = model.springs.iter().filter(|s| same_pair(&s.between, pair));
            here.map(|s| s.stiffness).sum()
        }
        _ => return None,
    };
    let law = find(&effect.kind)?
        .parameters()
        .iter()
        .find(|p| p.name == parameter.name)?;
    if own == 0.0 || law.neutral != Some(0.0) {
        return None;
    }
    let sum = own + parameter.value;
    let Prefixed { unit, factor } = prefixed(&unit, sum.abs());
    let doubt = if sum < 0.0 {
        ", which would drive the machine"
    } else {
        ""
    };
    let text = significant(sum * factor, 4);
    Some(format!("{text}\u{a0}{unit} with the model's own{doubt}"))
}

/// Masses, springs, dampers and gains that the corrected model has otherwise.
fn changes(nominal: &Model, corrected: &Model) -> Vec<(bool, Vec<String>)> {
    let mut rows = Vec::new();
    let mut add = |name: String, unit: &str, was: f64, is: f64| {
        let change = is / was - 1.0;
        if !change.is_finite() || change.abs() < UNCHANGED {
            return;
        }
        let Prefixed { unit, factor } = prefixed(unit, was.abs());
        let shown = |v: f64| format!("{}\u{a0}{unit}", significant(v * factor, 4));
        let sign = if change > 0.0 { "+" } else { "" };
        let change = format!("{sign}{}", percent(change));
        rows.push((false, vec![name, shown(was), shown(is), change]));
    };
    for (a, b) in nominal.masses.iter().zip(&corrected.masses) {
        add(format!("mass {}", a.name), "kg", a.value, b.value);
    }
    for (a, b) in nominal.springs.iter().zip(&corrected.springs) {
        add(
            format!("spring {}", a.name),
            "N/m",
            a.stiffness,
            b.stiffness,
        );
    }
    for (a, b) in nominal.dampers.iter().zip(&corrected.dampers) {
        add(format!("damper {}", a.name), "N s/m", a.damping, b.damping);
    }
    for (a, b) in nominal.inputs.iter().zip(&corrected.inputs) {
        if let (Some(was), Some(is)) = (a.gain, b.gain) {
            add(format!("gain of input {}", a.channel), "", was, is);
        }
    }
    rows
}
