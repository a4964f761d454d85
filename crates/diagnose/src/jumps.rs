//! What is left where a force jumps.
//!
//! A force output or an accelerometer beside dry friction jumps when the motion turns or sticks. When exactly,
//! between two samples, no estimate says, and one sample on the wrong side is off by the whole jump: a true law then
//! leaves much more than noise, in a few samples, and nothing but noise in all others. A wrong law leaves something in
//! most of them. So what the few worst samples of such a channel leave says nothing against a law, nor for a further
//! one.
//!
//! ```text
//! V′_c = mean of the squares of all but the worst 3 % / 0.830             (1)
//! excess = Σ_c max(V_c / N_c − 1, 0)                                      (2)
//! ```
//!
//! 0.830 is what the worst 3 % leave of the variance of normal noise, N_c its variance.

use simgap_effects::Placed;
use simgap_estimate::Problem;
use simgap_model::OutputKind;

use crate::diagnosis::Gap;
use crate::gap::{Prediction, closed, noise_variance, stepped, total};
use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// Share of the samples that may be those at which a force jumps, and the factor of (1).
const WORST: f64 = 0.03;
const KEPT_OF_NORMAL: f64 = 0.830;
/// Part of the excess, (2), that may be left without the worst samples where it is all of jumps: true laws left up to
/// 0.30 on tuning cases, foreign ones and stand-ins 0.72 and more.
const SPREAD: f64 = 0.45;
/// Excess, (2), that is worth the question.
const EXCESS: f64 = 0.1;

/// Outputs that jump with a force.
fn jumping(problem: &Problem) -> Vec<bool> {
    let jumps = |kind| matches!(kind, OutputKind::Acceleration | OutputKind::Force);
    let outputs = problem.model.outputs.iter();
    outputs.map(|output| jumps(output.kind)).collect()
}

/// The excess, (2), with V of all samples.
fn excess_of_all(discrepancy: &[Vec<Vec<f64>>], noise: &[f64]) -> f64 {
    excess(&variance(discrepancy, &vec![false; noise.len()]), noise)
}

/// V of every channel, by (1) where it may jump.
fn variance(discrepancy: &[Vec<Vec<f64>>], jumping: &[bool]) -> Vec<f64> {
    let of_channel = |(c, jumps): (usize, &bool)| {
        let of_runs = discrepancy.iter().filter_map(|run| run.get(c));
        let mut squares: Vec<f64> = of_runs.flatten().map(|d| d * d).collect();
        let mut factor = 1.0;
        if *jumps {
            squares.sort_by(f64::total_cmp);
            squares.truncate(kept(squares.len()));
            factor = KEPT_OF_NORMAL;
        }
        squares.iter().sum::<f64>() / squares.len().max(1) as f64 / factor
    };
    jumping.iter().enumerate().map(of_channel).collect()
}

fn kept(samples: usize) -> usize {
    (samples as f64 * (1.0 - WORST)).ceil() as usize
}

/// (2).
fn excess(variance: &[f64], noise: &[f64]) -> f64 {
    let each = variance.iter().zip(noise);
    each.map(|(v, n)| (v / n.max(f64::MIN_POSITIVE) - 1.0).max(0.0))
        .sum()
}

/// Whether discrepancies stand out of the noise, and hardly do without the worst samples.
fn is_of_jumps(discrepancy: &[Vec<Vec<f64>>], jumping: &[bool], noise: &[f64]) -> bool {
    let all = excess_of_all(discrepancy, noise);
    let between = excess(&variance(discrepancy, jumping), noise);
    all > EXCESS && between < SPREAD * all
}

fn has_friction(effects: &[Placed]) -> bool {
    effects.iter().any(|placed| placed.action().is_dry())
}

/// Whether what a set with dry friction leaves is of jumps, and what it brings beyond a smaller set is there.
pub(crate) fn brings_jumps_alone(
    search: &Search<'_>,
    larger: &Hypothesis,
    smaller: &Hypothesis,
    least: f64,
) -> bool {
    if !has_friction(larger.effects()) {
        return false;
    }
    let problem = search.problem;
    let jumping = jumping(problem);
    let left = &larger.fit.discrepancy;
    let noise = noise_variance(left, &stepped(problem, larger.effects()));
    if !is_of_jumps(left, &jumping, &noise) {
        return false;
    }
    let channels = jumping.iter().zip(&search.accuracy).enumerate();
    let gains = channels.map(|(c, (jumps, off))| {
        let of = |set: &Hypothesis| -> Vec<f64> {
            let runs = set.fit.discrepancy.iter();
            runs.flat_map(|run| run[c].iter().map(|d| d * d)).collect()
        };
        let mut pairs: Vec<(f64, f64)> = of(larger).into_iter().zip(of(smaller)).collect();
        if *jumps {
            // The samples that are worst in one of the two, which repairs some of them by chance.
            let worst = |(own, other): &(f64, f64)| own.max(*other);
            pairs.sort_by(|a, b| worst(a).total_cmp(&worst(b)));
            pairs.truncate(kept(pairs.len()));
        }
        let count = pairs.len() as f64;
        let (own, other) = pairs
            .iter()
            .fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
        let floor = (count * off * off).max(f64::MIN_POSITIVE);
        0.5 * search.weights.independence[c] * count * ((other + floor) / (own + floor)).ln()
    });
    gains.sum::<f64>() - search.penalty(larger, smaller) < least
}

/// The gap as it is without jumps, where they are all that a set with dry friction leaves, of the records it was
/// fitted to and of the check records. `predictions` are those of the model as given, with re-estimated parameters
/// and corrected.
pub(crate) fn gap_between(
    check: &Problem,
    set: &Hypothesis,
    (effects, predictions): (&[Placed], &[Prediction]),
    gap: &Gap,
) -> Option<Gap> {
    let between = gap_of_check_between(check, (effects, predictions), gap)?;
    let left = &set.fit.discrepancy;
    let noise = noise_variance(left, &stepped(check, effects));
    let explains =
        excess_of_all(left, &noise) <= EXCESS || is_of_jumps(left, &jumping(check), &noise);
    explains.then_some(between)
}

/// The same of the check records alone.
pub(crate) fn gap_of_check_between(
    check: &Problem,
    (effects, predictions): (&[Placed], &[Prediction]),
    gap: &Gap,
) -> Option<Gap> {
    let [nominal, recalibrated, corrected] = predictions else {
        return None;
    };
    if !has_friction(effects) {
        return None;
    }
    let jumping = jumping(check);
    let noise = noise_variance(&corrected.discrepancy, &stepped(check, effects));
    if !is_of_jumps(&corrected.discrepancy, &jumping, &noise) {
        return None;
    }
    let std = check.output_std();
    let without = |prediction: &Prediction, all: f64| {
        let channels = variance(&prediction.discrepancy, &jumping).into_iter();
        let nrmse: Vec<f64> = channels.zip(&std).map(|(v, std)| v.sqrt() / std).collect();
        total(&nrmse).min(all)
    };
    let nominal = without(nominal, gap.nominal);
    let corrected = without(corrected, gap.corrected).max(gap.noise_floor);
    Some(Gap {
        nominal,
        recalibrated: without(recalibrated, gap.recalibrated),
        corrected,
        closed: closed(nominal, corrected, gap.noise_floor),
        ..gap.clone()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normal noise of unit variance: sums of twelve terms of a sequence that fills the interval evenly.
    fn noise(samples: usize) -> Vec<f64> {
        let mut word = 7_u64;
        let mut unit = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut next = || (0..12).map(|_| unit()).sum::<f64>() - 6.0;
        (0..samples).map(|_| next()).collect()
    }

    #[test]
    fn verify_the_worst_samples_leave_the_variance_of_noise_as_it_is() {
        let noise = [vec![noise(20_000)]];
        let [all, between] = [false, true].map(|jumps| variance(&noise, &[jumps])[0]);
        assert!((between / all - 1.0).abs() < 0.02, "{between} of {all}");
    }

    #[test]
    fn a_few_samples_off_by_a_jump_are_of_jumps() {
        let plain = noise(2000);
        let with = |extra: &dyn Fn(usize) -> f64| {
            let all = plain.iter().enumerate();
            [vec![all.map(|(k, d)| d + extra(k)).collect::<Vec<f64>>()]]
        };
        let (forces, positions) = ([true], [false]);
        let jumps = with(&|k| if k % 100 == 0 { 20.0 } else { 0.0 });
        assert!(is_of_jumps(&jumps, &forces, &[1.0]));
        assert!(
            !is_of_jumps(&jumps, &positions, &[1.0]),
            "a position does not jump"
        );
        let swing = with(&|k| 3.0 * (0.1 * k as f64).sin());
        assert!(!is_of_jumps(&swing, &forces, &[1.0]), "a wrong law");
        let both = with(&|k| 3.0 * (0.1 * k as f64).sin() + if k % 100 == 0 { 8.0 } else { 0.0 });
        assert!(
            !is_of_jumps(&both, &forces, &[1.0]),
            "a wrong law that jumps"
        );
        assert!(!is_of_jumps(&with(&|_| 0.0), &forces, &[1.0]), "noise");
    }
}
