//! Two traces without a model: known faults of the chain are named with their values, what is none
//! of them is left to the model, and what the discrepancy looks like is told.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use simgap_diagnose::Status;
use simgap_diagnose::compare::{CompareError, CompareRequest, Compared, compare};
use simgap_record::{Channel, Record};

const STEP_S: f64 = 5e-3;
const ROWS: usize = 4000;
const NOISE: f64 = 3e-3;

/// Noise that is the same every time: a linear congruential generator, twelve draws a number.
fn noise(count: usize) -> Vec<f64> {
    let mut state = 12345_u64;
    let mut draw = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let gauss = |_| (0..12).map(|_| draw()).sum::<f64>() - 6.0;
    (0..count).map(gauss).collect()
}

/// Three lines that are no multiples of each other.
fn motion(t: f64) -> f64 {
    let line = |a: f64, f: f64, p: f64| a * (TAU * f * t + p).sin();
    line(1.0, 1.1, 0.0) + line(0.4, 2.73, 1.0) + line(0.2, 7.31, 0.3)
}

/// One line that dies out.
fn decay(t: f64) -> f64 {
    (1.0 - 0.04 * t) * (TAU * 1.1 * t).sin()
}

fn sampled(f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..ROWS).map(|k| f(STEP_S * k as f64)).collect()
}

fn noisy(f: impl Fn(f64) -> f64) -> Vec<f64> {
    let clean = sampled(f).into_iter().zip(noise(ROWS));
    clean.map(|(y, e)| y + NOISE * e).collect()
}

fn record(name: &str, values: Vec<f64>) -> Record {
    Record::from_uniform(name, 0.0, STEP_S, vec![Channel::new("y", "m", values)]).unwrap()
}

fn compared(measured: &Record, simulated: &Record) -> Compared {
    let request = CompareRequest {
        measured,
        simulated,
        pairs: &[],
        inputs: &[],
        align_start: false,
    };
    compare(&request, &|_| {}).unwrap()
}

fn of(measured: Vec<f64>, simulated: Vec<f64>) -> Compared {
    compared(&record("m.csv", measured), &record("s.csv", simulated))
}

/// The one fault named, with the value of its first parameter.
fn named(compared: &Compared) -> (String, f64) {
    let chain = &compared.comparison.chain;
    let kinds: Vec<&str> = chain.effects.iter().map(|e| e.kind.as_str()).collect();
    assert_eq!(chain.status, Status::Effect, "{:?}", compared.comparison);
    assert_eq!(kinds.len(), 1, "{kinds:?}");
    let effect = &chain.effects[0];
    (effect.kind.clone(), effect.parameters[0].value)
}

#[test]
fn verify_faults_of_the_chain_are_named_with_their_values() {
    let even = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut spiked = noisy(motion);
    (100..ROWS).step_by(397).for_each(|k| spiked[k] += 2.0);
    let alternating: Vec<f64> = noisy(motion)
        .into_iter()
        .enumerate()
        .map(|(k, y)| y * (1.0 + 0.03 * even(k)))
        .collect();
    // Kind, its first parameter, how well it is known from this noise, the measured trace.
    let cases: [(&str, f64, f64, Vec<f64>); 10] = [
        ("sensor_bias", 0.1, 2e-3, noisy(|t| motion(t) + 0.1)),
        ("sensor_gain", 1.07, 2e-3, noisy(|t| 1.07 * motion(t))),
        ("sensor_delay", 0.013, 2e-4, noisy(|t| motion(t - 0.013))),
        ("sensor_drift", 0.02, 1e-3, noisy(|t| motion(t) + 0.02 * t)),
        ("clock_skew", 5e-4, 2e-5, noisy(|t| motion(t * 1.0005))),
        (
            "tone_pickup",
            0.05,
            1e-3,
            noisy(|t| motion(t) + 0.05 * (TAU * 50.0 * t + 1.0).sin()),
        ),
        (
            "clipping",
            0.9,
            1e-3,
            sampled(|t| motion(t).clamp(-0.9, 0.9)),
        ),
        (
            "quantisation",
            0.05,
            1e-3,
            noisy(motion)
                .iter()
                .map(|y| (y / 0.05).round() * 0.05)
                .collect(),
        ),
        ("alternating_gain", 0.03, 1e-3, alternating),
        ("outliers", f64::NAN, 0.0, spiked),
    ];
    for (kind, value, known, measured) in cases {
        let (found, estimate) = named(&of(measured, sampled(motion)));
        assert_eq!(found, kind);
        assert!(
            value.is_nan() || (estimate - value).abs() < known,
            "{kind}: {estimate}, truth {value}"
        );
    }
}

#[test]
fn verify_what_the_chain_cannot_do_is_left_to_the_model() {
    for measured in [
        noisy(|t| motion(t) - 0.1 * motion(t).powi(3)),
        noisy(|t| motion(t) + 0.2 * (TAU * 1.1 * t).cos().signum()),
    ] {
        let answer = of(measured, sampled(motion)).comparison;
        let is_unknown = answer.chain.status == Status::Unknown;
        assert!(is_unknown || !answer.chain.complete, "{:?}", answer.chain);
    }
}

#[test]
fn verify_noise_and_nothing_are_no_gap() {
    let noise = of(noisy(motion), sampled(motion)).comparison;
    assert_eq!(noise.chain.status, Status::None);
    assert!(noise.look[0].noise_share > 0.9);
    let same = of(sampled(motion), sampled(motion)).comparison;
    assert_eq!(same.chain.status, Status::None);
    assert_eq!(
        (same.channels[0].nrmse, same.channels[0].largest),
        (0.0, 0.0)
    );
    assert_eq!(same.channels[0].iso18571.as_ref().unwrap().total, 1.0);
}

#[test]
fn verify_the_look_of_linear_harmonic_and_broadband() {
    let linear = &of(noisy(|t| motion(t - 0.02)), sampled(motion))
        .comparison
        .look[0];
    assert!(linear.linear_share > 0.9, "{linear:?}");
    let cubic = of(noisy(|t| decay(t) - 0.2 * decay(t).powi(3)), sampled(decay));
    let cubic = &cubic.comparison.look[0];
    // sin³ = ¾ sin − ¼ sin 3, so that a tenth of the square lies at the third harmonic; less, as
    // the line dies out and is no line any more.
    assert!(
        (0.05..0.1).contains(&cubic.harmonic_share.unwrap()),
        "{cubic:?}"
    );
    assert!(
        (cubic.amplitude_power.unwrap() - 3.0).abs() < 0.2,
        "{cubic:?}"
    );
    let dry = of(
        noisy(|t| decay(t) + 0.05 * (TAU * 1.1 * t).cos().signum()),
        sampled(decay),
    );
    let dry = &dry.comparison.look[0];
    assert!(dry.amplitude_power.unwrap().abs() < 0.2, "{dry:?}");
    let gain = &of(noisy(|t| 1.1 * decay(t)), sampled(decay))
        .comparison
        .look[0];
    assert!(
        (gain.amplitude_power.unwrap() - 1.0).abs() < 0.1,
        "{gain:?}"
    );
    let tone = noisy(|t| motion(t) + 0.05 * (TAU * 31.7 * t).sin());
    let tone = &of(tone, sampled(motion)).comparison.look[0];
    assert!(tone.linear_share < 0.3, "{tone:?}");
}

#[test]
fn verify_where_names_bands_times_and_states() {
    // A jump of the discrepancy with the direction of motion, in the second half only.
    let late = |t: f64| if t > 10.0 { 0.1 } else { 0.0 };
    let measured = noisy(|t| decay(t) + late(t) * (TAU * 1.1 * t).cos().signum());
    let answer = of(measured, sampled(decay)).comparison;
    let found = &answer.r#where;
    assert!(
        found.times.iter().all(|time| time.from_s > 9.0),
        "{:?}",
        found.times
    );
    let labels: Vec<&str> = found.bands.iter().map(|band| band.label.as_str()).collect();
    assert!(
        labels[0].starts_with("the main line of the motion at 1.1"),
        "{labels:?}"
    );
    assert!(
        labels[1].starts_with("harmonic 3 of the main line"),
        "{labels:?}"
    );
    let bump = |t: f64| 0.3 * (motion(t) - 0.8).max(0.0);
    let answer = of(noisy(|t| motion(t) - bump(t)), sampled(motion)).comparison;
    let state = &answer.r#where.states[0];
    assert_eq!(state.label, "large positive displacement of y");
    assert!(state.share > 0.95 && state.occupancy < 0.3, "{state:?}");
}

#[test]
fn verify_records_of_other_clocks_meet() {
    let step_s = 1.7e-3;
    let count = (22.0 / step_s) as usize;
    let fine = (0..count)
        .map(|k| 1e3 * motion(step_s * k as f64 - 1.0))
        .collect();
    let channels = vec![Channel::new("y", "mm", fine)];
    let simulated = Record::from_uniform("s.csv", -1.0, step_s, channels).unwrap();
    let measured = record("m.csv", sampled(motion));
    let answer = compared(&measured, &simulated).comparison;
    assert!(answer.time.resampled);
    // Interpolation between samples of 1.7 ms: (5/1024) (2π 7.31 Hz 1.7 ms)⁶ of 0.2.
    assert!(
        answer.channels[0].largest < 1e-6,
        "{:?}",
        answer.channels[0]
    );
    assert!(
        answer
            .notes
            .iter()
            .any(|note| note.contains("was interpolated"))
    );
    // A clock that began elsewhere: no common time, until both are set to one start.
    let moved = Record::from_uniform("m.csv", 500.0, STEP_S, measured.channels().to_vec()).unwrap();
    let reference = record("s.csv", sampled(motion));
    let mut request = CompareRequest {
        measured: &moved,
        simulated: &reference,
        pairs: &[],
        inputs: &[],
        align_start: false,
    };
    let refused = compare(&request, &|_| {});
    assert!(matches!(refused, Err(CompareError::NoCommonTime { .. })));
    request.align_start = true;
    let answer = compare(&request, &|_| {}).unwrap().comparison;
    assert!(!answer.time.resampled);
    assert_eq!(answer.channels[0].nrmse, 0.0);
}

#[test]
fn verify_what_drives_both_is_not_compared() {
    let drive = |t: f64| (TAU * 1.1 * t).sin();
    let make = |name: &str, u: f64, y: Vec<f64>| {
        let u = sampled(|t| u * drive(t));
        let channels = vec![Channel::new("u", "N", u), Channel::new("y", "m", y)];
        Record::from_uniform(name, 0.0, STEP_S, channels).unwrap()
    };
    let simulated = make("s.csv", 5.0, sampled(motion));
    let measured = make("m.csv", 5.0, noisy(|t| 1.05 * motion(t)));
    let answer = compared(&measured, &simulated).comparison;
    assert_eq!(answer.inputs.len(), 1);
    assert_eq!(answer.channels.len(), 1);
    assert!(
        answer.r#where.bands[0]
            .label
            .starts_with("the excitation at 1.1000 Hz")
    );
    // Another drive is compared unless it is said to be one, and then is told.
    let measured = make("m.csv", 4.0, noisy(|t| 1.05 * motion(t)));
    assert_eq!(compared(&measured, &simulated).comparison.channels.len(), 2);
    let answer = compare(
        &CompareRequest {
            measured: &measured,
            simulated: &simulated,
            pairs: &[],
            inputs: &["u".to_string()],
            align_start: false,
        },
        &|_| {},
    );
    let answer = answer.unwrap().comparison;
    assert_eq!(answer.channels.len(), 1);
    assert!(
        answer
            .notes
            .iter()
            .any(|note| note.contains("input \"u\" differs by 25")),
        "{:?}",
        answer.notes
    );
}
