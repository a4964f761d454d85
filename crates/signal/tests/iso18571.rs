//! ISO/TS 18571 rating: closed forms, a slow oracle for the shift, another program's numbers.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, cosine};
use proptest::prelude::*;
use simgap_signal::SignalError;
use simgap_signal::metrics::{Grade, iso18571};
use std::f64::consts::TAU;

/// Rounding of sums over a thousand samples and of the transforms behind the correlation.
const ROUNDING: f64 = 1e-10;

#[test]
fn verify_identical_curves_score_one() {
    let x = Noise::new(1).normals(200);
    let rating = iso18571(&x, &x).unwrap();
    assert_eq!(
        (rating.corridor, rating.phase, rating.magnitude),
        (1.0, 1.0, 1.0)
    );
    assert_eq!(
        (rating.slope, rating.total, rating.delay_samples),
        (1.0, 1.0, 0)
    );
    assert_eq!(rating.grade(), Grade::Excellent);
}

#[test]
fn verify_period_is_no_shift() {
    // Every whole period correlates perfectly: the smallest shift, none, must win.
    let x = cosine(1000, 1000.0, 20.0, 1.0, 0.3);
    assert_eq!(iso18571(&x, &x).unwrap().delay_samples, 0);
}

#[test]
fn verify_pure_shift() {
    // A pulse late or early by 30 of 500 samples: E_P = (100 - 30)/100, the rest of the shifted curves
    // agrees; the corridor is that of the unshifted ones.
    let pulse = |at: f64| -> Vec<f64> {
        (0..500)
            .map(|n| (-((n as f64 - at) / 25.0).powi(2)).exp())
            .collect()
    };
    for (at, delay) in [(270.0, 30), (210.0, -30)] {
        let rating = iso18571(&pulse(240.0), &pulse(at)).unwrap();
        assert_eq!(rating.delay_samples, delay);
        assert!((rating.phase - 0.7).abs() < ROUNDING);
        assert!((rating.correlation - 1.0).abs() < ROUNDING);
        assert!((rating.magnitude - 1.0).abs() < ROUNDING);
        assert!((rating.slope - 1.0).abs() < ROUNDING);
        assert!(rating.corridor < 0.95, "{rating:?}");
    }
}

#[test]
fn verify_pure_scale() {
    // C = 1.3 T of a ramp through zero: |T - C| = 0.3 |T|, so with u = |T|/T_norm uniform on 0 … 1 the
    // corridor is 1 up to u = 1/6 and ((0.5 - 0.3 u)/0.45)² beyond, integral
    // 1/6 + (0.45³ - 0.2³)/(0.9 · 0.45²).
    let t: Vec<f64> = (0..20_001).map(|n| f64::from(n) / 10_000.0 - 1.0).collect();
    let c: Vec<f64> = t.iter().map(|v| 1.3 * v).collect();
    let rating = iso18571(&t[..], &c).unwrap();
    let corridor = 1.0 / 6.0 + (0.45f64.powi(3) - 0.2f64.powi(3)) / (0.9 * 0.45 * 0.45);
    // Sum for integral, 10⁴ steps.
    assert!(
        (rating.corridor - corridor).abs() < 1e-4,
        "{} {corridor}",
        rating.corridor
    );
    assert_eq!((rating.phase, rating.delay_samples), (1.0, 0));
    // ε_S = 0.3
    assert!((rating.slope - 0.85).abs() < ROUNDING);
    let total = 0.4 * rating.corridor + 0.2 * (rating.phase + rating.magnitude + rating.slope);
    assert!((rating.total - total).abs() < ROUNDING);
}

#[test]
fn verify_warping_reaches_less_than_a_tenth() {
    // A tall pulse in place, a small one early and one late by d: warping mends both while
    // d < 0.1 · 200 samples, and no common shift does.
    let curve = |d: usize| -> Vec<f64> {
        let mut x = vec![0.0; 200];
        (x[100], x[50 - d], x[150 + d]) = (3.0, 1.0, 1.0);
        x
    };
    let within = iso18571(&curve(0), &curve(19)).unwrap();
    assert_eq!((within.delay_samples, within.magnitude), (0, 1.0));
    let beyond = iso18571(&curve(0), &curve(20)).unwrap();
    assert_eq!(beyond.delay_samples, 0);
    assert!(beyond.magnitude < 0.9, "{beyond:?}");
}

#[test]
fn verify_opposite_curve_scores_low() {
    let t: Vec<f64> = (0..300).map(|n| f64::from(n) - 149.5).collect();
    let c: Vec<f64> = t.iter().map(|v| -v).collect();
    let rating = iso18571(&t, &c).unwrap();
    // Slope: |C' - T'| = 2 |T'|, the largest error there is. Magnitude: warping cannot mend it.
    assert!(
        rating.slope.abs() < ROUNDING && rating.magnitude == 0.0,
        "{rating:?}"
    );
    assert_eq!(rating.grade(), Grade::Poor);
}

/// Correlation of every shift, written out; the first of the largest.
fn shift_oracle(t: &[f64], c: &[f64]) -> isize {
    let correlation = |a: &[f64], b: &[f64]| {
        let n = a.len() as f64;
        let (ma, mb) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
        let mut sums = [0.0; 3];
        for (x, y) in a.iter().zip(b) {
            sums[0] += (x - ma) * (y - mb);
            sums[1] += (x - ma).powi(2);
            sums[2] += (y - mb).powi(2);
        }
        sums[0] / (sums[1] * sums[2]).sqrt()
    };
    let n = t.len();
    let mut best = (0, correlation(t, c));
    for m in 1..=n / 5 {
        let late = correlation(&t[..n - m], &c[m..]);
        let early = correlation(&t[m..], &c[..n - m]);
        if late > best.1 {
            best = (m as isize, late);
        }
        if early > best.1 {
            best = (-(m as isize), early);
        }
    }
    best.0
}

proptest! {
    #[test]
    fn prop_shift_is_the_slow_one(seed in 0u64..10_000, len in 11usize..150) {
        let mut noise = Noise::new(seed);
        let (t, c) = (noise.normals(len), noise.normals(len));
        prop_assert_eq!(iso18571(&t, &c).unwrap().delay_samples, shift_oracle(&t, &c));
    }

    #[test]
    fn prop_scores_between_zero_and_one(seed in 0u64..10_000, len in 11usize..150, scale in 0.1..5.0f64) {
        let mut noise = Noise::new(seed);
        let t = noise.normals(len);
        let c: Vec<f64> = t.iter().map(|v| scale * v + 0.1 * noise.normal()).collect();
        let r = iso18571(&t, &c).unwrap();
        for score in [r.corridor, r.phase, r.magnitude, r.slope, r.total] {
            prop_assert!((0.0..=1.0).contains(&score), "{:?}", r);
        }
    }
}

#[test]
fn val_iso18571_scorer_demo_pair() {
    // The demo pair of the open ISO/TS 18571 scorer of Park (github.com/yeonsoo-p/ISO18571, checked there
    // against the 42 cases of the annex), with the scores its quickstart notebook prints.
    const PRINTED: f64 = 1e-12;
    let tau = |n: usize| n as f64 / 600.0;
    let measured: Vec<f64> = (0..600)
        .map(|n| {
            let s = tau(n);
            0.65 * (TAU * 3.0 * s).sin()
                + 0.20 * (TAU * 9.0 * s + 0.25).sin()
                + 0.10 * ((s - 0.42) / 0.035).tanh()
        })
        .collect();
    let predicted: Vec<f64> = (0..600)
        .map(|n| {
            let s = tau(n) - 0.012;
            0.62 * (TAU * 3.0 * s).sin()
                + 0.18 * (TAU * 9.0 * s + 0.25).sin()
                + 0.09 * ((tau(n) - 0.44) / 0.04).tanh()
                + 0.025
        })
        .collect();
    let r = iso18571(&measured, &predicted).unwrap();
    assert_eq!(r.delay_samples, 7);
    for (what, got, want) in [
        ("corridor", r.corridor, 0.652_890_716_899_321_8),
        ("phase", r.phase, 0.941_666_666_666_666_7),
        ("magnitude", r.magnitude, 0.950_654_019_291_195_4),
        ("slope", r.slope, 0.956_686_509_230_894_4),
        ("total", r.total, 0.830_957_725_797_480_1),
        ("correlation", r.correlation, 0.999_765_948_353_145_5),
    ] {
        println!("{what}: {:.1e}", got - want);
        assert!((got - want).abs() < PRINTED, "{what}: {got} {want}");
    }
    assert_eq!(r.grade(), Grade::Good);
}

#[test]
fn verify_bad_input_is_named() {
    assert_eq!(
        iso18571(&[1.0; 20], &[1.0; 20]).unwrap_err(),
        SignalError::Flat { what: "measured" }
    );
    assert_eq!(
        iso18571(&[1.0; 10], &[1.0; 10]).unwrap_err().to_string(),
        "measured has 10 entries, at least 11 are needed"
    );
    // A constant prediction is bad, not an error.
    let t = cosine(100, 100.0, 2.0, 1.0, 0.0);
    assert!(iso18571(&t, &[0.0; 100]).unwrap().total < 0.6);
}
