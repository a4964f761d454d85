//! The page of a campaign, and a paragraph on each case.

use std::fmt::Write as _;

use serde_json::Value;
use simgap_blind::{
    Answer, Hidden, Score, SealedCase, Spread, Totals, render_calibration, render_confusion,
    render_figures, render_requirements,
};
use simgap_model::Model;

use super::judged::Judged;
use super::plan::Planned;
use super::worker::Reply;
use super::{Args, LevelArg};

/// What is required beside what is measured, and what that is made of.
pub(super) fn tables(standard: &Totals, hard: &Totals, judged: &[Judged]) -> String {
    let mut text = render_requirements(standard, hard);
    let mut part = |title: &str, table: String| {
        // Writing to a string does not fail.
        let _ = write!(text, "\n## {title}\n\n{table}");
    };
    part("In detail", render_figures(standard));
    part("Stated probabilities", render_calibration(standard));
    part("Truth and what was said", render_confusion(standard));
    if hard.cases > 0 {
        part("Hard cases in detail", render_figures(hard));
        part(
            "Hard cases: truth and what was said",
            render_confusion(hard),
        );
    }
    part("Time", time(judged));
    text
}

fn time(judged: &[Judged]) -> String {
    let seconds: Vec<f64> = judged.iter().map(|j| j.seconds).collect();
    let longest = seconds.iter().fold(0.0, |m: f64, &s| m.max(s));
    let spread = Spread::of(seconds);
    let failed = judged.iter().filter(|j| j.is_failed).count();
    format!(
        "One diagnosis on one thread takes {:.1} s (median), {longest:.1} s at most; {failed} of {} gave no answer.\n",
        spread.median,
        judged.len()
    )
}

/// The page in `docs/`.
pub(super) fn page(args: &Args, digest: &str, tables: &str) -> String {
    format!(
        "# Withheld cases\n\n\
         Written by `{}`.\n\
         Seeds 1 to 999 set thresholds, 1000 to 1999 are for reporting.\n\
         SHA-256 of the sealed truths, told before anything was diagnosed: `{digest}`.\n\n\
         Each case is diagnosed in a process of its own that is given a folder with the nominal model and three\n\
         records; the truths are opened afterwards. A failed diagnosis is a wrong answer. `none, exact` are cases of\n\
         noise alone with the right parameters, where naming parameters counts as a false alarm too.\n\n\
         {tables}",
        command(args)
    )
}

/// The command that draws and scores the same cases.
fn command(args: &Args) -> String {
    let mut text = format!(
        "cargo xtask blind-check --cases {} --seed {}",
        args.cases, args.seed
    );
    if args.short {
        return "cargo xtask blind-check --short".to_string();
    }
    if args.level == LevelArg::Hard {
        text.push_str(" --level hard");
    }
    if args.hard > 0 {
        let _ = write!(text, " --hard {}", args.hard);
    }
    if !args.kinds.is_empty() {
        let _ = write!(text, " --kinds {}", args.kinds.join(","));
    }
    for kind in &args.withhold {
        let _ = write!(text, " --withhold {kind}");
    }
    if args.withhold_each {
        text.push_str(" --withhold-each");
    }
    if args.withheld_cases != 1 {
        let _ = write!(text, " --withheld-cases {}", args.withheld_cases);
    }
    if let Some(only) = args.only {
        let _ = write!(text, " --only {only}");
    }
    text + " --out FILE"
}

/// The paragraphs on the cases that are not right, or on all.
pub(super) fn details(judged: &[Judged], all: bool) -> String {
    let mut text = String::from(if all {
        "## Cases\n\n"
    } else {
        "## Cases that are not right\n\n"
    });
    for case in judged.iter().filter(|j| all || !j.is_right()) {
        text.push_str(&case.detail);
    }
    text
}

/// A paragraph on one case: what is there, what was said, with numbers.
pub(super) fn detail(
    case: &SealedCase,
    plan: &Planned,
    model: &Model,
    score: &Score,
    answer: &Answer,
    reply: Result<&Reply, &str>,
) -> String {
    let truth = &case.truth;
    let outputs: Vec<String> = model
        .outputs
        .iter()
        .map(|o| format!("{:?} {}", o.kind, o.at.as_deref().unwrap_or("-")))
        .collect();
    let besides = match score.extra.join(", ") {
        extra if extra.is_empty() => "nothing besides".to_string(),
        extra => format!("besides {extra}"),
    };
    let role = format!("{:?}", score.role).to_lowercase();
    let mut text = format!(
        "{} {} ({role}): {} ({besides})\n  plant: {}, outputs {}; noise {:.2} %, gaps {:.3?}\n",
        case.name,
        plan.recipe,
        score.outcome().label(),
        model.name,
        outputs.join(", "),
        100.0 * truth.noise_share,
        truth.gaps,
    );
    for hidden in &truth.effects {
        let _ = writeln!(text, "  truth: {}", hidden_text(hidden));
    }
    match reply {
        Err(why) => {
            let _ = writeln!(text, "  failed: {why}\n");
            return text;
        }
        Ok(reply) => said(&mut text, &reply.diagnosis, reply.seconds),
    }
    if let Some(closing) = score.closing {
        let _ = writeln!(
            text,
            "  closed: stated {:.3}, true {:.3}, best possible {:.3}",
            closing.stated, closing.actual, closing.best
        );
    }
    for named in &answer.named {
        let rivals = named.indistinguishable.iter();
        let rivals: Vec<String> = rivals.map(|(kind, at)| format!("{kind} {at}")).collect();
        let _ = writeln!(
            text,
            "  said:  {} {} p {:.2}{} rivals [{}]",
            named.kind,
            named.at,
            named.probability,
            if named.is_incomplete {
                " incomplete"
            } else {
                ""
            },
            rivals.join(", ")
        );
    }
    text.push('\n');
    text
}

/// Gap, values and single candidates of a diagnosis.
fn said(text: &mut String, diagnosis: &Value, seconds: f64) {
    let gap = |name: &str| diagnosis["gap"][name].as_f64().unwrap_or(f64::NAN);
    let _ = writeln!(
        text,
        "  gap nominal {:.3} recalibrated {:.3} corrected {:.3} floor {:.3}; status {}; {seconds:.1} s",
        gap("nominal"),
        gap("recalibrated"),
        gap("corrected"),
        gap("noise_floor"),
        diagnosis["verdict"]["status"].as_str().unwrap_or("-"),
    );
    for effect in diagnosis["verdict"]["effects"]
        .as_array()
        .into_iter()
        .flatten()
    {
        let parameters = effect["parameters"].as_array().into_iter().flatten();
        let values: Vec<String> = parameters
            .map(|p| {
                let value = p["value"].as_f64().unwrap_or(f64::NAN);
                format!("{} {value:.4e}", p["name"].as_str().unwrap_or("-"))
            })
            .collect();
        let _ = writeln!(text, "  found: {} [{}]", effect["kind"], values.join(", "));
    }
    let candidates = diagnosis["candidates"].as_array().into_iter().flatten();
    let candidates: Vec<String> = candidates
        .take(5)
        .map(|c| {
            let gap = c["held_back_gap"].as_f64().unwrap_or(f64::NAN);
            format!("{} {} {gap:.3}", c["kind"].as_str().unwrap_or("-"), c["at"])
        })
        .collect();
    let _ = writeln!(text, "  singles: {}", candidates.join("; "));
}

fn hidden_text(hidden: &Hidden) -> String {
    let values: Vec<String> = hidden
        .parameters
        .iter()
        .map(|(name, value)| format!("{name} {value:.4e}"))
        .collect();
    format!("{} {} [{}]", hidden.kind, hidden.at, values.join(", "))
}
