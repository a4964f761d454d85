//! Forward simulation of two masses under a sampled force, 60 s at 1 kHz.
//!
//! `cargo bench -p simgap-integrate --bench forward` prints a table of error and ns per sample
//! against a fine reference, then divan's statistics with the number of allocations.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::time::Instant;

use divan::counter::ItemsCount;
use faer::Mat;
use simgap_integrate::exact::{self, ExactPropagator};
use simgap_integrate::{
    AdaptiveTolerance, Excitation, GeneralizedAlpha, Method, Motion, Newmark, Problem, TimeGrid,
    simulate,
};
use simgap_model::StructuralMatrices;

/// Counts allocations: a handful per simulation, none per step.
#[global_allocator]
static ALLOCATIONS: divan::AllocProfiler = divan::AllocProfiler::system();

const SAMPLES: usize = 60_000;
const STEP_S: f64 = 1e-3;

/// Two masses with modes at 2.4 Hz and 21 Hz, damped by some per cent.
fn structure() -> StructuralMatrices {
    StructuralMatrices {
        mass_matrix: faer::mat![[33e3, 0.0], [0.0, 7e3]],
        damping_matrix: faer::mat![[6e4, -1e4], [-1e4, 5e4]],
        stiffness_matrix: faer::mat![[1.8e7, -1e7], [-1e7, 1.2e8]],
    }
}

/// Three tones and a kink in every interval.
fn sampled_force() -> Mat<f64> {
    Mat::from_fn(2, SAMPLES, |i, k| {
        let t = STEP_S * k as f64;
        if i == 1 {
            return 0.0;
        }
        1e4 * (6.3 * t).sin() + 3e3 * (31.0 * t).cos() + 5e2 * (170.0 * t).sin()
    })
}

fn methods() -> Vec<(&'static str, Method)> {
    let adaptive = |relative: f64| {
        Method::DormandPrince(
            AdaptiveTolerance::new(relative, relative * 1e-3, relative * 1e-2).unwrap(),
        )
    };
    vec![
        ("park", Method::Park),
        ("newmark_trapezoidal", Method::Newmark(Newmark::TRAPEZOIDAL)),
        (
            "generalized_alpha_0.8",
            Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(0.8).unwrap()),
        ),
        ("runge_kutta_4", Method::RungeKutta4),
        ("dormand_prince_1e-6", adaptive(1e-6)),
        ("dormand_prince_1e-10", adaptive(1e-10)),
    ]
}

fn names() -> Vec<&'static str> {
    methods().into_iter().map(|(name, _)| name).collect()
}

#[divan::bench(args = names(), sample_count = 10)]
fn linear_two_masses(bencher: divan::Bencher<'_, '_>, name: &str) {
    let method = methods()
        .into_iter()
        .find(|(other, _)| *other == name)
        .unwrap()
        .1;
    let matrices = structure();
    let force = sampled_force();
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_excitation(Excitation::Sampled(force.as_ref()))
        .unwrap();
    let grid = TimeGrid::new(0.0, STEP_S, SAMPLES).unwrap();
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench_local(|| simulate(&problem, &grid, method).unwrap());
}

/// First displacement by exact propagation of the first-order hold.
fn exact(structure: &StructuralMatrices, force: &[f64]) -> Vec<f64> {
    let propagator = ExactPropagator::new(structure, STEP_S).unwrap();
    let excitation = exact::Excitation {
        dof_force: force,
        base_displacement: &[],
        base_velocity: &[],
        base_count: 0,
        sample_count: SAMPLES,
        start_s: 0.0,
        substeps: 1,
    };
    let mut path = Vec::with_capacity(SAMPLES);
    let still = [0.0; 2];
    propagator.march(&[], &excitation, &still, &still, &mut |at| {
        path.push(at.displacement[0])
    });
    path
}

fn interleaved_force() -> Vec<f64> {
    let force = sampled_force();
    (0..SAMPLES)
        .flat_map(|k| [force[(0, k)], force[(1, k)]])
        .collect()
}

#[divan::bench(sample_count = 10)]
fn linear_two_masses_exact(bencher: divan::Bencher<'_, '_>) {
    let (matrices, force) = (structure(), interleaved_force());
    bencher
        .counter(ItemsCount::new(SAMPLES))
        .bench_local(|| exact(&matrices, &force));
}

/// The obvious optimum of one linear step: z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁ written out for four states.
#[divan::bench(sample_count = 10)]
fn dense_four_state_recurrence(bencher: divan::Bencher<'_, '_>) {
    let force = interleaved_force();
    let (phi, gamma) = ([[0.4_f64; 4]; 4], [[0.1_f64; 4]; 4]);
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut z = [1e-3_f64; 4];
        let mut path = Vec::with_capacity(SAMPLES);
        for k in 1..SAMPLES {
            let f = [
                force[2 * k - 2],
                force[2 * k - 1],
                force[2 * k],
                force[2 * k + 1],
            ];
            let mut next = [0.0; 4];
            for i in 0..4 {
                for j in 0..4 {
                    next[i] += phi[i][j] * z[j] + gamma[i][j] * f[j];
                }
            }
            z = next;
            path.push(z[0]);
        }
        path
    });
}

/// Largest error of the first displacement relative to its largest value.
fn error(motion: &Motion, reference: &Motion) -> f64 {
    let (mut error, mut size) = (0.0_f64, 0.0_f64);
    for k in 0..SAMPLES {
        let exact = reference.displacement[(0, k)];
        error = error.max((motion.displacement[(0, k)] - exact).abs());
        size = size.max(exact.abs());
    }
    error / size
}

/// Error and time of every method for one, four and sixteen steps a sample.
fn print_accuracy() {
    let matrices = structure();
    let force = sampled_force();
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_excitation(Excitation::Sampled(force.as_ref()))
        .unwrap();
    let grid = TimeGrid::new(0.0, STEP_S, SAMPLES).unwrap();
    // Its own error is 16⁻⁴ of that of one step a sample.
    let fine = grid.with_substeps(16).unwrap();
    let reference = simulate(&problem, &fine, Method::RungeKutta4)
        .unwrap()
        .motion;
    println!(
        "{:<24} {:>8} {:>12} {:>12} {:>10}",
        "method", "substeps", "error", "ns/sample", "steps"
    );
    let interleaved = interleaved_force();
    let start = Instant::now();
    let path = exact(&matrices, &interleaved);
    let spent = start.elapsed().as_nanos() as f64 / SAMPLES as f64;
    let size = path.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    let worst = (0..SAMPLES)
        .map(|k| (path[k] - reference.displacement[(0, k)]).abs())
        .fold(0.0_f64, f64::max);
    println!(
        "{:<24} {:>8} {:>12.2e} {spent:>12.1} {:>10}",
        "exact",
        1,
        worst / size,
        SAMPLES - 1
    );
    for (name, method) in methods() {
        for substeps in [1, 4, 16] {
            if substeps > 1 && (name.starts_with("dormand") || name.starts_with("runge")) {
                continue;
            }
            let cut = grid.with_substeps(substeps).unwrap();
            let start = Instant::now();
            let solution = simulate(&problem, &cut, method).unwrap();
            let spent = start.elapsed().as_nanos() as f64 / SAMPLES as f64;
            println!(
                "{name:<24} {substeps:>8} {:>12.2e} {spent:>12.1} {:>10}",
                error(&solution.motion, &reference),
                solution.work.steps
            );
        }
    }
}

fn main() {
    print_accuracy();
    divan::main();
}
