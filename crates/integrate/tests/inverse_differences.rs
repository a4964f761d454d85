//! Finite differences: what they are exact on, how fast they converge, what they do to sines.
#![allow(clippy::unwrap_used)]

use crate::support::{largest_difference, observed_order};
use proptest::prelude::*;
use simgap_integrate::IntegrateError;
use simgap_integrate::inverse::{
    Differentiator, PARK_WEIGHTS, central_difference, derive_motion, differentiate, exact_transfer,
    park_derivative, transfer,
};

/// A dozen roundings of numbers of order one.
const ROUNDING: f64 = 1e-13;

/// Moment Σ w_k k^p of the interior weights.
fn moment(differentiator: Differentiator, power: i32) -> f64 {
    differentiator
        .weights()
        .iter()
        .map(|(k, w)| w * (*k as f64).powi(power))
        .sum()
}

#[test]
fn verify_interior_weights_have_the_moments_of_a_derivative() {
    for differentiator in Differentiator::ALL {
        assert!(
            moment(differentiator, 0).abs() < ROUNDING,
            "{differentiator:?}"
        );
        assert!(
            (moment(differentiator, 1) - 1.0).abs() < ROUNDING,
            "{differentiator:?}"
        );
        let order = differentiator.order() as i32;
        for power in 2..=order {
            assert!(
                moment(differentiator, power).abs() < ROUNDING,
                "{differentiator:?} {power}"
            );
        }
        assert!(
            moment(differentiator, order + 1).abs() > 0.4,
            "{differentiator:?}"
        );
    }
}

/// Park's four weights from four equations: three of order two and Σ w_k k⁴ = 0, which the mean of
/// the formulas of orders two and three has and no other formula of order two on these points.
#[test]
fn verify_park_weights_are_the_mean_of_bdf2_and_bdf3() {
    let bdf2 = [3.0 / 2.0, -2.0, 1.0 / 2.0, 0.0];
    let bdf3 = [11.0 / 6.0, -3.0, 3.0 / 2.0, -1.0 / 3.0];
    for k in 0..4 {
        assert!(
            (PARK_WEIGHTS[k] - 0.5 * (bdf2[k] + bdf3[k])).abs() < ROUNDING,
            "weight {k}"
        );
    }
    assert!(moment(Differentiator::Park, 4).abs() < ROUNDING);
}

#[test]
fn verify_every_sample_is_exact_on_polynomials_of_the_order_named() {
    let h = 0.25;
    for differentiator in Differentiator::ALL {
        let degree = differentiator.order() as i32;
        for samples in differentiator.least_samples()..12 {
            let time = |n: usize| h * n as f64 - 1.0;
            let values: Vec<f64> = (0..samples)
                .map(|n| (0..=degree).map(|p| time(n).powi(p)).sum())
                .collect();
            let exact: Vec<f64> = (0..samples)
                .map(|n| {
                    (1..=degree)
                        .map(|p| f64::from(p) * time(n).powi(p - 1))
                        .sum()
                })
                .collect();
            let found = differentiate(differentiator, &values, h).unwrap();
            let error = largest_difference(&found, &exact);
            assert!(
                error < 100.0 * ROUNDING,
                "{differentiator:?}, {samples} samples: {error}"
            );
        }
    }
}

/// Largest error of the derivative of sin t over 0..3 s, ends included, with n steps.
fn error_on_a_sine(differentiator: Differentiator, steps: usize) -> f64 {
    let h = 3.0 / steps as f64;
    let values: Vec<f64> = (0..=steps).map(|n| (h * n as f64).sin()).collect();
    let exact: Vec<f64> = (0..=steps).map(|n| (h * n as f64).cos()).collect();
    largest_difference(&differentiate(differentiator, &values, h).unwrap(), &exact)
}

#[test]
fn order_of_every_differentiator_ends_included() {
    for differentiator in Differentiator::ALL {
        let order = observed_order(
            error_on_a_sine(differentiator, 400),
            error_on_a_sine(differentiator, 800),
        );
        let named = differentiator.order() as f64;
        assert!((order - named).abs() < 0.05, "{differentiator:?}: {order}");
    }
}

/// Twice Park: away from the start still of order two; at the start the change of formula between
/// neighbours is differenced and one order is lost.
#[test]
fn order_of_park_acceleration() {
    let errors = |steps: usize| {
        let h = 3.0 / steps as f64;
        let values: Vec<f64> = (0..=steps).map(|n| (h * n as f64).sin()).collect();
        let exact: Vec<f64> = (0..=steps).map(|n| -(h * n as f64).sin()).collect();
        let found = derive_motion(Differentiator::Park, &values, h)
            .unwrap()
            .acceleration;
        (
            largest_difference(&found[6..], &exact[6..]),
            largest_difference(&found[..6], &exact[..6]),
        )
    };
    let ((inner, start), (inner_fine, start_fine)) = (errors(400), errors(800));
    assert!((observed_order(inner, inner_fine) - 2.0).abs() < 0.05);
    assert!(observed_order(start, start_fine) > 0.95);
}

#[test]
fn val_paper_park_gain_at_nyquist_of_the_published_record() {
    // dt = 0.01 s: 533.33 1/s where the true factor is 314.16 1/s.
    let gain = transfer(Differentiator::Park, 50.0, 0.01).unwrap().norm();
    let exact = exact_transfer(50.0).unwrap().norm();
    assert!((gain - 533.33).abs() < 0.005, "{gain}");
    assert!((exact - 314.16).abs() < 0.005, "{exact}");
    // The same by applying it: an alternating series.
    let alternating: Vec<f64> = (0..20)
        .map(|n| if n % 2 == 0 { 1.0 } else { -1.0 })
        .collect();
    let velocity = park_derivative(&alternating, 0.01).unwrap();
    assert!((velocity[10] - 1600.0 / 3.0).abs() < 1e-9);
}

/// Leading terms of Park's error: gain 1 + θ²/6, lag θ⁵/12 (the fourth moment vanishes).
#[test]
fn verify_park_gain_and_lag_for_slow_sines() {
    let theta: f64 = 0.05;
    let h = 0.01;
    let found = transfer(Differentiator::Park, theta / (std::f64::consts::TAU * h), h).unwrap();
    let gain = found.norm() * h / theta - 1.0;
    let lag = std::f64::consts::FRAC_PI_2 - found.arg();
    // Next terms are of relative size θ².
    assert!(
        (gain / (theta.powi(2) / 6.0) - 1.0).abs() < 2.0 * theta.powi(2),
        "{gain}"
    );
    assert!(
        (lag / (theta.powi(5) / 12.0) - 1.0).abs() < 4.0 * theta.powi(2),
        "{lag}"
    );
}

/// The measured response to a sampled sine: cosine and sine in, combined to one complex factor.
fn measured_response(differentiator: Differentiator, freq_hz: f64, h: f64) -> (f64, f64) {
    let angle = std::f64::consts::TAU * freq_hz * h;
    let cosine: Vec<f64> = (0..24).map(|n| (angle * n as f64).cos()).collect();
    let sine: Vec<f64> = (0..24).map(|n| (angle * n as f64).sin()).collect();
    let real = differentiate(differentiator, &cosine, h).unwrap()[12];
    let imaginary = differentiate(differentiator, &sine, h).unwrap()[12];
    // (real + i imaginary) · exp(−i 12 angle)
    let (c, s) = ((12.0 * angle).cos(), -(12.0 * angle).sin());
    (real * c - imaginary * s, real * s + imaginary * c)
}

#[test]
fn verify_transfer_against_sampled_sines() {
    let h = 0.01;
    for differentiator in Differentiator::ALL {
        for tenth in 1..=20 {
            let freq_hz = 2.5 * f64::from(tenth);
            let closed = transfer(differentiator, freq_hz, h).unwrap();
            let (re, im) = measured_response(differentiator, freq_hz, h);
            // Gains reach 600 1/s: a dozen roundings of that.
            assert!(
                (closed.re - re).abs() < 1e-10,
                "{differentiator:?} {freq_hz} {re}"
            );
            assert!(
                (closed.im - im).abs() < 1e-10,
                "{differentiator:?} {freq_hz} {im}"
            );
        }
    }
}

#[test]
fn regress_gain_and_phase_up_to_nyquist() {
    let h = 0.01;
    let mut table =
        String::from("h = 0.01 s; gain over exact factor, phase error in degrees\n f Hz");
    for differentiator in Differentiator::ALL {
        table += &format!("  {:>17}", format!("{differentiator:?}"));
    }
    for freq_hz in [
        1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 45.0, 49.0, 50.0,
    ] {
        table += &format!("\n{freq_hz:>5}");
        for differentiator in Differentiator::ALL {
            let exact = exact_transfer(freq_hz).unwrap();
            let ratio = transfer(differentiator, freq_hz, h).unwrap() / exact;
            let phase = if ratio.norm() < 1e-12 {
                "-".to_owned()
            } else {
                // Rounded first, so that a rounding error does not show as a minus sign.
                format!(
                    "{:.3}",
                    (ratio.arg().to_degrees() * 1e3).round() / 1e3 + 0.0
                )
            };
            table += &format!("  {:>8.5} {phase:>8}", ratio.norm());
        }
    }
    insta::assert_snapshot!(table);
}

#[test]
fn verify_refusals_name_what_was_found() {
    let message = |result: Result<Vec<f64>, IntegrateError>| result.unwrap_err().to_string();
    assert_eq!(
        message(park_derivative(&[1.0, 2.0, 3.0], 0.1)),
        "the series to differentiate has 3 samples, needed: at least 4"
    );
    assert_eq!(
        message(park_derivative(&[1.0, f64::NAN, 3.0, 4.0], 0.1)),
        "the series to differentiate is NaN at sample 1, needed: finite"
    );
    assert_eq!(
        message(park_derivative(&[0.0; 4], 0.0)),
        "time step is 0 s, needed: finite and greater than 0"
    );
    assert_eq!(
        message(central_difference(&[0.0; 9], 0.1, 3)),
        "order of the central difference is 3, needed: 2 or 4"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn prop_differentiation_is_linear_and_forgets_the_offset(
        a in proptest::collection::vec(-1.0..1.0_f64, 12),
        b in proptest::collection::vec(-1.0..1.0_f64, 12),
        scale in -3.0..3.0_f64,
        offset in -3.0..3.0_f64,
    ) {
        for differentiator in Differentiator::ALL {
            let mixed: Vec<f64> = a.iter().zip(&b).map(|(x, y)| x + scale * y + offset).collect();
            let whole = differentiate(differentiator, &mixed, 0.5).unwrap();
            let part_a = differentiate(differentiator, &a, 0.5).unwrap();
            let part_b = differentiate(differentiator, &b, 0.5).unwrap();
            for n in 0..12 {
                prop_assert!((whole[n] - part_a[n] - scale * part_b[n]).abs() < 1e-12);
            }
        }
    }
}
