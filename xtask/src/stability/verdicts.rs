//! The answers of one case.

use std::collections::BTreeMap;

use simgap_rigs::Diagnosis;

use crate::asked::Kinds;

/// What is said of a draw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Said {
    pub(super) kinds: Kinds,
    /// Kinds that it says cannot be told from the one that it names first.
    pub(super) declared: Vec<String>,
}

impl Said {
    pub(super) fn of(diagnosis: Option<&Diagnosis>) -> Said {
        let first = diagnosis.and_then(|diagnosis| diagnosis.verdict.effects.first());
        let others = first.map_or(&[][..], |effect| &effect.indistinguishable);
        Said {
            kinds: Kinds::of(diagnosis),
            declared: others.iter().map(|other| other.kind.clone()).collect(),
        }
    }

    fn first(&self) -> Option<&String> {
        self.kinds.kinds.first()
    }

    /// Whether it has the status of another answer and names the same kind first, or one that it says cannot be told from that.
    fn agrees(&self, other: &Said) -> bool {
        let is_declared = |kind: &String| self.declared.contains(kind);
        self.kinds.status == other.kinds.status
            && (self.first() == other.first() || other.first().is_some_and(is_declared))
    }
}

/// The answers of one case, and the one that is given most often.
pub(super) struct Verdicts {
    answers: Vec<Said>,
    usual: Option<Said>,
}

impl Verdicts {
    pub(super) fn new(answers: Vec<Said>) -> Verdicts {
        let count = |of: &Said| {
            let agree = answers.iter().filter(|said| said.agrees(of));
            let same = answers.iter().filter(|said| said.kinds == of.kinds);
            (agree.count(), same.count())
        };
        // Of verdicts that are as frequent the one that comes first.
        let usual = answers.iter().rev().max_by_key(|said| count(said));
        Verdicts {
            usual: usual.cloned(),
            answers,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.answers.len()
    }

    fn agreeing(&self) -> impl Iterator<Item = &Said> {
        let agrees = |said: &&Said| self.usual.as_ref().is_some_and(|usual| said.agrees(usual));
        self.answers.iter().filter(agrees)
    }

    /// Answers that agree with the usual one.
    pub(super) fn agree(&self) -> usize {
        self.agreeing().count()
    }

    /// Answers with the usual status that name the usual kinds.
    pub(super) fn same(&self) -> usize {
        let kinds = self.usual.as_ref().map(|usual| &usual.kinds);
        let same = |said: &&Said| kinds == Some(&said.kinds);
        self.answers.iter().filter(same).count()
    }

    pub(super) fn usual(&self) -> String {
        let usual = self.usual.as_ref();
        usual.map_or("-".into(), |usual| usual.kinds.to_string())
    }

    /// The other verdicts with how often they are given.
    pub(super) fn others(&self) -> String {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        let disagrees = |said: &&Said| self.agreeing().all(|agreeing| agreeing != *said);
        for said in self.answers.iter().filter(disagrees) {
            let told = said.first().unwrap_or(&said.kinds.status).clone();
            *counts.entry(told).or_default() += 1;
        }
        let told = counts.iter().map(|(told, count)| format!("{told} {count}"));
        told.collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(status: &str, kinds: &[&str], declared: &[&str]) -> Said {
        let list = |of: &[&str]| of.iter().map(|kind| (*kind).into()).collect();
        Said {
            kinds: Kinds {
                status: status.into(),
                kinds: list(kinds),
            },
            declared: list(declared),
        }
    }

    #[test]
    fn verify_answers_are_held_against_the_usual_one() {
        let friction = said("effect", &["coulomb_friction"], &[]);
        let and_mass = said("effect", &["coulomb_friction", "mass_error"], &[]);
        let declares = said("effect", &["input_dead_zone"], &["coulomb_friction"]);
        let stop = said("effect", &["end_stop"], &[]);
        let verdicts = Verdicts::new(vec![
            stop.clone(),
            friction.clone(),
            and_mass,
            friction.clone(),
            said("unknown", &[], &[]),
            declares,
            stop,
        ]);
        assert_eq!(verdicts.usual(), "effect (coulomb_friction)");
        let counted = [verdicts.count(), verdicts.agree(), verdicts.same()];
        assert_eq!(counted, [7, 4, 2]);
        assert_eq!(verdicts.others(), "end_stop 2, unknown 1");
    }

    #[test]
    fn verify_no_answers_are_no_verdict() {
        let none = Verdicts::new(vec![]);
        assert_eq!((none.count(), none.agree(), none.same()), (0, 0, 0));
        assert_eq!(none.usual(), "-");
    }
}
