//! One effect at a place, as large as it is wanted.

use std::f64::consts::PI;

use crate::bench::Bench;
use crate::deviate::error;
use crate::effect::Effect;
use crate::kinds::{sites, template};
use crate::march::Run;
use crate::rng::Rng;

/// A gap within this factor of the wanted one is near enough.
pub(crate) const NEAR: f64 = 1.2;
/// Steps of the search for a size.
const STEPS: usize = 10;

/// The gap of the channel that shows most.
pub(crate) fn largest(gaps: &[f64]) -> f64 {
    gaps.iter().copied().fold(0.0, f64::max)
}

pub(crate) fn swings_little(bench: &Bench) -> bool {
    let arm = !bench.plant.pendulum.is_empty();
    !arm || (0..bench.setups.len()).all(|record| {
        let run = bench.run(&bench.plant, &[], record, 8);
        run.is_some_and(|(_, run)| run.states[0].iter().all(|a| a.abs() < 2.5))
    })
}

fn has_clock(kind: &str) -> bool {
    matches!(
        kind,
        "harmonic_force" | "tone_pickup" | "time_varying_stiffness"
    )
}

/// An effect at some place that causes a gap within a range; `plain` and `free` are the first record without it.
pub(crate) fn sized(
    bench: &Bench,
    kind: &'static str,
    (plain, free): (&Run, &[Vec<f64>]),
    (least, most): (f64, f64),
    rng: &mut Rng,
) -> Option<Effect> {
    let places = sites(&bench.plant, kind);
    if places.is_empty() {
        return None;
    }
    let at = *rng.pick(&places);
    let scale = crate::scale::scale(bench, plain, 0, at, kind);
    let positive = [scale.rms, scale.rate, scale.force];
    if positive.iter().any(|v| !(v.is_finite() && *v > 1e-15)) {
        return None;
    }
    let shape = template(kind, &scale, rng);
    let phases = match has_clock(kind) {
        true => bench.setups.iter().map(|_| 2.0 * PI * rng.unit()).collect(),
        false => vec![],
    };
    let target = rng.log_uniform(least, most);
    let mut size = target;
    for _ in 0..STEPS {
        let effect = Effect {
            kind,
            at,
            values: shape(size),
            phases: phases.clone(),
        };
        let Some(gaps) = bench.gap(std::slice::from_ref(&effect), 0, free) else {
            size *= 0.3;
            continue;
        };
        let gap = largest(&gaps);
        let off = target / gap.max(1e-9);
        if (1.0 / NEAR..NEAR).contains(&off) {
            return Some(effect);
        }
        size *= off.powf(0.9).clamp(0.1, 8.0);
        if !(1e-6..1e4).contains(&size) {
            return None;
        }
    }
    None
}

/// A nominal parameter that is wrong by a factor of 1.3 to 3, up or down.
pub(crate) fn far_off(bench: &Bench, kind: &'static str, rng: &mut Rng) -> Option<Effect> {
    let places = sites(&bench.plant, kind);
    if places.is_empty() {
        return None;
    }
    let at = *rng.pick(&places);
    let up = rng.log_uniform(1.3, 3.0);
    let factor = if rng.chance(0.5) { up } else { 1.0 / up };
    Some(error(kind, at, factor))
}
