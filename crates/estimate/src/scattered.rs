//! Initial states beside the measured ones, for motions that part.
//!
//! A pendulum that stands upright, a mass that friction holds: states that differ by less than a sensor shows go different ways, and
//! the objective of an initial state has more valleys than a descent finds.

use std::sync::Arc;

use simgap_simulate::{Job, Simulator};

use crate::problem::rms_about_mean;
use crate::{EstimateError, Problem};

/// States that are tried, and how far they are from the measured one, over how far the motion goes.
const TRIED: usize = 256;
const NEAR: f64 = 0.01;
/// Of them the best, which are fitted.
const FITTED: usize = 3;
/// Share of the motion that is left, rms, from which on a fit may be in a valley beside the right one: a lap ahead or behind leaves as much as
/// the motion itself, even if it is lost in a hundredth of the records.
pub const ASTRAY: f64 = 0.1;

/// Whether what is left of a run is so much of some output that the two may have parted.
pub(crate) fn is_astray(problem: &Problem, discrepancy: &[Vec<f64>]) -> bool {
    let mut channels = discrepancy.iter().zip(problem.motion_std());
    channels.any(|(left, std)| rms_about_mean(|| left.iter()) > ASTRAY * std)
}

/// The best of many states about one, with which the only run of a problem begins, where the motion goes as far as `reach`.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub(crate) fn scattered(
    alone: &Problem,
    (state, reach): (&[f64], &[f64]),
) -> Result<Vec<Vec<f64>>, EstimateError> {
    let Some(run) = alone.runs.first() else {
        return Ok(vec![]);
    };
    let simulator: Arc<Simulator> = Arc::new(alone.simulator(&[], 0)?);
    let about = |number: usize| -> Vec<f64> {
        let entries = state.iter().zip(reach).enumerate();
        let moved = |(k, (value, reach)): (usize, (&f64, &f64))| {
            value + NEAR * reach * (2.0 * halton(number, k) - 1.0)
        };
        entries.map(moved).collect()
    };
    let states: Vec<Vec<f64>> = (1..=TRIED).map(about).collect();
    let jobs: Vec<Job<'_>> = states
        .iter()
        .map(|initial| Job {
            simulator: &simulator,
            run,
            initial,
            smooth: false,
        })
        .collect();
    let std = alone.motion_std();
    let left = |predicted: &Vec<Vec<f64>>| -> f64 {
        let channels = predicted.iter().zip(&run.measured).zip(&std);
        let squares = channels.filter_map(|((predicted, measured), std)| {
            let pairs = predicted.iter().zip(measured.as_ref()?);
            let square: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
            Some(square / (std * std))
        });
        squares.sum()
    };
    let predicted = alone.predict_all(&jobs).into_iter().zip(&states);
    // A state that cannot be simulated from is not the right one.
    let tried = predicted.filter_map(|(predicted, state)| Some((left(&predicted.ok()?), state)));
    let mut tried: Vec<(f64, &Vec<f64>)> = tried.filter(|(left, _)| left.is_finite()).collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = tried.into_iter().take(FITTED);
    Ok(best.map(|(_, state)| state.clone()).collect())
}

/// A coordinate of a point of Halton's sequence, evenly spread over 0 to 1: the digits of its number in a prime base, mirrored at the
/// point. Coordinates beyond the sixth repeat the bases.
#[must_use]
pub fn halton(mut number: usize, coordinate: usize) -> f64 {
    const PRIMES: [usize; 6] = [2, 3, 5, 7, 11, 13];
    let base = PRIMES[coordinate % PRIMES.len()];
    let (mut value, mut digit) = (0.0, 1.0);
    while number > 0 {
        digit /= base as f64;
        value += digit * (number % base) as f64;
        number /= base;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pendulum let go near its upper rest, seen to a hundredth of a radian: from where it was seen it falls the other way, and
    /// one of many states beside that follows it.
    #[test]
    fn verify_a_state_beside_the_measured_one_follows_what_parts() {
        let text = "schema = \"simgap-model/1\"\nname = \"pendulum\"\n\
            [[mass]]\nname = \"bob\"\nvalue = 0.14\n\
            [[pendulum]]\nat = \"bob\"\nvalue = 2.8\n\
            [[output]]\nchannel = \"q\"\nkind = \"displacement\"\nat = \"bob\"\n";
        let model = simgap_model::Model::from_toml(text).unwrap();
        let run = simgap_simulate::Run {
            name: "fall".into(),
            start_s: 0.0,
            time_step_s: 0.005,
            len: 500,
            first_index: 0,
            inputs: vec![],
            measured: vec![None],
            mended: simgap_simulate::Mended::default(),
        };
        let mut problem = Problem::new(&model, vec![]).unwrap();
        let simulator = problem.simulator(&[], 0).unwrap();
        let fall = |state: &[f64]| simulator.predict(&run, state).unwrap().swap_remove(0);
        let seen = fall(&[3.139, 0.0]);
        let measured = [3.145, 0.0];
        let apart = |state: &[f64]| {
            let left: Vec<f64> = fall(state).iter().zip(&seen).map(|(a, b)| a - b).collect();
            rms_about_mean(|| left.iter()) / rms_about_mean(|| seen.iter())
        };
        assert!(apart(&measured) > 1.0, "{}", apart(&measured));
        let left: Vec<f64> = fall(&measured)
            .iter()
            .zip(&seen)
            .map(|(a, b)| a - b)
            .collect();
        problem.runs = vec![simgap_simulate::Run {
            measured: vec![Some(seen.clone())],
            ..run.clone()
        }];
        assert!(is_astray(&problem, &[left]));
        let found = scattered(&problem, (&measured, &[3.2, 9.0])).unwrap();
        assert_eq!(found.len(), FITTED);
        let best = &found[0];
        assert!(apart(best) < ASTRAY, "{best:?} {}", apart(best));
        assert!((best[0] - measured[0]).abs() <= NEAR * 3.2 && best[1].abs() <= NEAR * 9.0);
    }

    #[test]
    fn verify_digits_are_mirrored() {
        let found: Vec<f64> = (1..5).map(|i| halton(i, 0)).collect();
        assert_eq!(found, [0.5, 0.25, 0.75, 0.125]);
    }
}
