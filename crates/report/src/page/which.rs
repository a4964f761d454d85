//! Which effect: the ranking, what speaks for and against, what cannot be told apart.

use simgap_diagnose::{CandidateResult, Diagnosis, NamedEffect, Status};

use super::ReportError;
use super::answer::place_sentence;
use super::picture::{Picture, PictureFile};
use super::tables::{list, table};
use crate::chart::{Bar, BarChart, Role};
use crate::markup::Html;
use crate::number::{percent, ratio};
use crate::unit::quantity;
use crate::wording::{SURE, effect_at, kind, place, plain, sentence};

/// Candidates of the picture.
const RANKED: usize = 8;
/// Candidates of the table shown at once; the rest is folded away.
const FIRST_CANDIDATES: usize = 6;
/// A corrected gap this many times the noise floor leaves something to explain.
const STANDS_OUT: f64 = 1.5;

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
            "None is named: a cause outside the catalogue is likelier than the best set of the catalogue, which is shown here.",
        ),
        Status::Parameters | Status::Effect => {}
    }
    html.within("div", &[("class", "pair stack")], |html| {
        ranking(html, files, diagnosis)?;
        html.within("div", &[], |html| {
            let verdict = &diagnosis.verdict;
            for effect in verdict.effects.iter().chain(&verdict.leading) {
                for_and_against(html, diagnosis, effect);
            }
            ambiguity(html, diagnosis);
            left_over(html, diagnosis);
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
    bars.sort_by(|a, b| b.value.total_cmp(&a.value));
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
        Location::Mass(name)
        | Location::Input(name)
        | Location::Channel(name)
        | Location::Parameter(name) => name.clone(),
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
        let evidence: Vec<String> = effect.evidence.iter().map(|line| plain(line)).collect();
        list(html, &evidence);
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
                quantity(&p.name).words
            ));
        }
    }
    let gap = &diagnosis.gap;
    if gap.corrected > STANDS_OUT * gap.noise_floor {
        out.push(format!(
            "with all that is named the gap is still {}, {} times the noise of the sensors: something smaller is left",
            ratio(gap.corrected),
            times(gap.corrected / gap.noise_floor)
        ));
    }
    out
}

/// What the answer leaves of the check records, and whether a law outside the catalogue is likelier.
fn left_over(html: &mut Html, diagnosis: &Diagnosis) {
    let verdict = &diagnosis.verdict;
    if verdict.status == Status::None {
        return;
    }
    html.element("h3", &[], "What is left");
    let left = &verdict.unexplained;
    let mut text = if verdict.complete {
        "The answer is complete: it leaves no more than noise and the accuracy of the simulation."
            .to_owned()
    } else {
        format!(
            "The answer is incomplete: {} of the gap is left on the check records.",
            percent(left.share)
        )
    };
    if !verdict.complete && !left.looks_like.is_empty() {
        text.push_str(&format!(" {}", sentence(&plain(&left.looks_like))));
    }
    text.push_str(&format!(
        " Probability that the main cause is not in the catalogue: {}.",
        percent(verdict.other.probability)
    ));
    if let (Some(at), Some(closed)) = (&verdict.other.at, verdict.other.closed) {
        text.push_str(&format!(
            " A free law {} closes {} of the gap of the training records.",
            place(at),
            percent(closed)
        ));
    }
    if verdict.refuted {
        text.push_str(" The check records refute it: it closes less than half of the gap there.");
    }
    html.element("p", &[], &text);
}

/// A large ratio: "7.5", "more than 100".
fn times(ratio: f64) -> String {
    if ratio < 100.0 {
        crate::number::significant(ratio, 2)
    } else {
        "more than 100".to_owned()
    }
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
            .map(|r| format!("{} {}: {}", kind(&r.kind), place(&r.at), plain(&r.because)))
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
    let any = !diagnosis.verdict.effects.is_empty();
    let how = "Added to the re-estimated model, one at a time. The gap is on the check records, which nothing was fitted to.";
    let bold = if any { " Named effects are bold." } else { "" };
    html.element("p", &[], &format!("{how}{bold}"));
    let head = ["Effect", "Where", "Gap (nrmse)", "Probability"];
    // Probabilities are those of an answer.
    let columns = if any { 4 } else { 3 };
    let row = |c: &CandidateResult| {
        let text = sentence(&kind(&c.kind)).trim_end_matches('.').to_owned();
        let gap = ratio(c.held_back_gap);
        let mut cells = vec![text, place(&c.at), gap, percent(c.probability)];
        cells.truncate(columns);
        (is_named(diagnosis, c), cells)
    };
    let rows: Vec<(bool, Vec<String>)> = diagnosis.candidates.iter().map(row).collect();
    let head = &head[..columns];
    let mut place_in_list = 0;
    let (first, rest): (Vec<_>, Vec<_>) = rows.into_iter().partition(|(named, _)| {
        place_in_list += 1;
        *named || place_in_list <= FIRST_CANDIDATES
    });
    table(html, head, 2, &first);
    if !rest.is_empty() {
        html.within("details", &[], |html| {
            html.element("summary", &[], &format!("{} more", rest.len()));
            table(html, head, 2, &rest);
        });
    }
}
