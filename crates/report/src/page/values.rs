//! The corrected values with their intervals, and what they mean for the machine.

use simgap_diagnose::{Diagnosis, NamedEffect, Status};
use simgap_model::{Location, Model};

use super::ReportInput;
use super::answer::place_sentence;
use super::sense::sense;
use super::tables::table;
use crate::markup::Html;
use crate::number::{change, significant};
use crate::unit::{Prefixed, estimate, prefixed, raised};

/// Changes of a nominal parameter below this are not told.
const UNCHANGED: f64 = 1e-3;

/// The section; left out where there is nothing to list.
pub(super) fn values(html: &mut Html, input: &ReportInput<'_>) {
    let diagnosis = input.diagnosis;
    let changed = match (input.nominal, input.corrected) {
        // A change within the noise is none.
        _ if diagnosis.verdict.status == Status::None => vec![],
        (Some(nominal), Some(corrected)) => changes(diagnosis, nominal, corrected),
        _ => vec![],
    };
    if diagnosis.verdict.effects.is_empty() && changed.is_empty() {
        return;
    }
    html.element("h2", &[], "The corrected values");
    for effect in &diagnosis.verdict.effects {
        let head = place_sentence(&effect.kind, &effect.at);
        html.element("h3", &[], &head);
        effect_values(html, effect, input);
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

fn effect_values(html: &mut Html, effect: &NamedEffect, input: &ReportInput<'_>) {
    if let Some(known) = input.effect(&effect.kind) {
        html.element("p", &[], &crate::wording::sentence(known.summary()));
    }
    if effect.parameters.is_empty() {
        return;
    }
    let rows: Vec<(bool, Vec<String>)> = effect
        .parameters
        .iter()
        .map(|p| {
            let e = estimate(p);
            let sense = sense(effect, p, input);
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
        "What it means",
    ];
    table(html, &head, 99, &rows);
}

/// Masses, springs, dampers and gains that the corrected model has otherwise.
fn changes(diagnosis: &Diagnosis, nominal: &Model, corrected: &Model) -> Vec<(bool, Vec<String>)> {
    let mut rows = Vec::new();
    let unit_of_mass = |name: &String| diagnosis.unit_at("kg", &Location::Mass(name.clone()));
    let unit_of_member =
        |unit: &str, pair: &[String; 2]| diagnosis.unit_at(unit, &Location::Between(pair.clone()));
    let mut add = |name: String, unit: &str, was: f64, is: f64| {
        let relative = is / was - 1.0;
        if !relative.is_finite() || relative.abs() < UNCHANGED {
            return;
        }
        let Prefixed { unit, factor } = prefixed(&raised(unit), was.abs());
        let space = if unit.is_empty() { "" } else { "\u{a0}" };
        let shown = |v: f64| format!("{}{space}{unit}", significant(v * factor, 4));
        rows.push((false, vec![name, shown(was), shown(is), change(relative)]));
    };
    for (a, b) in nominal.masses.iter().zip(&corrected.masses) {
        let unit = unit_of_mass(&a.name);
        let what = if unit == "kg" { "mass" } else { "inertia" };
        add(format!("{what} {}", a.name), &unit, a.value, b.value);
    }
    for (a, b) in nominal.springs.iter().zip(&corrected.springs) {
        let unit = unit_of_member("N/m", &a.between);
        add(
            format!("spring {}", a.name),
            &unit,
            a.stiffness,
            b.stiffness,
        );
    }
    for (a, b) in nominal.dampers.iter().zip(&corrected.dampers) {
        let unit = unit_of_member("N s/m", &a.between);
        add(format!("damper {}", a.name), &unit, a.damping, b.damping);
    }
    for (a, b) in nominal.inputs.iter().zip(&corrected.inputs) {
        if let (Some(was), Some(is)) = (a.gain, b.gain) {
            add(format!("gain of input {}", a.channel), "", was, is);
        }
    }
    rows
}
