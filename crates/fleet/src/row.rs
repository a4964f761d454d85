//! Rows of the table.

use simgap_app::diagnosis::Answer;
use simgap_diagnose::{NamedEffect, NamedParameter, Status};
use simgap_model::Location;

/// Columns that every table has, with those that its folders hold; conditions have other names.
pub const FIXED_COLUMNS: [&str; 23] = [
    "machine",
    "date",
    "role",
    "status",
    "complete",
    "refuted",
    "kind",
    "place",
    "probability",
    "parameter",
    "value",
    "low",
    "high",
    "prior_std",
    "gap_nominal",
    "gap_corrected",
    "noise_floor",
    "closed",
    "reason",
    "train",
    "check",
    "inputs",
    "version",
];

/// What a row tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A parameter of a named effect.
    Named,
    /// For the status `unknown`: a parameter of the best set of the catalogue all the same.
    Leading,
    /// Nothing is named.
    Nothing,
    /// A nominal parameter beside what is named.
    Nominal,
    /// The diagnosis failed.
    Failed,
}

impl Role {
    /// All of them.
    pub const ALL: [Role; 5] = [
        Role::Named,
        Role::Leading,
        Role::Nothing,
        Role::Nominal,
        Role::Failed,
    ];

    /// As the table writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Role::Named => "named",
            Role::Leading => "leading",
            Role::Nothing => "nothing",
            Role::Nominal => "nominal",
            Role::Failed => "failed",
        }
    }
}

/// One row: a diagnosis with one parameter of one effect. Machine, date and conditions are those of its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What it tells.
    pub role: Role,
    /// `none`, `parameters`, `effect`, `unknown` or `failed`.
    pub status: String,
    /// What is left is no more than noise.
    pub complete: Option<bool>,
    /// The check records contradict the answer.
    pub refuted: Option<bool>,
    /// Catalogue name.
    pub kind: Option<String>,
    /// Where it acts, in words.
    pub place: Option<String>,
    /// Probability that it, or what cannot be told from it, is part of the cause.
    pub probability: Option<f64>,
    /// Name of the parameter with its unit.
    pub parameter: Option<String>,
    /// Estimate.
    pub value: Option<f64>,
    /// Lower end of its 95 % interval; may be infinite.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
    /// Relative standard deviation of the prior that a nominal parameter was held by.
    pub prior_std: Option<f64>,
    /// Gap of the model as given, on the check records.
    pub gap_nominal: Option<f64>,
    /// Gap of the corrected model.
    pub gap_corrected: Option<f64>,
    /// What noise alone leaves.
    pub noise_floor: Option<f64>,
    /// Share of the gap that is closed.
    pub closed: Option<f64>,
    /// Why the diagnosis failed.
    pub reason: Option<String>,
}

impl Row {
    /// A failed diagnosis.
    #[must_use]
    pub fn failed(reason: String) -> Row {
        Row {
            role: Role::Failed,
            status: "failed".to_owned(),
            complete: None,
            refuted: None,
            kind: None,
            place: None,
            probability: None,
            parameter: None,
            value: None,
            low: None,
            high: None,
            prior_std: None,
            gap_nominal: None,
            gap_corrected: None,
            noise_floor: None,
            closed: None,
            reason: Some(reason),
        }
    }

    fn with(
        &self,
        role: Role,
        kind: &str,
        place: &impl ToString,
        p: Option<&NamedParameter>,
    ) -> Row {
        Row {
            role,
            kind: Some(kind.to_owned()),
            place: Some(place.to_string()),
            parameter: p.map(|p| p.name.clone()),
            value: p.map(|p| p.value),
            low: p.map(|p| p.ci95[0]),
            high: p.map(|p| p.ci95[1]),
            ..self.clone()
        }
    }
}

/// The rows of an answer: one for each parameter of each named effect, one where nothing is named, then one for each
/// nominal parameter that is not named.
#[must_use]
pub(crate) fn rows(answer: &Answer) -> Vec<Row> {
    let diagnosis = &answer.outcome.diagnosis;
    let verdict = &diagnosis.verdict;
    let base = Row {
        role: Role::Nothing,
        status: status(verdict.status).to_owned(),
        complete: Some(verdict.complete),
        refuted: Some(verdict.refuted),
        gap_nominal: Some(diagnosis.gap.nominal),
        gap_corrected: Some(diagnosis.gap.corrected),
        noise_floor: Some(diagnosis.gap.noise_floor),
        closed: Some(diagnosis.gap.closed),
        reason: None,
        ..Row::failed(String::new())
    };
    let of = |role: Role, effect: &NamedEffect| -> Vec<Row> {
        let row = Row {
            probability: Some(effect.probability),
            ..base.clone()
        };
        match effect.parameters.is_empty() {
            true => vec![row.with(role, &effect.kind, &effect.at, None)],
            false => {
                let parameters = effect.parameters.iter();
                let rows = parameters.map(|p| row.with(role, &effect.kind, &effect.at, Some(p)));
                rows.collect()
            }
        }
    };
    let mut rows: Vec<Row> = Vec::new();
    rows.extend(verdict.effects.iter().flat_map(|e| of(Role::Named, e)));
    if rows.is_empty() {
        rows.push(base.clone());
    }
    rows.extend(verdict.leading.iter().flat_map(|e| of(Role::Leading, e)));
    let nominal = answer.outcome.nominal.iter();
    let is_named = |kind: &str, at: &Location| {
        verdict
            .effects
            .iter()
            .any(|e| e.kind == kind && e.at == *at)
    };
    let nominal = nominal.filter(|one| !is_named(one.kind, &one.at));
    rows.extend(nominal.map(|one| Row {
        prior_std: Some(one.prior_std),
        ..base.with(Role::Nominal, one.kind, &one.at, Some(&one.parameter))
    }));
    rows
}

fn status(status: Status) -> &'static str {
    match status {
        Status::None => "none",
        Status::Parameters => "parameters",
        Status::Effect => "effect",
        Status::Unknown => "unknown",
    }
}
