//! Long records: what a search in a part of them finds, fitted to all.

use simgap_effects::{Placed, find};
use simgap_estimate::Problem;
use simgap_inference::CandidateModel;
use simgap_model::{Location, Model};
use simgap_simulate::Run;

use crate::common::{self, record};

const AXIS: &str = r#"
schema = "simgap-model/1"
name = "axis"
[[mass]]
name = "slide"
value = 3.0
[[spring]]
name = "spring"
between = ["slide", "ground"]
stiffness = 2000.0
[[damper]]
name = "damper"
between = ["slide", "ground"]
damping = 20.0
[[input]]
channel = "F"
kind = "force"
at = "slide"
[[output]]
channel = "x"
kind = "displacement"
at = "slide"
"#;

const LEN: usize = 6000;
const CUBIC: f64 = 4.0e6;

/// A slide on a hardening spring, moved by two tones.
fn tones(model: &Model) -> Run {
    let force = |n: usize| {
        let t = 0.002 * n as f64;
        20.0 * (std::f64::consts::TAU * 0.9 * t).sin()
            + 15.0 * (std::f64::consts::TAU * 2.3 * t).sin()
    };
    let at = Location::Between(["slide".into(), "ground".into()]);
    let spring = Placed::new(find("cubic_stiffness").unwrap(), at, vec![CUBIC]);
    record(model, spring, 0.002, (0..LEN).map(force).collect(), 2e-5)
}

/// The best set, and what finding it cost.
fn found(problem: &mut Problem, part: Option<&Problem>) -> (CandidateModel, u64) {
    let before = problem.effort.spent();
    let pool = common::found(problem, part);
    (pool[0].clone(), problem.effort.spent() - before)
}

/// By a stretch that begins elsewhere, and by every fifth sample of the whole: the answer is that of all samples, for less.
#[test]
fn verify_what_a_part_proposes_is_what_all_samples_say() {
    let model = Model::from_toml(AXIS).unwrap();
    let run = tones(&model);
    let mut problem = Problem::new(&model, vec![run.clone()]).unwrap();
    let (whole, cost) = found(&mut problem, None);
    assert_eq!(whole.key(), ["cubic_stiffness between slide and ground"]);
    for part in [run.slice(2000..3500), run.thinned(5)] {
        let part = problem.with_runs(vec![part]);
        let (of_part, less) = found(&mut problem, Some(&part));
        assert_eq!(of_part.key(), whole.key());
        let ratio = of_part.effects()[0].values[0] / CUBIC;
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        let apart = of_part.log_posterior() - whole.log_posterior();
        assert!(apart.abs() < 0.1, "fitted to all samples: {apart}");
        assert!(less < cost, "{less} for {cost}");
    }
}
