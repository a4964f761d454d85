//! What members, clocks and missing dynamics do, each kind against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::{PI, TAU};

use crate::common::{effect, force, law, map, model, scale, through};
use simgap_effects::{Action, SiteKind, SiteScale, sites};
use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_model::{Location, Model};

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-13;
/// The trapezoidal rule over 40 000 points of a cycle with kinks leaves (2π/N)² of the amplitude.
const QUADRATURE: f64 = 1e-7;

fn assert_near(found: f64, needed: f64, absolute: f64) {
    assert!(
        (found - needed).abs() <= absolute,
        "{found} instead of {needed}"
    );
}

fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

/// Mean of `weight(φ) F(φ)` over a cycle d = A sin φ, v = A ω cos φ.
fn cycle_mean(law: &dyn ForceLaw, amplitude: f64, omega: f64, weight: fn(f64) -> f64) -> f64 {
    let samples = 40_000;
    let sum: f64 = (0..samples)
        .map(|i| (f64::from(i) + 0.5) * TAU / f64::from(samples))
        .map(|phase| {
            let (sin, cos) = phase.sin_cos();
            weight(phase) * force(law, amplitude * sin, amplitude * omega * cos)
        })
        .sum();
    sum / f64::from(samples)
}

/// Stiffness of the sine that a force of the displacement swings with at amplitude A.
fn equivalent_stiffness(law: &dyn ForceLaw, amplitude: f64) -> f64 {
    2.0 * cycle_mean(law, amplitude, 1.0, f64::sin) / amplitude
}

/// Share of its stiffness that a spring keeps with play δ on either side, at amplitude A.
fn share_beyond_play(play: f64, amplitude: f64) -> f64 {
    let x = play / amplitude;
    1.0 - 2.0 / PI * (x.asin() + x * (1.0 - x * x).sqrt())
}

#[test]
fn verify_asymmetric_damping() {
    let (forward, backward) = (30.0, -12.0);
    let law = law("asymmetric_damping", &[forward, backward]);
    assert_eq!(force(law.as_ref(), 0.3, 2.0), 60.0);
    assert_eq!(force(law.as_ref(), 0.3, -2.0), 24.0);
    assert_eq!(force(law.as_ref(), 0.3, 0.0), 0.0);
    // Over a cycle: work of the mean damping, ½ (c_f + c_b) π A² ω, and a mean force (c_f − c_b) A ω / π.
    let (amplitude, omega) = (0.02, 30.0);
    let power = cycle_mean(law.as_ref(), amplitude, omega, f64::cos) * amplitude * omega;
    let work = 0.5 * (forward + backward) * PI * amplitude.powi(2) * omega;
    assert_near(power * TAU / omega, work, QUADRATURE * work);
    let mean = cycle_mean(law.as_ref(), amplitude, omega, |_| 1.0);
    let needed = (forward - backward) * amplitude * omega / PI;
    assert_near(mean, needed, QUADRATURE * needed);
}

#[test]
fn verify_a_damper_that_gives_energy_is_rare_and_not_impossible() {
    let scale = SiteScale {
        damping_n_s_per_m: 10.0,
        has_damper: true,
        ..SiteScale::plain(1e-3, 0.1, 100.0)
    };
    let weight = |values: [f64; 2]| effect("asymmetric_damping").weight(&values, &scale);
    assert_eq!(weight([5.0, -9.0]), 1.0);
    assert_eq!(weight([5.0, -11.0]), 0.05);
    let is_met = |values: [f64; 2]| effect("asymmetric_damping").has_support(&values, &scale);
    assert!(is_met([5.0, -11.0]) && is_met([-19.0, 0.0]) && !is_met([-21.0, 0.0]));
}

/// With one damping for both directions it is a damper, or a factor on the damper of the model: c + c_f = f c.
#[test]
fn verify_asymmetric_damping_shrinks_to_a_damper() {
    let scale = SiteScale {
        damping_n_s_per_m: 50.0,
        ..SiteScale::plain(0.01, 0.2, 30.0)
    };
    let larger = effect("asymmetric_damping");
    let shrunk = |kind: &str, values: [f64; 2]| larger.shrunk_to(kind, &values, &scale);
    assert_eq!(shrunk("viscous_damping", [30.0, 30.0]), Some(vec![30.0]));
    assert_eq!(shrunk("damping_error", [30.0, 30.0]), Some(vec![1.6]));
    assert_eq!(shrunk("damping_error", [40.0, 20.0]), Some(vec![1.6]));
}

/// The law of a kind that looks at the members of a model.
fn member_law(kind: &str, values: &[f64], model: &Model, at: &Location) -> Box<dyn ForceLaw> {
    match effect(kind).action(values) {
        Action::Member(build) => build(model, at),
        _ => panic!("{kind} does not look at the members"),
    }
}

#[test]
fn verify_backlash_takes_the_play_off_the_springs_of_the_model() {
    let (gap, k) = (0.004, 9000.0);
    // The spring is listed as carriage-load: the order does not matter.
    let law = member_law("backlash", &[gap], &model(), &between("load", "carriage"));
    let carried = |d: f64| k * d + force(law.as_ref(), d, 5.0);
    for (d, needed) in [
        (0.0, 0.0),
        (0.0019, 0.0),
        (-0.0019, 0.0),
        (0.005, k * 0.003),
        (-0.005, -k * 0.003),
    ] {
        assert_near(carried(d), needed, ROUNDING * k);
    }
    for amplitude in [0.0021, 0.004, 0.1] {
        let needed = k * (share_beyond_play(0.5 * gap, amplitude) - 1.0);
        assert_near(
            equivalent_stiffness(law.as_ref(), amplitude),
            needed,
            QUADRATURE * k,
        );
    }
}

/// The limited force against its definition, and against the describing function of a saturation.
#[test]
fn verify_a_limited_force_is_that_of_spring_and_damper_up_to_its_limits() {
    let (k, c, upper, lower) = (9000.0, 20.0, 45.0, 18.0);
    let at = between("load", "carriage");
    let law = member_law("force_limit", &[upper, lower], &model(), &at);
    let carried = |d: f64, v: f64| k * d + c * v + force(law.as_ref(), d, v);
    for (d, v, needed) in [
        (0.0, 0.0, 0.0),
        (0.0049, 0.0, k * 0.0049),
        (0.0051, 0.0, upper),
        (-0.0019, 0.0, -k * 0.0019),
        (-0.5, 0.0, -lower),
        (0.0, 2.0, c * 2.0),
        (0.003, 2.0, upper),
        (0.006, -1.0, k * 0.006 - c),
    ] {
        assert_near(carried(d, v), needed, ROUNDING * k);
    }
    assert!(!law.remembers() && law.dry_level(0.0).is_none());
    let limit = 45.0;
    let mut undamped = model();
    undamped.dampers.clear();
    let law = member_law("force_limit", &[limit, limit], &undamped, &at);
    for amplitude in [0.0051, 0.01, 0.3] {
        // What a spring loses to play of L/k on either side is what it keeps under a limit L.
        let needed = -k * share_beyond_play(limit / k, amplitude);
        assert_near(
            equivalent_stiffness(law.as_ref(), amplitude),
            needed,
            QUADRATURE * k,
        );
    }
}

#[test]
fn verify_a_slack_spring_grows_into_a_limit() {
    let larger = effect("force_limit");
    let scale = SiteScale {
        stiffness_n_per_m: 9000.0,
        ..scale()
    };
    let grown =
        |change: f64| larger.grown_from("bilinear_stiffness", &[change, 0.005, 0.002], &scale);
    assert_eq!(grown(-8500.0), [vec![45.0, 18.0]]);
    assert!(grown(500.0).is_empty());
}

#[test]
fn verify_backlash_follows_the_recalibrated_model() {
    let mut model = model();
    let mut second = model.springs[1].clone();
    second.name = "second".into();
    second.between.reverse();
    model.springs[1].stiffness = 10_000.0;
    second.stiffness = 500.0;
    model.springs.push(second);
    let law = member_law("backlash", &[0.004], &model, &between("carriage", "load"));
    assert_near(force(law.as_ref(), 1.0, 0.0), -10_500.0 * 0.002, ROUNDING);
    assert_near(
        force(law.as_ref(), -0.001, 0.0),
        10_500.0 * 0.001,
        ROUNDING * 10.0,
    );
    assert!(!law.remembers() && law.dry_level(0.0).is_none());
}

#[test]
fn verify_bilinear_stiffness() {
    for change in [700.0, -700.0] {
        let law = law("bilinear_stiffness", &[change, 0.0, 1.0]);
        assert_eq!(force(law.as_ref(), 0.5, -3.0), 0.5 * change);
        assert_eq!(force(law.as_ref(), -0.5, 3.0), 0.0);
        // Half the change at the frequency of the motion, and a mean force Δk A / π.
        let amplitude = 0.01;
        let stiffness = equivalent_stiffness(law.as_ref(), amplitude);
        assert_near(stiffness, 0.5 * change, QUADRATURE * change.abs());
        let mean = cycle_mean(law.as_ref(), amplitude, 1.0, |_| 1.0);
        let needed = change * amplitude / PI;
        assert_near(mean, needed, QUADRATURE * needed.abs());
    }
}

#[test]
fn verify_bilinear_stiffness_changes_at_its_point() {
    for (upper, lower, sign) in [(0.02, 1.0, 1.0), (1.0, 0.02, -1.0)] {
        let law = law("bilinear_stiffness", &[-700.0, upper, lower]);
        for (d, needed) in [(0.02, 0.0), (0.05, -700.0 * 0.03), (-0.9, 0.0)] {
            let found = force(law.as_ref(), sign * d, 1.0);
            assert_near(found, sign * needed, ROUNDING * 21.0);
        }
    }
}

#[test]
fn verify_end_stop() {
    let k = 5e4;
    let stop = law("end_stop", &[0.004, 0.006, k, 0.0]);
    for (d, needed) in [
        (0.0, 0.0),
        (0.004, 0.0),
        (-0.006, 0.0),
        (0.005, k * 0.001),
        (-0.0075, -k * 0.0015),
    ] {
        assert_near(force(stop.as_ref(), d, 1.0), needed, ROUNDING * k);
    }
    // Stops at equal distances are a spring with play.
    let stop = law("end_stop", &[0.004, 0.004, k, 0.0]);
    for amplitude in [0.0041, 0.008, 0.05] {
        let needed = k * share_beyond_play(0.004, amplitude);
        assert_near(
            equivalent_stiffness(stop.as_ref(), amplitude),
            needed,
            QUADRATURE * k,
        );
    }
    // On one side only, with the other beyond reach; and not at all.
    let upper = law("end_stop", &[0.004, f64::INFINITY, k, 0.0]);
    assert_eq!(force(upper.as_ref(), -1e6, 0.0), 0.0);
    assert_near(force(upper.as_ref(), 0.005, 0.0), k * 0.001, ROUNDING * k);
    // A damped contact pushes more on the way in, less on the way out, and never pulls.
    let damped = law("end_stop", &[0.004, 0.004, k, 2e-3]);
    for (d, v, needed) in [
        (0.005, 0.3, k * 0.0016),
        (0.005, -0.3, k * 0.0004),
        (0.005, -0.8, 0.0),
        (0.0039, 5.0, 0.0),
        (-0.005, -0.3, -k * 0.0016),
        (-0.005, 0.8, 0.0),
    ] {
        assert_near(force(damped.as_ref(), d, v), needed, ROUNDING * k);
    }
}

/// Wherever the travel lies, some start stands within it on each side that it reaches.
#[test]
fn verify_end_stop_starts_stand_within_the_travel() {
    for [low, high] in [
        [-0.004, 0.004],
        [-0.001, 0.005],
        [0.0, 0.3],
        [0.25, 0.3],
        [-0.3, -0.25],
    ] {
        let scale = SiteScale {
            displacement_range_m: [low, high],
            ..scale()
        };
        let starts = effect("end_stop").starts(&scale);
        let within = |stop: f64| low < stop && stop < high;
        let far = |stop: f64| stop > 2.0 * high.abs().max(low.abs());
        let upper = starts.iter().any(|s| within(s[0]) && far(s[1]));
        let lower = starts.iter().any(|s| far(s[0]) && within(-s[1]));
        assert_eq!(upper, high > 0.0, "{low} to {high}: {starts:?}");
        assert_eq!(lower, low < 0.0, "{low} to {high}: {starts:?}");
        let both = starts.iter().any(|s| s[0] == s[1]);
        assert!(both, "{low} to {high}: {starts:?}");
    }
}

fn at_time(time_s: f64, displacement: f64) -> MemberMotion {
    MemberMotion {
        displacement,
        velocity: 0.7,
        time_s,
        step_s: 0.0,
    }
}

#[test]
fn verify_harmonic_force_pushes_the_mass_on_the_clock_of_the_record() {
    let (amplitude, freq_hz, phase) = (12.0, 7.0, 0.4);
    let law = law("harmonic_force", &[amplitude, freq_hz, phase]);
    for time_s in [0.0, 0.02, 3.456] {
        // As of a constant force, what acts on the mass is the negative of what the law carries.
        let needed = -amplitude * (TAU * freq_hz * time_s + phase).sin();
        assert_near(law.force(at_time(time_s, 0.3)), needed, ROUNDING * 1e2);
    }
    let clock = effect("harmonic_force").clock().unwrap();
    let parameters = effect("harmonic_force").parameters();
    assert_eq!(parameters[clock.amplitude].name, "amplitude_n");
    assert_eq!(parameters[clock.phase].name, "phase_rad");
    assert!(parameters[clock.phase].per_record && parameters[clock.phase].neutral.is_none());
}

#[test]
fn verify_time_varying_stiffness() {
    let (amplitude, freq_hz, phase) = (400.0, 3.0, -1.1);
    let law = law("time_varying_stiffness", &[amplitude, freq_hz, phase]);
    for (time_s, d) in [(0.0, 0.2), (0.4, -0.1), (11.3, 0.05)] {
        let needed = amplitude * (TAU * freq_hz * time_s + phase).sin() * d;
        assert_near(law.force(at_time(time_s, d)), needed, ROUNDING * 1e3);
    }
    let clock = effect("time_varying_stiffness").clock().unwrap();
    assert_eq!((clock.amplitude, clock.phase), (0, 2));
}

#[test]
fn verify_clocks_start_at_lines_and_only_there() {
    let freqs = |kind: &str, scale: &SiteScale| -> Vec<f64> {
        let starts = effect(kind).starts(scale);
        starts.iter().map(|start| start[1]).collect()
    };
    assert_eq!(freqs("harmonic_force", &scale()), [3.1, 12.7]);
    // A stiffness at f under a motion at 2.3 Hz leaves lines at f ± 2.3 Hz.
    let found = freqs("time_varying_stiffness", &scale());
    for (i, needed) in [3.1, 5.4, 0.8, 12.7, 15.0, 10.4].into_iter().enumerate() {
        assert_near(found[i], needed, ROUNDING * 10.0);
    }
    let silent = SiteScale {
        lines_hz: [0.0; 4],
        ..scale()
    };
    for kind in ["harmonic_force", "time_varying_stiffness"] {
        assert!(effect(kind).starts(&silent).is_empty(), "{kind}");
    }
}

#[test]
fn verify_position_periodic_force() {
    let (sine, cosine, period) = (3.0, -4.0, 0.02);
    let law = law("position_periodic_force", &[sine, cosine, period]);
    let at = |d: f64| force(law.as_ref(), d, 9.0);
    assert_near(at(0.0), cosine, ROUNDING);
    assert_near(at(0.25 * period), sine, ROUNDING);
    for d in [-0.031, 0.004, 0.5] {
        assert_near(at(d + period), at(d), 1e2 * ROUNDING);
        assert_near(at(d) + at(d + 0.5 * period), 0.0, 1e2 * ROUNDING);
        // a sin x + b cos x = √(a² + b²) sin(x + atan2(b, a)).
        let needed = 5.0 * (TAU * d / period + cosine.atan2(sine)).sin();
        assert_near(at(d), needed, 1e2 * ROUNDING);
    }
}

/// Two starts side by side differ by a sixth: no period is farther than half of that.
#[test]
fn verify_position_periodic_force_starts_near_every_period() {
    let travel = 0.009; // of the scale
    let starts = effect("position_periodic_force").starts(&scale());
    for periods in 1..=20 {
        let period = travel / f64::from(periods);
        let near = starts.iter().any(|s| (s[2] / period).ln().abs() < 0.08);
        assert!(near, "{periods} periods within the travel: {starts:?}");
    }
}

#[test]
fn verify_input_lag_is_the_lag_of_a_sensor_before_the_plant() {
    assert!(matches!(
        effect("input_lag").action(&[0.1]),
        Action::Input(_)
    ));
    // A ramp c t from rest: c (t − τ (1 − e^(−t/τ))).
    let (step_s, tau) = (0.01, 0.07);
    let ramp: Vec<f64> = (0..300).map(|i| 3.0 * step_s * f64::from(i)).collect();
    let found = through(map("input_lag", &[tau]).as_ref(), &ramp, step_s);
    for (i, u) in found.iter().enumerate() {
        let t = step_s * i as f64;
        assert_near(*u, 3.0 * (t + tau * (-t / tau).exp_m1()), 10.0 * ROUNDING);
    }
}

#[test]
fn verify_input_delay_of_a_sine() {
    assert!(matches!(
        effect("input_delay").action(&[0.1]),
        Action::Input(_)
    ));
    let (step_s, omega) = (0.005, 20.0);
    let sine: Vec<f64> = (0..400)
        .map(|i| (omega * step_s * f64::from(i)).sin())
        .collect();
    // Interpolation between six neighbours leaves (5/1024) (ω Δt)⁶.
    const INTERPOLATION: f64 = 5.0 / 1024.0 * 1e-6;
    for delay_s in [0.0004, 0.0025, 0.0871] {
        let found = through(map("input_delay", &[delay_s]).as_ref(), &sine, step_s);
        for (i, u) in found.iter().enumerate().take(390).skip(25) {
            let needed = (omega * (step_s * i as f64 - delay_s)).sin();
            assert_near(*u, needed, INTERPOLATION + ROUNDING);
        }
        // Before the record the first value is held.
        assert_eq!(found[0], sine[0]);
    }
}

#[test]
fn verify_flexible_support_is_offered_where_a_spring_stands_on_the_ground() {
    let found = sites(&model(), SiteKind::GroundSpring);
    assert_eq!(found, [between("carriage", "ground")]);
    assert_eq!(effect("flexible_support").site(), SiteKind::GroundSpring);
}
