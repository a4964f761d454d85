//! A spring that softens, from which a plant runs away where it is scored.

use simgap_estimate::Problem;
use simgap_model::Model;
use simgap_simulate::{Mended, Run, Simulator};

use crate::common::found;

const LINEAR: &str = r#"
schema = "simgap-model/1"
name = "small angles"
[[mass]]
name = "bob"
value = 1.0
[[damper]]
name = "bearing"
between = ["bob", "ground"]
damping = 0.03
[[output]]
channel = "q"
kind = "displacement"
at = "bob"
"#;
const SPRING: &str = r#"
[[spring]]
name = "gravity"
between = ["bob", "ground"]
stiffness = 37.0
"#;
const PENDULUM: &str = r#"
[[pendulum]]
at = "bob"
value = 37.0
"#;

/// A pendulum that swings far, modelled by the spring that it is at small angles.
#[test]
fn verify_a_pendulum_that_swings_far_is_a_spring_that_softens() {
    let truth = Model::from_toml(&format!("{LINEAR}{PENDULUM}")).unwrap();
    let model = Model::from_toml(&format!("{LINEAR}{SPRING}")).unwrap();
    let simulator = Simulator::new(&truth, &[], 4).unwrap();
    let swung = |(name, angle): (&str, f64)| {
        let mut run = Run {
            name: name.into(),
            start_s: 0.0,
            time_step_s: 0.01,
            len: 580,
            first_index: 0,
            inputs: vec![],
            measured: vec![None],
            mended: Mended::default(),
        };
        let seen = simulator
            .predict(&run, &[angle, 0.0])
            .unwrap()
            .swap_remove(0);
        let noise = (0..580_i64).map(|n| (n * n * 7919 % 1009) as f64 / 504.5 - 1.0);
        run.measured = vec![Some(
            seen.iter().zip(noise).map(|(q, e)| q + 0.003 * e).collect(),
        )];
        run
    };
    let runs = [("far", 1.6), ("near", 0.25)].map(swung);
    let mut problem = Problem::new(&model, runs.into()).unwrap();
    let pool = found(&mut problem, None);
    let cubic = pool[0].effects().iter();
    let mut cubic = cubic.filter(|placed| placed.effect.kind() == "cubic_stiffness");
    // sin q = q − q³/6 + …: at 1.6 rad the best cubic is a little less.
    let stiffness = cubic.next().map(|placed| placed.values[0]);
    assert!(
        stiffness.is_some_and(|k| k < -0.8 * 37.0 / 6.0 && k > -1.05 * 37.0 / 6.0),
        "{stiffness:?}"
    );
}
