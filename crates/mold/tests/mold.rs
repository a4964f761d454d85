//! The mold models and the records rebuilt from the tables.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use proptest::prelude::*;
use simgap_mold::{
    DISPLACEMENT_CHANNEL, Derivative, FORCE_CHANNEL, MoldError, OneDof, Reading, STANDARD_GRAVITY,
    TwoDof, published_line_amplitude, published_plan, rebuild,
};

/// Half a unit of the third decimal, to which these values were worked out by hand.
const THIRD_DECIMAL: f64 = 5e-4;

/// Eigenvalues of a 2 × 2 problem scaled to 1e5: a few units in the last place.
const EIGENVALUE_ROUNDING: f64 = 1e-9;

#[test]
fn verify_one_dof_frequencies() {
    let mold = OneDof::published().unwrap();
    assert!((mold.natural_freq_hz() - 2.5222).abs() < THIRD_DECIMAL);
    assert!((mold.damped_freq_hz().unwrap() - 2.4060).abs() < THIRD_DECIMAL);
    assert!((mold.resonance_freq_hz().unwrap() - 2.2839).abs() < THIRD_DECIMAL);
    assert!((mold.damping() - 313_778.8).abs() < 0.1);
    assert!((mold.static_force(0.002) - 16_575.278).abs() < 1e-3);
    let heavy = OneDof::new(1.0, 0.8, 1.0).unwrap();
    assert!(heavy.resonance_freq_hz().is_none() && heavy.damped_freq_hz().is_some());
    assert!(
        OneDof::new(1.0, 1.0, 1.0)
            .unwrap()
            .damped_freq_hz()
            .is_none()
    );
}

/// The peak of the receptance lies where the closed form says: compared at 0.1 % either side.
#[test]
fn verify_resonance_is_the_largest_receptance() {
    let mold = OneDof::published().unwrap();
    let matrices = mold.model().unwrap().matrices().unwrap();
    let at = |freq| {
        simgap_model::frequency_response(&matrices, freq, simgap_model::FrfKind::Receptance)
            .unwrap()[(0, 0)]
            .norm()
    };
    let peak = mold.resonance_freq_hz().unwrap();
    assert!(at(peak) > at(peak * 0.999) && at(peak) > at(peak * 1.001));
}

#[test]
fn verify_one_dof_model_carries_eq_1() {
    let mold = OneDof::published().unwrap();
    let model = mold.model().unwrap();
    let again = simgap_model::Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(again, model);
    assert_eq!(model.load_vector(), vec![-33_000.0 * STANDARD_GRAVITY]);
    let modes = simgap_model::damped_modes(&model.matrices().unwrap()).unwrap();
    assert!((modes[0].damping_ratio - 0.3).abs() < 1e-12);
}

#[test]
fn val_park_table5_modes() {
    // Own computation of the 2 × 2 determinant, to three decimals; the paper wants 50 -+ f.
    let expected = [
        [50.175, 52.790],
        [49.148, 53.090],
        [48.307, 54.081],
        [47.209, 54.932],
        [46.358, 56.064],
        [45.245, 57.052],
    ];
    for (row, f) in expected.iter().zip(1..) {
        let modes = TwoDof::published(f64::from(f)).unwrap().modes_hz().unwrap();
        for (mode, expected) in modes.iter().zip(row) {
            assert!(
                (mode - expected).abs() < THIRD_DECIMAL,
                "{f} Hz: {mode} against {expected}"
            );
        }
    }
}

#[test]
fn verify_restored_modes_are_exact() {
    for f in 1..=6 {
        let f = f64::from(f);
        let restored = TwoDof::published(f)
            .unwrap()
            .restored(50.0 - f, 50.0 + f)
            .unwrap();
        let [lower, upper] = restored.modes_hz().unwrap();
        assert!((lower - (50.0 - f)).abs() < EIGENVALUE_ROUNDING);
        assert!((upper - (50.0 + f)).abs() < EIGENVALUE_ROUNDING);
        assert_eq!(restored.mold_stiffness(), 3.3e9);
    }
}

#[test]
fn verify_two_dof_force_is_hundreds_of_times_larger() {
    let stiff = TwoDof::published(1.0).unwrap();
    let static_force = stiff.mold_stiffness() * 0.002;
    assert_eq!(static_force, 6.6e6);
    // At rest m₁ sees k₁ and, in series, k_leaf and k₂.
    let series = 1.0 / (1.0 / stiff.leaf_stiffness() + 1.0 / stiff.support_stiffness());
    let at_rest = stiff.force_amplitude(0.002, 0.0).unwrap();
    assert!((at_rest / (0.002 * (3.3e9 + series)) - 1.0).abs() < 1e-12);
    assert!(static_force / OneDof::published().unwrap().static_force(0.002) > 398.0);
    let ratio = stiff.support_motion_ratio(0.0).unwrap();
    let leaf = stiff.leaf_stiffness();
    assert!((ratio - leaf / (leaf + stiff.support_stiffness())).abs() < 1e-12);
}

#[test]
fn verify_errors_say_what_is_needed() {
    assert_eq!(
        OneDof::new(-1.0, 0.3, 1.0).unwrap_err().to_string(),
        "mass is -1, needed is finite and above zero"
    );
    assert_eq!(
        TwoDof::published(7.0).unwrap_err().to_string(),
        "Table 5 has no row for 7 Hz, it has 1, 2, 3, 4, 5, 6 Hz"
    );
    assert_eq!(
        TwoDof::published(1.0)
            .unwrap()
            .restored(49.0, 50.0)
            .unwrap_err()
            .to_string(),
        "no positive k_leaf and k2 give modes at 49 and 50 Hz with these masses and k1"
    );
    let plan = published_plan(1.0, 100.0, Reading::None).unwrap();
    let mut short = plan.clone();
    short.duration_s = f64::NAN;
    assert_eq!(
        rebuild(&OneDof::published().unwrap(), short)
            .unwrap_err()
            .to_string(),
        "duration is NaN, needed is finite and above zero"
    );
    let mut empty = plan;
    empty.duration_s = 0.01;
    let refused = rebuild(&OneDof::published().unwrap(), empty);
    assert!(matches!(refused, Err(MoldError::Record(_))));
}

fn samples(f: f64, fs: f64, reading: Reading, channel: &str) -> Vec<f64> {
    let plan = published_plan(f, fs, reading).unwrap();
    let rebuilt = rebuild(&OneDof::published().unwrap(), plan).unwrap();
    assert!(rebuilt.record.name().starts_with("rebuilt"));
    assert!(rebuilt.statement.contains("not measured"));
    rebuilt.record.require(channel).unwrap().values.clone()
}

/// Amplitude of a line by correlation over a whole number of periods.
fn line(values: &[f64], fs: f64, freq: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (n, y) in values.iter().enumerate() {
        let (sin, cos) = (TAU * freq * n as f64 / fs).sin_cos();
        re += y * cos;
        im += y * sin;
    }
    2.0 * f64::hypot(re, im) / values.len() as f64
}

/// At 100 Hz the two readings give one and the same line; at 500 Hz they part.
#[test]
fn verify_readings_agree_at_100_hz_and_part_at_500_hz() {
    let (f, tau) = (3.0, 0.6e-3);
    let line_amplitude = TAU * f * 0.002 * tau;
    let timing = Reading::AlternatingTiming {
        timing_error_s: tau,
    };
    let support = Reading::FlexibleSupport {
        line_amplitude,
        base_hz: 50.0,
    };
    // (ωτ)²/6 of the fundamental, and the harmonics' share of the image lines.
    const SECOND_ORDER: f64 = 1e-3;
    for reading in [timing, support] {
        let y = samples(f, 100.0, reading, DISPLACEMENT_CHANNEL);
        assert!((line(&y, 100.0, 47.0) / line_amplitude - 1.0).abs() < SECOND_ORDER);
    }
    let y = samples(f, 500.0, timing, DISPLACEMENT_CHANNEL);
    assert!((line(&y, 500.0, 247.0) / line_amplitude - 1.0).abs() < SECOND_ORDER);
    assert!(line(&y, 500.0, 47.0) < SECOND_ORDER * line_amplitude);
    assert!(line(&y, 500.0, 53.0) < SECOND_ORDER * line_amplitude);
    let y = samples(f, 500.0, support, DISPLACEMENT_CHANNEL);
    assert!((line(&y, 500.0, 47.0) / (0.5 * line_amplitude) - 1.0).abs() < SECOND_ORDER);
    assert!((line(&y, 500.0, 53.0) / (0.5 * line_amplitude) - 1.0).abs() < SECOND_ORDER);
    assert!(line(&y, 500.0, 247.0) < SECOND_ORDER * line_amplitude);
}

/// Table 2: the pressure has the lines of the table and no high line, whatever the reading.
#[test]
fn val_park_table2_lines_of_the_rebuilt_pressure() {
    let table = simgap_tables::table2().unwrap();
    for row in &table.rows[..6] {
        let f = row.excitation.si();
        let reading = Reading::AlternatingTiming {
            timing_error_s: 0.6e-3,
        };
        let force = samples(f, 100.0, reading, FORCE_CHANNEL);
        for listed in row.pressure.lines_hz() {
            assert!(line(&force, 100.0, *listed) > 1.0, "{f} Hz: {listed} Hz");
        }
        let high = row.displacement_high.as_ref().unwrap().si();
        assert!(line(&force, 100.0, high) < 1e-6, "{f} Hz: {high} Hz");
    }
}

/// With exact derivatives the force of a plan is Eq. (3) of the smooth motion; with Park's it is
/// what gives Table 3 back when Park's formula is applied at the paper's step.
#[test]
fn verify_force_follows_eq_3() {
    let mold = OneDof::published().unwrap();
    let mut plan = published_plan(2.0, 100.0, Reading::None).unwrap();
    assert_eq!(plan.derivative, Derivative::Park { time_step_s: 0.01 });
    let of = |plan: &simgap_mold::RebuildPlan, channel: &str| {
        let rebuilt = rebuild(&mold, plan.clone()).unwrap();
        rebuilt.record.require(channel).unwrap().values.clone()
    };
    let y = of(&plan, DISPLACEMENT_CHANNEL);
    let unknown = |n: usize| {
        plan.centre_force + 0.5 * plan.stroke_force * (TAU * 2.0 * n as f64 * 0.01).cos()
    };
    let weight = 33_000.0 * STANDARD_GRAVITY;

    let v = simgap_integrate::inverse::park_derivative(&y, 0.01).unwrap();
    let a = simgap_integrate::inverse::park_derivative(&v, 0.01).unwrap();
    let force = of(&plan, FORCE_CHANNEL);
    for n in 10..y.len() {
        let alpha =
            33_000.0 * a[n] + mold.damping() * v[n] + mold.stiffness() * y[n] - force[n] + weight;
        // Rounding of y, 1e-16 · 2 mm, through m/h² and m g.
        assert!((alpha - unknown(n)).abs() < 1e-6, "sample {n}: {alpha}");
    }

    plan.derivative = Derivative::Exact;
    plan.lines_hz.clear();
    let omega = TAU * 2.0;
    let exact = of(&plan, FORCE_CHANNEL);
    for (n, force) in exact.iter().enumerate() {
        let (sin, cos) = (omega * n as f64 * 0.01).sin_cos();
        let expected = (mold.stiffness() - 33_000.0 * omega * omega) * 0.002 * sin
            + mold.damping() * omega * 0.002 * cos
            + weight
            - unknown(n);
        assert!((force - expected).abs() < 1e-6);
    }
}

#[test]
fn verify_line_amplitude_of_table4() {
    // 75236.49 N over |m D² + c D + k| at 49 Hz, worked out by hand from Park's formula.
    let amplitude = published_line_amplitude(1.0).unwrap();
    assert!((amplitude - 7.887e-6).abs() < 5e-9, "{amplitude}");
    assert!(matches!(
        published_line_amplitude(7.0),
        Err(MoldError::NoRow { .. })
    ));
}

#[test]
fn verify_records_are_reproducible_and_noise_is_asked_for() {
    let mold = OneDof::published().unwrap();
    let mut plan = published_plan(2.0, 100.0, Reading::None).unwrap();
    assert_eq!(plan.noise_rms, 0.0);
    let quiet = rebuild(&mold, plan.clone()).unwrap();
    plan.noise_rms = 1e-6;
    let noisy = rebuild(&mold, plan.clone()).unwrap();
    assert_eq!(noisy, rebuild(&mold, plan.clone()).unwrap());
    let of = |r: &simgap_mold::RebuiltRecord| r.record.require("y").unwrap().values.clone();
    let square: f64 = of(&noisy)
        .iter()
        .zip(of(&quiet))
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        / 2000.0;
    // The standard deviation of 2000 normal numbers is known to 1/√4000 = 1.6 %; five of these.
    assert!((square.sqrt() / 1e-6 - 1.0).abs() < 0.08);
    plan.seed = 1;
    assert_ne!(noisy, rebuild(&mold, plan).unwrap());
}

proptest! {
    /// Restoring from the modes of any admissible system gives that system back.
    #[test]
    fn prop_restored_inverts_modes(leaf in 1e7_f64..1e9, support in 1e7_f64..2e9) {
        let given = TwoDof::new([33_000.0, 7_000.0], [3.3e9, leaf, support]).unwrap();
        let [lower, upper] = given.modes_hz().unwrap();
        let back = given.restored(lower, upper).unwrap();
        let [lower_back, upper_back] = back.modes_hz().unwrap();
        prop_assert!((lower_back / lower - 1.0).abs() < 1e-7);
        prop_assert!((upper_back / upper - 1.0).abs() < 1e-7);
        prop_assert!(back.leaf_stiffness() > 0.0 && back.support_stiffness() > 0.0);
    }
}
