//! What drives the plant: forces on the masses and motion of the bases, sample by sample.

use simgap_model::BetweenSamples;

/// Forces on the masses and motion of the bases, samples × masses or bases, row-major.
#[derive(Default)]
pub(crate) struct Drive {
    /// What the propagator joins by straight lines, such that they push as the smooth curve through the
    /// samples does.
    pub(crate) dof_force: Vec<f64>,
    /// What the force at each sample is beyond that, for each mass that is driven.
    pub(crate) beyond: Vec<(usize, Vec<f64>)>,
    /// The impulse by which held forces are ahead of the straight lines at each sample, N s.
    pub(crate) impulse_beyond: Vec<(usize, Vec<f64>)>,
    pub(crate) base_displacement: Vec<f64>,
    pub(crate) base_velocity: Vec<f64>,
    pub(crate) base_acceleration: Vec<f64>,
    pub(crate) base_count: usize,
}

impl Drive {
    /// Adds a signal times a weight to the forces on one of n masses. A smooth one is straightened with all others later.
    pub(crate) fn add(
        &mut self,
        between: BetweenSamples,
        (dof, n): (usize, usize),
        (signal, weight): (&[f64], f64),
        time_step_s: f64,
    ) {
        if between == BetweenSamples::Held {
            let beyond = add_held(&mut self.dof_force, (dof, n), signal, weight);
            let ahead = impulse_beyond(signal, weight, &beyond, time_step_s);
            self.beyond.push((dof, beyond));
            self.impulse_beyond.push((dof, ahead));
            return;
        }
        let forces = self.dof_force.iter_mut().skip(dof).step_by(n);
        for (force, value) in forces.zip(signal) {
            *force += weight * value;
        }
    }
}

/// What a drive depends on: two simulators with the same key have the same drive in each run.
#[derive(PartialEq)]
pub(crate) struct DriveKey<'a> {
    pub(crate) input_effects: &'a [(&'static str, Vec<f64>)],
    pub(crate) between_samples: Vec<BetweenSamples>,
    pub(crate) mapped_inputs: Vec<usize>,
    pub(crate) input_terms: Vec<Vec<(usize, f64)>>,
    pub(crate) loads: &'a [f64],
    pub(crate) couplings: Vec<Coupling>,
}

/// A spring or damper between a mass and a moving base.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Coupling {
    pub(crate) dof: usize,
    pub(crate) base: usize,
    /// Zero: to the displacement; one: to the velocity; two: to the acceleration.
    pub(crate) order: usize,
    pub(crate) coefficient: f64,
}

/// Changes of a signal from each sample to the next that stand alone: it pauses before and after them. Zero elsewhere.
#[must_use]
pub fn lone_changes(signal: &[f64]) -> Vec<f64> {
    let changes: Vec<f64> = signal.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let pauses = |k: Option<usize>| k.and_then(|k| changes.get(k)).is_none_or(|c| *c == 0.0);
    let each = changes.iter().enumerate();
    let lone = each.map(
        |(k, change)| match pauses(k.checked_sub(1)) && pauses(Some(k + 1)) {
            true => *change,
            false => 0.0,
        },
    );
    lone.collect()
}

/// A signal in two parts: the steps of which it holds the [`lone_changes`], and what is left without them.
pub(crate) fn steps_apart(signal: &[f64]) -> [Vec<f64>; 2] {
    let changes = [0.0].into_iter().chain(lone_changes(signal));
    let steps = changes.take(signal.len()).scan(0.0, |level, change| {
        *level += change;
        Some(*level)
    });
    let steps: Vec<f64> = steps.collect();
    let rest = signal.iter().zip(&steps).map(|(value, step)| value - step);
    [rest.collect(), steps]
}

/// Replaces sampled forces on n masses by those whose straight lines push as the smooth curve through the
/// samples does; returns what was taken away, sample by sample, for each mass where it is not zero throughout.
///
/// Straight lines between the samples of e^(iωt) are sinc²(ωh/2) of it, and harmonics about the sample rate,
/// which masses do not follow. With s = sin²(ωh/2) = −δ²/4, the inverse is
///
/// ```text
/// (ωh/2)²/s = 1 + s/3 + 8 s²/45 + ...,   f' = f − δ²f/12 + δ⁴f/90
/// ```
///
/// off by 0.01 % at ten samples a cycle, where straight lines lose 3 %. Of a pulse, the sum and the first
/// moment of what is taken away are zero. The last two samples at each end stay as they are.
pub(crate) fn straighten(force: &mut [f64], n: usize) -> Vec<(usize, Vec<f64>)> {
    let mut beyond = Vec::new();
    for dof in 0..n {
        let of_dof: Vec<f64> = force.iter().skip(dof).step_by(n).copied().collect();
        if of_dof.iter().all(|value| *value == of_dof[0]) {
            continue;
        }
        let mut taken = vec![0.0; of_dof.len()];
        for (taken, f) in taken.iter_mut().skip(2).zip(of_dof.windows(5)) {
            let near = f[1] + f[3];
            let far = f[0] + f[4];
            let second = near - 2.0 * f[2];
            let fourth = far - 4.0 * near + 6.0 * f[2];
            *taken = second / 12.0 - fourth / 90.0;
        }
        for (force, taken) in force.iter_mut().skip(dof).step_by(n).zip(&taken) {
            *force -= taken;
        }
        beyond.push((dof, taken));
    }
    beyond
}

/// Adds to the forces on one of n masses what pushes as a signal does that keeps each value until the next sample;
/// returns what the signal is beyond that, sample by sample.
///
/// Held values are the means of intervals, and straight lines are wanted that push as the smooth curve with these means
/// does: with s = sin²(ωh/2), that curve at the samples and its straight lines are
///
/// ```text
/// f = (37 (u₋₁ + u₀) − 8 (u₋₂ + u₁) + (u₋₃ + u₂)) / 60
/// ```
///
/// whose fundamental is that of the held signal to 6th order: sinc(ωh/2) about half an interval late, off by 0.04 % at
/// ten samples a cycle. Before the first sample and after the last one the signal keeps its value.
fn add_held(force: &mut [f64], (dof, n): (usize, usize), signal: &[f64], weight: f64) -> Vec<f64> {
    const TAPS: [f64; 3] = [37.0 / 60.0, -8.0 / 60.0, 1.0 / 60.0];
    let last = signal.len().saturating_sub(1);
    let rows = force.iter_mut().skip(dof).step_by(n);
    let beyond = rows.zip(signal).enumerate().map(|(i, (force, value))| {
        let tap = |(j, tap): (usize, &f64)| {
            let before = signal[i.saturating_sub(j + 1)];
            let after = signal[(i + j).min(last)];
            tap * (before + after)
        };
        let pushes: f64 = TAPS.iter().enumerate().map(tap).sum();
        *force += weight * pushes;
        weight * (value - pushes)
    });
    beyond.collect()
}

/// The impulse by which held values are ahead of straight lines at each sample, from what they are beyond them there:
///
/// ```text
/// p_n = h (Σ_(i<n) (u_i − f_i) − (f_n − f_0)/2)
/// ```
///
/// with u the held values and f what the straight lines go through.
fn impulse_beyond(signal: &[f64], weight: f64, beyond: &[f64], step: f64) -> Vec<f64> {
    let line = |i: usize| weight * signal[i] - beyond[i];
    let mut sum = 0.0;
    let ahead = beyond.iter().enumerate().map(|(n, value)| {
        let ahead = step * (sum - 0.5 * (line(n) - line(0)));
        sum += value;
        ahead
    });
    ahead.collect()
}

/// First derivative of a sampled signal by five-point central differences,
///
/// ```text
/// y'_n = (y_(n−2) − 8 y_(n−1) + 8 y_(n+1) − y_(n+2)) / (12 h)
/// ```
///
/// and one-sided formulas of the same order at the ends. A difference within the rounding of its terms is
/// none: what pauses is at rest.
pub(crate) fn derivative(signal: &[f64], step: f64) -> Vec<f64> {
    let n = signal.len();
    if n < 5 {
        return (0..n)
            .map(|i| {
                let (left, right) = (i.saturating_sub(1), (i + 1).min(n - 1));
                let span = (right - left).max(1) as f64;
                (signal[right] - signal[left]) / (span * step)
            })
            .collect();
    }
    const EDGE: [[f64; 5]; 2] = [
        [-25.0, 48.0, -36.0, 16.0, -3.0],
        [-3.0, -10.0, 18.0, -6.0, 1.0],
    ];
    let edge = |row: usize, mirrored: bool| -> f64 {
        let sum: f64 = (0..5)
            .map(|j| {
                EDGE[row][j]
                    * if mirrored {
                        -signal[n - 1 - j]
                    } else {
                        signal[j]
                    }
            })
            .sum();
        sum / (12.0 * step)
    };
    (0..n)
        .map(|i| match (i, n - 1 - i) {
            (0 | 1, _) => edge(i, false),
            (_, 0 | 1) => edge(n - 1 - i, true),
            _ => {
                let s = signal;
                let terms = [s[i - 2], -8.0 * s[i - 1], 8.0 * s[i + 1], -s[i + 2]];
                let sum: f64 = terms.iter().sum();
                let rounding = 8.0 * f64::EPSILON * terms.iter().map(|t| t.abs()).sum::<f64>();
                if sum.abs() > rounding {
                    sum / (12.0 * step)
                } else {
                    0.0
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{add_held, derivative, lone_changes, steps_apart, straighten};

    /// Amplitude of the fundamental of straight lines through a sine of so many samples a cycle.
    fn fundamental(per_cycle: f64, straightened: bool) -> f64 {
        let angle = TAU / per_cycle;
        let mut force: Vec<f64> = (0..200).map(|i| (angle * f64::from(i)).cos()).collect();
        if straightened {
            straighten(&mut force, 1);
        }
        let half = 0.5 * angle;
        force[100] / (angle * 100.0).cos() * (half.sin() / half).powi(2)
    }

    #[test]
    fn verify_straight_lines_push_as_the_curve_does() {
        assert!((fundamental(10.0, false) - 0.9675).abs() < 1e-3);
        assert!((fundamental(10.0, true) - 1.0).abs() < 1.5e-4);
        assert!((fundamental(4.0, true) - 1.0).abs() < 0.02);
        // Sixth order: half the interval leaves a sixty-fourth.
        let ratio = (fundamental(15.0, true) - 1.0) / (fundamental(30.0, true) - 1.0);
        assert!((ratio / 64.0 - 1.0).abs() < 0.1, "{ratio}");
    }

    /// The fundamental of the held signal is sinc(ωh/2) of that of the samples, half an interval late.
    #[test]
    fn verify_straight_lines_push_as_held_values_do() {
        let off = |per_cycle: f64| {
            let angle = TAU / per_cycle;
            let signal: Vec<f64> = (0..200).map(|i| (angle * f64::from(i)).cos()).collect();
            let mut force = vec![0.0; 200];
            let beyond = add_held(&mut force, (0, 1), &signal, 2.0);
            for ((force, beyond), value) in force.iter().zip(beyond).zip(&signal) {
                assert!((force + beyond - 2.0 * value).abs() < 1e-14);
            }
            let half = 0.5 * angle;
            let sinc = half.sin() / half;
            let wanted = 2.0 * sinc * (angle * 99.5).cos();
            let found = force[100] * sinc * sinc;
            found / wanted - 1.0
        };
        assert!(off(10.0).abs() < 5e-4, "{}", off(10.0));
        let ratio = off(15.0) / off(30.0);
        assert!((ratio / 64.0 - 1.0).abs() < 0.1, "{ratio}");
    }

    /// A sine with a step of 3 in a pause, and two changes in a row, which are no step.
    #[test]
    fn verify_steps_are_what_changes_at_once() {
        let mut signal: Vec<f64> = (0..40).map(|i| (0.3 * f64::from(i)).sin()).collect();
        let pause = signal[39];
        signal.extend([
            pause,
            pause,
            pause + 3.0,
            pause + 3.0,
            pause + 4.0,
            pause + 5.0,
        ]);
        signal.extend([pause + 5.0; 3]);
        let lone: Vec<(usize, f64)> = lone_changes(&signal)
            .into_iter()
            .enumerate()
            .filter(|(_, change)| *change != 0.0)
            .collect();
        assert_eq!(lone.len(), 1);
        assert!(lone[0].0 == 41 && (lone[0].1 - 3.0).abs() < 1e-15);
        let [rest, steps] = steps_apart(&signal);
        for (i, (rest, step)) in rest.iter().zip(&steps).enumerate() {
            assert!((rest + step - signal[i]).abs() < 1e-15);
            assert!((step - if i < 42 { 0.0 } else { 3.0 }).abs() < 1e-15);
        }
        for signal in [vec![], vec![2.0]] {
            let [rest, steps] = steps_apart(&signal);
            assert_eq!((rest, steps), (signal.clone(), vec![0.0; signal.len()]));
        }
    }

    #[test]
    fn verify_what_is_taken_away_has_neither_sum_nor_moment() {
        let pulse = |i: u8| f64::from(u8::from((13..17).contains(&i)));
        let mut force: Vec<f64> = (0..30).map(pulse).collect();
        let before = force.clone();
        let beyond = straighten(&mut force, 1);
        let [(0, taken)] = &beyond[..] else {
            panic!("one mass is driven");
        };
        let sum: f64 = taken.iter().sum();
        let moment: f64 = taken.iter().enumerate().map(|(i, t)| i as f64 * t).sum();
        assert!(sum.abs() < 1e-14 && moment.abs() < 1e-12, "{sum} {moment}");
        for ((now, taken), before) in force.iter().zip(taken).zip(before) {
            assert!((now + taken - before).abs() < 1e-15);
        }
        assert_eq!(straighten(&mut [1.0, 5.0, 2.0], 1), [(0, vec![0.0; 3])]);
        assert_eq!(straighten(&mut [], 0), []);
        // Two masses, of which the second is driven by a pulse.
        let mut force = [3.0, 0.0, 3.0, 0.0, 3.0, 1.0, 3.0, 0.0, 3.0, 0.0];
        let beyond = straighten(&mut force, 2);
        assert_eq!(beyond.len(), 1);
        assert_eq!(
            (beyond[0].0, force[4], force[5]),
            (1, 3.0, 1.0 - beyond[0].1[2])
        );
    }

    /// Ten thirds of a metre, computed in two ways.
    #[test]
    fn verify_what_pauses_is_at_rest() {
        let values: Vec<f64> = (0..12)
            .map(|i| {
                if i % 2 == 0 {
                    10.0 / 3.0
                } else {
                    10.0 * (1.0 / 3.0)
                }
            })
            .collect();
        assert!(
            derivative(&values, 1e-4)[2..10]
                .iter()
                .all(|slope| *slope == 0.0)
        );
    }

    #[test]
    fn verify_derivative_is_exact_for_degree_four() {
        let values: Vec<f64> = (0..9).map(|i| (f64::from(i) * 0.5).powi(4)).collect();
        for (i, slope) in derivative(&values, 0.5).iter().enumerate() {
            assert!(
                (slope - 4.0 * (i as f64 * 0.5).powi(3)).abs() < 1e-10,
                "sample {i}"
            );
        }
    }
}
