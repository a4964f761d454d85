//! The score as text.

use simgap_rigs::Answer;

use super::truth::{Judged, Truth};

/// A statement that is as sure as this is wrong in one of ten cases at the most.
const SURE: f64 = 0.9;

/// A machine, or a draw of it, with its truth and what was said.
pub(super) struct Case {
    /// Folder.
    pub(super) name: String,
    pub(super) truth: Truth,
    pub(super) answer: Answer,
}

impl Case {
    pub(super) fn judged(&self) -> Judged {
        self.truth.judge(&self.answer)
    }

    /// Whether another cause is named first, and surely.
    fn is_surely_wrong(&self) -> bool {
        let verdict = self.answer.diagnosis.as_ref().map(|d| &d.verdict);
        let first = verdict.and_then(|verdict| verdict.effects.first());
        let probability = first.and_then(|effect| effect.probability);
        self.judged() == Judged::Wrong && probability.is_some_and(|p| p >= SURE)
    }

    fn said(&self) -> String {
        let Some(diagnosis) = &self.answer.diagnosis else {
            return self.answer.failure.clone();
        };
        let verdict = &diagnosis.verdict;
        let effects = verdict.effects.iter().map(|effect| {
            let probability = effect.probability.map_or("-".into(), |p| format!("{p:.2}"));
            format!("{} {probability}", effect.kind)
        });
        let effects: Vec<String> = effects.collect();
        match effects.is_empty() {
            true => format!("`{}`", verdict.status),
            false => effects.join(", "),
        }
    }
}

fn figure(value: Option<f64>) -> String {
    match value {
        Some(value) if value < 0.1 => format!("{value:.3}"),
        Some(value) => format!("{value:.2}"),
        None => "-".into(),
    }
}

/// How many are judged how, in a line.
pub(super) fn totals(cases: &[Case]) -> String {
    let count = |judged| cases.iter().filter(|case| case.judged() == judged).count();
    let sure = cases.iter().filter(|case| case.is_surely_wrong()).count();
    let mut seconds: Vec<f64> = cases.iter().map(|case| case.answer.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let last = seconds.len().saturating_sub(1) as f64;
        seconds.get((share * last) as usize).copied().unwrap_or(0.0)
    };
    format!(
        "{} diagnoses: {} right, {} more declare the cause as what cannot be told from what they name, {} do not name it, {} name another \
         ({sure} of them at {SURE} or more), {} gave no answer; {:.1} s on one thread (median), {:.1} s at most",
        cases.len(),
        count(Judged::Right),
        count(Judged::Declared),
        count(Judged::Unnamed),
        count(Judged::Wrong),
        count(Judged::Failed),
        at(0.5),
        at(1.0),
    )
}

/// A line for each case, with the gap as given, re-estimated and corrected, and what a fit by hand reaches.
pub(super) fn lines(cases: &[Case]) -> String {
    let mut text = String::from(
        "| Machine | Known cause | Said first, with its probability, and beside | | Gap as given, re-estimated, corrected | By hand, re-estimated, with the cause |\n\
         |---|---|---|---|---|---|\n",
    );
    for case in cases {
        let diagnosis = case.answer.diagnosis.as_ref();
        let gap = diagnosis.map(|d| d.gap).unwrap_or_default();
        let known = match case.truth.accepted.is_empty() {
            true => "nothing".into(),
            false => case.truth.accepted.join(" or "),
        };
        let by_hand = case.truth.by_hand.map_or("-".into(), |by_hand| {
            let figures = [by_hand.recalibrated, by_hand.with_cause];
            figures.map(figure).join(", ")
        });
        let figures = [gap.nominal, gap.recalibrated, gap.corrected].map(figure);
        text += &format!(
            "| {} | {known} | {} | {} | {} | {by_hand} |\n",
            case.name,
            case.said(),
            case.judged().name(),
            figures.join(", "),
        );
    }
    text
}

/// What the machines are.
fn sources(cases: &[Case]) -> String {
    let each = cases.iter().map(|Case { name, truth, .. }| {
        let (source, licence, cause) = (&truth.source, &truth.licence, &truth.cause);
        format!("- **{name}** ({source}; {licence}): {cause}.\n")
    });
    each.collect()
}

/// The page on real machines.
pub(super) fn page(cases: &[Case]) -> String {
    format!(
        "# Real machines\n\n\
         Written by `cargo xtask machines --write`. The measurements are excerpts of published packages under open licences, made into \
         cases by authors who had not read the diagnosis; the cause of each gap is documented there, or separated by a fit by hand. Each \
         machine is a folder of `fixtures/machines`. They are looked at while the program is changed: development data, no report on \
         machines that it has not seen. `cargo xtask machines --root DIR` scores machines that are kept elsewhere, `--draws N` adds a \
         little noise to their outputs.\n\n{}.\n\n{}\n## Sources and causes\n\n{}",
        totals(cases),
        lines(cases),
        sources(cases)
    )
}
