//! Shared by the integration tests: small plants, runs with seeded noise.
#![allow(dead_code, unreachable_pub)]

use simgap_effects::{Placed, SiteScale, find};
use simgap_estimate::{Candidate, Problem, Start};
use simgap_model::{Location, Model};
use simgap_simulate::{Run, Simulator};

/// One mass on a spring and a damper, driven by a force, its displacement measured.
pub const OSCILLATOR: &str = r#"schema = "simgap-model/1"
name = "oscillator"
[[mass]]
name = "block"
value = 2.0
[[spring]]
name = "k"
between = ["block", "ground"]
stiffness = 800.0
[[damper]]
name = "c"
between = ["block", "ground"]
damping = 6.0
[[input]]
channel = "u"
kind = "force"
at = "block"
[[output]]
channel = "y"
kind = "displacement"
at = "block"
"#;

/// A damper driven by a displacement whose force is measured: linear in its damping.
pub const DAMPER: &str = r#"schema = "simgap-model/1"
name = "damper"
[[damper]]
name = "c"
between = ["rod", "ground"]
damping = 1500.0
[[input]]
channel = "x"
kind = "displacement"
at = "rod"
[[output]]
channel = "F"
kind = "force"
between = ["rod", "ground"]
"#;

pub fn model(text: &str) -> Model {
    Model::from_toml(text).unwrap()
}

/// Sines of unequal frequencies: every parameter of the plants shows.
pub fn drive(time_step_s: f64, len: usize, size: f64) -> Vec<f64> {
    let wave = |t: f64| (8.0 * t).sin() + 0.8 * (19.0 * t + 1.0).sin() + 0.7 * (33.0 * t).cos();
    (0..len)
        .map(|k| size * wave(k as f64 * time_step_s))
        .collect()
}

/// A run whose outputs are what the model with these effects predicts.
pub fn truth(
    model: &Model,
    effects: &[Placed],
    input: Vec<f64>,
    step: f64,
    initial: &[f64],
) -> Run {
    let mut run = Run {
        first_index: 0,
        name: "made here".into(),
        start_s: 0.0,
        time_step_s: step,
        len: input.len(),
        inputs: vec![input],
        measured: vec![],
        mended: simgap_simulate::Mended::default(),
    };
    let simulator = Simulator::new(model, effects, SUBSTEPS).unwrap();
    let predicted = simulator.predict(&run, initial).unwrap();
    run.measured = predicted.into_iter().map(Some).collect();
    run
}

/// Steps between samples of truth and estimate alike: their difference is then no model error.
pub const SUBSTEPS: usize = 4;

pub fn problem(model: &Model, run: Run) -> Problem {
    let mut problem = Problem::new(model, vec![run]).unwrap();
    problem.substeps = SUBSTEPS;
    problem
}

/// The run with white noise on its first output.
pub fn noisy(run: &Run, std: f64, seed: u64) -> Run {
    let mut run = run.clone();
    let mut normal = Normal(seed);
    for value in run.measured[0].as_mut().unwrap() {
        *value += std * normal.draw();
    }
    run
}

pub fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

pub fn placed(kind: &str, at: Location, values: &[f64]) -> Placed {
    Placed::new(find(kind).unwrap(), at, values.to_vec())
}

pub fn candidate(kind: &str, at: Location) -> Candidate {
    Candidate {
        effect: find(kind).unwrap(),
        at,
    }
}

pub fn start(effects: Vec<Placed>, nominal: Vec<Placed>, initial: &[f64]) -> Start {
    Start {
        effects,
        nominal,
        initial: vec![initial.to_vec()],
    }
}

pub fn scale() -> SiteScale {
    SiteScale {
        signal: 0.01,
        time_step_s: 0.01,
        duration_s: 4.0,
        ..SiteScale::plain(0.01, 0.2, 10.0)
    }
}

/// Normal deviates from a fixed seed: splitmix64 and Box-Muller.
pub struct Normal(pub u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn draw(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
