//! What is looked for beside an effect.

use simgap_effects::{Placed, find};
use simgap_estimate::Problem;
use simgap_model::{Location, Model};
use simgap_simulate::Simulator;

use crate::common::{found, record};

const DAMPER: &str = r#"
schema = "simgap-model/1"
name = "test stand"
[[damper]]
name = "damper"
between = ["rod", "ground"]
damping = 80.0
[[input]]
channel = "u"
kind = "displacement"
at = "rod"
[[output]]
channel = "F"
kind = "force"
between = ["rod", "ground"]
"#;

/// A delay leaves lines of its own: a gain that swings slowly is found beside it by the carrier of what both leave.
#[test]
fn verify_carriers_are_those_of_what_a_set_leaves() {
    let model = Model::from_toml(DAMPER).unwrap();
    let tones = |n: usize| {
        let t = 0.013 * n as f64;
        0.02 * (2.1 * t).sin() + 0.013 * (5.2 * t + 1.0).sin() + 0.008 * (9.0 * t).cos()
    };
    let at = Location::Channel("F".into());
    let kind = |kind: &str| find(kind).unwrap();
    let ripple = Placed::new(kind("gain_ripple"), at.clone(), vec![0.25, 0.173, -0.3]);
    let mut run = record(
        &model,
        ripple.clone(),
        0.013,
        (0..3000).map(tones).collect(),
        0.0,
    );
    let delay = Placed::new(kind("sensor_delay"), at, vec![0.088]);
    let simulator = Simulator::new(&model, &[ripple, delay], 1).unwrap();
    let seen = simulator.predict(&run, &[]).unwrap();
    let noise = (0..run.len as i64).map(|n| (n * n * 7919 % 1009) as f64 / 504.5 - 1.0);
    let seen = seen[0].iter().zip(noise).map(|(force, e)| force + 0.02 * e);
    run.measured = vec![Some(seen.collect())];
    let mut problem = Problem::new(&model, vec![run]).unwrap();
    let pool = found(&mut problem, None);
    // With one record of a damper the gain of its force and a damping that swings are the same.
    let swings = |placed: &Placed| match placed.effect.kind() {
        "gain_ripple" => Some(placed.values[0] / 0.25),
        "synchronous_force" => Some(placed.values[0] / (0.25 * 80.0)),
        _ => None,
    };
    let best = pool[0].effects();
    let size = best.iter().find_map(swings);
    assert!(
        size.is_some_and(|size| (size - 1.0).abs() < 0.02),
        "{size:?}"
    );
    let is_late = |placed: &Placed| placed.effect.kind().ends_with("_delay");
    let late = best.iter().find(|placed| is_late(placed));
    let late = late.map(|placed| placed.values[0]);
    assert!(
        late.is_some_and(|delay_s| (delay_s / 0.088 - 1.0).abs() < 0.01),
        "{late:?}"
    );
}
