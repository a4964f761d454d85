//! Each law against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::{E, PI};

use crate::common::{effect, force, law, map, model, through};
use simgap_effects::Action;
use simgap_integrate::exact::ForceLaw;
use simgap_model::{Location, Model};

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-14;
/// The trapezoidal rule over whole periods is exact for polynomials of sine and cosine; |v| v has
/// kinks in its second derivative and leaves (2π/N)⁴ with N = 4000.
const QUADRATURE: f64 = 1e-9;

/// Force, or motion, or both, along one cycle of d = A sin φ, v = A ω cos φ: the mean of
/// `weight(φ) F(φ)`.
fn cycle_mean(law: &dyn ForceLaw, amplitude: f64, omega: f64, weight: fn(f64) -> f64) -> f64 {
    let samples = 4000;
    let sum: f64 = (0..samples)
        .map(|i| 2.0 * PI * f64::from(i) / f64::from(samples))
        .map(|phase| {
            let (sin, cos) = phase.sin_cos();
            weight(phase) * force(law, amplitude * sin, amplitude * omega * cos)
        })
        .sum();
    sum / f64::from(samples)
}

fn assert_close(found: f64, needed: f64, relative: f64) {
    assert!(
        (found - needed).abs() <= relative * needed.abs(),
        "{found} instead of {needed}"
    );
}

#[test]
fn verify_quadratic_damping() {
    let q = 120.0;
    let law = law("quadratic_damping", &[q]);
    for v in [-3.0, -0.1, 0.0, 0.2, 4.0] {
        let needed = if v < 0.0 { -q * v * v } else { q * v * v };
        assert_eq!(force(law.as_ref(), 0.7, v), needed);
    }
    // Work over one cycle: ∮ q |v| v dx = (8/3) q A³ ω².
    let (amplitude, omega) = (0.02, 30.0);
    let mean_power = cycle_mean(law.as_ref(), amplitude, omega, f64::cos) * amplitude * omega;
    let work = mean_power * 2.0 * PI / omega;
    let needed = 8.0 / 3.0 * q * amplitude.powi(3) * omega.powi(2);
    assert_close(work, needed, QUADRATURE);
    assert_eq!(law.dry_level(0.1), None);
}

#[test]
fn verify_cubic_stiffness() {
    let k3 = 2.0e9;
    let law = law("cubic_stiffness", &[k3]);
    assert_close(force(law.as_ref(), 0.003, 9.0), k3 * 2.7e-8, ROUNDING);
    assert_eq!(
        force(law.as_ref(), -0.003, 9.0),
        -force(law.as_ref(), 0.003, 9.0)
    );
    // Harmonic balance: the equivalent stiffness is ¾ k3 A², and no work is done over a cycle.
    let amplitude = 0.004;
    let stiffness = 2.0 * cycle_mean(law.as_ref(), amplitude, 10.0, f64::sin) / amplitude;
    assert_close(stiffness, 0.75 * k3 * amplitude.powi(2), QUADRATURE);
    let power = cycle_mean(law.as_ref(), amplitude, 10.0, f64::cos);
    assert!(power.abs() < QUADRATURE * k3 * amplitude.powi(3));
}

#[test]
fn verify_quadratic_stiffness() {
    let k2 = 5.0e6;
    let law = law("quadratic_stiffness", &[k2]);
    for d in [-0.004, 0.004] {
        assert_close(force(law.as_ref(), d, -1.0), k2 * 1.6e-5, ROUNDING);
    }
    // The same way on both sides: a mean force of ½ k2 A², and nothing at the frequency itself.
    let amplitude = 0.004;
    let mean = cycle_mean(law.as_ref(), amplitude, 10.0, |_| 1.0);
    assert_close(mean, 0.5 * k2 * amplitude.powi(2), QUADRATURE);
    let at_frequency = cycle_mean(law.as_ref(), amplitude, 10.0, f64::sin);
    assert!(at_frequency.abs() < QUADRATURE * mean);
}

#[test]
fn verify_constant_force_pushes_the_mass_its_own_way() {
    // A law pushes node a with −F: so that +F0 acts on the mass, the law carries −F0.
    let law = law("constant_force", &[12.5]);
    assert_eq!(force(law.as_ref(), 0.3, -2.0), -12.5);
    assert_eq!(law.dry_level(0.0), None);
}

#[test]
fn verify_coulomb_friction_is_dry_and_level() {
    let law = law("coulomb_friction", &[2100.0]);
    for speed in [0.0, 1e-9, 0.1, 50.0] {
        assert_eq!(law.dry_level(speed), Some(2100.0));
        // No smooth part beside the dry one: it would be counted twice.
        assert_eq!(force(law.as_ref(), 0.1, speed), 0.0);
    }
}

#[test]
fn verify_stribeck_friction() {
    let (sliding, breakaway, velocity) = (100.0, 160.0, 0.02);
    let law = law("stribeck_friction", &[sliding, breakaway, velocity]);
    let level = |speed: f64| law.dry_level(speed).unwrap();
    assert_eq!(level(0.0), breakaway);
    assert_close(level(velocity), sliding + 60.0 / E, ROUNDING);
    assert_close(level(2.0 * velocity), sliding + 60.0 / E.powi(4), ROUNDING);
    assert_eq!(level(1.0), sliding);
    assert_eq!(force(law.as_ref(), 0.1, 0.01), 0.0);
}

#[test]
fn verify_stribeck_friction_without_a_rise_is_coulomb_friction() {
    let mut values = [100.0, 40.0, 0.02];
    effect("stribeck_friction").make_physical(&mut values);
    assert_eq!(values, [100.0, 100.0, 0.02], "at rest not below sliding");
    let (stribeck, coulomb) = (
        law("stribeck_friction", &values),
        law("coulomb_friction", &values[..1]),
    );
    for speed in [0.0, 0.01, 0.02, 1.0] {
        assert_eq!(stribeck.dry_level(speed), coulomb.dry_level(speed));
    }
}

/// The model after an effect at a place.
fn changed(kind: &str, values: &[f64], at: &Location) -> Model {
    let mut model = model();
    match effect(kind).action(values) {
        Action::Model(change) => change(&mut model, at),
        _ => panic!("{kind} does not change the model"),
    }
    model
}

/// The two nodes against the order of the file: a pair is a pair either way.
fn reversed() -> Location {
    Location::Between(["load".into(), "carriage".into()])
}

#[test]
fn verify_mass_error() {
    let at = Location::Mass("load".into());
    let found = changed("mass_error", &[1.25], &at);
    assert_eq!(found.masses[0].value, 3.0);
    assert_eq!(found.masses[1].value, 2.5);
    // No mass at all would make M singular: a millionth of it stays.
    assert_eq!(changed("mass_error", &[0.0], &at).masses[1].value, 2e-6);
}

#[test]
fn verify_stiffness_and_damping_error() {
    let found = changed("stiffness_error", &[0.5], &reversed());
    assert_eq!(found.springs[0].stiffness, 4000.0);
    assert_eq!(found.springs[1].stiffness, 4500.0);
    assert_eq!(found.dampers, model().dampers);
    let found = changed("damping_error", &[3.0], &reversed());
    assert_eq!(found.dampers[0].damping, 60.0);
    assert_eq!(found.dampers[1].damping, 7.0);
    assert_eq!(found.springs, model().springs);
}

#[test]
fn verify_pendulum_and_load_error() {
    let arm = Location::Mass("carriage".into());
    let found = changed("pendulum_error", &[0.8], &arm);
    assert_eq!(found.pendulums[0].value, 0.8 * 1.5);
    assert_eq!(found.loads, model().loads);
    let weight = Location::Mass("load".into());
    let found = changed("load_error", &[1.5], &weight);
    assert_eq!(found.load_vector(), [0.0, 1.5 * -19.6]);
    assert_eq!(found.pendulums, model().pendulums);
    // Only what is at the place.
    assert_eq!(changed("load_error", &[1.5], &arm), model());
    assert_eq!(changed("pendulum_error", &[0.8], &weight), model());
}

#[test]
fn verify_missing_members_are_added_between_their_nodes() {
    let at = Location::Between(["load".into(), "ground".into()]);
    let (plain, with) = (
        model().matrices().unwrap(),
        changed("linear_stiffness", &[500.0], &at)
            .matrices()
            .unwrap(),
    );
    let gained = |i, j| with.stiffness_matrix[(i, j)] - plain.stiffness_matrix[(i, j)];
    assert_eq!(
        [gained(0, 0), gained(0, 1), gained(1, 0), gained(1, 1)],
        [0.0, 0.0, 0.0, 500.0]
    );
    let with = changed("viscous_damping", &[11.0], &reversed())
        .matrices()
        .unwrap();
    let gained = |i, j| with.damping_matrix[(i, j)] - plain.damping_matrix[(i, j)];
    assert_eq!(
        [gained(0, 0), gained(0, 1), gained(1, 0), gained(1, 1)],
        [11.0, -11.0, -11.0, 11.0]
    );
}

#[test]
fn verify_gain_and_bias() {
    let signal = [0.5, -2.0, 0.0];
    let gained = through(map("input_gain", &[1.5]).as_ref(), &signal, 0.01);
    assert_eq!(gained, [0.75, -3.0, 0.0]);
    let biased = through(map("sensor_bias", &[0.25]).as_ref(), &signal, 0.01);
    assert_eq!(biased, [0.75, -1.75, 0.25]);
}

const SAMPLE_RATE_HZ: f64 = 100.0;
const SAMPLES: usize = 400;
/// 12 periods in the record.
const FREQ_HZ: f64 = 3.0;
const AMPLITUDE: f64 = 0.002;

fn sine(time_s: f64) -> f64 {
    AMPLITUDE * (2.0 * PI * FREQ_HZ * time_s).sin()
}

fn time_s(sample: usize) -> f64 {
    sample as f64 / SAMPLE_RATE_HZ
}

fn sampled_sine() -> Vec<f64> {
    (0..SAMPLES).map(|i| sine(time_s(i))).collect()
}

/// Largest error of interpolating the sine between its six neighbours, A (5/1024) (ω Δt)⁶.
fn interpolation_error() -> f64 {
    AMPLITUDE * 5.0 / 1024.0 * (2.0 * PI * FREQ_HZ / SAMPLE_RATE_HZ).powi(6)
}

/// Amplitude of a line with whole periods in the record.
fn line_amplitude(signal: &[f64], freq_hz: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (i, value) in signal.iter().enumerate() {
        let (sin, cos) = (2.0 * PI * freq_hz * time_s(i)).sin_cos();
        re += value * cos;
        im += value * sin;
    }
    2.0 * f64::hypot(re, im) / signal.len() as f64
}

#[test]
fn verify_delay_of_a_sine() {
    for delay_s in [0.0, 0.0004, 0.005, 0.0123] {
        let late = through(
            map("sensor_delay", &[delay_s]).as_ref(),
            &sampled_sine(),
            1.0 / SAMPLE_RATE_HZ,
        );
        // Near the ends there are no neighbours on one side, and nothing before the record.
        for i in 5..SAMPLES - 5 {
            let error = (late[i] - sine(time_s(i) - delay_s)).abs();
            assert!(
                error <= interpolation_error() + ROUNDING,
                "{delay_s} s: {error} at sample {i}"
            );
        }
        assert_eq!(
            late[0],
            sine(0.0),
            "before the record its first value holds"
        );
    }
}

#[test]
fn verify_alternating_timing_of_a_sine() {
    let timing_s = 0.0007;
    let found = through(
        map("alternating_timing", &[timing_s, 0.5]).as_ref(),
        &sampled_sine(),
        1.0 / SAMPLE_RATE_HZ,
    );
    for i in 5..SAMPLES - 5 {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let error = (found[i] - sine(time_s(i) + sign * timing_s)).abs();
        assert!(
            error <= interpolation_error() + ROUNDING,
            "{error} at sample {i}"
        );
    }
    // sin(ω(t ± τ)) = cos ωτ sin ωt ± sin ωτ cos ωt: a line at f_s/2 − f of amplitude A sin ωτ.
    let image = line_amplitude(&found, SAMPLE_RATE_HZ / 2.0 - FREQ_HZ);
    let needed = AMPLITUDE * (2.0 * PI * FREQ_HZ * timing_s).sin();
    assert!(
        (image - needed).abs() < 0.01 * needed,
        "{image} instead of {needed} (the first and last samples have one-sided neighbours)"
    );
}

#[test]
fn verify_alternating_gain_of_a_sine() {
    let gain = 0.03;
    let found = through(
        map("alternating_gain", &[gain, 0.5]).as_ref(),
        &sampled_sine(),
        1.0 / SAMPLE_RATE_HZ,
    );
    for (i, value) in found.iter().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        assert_eq!(*value, (1.0 + sign * gain) * sine(time_s(i)));
    }
    // Flat in f, unlike the timing error: a line at f_s/2 − f of amplitude g A.
    let image = line_amplitude(&found, SAMPLE_RATE_HZ / 2.0 - FREQ_HZ);
    assert_close(image, gain * AMPLITUDE, 1e-9);
}

#[test]
fn verify_one_half_of_an_alternation_may_be_right() {
    let (signal, step_s) = (sampled_sine(), 1.0 / SAMPLE_RATE_HZ);
    for (share, right) in [(0.0, 0), (1.0, 1)] {
        let gains = through(
            map("alternating_gain", &[0.03, share]).as_ref(),
            &signal,
            step_s,
        );
        let times = through(
            map("alternating_timing", &[7e-4, share]).as_ref(),
            &signal,
            step_s,
        );
        let sign = if right == 0 { -1.0 } else { 1.0 };
        for i in 5..SAMPLES - 5 {
            if i % 2 == right {
                assert_eq!((gains[i], times[i]), (signal[i], signal[i]));
            } else {
                assert_close(gains[i], (1.0 + 2.0 * sign * 0.03) * signal[i], 1e-12);
                let moved = sine(time_s(i) + 2.0 * sign * 7e-4);
                let error = (times[i] - moved).abs();
                assert!(error <= interpolation_error() + ROUNDING, "{error} at {i}");
            }
        }
    }
}

#[test]
fn verify_maps_keep_the_length_of_short_signals() {
    for kind in [
        "sensor_delay",
        "alternating_timing",
        "alternating_gain",
        "sensor_bias",
        "input_gain",
    ] {
        for len in 0..8 {
            let signal = vec![1.0; len];
            let found = through(map(kind, &[0.0, 0.5]).as_ref(), &signal, 0.01);
            assert_eq!(found.len(), len, "{kind}");
        }
    }
}
