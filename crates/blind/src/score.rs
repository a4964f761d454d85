//! One answer held against one truth.

use simgap_effects::same_place;

use crate::answer::{Answer, Named};
use crate::closing::{Closing, Signals, gap_to};
use crate::judge::{hit, of_clean, of_effect, of_foreign};
use crate::outcome::{Outcome, Verdict};
use crate::{Level, Status, Truth};

/// Largest set of kinds that an answer may leave undecided.
pub const LARGEST_SET: usize = 3;

/// What a case asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// One effect of the catalogue.
    Single,
    /// Two of them.
    Pair,
    /// None.
    Clean,
    /// One that the catalogue does not have.
    Foreign,
    /// One whose kind is taken out of the catalogue.
    Withheld,
}

impl Role {
    fn of(truth: &Truth) -> Role {
        match (truth.status, truth.withheld, truth.effects.len()) {
            (_, true, _) => Role::Withheld,
            (Status::Unknown, ..) => Role::Foreign,
            (Status::None, ..) => Role::Clean,
            (_, _, 1) => Role::Single,
            _ => Role::Pair,
        }
    }
}

/// The effect that is named first, held against the only effect of the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct First {
    /// It is of the true kind.
    pub is_kind: bool,
    /// It is of the true kind, or of one that no data tell from it on this plant.
    pub is_same: bool,
    /// It is of the true kind, and at its place, or at one that no data tell from it.
    pub is_placed: bool,
    /// The true kind is among what is said to be indistinguishable from it.
    pub is_declared: bool,
    /// Different kinds in the set of it and what is said to be indistinguishable from it.
    pub set: usize,
}

/// The score of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Number of the case.
    pub name: String,
    /// How hard it is.
    pub level: Level,
    /// What it asks for.
    pub role: Role,
    /// Right kind of answer.
    pub truth: Status,
    /// Kind of answer given.
    pub answer: Status,
    /// One for each effect of the truth; one for noise alone.
    pub verdicts: Vec<Verdict>,
    /// What is named first, for [`Role::Single`] and an answer that names something.
    pub first: Option<First>,
    /// Probability stated for each named effect, and whether it holds: that it, or one of a few kinds that are
    /// said to be indistinguishable from it ([`LARGEST_SET`]), is part of the cause.
    pub stated: Vec<(f64, bool)>,
    /// Named effects that are neither in the truth nor excused by small parameter errors.
    pub extra: Vec<String>,
    /// Closed share of the gap, where there is one.
    pub closing: Option<Closing>,
    /// The nominal parameters are right to the last digit.
    pub is_exact: bool,
}

impl Score {
    /// Whether the whole answer is right: every effect, and nothing besides.
    #[must_use]
    pub fn is_right(&self) -> bool {
        let foreign = matches!(self.role, Role::Foreign | Role::Withheld);
        (foreign || self.extra.is_empty()) && self.verdicts.iter().all(|v| v.outcome.is_right())
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

/// Holds an answer against the truth of its case. `best` are the predictions of the model with the
/// true effects and parameters.
///
/// An effect of the truth is `Right` when it is named at its place, `Equivalent` when one of its
/// [`simgap_effects::equivalents`] is. Named nominal parameters beside the effect are excused where the case
/// has small errors of them ([`Truth::deviations`]), but for one from outside the catalogue where they are all that is named.
///
/// ```
/// use simgap_blind::{Answer, Level, Outcome, Recipe, generate, score};
/// let case = generate(1, 3, &Recipe::Noise, Level::Standard)?;
/// let score = score(&case.name, &case.truth, &Answer::nothing(), None);
/// assert_eq!(score.outcome(), Outcome::Quiet);
/// # Ok::<(), simgap_blind::BlindError>(())
/// ```
#[must_use]
pub fn score(name: &str, truth: &Truth, answer: &Answer, best: Option<&Signals>) -> Score {
    let names = matches!(answer.status, Status::Parameters | Status::Effect);
    let named: &[Named] = if names { &answer.named } else { &[] };
    let hits: Vec<Option<usize>> = named.iter().map(|named| hit(truth, named)).collect();
    let closing = closing(truth, answer, best);
    let role = Role::of(truth);
    let unexcused: Vec<&Named> = named.iter().filter(|n| !is_excused(truth, n)).collect();
    let verdicts = match truth.status {
        Status::None => vec![of_clean(truth, answer.status, named)],
        Status::Unknown => {
            let closed = closing.map_or(f64::NAN, |closing| closing.actual);
            // Where parameters that are off a little are all that is named, they are what stands in.
            let all: Vec<&Named> = named.iter().collect();
            let blamed = if unexcused.is_empty() {
                &all
            } else {
                &unexcused
            };
            vec![of_foreign(truth, answer.status, blamed, closed)]
        }
        Status::Parameters | Status::Effect => (0..truth.effects.len())
            .map(|i| of_effect(truth, i, answer.status, named, &hits))
            .collect(),
    };
    let counted = || {
        let all = named.iter().zip(&hits);
        all.filter(|(named, hit)| hit.is_some() || !is_excused(truth, named))
    };
    Score {
        name: name.to_string(),
        level: truth.level,
        role,
        truth: truth.status,
        answer: answer.status,
        verdicts,
        first: match (role, named.first()) {
            (Role::Single, Some(first)) => Some(first_named(truth, first, hits[0])),
            _ => None,
        },
        stated: counted()
            .map(|(named, hit)| {
                let holds = hit.is_some() || is_of_small_class(truth, named);
                (named.probability, holds)
            })
            .collect(),
        extra: counted()
            .filter(|(_, hit)| hit.is_none())
            .map(|(named, _)| format!("{} {}", named.kind, named.at))
            .collect(),
        closing,
        is_exact: truth.deviations.is_empty(),
    }
}

/// Whether a named effect is a small error that the parameters do have.
fn is_excused(truth: &Truth, named: &Named) -> bool {
    let mut small = truth.deviations.iter();
    small.any(|e| e.kind == named.kind && same_place(&e.at, &named.at))
}

/// Whether an effect of the truth is among the few that are said to be indistinguishable from a named one.
fn is_of_small_class(truth: &Truth, named: &Named) -> bool {
    let is_known = truth.status != Status::Unknown;
    is_known
        && named.kinds().len() <= LARGEST_SET
        && truth.effects.iter().any(|e| named.declares(e))
}

fn first_named(truth: &Truth, first: &Named, hit: Option<usize>) -> First {
    let kind = truth.effects.first().map_or("", |effect| &effect.kind);
    let kinds = first.kinds();
    let is_declared = kinds.contains(&kind);
    First {
        is_kind: first.kind == kind,
        is_same: first.kind == kind || hit.is_some(),
        is_placed: first.kind == kind && hit.is_some(),
        is_declared,
        set: kinds.len(),
    }
}

fn closing(truth: &Truth, answer: &Answer, best: Option<&Signals>) -> Option<Closing> {
    if truth.status == Status::None {
        return None;
    }
    let nominal = gap_to(&truth.signals, &answer.nominal);
    let closed = |predicted: &Signals| 1.0 - gap_to(&truth.signals, predicted) / nominal;
    let actual = closed(&answer.corrected);
    Some(Closing {
        stated: answer.closed,
        // No prediction closes nothing.
        actual: if actual.is_finite() { actual } else { 0.0 },
        best: best.map_or(f64::NAN, closed),
    })
}
