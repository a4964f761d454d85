//! Lost samples and spikes are found in the record alone, and none where there are none.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::PI;

use crate::common::{self, effect, map, through};
use simgap_effects::Sampled;

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
        for step in [0.5, 3.0, 10.0] {
            let name = format!("resonance of period {period} in steps of {step}");
            add(&name, stored_in_steps(&resonance, step));
        }
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
            let range = signal.iter().fold(0.0, |most, y| f64::max(most, y.abs()));
            for levels in [5.0, 30.0, 300.0] {
                let coarse = stored_in_steps(&signal, range / levels);
                add(
                    &format!("stick-slip {name} at {step} in {levels} levels"),
                    coarse,
                );
                let coarse = stored_in_steps(&noisy, range / levels);
                add(
                    &format!("stick-slip {name} at {step} with noise in {levels} levels"),
                    coarse,
                );
            }
            add(&format!("stick-slip {name} at {step}"), signal);
            add(&format!("stick-slip {name} at {step} with noise"), noisy);
        }
    }
    let clipped = sine(200.0).iter().map(|y| y.clamp(-0.7, 0.6)).collect();
    add("clipped", clipped);
    let loud = from_samples(count, |i| 2.0 * (0.03 * i).sin() + 0.1 * noise(&mut rng));
    let loud = loud.iter().map(|y| y.clamp(-1.9, 1.7)).collect();
    add("clipped with noise", loud);
    // Little noise on a lattice: single samples flicker by one step.
    for share in [0.1, 0.2, 0.3, 0.5, 1.0] {
        let flicker = from_samples(count, |i| {
            (0.002 * i).sin() + 0.01 * share * noise(&mut rng)
        });
        add(
            &format!("flicker of {share} steps"),
            stored_in_steps(&flicker, 0.01),
        );
        let struck = from_samples(count, |i| {
            let since = i % 500.0;
            (-0.03 * since).exp() * (0.7 * since).sin() + 0.001 * share * noise(&mut rng)
        });
        add(
            &format!("ringing on flicker of {share} steps"),
            stored_in_steps(&struck, 0.001),
        );
    }
    let through_half = |i: f64| match i % 100.0 {
        p if p < 49.0 => 0.0,
        p if !(50.0..99.0).contains(&p) => 0.5,
        _ => 1.0,
    };
    let soft = from_samples(count, |i| through_half(i) + 0.001 * noise(&mut rng));
    add("square wave through a value between", soft);
    let pulse = |i: f64| if i % 15.0 < 3.0 { 1.0 } else { 0.0 };
    let pulses = from_samples(count, |i| pulse(i) + 0.001 * noise(&mut rng));
    add("short pulses all the time", pulses);
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
