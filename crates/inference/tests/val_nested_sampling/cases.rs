//! The cases: small plants with records made here, and the set of effects that is integrated over for each.

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_simulate::{Mended, Run, Simulator, substeps_for};

use crate::random::Random;

const STEP_S: f64 = 0.01;
/// Nominal values of the machine over those of the model file, by turns.
const OFF: [f64; 6] = [1.01, 0.985, 1.02, 0.99, 1.015, 0.98];

const ONE_MASS: &str = r#"
schema = "simgap-model/1"
name = "one mass"
[[mass]]
name = "table"
value = 2.0
[[spring]]
name = "leaf"
between = ["table", "ground"]
stiffness = 800.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 4.0
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

const TWO_MASSES: &str = r#"
schema = "simgap-model/1"
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
stiffness = 800.0
[[spring]]
name = "k2"
between = ["top", "base"]
stiffness = 600.0
[[damper]]
name = "c1"
between = ["base", "ground"]
damping = 6.0
[[damper]]
name = "c2"
between = ["top", "base"]
damping = 2.0
[[input]]
channel = "u"
kind = "force"
at = "base"
[[output]]
channel = "x"
kind = "displacement"
at = "base"
[[output]]
channel = "z"
kind = "displacement"
at = "top"
"#;

/// A set of effects with its records.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) model: Model,
    pub(crate) runs: Vec<Run>,
    /// The effects of the set, at values that a fit starts from.
    pub(crate) effects: Vec<Placed>,
    /// The kinds of nominal parameters that are adjusted beside them.
    pub(crate) nominal: &'static [&'static str],
}

/// What a case is made from.
struct Plan {
    name: &'static str,
    model: &'static str,
    /// Kinds, places and values of the effects of the machine; of a value of a record's own that of the first.
    truth: Vec<(&'static str, Location, Vec<f64>)>,
    /// Samples of each record.
    len: usize,
    runs: usize,
    /// Amplitude of the force, N.
    force_n: f64,
    /// Standard deviation of the noise of the sensors, m.
    noise_m: f64,
    /// Correlation of the noise from sample to sample.
    colour: f64,
    nominal: &'static [&'static str],
}

const ALL: &[&str] = &["mass_error", "stiffness_error", "damping_error"];

fn plan(name: &'static str, kind: &'static str, at: Location, values: &[f64]) -> Plan {
    Plan {
        name,
        model: ONE_MASS,
        truth: vec![(kind, at, values.to_vec())],
        len: 400,
        runs: 1,
        force_n: 4.0,
        noise_m: 1e-4,
        colour: 0.0,
        nominal: ALL,
    }
}

fn ground(mass: &str) -> Location {
    Location::Between([mass.into(), "ground".into()])
}

fn channel(name: &str) -> Location {
    Location::Channel(name.into())
}

/// Ten sets of different kinds.
pub(crate) fn cases() -> Vec<Case> {
    let table = || ground("table");
    let plans = vec![
        plan("coulomb friction", "coulomb_friction", table(), &[0.3]),
        plan("cubic spring", "cubic_stiffness", table(), &[4e5]),
        plan("wrong stiffness", "stiffness_error", table(), &[1.15]),
        plan("sensor delay", "sensor_delay", channel("y"), &[0.006]),
        plan("clipping", "clipping", channel("y"), &[0.011, -0.009]),
        Plan {
            runs: 2,
            nominal: &["stiffness_error", "damping_error"],
            ..plan(
                "harmonic force, two records",
                "harmonic_force",
                Location::Mass("table".into()),
                &[0.3, 4.7, 0.6],
            )
        },
        Plan {
            len: 600,
            ..plan(
                "force along the travel",
                "position_periodic_force",
                table(),
                &[0.25, -0.15, 0.006],
            )
        },
        Plan {
            noise_m: 4e-4,
            ..plan(
                "weak quadratic damping",
                "quadratic_damping",
                table(),
                &[0.5],
            )
        },
        Plan {
            len: 1200,
            noise_m: 5e-4,
            colour: 0.9,
            ..plan(
                "wrong damping, coloured noise",
                "damping_error",
                table(),
                &[1.6],
            )
        },
        Plan {
            model: TWO_MASSES,
            truth: vec![
                (
                    "cubic_stiffness",
                    Location::Between(["top".into(), "base".into()]),
                    vec![3e6],
                ),
                ("sensor_bias", channel("x"), vec![2e-4]),
            ],
            len: 300,
            nominal: &["stiffness_error"],
            ..plan(
                "cubic spring and bias, two masses",
                "sensor_bias",
                channel("x"),
                &[0.0],
            )
        },
    ];
    plans
        .iter()
        .enumerate()
        .map(|(number, plan)| made(plan, 1000 + number as u64))
        .collect()
}

/// Sets of which the log-likelihood is no quadratic in the coordinates of the priors, in ways that a closed form takes into
/// account.
pub(crate) fn beyond_a_quadratic() -> Vec<Case> {
    let table = || ground("table");
    let plans = [
        Plan {
            len: 120,
            ..plan(
                "cubic spring, a short record",
                "cubic_stiffness",
                table(),
                &[4e5],
            )
        },
        plan(
            "clipping on one side",
            "clipping",
            channel("y"),
            &[0.011, -0.1],
        ),
        Plan {
            colour: 0.97,
            noise_m: 3e-4,
            ..plan(
                "cubic spring, few independent samples",
                "cubic_stiffness",
                table(),
                &[2e5],
            )
        },
    ];
    plans
        .iter()
        .enumerate()
        .map(|(number, plan)| made(plan, 1000 + [17, 14, 16][number]))
        .collect()
}

/// Weak sets that have many peaks.
pub(crate) fn of_many_peaks() -> Vec<Case> {
    let plans = [
        Plan {
            noise_m: 4e-4,
            ..plan(
                "force along the travel, no cosine to be seen",
                "position_periodic_force",
                ground("table"),
                &[0.25, -0.01, 0.006],
            )
        },
        Plan {
            noise_m: 4e-4,
            ..plan(
                "harmonic force within the noise",
                "harmonic_force",
                Location::Mass("table".into()),
                &[0.05, 4.7, 0.6],
            )
        },
    ];
    plans
        .iter()
        .enumerate()
        .map(|(number, plan)| made(plan, 1000 + [18, 21][number]))
        .collect()
}

fn made(plan: &Plan, seed: u64) -> Case {
    let model = Model::from_toml(plan.model).unwrap();
    let mut random = Random::new(seed);
    let runs: Vec<Run> = (0..plan.runs)
        .map(|r| driven(&model, plan, r, &mut random))
        .collect();
    let substeps = substeps_for(&model, &runs).unwrap();
    let effects: Vec<Placed> = plan
        .truth
        .iter()
        .map(|(kind, at, values)| Placed::new(find(kind).unwrap(), at.clone(), values.clone()))
        .collect();
    let off = off(&model, &effects);
    let runs = runs.into_iter().enumerate().map(|(r, mut run)| {
        let in_run = effects.iter().map(|placed| {
            let mut placed = placed.clone();
            for place in placed.own_places() {
                placed.values[place] += 2.0 * r as f64;
            }
            placed
        });
        let all: Vec<Placed> = in_run.chain(off.iter().cloned()).collect();
        let simulator = Simulator::new(&model, &all, substeps).unwrap();
        let state = vec![1e-3; simulator.state_len()];
        let mut shown = simulator.predict(&run, &state).unwrap();
        for signal in &mut shown {
            add_noise(signal, plan, &mut random);
        }
        run.measured = shown.into_iter().map(Some).collect();
        run
    });
    let runs: Vec<Run> = runs.collect();
    let off_start = |placed: &Placed| {
        let mut placed = placed.clone();
        placed.values[0] *= 1.05;
        placed
    };
    Case {
        name: plan.name,
        effects: effects.iter().map(off_start).collect(),
        model,
        runs,
        nominal: plan.nominal,
    }
}

/// Nominal values a little off, of all that no effect of the case is.
fn off(model: &Model, effects: &[Placed]) -> Vec<Placed> {
    let mut found = vec![];
    for kind in ALL {
        let kind = find(kind).unwrap();
        for at in simgap_effects::places_of(model, kind) {
            let is_named = effects
                .iter()
                .any(|p| p.effect.kind() == kind.kind() && p.at == at);
            if !is_named {
                found.push(Placed::new(kind, at, vec![OFF[found.len() % OFF.len()]]));
            }
        }
    }
    found
}

/// A record of a sweep from 0.5 Hz to 7 Hz with a second tone, before it is measured.
fn driven(model: &Model, plan: &Plan, number: usize, random: &mut Random) -> Run {
    let duration = plan.len as f64 * STEP_S;
    let turn = 6.0 * random.uniform();
    let force = |n: usize| {
        let t = n as f64 * STEP_S;
        let cycles = 0.5 * t + 0.5 * 6.5 * t * t / duration;
        plan.force_n * ((std::f64::consts::TAU * cycles + turn).sin() + 0.4 * (9.0 * t).cos())
    };
    Run {
        name: format!("record {number}"),
        start_s: 0.0,
        time_step_s: STEP_S,
        len: plan.len,
        first_index: 0,
        inputs: vec![(0..plan.len).map(force).collect()],
        measured: vec![None; model.outputs.len()],
        mended: Mended::default(),
    }
}

fn add_noise(signal: &mut [f64], plan: &Plan, random: &mut Random) {
    let fresh = (1.0 - plan.colour.powi(2)).sqrt();
    let mut noise = random.normal();
    for value in signal {
        *value += plan.noise_m * noise;
        noise = plan.colour * noise + fresh * random.normal();
    }
}
