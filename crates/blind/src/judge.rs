//! What became of each effect of the truth.

use simgap_effects::same_place;

use crate::answer::Named;
use crate::case::known;
use crate::outcome::{Outcome, Verdict};
use crate::{Hidden, Status, Truth};

/// Which effect of the truth a named one stands for.
pub(crate) fn hit(truth: &Truth, named: &Named) -> Option<usize> {
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

pub(crate) fn of_clean(truth: &Truth, status: Status, named: &[Named]) -> Verdict {
    // Parameters that are off may be found to be.
    let is_right = match status {
        Status::None => true,
        Status::Parameters => !truth.deviations.is_empty(),
        Status::Effect | Status::Unknown => false,
    };
    Verdict {
        kind: if truth.deviations.is_empty() {
            "none, exact".to_string()
        } else {
            "none, small errors".to_string()
        },
        at: None,
        outcome: if is_right {
            Outcome::Quiet
        } else {
            Outcome::FalseAlarm
        },
        probability: 0.0,
        said: said(status, named.iter()),
    }
}

/// An answer under which the same law goes by another name predicts the check records to this share of the gap.
const PREDICTS: f64 = 0.03;

/// A foreign effect, or one whose kind was out of the catalogue. `closed` is the share of the gap
/// that the answer really closes.
pub(crate) fn of_foreign(truth: &Truth, status: Status, named: &[&Named], closed: f64) -> Verdict {
    let first = truth.effects.first();
    let is_near = |named: &&&Named| {
        let family = |kind: &str| known(kind).map(|effect| effect.family());
        named.is_incomplete && first.is_some_and(|e| family(&e.kind) == family(&named.kind))
    };
    let is_same = |named: &&Named| first.is_some_and(|e| is_same_law(truth, e, named));
    let predicts = closed >= 1.0 - PREDICTS;
    let outcome = match status {
        Status::Unknown => Outcome::HonestUnknown,
        Status::None => Outcome::Missed,
        _ if !named.is_empty() && predicts && named.iter().all(is_same) => Outcome::Equivalent,
        _ if named.first().is_some_and(|first| is_near(&first)) => Outcome::Nearest,
        _ => Outcome::Wrong,
    };
    Verdict {
        kind: first.map_or_else(String::new, |e| e.kind.clone()),
        at: first.map(|e| e.at.clone()),
        outcome,
        probability: 0.0,
        said: said(status, named.iter().copied()),
    }
}

/// Whether a named effect is that of the truth under another name: an equivalent on this plant, or a
/// more general law at its place of which it is a special case.
fn is_same_law(truth: &Truth, effect: &Hidden, named: &Named) -> bool {
    let mut equivalents = truth.equivalents.iter().flatten();
    let contains = known(&named.kind).is_some_and(|law| {
        let special = law.contains();
        special.contains(&effect.kind.as_str()) && same_place(&named.at, &effect.at)
    });
    contains || equivalents.any(|e| e.kind == named.kind && same_place(&e.at, &named.at))
}

pub(crate) fn of_effect(
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
    let rival = || named.iter().any(|n| n.declares(effect));
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
