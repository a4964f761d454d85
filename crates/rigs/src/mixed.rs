//! A machine as machines are: one cause that matters, and others beside it that do not go away.

use crate::deviate::apply;
use crate::draft::Draft;
use crate::effect::Effect;
use crate::kinds::{EFFECTS, FOREIGN, PARAMETERS, group};
use crate::rng::Rng;
use crate::sizing::{NEAR, far_off, largest, sized, swings_little};

/// Gap of a channel that the main cause makes.
const MAIN: (f64, f64) = (0.1, 0.5);
/// Gap of each smaller cause, as a share of that.
const BESIDE: (f64, f64) = (0.05, 0.2);
/// On the check record: least gap of the main cause over the least one that was aimed at, largest gap of a smaller cause over
/// that, and largest gap of all together.
const LEAST_ON_CHECK: f64 = 0.5;
const MOST_BESIDE: f64 = 0.4;
const MOST: f64 = 1.5;
/// Kinds that are tried for each smaller cause.
const TRIES: usize = 8;

/// Adds a main cause, first in the list, and two or three smaller ones, of which any may be a law that the catalogue lacks.
pub(crate) fn mixed(mut draft: Draft, kind: &'static str, rng: &mut Rng) -> Option<Draft> {
    if !swings_little(&draft.bench) {
        return None;
    }
    let plain = draft.bench.run(&draft.bench.plant, &[], 0, 8)?.1;
    let free = draft.bench.free_responses(0);
    let main = match PARAMETERS.contains(&kind) {
        true => {
            let wrong = far_off(&draft.bench, kind, rng)?;
            apply(&mut draft.bench.plant, &wrong);
            wrong
        }
        false => sized(&draft.bench, kind, (&plain, &free), MAIN, rng)?,
    };
    let first = draft.bench.gap(std::slice::from_ref(&main), 0, &free)?;
    let gap = largest(&first);
    if !(MAIN.0..NEAR * MAIN.1).contains(&gap) {
        return None;
    }
    draft.effects.push(main);
    // The smaller ones are sized on a machine without the main cause.
    let mut without = draft.bench.clone();
    without.plant = without.without.clone();
    let mut all = EFFECTS.to_vec();
    all.extend(FOREIGN);
    let count = rng.whole(2, 3);
    for _ in 0..TRIES * count {
        let kind = *rng.pick(&all);
        let own = group(kind);
        let taken = |e: &Effect| e.kind == kind || (own != "other" && group(e.kind) == own);
        if draft.effects.iter().any(taken) {
            continue;
        }
        let sizes = (BESIDE.0 * gap, BESIDE.1 * gap);
        let small = sized(&without, kind, (&plain, &free), sizes, rng);
        draft.effects.extend(small);
        if draft.effects.len() > count {
            break;
        }
    }
    if draft.effects.len() <= count {
        return None;
    }
    // The main cause is what matters on the check record too, with the others in their places.
    let check = draft.bench.setups.len() - 1;
    let free = draft.bench.free_responses(check);
    let alone = largest(&draft.bench.gap(&draft.effects[..1], check, &free)?);
    if alone < LEAST_ON_CHECK * MAIN.0 {
        return None;
    }
    for small in &draft.effects[1..] {
        let gaps = without.gap(std::slice::from_ref(small), check, &free)?;
        if largest(&gaps) > MOST_BESIDE * alone {
            return None;
        }
    }
    draft.gaps = draft.bench.gap(&draft.effects, check, &free)?;
    draft.gap = largest(&draft.gaps);
    (draft.gap < MOST).then_some(draft)
}
