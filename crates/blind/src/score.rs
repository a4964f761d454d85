//! One answer held against one truth.

use simgap_model::Location;

use crate::equivalent::same_place;
use crate::{Case, Status, Truth};

/// What was answered, in plain types.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Kind of answer.
    pub status: Status,
    /// What is named; counts for [`Status::Parameters`] and [`Status::Effect`] only.
    pub named: Vec<Named>,
    /// Share of the gap that is closed, 1 for all of it.
    pub closed: f64,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Stated probability that it is the cause.
    pub probability: f64,
    /// What the answer says cannot be told from it.
    pub indistinguishable: Vec<(String, Location)>,
}

/// What became of one effect of the truth; from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// Right kind, right place.
    Right,
    /// An equivalent is named.
    Equivalent,
    /// Nothing was there and nothing is named.
    Quiet,
    /// Not in the catalogue, and said to be unknown.
    HonestUnknown,
    /// Among what the answer says cannot be told from a named effect.
    AmongRivals,
    /// Right kind, wrong place.
    WrongPlace,
    /// In the catalogue, but said to be unknown.
    CalledUnknown,
    /// Something else is named.
    Wrong,
    /// The gap is said to be noise.
    Missed,
    /// Nothing was there, and something is named or said to be unknown.
    FalseAlarm,
}

impl Outcome {
    /// A word or two for tables.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Outcome::Right => "right",
            Outcome::Equivalent => "equivalent",
            Outcome::Quiet => "quiet",
            Outcome::HonestUnknown => "honest unknown",
            Outcome::AmongRivals => "among rivals",
            Outcome::WrongPlace => "wrong place",
            Outcome::CalledUnknown => "called unknown",
            Outcome::Wrong => "wrong",
            Outcome::Missed => "missed",
            Outcome::FalseAlarm => "false alarm",
        }
    }

    /// Whether a reader of the answer would know the cause and its place.
    #[must_use]
    pub fn is_right(self) -> bool {
        matches!(
            self,
            Outcome::Right | Outcome::Equivalent | Outcome::Quiet | Outcome::HonestUnknown
        )
    }
}

/// One effect of the truth and what was said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Kind of the truth; `none` for noise alone.
    pub kind: String,
    /// Its place, if it has one.
    pub at: Option<Location>,
    /// What became of it.
    pub outcome: Outcome,
    /// Probability stated for it (or its equivalent); 0 when it is not named.
    pub probability: f64,
    /// Kind that was said: of the effect that matches it, else of the most probable one that
    /// matches nothing, else the status.
    pub said: String,
}

/// The score of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Number of the case.
    pub name: String,
    /// Right kind of answer.
    pub truth: Status,
    /// Kind of answer given.
    pub answer: Status,
    /// One for each effect of the truth; one for noise alone.
    pub verdicts: Vec<Verdict>,
    /// Probability stated for each named effect, and whether it was right.
    pub stated: Vec<(f64, bool)>,
    /// Length of each list of what cannot be told apart.
    pub rivals: Vec<usize>,
    /// Named effects that are neither in the truth nor excused by small parameter errors.
    pub extra: Vec<String>,
    /// Closed share of the gap, as answered.
    pub closed: f64,
}

impl Score {
    /// Whether the whole answer is right: every effect, and nothing besides.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.extra.is_empty() && self.verdicts.iter().all(|v| v.outcome.is_right())
    }

    /// The worst of the outcomes.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.verdicts
            .iter()
            .map(|verdict| verdict.outcome)
            .max()
            .unwrap_or(Outcome::Quiet)
    }
}

/// Holds an answer against the truth of its case.
///
/// An effect of the truth is `Right` when it is named at its place, `Equivalent` when one of its
/// [`crate::equivalents`] is. Named nominal parameters beside the effect are excused where the case
/// has small errors of them ([`Truth::deviations`]).
///
/// ```
/// use simgap_blind::{Answer, Outcome, Recipe, Status, generate, score};
/// let case = generate(1, 3, &Recipe::Noise)?;
/// let answer = Answer { status: Status::None, named: vec![], closed: 1.0 };
/// assert_eq!(score(&case, &answer).outcome(), Outcome::Quiet);
/// # Ok::<(), simgap_blind::BlindError>(())
/// ```
#[must_use]
pub fn score(case: &Case, answer: &Answer) -> Score {
    let truth = &case.truth;
    let names = matches!(answer.status, Status::Parameters | Status::Effect);
    let named: &[Named] = if names { &answer.named } else { &[] };
    let hits: Vec<Option<usize>> = named.iter().map(|named| hit(truth, named)).collect();
    let verdicts = match truth.status {
        Status::None => vec![of_noise(answer.status, named)],
        Status::Unknown => vec![of_foreign(truth, answer.status, named)],
        Status::Parameters | Status::Effect => (0..truth.effects.len())
            .map(|i| of_effect(truth, i, answer.status, named, &hits))
            .collect(),
    };
    let excused = |named: &Named| {
        let same =
            |e: &simgap_model::EffectEntry| e.kind == named.kind && same_place(&e.at, &named.at);
        truth.deviations.iter().any(same)
    };
    let spare = |(named, hit): &(&Named, &Option<usize>)| hit.is_none() && !excused(named);
    Score {
        name: case.name.clone(),
        truth: truth.status,
        answer: answer.status,
        verdicts,
        stated: named
            .iter()
            .zip(&hits)
            .filter(|(named, hit)| hit.is_some() || !excused(named))
            .map(|(named, hit)| (named.probability, hit.is_some()))
            .collect(),
        rivals: named.iter().map(|n| n.indistinguishable.len()).collect(),
        extra: named
            .iter()
            .zip(&hits)
            .filter(spare)
            .map(|(named, _)| format!("{} {}", named.kind, named.at))
            .collect(),
        closed: answer.closed,
    }
}

/// Which effect of the truth a named one stands for.
fn hit(truth: &Truth, named: &Named) -> Option<usize> {
    if truth.status == Status::Unknown {
        return None;
    }
    let exact = truth
        .effects
        .iter()
        .position(|e| e.kind == named.kind && same_place(&e.at, &named.at));
    exact.or_else(|| {
        truth.equivalents.iter().position(|list| {
            list.iter()
                .any(|e| e.kind == named.kind && same_place(&e.at, &named.at))
        })
    })
}

fn of_noise(status: Status, named: &[Named]) -> Verdict {
    Verdict {
        kind: "none".to_string(),
        at: None,
        outcome: if status == Status::None {
            Outcome::Quiet
        } else {
            Outcome::FalseAlarm
        },
        probability: 0.0,
        said: said(status, named.iter()),
    }
}

fn of_foreign(truth: &Truth, status: Status, named: &[Named]) -> Verdict {
    let first = truth.effects.first();
    Verdict {
        kind: first.map_or_else(String::new, |e| e.kind.clone()),
        at: first.map(|e| e.at.clone()),
        outcome: match status {
            Status::Unknown => Outcome::HonestUnknown,
            Status::None => Outcome::Missed,
            Status::Parameters | Status::Effect => Outcome::Wrong,
        },
        probability: 0.0,
        said: said(status, named.iter()),
    }
}

fn of_effect(
    truth: &Truth,
    i: usize,
    status: Status,
    named: &[Named],
    hits: &[Option<usize>],
) -> Verdict {
    let effect = &truth.effects[i];
    let of_mine = |n: &&Named| n.kind == effect.kind && same_place(&n.at, &effect.at);
    let mine = named
        .iter()
        .zip(hits)
        .filter(|(_, hit)| **hit == Some(i))
        .map(|(named, _)| named)
        .max_by(|a, b| {
            let exact = |n: &&Named| u8::from(of_mine(n));
            exact(a)
                .cmp(&exact(b))
                .then(a.probability.total_cmp(&b.probability))
        });
    let spare = || named.iter().zip(hits).filter(|(_, hit)| hit.is_none());
    let rival = || {
        named.iter().any(|n| {
            n.indistinguishable
                .iter()
                .any(|(kind, at)| *kind == effect.kind && same_place(at, &effect.at))
        })
    };
    let outcome = match (mine, status) {
        (Some(named), _) if of_mine(&named) => Outcome::Right,
        (Some(_), _) => Outcome::Equivalent,
        (None, Status::None) => Outcome::Missed,
        (None, Status::Unknown) => Outcome::CalledUnknown,
        (None, _) if rival() => Outcome::AmongRivals,
        (None, _) if spare().any(|(n, _)| n.kind == effect.kind) => Outcome::WrongPlace,
        // The other effect of a pair is all that was found.
        (None, _) if spare().next().is_none() => Outcome::Missed,
        (None, _) => Outcome::Wrong,
    };
    Verdict {
        kind: effect.kind.clone(),
        at: Some(effect.at.clone()),
        outcome,
        probability: mine.map_or(0.0, |named| named.probability),
        said: mine.map_or_else(
            || said(status, spare().map(|(named, _)| named)),
            |named| named.kind.clone(),
        ),
    }
}

fn said<'a>(status: Status, named: impl Iterator<Item = &'a Named>) -> String {
    let most = named.max_by(|a, b| a.probability.total_cmp(&b.probability));
    match (status, most) {
        (Status::Unknown, _) => "(unknown)".to_string(),
        (_, Some(named)) => named.kind.clone(),
        (_, None) => "(nothing)".to_string(),
    }
}
