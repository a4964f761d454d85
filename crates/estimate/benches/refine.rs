//! Two masses, two outputs, two records of 60 s at 1 kHz: the refinement of one candidate and the
//! score of another.
//!
//! `cargo bench -p simgap-estimate --bench refine`
#![allow(clippy::unwrap_used, missing_docs)]

use simgap_effects::{Placed, SiteScale, find};
use simgap_estimate::{Candidate, FitOptions, Problem, Start, fit, linearise_at, score};
use simgap_model::{Location, Model};
use simgap_simulate::{Job, Run, Simulator, predict_all};

const SAMPLES: usize = 60_000;
const STEP_S: f64 = 1e-3;

const PLANT: &str = r#"schema = "simgap-model/1"
name = "two masses"
[[mass]]
name = "base"
value = 2.0
[[mass]]
name = "top"
value = 0.7
[[spring]]
name = "k1"
between = ["base", "ground"]
stiffness = 4000.0
[[spring]]
name = "k2"
between = ["top", "base"]
stiffness = 2500.0
[[damper]]
name = "c1"
between = ["base", "ground"]
damping = 4.0
[[damper]]
name = "c2"
between = ["top", "base"]
damping = 1.5
[[input]]
channel = "u"
kind = "force"
at = "base"
[[output]]
channel = "x"
kind = "displacement"
at = "top"
[[output]]
channel = "a"
kind = "acceleration"
at = "base"
"#;

fn ground() -> Location {
    Location::Between(["base".into(), "ground".into()])
}

fn placed(kind: &str, values: &[f64]) -> Placed {
    Placed::new(find(kind).unwrap(), ground(), values.to_vec())
}

/// Pseudo-random numbers of zero mean, by splitmix64.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Records of a plant with friction and a stiffening spring, with noise.
fn problem() -> Problem {
    let model = Model::from_toml(PLANT).unwrap();
    let hidden = [
        placed("coulomb_friction", &[2.0]),
        placed("cubic_stiffness", &[4e6]),
    ];
    let mut seed = 7;
    let runs = [0.0, 2.0].map(|phase| {
        let wave = |k: usize| {
            let t = k as f64 * STEP_S;
            20.0 * ((23.0 * t + phase).sin() + (37.0 * t).cos() + (71.0 * t + phase).sin())
        };
        let mut run = Run {
            first_index: 0,
            name: "made here".into(),
            start_s: 0.0,
            time_step_s: STEP_S,
            len: SAMPLES,
            inputs: vec![(0..SAMPLES).map(wave).collect()],
            measured: vec![],
            mended: simgap_simulate::Mended::default(),
        };
        let truth = Simulator::new(&model, &hidden, 1).unwrap();
        let mut signals = truth.predict(&run, &[0.0; 4]).unwrap();
        for (signal, size) in signals.iter_mut().zip([1e-4, 0.2]) {
            signal
                .iter_mut()
                .for_each(|y| *y += size * noise(&mut seed));
        }
        run.measured = signals.into_iter().map(Some).collect();
        run
    });
    let mut problem = Problem::new(&model, runs.into()).unwrap();
    problem.substeps = 1;
    problem
}

fn start(problem: &Problem, effects: Vec<Placed>) -> Start {
    let nominal = problem.nominal_parameters().into_iter().map(|candidate| {
        let values = candidate.effect.parameters().iter();
        let values = values.map(|p| p.neutral.unwrap_or(1.0)).collect();
        Placed::new(candidate.effect, candidate.at, values)
    });
    Start {
        effects,
        nominal: nominal.collect(),
        initial: vec![vec![0.0; 4]; problem.runs.len()],
    }
}

/// The fit of friction and a stiffening spring, nominal parameters and initial states.
#[divan::bench(sample_count = 5)]
fn refinement_of_one_candidate(bencher: divan::Bencher<'_, '_>) {
    let problem = problem();
    let effects = vec![
        placed("coulomb_friction", &[1.0]),
        placed("cubic_stiffness", &[1e6]),
    ];
    let start = start(&problem, effects);
    let weights = FitOptions::white(2);
    bencher.bench_local(|| fit(&problem, &start, &weights).unwrap());
}

/// The score of a friction that falls with the speed, all its starts.
#[divan::bench(sample_count = 5)]
fn score_of_one_candidate(bencher: divan::Bencher<'_, '_>) {
    let problem = problem();
    let weights = FitOptions::white(2);
    let start = start(&problem, vec![placed("cubic_stiffness", &[4e6])]);
    let base = fit(&problem, &start, &weights).unwrap();
    let base = linearise_at(&problem, &base, &weights).unwrap();
    let candidate = Candidate {
        effect: find("stribeck_friction").unwrap(),
        at: ground(),
    };
    let scale = SiteScale {
        time_step_s: STEP_S,
        ..SiteScale::plain(0.01, 0.3, 30.0)
    };
    bencher.bench_local(|| score(&base, &candidate, &scale).unwrap());
}

/// Sixteen sets of two effects on one record, one by one and together.
#[divan::bench(args = [false, true], sample_count = 5)]
fn sixteen_simulations(bencher: divan::Bencher<'_, '_>, together: bool) {
    let problem = problem();
    let simulators: Vec<Simulator> = (0..16)
        .map(|k| {
            let size = 1.0 + 0.01 * f64::from(k);
            let effects = [
                placed("coulomb_friction", &[2.0 * size]),
                placed("cubic_stiffness", &[4e6 * size]),
            ];
            problem.simulator(&effects, 0).unwrap()
        })
        .collect();
    let run = &problem.runs[0];
    let counter = divan::counter::ItemsCount::new(16 * SAMPLES);
    bencher.counter(counter).bench_local(|| {
        if !together {
            let alone = simulators.iter().map(|s| s.predict(run, &[0.0; 4]));
            return alone.collect::<Vec<_>>();
        }
        let job = |simulator| Job {
            simulator,
            run,
            initial: &[0.0; 4],
            smooth: false,
        };
        predict_all(&simulators.iter().map(job).collect::<Vec<_>>())
    });
}

fn main() {
    divan::main();
}
