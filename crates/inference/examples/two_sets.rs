//! Two explanations of one record and their probabilities: `cargo run -p simgap-inference --example two_sets`.
#![allow(clippy::print_stdout)]

use simgap_effects::{Placed, find};
use simgap_estimate::{FitOptions, Problem, Start, fit};
use simgap_inference::{Budget, ModelSpace, NoiseModel, Search, add, model_posterior, name};
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
    let nothing = Start {
        effects: vec![],
        nominal: vec![],
        initial: problem.initial_guess(),
    };
    let baseline = fit(&problem, &nothing, &FitOptions::white(1))?;
    let noise = NoiseModel::new(&problem, &baseline, &baseline)?;
    let space = ModelSpace::new(&problem, &baseline, &[])?;
    let budget = Budget {
        progress: &|_| {},
        is_spent: &|| false,
    };
    let gap: Vec<f64> = baseline.variance.iter().map(|v| v.sqrt()).collect();
    let search = Search::new(&problem, &noise, space, &gap, budget);
    let kind = find("damping_error").ok_or("not in the catalogue")?;
    let at = Location::Between(["table".into(), "ground".into()]);
    let damping = Placed::new(kind, at, vec![1.1]);
    let mut sets = vec![];
    for effect in [spring(1.05)?, damping] {
        sets.push(search.fit(&add(&nothing, effect))?);
    }
    let posterior = model_posterior(&search, sets)?;
    for (set, probability) in posterior.sets.iter().zip(&posterior.probabilities) {
        let effects: Vec<String> = set.effects().iter().map(name).collect();
        println!(
            "{}: ln Z = {:.1}, probability {probability:.3}",
            effects.join(" and "),
            set.log_marginal_likelihood
        );
    }
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
