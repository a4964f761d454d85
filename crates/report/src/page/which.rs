//! Which effect: the ranking, what speaks for and against, what cannot be told apart.

use simgap_diagnose::{CandidateResult, Diagnosis, NamedEffect, Status};

use super::ReportError;
use super::answer::place_sentence;
use super::picture::{Picture, PictureFile};
use super::tables::{list, table};
use crate::chart::{Bar, BarChart, Role};
use crate::markup::Html;
use crate::number::{percent, ratio};
use crate::unit::estimate;
use crate::wording::{SURE, effect_at, kind, place, sentence};

/// Candidates of the picture.
const RANKED: usize = 8;
/// Candidates of the table shown at once; the rest is folded away.
const FIRST_CANDIDATES: usize = 6;
/// A corrected gap this many times the noise floor leaves something to explain.
const STANDS_OUT: f64 = 1.2;

/// The whole section.
pub(super) fn which(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    diagnosis: &Diagnosis,
) -> Result<(), ReportError> {
    let title = match diagnosis.verdict.status {
        Status::Parameters => "Which parameter is off",
        _ => "Which effect it is",
    };
    html.element("h2", &[], title);
    match diagnosis.verdict.status {
        Status::None => html.element(
            "p",
            &[],
            "None: the model as given predicts the records as well as their noise allows.",
        ),
        Status::Unknown => html.element(
            "p",
            &[],
            "None is named: what the catalogue offers leaves too much of the gap to be believed.",
        ),
        Status::Parameters | Status::Effect => {}
    }
    html.within("div", &[("class", "pair")], |html| {
        ranking(html, files, diagnosis)?;
        html.within("div", &[], |html| {
            for effect in &diagnosis.verdict.effects {
                for_and_against(html, diagnosis, effect);
            }
            ambiguity(html, diagnosis);
        });
        Ok::<(), ReportError>(())
    })?;
    candidates(html, diagnosis);
    Ok(())
}

/// Probabilities of the named effects and of every single effect tried.
fn ranking(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    diagnosis: &Diagnosis,
) -> Result<(), ReportError> {
    let named = &diagnosis.verdict.effects;
    let mut bars: Vec<Bar> = named
        .iter()
        .map(|e| Bar::share(short(&e.kind, &e.at), e.probability, Role::Corrected))
        .collect();
    let others = diagnosis
        .candidates
        .iter()
        .filter(|c| !is_named(diagnosis, c));
    bars.extend(others.map(|c| Bar::share(short(&c.kind, &c.at), c.probability, Role::Nominal)));
    bars.truncate(RANKED.max(named.len()));
    if bars.is_empty() || named.is_empty() {
        return Ok(());
    }
    let mut chart = BarChart::shares("Ranking: probability that each is part of the cause", bars);
    chart.axis_label = "probability [%]".to_owned();
    let note =
        "Blue: named. Orange: rivals. The sum may pass 100 %, since several can act at once.";
    Picture::bars("ranking", chart)?
        .with_note(note)
        .show(html, files);
    Ok(())
}

/// "Coulomb friction, mold–ground".
fn short(name: &str, at: &simgap_model::Location) -> String {
    use simgap_model::Location;
    let at = match at {
        Location::Between([a, b]) => format!("{a}–{b}"),
        Location::Mass(name) | Location::Input(name) | Location::Channel(name) => name.clone(),
    };
    format!("{}, {at}", kind(name))
}

fn is_named(diagnosis: &Diagnosis, candidate: &CandidateResult) -> bool {
    let named = &diagnosis.verdict.effects;
    named
        .iter()
        .any(|e| e.kind == candidate.kind && e.at == candidate.at)
}

fn for_and_against(html: &mut Html, diagnosis: &Diagnosis, effect: &NamedEffect) {
    let head = format!(
        "{}, probability {}",
        place_sentence(&effect.kind, &effect.at),
        percent(effect.probability)
    );
    html.element("h3", &[], &head);
    if !effect.evidence.is_empty() {
        html.element("p", &[("class", "sub")], "For");
        list(html, &effect.evidence);
    }
    html.element("p", &[("class", "sub")], "Against");
    let against = against(diagnosis, effect);
    if against.is_empty() {
        html.element("p", &[], "Nothing in these records.");
    } else {
        list(html, &against);
    }
}

/// What weakens the answer.
fn against(diagnosis: &Diagnosis, effect: &NamedEffect) -> Vec<String> {
    let mut out = Vec::new();
    if effect.probability < SURE {
        out.push(format!(
            "its probability of {} leaves room for its rivals",
            percent(effect.probability)
        ));
    }
    if !effect.indistinguishable.is_empty() {
        let names: Vec<String> = effect
            .indistinguishable
            .iter()
            .map(|r| effect_at(&r.kind, &r.at))
            .collect();
        out.push(format!(
            "{} fits these records as well",
            crate::wording::list(&names)
        ));
    }
    for p in &effect.parameters {
        if !(p.ci95[0].is_finite() && p.ci95[1].is_finite()) {
            out.push(format!(
                "these records do not bound its {}",
                estimate(p, "").words
            ));
        }
    }
    let gap = &diagnosis.gap;
    if gap.corrected > STANDS_OUT * gap.noise_floor {
        out.push(format!(
            "with all that is named the gap is still {}, {} times the noise: something smaller is left",
            ratio(gap.corrected),
            crate::number::significant(gap.corrected / gap.noise_floor, 2)
        ));
    }
    out
}

/// What the data cannot tell apart.
fn ambiguity(html: &mut Html, diagnosis: &Diagnosis) {
    let effects = &diagnosis.verdict.effects;
    if effects.is_empty() {
        return;
    }
    html.element("h3", &[], "What these records cannot tell apart");
    if effects.iter().all(|e| e.indistinguishable.is_empty()) {
        let none = "Nothing: no other effect of the catalogue explains them as well.";
        html.element("p", &[], none);
    }
    for effect in effects.iter().filter(|e| !e.indistinguishable.is_empty()) {
        let head = format!(
            "In place of {} {} it could also be:",
            kind(&effect.kind),
            place(&effect.at)
        );
        html.element("p", &[], &head);
        let rivals: Vec<String> = effect
            .indistinguishable
            .iter()
            .map(|r| format!("{} {}: {}", kind(&r.kind), place(&r.at), r.because))
            .collect();
        list(html, &rivals);
    }
}

/// Every single effect that was tried, best first.
fn candidates(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.candidates.is_empty() {
        return;
    }
    html.element("h3", &[], "Each effect alone");
    let how = "Added to the re-estimated model, one at a time. The gap is on the check records, which nothing was fitted to. Named effects are bold.";
    html.element("p", &[], how);
    let row = |c: &CandidateResult| {
        let text = sentence(&kind(&c.kind)).trim_end_matches('.').to_owned();
        (
            is_named(diagnosis, c),
            vec![
                text,
                place(&c.at),
                ratio(c.held_back_gap),
                percent(c.probability),
            ],
        )
    };
    let rows: Vec<(bool, Vec<String>)> = diagnosis.candidates.iter().map(row).collect();
    let head = ["Effect", "Where", "Gap", "Probability"];
    let (first, rest) = rows.split_at(rows.len().min(FIRST_CANDIDATES));
    table(html, &head, 2, first);
    if !rest.is_empty() {
        html.within("details", &[], |html| {
            html.element("summary", &[], &format!("{} more", rest.len()));
            table(html, &head, 2, rest);
        });
    }
}
