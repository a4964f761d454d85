//! Answers against truths.

use serde::Serialize;

use crate::answer::{Diagnosis, Said, same_place};
use crate::kinds::PARAMETERS;
use crate::plan::Role;
use crate::truth::{Named, Truth};

/// What the program said of a case.
#[derive(Debug, Clone)]
pub struct Answer {
    /// `diagnosis.json`; `None` where there is none.
    pub diagnosis: Option<Diagnosis>,
    /// Why there is none.
    pub failure: String,
    /// How long it took, s.
    pub seconds: f64,
}

/// The score of one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseScore {
    /// Folder.
    pub name: String,
    /// Role.
    pub role: Role,
    /// As wanted: named first, whole pair, the right parameters, nothing blamed, unknown.
    pub right: bool,
    /// Right, or the truth is among what is declared indistinguishable.
    pub declared: bool,
    /// The truth is first, but more is blamed than is there.
    pub extra: usize,
    /// Stated probabilities and whether they hold.
    pub statements: Vec<(f64, bool)>,
    /// Truth and answer in a line.
    pub line: String,
    /// s.
    pub seconds: f64,
}

/// The score of all cases.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    /// Per case, in the order given.
    pub cases: Vec<CaseScore>,
    /// Expected calibration error of the statements, ten bins.
    pub calibration_error: f64,
    /// Statements at 0.9 and more, and how many of them are wrong.
    pub sure: (usize, usize),
    /// Median and longest, s.
    pub seconds: (f64, f64),
}

/// Whether a name is the truth or cannot be told from it.
fn is_name_of(kind: &str, at: &serde_json::Value, truth: &Named) -> bool {
    let own = truth.kind == kind && same_place(&truth.at, at);
    own || truth
        .accept
        .iter()
        .any(|t| t.kind == kind && same_place(&t.at, at))
}

fn names(said: &Said, truth: &Named) -> bool {
    is_name_of(&said.kind, &said.at, truth)
}

fn declares(said: &Said, truth: &Named) -> bool {
    names(said, truth)
        || said
            .indistinguishable
            .iter()
            .any(|o| is_name_of(&o.kind, &o.at, truth))
}

/// Whether every truth has an answer of its own.
fn matched(said: &[Said], truths: &[Named], fits: fn(&Said, &Named) -> bool) -> bool {
    let Some((first, rest)) = truths.split_first() else {
        return true;
    };
    (0..said.len()).any(|i| {
        let mut left = said.to_vec();
        fits(&left.remove(i), first) && matched(&left, rest, fits)
    })
}

fn is_parameter(said: &Said) -> bool {
    PARAMETERS.contains(&said.kind.as_str())
}

/// A named parameter whose error is there and as small as it is said to be.
fn within_deviations(said: &Said, truth: &Truth) -> bool {
    /// What a factor may be off beside its interval.
    const MARGIN: f64 = 0.03;
    if !is_parameter(said) {
        return false;
    }
    let there = truth.deviations.iter().find(|d| names(said, d));
    let factor = there
        .and_then(|d| d.parameters.values().next())
        .and_then(serde_json::Value::as_f64)
        .unwrap_or(1.0);
    said.parameters.first().is_some_and(|p| {
        let near = p.value.is_some_and(|v| (v - factor).abs() <= MARGIN);
        let inside = p.ci95.is_some_and(|[low, high]| {
            low.is_some_and(|l| l - MARGIN <= factor) && high.is_some_and(|h| factor <= h + MARGIN)
        });
        near || inside
    })
}

/// Right and declared for the roles.
fn judged(truth: &Truth, diagnosis: &Diagnosis) -> (bool, bool) {
    let verdict = &diagnosis.verdict;
    let said = &verdict.effects;
    let blames = verdict.status == "effect" || verdict.status == "parameters";
    let open = verdict.status == "unknown" || verdict.complete == Some(false);
    if truth.status == "unknown" {
        return (open, open);
    }
    match truth.role {
        Role::Clean => {
            let right = match verdict.status.as_str() {
                "none" => true,
                "parameters" => said.iter().all(|s| within_deviations(s, truth)),
                _ => false,
            };
            (right, right)
        }
        Role::Parameters => {
            let rest = said
                .iter()
                .all(|s| is_parameter(s) || truth.effects.iter().any(|t| names(s, t)));
            let right = blames && rest && matched(said, &truth.effects, names);
            (
                right,
                right || (blames && matched(said, &truth.effects, declares)),
            )
        }
        Role::Pair => {
            let whole = blames && said.len() == truth.effects.len();
            let right = whole && matched(said, &truth.effects, names);
            (
                right,
                right || (blames && matched(said, &truth.effects, declares)),
            )
        }
        Role::Single | Role::Slip | Role::Foreign | Role::Mixed => {
            let Some(only) = truth.effects.first() else {
                return (open, open);
            };
            let first = blames && said.first().is_some_and(|s| names(s, only));
            (
                first,
                first || (blames && said.iter().any(|s| declares(s, only))),
            )
        }
    }
}

/// Stated probabilities that can be judged: small parameter errors that are there are left out.
fn statements(truth: &Truth, diagnosis: &Diagnosis) -> Vec<(f64, bool)> {
    let said = diagnosis.verdict.effects.iter();
    said.filter_map(|s| {
        let holds = truth.effects.iter().any(|t| declares(s, t));
        let small = is_parameter(s) && truth.deviations.iter().any(|d| names(s, d));
        (holds || !small).then_some((s.probability?, holds))
    })
    .collect()
}

fn place(at: &serde_json::Value) -> String {
    let pair = |v: &serde_json::Value| match v.as_array() {
        Some(list) => list
            .iter()
            .filter_map(|n| n.as_str())
            .collect::<Vec<_>>()
            .join("-"),
        None => v.as_str().unwrap_or("?").to_owned(),
    };
    at.as_object()
        .and_then(|o| o.values().next())
        .map_or_else(|| "?".into(), pair)
}

fn line(truth: &Truth, answer: &Answer) -> String {
    let true_names = truth.effects.iter().chain(&truth.foreign);
    let was: Vec<String> = true_names
        .map(|e| format!("{}@{}", e.kind, place(&e.at)))
        .collect();
    let was = if was.is_empty() {
        "nothing".into()
    } else {
        was.join(" + ")
    };
    let slip = truth
        .slip
        .as_ref()
        .map_or(String::new(), |s| format!(" ({s})"));
    let got = match &answer.diagnosis {
        None => format!("no answer: {}", answer.failure),
        Some(d) => {
            let one = |s: &Said| {
                let others: Vec<String> = s
                    .indistinguishable
                    .iter()
                    .map(|o| format!("{}@{}", o.kind, place(&o.at)))
                    .collect();
                let or = if others.is_empty() {
                    String::new()
                } else {
                    format!(" or {}", others.join("/"))
                };
                format!(
                    "{}@{} {:.2}{or}",
                    s.kind,
                    place(&s.at),
                    s.probability.unwrap_or(f64::NAN)
                )
            };
            let named: Vec<String> = d.verdict.effects.iter().map(one).collect();
            let complete = if d.verdict.complete == Some(false) {
                ", incomplete"
            } else {
                ""
            };
            let figure = |v: Option<f64>| v.map_or("-".into(), |v| format!("{v:.3}"));
            format!(
                "{}{complete}: {} | gap {} -> {} -> {}, floor {}",
                d.verdict.status,
                named.join(" + "),
                figure(d.gap.nominal),
                figure(d.gap.recalibrated),
                figure(d.gap.corrected),
                figure(d.gap.noise_floor)
            )
        }
    };
    format!(
        "{} {}{slip} {} [{}; {}] gap {:.3} noise {:.4}{}{} => {got}",
        truth.name,
        truth.role.name(),
        was,
        truth.plant,
        truth.excitations.join(","),
        truth.gap,
        truth.noise.rms_share,
        if truth.noise.ar1 > 0.0 {
            " coloured"
        } else {
            ""
        },
        if truth.noise.input_share > 0.0 {
            " input-noise"
        } else {
            ""
        },
    )
}

fn score_case(truth: &Truth, answer: &Answer) -> CaseScore {
    let (right, declared, statements, extra) = match &answer.diagnosis {
        Some(d) => {
            let (right, declared) = judged(truth, d);
            let extra = d.verdict.effects.len().saturating_sub(truth.effects.len());
            (
                right,
                declared,
                statements(truth, d),
                if right { extra } else { 0 },
            )
        }
        None => (false, false, vec![], 0),
    };
    CaseScore {
        name: truth.name.clone(),
        role: truth.role,
        right,
        declared,
        extra,
        statements,
        line: line(truth, answer),
        seconds: answer.seconds,
    }
}

/// Expected calibration error: what stated probabilities and shares that hold are apart, bin by bin,
/// weighted by the number of statements.
#[must_use]
pub fn calibration_error(statements: &[(f64, bool)]) -> f64 {
    const BINS: usize = 10;
    let mut error = 0.0;
    for bin in 0..BINS {
        let of = |p: f64| ((p * BINS as f64) as usize).min(BINS - 1);
        let inside: Vec<_> = statements.iter().filter(|(p, _)| of(*p) == bin).collect();
        let stated: f64 = inside.iter().map(|(p, _)| p).sum();
        let held = inside.iter().filter(|(_, h)| *h).count() as f64;
        error += (stated - held).abs();
    }
    error / statements.len().max(1) as f64
}

/// The score of answers, each beside its truth.
#[must_use]
pub fn score(pairs: &[(Truth, Answer)]) -> Score {
    let cases: Vec<CaseScore> = pairs.iter().map(|(t, a)| score_case(t, a)).collect();
    let statements: Vec<(f64, bool)> = cases.iter().flat_map(|c| c.statements.clone()).collect();
    let sure = statements.iter().filter(|(p, _)| *p >= 0.9);
    let wrong = sure.clone().filter(|(_, holds)| !holds).count();
    let mut seconds: Vec<f64> = cases.iter().map(|c| c.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    Score {
        calibration_error: calibration_error(&statements),
        sure: (sure.count(), wrong),
        seconds: (
            seconds.get(seconds.len() / 2).copied().unwrap_or(0.0),
            seconds.last().copied().unwrap_or(0.0),
        ),
        cases,
    }
}
