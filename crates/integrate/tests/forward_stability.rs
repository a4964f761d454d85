//! Amplification and dissipation: closed form against the running methods.
#![allow(clippy::unwrap_used)]

use crate::support::oscillator;
use faer::Mat;
use simgap_integrate::inverse::PARK_WEIGHTS;
use simgap_integrate::{
    AdaptiveTolerance, GeneralizedAlpha, Method, Newmark, Problem, TimeGrid, amplification_matrix,
    numerical_dissipation, simulate, spectral_radius,
};

const TRAPEZOIDAL: Method = Method::Newmark(Newmark::TRAPEZOIDAL);

fn rho(value: f64) -> Method {
    Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(value).unwrap())
}

fn hht(alpha: f64) -> Method {
    Method::GeneralizedAlpha(GeneralizedAlpha::hilber_hughes_taylor(alpha).unwrap())
}

fn unconditional() -> Vec<(&'static str, Method)> {
    vec![
        ("park", Method::Park),
        ("trapezoidal", TRAPEZOIDAL),
        (
            "newmark .3025 .6",
            Method::Newmark(Newmark::new(0.3025, 0.6).unwrap()),
        ),
        ("gen-alpha 0", rho(0.0)),
        ("gen-alpha 0.5", rho(0.5)),
        ("gen-alpha 0.8", rho(0.8)),
        ("gen-alpha 1", rho(1.0)),
        ("hht 0.1", hht(0.1)),
        ("hht 0.3", hht(0.3)),
    ]
}

fn radius(method: Method, step_angle: f64, damping_ratio: f64) -> f64 {
    spectral_radius(&amplification_matrix(method, step_angle, damping_ratio).unwrap()).unwrap()
}

/// Roots that coincide (generalized-alpha at high frequency: two, or three at ρ∞ = 0) are computed
/// to the square or cube root of the rounding: 1e-8, 6e-6.
const ROOT_ROUNDING: f64 = 1e-5;

#[test]
fn verify_unconditional_stability_from_slow_to_stiff() {
    for (name, method) in unconditional() {
        for damping_ratio in [0.0, 0.02, 0.3, 1.0, 3.0] {
            for eighth in -16..=32 {
                let step_angle = 10f64.powf(f64::from(eighth) / 8.0);
                let found = radius(method, step_angle, damping_ratio);
                assert!(
                    found < 1.0 + ROOT_ROUNDING,
                    "{name} {step_angle} {damping_ratio}: {found}"
                );
            }
        }
    }
}

#[test]
fn verify_dissipation_at_infinite_frequency() {
    for named in [0.0, 0.2, 0.5, 0.8, 1.0] {
        // Splitting of the coincident roots falls as 1/Ω (two) or Ω^(−2/3) (three): 2e-3 at 1e4.
        let found = radius(rho(named), 1e4, 0.0);
        assert!((found - named).abs() < 5e-3, "rho {named}: {found}");
    }
    for alpha in [0.0, 0.1, 0.3] {
        let found = radius(hht(alpha), 1e4, 0.0);
        assert!(
            (found - (1.0 - alpha) / (1.0 + alpha)).abs() < 5e-3,
            "alpha {alpha}: {found}"
        );
    }
    for exponent in -2..=4 {
        let found = radius(TRAPEZOIDAL, 10f64.powi(exponent), 0.0);
        assert!((found - 1.0).abs() < ROOT_ROUNDING, "1e{exponent}: {found}");
    }
    // Park: 6 Ω |z|³ = 1 at high frequency, so the radius goes to zero as (6Ω)^(−1/3).
    for step_angle in [1e3, 1e4, 1e6] {
        let ratio = radius(Method::Park, step_angle, 0.0) * (6.0_f64 * step_angle).cbrt();
        // Next term: 2 |z| relative, from the weight 6 beside the weight 1, halved by phase.
        let bound = 3.0 / (6.0_f64 * step_angle).cbrt();
        assert!((ratio - 1.0).abs() < bound, "{step_angle}: {ratio}");
    }
}

#[test]
fn verify_limits_of_conditional_methods() {
    let newmark = Method::Newmark;
    for (name, method, limit) in [
        (
            "linear acceleration",
            newmark(Newmark::LINEAR_ACCELERATION),
            12.0_f64.sqrt(),
        ),
        ("fox-goodwin", newmark(Newmark::FOX_GOODWIN), 6.0_f64.sqrt()),
        (
            "central difference",
            newmark(Newmark::CENTRAL_DIFFERENCE),
            2.0,
        ),
        ("runge-kutta 4", Method::RungeKutta4, 8.0_f64.sqrt()),
    ] {
        assert!(
            radius(method, 0.999 * limit, 0.0) < 1.0 + ROOT_ROUNDING,
            "{name}"
        );
        assert!(radius(method, 1.001 * limit, 0.0) > 1.001, "{name}");
    }
}

/// Leading terms: (method, period elongation c Ω^p, damping ratio d Ω^q).
#[test]
fn verify_leading_terms_of_dispersion_and_damping() {
    let newmark = Method::Newmark;
    let tolerance = AdaptiveTolerance::new(1e-6, 1.0, 1.0).unwrap();
    for (name, method, (c, p), (d, q)) in [
        ("park", Method::Park, (1.0 / 6.0, 2), (1.0 / 12.0, 5)),
        ("trapezoidal", TRAPEZOIDAL, (1.0 / 12.0, 2), (0.0, 1)),
        (
            "linear",
            newmark(Newmark::LINEAR_ACCELERATION),
            (1.0 / 24.0, 2),
            (0.0, 1),
        ),
        (
            "fox-goodwin",
            newmark(Newmark::FOX_GOODWIN),
            (-1.0 / 480.0, 4),
            (0.0, 1),
        ),
        (
            "central",
            newmark(Newmark::CENTRAL_DIFFERENCE),
            (-1.0 / 24.0, 2),
            (0.0, 1),
        ),
        (
            "runge-kutta",
            Method::RungeKutta4,
            (1.0 / 120.0, 4),
            (1.0 / 144.0, 5),
        ),
        (
            "dormand-prince",
            Method::DormandPrince(tolerance),
            (-1.0 / 2100.0, 6),
            (1.0 / 3600.0, 5),
        ),
    ] {
        let step_angle: f64 = 0.2;
        let found = numerical_dissipation(method, step_angle).unwrap();
        // The next terms are of relative size Ω² times at most two.
        let slack = 2.0 * step_angle * step_angle;
        let elongation = found.period_elongation / (c * step_angle.powi(p));
        assert!(
            (elongation - 1.0).abs() < slack,
            "{name}: elongation {elongation}"
        );
        if d == 0.0 {
            assert!(found.damping_ratio.abs() < 1e-13, "{name}: {found:?}");
        } else {
            let damping = found.damping_ratio / (d * step_angle.powi(q));
            assert!((damping - 1.0).abs() < slack, "{name}: damping {damping}");
        }
    }
}

/// Every eigenvalue z of Park's matrix solves p(1/z) = Ω λ with λ² + 2ζλ + 1 = 0: the matrix and the
/// method's own characteristic equation agree.
#[test]
fn verify_park_roots_solve_the_characteristic_equation() {
    for (step_angle, zeta) in [(0.3, 0.2), (2.0, 0.0), (40.0, 0.7)] {
        let matrix = amplification_matrix(Method::Park, step_angle, zeta).unwrap();
        for z in matrix.eigenvalues().unwrap() {
            let formula: faer::c64 = (0..4)
                .map(|k| PARK_WEIGHTS[k] * z.powi(-(k as i32)))
                .sum::<faer::c64>()
                / step_angle;
            let residual = formula * formula + 2.0 * zeta * formula + 1.0;
            // z⁻³ multiplies the rounding of small roots.
            let size = 1.0 + z.norm().powi(-6) / step_angle.powi(2);
            assert!(
                residual.norm() < 1e-12 * size,
                "{step_angle} {z}: {residual}"
            );
        }
    }
}

/// Motion of the running method in free vibration, ω = Ω, h = 1, scaled (x, v/ω).
fn run(method: Method, step_angle: f64, zeta: f64, steps: usize) -> Vec<[f64; 2]> {
    let matrices = oscillator(step_angle, zeta);
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&[1.0], &[0.4 * step_angle])
        .unwrap();
    let grid = TimeGrid::new(0.0, 1.0, steps + 1).unwrap();
    let motion = simulate(&problem, &grid, method).unwrap().motion;
    (0..=steps)
        .map(|k| {
            [
                motion.displacement[(0, k)],
                motion.velocity[(0, k)] / step_angle,
            ]
        })
        .collect()
}

#[test]
fn verify_running_methods_follow_their_matrix() {
    let mut methods = unconditional();
    methods.push(("runge-kutta", Method::RungeKutta4));
    methods.push(("linear", Method::Newmark(Newmark::LINEAR_ACCELERATION)));
    let steps = 60;
    for (name, method) in methods {
        for step_angle in [0.01, 0.3, 2.0, 50.0, 1e4] {
            for zeta in [0.0, 0.1, 1.0] {
                let matrix = amplification_matrix(method, step_angle, zeta).unwrap();
                if spectral_radius(&matrix).unwrap() > 1.0 + ROOT_ROUNDING {
                    continue;
                }
                let found = run(method, step_angle, zeta, steps);
                let velocity_row = if matrix.nrows() == 6 { 3 } else { 1 };
                // Park's past is that of its starting steps.
                let first = if matrix.nrows() == 6 { 2 } else { 0 };
                let mut z = Mat::from_fn(matrix.nrows(), 1, |i, _| match matrix.nrows() {
                    6 => found[2 - i % 3][i / 3],
                    _ if i < 2 => found[0][i],
                    _ => -2.0 * zeta * found[0][1] - found[0][0],
                });
                let mut size = 1.0_f64;
                for k in first..=steps {
                    size = size.max(z.norm_max());
                    let error = (z[(0, 0)] - found[k][0]).abs()
                        + (z[(velocity_row, 0)] - found[k][1]).abs();
                    // The predictor of x holds Ω v, in Newmark's family also Ω² a: their rounding
                    // stays in x; over the steps done.
                    let largest = step_angle.powi(if matrix.nrows() == 6 { 1 } else { 2 });
                    let bound = 1e-15 * (10.0 + largest) * size * (1.0 + k as f64);
                    assert!(
                        error < bound,
                        "{name} {step_angle} {zeta} step {k}: {error:e}"
                    );
                    z = &matrix * &z;
                }
            }
        }
    }
}

/// Amplitude and phase per step measured from the running method. Three neighbours of
/// x_n = c rⁿ cos(nφ + ψ) give r² = (x_n² − x_(n−1) x_(n+1)) / (x_(n−1)² − x_(n−2) x_n).
#[test]
fn verify_measured_decay_and_period() {
    for (name, method) in unconditional() {
        for step_angle in [0.2, 0.5] {
            let expected = numerical_dissipation(method, step_angle).unwrap();
            let x: Vec<f64> = run(method, step_angle, 0.0, 60)
                .iter()
                .map(|z| z[0])
                .collect();
            let n = 58;
            let square =
                (x[n] * x[n] - x[n - 1] * x[n + 1]) / (x[n - 1] * x[n - 1] - x[n - 2] * x[n]);
            let angle = ((x[n + 1] + square * x[n - 1]) / (2.0 * x[n] * square.sqrt())).acos();
            let damping = -0.5 * square.ln() / angle;
            let elongation = step_angle / angle - 1.0;
            // Spurious roots have died to below 1e-9 after 58 steps (radius < 0.7).
            assert!(
                (damping - expected.damping_ratio).abs() < 1e-8,
                "{name} {damping}"
            );
            assert!(
                (elongation - expected.period_elongation).abs() < 1e-8,
                "{name} {elongation}"
            );
        }
    }
}

#[test]
fn verify_refusals_name_what_was_found() {
    assert_eq!(
        spectral_radius(&faer::mat![[f64::NAN]])
            .unwrap_err()
            .to_string(),
        "the eigenvalues of a 1 x 1 matrix did not converge, needed: finite entries of moderate size"
    );
    assert_eq!(
        amplification_matrix(Method::Park, 0.0, 0.0)
            .unwrap_err()
            .to_string(),
        "step_angle is 0, needed: finite and greater than 0"
    );
}

#[test]
fn regress_spectral_radius_from_slow_to_stiff() {
    let mut table = format!("{:<18}", "omega h");
    let exponents = [-2, -1, 0, 1, 2, 3, 4];
    for exponent in exponents {
        table += &format!("  1e{exponent:<5}");
    }
    for (name, method) in unconditional() {
        table += &format!("\n{name:<18}");
        for exponent in exponents {
            table += &format!(" {:8.4}", radius(method, 10f64.powi(exponent), 0.0));
        }
    }
    insta::assert_snapshot!(table);
}
