//! A campaign summed up.

use std::collections::BTreeMap;

use crate::score::LARGEST_SET;
use crate::{Outcome, Role, Score};

/// Edges of the bins of stated probabilities.
const BINS: [f64; 7] = [0.0, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0];
/// A stated closing this near to the true one is right.
pub const CLOSE: f64 = 0.05;

/// So many of so many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// That are right.
    pub hits: usize,
    /// Of these.
    pub of: usize,
}

impl Share {
    /// Counts what is true.
    pub fn count(of: impl Iterator<Item = bool>) -> Share {
        of.fold(Share::default(), |share, hit| Share {
            hits: share.hits + usize::from(hit),
            of: share.of + 1,
        })
    }

    /// 0 to 1; NaN of nothing.
    #[must_use]
    pub fn value(self) -> f64 {
        self.hits as f64 / self.of as f64
    }

    /// Both together.
    #[must_use]
    pub fn and(self, other: Share) -> Share {
        Share {
            hits: self.hits + other.hits,
            of: self.of + other.of,
        }
    }
}

/// Median and 10th percentile of some values; NaN of none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// How many values.
    pub count: usize,
    /// Half of them are above.
    pub median: f64,
    /// Nine of ten are above.
    pub tenth: f64,
}

impl Spread {
    /// Of values in any order, by linear interpolation between the two nearest ranks. A value that
    /// is no number is left out.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Spread {
        values.retain(|value| !value.is_nan());
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let position = share * values.len().saturating_sub(1) as f64;
            let low = position.floor() as usize;
            let value = |i: usize| values.get(i).or(values.last()).copied();
            let (a, b) = (value(low), value(low + 1));
            let (a, b) = (a.unwrap_or(f64::NAN), b.unwrap_or(f64::NAN));
            a + (position - low as f64) * (b - a)
        };
        Spread {
            count: values.len(),
            median: at(0.5),
            tenth: at(0.1),
        }
    }
}

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

/// The figures of the cases of one level. A share over nothing is NaN and written as a dash.
#[derive(Debug, Clone, PartialEq)]
pub struct Totals {
    /// Cases.
    pub cases: usize,
    /// Cases whose whole answer is right.
    pub right: Share,
    /// One effect: its kind is named first.
    pub first: Share,
    /// One effect: its kind, or one that no data tell from it on that plant, is named first.
    pub first_or_same: Share,
    /// One effect: its kind is named first or declared indistinguishable from the first, in a set of
    /// at most [`LARGEST_SET`] kinds.
    pub declared: Share,
    /// Mean number of kinds in the set of the first and what is declared indistinguishable from it.
    pub set_mean: f64,
    /// Largest of them.
    pub set_max: usize,
    /// One effect whose kind is named first: at its place.
    pub placed: Share,
    /// Noise alone with exact parameters, nothing blamed.
    pub exact: Share,
    /// Noise alone with small errors of the parameters, nothing blamed but parameters.
    pub small_errors: Share,
    /// A foreign effect that is said to be unknown, or incompletely explained by one of its family.
    pub foreign: Share,
    /// A kind out of the catalogue that is said to be unknown, incompletely explained by one of its family, or named by another
    /// name of the same law.
    pub withheld: Share,
    /// Of both: honestly unknown, the nearest name of an incomplete answer, the same law by another name.
    pub foreign_how: [usize; 3],
    /// Two effects: both named at their places, none invented.
    pub pairs: Share,
    /// Effects of pairs that are named at their places.
    pub of_pairs: Share,
    /// Closed share of the gap against the truth without noise, where the catalogue can close it.
    pub closing: Spread,
    /// The same of the model with the true effects and parameters.
    pub best: Spread,
    /// What the answers close of what the true model closes.
    pub of_best: Spread,
    /// Stated closings within [`CLOSE`] of the true one.
    pub stated: Share,
    /// Mean of (stated probability − right or not)² over all statements.
    pub brier: f64,
    /// Stated probabilities against how often they were right.
    pub calibration: Vec<Bin>,
    /// Truth by what was said, with counts; what is right in parts is under its own name.
    pub confusion: BTreeMap<String, BTreeMap<String, usize>>,
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
        let of_role = |role: Role| scores.iter().filter(move |score| score.role == role);
        let single = |hit: &dyn Fn(&crate::First) -> bool| {
            Share::count(of_role(Role::Single).map(|s| s.first.as_ref().is_some_and(hit)))
        };
        let firsts = || of_role(Role::Single).filter_map(|score| score.first);
        let clean = |is_exact: bool| {
            let such = of_role(Role::Clean).filter(move |s| is_exact == s.is_exact);
            // A parameter that is not off is a wrong answer, but no other thing that is blamed.
            Share::count(such.map(|s| s.outcome().is_right()))
        };
        let foreign = || of_role(Role::Foreign).chain(of_role(Role::Withheld));
        let how = |outcome: Outcome| foreign().filter(|s| s.outcome() == outcome).count();
        let found = |outcome: Outcome| matches!(outcome, Outcome::Right | Outcome::Equivalent);
        let of_pairs = of_role(Role::Pair).flat_map(|score| &score.verdicts);
        let closable = || of_role(Role::Single).chain(of_role(Role::Pair));
        let closings = || closable().filter_map(|score| score.closing);
        let told = scores.iter().filter_map(|score| score.closing);
        let statements: Vec<(f64, bool)> = scores
            .iter()
            .filter(|score| score.role != Role::Withheld)
            .flat_map(|score| score.stated.clone())
            .collect();
        Totals {
            cases: scores.len(),
            right: Share::count(scores.iter().map(Score::is_right)),
            first: single(&|first| first.is_kind),
            first_or_same: single(&|first| first.is_same),
            declared: single(&|first| {
                (first.is_kind || first.is_declared) && first.set <= LARGEST_SET
            }),
            set_mean: mean(firsts().map(|first| first.set as f64)),
            set_max: firsts().map(|first| first.set).max().unwrap_or(0),
            placed: Share::count(firsts().filter(|f| f.is_kind).map(|f| f.is_placed)),
            exact: clean(true),
            small_errors: clean(false),
            foreign: Share::count(of_role(Role::Foreign).map(Score::is_right)),
            withheld: Share::count(of_role(Role::Withheld).map(Score::is_right)),
            foreign_how: [
                how(Outcome::HonestUnknown),
                how(Outcome::Nearest),
                how(Outcome::Equivalent),
            ],
            pairs: Share::count(of_role(Role::Pair).map(Score::is_right)),
            of_pairs: Share::count(of_pairs.map(|verdict| found(verdict.outcome))),
            closing: Spread::of(closings().map(|c| c.actual).collect()),
            best: Spread::of(closings().map(|c| c.best).collect()),
            of_best: Spread::of(closings().map(|c| c.actual / c.best).collect()),
            stated: Share::count(told.map(|c| (c.stated - c.actual).abs() <= CLOSE)),
            brier: mean(statements.iter().map(|&(p, hit)| (p - number(hit)).powi(2))),
            calibration: calibration(&statements),
            confusion: confusion(scores),
        }
    }

    /// Noise alone of both kinds.
    #[must_use]
    pub fn clean(&self) -> Share {
        self.exact.and(self.small_errors)
    }

    /// Foreign effects and kinds out of the catalogue.
    #[must_use]
    pub fn unknowable(&self) -> Share {
        self.foreign.and(self.withheld)
    }
}

fn number(hit: bool) -> f64 {
    f64::from(u8::from(hit))
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
                right: mean(inside.iter().map(|(_, right)| number(*right))),
            }
        })
        .collect()
}

fn confusion(scores: &[Score]) -> BTreeMap<String, BTreeMap<String, usize>> {
    let mut rows: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for score in scores {
        for verdict in &score.verdicts {
            let truth = match score.role {
                Role::Withheld => format!("{} (withheld)", verdict.kind),
                Role::Pair => format!("{} (of two)", verdict.kind),
                _ => verdict.kind.clone(),
            };
            let row = rows.entry(truth).or_default();
            *row.entry(verdict.said.clone()).or_default() += 1;
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_percentiles_between_ranks() {
        let spread = Spread::of((0..=10).rev().map(f64::from).collect());
        assert_eq!((spread.count, spread.median, spread.tenth), (11, 5.0, 1.0));
        let two = Spread::of(vec![1.0, f64::NAN, 0.0]);
        assert_eq!((two.count, two.median, two.tenth), (2, 0.5, 0.1));
        assert!(Spread::of(vec![]).median.is_nan());
    }
}
