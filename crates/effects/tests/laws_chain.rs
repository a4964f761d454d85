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

#[test]
fn verify_sensor_drift_counts_from_the_start_of_the_record() {
    let map = map("sensor_drift", &[0.3]);
    let signal: Vec<f64> = (0..50).map(|i| (0.3 * f64::from(i)).sin()).collect();
    let whole = through(map.as_ref(), &signal, 0.02);
    for (i, (found, y)) in whole.iter().zip(&signal).enumerate() {
        assert_near(*found, y + 0.3 * 0.02 * i as f64, ROUNDING);
    }
    // A slice keeps its place, whatever the time stamp of the first sample.
    let slice = map.apply(Sampled {
        first_index: 20,
        start_s: 1000.4,
        ..Sampled::from_start(&signal[20..], 0.02)
    });
    assert_eq!(slice, whole[20..]);
}
