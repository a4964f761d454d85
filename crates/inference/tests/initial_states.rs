//! Initial states of sets in which motions part.

use simgap_effects::{Placed, find};
use simgap_estimate::{FitOptions, Problem, Start, fit};
use simgap_inference::{ModelSpace, NoiseModel, Search};
use simgap_model::{Location, Model};
use simgap_simulate::Run;

use crate::common::{record, without_end};

/// A body on a moved base, of which the acceleration alone is measured: where it begins is seen by its motion.
const ISOLATOR: &str = r#"
schema = "simgap-model/1"
name = "isolator"
[[mass]]
name = "body"
value = 2.0
[[spring]]
name = "leaf"
between = ["body", "base"]
stiffness = 800.0
[[damper]]
name = "guide"
between = ["body", "base"]
damping = 8.0
[[input]]
channel = "z"
kind = "displacement"
at = "base"
[[output]]
channel = "a"
kind = "acceleration"
at = "body"
"#;

const LEN: usize = 1500;
const PLAY_M: f64 = 0.01;

fn play(gap_m: f64) -> Placed {
    let at = Location::Between(["body".into(), "base".into()]);
    Placed::new(find("backlash").unwrap(), at, vec![gap_m])
}

/// A sweep of the base, with a body at rest in the middle of its play.
fn sweep(model: &Model) -> Run {
    let base = |n: usize| {
        let t = 0.01 * n as f64;
        0.012 * (std::f64::consts::TAU * (0.5 * t + 0.15 * t * t)).sin()
    };
    record(
        model,
        play(PLAY_M),
        0.01,
        (0..LEN).map(base).collect(),
        2e-4,
    )
}

/// With play, a fit of its width and of how the record begins ends where the body began on the wrong side of it: where the play is
/// found, how the record begins is found anew.
#[test]
fn verify_a_body_at_rest_in_its_play_is_found_from_afar() {
    let model = Model::from_toml(ISOLATOR).unwrap();
    let mut problem = Problem::new(&model, vec![sweep(&model)]).unwrap();
    let nothing = Start {
        effects: vec![],
        nominal: vec![],
        initial: problem.initial_guess(),
    };
    let baseline = fit(&problem, &nothing, &FitOptions::white(1)).unwrap();
    let noise = NoiseModel::new(&problem, &baseline, &baseline).unwrap();
    let space = ModelSpace::new(&problem, &baseline, &[]).unwrap();
    space.put_priors(&mut problem);
    let mut astray = 0;
    for state in [[0.02, 0.0], [-0.02, 0.0], [0.0, 0.2], [0.0, -0.2]] {
        let mut search = Search::new(
            &problem,
            &noise,
            space.clone(),
            &problem.output_std(),
            without_end(),
        );
        let start = Start {
            effects: vec![play(1.4 * PLAY_M)],
            nominal: vec![],
            initial: vec![state.to_vec()],
        };
        let first = search.fit(&start).unwrap();
        let again = search.recolour(std::slice::from_ref(&first));
        let own = search.fit(&first.fit.estimate).unwrap();
        astray += usize::from(own.fit.estimate.initial[0][0].abs() > 0.1 * PLAY_M);
        let found = &again[0];
        let values = (found.effects()[0].values[0], &found.fit.estimate.initial[0]);
        assert!((values.0 / PLAY_M - 1.0).abs() < 0.01, "{values:?}");
        assert!(values.1[0].abs() < 0.02 * PLAY_M, "{values:?}");
        assert!(found.log_posterior() >= own.log_posterior());
    }
    assert!(astray > 0, "no fit ends elsewhere");
}
