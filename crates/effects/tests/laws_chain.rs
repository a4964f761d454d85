//! What the measurement chain does to a channel, each kind against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::PI;

use crate::common::{self, effect, map, through};
use simgap_effects::{Sampled, SiteScale};

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-14;

fn assert_near(found: f64, needed: f64, absolute: f64) {
    assert!(
        (found - needed).abs() <= absolute,
        "{found} instead of {needed}"
    );
}

fn from_samples(count: usize, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..count).map(|i| value(i as f64)).collect()
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

/// The lag after a ramp y = c t from rest: z = c (t − τ (1 − e^(−t/τ))), with no error from
/// sampling as a ramp is linear between samples.
#[test]
fn verify_sensor_lag_of_a_ramp() {
    let (step_s, slope) = (0.01, 3.0);
    let ramp: Vec<f64> = (0..400).map(|i| slope * step_s * f64::from(i)).collect();
    // Rounding of 400 steps, on values up to 12.
    const SUMMED: f64 = 1e-12;
    for time_constant_s in [1e-9, 0.002, 0.01, 0.3, 0.99, 1.01, 40.0, 1e6] {
        let found = through(
            map("sensor_lag", &[time_constant_s]).as_ref(),
            &ramp,
            step_s,
        );
        for (i, z) in found.iter().enumerate() {
            let t = step_s * i as f64;
            // −expm1 keeps the digits of 1 − e^(−t/τ); for t ≪ τ the difference loses them.
            let x = t / time_constant_s;
            let needed = if x < 1e-3 {
                slope * time_constant_s * x * x * (0.5 - x * (1.0 / 6.0 - x / 24.0))
            } else {
                slope * (t + time_constant_s * (-x).exp_m1())
            };
            assert_near(*z, needed, SUMMED);
        }
    }
}

#[test]
fn verify_sensor_lag_starts_in_the_steady_state() {
    let level = [4.2; 30];
    let found = through(map("sensor_lag", &[0.5]).as_ref(), &level, 0.01);
    assert_eq!(found, level);
    // A jump is no polynomial: it shows two samples early, and has settled long after.
    let mut step = [0.0; 4000];
    step[10..].fill(1.0);
    let tau = 0.5_f64;
    let found = through(map("sensor_lag", &[tau]).as_ref(), &step, 0.01);
    assert_eq!(found[..8], [0.0; 8]);
    assert!(found[8..10].iter().all(|z| z.abs() < 0.1 * 0.01 / tau));
    for pair in found[13..].windows(2) {
        assert_near(
            1.0 - pair[1],
            (1.0 - pair[0]) * (-0.01 / tau).exp(),
            1e3 * ROUNDING,
        );
    }
    assert_near(found[3999], 1.0, 1e3 * ROUNDING);
}

/// sin ωt after the transient: gain 1/√(1 + (ωτ)²), phase −atan ωτ, off by no more than the polynomials are.
#[test]
fn verify_sensor_lag_of_a_sine() {
    let (step_s, freq_hz, tau) = (0.01_f64, 5.0, 0.02);
    let omega = 2.0 * PI * freq_hz;
    let sine: Vec<f64> = (0..2000)
        .map(|i| (omega * step_s * f64::from(i)).sin())
        .collect();
    let delivered = |i: usize| {
        let phase = -(omega * tau).atan();
        (omega * step_s * i as f64 + phase).sin() / (omega * tau).hypot(1.0)
    };
    let bound = 5.0 / 1024.0 * (omega * step_s).powi(6);
    let lag = map("sensor_lag", &[tau]);
    let found = through(lag.as_ref(), &sine, step_s);
    for (i, z) in found.iter().enumerate().take(1990).skip(200) {
        assert_near(*z, delivered(i), bound);
    }
    // A record that begins mid-motion: what the filter held before is taken from it.
    assert!((found[1] - delivered(1)).abs() > 0.1);
    let measured: Vec<f64> = (0..2000).map(delivered).collect();
    let found = lag.apply(Sampled {
        measured: Some(&measured),
        ..Sampled::from_start(&sine, step_s)
    });
    // The first two intervals are taken as linear.
    let linear = (omega * step_s).powi(2) / 8.0;
    for (i, z) in found.iter().enumerate() {
        assert_near(*z, measured[i], linear);
    }
}

/// Where there is nothing to tell a transient from, none is made, and no length is too short.
#[test]
fn verify_sensor_lag_of_short_signals_and_of_extreme_lags() {
    for len in 0..8 {
        let values = vec![1.5; len];
        let measured = vec![2.0; len];
        for (tau, is_extreme) in [(1e-12, true), (1e-3, true), (1.0, false), (1e9, true)] {
            let found = map("sensor_lag", &[tau]).apply(Sampled {
                measured: Some(&measured),
                ..Sampled::from_start(&values, 0.01)
            });
            assert_eq!(found.len(), len);
            assert!(
                found.iter().all(|z| (1.5..=2.0).contains(z)),
                "{len} {tau}: {found:?}"
            );
            if is_extreme {
                assert!(
                    found.iter().all(|z| (z - 1.5).abs() < 1e-5),
                    "{len} {tau}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn verify_clipping_of_a_sine() {
    let sine: Vec<f64> = (0..1000)
        .map(|i| (2.0 * PI * f64::from(i) / 1000.0).sin())
        .collect();
    let found = through(map("clipping", &[0.5, -0.8]).as_ref(), &sine, 0.01);
    for (z, y) in found.iter().zip(&sine) {
        let level = if *y > 0.0 { 0.5 } else { -0.8 };
        let inside = (-0.8..=0.5).contains(y);
        assert_eq!(*z, if inside { *y } else { level });
    }
    // sin φ > ½ for a third of the period.
    assert_eq!(found.iter().filter(|z| **z == 0.5).count(), 333);
}

#[test]
fn verify_clipping_on_one_side_and_away_from_zero() {
    let signal = [5.0, 6.0, 7.0, 8.0];
    let above = through(map("clipping", &[6.5, -1e9]).as_ref(), &signal, 0.01);
    assert_eq!(above, [5.0, 6.0, 6.5, 6.5]);
    let below = through(
        map("clipping", &[-5.0, -6.0]).as_ref(),
        &[-7.0, -5.5, -4.0],
        0.01,
    );
    assert_eq!(below, [-6.0, -5.5, -5.0]);
    let mut crossed = [1.0, 2.0];
    effect("clipping").make_physical(&mut crossed);
    assert_eq!(crossed, [1.0, 1.0]);
}

/// A record clipped at both ends shows the levels at the ends of its range: a start is beside them.
#[test]
fn verify_clipping_starts_beside_the_edges_of_the_record() {
    let scale = SiteScale {
        signal_range: [-0.8, 0.5],
        ..common::scale()
    };
    let starts = effect("clipping").starts(&scale);
    let near = |start: &Vec<f64>| (start[0] - 0.5).abs() < 0.02 && (start[1] + 0.8).abs() < 0.02;
    assert!(starts.iter().any(near), "{starts:?}");
}

#[test]
fn verify_quantisation_rounds_to_the_nearest_level() {
    let rounded = map("quantisation", &[0.25, 0.0]);
    let signal = [0.0, 0.124, 0.126, -0.126, 0.375, -0.375, 7.9];
    let needed = [0.0, 0.0, 0.25, -0.25, 0.5, -0.5, 8.0];
    assert_eq!(through(rounded.as_ref(), &signal, 0.01), needed);
    // Twice is once.
    assert_eq!(through(rounded.as_ref(), &needed, 0.01), needed);
    assert!(rounded.is_stepped());
    // Steps beyond the digits of a number change nothing, and never overflow.
    let fine = through(
        map("quantisation", &[1e-300, 0.0]).as_ref(),
        &[1e10, -0.3],
        0.01,
    );
    assert_eq!(fine, [1e10, -0.3]);
}

/// The error of rounding a signal that crosses many levels is even over ±q/2: rms q/√12.
#[test]
fn verify_quantisation_error_is_the_step_over_root_twelve() {
    let step = 0.003;
    let sine: Vec<f64> = (0..20_000).map(|i| (0.7 * f64::from(i)).sin()).collect();
    let found = through(map("quantisation", &[step, 0.0]).as_ref(), &sine, 0.01);
    let square: f64 = found.iter().zip(&sine).map(|(z, y)| (z - y).powi(2)).sum();
    let rms = (square / sine.len() as f64).sqrt();
    // 20 000 errors: the rms of even ones is known to 0.3 %.
    assert_near(rms, step / 12.0_f64.sqrt(), 0.01 * rms);
}

#[test]
fn verify_quantisation_starts_only_where_a_lattice_is_seen() {
    let without = SiteScale {
        signal_step: 0.0,
        ..common::scale()
    };
    assert!(effect("quantisation").starts(&without).is_empty());
    assert_eq!(
        effect("quantisation").starts(&common::scale()),
        [[0.01, 0.0]]
    );
}

#[test]
fn verify_tone_pickup_is_a_sine_on_the_clock_of_the_record() {
    let (amplitude, freq_hz, phase, step_s) = (0.3, 50.0, 1.1, 0.00137);
    let map = map("tone_pickup", &[amplitude, freq_hz, phase]);
    let signal: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
    // Rounding of angles up to 2π f t = 1200.
    const ANGLE: f64 = 1e-12;
    for (first_index, start_s) in [(0, 0.0), (300, 2.503)] {
        let found = map.apply(Sampled {
            first_index,
            start_s,
            ..Sampled::from_start(&signal, step_s)
        });
        for (i, (z, y)) in found.iter().zip(&signal).enumerate() {
            let t = start_s + step_s * i as f64;
            let needed = y + amplitude * (2.0 * PI * freq_hz * t + phase).sin();
            assert_near(*z, needed, ANGLE);
        }
    }
}

#[test]
fn verify_tone_pickup_starts_at_the_lines_and_at_the_mains_as_sampled() {
    let frequencies = |step_s: f64, lines: [f64; 2]| -> Vec<f64> {
        let scale = SiteScale {
            time_step_s: step_s,
            lines_hz: [lines[0], lines[1], 0.0, 0.0],
            ..common::scale()
        };
        let starts = effect("tone_pickup").starts(&scale);
        starts.iter().map(|start| start[1]).collect()
    };
    assert_eq!(frequencies(0.001, [3.1, 12.7]), [3.1, 12.7, 50.0]);
    // Seen already, a little off: within 1/20 s.
    assert_eq!(frequencies(0.001, [50.02, 0.0]), [50.02]);
    // At 80 Hz, 50 Hz is stored as 30 Hz; at 50 Hz, as a constant.
    let stored = frequencies(1.0 / 80.0, [0.0; 2]);
    assert!(
        stored.len() == 1 && (stored[0] - 30.0).abs() < 1e-9,
        "{stored:?}"
    );
    assert!(frequencies(0.02, [0.0; 2]).is_empty());
}

#[test]
fn verify_clock_skew_stretches_a_sine() {
    let (omega, step_s) = (20.0, 0.005);
    // Interpolation between six neighbours leaves (5/1024) (ω Δt)⁶.
    const INTERPOLATION: f64 = 5.0 / 1024.0 * 1e-6;
    let sine = from_samples(2000, |i| (omega * step_s * i).sin());
    for skew in [0.002, -0.002, 1e-5] {
        let map = map("clock_skew", &[skew]);
        let whole = through(map.as_ref(), &sine, step_s);
        // Positive skew looks beyond the end by four samples at most.
        for (i, z) in whole.iter().enumerate().take(1990).skip(5) {
            let needed = (omega * step_s * (1.0 + skew) * i as f64).sin();
            assert_near(*z, needed, INTERPOLATION + 1e3 * ROUNDING);
        }
        // A slice keeps the shift that has come together before it.
        let slice = map.apply(Sampled {
            first_index: 1000,
            ..Sampled::from_start(&sine[1000..], step_s)
        });
        for (z, y) in slice[5..990].iter().zip(&whole[1005..1990]) {
            assert_near(*z, *y, 1e3 * ROUNDING);
        }
    }
    // Beyond the end the last value holds.
    let fast = through(map("clock_skew", &[0.05]).as_ref(), &sine, step_s);
    assert_eq!(fast[1950..], vec![sine[1999]; 50]);
}

#[test]
fn verify_linear_maps_are_linear_and_keep_the_length() {
    let a = from_samples(300, |i| (0.37 * i * i).sin());
    let b = from_samples(300, |i| (0.9 * i).cos() + 0.01 * i);
    let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - 0.5 * b).collect();
    for (kind, value) in [
        ("sensor_gain", 1.3),
        ("sensor_lag", 0.03),
        ("clock_skew", 0.01),
    ] {
        let map = map(kind, &[value]);
        let [of_a, of_b, of_sum] = [&a, &b, &sum].map(|y| through(map.as_ref(), y, 0.01));
        for ((a, b), sum) in of_a.iter().zip(&of_b).zip(&of_sum) {
            assert_near(*sum, 2.0 * a - 0.5 * b, 1e2 * ROUNDING);
        }
        for len in 0..8 {
            assert_eq!(through(map.as_ref(), &a[..len], 0.01).len(), len, "{kind}");
        }
    }
}
