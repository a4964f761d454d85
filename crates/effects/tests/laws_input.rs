//! What happens to an input on its way to the plant, and carriers in step with the motion, each kind
//! against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::{PI, TAU};

use crate::common::{effect, law, map, scale, through};
use simgap_effects::{Sampled, SiteScale};
use simgap_integrate::exact::MemberMotion;

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-13;

const STEP_S: f64 = 0.01;

fn assert_near(found: f64, needed: f64, absolute: f64) {
    assert!(
        (found - needed).abs() <= absolute,
        "{found} instead of {needed}"
    );
}

fn sine(count: usize, amplitude: f64, freq_hz: f64) -> Vec<f64> {
    let at = |n: usize| amplitude * (TAU * freq_hz * STEP_S * n as f64).sin();
    (0..count).map(at).collect()
}

/// The fundamental of a signal at a frequency of which it holds whole periods.
fn fundamental(signal: &[f64], freq_hz: f64) -> f64 {
    let turns = |n: usize| TAU * freq_hz * STEP_S * n as f64;
    let along = signal.iter().enumerate().map(|(n, y)| y * turns(n).sin());
    2.0 * along.sum::<f64>() / signal.len() as f64
}

#[test]
fn verify_dead_zone() {
    let signal = [-3.0, -0.5, -0.25, 0.0, 0.5, 0.75, 2.0];
    let found = through(map("input_dead_zone", &[0.5]).as_ref(), &signal, STEP_S);
    assert_eq!(found, [-2.5, 0.0, 0.0, 0.0, 0.0, 0.25, 1.5]);
}

/// The describing functions of a dead zone and of a saturation: of a sine of amplitude A through limits
/// ±δ the fundamental is A (2/π) (asin x + x √(1 − x²)), x = δ/A, and the dead zone has the rest.
#[test]
fn verify_describing_functions_of_dead_zone_and_saturation() {
    let (amplitude, freq_hz, limit) = (2.0, 0.05, 0.7);
    let signal = sine(20_000, amplitude, freq_hz);
    let x: f64 = limit / amplitude;
    let limited = 2.0 / PI * (x.asin() + x * (1.0 - x * x).sqrt());
    let of = |kind: &str, values: &[f64]| {
        let through = through(map(kind, values).as_ref(), &signal, STEP_S);
        fundamental(&through, freq_hz) / amplitude
    };
    // A kink within a sample: of the order of the square of its angle.
    const KINKS: f64 = 1e-5;
    assert_near(of("input_saturation", &[limit, -limit]), limited, KINKS);
    assert_near(of("input_dead_zone", &[limit]), 1.0 - limited, KINKS);
}

#[test]
fn verify_saturation_of_either_side() {
    let signal = [-3.0, -0.5, 0.25, 2.0];
    let of = |high: f64, low: f64| {
        let map = map("input_saturation", &[high, low]);
        through(map.as_ref(), &signal, STEP_S)
    };
    assert_eq!(of(1.0, -2.0), [-2.0, -0.5, 0.25, 1.0]);
    assert_eq!(of(f64::INFINITY, -2.0), [-2.0, -0.5, 0.25, 2.0]);
    assert_eq!(of(1.0, f64::NEG_INFINITY), [-3.0, -0.5, 0.25, 1.0]);
    let mut values = [0.2, 0.5];
    effect("input_saturation").make_physical(&mut values);
    assert_eq!(values, [0.2, 0.2]);
}

/// A step becomes a ramp of the limited rate; what is slower passes untouched.
#[test]
fn verify_rate_limit_of_a_step_and_of_a_ramp() {
    let rate = 4.0;
    let mut step = vec![0.0; 5];
    step.extend([1.0; 60]);
    let found = through(map("input_rate_limit", &[rate]).as_ref(), &step, STEP_S);
    for (n, value) in found.iter().enumerate() {
        let since = (n as f64 - 4.0).max(0.0) * STEP_S;
        assert_near(*value, (rate * since).min(1.0), ROUNDING);
    }
    let down: Vec<f64> = step.iter().map(|u| 3.0 - u).collect();
    let found_down = through(map("input_rate_limit", &[rate]).as_ref(), &down, STEP_S);
    for (up, down) in found.iter().zip(found_down) {
        assert_near(down, 3.0 - up, ROUNDING);
    }
    let ramp: Vec<f64> = (0..50).map(|n| 3.9 * STEP_S * f64::from(n)).collect();
    let passed = through(map("input_rate_limit", &[rate]).as_ref(), &ramp, STEP_S);
    assert_eq!(passed, ramp);
    // A limit of zero holds the first value.
    let held = through(map("input_rate_limit", &[0.0]).as_ref(), &down, STEP_S);
    assert_eq!(held, vec![3.0; down.len()]);
}

#[test]
fn verify_held_input_repeats_samples() {
    let signal: Vec<f64> = (0..10).map(f64::from).collect();
    let of = |samples: f64, first: f64| {
        let map = map("held_input", &[samples * STEP_S, first * STEP_S]);
        through(map.as_ref(), &signal, STEP_S)
    };
    let assert_held = |found: &[f64], needed: &[f64]| {
        assert_eq!(found.len(), needed.len());
        for (found, needed) in found.iter().zip(needed) {
            assert_near(*found, *needed, ROUNDING);
        }
    };
    // A renewal at a sample is in the middle of its interval.
    let from_start = [0.0, 0.0, 0.0, 0.0, 2.0, 4.0, 4.0, 4.0, 6.0, 8.0];
    assert_held(&of(4.0, 0.0), &from_start);
    // Before the first renewal the record holds nothing older than its first value.
    let later = [0.0, 0.0, 0.0, 1.5, 3.0, 3.0, 3.0, 5.0, 7.0, 7.0];
    assert_held(&of(4.0, 3.0), &later);
    assert_eq!(of(0.0, 0.0), signal);
    // Between samples: the value at 2.5 samples is held from the end of the interval about sample 2 to the middle of that about 5.
    let between = [0.0, 0.0, 0.0, 2.5, 2.5, 3.75, 5.0, 5.0, 7.5, 7.5];
    assert_held(&of(2.5, 0.0), &between);
    // A fifth of the interval about sample 1 is old.
    let fifth = [0.0, 0.8 * 0.7, 0.7, 0.7];
    assert_held(&of(20.0, 0.7)[..4], &fifth);
    // A stretch keeps the clock of the record.
    let whole = of(3.0, 1.0);
    let stretch = map("held_input", &[3.0 * STEP_S, STEP_S]).apply(Sampled {
        first_index: 4,
        ..Sampled::from_start(&signal[4..], STEP_S)
    });
    // But for what was held before it.
    assert_held(&stretch[1..], &whole[5..]);
}

/// A slow sine held every T is late by T/2, whatever the rate of its samples.
#[test]
fn verify_held_input_is_a_delay_for_slow_inputs() {
    let freq_hz = 0.05;
    let signal = sine(20_000, 1.0, freq_hz);
    for samples in [0.4, 1.0, 8.0, 8.3] {
        let map = map("held_input", &[samples * STEP_S, 0.0]);
        let held = through(map.as_ref(), &signal, STEP_S);
        let expected = (TAU * freq_hz * 0.5 * samples * STEP_S).cos();
        // The amplitude falls by the sinc of a hold, here by 3e-5.
        assert_near(fundamental(&held, freq_hz), expected, 1e-4);
    }
}

/// Of the holds that a delay may stand for, one is within a quarter of a hold of the truth all along a record, in time and in place.
#[test]
fn verify_a_hold_grows_from_the_delay_that_it_is_seen_as() {
    let held = simgap_effects::find("held_input").unwrap();
    let sizes = SiteScale {
        duration_s: 9.0,
        ..scale()
    };
    let (delay_s, hold_s, start_s) = (0.0301, 0.0597, 0.0123);
    let grown = held.grown_from("input_delay", &[delay_s], &sizes);
    let apart = |values: &[f64], t_s: f64| {
        let renewals = (t_s - values[1]) / values[0] - (t_s - start_s) / hold_s;
        (renewals - renewals.round()).abs()
    };
    let is_near = |values: &Vec<f64>| [0.0, 9.0].iter().all(|t_s| apart(values, *t_s) <= 0.25);
    let mut begun = grown.iter().flat_map(|values| held.own_starts(values));
    assert!(begun.any(|values| is_near(&values)));
    let short_s = 0.4 * sizes.time_step_s;
    assert!(
        held.grown_from("input_delay", &[short_s], &sizes)
            .is_empty()
    );
    assert!(
        held.grown_from("sensor_delay", &[delay_s], &sizes)
            .is_empty()
    );
}

/// A fit follows the begin and the length of holds: what they do is continuous in both.
#[test]
fn prop_held_input_moves_with_its_times() {
    let signal = sine(400, 1.0, 1.3);
    let held = |hold: f64, start: f64| {
        let map = map("held_input", &[hold * STEP_S, start * STEP_S]);
        through(map.as_ref(), &signal, STEP_S)
    };
    let apart = |a: &[f64], b: &[f64]| {
        let each = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        each.fold(0.0, f64::max)
    };
    for hold in [2.0, 7.0, 13.27] {
        for start in [-1.0, 0.0, 0.5, 3.1] {
            let here = held(hold, start);
            assert!(
                apart(&here, &held(hold, start + 1e-7)) < 1e-6,
                "{hold}, {start}"
            );
            assert!(
                apart(&here, &held(hold + 1e-9, start)) < 1e-6,
                "{hold}, {start}"
            );
        }
    }
}

/// In every record the first of the holds begins anywhere within one.
#[test]
fn verify_holds_begin_anywhere_within_one() {
    let held = effect("held_input");
    assert_eq!(held.parameters().iter().filter(|p| p.per_record).count(), 1);
    for start in held.starts(&scale()) {
        let begun = held.own_starts(&start);
        assert!(begun.iter().all(|values| values[0] == start[0]));
        for share in [0.0, 0.3, 0.99] {
            let apart = |values: &Vec<f64>| {
                let holds = values[1] / values[0] - share;
                (holds - holds.round()).abs()
            };
            assert!(begun.iter().any(|values| apart(values) < 0.07), "{share}");
        }
    }
}

/// What is left times the rate of the input has a line at one over the time of a hold.
#[test]
fn verify_held_input_starts_from_carriers() {
    let sizes = SiteScale {
        carriers_hz: [8.0, 0.0, 0.0, 0.0],
        ..scale()
    };
    let starts = effect("held_input").starts(&sizes);
    assert!(starts.iter().any(|start| start[0] == 0.125));
}

#[test]
fn verify_synchronous_force() {
    let (amplitude, freq_hz, phase) = (30.0, 7.0, 0.4);
    let law = law("synchronous_force", &[amplitude, freq_hz, phase]);
    for n in 0..50 {
        let time_s = 0.013 * f64::from(n);
        let velocity = (1.7 * f64::from(n)).cos();
        let found = law.force(MemberMotion {
            displacement: 0.3,
            velocity,
            time_s,
            step_s: 1e-3,
        });
        let carrier = (TAU * freq_hz * time_s + phase).sin();
        assert_near(found, amplitude * carrier * velocity, 30.0 * ROUNDING);
    }
}

/// Differences are exact for a polynomial of degree four.
#[test]
fn verify_synchronous_tone_grows_with_the_velocity() {
    let (amplitude_s, freq_hz, phase, start_s) = (0.02, 3.3, 0.9, 7.0);
    let values: Vec<f64> = (0..40)
        .map(|n| (STEP_S * f64::from(n)).powi(4) - 2.0 * STEP_S * f64::from(n))
        .collect();
    let map = map("synchronous_tone", &[amplitude_s, freq_hz, phase]);
    let found = map.apply(Sampled {
        start_s,
        ..Sampled::from_start(&values, STEP_S)
    });
    for n in 2..38 {
        let t = STEP_S * n as f64;
        let slope = 4.0 * t.powi(3) - 2.0;
        let carrier = (TAU * freq_hz * (start_s + t) + phase).sin();
        assert_near(
            found[n],
            values[n] + amplitude_s * carrier * slope,
            ROUNDING,
        );
    }
    for count in 0..6 {
        let found = through(map.as_ref(), &values[..count], STEP_S);
        assert_eq!(found.len(), count);
    }
}

/// Samples taken early and late in turn: at half the sample rate a carrier does what the alternation does,
/// up to the curvature within the shift.
#[test]
fn verify_carriers_at_half_the_sample_rate_alternate() {
    let (freq_hz, small_s, small) = (1.0, 1e-5, 1e-3);
    let signal = sine(400, 1.0, freq_hz);
    let nyquist = 0.5 / STEP_S;
    let of = |kind: &str, values: &[f64]| through(map(kind, values).as_ref(), &signal, STEP_S);
    let tone = of("synchronous_tone", &[small_s, nyquist, 0.5 * PI]);
    let timing = of("alternating_timing", &[small_s, 0.5]);
    let (w, h) = (TAU * freq_hz, STEP_S);
    // ½ (ω τ)² of the expansion, (ω h)⁴ ω τ / 30 of the differences.
    let off = 0.5 * (w * small_s).powi(2) + (w * h).powi(4) * w * small_s / 30.0;
    for n in 4..396 {
        assert_near(tone[n], timing[n], 1.2 * off + ROUNDING);
    }
    let ripple = of("gain_ripple", &[small, nyquist, 0.5 * PI]);
    let gain = of("alternating_gain", &[small, 0.5]);
    for (ripple, gain) in ripple.iter().zip(gain) {
        assert_near(*ripple, gain, 100.0 * ROUNDING);
    }
}

#[test]
fn verify_gain_ripple_grows_with_the_value() {
    let found = map("gain_ripple", &[0.25, 2.0, 0.5]).apply(Sampled {
        start_s: 3.0,
        ..Sampled::from_start(&[2.0, -4.0, 0.0], STEP_S)
    });
    for (n, (found, value)) in found.iter().zip([2.0, -4.0, 0.0]).enumerate() {
        let carrier = (TAU * 2.0 * (3.0 + STEP_S * n as f64) + 0.5).sin();
        assert_near(*found, value * (1.0 + 0.25 * carrier), ROUNDING);
    }
}

/// A motion at 2 Hz times a carrier at 9 Hz leaves lines at 7 and 11 Hz: the carrier is among the starts.
#[test]
fn verify_carriers_start_from_sums_and_differences() {
    let sizes = SiteScale {
        lines_hz: [7.0, 11.0, 0.0, 0.0],
        motion_hz: [2.0, 0.0, 0.0, 0.0],
        ..scale()
    };
    for kind in ["synchronous_force", "synchronous_tone", "gain_ripple"] {
        let starts = effect(kind).starts(&sizes);
        let found = starts.iter().filter(|start| (start[1] - 9.0).abs() < 1e-12);
        assert_eq!(found.count(), 1, "{kind}");
    }
    // Of a motion of many frequencies, the line of what is left times the motion.
    let sizes = SiteScale {
        lines_hz: [0.0; 4],
        carriers_hz: [9.0, 0.0, 0.0, 0.0],
        ..scale()
    };
    assert_eq!(effect("gain_ripple").starts(&sizes)[0][1], 9.0);
}
