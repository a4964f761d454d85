//! The score as text.

use crate::plan::{ROLES, Role};
use crate::score::{CaseScore, Score};

fn share(part: usize, of: usize) -> String {
    match of {
        0 => "-".into(),
        _ => format!("{part} of {of} ({:.0} %)", 100.0 * part as f64 / of as f64),
    }
}

fn wanted(role: Role) -> (&'static str, Option<&'static str>) {
    match role {
        Role::Single => ("named first", Some("first or declared")),
        Role::Pair => ("whole pair", Some("both declared")),
        Role::Clean => ("nothing blamed", None),
        Role::Parameters => ("parameters right", Some("or declared")),
        Role::Foreign => ("unknown or incomplete", None),
        Role::Slip => ("slip found", Some("or declared")),
        Role::Mixed => ("main cause first", Some("named or declared")),
    }
}

/// A table of the roles, the figures of the statements, and a line for each wrong case.
#[must_use]
pub fn page(score: &Score) -> String {
    let mut text = String::from("| Role | Wanted | Cases |\n|---|---|---|\n");
    for (role, _) in ROLES {
        let cases: Vec<&CaseScore> = score.cases.iter().filter(|c| c.role == role).collect();
        let (right, declared) = wanted(role);
        let count = |f: fn(&CaseScore) -> bool| cases.iter().filter(|c| f(c)).count();
        let first = share(count(|c| c.right), cases.len());
        text += &format!("| {} | {right} | {first} |\n", role.name());
        if let Some(declared) = declared {
            let either = share(count(|c| c.declared), cases.len());
            text += &format!("| {} | {declared} | {either} |\n", role.name());
        }
    }
    let statements: usize = score.cases.iter().map(|c| c.statements.len()).sum();
    text += &format!(
        "\nExpected calibration error of {statements} statements: {:.3}\n",
        score.calibration_error
    );
    text += &format!(
        "Statements at 0.9 and more that are wrong: {}\n",
        share(score.sure.1, score.sure.0)
    );
    let extra = score.cases.iter().filter(|c| c.extra > 0).count();
    text += &format!("Right cases with more named than is there: {extra}\n");
    text += &format!(
        "Time: median {:.1} s, longest {:.1} s\n",
        score.seconds.0, score.seconds.1
    );
    text += "\nNot as wanted:\n\n";
    for case in score.cases.iter().filter(|c| !c.right) {
        let mark = if case.declared { "(declared) " } else { "" };
        text += &format!("- {mark}{} [{:.1} s]\n", case.line, case.seconds);
    }
    text
}
