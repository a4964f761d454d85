//! A campaign summed up.

use std::collections::BTreeMap;

use crate::{Outcome, Score, Status};

/// Edges of the bins of stated probabilities.
const BINS: [f64; 7] = [0.0, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0];

/// Stated probabilities of one bin and how often they were right.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// Lower edge, included.
    pub from: f64,
    /// Upper edge; included in the last bin.
    pub to: f64,
    /// Statements.
    pub count: usize,
    /// Mean of the stated probabilities.
    pub stated: f64,
    /// Share of them that was right.
    pub right: f64,
}

/// The figures of a campaign. A share over nothing is NaN and written as a dash.
#[derive(Debug, Clone, PartialEq)]
pub struct Totals {
    /// Cases.
    pub cases: usize,
    /// Cases whose whole answer is right.
    pub right: f64,
    /// Effects of the catalogue in all cases; the next seven are shares of them.
    pub effects: usize,
    /// Kind and place named, or an equivalent.
    pub placed: f64,
    /// Kind named, or an equivalent, wherever.
    pub named: f64,
    /// Truth among what was said to be indistinguishable.
    pub among_rivals: f64,
    /// Something else named.
    pub wrong: f64,
    /// Said to be noise, or left out.
    pub missed: f64,
    /// Said to be unknown.
    pub called_unknown: f64,
    /// Mean probability stated for the truth.
    pub truth_probability: f64,
    /// Cases of noise alone, and the share of them with an alarm.
    pub quiet_cases: usize,
    /// As above.
    pub false_alarms: f64,
    /// Foreign cases, and the share of them said to be unknown.
    pub foreign_cases: usize,
    /// As above.
    pub honest_unknown: f64,
    /// Cases with a named effect that is not there.
    pub extra: f64,
    /// Mean of (stated probability − right or not)² over all statements.
    pub brier: f64,
    /// Stated probabilities against how often they were right.
    pub calibration: Vec<Bin>,
    /// Mean number of effects that an answer says cannot be told from a named one.
    pub rivals: f64,
    /// True kind, outcomes and what was said, with counts.
    pub kinds: BTreeMap<String, KindRow>,
}

/// One kind of the truth.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KindRow {
    /// How often each outcome.
    pub outcomes: BTreeMap<Outcome, usize>,
    /// How often each kind was said instead.
    pub said: BTreeMap<String, usize>,
}

impl Totals {
    /// Sums up scores.
    ///
    /// ```
    /// let totals = simgap_blind::Totals::of(&[]);
    /// assert_eq!(totals.cases, 0);
    /// ```
    #[must_use]
    pub fn of(scores: &[Score]) -> Totals {
        let verdicts: Vec<_> = scores
            .iter()
            .filter(|score| matches!(score.truth, Status::Parameters | Status::Effect))
            .flat_map(|score| &score.verdicts)
            .collect();
        let of_effects = |outcomes: &[Outcome]| {
            let hits = verdicts.iter().filter(|v| outcomes.contains(&v.outcome));
            share(hits.count(), verdicts.len())
        };
        let of_status = |status: Status, outcome: Outcome| {
            let such: Vec<_> = scores.iter().filter(|s| s.truth == status).collect();
            let hits = such.iter().filter(|s| s.outcome() == outcome).count();
            (such.len(), share(hits, such.len()))
        };
        let (quiet_cases, false_alarms) = of_status(Status::None, Outcome::FalseAlarm);
        let (foreign_cases, honest_unknown) = of_status(Status::Unknown, Outcome::HonestUnknown);
        let stated: Vec<(f64, bool)> = scores.iter().flat_map(|s| s.stated.clone()).collect();
        let errors = stated.iter().map(|&(p, right)| (p - of(right)).powi(2));
        let rivals = scores.iter().flat_map(|s| &s.rivals).map(|&n| n as f64);
        Totals {
            cases: scores.len(),
            right: share(scores.iter().filter(|s| s.is_right()).count(), scores.len()),
            effects: verdicts.len(),
            placed: of_effects(&[Outcome::Right, Outcome::Equivalent]),
            named: of_effects(&[Outcome::Right, Outcome::Equivalent, Outcome::WrongPlace]),
            among_rivals: of_effects(&[Outcome::AmongRivals]),
            wrong: of_effects(&[Outcome::Wrong]),
            missed: of_effects(&[Outcome::Missed]),
            called_unknown: of_effects(&[Outcome::CalledUnknown]),
            truth_probability: mean(verdicts.iter().map(|v| v.probability)),
            quiet_cases,
            false_alarms,
            foreign_cases,
            honest_unknown,
            extra: share(
                scores.iter().filter(|s| !s.extra.is_empty()).count(),
                scores.len(),
            ),
            brier: mean(errors),
            calibration: calibration(&stated),
            rivals: mean(rivals),
            kinds: kinds(scores),
        }
    }
}

fn of(right: bool) -> f64 {
    f64::from(u8::from(right))
}

fn share(hits: usize, of: usize) -> f64 {
    hits as f64 / of as f64
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
    sum / count
}

fn calibration(stated: &[(f64, bool)]) -> Vec<Bin> {
    BINS.windows(2)
        .map(|edge| {
            let last = edge[1] == 1.0;
            let inside: Vec<_> = stated
                .iter()
                .filter(|(p, _)| (edge[0]..edge[1]).contains(p) || (last && *p >= 1.0))
                .collect();
            Bin {
                from: edge[0],
                to: edge[1],
                count: inside.len(),
                stated: mean(inside.iter().map(|(p, _)| *p)),
                right: mean(inside.iter().map(|(_, right)| of(*right))),
            }
        })
        .collect()
}

fn kinds(scores: &[Score]) -> BTreeMap<String, KindRow> {
    let mut rows: BTreeMap<String, KindRow> = BTreeMap::new();
    for verdict in scores.iter().flat_map(|score| &score.verdicts) {
        let row = rows.entry(verdict.kind.clone()).or_default();
        *row.outcomes.entry(verdict.outcome).or_default() += 1;
        if !verdict.outcome.is_right() {
            *row.said.entry(verdict.said.clone()).or_default() += 1;
        }
    }
    rows
}
