//! Planted defects are found with their numbers; clean data raise no alarm.
#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use proptest::prelude::*;
use simgap_record::{Channel, Defect, Edge, Record, quality};

/// Cases of each property: a few tenths of a second in all. 4000 have been run as well.
const CASES: u32 = 64;

/// A small generator with a seed (splitmix64), so that a failure repeats itself.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (2.0 * PI * self.uniform()).cos()
    }
}

fn noisy_sine(len: usize, cycles_per_sample: f64, noise: f64, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let sine = |k: usize| (2.0 * PI * cycles_per_sample * k as f64 + 0.3).sin();
    (0..len)
        .map(|k| sine(k) + noise * random.normal())
        .collect()
}

fn defects(values: Vec<f64>) -> Vec<Defect> {
    let record = Record::from_uniform("A", 0.0, 1e-3, vec![Channel::new("y", "mm", values)]);
    quality(&record.unwrap())
        .into_iter()
        .map(|finding| finding.defect)
        .collect()
}

fn quantised(values: &[f64], step: f64) -> Vec<f64> {
    values.iter().map(|v| (v / step).round() * step).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: CASES, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn prop_a_clean_noisy_sine_raises_no_alarm(
        len in 8usize..5000,
        frequency in 1e-4..0.3f64,
        log_noise in -6.0..1.0f64,
        scale in -9.0..9.0f64,
        seed in any::<u64>(),
    ) {
        let mut values = noisy_sine(len, frequency, 10f64.powf(log_noise), seed);
        values.iter_mut().for_each(|v| *v = (*v + 0.7) * 10f64.powf(scale));
        let found = defects(values);
        prop_assert!(found.is_empty(), "{:?}", found);
    }

    /// Growing noise, a walk, a decay, noise with heavy tails: not one of them is a defect.
    #[test]
    fn prop_other_clean_data_raise_no_alarm(len in 300usize..5000, seed in any::<u64>()) {
        let mut random = Random(seed);
        let growing = (0..len).map(|k| k as f64 * random.normal()).collect();
        let decay = noisy_sine(len, 0.02, 0.0, seed).iter().enumerate()
            .map(|(k, v)| v * (-8.0 * k as f64 / len as f64).exp() + 1e-4 * random.normal())
            .collect();
        let mut walk = vec![0.0];
        for k in 1..len {
            walk.push(walk[k - 1] + random.normal());
        }
        let friction = noisy_sine(len, 0.004, 0.0, seed).iter()
            .map(|v| v.signum() + 0.2 * v + 0.01 * random.normal()).collect();
        for (name, values) in
            [("growing", growing), ("decay", decay), ("walk", walk), ("friction", friction)]
        {
            let found = defects(values);
            prop_assert!(found.is_empty(), "{}: {:?}", name, found);
        }
    }

    /// A quantised channel is called that, and nothing else: neither clipped at its crests nor
    /// repeating itself.
    #[test]
    fn prop_a_lattice_is_found_with_its_step_and_nothing_else(
        len in 300usize..5000,
        frequency in 5e-4..0.05f64,
        log_step in -2.5..-0.9f64,
        noise in 0.0..0.05f64,
        origin in -1.0..1.0f64,
        seed in any::<u64>(),
    ) {
        let step = 10f64.powf(log_step);
        let clean = noisy_sine(len, frequency, noise, seed);
        prop_assume!(len as f64 * frequency > 1.0);
        let values = quantised(&clean, step).iter().map(|v| v + origin).collect();
        let found = defects(values);
        match &found[..] {
            [Defect::Quantised { step: estimate, .. }] => {
                prop_assert!((estimate / step - 1.0).abs() < 1e-9, "{} {}", estimate, step);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    /// Samples lost now and then, the last one held.
    #[test]
    fn prop_held_samples_are_counted(
        frequency in 1e-3..0.05f64, share in 0.01..0.2f64, seed in any::<u64>(),
    ) {
        let mut values = noisy_sine(4000, frequency, 0.02, seed);
        let mut random = Random(!seed);
        let mut held = 0;
        for k in 1..values.len() {
            if random.uniform() < share {
                values[k] = values[k - 1];
                held += 1;
            }
        }
        let found = defects(values);
        match &found[..] {
            [Defect::Repeated { fraction, longest_run, .. }] => {
                prop_assert!((fraction - f64::from(held) / 3999.0).abs() < 1e-12);
                prop_assert!(*longest_run >= 1);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    #[test]
    fn prop_spikes_are_found_where_they_are(
        frequency in 1e-3..0.05f64, height in 1.0..20.0f64, seed in any::<u64>(),
    ) {
        // Fifty standard deviations of the noise and more.
        let mut values = noisy_sine(2000, frequency, 0.02, seed);
        let mut random = Random(!seed);
        let planted: Vec<usize> =
            (0..10).map(|k| 50 + 190 * k + (random.uniform() * 100.0) as usize).collect();
        for &row in &planted {
            values[row] += if random.uniform() < 0.5 { -height } else { height };
        }
        let found = defects(values);
        match &found[..] {
            [Defect::Spikes { rows, largest, .. }] => {
                prop_assert_eq!(rows, &planted);
                prop_assert!((largest.abs() / height - 1.0).abs() < 0.2);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    #[test]
    fn prop_an_alternation_is_found_with_its_amplitude_and_sign(
        frequency in 1e-3..0.2f64, amplitude in 0.005..0.1f64, sign in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let signed = if sign { amplitude } else { -amplitude };
        let values = noisy_sine(8000, frequency, 0.01, seed).iter().enumerate()
            .map(|(k, v)| v + if k % 2 == 0 { signed } else { -signed }).collect();
        let found = defects(values);
        match &found[..] {
            [Defect::Alternation { amplitude: estimate, .. }] => {
                // Standard error of the mean of the noise: 0.01 / sqrt(8000 / 1.5), six of them.
                prop_assert!((estimate - signed).abs() < 6.0 * 0.01 / 73.0, "{}", estimate);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    #[test]
    fn prop_a_limited_range_is_found_at_its_level(
        frequency in 1e-3..0.02f64, limit in 0.3..0.9f64, noise in 0.0..0.05f64,
        upper in any::<bool>(), coarse in any::<bool>(), seed in any::<u64>(),
    ) {
        let free = noisy_sine(4000, frequency, noise, seed);
        let beyond = free.iter().filter(|v| if upper { **v > limit } else { **v < -limit }).count();
        let values: Vec<f64> = free.iter()
            .map(|v| if upper { v.min(limit) } else { v.max(-limit) }).collect();
        let values = if coarse { quantised(&values, 0.003) } else { values };
        let level = if upper { limit } else { -limit };
        let found = defects(values);
        let clipped: Vec<&Defect> =
            found.iter().filter(|d| matches!(d, Defect::Clipped { .. })).collect();
        match clipped[..] {
            [Defect::Clipped { edge, level: estimate, fraction, .. }] => {
                prop_assert_eq!(*edge, if upper { Edge::Upper } else { Edge::Lower });
                prop_assert!((estimate - level).abs() <= 0.0015 + 1e-12);
                let expected = beyond as f64 / 4000.0;
                prop_assert!((fraction - expected).abs() < 0.05, "{} {}", fraction, expected);
            }
            _ => prop_assert!(false, "{:?}", found),
        }
        prop_assert_eq!(found.len(), 1 + usize::from(coarse), "{:?}", found);
    }
}

#[test]
fn verify_noise_free_periodic_inputs_raise_no_alarm() {
    for samples_per_period in 3..400 {
        for phase in [0.0, 0.5, 0.25] {
            let turn = |k: usize| 2.0 * PI * (k as f64 + phase) / f64::from(samples_per_period);
            let found = defects((0..2000).map(|k| turn(k).sin()).collect());
            assert!(found.is_empty(), "{samples_per_period} a period: {found:?}");
        }
    }
    let square = (0..2000)
        .map(|k| f64::from(u8::from(k % 50 < 25)))
        .collect();
    let ramp = (0..2000).map(|k| 0.1 * f64::from(k)).collect();
    for values in [square, ramp] {
        assert_eq!(defects(values), []);
    }
}

/// Eleven samples in half a period: the eleventh harmonic of the rounding is an alternation.
#[test]
fn verify_rounding_of_a_periodic_motion_is_no_alternation() {
    for step in [0.0304, 0.01, 0.051] {
        let found = defects(quantised(&noisy_sine(1186, 1.0 / 22.0, 1e-4, 1), step));
        assert!(
            matches!(found[..], [Defect::Quantised { .. }]),
            "{step}: {found:?}"
        );
    }
}

#[test]
fn verify_a_flat_channel_is_flat_and_nothing_else() {
    assert_eq!(defects(vec![3.5; 100]), [Defect::Flat { value: 3.5 }]);
}

#[test]
fn verify_jitter_of_stamps_and_its_rounding() {
    let y = |len| Channel::new("y", "m", noisy_sine(len, 0.01, 0.1, 7));
    let of = |time: Vec<f64>| {
        let len = time.len();
        let found = quality(&Record::new("A", time, vec![y(len)]).unwrap());
        found
            .into_iter()
            .map(|finding| (finding.channel, finding.defect))
            .collect::<Vec<_>>()
    };
    let even = |k: usize| k as f64 * 1.6384e-3;
    assert_eq!(of((0..900).map(even).collect()), []);
    let rounded = of((0..900).map(|k| (even(k) * 1e3).round() / 1e3).collect());
    assert!(matches!(
        &rounded[..],
        [(t, Defect::TimeJitter { worst_steps, rounded_to_s: Some(unit), .. })]
            if t == "t" && *unit == 1e-3 && (0.25..0.33).contains(worst_steps)
    ));
    // Alternately early and late by a twenty-fifth of a step.
    let alternating = of((0..900)
        .map(|k| even(k) + 0.04 * 1.6384e-3 * if k % 2 == 0 { 1.0 } else { -1.0 })
        .collect());
    assert!(matches!(
        &alternating[..],
        [(_, Defect::TimeJitter { rms_steps, rounded_to_s: None, .. })]
            if (rms_steps - 0.04).abs() < 1e-3
    ));
}

#[test]
fn regress_sentences() {
    let mut spiked = noisy_sine(2000, 0.01, 0.01, 1);
    spiked[700] -= 3.0;
    spiked[900] += 1.0;
    let mut held = noisy_sine(2000, 0.01, 0.01, 2);
    for start in (50..2000).step_by(100) {
        let last = held[start];
        held[start..start + 4].fill(last);
    }
    let alternating = |k: usize| if k.is_multiple_of(2) { 0.05 } else { -0.05 };
    let channels = vec![
        Channel::new("flat", "N", vec![1.0; 2000]),
        Channel::new(
            "upper",
            "mm",
            noisy_sine(2000, 0.01, 0.01, 3)
                .iter()
                .map(|v| v.min(0.8))
                .collect(),
        ),
        Channel::new(
            "lower",
            "mm",
            noisy_sine(2000, 0.01, 0.01, 4)
                .iter()
                .map(|v| v.max(-0.8))
                .collect(),
        ),
        Channel::new(
            "coarse",
            "V",
            quantised(&noisy_sine(2000, 0.01, 0.01, 5), 0.02),
        ),
        Channel::new("held", "bar", held),
        Channel::new("spiked", "g", spiked),
        Channel::new(
            "tone",
            "deg",
            noisy_sine(2000, 0.01, 0.01, 6)
                .iter()
                .enumerate()
                .map(|(k, v)| v + alternating(k))
                .collect(),
        ),
    ];
    let time = (0..2000)
        .map(|k| f64::from(k * 16_384 / 10_000) / 1e3)
        .collect();
    let record = Record::new("A.csv", time, channels).unwrap();
    let sentences: Vec<String> = quality(&record).iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(sentences.join("\n"), @r"
    stamps are 0.176 of a step off a uniform grid (rms), 0.305 at worst, by rounding to 0.001 s
    flat is flat at 1 N
    upper is held at its largest value 0.8 mm for 20.35 % of the samples, up to 21 in a row
    lower is held at its smallest value -0.8 mm for 20.55 % of the samples, up to 21 in a row
    coarse lies on a lattice of step 0.02 V, 103 levels wide
    held repeats the value before in 3.00 % of the samples, in 20 runs of up to 3
    spiked has 2 single outliers of up to -2.99306 g, with 0.00970707 g of noise about its curve
    tone alternates from sample to sample by 0.0497051 deg (217 standard errors)
    ");
}

/// Values at the ends of the double range come through without a panic.
#[test]
fn verify_extreme_values_do_not_break_the_checks() {
    for scale in [1e-320, 1e-200, 1e200, f64::MAX / 2.0, f64::MAX] {
        let values: Vec<f64> = noisy_sine(600, 0.01, 0.0, 1)
            .iter()
            .map(|v| v * scale)
            .collect();
        let _ = defects(values);
    }
}
