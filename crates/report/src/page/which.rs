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
/// A law of any shape that explains this share of what is left speaks against the law named.
const ANOTHER_LAW: f64 = 0.3;

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
    html.within("div", &[("class", "pair stack")], |html| {
        ranking(html, files, diagnosis)?;
        html.within("div", &[], |html| {
            for effect in &diagnosis.verdict.effects {
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
    let (evidence, doubt) = divided(effect);
    if !evidence.is_empty() {
        html.element("p", &[("class", "sub")], "For");
        let evidence: Vec<String> = evidence.iter().map(|line| plain(line)).collect();
        list(html, &evidence);
    }
    html.element("p", &[("class", "sub")], "Against");
    let doubt = doubt.map(|line| plain(line));
    let against: Vec<String> = doubt
        .into_iter()
        .chain(against(diagnosis, effect))
        .collect();
    if against.is_empty() {
        html.element("p", &[], "Nothing in these records.");
    } else {
        list(html, &against);
    }
}

/// What speaks for an effect, and what says that it may only stand in for another law.
fn divided(effect: &NamedEffect) -> (&[String], Option<&String>) {
    match effect.evidence.split_last() {
        Some((doubt, rest)) if effect.stand_in => (rest, Some(doubt)),
        _ => (&effect.evidence, None),
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

/// What the best set of effects leaves of the training records, and whether a law of another shape
/// would explain it.
fn left_over(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.verdict.status == Status::None {
        return;
    }
    let left = &diagnosis.remainder;
    html.element("h3", &[], "What is left in the training records");
    let best = match diagnosis.verdict.status {
        Status::Unknown => "The best that the catalogue offers",
        _ => "The answer",
    };
    let mut text = if left.over_noise > STANDS_OUT {
        format!("{best} leaves {} times the noise.", times(left.over_noise))
    } else {
        format!("{best} leaves no more than noise.")
    };
    if let Some(at) = left.law_at.as_ref()
        && left.over_noise > STANDS_OUT
        && left.law_share > ANOTHER_LAW
    {
        let named = diagnosis.verdict.effects.iter().any(|e| &e.at == at);
        let so = if named {
            "so the law there may be another than the one named"
        } else {
            "so something acts there that is not named"
        };
        text.push_str(&format!(
            " A law of free shape {} would explain {} of that, {so}.",
            place(at),
            percent(left.law_share)
        ));
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
