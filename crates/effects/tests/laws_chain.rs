//! What the measurement chain does to a channel, each kind against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use std::f64::consts::PI;

use common::{effect, map, through};
use simgap_effects::{Sampled, SiteScale};

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
    // A step between two samples is a ramp of one sample; long after it the lag has settled.
    let mut step = [0.0; 4000];
    step[10..].fill(1.0);
    let found = through(map("sensor_lag", &[0.5]).as_ref(), &step, 0.01);
    assert_eq!(found[9], 0.0);
    let tau = 0.5_f64;
    let at_step = 1.0 + tau / 0.01 * (-0.01 / tau).exp_m1();
    for (i, z) in found.iter().enumerate().skip(10) {
        let needed = 1.0 - (1.0 - at_step) * (-0.01 * (i - 10) as f64 / tau).exp();
        assert_near(*z, needed, 1e3 * ROUNDING);
    }
}

/// A sine of whole periods after the transient: gain 1/√(1 + (ωτ)²), phase −atan ωτ, and the
/// linear interpolation lowers the amplitude by (ωΔt)²/12.
#[test]
fn verify_sensor_lag_of_a_sine() {
    let (step_s, freq_hz, tau) = (0.001, 5.0, 0.02);
    let omega = 2.0 * PI * freq_hz;
    let sine: Vec<f64> = (0..2000)
        .map(|i| (omega * step_s * f64::from(i)).sin())
        .collect();
    let found = through(map("sensor_lag", &[tau]).as_ref(), &sine, step_s);
    let (gain, phase) = (1.0 / (omega * tau).hypot(1.0), -(omega * tau).atan());
    let interpolated = (omega * step_s).powi(2) / 12.0;
    for (i, z) in found.iter().enumerate().skip(1000) {
        let needed = gain * (omega * step_s * i as f64 + phase).sin();
        assert_near(*z, needed, 1.01 * gain * interpolated);
    }
}

#[test]
fn verify_clipping_of_a_sine() {
    let sine: Vec<f64> = (0..1000)
        .map(|i| (2.0 * PI * f64::from(i) / 1000.0).sin())
        .collect();
    let found = through(map("clipping", &[0.5, -0.8]).as_ref(), &sine, 0.01);
    for (z, y) in found.iter().zip(&sine) {
        let needed = if *y > 0.5 {
            0.5
        } else if *y < -0.8 {
            -0.8
        } else {
            *y
        };
        assert_eq!(*z, needed);
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
    let rounded = map("quantisation", &[0.25]);
    let signal = [0.0, 0.124, 0.126, -0.126, 0.375, -0.375, 7.9];
    let needed = [0.0, 0.0, 0.25, -0.25, 0.5, -0.5, 8.0];
    assert_eq!(through(rounded.as_ref(), &signal, 0.01), needed);
    // Twice is once.
    assert_eq!(through(rounded.as_ref(), &needed, 0.01), needed);
    assert!(rounded.is_stepped());
    // Steps beyond the digits of a number change nothing, and never overflow.
    let fine = through(map("quantisation", &[1e-300]).as_ref(), &[1e10, -0.3], 0.01);
    assert_eq!(fine, [1e10, -0.3]);
}

/// The error of rounding a signal that crosses many levels is even over ±q/2: rms q/√12.
#[test]
fn verify_quantisation_error_is_the_step_over_root_twelve() {
    let step = 0.003;
    let sine: Vec<f64> = (0..20_000).map(|i| (0.7 * f64::from(i)).sin()).collect();
    let found = through(map("quantisation", &[step]).as_ref(), &sine, 0.01);
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
    assert_eq!(effect("quantisation").starts(&common::scale()), [[0.01]]);
}

#[test]
fn verify_tone_pickup_is_a_sine_on_the_clock_of_the_record() {
    let (amplitude, freq_hz, phase, step_s) = (0.3, 50.0, 1.1, 0.00137);
    let map = map("tone_pickup", &[amplitude, freq_hz, phase]);
    let signal: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
    // Rounding of angles up to 2π f t = 1200.
    const ANGLE: f64 = 1e-12;
    for (first_index, start_s) in [(0, 0.0), (300, 2.5)] {
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

/// Numbers evenly drawn in 0 to 1 (a linear congruence, high bits).
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed
        .wrapping_mul(2_862_933_555_777_941_757)
        .wrapping_add(3_037_000_493);
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Normal noise of deviation 1 [Box-Muller1958].
fn noise(random: &mut impl FnMut() -> f64) -> f64 {
    let radius = (-2.0 * (1.0 - random()).ln()).sqrt();
    radius * (2.0 * PI * random()).cos()
}

fn from_samples(count: usize, mut value: impl FnMut(f64) -> f64) -> Vec<f64> {
    (0..count).map(|i| value(i as f64)).collect()
}

fn stored_in_steps(signal: &[f64], step: f64) -> Vec<f64> {
    signal.iter().map(|v| step * (v / step).round()).collect()
}

/// A block of mass 1 on a belt of speed `speed`, held by a spring to the ground, with dry friction
/// that is higher at rest: displacement, velocity and acceleration while it sticks and slips.
fn stick_slip(count: usize, step: f64) -> [Vec<f64>; 3] {
    let (stiffness, at_rest, sliding, speed) = (400.0, 8.0, 5.0, 0.05);
    let (mut x, mut v, mut sticks) = (0.0, speed, true);
    let mut out = [vec![], vec![], vec![]];
    const FINE: usize = 200;
    let fine = step / FINE as f64;
    for i in 0..count * FINE {
        let pull: f64 = -stiffness * x;
        if sticks && pull.abs() > at_rest {
            sticks = false;
        }
        let acceleration = if sticks {
            0.0
        } else {
            pull + sliding * f64::signum(speed - v)
        };
        if i % FINE == 0 {
            out[0].push(x);
            out[1].push(v);
            out[2].push(acceleration);
        }
        let before = v - speed;
        v += fine * acceleration;
        x += fine * v;
        if !sticks && before != 0.0 && before * (v - speed) <= 0.0 {
            (v, sticks) = (speed, true);
        }
    }
    out
}

/// Records without any defect, of every make that could be taken for one.
fn clean_records() -> Vec<(String, Vec<f64>)> {
    let mut rng = random(7);
    let count = 6000;
    let mut records: Vec<(String, Vec<f64>)> = Vec::new();
    let mut add = |name: &str, signal: Vec<f64>| records.push((name.to_string(), signal));
    let sine = |period: f64| from_samples(count, |i| (2.0 * PI * i / period + 0.1).sin());
    for period in [2.0, 2.02, 2.3, 3.0, 4.0, 5.0, 6.1, 8.0, 20.0, 333.3, 2000.0] {
        add(&format!("sine of period {period}"), sine(period));
        let coarse = stored_in_steps(&sine(period), 0.01);
        add(&format!("sine of period {period} in steps"), coarse);
        let fine = stored_in_steps(&sine(period), 1e-4);
        add(&format!("sine of period {period} in fine steps"), fine);
    }
    add(
        "exact crests",
        from_samples(count, |i| (2.0 * PI * (i % 20.0) / 20.0).sin()),
    );
    for half in [3.0, 4.0, 7.0, 50.0] {
        let square = |i: f64| {
            if (i / half).floor() % 2.0 == 0.0 {
                1.0
            } else {
                -1.0
            }
        };
        add(
            &format!("square wave, half {half}"),
            from_samples(count, square),
        );
        let noisy = from_samples(count, |i| square(i) + 0.01 * noise(&mut rng));
        add(&format!("noisy square wave, half {half}"), noisy);
        let triangle = from_samples(count, |i| (i % (2.0 * half) - half).abs());
        add(&format!("triangle, half {half}"), triangle);
    }
    let white = from_samples(200_000, |_| noise(&mut rng));
    for step in [0.01, 0.05, 0.1, 0.5, 2.0] {
        add(
            &format!("white noise in steps of {step}"),
            stored_in_steps(&white, step),
        );
    }
    add("white noise", white);
    let burst = from_samples(count, |i| {
        let size = if (i % 1000.0) < 100.0 { 1.0 } else { 0.01 };
        size * noise(&mut rng)
    });
    add("noise in bursts", burst);
    // A resonance driven by noise, 4 to 40 samples a period.
    for period in [4.0, 7.0, 15.0, 40.0] {
        let (radius, turn) = (0.99_f64, 2.0 * PI / period);
        let (mut a, mut b) = (0.0, 0.0);
        let resonance = from_samples(40_000, |_| {
            let next = 2.0 * radius * turn.cos() * a - radius * radius * b + noise(&mut rng);
            (a, b) = (next, a);
            next
        });
        add(&format!("resonance of period {period}"), resonance);
        // Struck every 500 samples, it rings and dies away.
        let ring = from_samples(count, |i| {
            let since = i % 500.0;
            (-0.02 * since).exp() * (turn * since).sin()
        });
        let noisy: Vec<f64> = ring.iter().map(|y| y + 1e-3 * noise(&mut rng)).collect();
        add(&format!("ringing of period {period}"), noisy);
        add(&format!("noiseless ringing of period {period}"), ring);
    }
    for step in [0.002, 0.01] {
        let motion = stick_slip(count, step);
        for (name, signal) in ["displacement", "velocity", "acceleration"]
            .iter()
            .zip(motion)
        {
            let noisy: Vec<f64> = signal.iter().map(|y| y + 1e-3 * noise(&mut rng)).collect();
            add(&format!("stick-slip {name} at {step}"), signal);
            add(&format!("stick-slip {name} at {step} with noise"), noisy);
        }
    }
    let clipped = sine(200.0).iter().map(|y| y.clamp(-0.7, 0.6)).collect();
    add("clipped", clipped);
    let rectified = sine(200.0).iter().map(|y| y.max(0.0)).collect();
    add("rectified", rectified);
    let mut decay = from_samples(count, |i| (-0.01 * i).exp() * (0.1 * i).sin());
    decay[3000..].fill(0.0);
    add("decay to rest", decay);
    add("constant", vec![3.0; count]);
    records
}

/// Samples where a map delivers what was measured instead of a prediction.
fn taken_over(kind: &str, values: &[f64], measured: &[f64]) -> Vec<usize> {
    let predicted = vec![1234.5; measured.len()];
    let delivered = map(kind, values).apply(Sampled {
        measured: Some(measured),
        ..Sampled::from_start(&predicted, 0.001)
    });
    let taken = (0..measured.len()).filter(|&i| delivered[i] != predicted[i]);
    let taken: Vec<usize> = taken.collect();
    assert!(taken.iter().all(|&i| delivered[i] == measured[i]));
    taken
}

#[test]
fn verify_dropouts_finds_none_in_records_that_lost_nothing() {
    for (name, record) in clean_records() {
        let taken = taken_over("dropouts", &[1.0], &record);
        assert!(
            taken.is_empty(),
            "{name}: {} at {:?}",
            taken.len(),
            taken.first()
        );
    }
}

/// A record with noise, and the same with the losses of a seed: which samples differ.
fn with_losses(signal: &[f64], seed: u64) -> (Vec<f64>, Vec<usize>) {
    let mut rng = random(seed);
    let struck = effect("dropouts").strike(&[1.0], signal, &mut rng).unwrap();
    let lost = (0..signal.len())
        .filter(|&i| struck[i] != signal[i])
        .collect();
    (struck, lost)
}

#[test]
fn verify_dropouts_finds_the_samples_that_were_lost() {
    let mut rng = random(11);
    let sine = from_samples(5000, |i| (0.05 * i).sin() + 0.4 * (0.31 * i).sin());
    let noisy: Vec<f64> = sine.iter().map(|y| y + 0.02 * noise(&mut rng)).collect();
    let offset: Vec<f64> = noisy.iter().map(|y| 5.0 + y).collect();
    let white = from_samples(5000, |_| noise(&mut rng));
    let in_steps = stored_in_steps(&noisy, 1e-3);
    let names = ["smooth", "noisy", "offset", "white", "in steps"];
    for (name, signal) in names.iter().zip([sine, noisy, offset, white, in_steps]) {
        for seed in 1..9 {
            let (struck, lost) = with_losses(&signal, seed);
            assert!(lost.len() > 40, "{name}: only {} lost", lost.len());
            let taken = taken_over("dropouts", &[1.0], &struck);
            let missed = lost.iter().filter(|i| !taken.contains(i)).count();
            let wrong = taken.iter().filter(|i| !lost.contains(i)).count();
            // On a lattice the shortest runs may be chance, and one in twenty taken may be; elsewhere
            // a single zero beside a value near zero may be a crossing.
            let (share, most_wrong) = match *name {
                "in steps" => (4, lost.len() / 20),
                _ => (100, 0),
            };
            let allowed = lost.len() / share;
            assert!(
                missed <= allowed,
                "{name}, seed {seed}: {missed} of {} missed",
                lost.len()
            );
            assert!(
                wrong <= most_wrong,
                "{name}, seed {seed}: {wrong} taken that arrived"
            );
        }
    }
}

#[test]
fn verify_dropouts_without_a_record_or_at_infinity_change_nothing() {
    let (struck, lost) = with_losses(&from_samples(5000, |i| (0.05 * i).sin()), 3);
    assert!(taken_over("dropouts", &[f64::INFINITY], &struck).is_empty());
    assert_eq!(
        through(map("dropouts", &[1.0]).as_ref(), &struck, 0.01),
        struck
    );
    // No run is longer than twenty, and what a fit tries beside a whole number is that number.
    assert!(taken_over("dropouts", &[30.0], &struck).is_empty());
    let taken = taken_over("dropouts", &[1.0], &struck);
    assert_eq!(taken_over("dropouts", &[1.0001], &struck), taken);
    let longer = taken_over("dropouts", &[10.0], &struck).len();
    assert!(longer > 0 && longer < lost.len());
}

#[test]
fn verify_outliers_finds_none_in_records_without_spikes() {
    for (name, record) in clean_records() {
        for start in effect("outliers").starts(&common::scale()) {
            let taken = taken_over("outliers", &start, &record);
            assert!(
                taken.is_empty(),
                "{name}: {} at {:?}",
                taken.len(),
                taken.first()
            );
        }
    }
}

#[test]
fn verify_outliers_finds_the_spikes() {
    let mut rng = random(17);
    let sine = from_samples(5000, |i| (0.05 * i).sin() + 0.4 * (0.31 * i).sin());
    let noisy: Vec<f64> = sine.iter().map(|y| y + 0.02 * noise(&mut rng)).collect();
    let fast = from_samples(5000, |i| (0.5 * i).sin() + 0.02 * noise(&mut rng));
    let in_steps = stored_in_steps(&noisy, 0.05);
    let names = ["smooth", "noisy", "fast", "in steps"];
    for (name, signal) in names.iter().zip([sine, noisy, fast, in_steps]) {
        for seed in 1..9 {
            let mut rng = random(seed);
            let struck = effect("outliers")
                .strike(&[8.0], &signal, &mut rng)
                .unwrap();
            let spikes: Vec<usize> = (0..signal.len())
                .filter(|&i| struck[i] != signal[i])
                .collect();
            assert!(spikes.len() > 5, "{name}: only {} spikes", spikes.len());
            let taken = taken_over("outliers", &[7.0], &struck);
            let missed = spikes.iter().filter(|i| !taken.contains(i)).count();
            let wrong = taken.iter().filter(|i| !spikes.contains(i)).count();
            // Spikes may come in a longer row than three, or at the ends.
            assert!(
                missed <= spikes.len() / 12,
                "{name}, seed {seed}: {missed} of {} missed",
                spikes.len()
            );
            assert_eq!(wrong, 0, "{name}, seed {seed}");
        }
    }
}

#[test]
fn verify_outliers_takes_up_to_three_in_a_row_whatever_their_signs() {
    let quiet = from_samples(100, |i| 0.1 * (0.05 * i).sin() + 0.01 * (2.9 * i).cos());
    let taken = |rise: &[f64]| -> Vec<usize> {
        let mut record = quiet.clone();
        for (value, rise) in record[50..].iter_mut().zip(rise) {
            *value += rise;
        }
        taken_over("outliers", &[7.0], &record)
    };
    assert_eq!(taken(&[5.0]), [50]);
    assert_eq!(taken(&[-5.0, 2.0, -3.0]), [50, 51, 52]);
    // An ordinary sample between two spikes stays.
    assert_eq!(taken(&[5.0, 0.0, 4.0]), [50, 52]);
    // Longer than three it is something else, and so is a step.
    assert!(taken(&[5.0; 4]).is_empty());
    assert!(taken(&[5.0; 50]).is_empty());
    // Below the threshold in spreads of about 0.02 it may be noise.
    assert!(taken(&[0.05]).is_empty());
}

#[test]
fn verify_outliers_without_a_record_or_at_infinity_change_nothing() {
    let mut struck = from_samples(200, |i| (0.1 * i).sin());
    struck[77] = 20.0;
    assert_eq!(taken_over("outliers", &[12.0], &struck), [77]);
    assert_eq!(taken_over("outliers", &[12.001], &struck), [77]);
    assert!(taken_over("outliers", &[f64::INFINITY], &struck).is_empty());
    assert_eq!(
        through(map("outliers", &[12.0]).as_ref(), &struck, 0.01),
        struck
    );
}

/// Maps that look at what was measured keep the length of short signals.
#[test]
fn verify_short_records_are_left_alone() {
    for (kind, values) in [("outliers", 7.0), ("dropouts", 1.0)] {
        for len in 0..20 {
            let measured = vec![1.0; len];
            assert!(taken_over(kind, &[values], &measured).is_empty());
            let empty = effect(kind).strike(&[values], &[], &mut || 0.5).unwrap();
            assert!(empty.is_empty());
        }
    }
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
    let mut rng = random(5);
    let a = from_samples(300, |_| noise(&mut rng));
    let b = from_samples(300, |_| noise(&mut rng));
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
