//! A stiffness with its interval from a record: `cargo run -p simgap-estimate --example stiffness`.
#![allow(clippy::print_stdout)]

use simgap_effects::{Placed, find};
use simgap_estimate::{FitOptions, Problem, Start, fit};
use simgap_model::{Location, Model};
use simgap_simulate::{Mended, Run, Simulator};

const AXIS: &str = r#"
schema = "simgap-model/1"
name = "axis"
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::from_toml(AXIS)?;
    let problem = Problem::new(&model, vec![record(&model)?])?;
    let start = Start {
        effects: vec![spring(1.01)?],
        nominal: vec![],
        initial: problem.initial_guess(),
    };
    let found = fit(&problem, &start, &FitOptions::white(1))?.summary();
    for effect in &found.effects {
        for value in &effect.parameters {
            let [low, high] = value.ci95.ok_or("the data do not see it")?;
            let (kind, at) = (&effect.kind, &effect.at);
            println!(
                "{kind} {at}: {} = {:.4}, 95 %: {low:.4} to {high:.4}",
                value.name, value.value
            );
        }
    }
    println!("left: {:.1} um rms", 1e6 * found.variance[0].sqrt());
    Ok(())
}

/// A record of a table on a spring that is 10 % stiffer than that of the model, with noise of 20 µm.
fn record(model: &Model) -> Result<Run, Box<dyn std::error::Error>> {
    let chirp = |n: i32| (0.002 * f64::from(n * n)).sin();
    let mut run = Run {
        name: "sweep".into(),
        start_s: 0.0,
        time_step_s: 0.01,
        len: 400,
        first_index: 0,
        inputs: vec![(0..400).map(chirp).collect()],
        measured: vec![None],
        mended: Mended::default(),
    };
    let truth = Simulator::new(model, &[spring(1.1)?], 1)?.predict(&run, &[0.0, 0.0])?;
    // A sequence that no model of the catalogue makes, in the place of noise.
    let noise = (0..400).map(|n: i64| 2e-5 * ((n * n * 7919 % 1009) as f64 / 504.5 - 1.0));
    let seen = truth[0].iter().zip(noise).map(|(y, e)| y + e).collect();
    run.measured = vec![Some(seen)];
    Ok(run)
}

fn spring(factor: f64) -> Result<Placed, &'static str> {
    let kind = find("stiffness_error").ok_or("not in the catalogue")?;
    let at = Location::Between(["table".into(), "ground".into()]);
    Ok(Placed::new(kind, at, vec![factor]))
}
