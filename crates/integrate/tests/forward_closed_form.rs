//! Forward methods against closed forms: order of convergence and size of the error.
#![allow(clippy::unwrap_used)]

use crate::support::{free_decay, observed_order, oscillator};
use faer::Mat;
use simgap_integrate::{
    Excitation, GeneralizedAlpha, Method, Motion, Newmark, Problem, TimeGrid, simulate,
};

/// All fixed-step methods with their order.
fn methods() -> Vec<(&'static str, Method, f64)> {
    let rho = |value| Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(value).unwrap());
    let hht = GeneralizedAlpha::hilber_hughes_taylor(0.1).unwrap();
    vec![
        ("park", Method::Park, 2.0),
        ("trapezoidal", Method::Newmark(Newmark::TRAPEZOIDAL), 2.0),
        (
            "linear acceleration",
            Method::Newmark(Newmark::LINEAR_ACCELERATION),
            2.0,
        ),
        (
            "central difference",
            Method::Newmark(Newmark::CENTRAL_DIFFERENCE),
            2.0,
        ),
        (
            "newmark gamma 0.6",
            Method::Newmark(Newmark::new(0.3025, 0.6).unwrap()),
            1.0,
        ),
        ("generalized alpha 0", rho(0.0), 2.0),
        ("generalized alpha 0.5", rho(0.5), 2.0),
        ("generalized alpha 1", rho(1.0), 2.0),
        ("hht 0.1", Method::GeneralizedAlpha(hht), 2.0),
        ("runge-kutta 4", Method::RungeKutta4, 4.0),
    ]
}

/// Largest errors of x, v, a against closed forms (x, v, a)(t), each relative to its largest value.
fn errors(motion: &Motion, exact: &dyn Fn(f64) -> (f64, f64, f64)) -> [f64; 3] {
    let (mut error, mut size) = ([0.0_f64; 3], [0.0_f64; 3]);
    for (k, t) in motion.time_s.iter().enumerate() {
        let (x, v, a) = exact(*t);
        let found = [
            motion.displacement[(0, k)],
            motion.velocity[(0, k)],
            motion.acceleration[(0, k)],
        ];
        for (j, value) in [x, v, a].into_iter().enumerate() {
            error[j] = error[j].max((found[j] - value).abs());
            size[j] = size[j].max(value.abs());
        }
    }
    std::array::from_fn(|j| error[j] / size[j])
}

const OMEGA: f64 = 15.0;

#[test]
fn order_on_free_decay_under_over_and_critically_damped() {
    for zeta in [0.0, 0.05, 0.3, 1.0, 2.5] {
        let matrices = oscillator(OMEGA, zeta);
        let problem = Problem::new(&matrices)
            .unwrap()
            .with_initial_state(&[0.02], &[-0.4])
            .unwrap();
        let exact = |t: f64| {
            let (x, v) = free_decay(OMEGA, zeta, 0.02, -0.4, t);
            (x, v, -2.0 * zeta * OMEGA * v - OMEGA * OMEGA * x)
        };
        for (name, method, order) in methods() {
            let run = |steps: usize| {
                let grid = TimeGrid::new(0.0, 1.0 / steps as f64, steps + 1).unwrap();
                errors(&simulate(&problem, &grid, method).unwrap().motion, &exact)
            };
            // Fine enough for the leading term to rule, coarse enough to stay clear of rounding.
            let steps = if order > 2.0 { 400 } else { 6400 };
            let (coarse, fine) = (run(steps), run(2 * steps));
            for j in 0..3 {
                let found = observed_order(coarse[j], fine[j]);
                assert!(
                    (found - order).abs() < 0.15,
                    "{name}, zeta {zeta}, {j}: {found}"
                );
            }
        }
    }
}

/// Force cos(w t) from rest: particular solution and the free decay that cancels it at t = 0.
fn harmonic_response(zeta: f64, drive: f64, t: f64) -> (f64, f64, f64) {
    let real = OMEGA * OMEGA - drive * drive;
    let imaginary = 2.0 * zeta * OMEGA * drive;
    let square = real * real + imaginary * imaginary;
    let (a, b) = (real / square, imaginary / square);
    let steady = (
        a * (drive * t).cos() + b * (drive * t).sin(),
        drive * (b * (drive * t).cos() - a * (drive * t).sin()),
    );
    let free = free_decay(OMEGA, zeta, -a, -b * drive, t);
    let (x, v) = (steady.0 + free.0, steady.1 + free.1);
    (
        x,
        v,
        (drive * t).cos() - 2.0 * zeta * OMEGA * v - OMEGA * OMEGA * x,
    )
}

#[test]
fn order_on_harmonic_response_with_closure_and_with_sampled_force() {
    let zeta = 0.1;
    let drive = 9.0;
    let matrices = oscillator(OMEGA, zeta);
    let exact = |t: f64| harmonic_response(zeta, drive, t);
    let function = |t: f64, force: &mut [f64]| force[0] = (drive * t).cos();
    for (name, method, order) in methods() {
        let run = |steps: usize, sampled: bool| {
            let h = 1.0 / steps as f64;
            let samples = Mat::from_fn(1, steps + 1, |_, k| (drive * h * k as f64).cos());
            let excitation = if sampled {
                Excitation::Sampled(samples.as_ref())
            } else {
                Excitation::Function(&function)
            };
            let problem = Problem::new(&matrices)
                .unwrap()
                .with_excitation(excitation)
                .unwrap();
            let grid = TimeGrid::new(0.0, h, steps + 1).unwrap();
            errors(&simulate(&problem, &grid, method).unwrap().motion, &exact)
        };
        for sampled in [false, true] {
            // Straight lines between samples are themselves only of order two.
            let expected = if sampled { order.min(2.0) } else { order };
            let (coarse, fine) = (run(400, sampled), run(800, sampled));
            for j in 0..3 {
                let found = observed_order(coarse[j], fine[j]);
                assert!(
                    (found - expected).abs() < 0.15,
                    "{name}, sampled {sampled}, {j}: {found}"
                );
            }
        }
    }
}

/// A step of force: the rest position is K⁻¹ f, the way there the free decay from minus that.
#[test]
fn verify_step_response() {
    for zeta in [0.3_f64, 1.0, 1.7] {
        let matrices = oscillator(OMEGA, zeta);
        let push = |_t: f64, force: &mut [f64]| force[0] = 7.0;
        let problem = Problem::new(&matrices)
            .unwrap()
            .with_excitation(Excitation::Function(&push))
            .unwrap();
        let rest = 7.0 / (OMEGA * OMEGA);
        let exact = |t: f64| {
            let (x, v) = free_decay(OMEGA, zeta, -rest, 0.0, t);
            (x + rest, v, -2.0 * zeta * OMEGA * v - OMEGA * OMEGA * x)
        };
        for (name, method, order) in methods() {
            let grid = TimeGrid::new(0.0, 1e-3, 2001).unwrap();
            let found = errors(&simulate(&problem, &grid, method).unwrap().motion, &exact);
            // (Fastest rate times h) to the order, with error constants below three.
            let rate = OMEGA * (zeta + f64::max(zeta * zeta - 1.0, 0.0).sqrt()).max(1.0);
            let bound = 3.0 * (rate * 1e-3).powf(order);
            assert!(
                found.iter().all(|e| *e < bound),
                "{name}, zeta {zeta}: {found:?}"
            );
        }
    }
}

/// Cutting an interval into substeps is the same as a finer grid.
#[test]
fn verify_substeps_are_a_finer_grid() {
    let matrices = oscillator(OMEGA, 0.1);
    let wave = |t: f64| (9.0 * t).sin();
    let coarse_force = Mat::from_fn(1, 51, |_, k| wave(0.02 * k as f64));
    // The straight lines of the coarse samples, sampled finely.
    let fine_force = Mat::from_fn(1, 201, |_, k| {
        let (whole, part) = (k / 4, (k % 4) as f64 / 4.0);
        let next = (whole + 1).min(50);
        coarse_force[(0, whole)] * (1.0 - part) + coarse_force[(0, next)] * part
    });
    let base = Problem::new(&matrices).unwrap();
    let coarse_problem = base
        .clone()
        .with_excitation(Excitation::Sampled(coarse_force.as_ref()))
        .unwrap();
    let fine_problem = base
        .with_excitation(Excitation::Sampled(fine_force.as_ref()))
        .unwrap();
    let coarse_grid = TimeGrid::new(0.0, 0.02, 51)
        .unwrap()
        .with_substeps(4)
        .unwrap();
    let fine_grid = TimeGrid::new(0.0, 0.005, 201).unwrap();
    for (name, method, _) in methods() {
        let coarse = simulate(&coarse_problem, &coarse_grid, method).unwrap();
        let fine = simulate(&fine_problem, &fine_grid, method).unwrap();
        for k in 0..51 {
            let difference =
                coarse.motion.displacement[(0, k)] - fine.motion.displacement[(0, 4 * k)];
            assert!(
                difference.abs() < 1e-14,
                "{name}, sample {k}: {difference:e}"
            );
        }
    }
}

/// Two masses started in a mode move as one oscillator each.
#[test]
fn verify_two_masses_keep_their_modes() {
    let matrices = simgap_model::StructuralMatrices {
        mass_matrix: faer::mat![[2.0, 0.0], [0.0, 2.0]],
        damping_matrix: faer::mat![[0.0, 0.0], [0.0, 0.0]],
        stiffness_matrix: faer::mat![[300.0, -100.0], [-100.0, 300.0]],
    };
    for (shape, square) in [([1.0, 1.0], 100.0), ([1.0, -1.0], 200.0_f64)] {
        let problem = Problem::new(&matrices)
            .unwrap()
            .with_initial_state(&shape, &[0.0, 0.0])
            .unwrap();
        let grid = TimeGrid::new(0.0, 1e-3, 501).unwrap();
        for (name, method, order) in methods() {
            let motion = simulate(&problem, &grid, method).unwrap().motion;
            let bound = if order == 1.0 { 1e-2 } else { 1e-3 };
            for k in 0..501 {
                let exact = (square.sqrt() * motion.time_s[k]).cos();
                assert!(
                    (motion.displacement[(0, k)] - exact).abs() < bound,
                    "{name}"
                );
                let mirror = motion.displacement[(1, k)] * shape[1] - motion.displacement[(0, k)];
                assert!(mirror.abs() < 1e-12, "{name}");
            }
        }
    }
}
