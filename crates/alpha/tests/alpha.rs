//! Unknown force, its parts, and the explanation of the lines near the Nyquist frequency.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use simgap_alpha::{
    AlphaError, BeatParameters, ConverterFault, ObservedLine, Oscillator, RateFormula,
    explain_lines, fit_beat, fit_folded_beat, fit_fourier, force_gain, gain_table, leads,
    unknown_force, unknown_force_of_record,
};
use simgap_integrate::inverse::Differentiator;
use simgap_record::{Channel, Record};

const PAPER: Oscillator = Oscillator {
    mass_kg: 33_000.0,
    damping: 313_778.8,
    stiffness: 8_287_639.0,
    load: -323_619.45,
};

const PARK: RateFormula = RateFormula::Scheme(Differentiator::Park);

/// F0 of Table 4, typed in here so that the test does not share a source with the program.
const TABLE4: [f64; 6] = [
    75236.49, 138166.37, 207682.21, 302004.08, 352677.60, 400450.39,
];

/// Standard errors a fitted value may be off: one in two million for normal errors.
const FIVE_SIGMA: f64 = 5.0;

fn observed() -> Vec<ObservedLine> {
    TABLE4
        .iter()
        .zip(1..)
        .map(|(force, f)| ObservedLine {
            excitation_freq_hz: f64::from(f),
            force_amplitude: *force,
        })
        .collect()
}

fn explain(formula: RateFormula, fault: ConverterFault) -> simgap_alpha::Explanation {
    explain_lines(&observed(), &PAPER, 0.002, 0.01, formula, fault).unwrap()
}

#[test]
fn val_park_table4_from_one_timing_error() {
    let park = explain(PARK, ConverterFault::AlternatingTiming);
    assert!((1e3 * park.value - 0.617).abs() < 5e-4, "{}", park.value);
    assert!((park.r_squared - 0.994).abs() < 5e-4, "{}", park.r_squared);
    assert!(
        (park.worst_relative_error - 0.063).abs() < 5e-4,
        "{}",
        park.worst_relative_error
    );
    assert!(park.standard_error < 0.02 * park.value);

    let exact = explain(RateFormula::Exact, ConverterFault::AlternatingTiming);
    assert!(
        (exact.r_squared - 0.988).abs() < 5e-4,
        "{}",
        exact.r_squared
    );
    assert!(
        (exact.worst_relative_error - 0.14).abs() < 5e-3,
        "{}",
        exact.worst_relative_error
    );
}

#[test]
fn val_park_table4_not_from_an_alternating_gain() {
    assert!(explain(PARK, ConverterFault::AlternatingGain).r_squared < 0.0);
    assert!(explain(RateFormula::Exact, ConverterFault::AlternatingGain).r_squared < 0.0);
}

/// The closed form of (3) against the whole chain: sample with the fault, differentiate twice,
/// Eq. (3), fit the folded beat.
#[test]
fn verify_explanation_against_the_whole_chain() {
    let (h, tau, amplitude) = (0.01, 0.6e-3, 0.002);
    // (2πfτ)²/8 and the part of the next order that falls on the same line.
    const FIRST_ORDER: f64 = 1e-3;
    for f in [1.0, 3.0, 6.0] {
        let y: Vec<f64> = (0..2000)
            .map(|n| {
                let late = if n % 2 == 0 { tau } else { -tau };
                amplitude * (TAU * f * (f64::from(n) * h + late)).sin()
            })
            .collect();
        let found = unknown_force(&PAPER, &y, &vec![0.0; 2000], h, Differentiator::Park).unwrap();
        let fit =
            fit_folded_beat(&found.unknown_force, h, found.settling_samples, 50.0 - f).unwrap();
        let expected =
            force_gain(&PAPER, PARK, 50.0 - f, h).unwrap().norm() * TAU * f * amplitude * tau;
        let ratio = fit.parameters.amplitude / expected;
        assert!((ratio - 1.0).abs() < FIRST_ORDER, "{f} Hz: {ratio}");
        assert!((fit.parameters.split_hz - 2.0 * f).abs() < 1e-3);
    }
}

/// Equation (3) undone: a motion and the force that makes α what it was.
#[test]
fn verify_unknown_force_is_recovered_from_a_known_motion() {
    let (h, omega) = (1e-3, TAU * 2.0);
    let alpha = |t: f64| 500.0 + 300.0 * (omega * t).cos();
    let (mut y, mut force) = (vec![], vec![]);
    for n in 0..4000 {
        let t = f64::from(n) * h;
        let (sin, cos) = (omega * t).sin_cos();
        y.push(0.002 * sin);
        force.push(
            PAPER.mass_kg * -0.002 * omega * omega * sin
                + PAPER.damping * 0.002 * omega * cos
                + PAPER.stiffness * 0.002 * sin
                - PAPER.load
                - alpha(t),
        );
    }
    let record = Record::from_uniform(
        "made",
        0.0,
        h,
        vec![Channel::new("F", "N", force), Channel::new("y", "m", y)],
    )
    .unwrap();
    let error = |differentiator| {
        let found = unknown_force_of_record(&PAPER, &record, "y", "F", differentiator).unwrap();
        (found.settling_samples..3990)
            .map(|n| (found.unknown_force[n] - alpha(n as f64 * h)).abs())
            .fold(0.0, f64::max)
    };
    // (ωh)⁴/30 of the velocity twice, on 10 kN of inertia and damping force: 1e-5 N.
    assert!(error(Differentiator::CentralFourth) < 1e-3);
    // Gain (ωh)²/6 too large per derivative: twice on 10.4 kN of inertia, once on 7.9 kN of
    // damping force, 0.76 N if they add up.
    let park = error(Differentiator::Park);
    assert!(park > 0.3 && park < 0.76, "{park}");
    assert!(error(Differentiator::BackwardEuler) > 10.0 * park);
}

/// Halving the step of Park's formula takes the error of α down by its order and more.
#[test]
fn order_unknown_force_park() {
    let omega = TAU * 2.0;
    let plant = Oscillator {
        mass_kg: 1.0,
        damping: 0.0,
        stiffness: omega * omega,
        load: 0.0,
    };
    let error = |h: f64| {
        let count = (2.0 / h) as usize;
        let y: Vec<f64> = (0..count).map(|n| (omega * n as f64 * h).sin()).collect();
        let found = unknown_force(&plant, &y, &vec![0.0; count], h, Differentiator::Park).unwrap();
        found.unknown_force[found.settling_samples..]
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()))
    };
    let order = (error(2e-3) / error(1e-3)).log2();
    // Second order; at ωh = 0.025 the next term moves the observed order by less than 0.05.
    assert!((order - 2.0).abs() < 0.05, "{order}");
}

#[test]
fn verify_gain_near_nyquist() {
    let rows = gain_table(&PAPER, &[1.0, 50.0], 0.01).unwrap();
    let row = |differentiator, freq: f64| {
        *rows
            .iter()
            .find(|row| row.differentiator == differentiator && row.freq_hz == freq)
            .unwrap()
    };
    // At Nyquist Park's formula is real, (10 + 15 + 6 + 1)/(6h) = 16/(3h): 1.698 of π/h.
    let park = row(Differentiator::Park, 50.0);
    assert!((park.rate_ratio - 16.0 / (3.0 * PI)).abs() < 1e-12);
    assert!((park.rate_phase_deg + 90.0).abs() < 1e-9);
    assert!(park.force_ratio > 2.8 && park.force_ratio < 3.0);
    assert!(park.force_phase_deg.abs() > 170.0);
    // Central differences are blind there: only k is left of m D² + c D + k.
    let central = row(Differentiator::CentralSecond, 50.0);
    assert!(central.rate_ratio < 1e-12);
    let exact = force_gain(&PAPER, RateFormula::Exact, 50.0, 0.01)
        .unwrap()
        .norm();
    assert!((central.force_ratio - PAPER.stiffness / exact).abs() < 1e-9);
    // At 1 Hz all but backward Euler are within 1 %.
    for differentiator in Differentiator::ALL {
        let ratio = row(differentiator, 1.0).force_ratio;
        let tolerance = if differentiator == Differentiator::BackwardEuler {
            0.05
        } else {
            0.01
        };
        assert!(
            (ratio - 1.0).abs() < tolerance,
            "{differentiator:?}: {ratio}"
        );
    }
}

#[test]
fn val_park_leads() {
    let stroke = [4191.30, 7190.19, 10345.57, 11968.35];
    let expected = [0.53, 0.46, 0.44, 0.38];
    for ((stroke, expected), f) in stroke.iter().zip(expected).zip(1..) {
        let share = leads::damping_share(*stroke, PAPER.damping, 0.002, f64::from(f)).unwrap();
        assert!((share - expected).abs() < 5e-3, "{f} Hz: {share}");
    }
    let natural = (PAPER.stiffness / PAPER.mass_kg).sqrt() / TAU;
    let ratio = leads::damping_ratio_of_damped_freq(natural, 2.499).unwrap();
    assert!((ratio - 0.135).abs() < 5e-4);
    let mass = leads::mass_of_natural_freq(PAPER.stiffness, 2.499).unwrap();
    assert!((mass - 33_615.4).abs() < 0.1);
}

/// The share found through a formula gives the stroke back when it is put into the plant.
#[test]
fn verify_damping_share_through_a_formula() {
    let (h, amplitude, freq, stroke) = (0.01, 0.002, 3.0, 10345.57);
    let share = leads::damping_share_through(&PAPER, PARK, stroke, amplitude, freq, h)
        .unwrap()
        .unwrap();
    let true_damping = (1.0 - share) * PAPER.damping;
    let omega = TAU * freq;
    let (y, force): (Vec<f64>, Vec<f64>) = (0..2000)
        .map(|n| {
            let (sin, cos) = (omega * f64::from(n) * h).sin_cos();
            let elastic = (PAPER.stiffness - PAPER.mass_kg * omega * omega) * amplitude * sin;
            (
                amplitude * sin,
                elastic + true_damping * omega * amplitude * cos,
            )
        })
        .unzip();
    let found = unknown_force(&PAPER, &y, &force, h, Differentiator::Park).unwrap();
    let fit = fit_fourier(&found.unknown_force, h, found.settling_samples, freq, 1).unwrap();
    // The grid of the peak-to-peak value misses 4e-5 at most.
    assert!((fit.peak_to_peak() / stroke - 1.0).abs() < 1e-4);
    let impossible = leads::damping_share_through(&PAPER, PARK, 10.0, amplitude, 6.0, h);
    assert_eq!(impossible.unwrap(), None);
    let plain = leads::damping_share(stroke, PAPER.damping, amplitude, freq).unwrap();
    let exact = RateFormula::Exact;
    let through = leads::damping_share_through(&PAPER, exact, stroke, amplitude, freq, h);
    assert!((through.unwrap().unwrap() / plain - 1.0).abs() < 1e-12);
}

/// A small generator of normal numbers: the sum of twelve uniform ones less six.
fn normal(state: &mut u64) -> f64 {
    (0..12)
        .map(|_| {
            *state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1_u64 << 53) as f64
        })
        .sum::<f64>()
        - 6.0
}

/// The standard errors are honest: over 300 noisy records the normalised errors have variance 1.
#[test]
fn verify_standard_errors_are_calibrated() {
    let truth = BeatParameters {
        amplitude: 10.0,
        base_hz: 96.0,
        split_hz: 4.0,
    };
    let (h, mut state) = (0.004, 7_u64);
    let mut squares = [0.0; 4];
    let runs = 300;
    for _ in 0..runs {
        let values: Vec<f64> = (0..1000)
            .map(|n| {
                let t = f64::from(n) * h;
                truth.value(t) - 3.0 + (TAU * 2.0 * t).sin() + normal(&mut state)
            })
            .collect();
        let smooth = fit_fourier(&values, h, 0, 2.0, 1).unwrap();
        let beat = fit_beat(
            &values.iter().map(|v| v + 3.0).collect::<Vec<_>>(),
            h,
            truth,
        )
        .unwrap();
        squares[0] += ((smooth.mean + 3.0) / smooth.mean_error).powi(2);
        let (found, error) = (beat.parameters, beat.standard_error);
        squares[1] += ((found.amplitude - truth.amplitude) / error.amplitude).powi(2);
        squares[2] += ((found.base_hz - truth.base_hz) / error.base_hz).powi(2);
        squares[3] += ((found.split_hz - truth.split_hz) / error.split_hz).powi(2);
    }
    // The part each fit does not model (the beat for one, the sine for the other) is counted as
    // noise, so the errors are stated too large, never too small: variance at most 1. The mean
    // of 300 squares is known to √(2/300) = 8 %; three of these.
    for square in squares {
        let variance = square / f64::from(runs);
        assert!(variance < 1.25, "{squares:?}");
    }
    // The beat's residual is dominated by the noise (1) plus the sine (1/2): about 2/3.
    assert!(squares[1] / f64::from(runs) > 0.45, "{squares:?}");
}

proptest! {
    /// Known Fourier coefficients come back from a noisy record within their standard errors.
    #[test]
    fn prop_fourier_recovered(
        freq in 0.8_f64..7.0,
        mean in -2e4_f64..2e4,
        cosine in proptest::array::uniform3(-5e3_f64..5e3),
        sine in proptest::array::uniform3(-5e3_f64..5e3),
        seed in any::<u64>(),
    ) {
        let (h, noise, mut state) = (0.01, 100.0, seed);
        let values: Vec<f64> = (0..1000).map(|n| {
            let phase = TAU * freq * f64::from(n) * h;
            (1..=3).fold(mean, |sum, k| {
                let order = k as f64;
                sum + cosine[k - 1] * (order * phase).cos() + sine[k - 1] * (order * phase).sin()
            }) + noise * normal(&mut state)
        }).collect();
        let fit = fit_fourier(&values, h, 0, freq, 3).unwrap();
        prop_assert!((fit.mean - mean).abs() < FIVE_SIGMA * fit.mean_error);
        for n in 0..3 {
            prop_assert!((fit.cosine[n] - cosine[n]).abs() < FIVE_SIGMA * fit.cosine_error[n]);
            prop_assert!((fit.sine[n] - sine[n]).abs() < FIVE_SIGMA * fit.sine_error[n]);
            prop_assert!(fit.cosine_error[n] < 10.0, "{}", fit.cosine_error[n]);
        }
    }

    /// A beat at 500 Hz comes back, phases and all, from a start a third of a bin away.
    #[test]
    fn prop_beat_recovered(
        f in 1.0_f64..6.0,
        amplitude in 1e4_f64..5e5,
        slow_phase in -3.0_f64..3.0,
        carrier_phase in -3.0_f64..3.0,
        off in -0.03_f64..0.03,
        seed in any::<u64>(),
    ) {
        let (h, mut state) = (0.002, seed);
        let truth = BeatParameters { amplitude, base_hz: 100.0 - 2.0 * f, split_hz: 2.0 * f };
        let values: Vec<f64> = (0..5000).map(|n| {
            let t = f64::from(n) * h;
            amplitude * (PI * truth.split_hz * t + slow_phase).cos()
                * (PI * 100.0 * t + carrier_phase).cos()
                + 0.05 * amplitude * normal(&mut state)
        }).collect();
        let start = BeatParameters { base_hz: truth.base_hz + off, ..truth };
        let fit = fit_beat(&values, h, start).unwrap();
        let (found, error) = (fit.parameters, fit.standard_error);
        prop_assert!((found.amplitude - amplitude).abs() < FIVE_SIGMA * error.amplitude);
        prop_assert!((found.base_hz - truth.base_hz).abs() < FIVE_SIGMA * error.base_hz);
        prop_assert!((found.split_hz - truth.split_hz).abs() < FIVE_SIGMA * error.split_hz);
        prop_assert!(error.amplitude < 0.01 * amplitude && error.base_hz < 1e-3);
        // The phases are right as a product: the curve is.
        for t in [0.0, 0.37, 5.0, 9.9] {
            let expected = amplitude * (PI * truth.split_hz * t + slow_phase).cos()
                * (PI * 100.0 * t + carrier_phase).cos();
            prop_assert!((fit.value(t) - expected).abs() < 0.03 * amplitude);
        }
    }

    /// The folded beat at 100 Hz, amplitude and split.
    #[test]
    fn prop_folded_beat_recovered(
        f in 1.0_f64..7.0,
        phase in -3.0_f64..3.0,
        off in -0.03_f64..0.03,
        seed in any::<u64>(),
    ) {
        let mut state = seed;
        let values: Vec<f64> = (0..1000).map(|n| {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            1e5 * sign * (TAU * f * f64::from(n) * 0.01 + phase).cos() + 5e3 * normal(&mut state)
        }).collect();
        let fit = fit_folded_beat(&values, 0.01, 6, 50.0 - f + off).unwrap();
        let (found, error) = (fit.parameters, fit.standard_error);
        prop_assert!((found.amplitude - 1e5).abs() < FIVE_SIGMA * error.amplitude);
        prop_assert!((found.split_hz - 2.0 * f).abs() < FIVE_SIGMA * error.split_hz);
        prop_assert!((found.carrier_hz() - 50.0).abs() < 1e-9);
        prop_assert!((fit.value(0.25) - 1e5 * -(TAU * f * 0.25 + phase).cos()).abs() < 3e3);
    }

    /// Beat parameters and line pairs are the same thing, forwards, backwards and as curves.
    #[test]
    fn prop_beat_and_lines_round_trip(
        amplitude in 1.0_f64..1e6, base_hz in 1.0_f64..200.0, split_hz in 0.1_f64..20.0, t in 0.0_f64..3.0,
    ) {
        let beat = BeatParameters { amplitude, base_hz, split_hz };
        let lines = beat.lines();
        let back = lines.beat();
        prop_assert!((back.base_hz - base_hz).abs() < 1e-9);
        prop_assert!((back.split_hz - split_hz).abs() < 1e-9);
        prop_assert!((back.amplitude - amplitude).abs() < 1e-9 * amplitude);
        let sum = lines.line_amplitude
            * ((TAU * lines.lower_hz * t).cos() + (TAU * lines.upper_hz * t).cos());
        prop_assert!((beat.value(t) - sum).abs() < 1e-9 * amplitude);
    }
}

#[test]
fn verify_errors_say_what_is_needed() {
    let message = |error: AlphaError| error.to_string();
    assert_eq!(
        message(
            unknown_force(&PAPER, &[0.0; 9], &[0.0; 8], 0.01, Differentiator::Park).unwrap_err()
        ),
        "force: found 8 values, needed are 9"
    );
    let beat = BeatParameters {
        amplitude: 1.0,
        base_hz: 98.0,
        split_hz: 2.0,
    };
    assert_eq!(
        message(fit_beat(&[0.0; 100], 0.01, beat).unwrap_err()),
        "upper line in Hz is 51, needed is below the Nyquist frequency 50"
    );
    assert_eq!(
        message(fit_fourier(&[0.0; 100], 0.01, 0, 10.0, 5).unwrap_err()),
        "highest harmonic in Hz is 50, needed is below the Nyquist frequency 50"
    );
    assert_eq!(
        message(fit_fourier(&[0.0; 5], 0.01, 3, 1.0, 1).unwrap_err()),
        "Fourier part: found 2 values, needed are 4"
    );
    assert_eq!(
        message(fit_fourier(&[0.0; 100], 0.01, 200, 1.0, 1).unwrap_err()),
        "Fourier part: found 0 values, needed are 4"
    );
    assert_eq!(
        message(fit_fourier(&[1.0; 100], 1e-9, 0, 1.0, 2).unwrap_err()),
        "Fourier part: the data do not determine all 5 coefficients"
    );
    assert_eq!(
        message(fit_folded_beat(&[0.0; 100], 0.01, 0, 20.0).unwrap_err()),
        "line in Hz is 20, needed is between 25 and 50"
    );
    assert_eq!(
        message(fit_fourier(&[f64::NAN; 100], 0.01, 0, 1.0, 1).unwrap_err()),
        "series is NaN, needed is finite"
    );
    let one = &observed()[..1];
    let refused = explain_lines(
        one,
        &PAPER,
        0.002,
        0.01,
        PARK,
        ConverterFault::AlternatingTiming,
    );
    assert_eq!(
        message(refused.unwrap_err()),
        "rows to explain: found 1 values, needed are 2"
    );
    assert_eq!(
        message(leads::damping_ratio_of_damped_freq(2.0, 3.0).unwrap_err()),
        "damped frequency is 3, needed is not above the natural frequency 2"
    );
    let free = simgap_model::Model {
        name: "none".into(),
        ..Default::default()
    };
    assert_eq!(
        message(Oscillator::from_model(&free).unwrap_err()),
        "model \"none\" has 0 degrees of freedom, needed is 1"
    );
    let silent = fit_folded_beat(&[0.0; 100], 0.01, 0, 48.0);
    assert!(matches!(silent, Err(AlphaError::Undetermined { .. })));
}

/// Results come back from JSON as they were.
#[cfg(feature = "serde")]
#[test]
fn verify_results_come_back_from_json() {
    let explanation = explain(PARK, ConverterFault::AlternatingTiming);
    let text = serde_json::to_string(&explanation).unwrap();
    let read: simgap_alpha::Explanation = serde_json::from_str(&text).unwrap();
    assert_eq!(read, explanation);
    let y: Vec<f64> = (0..60).map(|n| (0.3 * f64::from(n)).sin() * 1e-3).collect();
    let force = unknown_force(&PAPER, &y, &[0.0; 60], 0.01, Differentiator::Park).unwrap();
    let text = serde_json::to_string(&force).unwrap();
    let read: simgap_alpha::UnknownForce = serde_json::from_str(&text).unwrap();
    assert_eq!(read, force);
}
