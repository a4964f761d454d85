//! Many simulations at once give what each gives alone, to the last bit.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{
    self, base_input, force_input, force_output, model, oscillator, output, sampled,
};
use proptest::prelude::*;
use simgap_effects::{Effect, Placed, SiteKind, SiteScale, catalogue, free_laws, sites};
use simgap_model::{Load, Model, Pendulum};
use simgap_simulate::{Job, Run, Simulator, predict_all};

/// Two masses over a moving floor, every kind of output.
fn plant() -> Model {
    model(
        &[
            &oscillator(1.0, 900.0, 2.0, "floor"),
            "[[mass]]\nname = \"top\"\nvalue = 0.5\n",
            "[[spring]]\nname = \"k2\"\nbetween = [\"top\", \"block\"]\nstiffness = 700.0\n",
            "[[spring]]\nname = \"k3\"\nbetween = [\"top\", \"ground\"]\nstiffness = 200.0\n",
            "[[damper]]\nname = \"c2\"\nbetween = [\"top\", \"block\"]\ndamping = 0.8\n",
            &base_input("floor"),
            &force_input("top"),
            &output("x", "displacement", "top"),
            &output("v", "velocity", "block"),
            &output("a", "acceleration", "top"),
            &output("r", "acceleration", "floor"),
            &force_output("f", "floor", "block"),
        ]
        .concat(),
    )
}

const STEP_S: f64 = 0.004;

/// Runs of different lengths and clocks.
fn runs() -> Vec<Run> {
    let wave = |len: usize, phase: f64| -> Vec<Vec<f64>> {
        [(0.004, 17.0), (4.0, 29.0)]
            .map(|(size, w)| {
                sampled(STEP_S, len, |t| {
                    size * ((w * t + phase).sin() + (0.31 * w * t).cos())
                })
            })
            .into()
    };
    [(230, 0.0), (97, 1.3)]
        .map(|(len, phase)| Run {
            start_s: 0.3 * phase,
            measured: vec![Some(sampled(STEP_S, len, |t| (20.0 * t).sin())); 5],
            ..support::run(STEP_S, len, wave(len, phase))
        })
        .into()
}

fn scale() -> SiteScale {
    SiteScale {
        time_step_s: STEP_S,
        signal_step: 0.01,
        lines_hz: [3.0, 5.0, 8.0, 13.0],
        motion_hz: [3.0, 5.0, 8.0, 13.0],
        ..SiteScale::plain(0.004, 0.1, 3.0)
    }
}

/// The effect at each of its sites, with its starting values off by a factor.
fn instances(effect: &'static dyn Effect, model: &Model, factor: f64) -> Vec<Placed> {
    let mut placed = Vec::new();
    for at in sites(model, effect.site()) {
        for mut values in effect.starts(&scale()).into_iter().take(2) {
            values.iter_mut().for_each(|value| *value *= factor);
            effect.make_physical(&mut values);
            placed.push(Placed::new(effect, at.clone(), values));
        }
    }
    placed
}

fn bits(signals: &[Vec<f64>]) -> Vec<u64> {
    signals.iter().flatten().map(|v| v.to_bits()).collect()
}

/// Predicts all at once and one by one.
fn compare(simulators: &[Simulator], runs: &[Run], what: &str) {
    let initial = |k: usize| [0.001 * k as f64, -0.002, 0.03, 0.01 * (k % 5) as f64];
    let states: Vec<[f64; 4]> = (0..simulators.len()).map(initial).collect();
    for smooth in [false, true] {
        let jobs: Vec<Job<'_>> = simulators
            .iter()
            .zip(&states)
            .flat_map(|(simulator, initial)| {
                runs.iter().map(move |run| Job {
                    simulator,
                    run,
                    initial,
                    smooth,
                })
            })
            .collect();
        for (job, together) in jobs.iter().zip(predict_all(&jobs)) {
            let alone = if smooth {
                job.simulator.predict_smooth(job.run, job.initial)
            } else {
                job.simulator.predict(job.run, job.initial)
            };
            assert_eq!(bits(&together.unwrap()), bits(&alone.unwrap()), "{what}");
        }
    }
}

#[test]
fn verify_every_kind_of_the_catalogue_in_a_batch() {
    let (plain, runs) = (plant(), runs());
    let mut loaded = plain.clone();
    let (at, uncertainty) = ("top".to_string(), None);
    loaded.loads.push(Load {
        at: at.clone(),
        value: -4.9,
        uncertainty,
    });
    loaded.pendulums.push(Pendulum {
        at,
        value: 1.7,
        uncertainty,
    });
    let mut driven = plain.clone();
    let axis = Model::from_toml(include_str!("fixtures/servo_axis.toml")).unwrap();
    let mut cylinder = axis.elements.cylinders[0].clone();
    cylinder.between = ["top".into(), "ground".into()];
    driven.add_cylinder(cylinder).unwrap();
    let mut valve = axis.elements.valves[0].clone();
    valve.from = None;
    driven.add_valve(valve).unwrap();
    let all = catalogue()
        .iter()
        .chain(&free_laws())
        .copied()
        .collect::<Vec<_>>();
    // A simulator of someone else's is asked one set at a time.
    let own = all
        .into_iter()
        .filter(|effect| effect.site() != SiteKind::Parameter);
    for effect in own {
        let has_site = !sites(&plain, effect.site()).is_empty();
        let model = match has_site {
            true => plain.clone(),
            false if effect.site().is_hydraulic() => driven.clone(),
            false => loaded.clone(),
        };
        let simulators: Vec<Simulator> = [1.0, 0.97, 1.1, 0.5]
            .iter()
            .flat_map(|&factor| instances(effect, &model, factor))
            .map(|placed| Simulator::new(&model, &[placed], 2).unwrap())
            .collect();
        assert!(!simulators.is_empty(), "{}", effect.kind());
        compare(&simulators, &runs, effect.kind());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Sets of three effects of any kind, each with values of its own in every job.
    #[test]
    fn prop_sets_of_effects_in_a_batch(
        picks in proptest::collection::vec((0_usize..1000, 0_usize..1000), 3),
        factors in proptest::collection::vec(0.8_f64..1.25, 2..11),
        substeps in 1_usize..4,
    ) {
        let (model, runs) = (plant(), runs());
        let simulators: Vec<Simulator> = factors
            .iter()
            .map(|&factor| {
                let effects: Vec<Placed> = picks
                    .iter()
                    .filter_map(|(kind, place)| {
                        let effect = catalogue()[kind % catalogue().len()];
                        let all = instances(effect, &model, factor);
                        all.get(place % all.len().max(1)).cloned()
                    })
                    .collect();
                Simulator::new(&model, &effects, substeps).unwrap()
            })
            .collect();
        compare(&simulators, &runs, &format!("{picks:?}"));
    }
}
