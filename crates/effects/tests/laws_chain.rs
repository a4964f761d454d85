//! What the measurement chain does to a channel, each kind against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::{map, through};
use simgap_effects::Sampled;

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-14;

fn assert_near(found: f64, needed: f64, absolute: f64) {
    assert!(
        (found - needed).abs() <= absolute,
        "{found} instead of {needed}"
    );
}

#[test]
fn verify_sensor_gain_of_either_sign() {
    let signal = [0.5, -2.0, 0.0];
    let gained = through(map("sensor_gain", &[1.5]).as_ref(), &signal, 0.01);
    assert_eq!(gained, [0.75, -3.0, 0.0]);
    let swapped = through(map("sensor_gain", &[-1.0]).as_ref(), &signal, 0.01);
    assert_eq!(swapped, [-0.5, 2.0, 0.0]);
}
