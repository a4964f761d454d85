//! A plant that is simulated from outside against the same plant as a model file.
#![allow(clippy::unwrap_used)]

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_simulate::{
    ExternalPlant, Mended, Plant, PlantError, PlantRun, Run, SimulateError, Simulator,
};

const STEP_S: f64 = 2e-3;
const SAMPLES: usize = 3000;

const INSIDE: &str = r#"
schema = "simgap-model/1"
name = "table"
[[mass]]
name = "joint"
value = 2.0
[[spring]]
name = "leaf"
between = ["joint", "ground"]
stiffness = 800.0
[[damper]]
name = "guide"
between = ["joint", "ground"]
damping = 4.0
[[input]]
channel = "u"
kind = "force"
at = "joint"
between_samples = "held"
[[output]]
channel = "y"
kind = "displacement"
at = "joint"
"#;

const OUTSIDE: &str = r#"
schema = "simgap-model/1"
name = "table"
[[parameter]]
name = "mass"
value = 2.0
[[parameter]]
name = "damping"
value = 4.0
[[port]]
name = "joint"
displacement = "x"
velocity = "v"
[[input]]
channel = "u"
kind = "signal"
at = "force"
[[output]]
channel = "y"
kind = "signal"
at = "x"
"#;

/// The table of both models, stepped exactly under held forces by small steps; `bend` is a cubic spring.
struct Table {
    bend: f64,
    calls: Arc<AtomicUsize>,
}

const FINE: usize = 40;

impl Plant for Table {
    fn simulate(&self, run: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError> {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let value = |name: &str| {
            run.parameters
                .iter()
                .find(|(known, _)| known == name)
                .unwrap()
                .1
        };
        let (m, c, h) = (
            value("mass"),
            value("damping"),
            run.time_step_s / FINE as f64,
        );
        let (mut x, mut v) = (0.0, 0.0);
        let rate = |x: f64, v: f64, f: f64| (f - c * v - 800.0 * x - self.bend * x * x * x) / m;
        let mut signals = [vec![], vec![]];
        for n in 0..run.len {
            signals[0].push(x);
            signals[1].push(v);
            let f = run.inputs[0].1[n] + run.forces[0].1[n];
            for _ in 0..FINE {
                let (k1x, k1v) = (v, rate(x, v, f));
                let (k2x, k2v) = (
                    v + 0.5 * h * k1v,
                    rate(x + 0.5 * h * k1x, v + 0.5 * h * k1v, f),
                );
                let (k3x, k3v) = (
                    v + 0.5 * h * k2v,
                    rate(x + 0.5 * h * k2x, v + 0.5 * h * k2v, f),
                );
                let (k4x, k4v) = (v + h * k3v, rate(x + h * k3x, v + h * k3v, f));
                x += h / 6.0 * (k1x + 2.0 * k2x + 2.0 * k3x + k4x);
                v += h / 6.0 * (k1v + 2.0 * k2v + 2.0 * k3v + k4v);
            }
        }
        let of = |name: &String| signals[usize::from(name == "v")].clone();
        Ok(run.outputs.iter().map(of).collect())
    }
}

fn table(bend: f64) -> (Arc<ExternalPlant>, Arc<AtomicUsize>) {
    let calls = Arc::new(AtomicUsize::new(0));
    let plant = Table {
        bend,
        calls: Arc::clone(&calls),
    };
    (ExternalPlant::new(plant), calls)
}

/// Two tones that the table follows with up to 40 mm.
fn run(model: &Model) -> Run {
    let force = |n: usize| {
        let t = n as f64 * STEP_S;
        9.0 * (11.0 * t).sin() + 6.0 * (23.0 * t).cos()
    };
    Run {
        name: "tones".into(),
        start_s: 0.0,
        time_step_s: STEP_S,
        len: SAMPLES,
        first_index: 0,
        inputs: vec![(0..SAMPLES).map(force).collect()],
        measured: vec![None; model.outputs.len()],
        mended: Mended::default(),
    }
}

fn at_joint() -> Location {
    Location::Between(["joint".into(), "ground".into()])
}

fn placed(kind: &str, at: Location, values: &[f64]) -> Placed {
    Placed::new(find(kind).unwrap(), at, values.to_vec())
}

/// The displacement inside and outside under the same effects, and how often the plant was asked.
fn both(effects: &[Placed]) -> ([Vec<f64>; 2], usize) {
    let (inside, outside) = (
        Model::from_toml(INSIDE).unwrap(),
        Model::from_toml(OUTSIDE).unwrap(),
    );
    let (plant, calls) = table(0.0);
    let inner = Simulator::new(&inside, effects, 16).unwrap();
    let outer = Simulator::with_plant(&outside, effects, 1, Some(&plant)).unwrap();
    let one = inner.predict(&run(&inside), &[]).unwrap().swap_remove(0);
    let other = outer.predict(&run(&outside), &[]).unwrap().swap_remove(0);
    ([one, other], calls.load(Ordering::Relaxed))
}

/// Largest difference over the largest value.
fn apart([one, other]: &[Vec<f64>; 2]) -> f64 {
    let size = one.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    let apart = one.iter().zip(other).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max) / size
}

/// The model file reads held forces as smooth ones that push as much: off by (ωh)⁶ and what the first sample sets off.
const SAME: f64 = 2e-3;

/// A friction F that is held from sample to sample turns up to a sample h late where the motion turns: by 2 F h / m of the
/// velocity each time, about 1 % of 0.4 m/s here.
const HELD: f64 = 1e-2;

#[test]
fn verify_a_plant_outside_predicts_as_the_model_file_does() {
    let (found, calls) = both(&[]);
    assert!(apart(&found) < SAME, "{}", apart(&found));
    assert_eq!(calls, 1);
    let late = [placed(
        "sensor_delay",
        Location::Channel("y".into()),
        &[0.004],
    )];
    let (found, calls) = both(&late);
    assert!(apart(&found) < SAME, "{}", apart(&found));
    assert_eq!(calls, 1);
    let weak = [placed("input_gain", Location::Input("u".into()), &[0.8])];
    assert!(apart(&both(&weak).0) < SAME);
}

/// A linear plant settles in a few questions: nominal, two pulses, the forces.
#[test]
fn verify_forces_at_a_port_act_as_they_do_in_a_model_file() {
    let laws = [
        placed("coulomb_friction", at_joint(), &[2.0]),
        placed("viscous_damping", at_joint(), &[3.0]),
        placed("linear_stiffness", at_joint(), &[150.0]),
        placed("cubic_stiffness", at_joint(), &[4e5]),
        placed("asymmetric_damping", at_joint(), &[2.0, 6.0]),
        placed("stribeck_friction", at_joint(), &[1.5, 2.5, 0.05]),
        placed("hysteresis", at_joint(), &[600.0, 0.005, 0.5, 1.0, 0.0]),
        placed("constant_force", Location::Mass("joint".into()), &[3.0]),
    ];
    for law in laws {
        let kind = law.effect.kind();
        let plain = both(&[]).0;
        let (found, calls) = both(&[law]);
        assert!(apart(&found) < HELD, "{kind}: {}", apart(&found));
        assert!(
            apart(&[plain[0].clone(), found[0].clone()]) > 0.02,
            "{kind} does nothing"
        );
        assert!(calls <= 6, "{kind}: {calls} calls");
    }
}

#[test]
fn verify_two_laws_at_a_port_act_together() {
    let laws = [
        placed("coulomb_friction", at_joint(), &[2.0]),
        placed("viscous_damping", at_joint(), &[3.0]),
    ];
    let (found, _) = both(&laws);
    assert!(apart(&found) < HELD, "{}", apart(&found));
}

/// A hardening spring of the plant itself: the response about its own motion is wrong, and the answers put it right.
#[test]
fn verify_forces_settle_where_the_plant_is_not_linear() {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let (plant, calls) = table(6e5);
    let laws = [placed("coulomb_friction", at_joint(), &[2.0])];
    let run = run(&outside);
    let simulator = Simulator::with_plant(&outside, &laws, 1, Some(&plant)).unwrap();
    let settled = simulator.predict(&run, &[]).unwrap().swap_remove(0);
    let questions = calls.load(Ordering::Relaxed);
    assert!(questions < 40, "{questions}");
    let inside = INSIDE.to_owned()
        + "[[effect]]\nkind = \"cubic_stiffness\"\nbetween = [\"joint\", \"ground\"]\ncubic_stiffness_n_per_m3 = 6e5\n";
    let inside = Model::from_toml(&inside).unwrap();
    let given = Placed::from_entry(&inside, &inside.effects[0]).unwrap();
    let reference = Simulator::new(&inside, &[given, laws[0].clone()], 16).unwrap();
    let reference = reference.predict(&run, &[]).unwrap().swap_remove(0);
    let found = apart(&[reference, settled]);
    assert!(found < HELD, "{found}");
}

/// Values a difference away begin where the forces have settled: fewer questions, and the same answer to what is left when forces
/// and motion agree (1e-5 of the range).
#[test]
fn verify_a_simulator_beside_another_is_asked_less_often() {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let run = run(&outside);
    let laws = |friction: f64, factor: f64| {
        let mass = Location::Parameter("mass".into());
        [
            placed("coulomb_friction", at_joint(), &[friction]),
            placed("parameter_error", mass, &[factor]),
        ]
    };
    for (friction, factor) in [(2.0002, 1.0), (2.0, 1.0001)] {
        let (plant, calls) = table(6e5);
        let of = |friction, factor| {
            Simulator::with_plant(&outside, &laws(friction, factor), 1, Some(&plant)).unwrap()
        };
        let here = Arc::new(of(2.0, 1.0));
        here.predict(&run, &[]).unwrap();
        let before = calls.load(Ordering::Relaxed);
        let beside = of(friction, factor).beside(Some(&here));
        let near = beside.predict(&run, &[]).unwrap().swap_remove(0);
        let between = calls.load(Ordering::Relaxed);
        let alone = of(friction, factor).predict(&run, &[]).unwrap();
        let after = calls.load(Ordering::Relaxed);
        let (asked, needed) = (between - before, after - between);
        assert!(2 * asked <= needed, "{asked} questions, alone {needed}");
        let found = apart(&[alone[0].clone(), near]);
        assert!(found < 1e-5, "{found}");
    }
}

/// A table that takes its time.
struct Slow(Table);

impl Plant for Slow {
    fn simulate(&self, run: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError> {
        std::thread::sleep(std::time::Duration::from_millis(100));
        self.0.simulate(run)
    }
}

#[test]
fn verify_an_equal_question_at_the_same_time_waits_for_the_answer() {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let calls = Arc::new(AtomicUsize::new(0));
    let plant = ExternalPlant::new(Slow(Table {
        bend: 0.0,
        calls: Arc::clone(&calls),
    }));
    let run = run(&outside);
    let together = std::sync::Barrier::new(4);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let simulator = Simulator::with_plant(&outside, &[], 1, Some(&plant)).unwrap();
                together.wait();
                simulator.predict(&run, &[]).unwrap();
            });
        }
    });
    assert_eq!(calls.load(Ordering::Relaxed), 1);
}

#[test]
fn verify_parameters_reach_the_plant_and_answers_are_kept() {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let (plant, calls) = table(0.0);
    let heavy = [placed(
        "parameter_error",
        Location::Parameter("mass".into()),
        &[1.2],
    )];
    let run = run(&outside);
    let predict = |effects: &[Placed]| {
        let simulator = Simulator::with_plant(&outside, effects, 1, Some(&plant)).unwrap();
        simulator.predict(&run, &[]).unwrap().swap_remove(0)
    };
    let (plain, moved) = (predict(&[]), predict(&heavy));
    let inside = INSIDE.replace("value = 2.0", "value = 2.4");
    let inside = Simulator::new(&Model::from_toml(&inside).unwrap(), &[], 1).unwrap();
    let reference = inside.predict(&run, &[]).unwrap().swap_remove(0);
    assert!(apart(&[reference, moved.clone()]) < SAME);
    assert!(apart(&[plain.clone(), moved.clone()]) > 0.05);
    assert_eq!((predict(&[]), predict(&heavy)), (plain, moved));
    assert_eq!(calls.load(Ordering::Relaxed), 2);
}

#[test]
fn verify_the_motion_and_the_inertia_of_a_port_are_told() {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let (plant, _) = table(0.0);
    let run = run(&outside);
    let simulator = Simulator::with_plant(&outside, &[], 1, Some(&plant)).unwrap();
    let path = simulator.path(&run, &[], &at_joint()).unwrap();
    assert_eq!(path.displacement, simulator.predict(&run, &[]).unwrap()[0]);
    let inertia = simulator.port_inertia(&run, &at_joint()).unwrap().unwrap();
    // A damper and a spring take part of a sample's push.
    assert!((inertia / 2.0 - 1.0).abs() < 0.01, "{inertia}");
    let channel = Location::Channel("y".into());
    assert_eq!(simulator.port_inertia(&run, &channel).unwrap(), None);
}

/// Gives what it was told to.
struct Given(Mutex<Vec<Vec<f64>>>);

impl Plant for Given {
    fn simulate(&self, _: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError> {
        Ok(self.0.lock().unwrap().clone())
    }
}

fn refused(answer: Vec<Vec<f64>>, effects: &[Placed]) -> String {
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let plant = ExternalPlant::new(Given(Mutex::new(answer)));
    let simulator = Simulator::with_plant(&outside, effects, 1, Some(&plant)).unwrap();
    let error = simulator.predict(&run(&outside), &[]).unwrap_err();
    assert!(matches!(error, SimulateError::Plant(_)));
    error.to_string()
}

#[test]
fn verify_answers_that_are_none_are_refused_in_one_line() {
    let still = || vec![0.0; SAMPLES];
    assert_eq!(
        refused(vec![still(), vec![0.0; 10]], &[]),
        "output \"v\" of the simulator has 10 values, needed is one for each of the 3000 samples of the inputs"
    );
    let mut broken = still();
    broken[500] = f64::NAN;
    assert_eq!(
        refused(vec![broken, still()], &[]),
        "output \"x\" of the simulator is NaN at 1 s, needed is a finite number"
    );
    let friction = [placed("coulomb_friction", at_joint(), &[2.0])];
    assert_eq!(
        refused(vec![still(), still()], &friction),
        "a force at port \"joint\" does not move its velocity in its own direction, needed is a simulator that applies the forces it \
         is given"
    );
    let outside = Model::from_toml(OUTSIDE).unwrap();
    let without = Simulator::new(&outside, &[], 1).err().unwrap();
    assert_eq!(
        without.to_string(),
        "model \"table\" stands for a simulator, needed is the simulator itself: it is asked from Python or Rust, not from a model \
         file"
    );
}
