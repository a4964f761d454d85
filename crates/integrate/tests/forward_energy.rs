//! Energy and superposition of random structures with three degrees of freedom.
#![allow(clippy::unwrap_used)]

use faer::Mat;
use proptest::prelude::*;
use simgap_integrate::{
    Excitation, GeneralizedAlpha, Method, Newmark, Problem, TimeGrid, simulate,
};

const TRAPEZOIDAL: Method = Method::Newmark(Newmark::TRAPEZOIDAL);

fn rho(value: f64) -> Method {
    Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(value).unwrap())
}

fn hht(alpha: f64) -> Method {
    Method::GeneralizedAlpha(GeneralizedAlpha::hilber_hughes_taylor(alpha).unwrap())
}

/// Kinetic and elastic energy of a sample.
fn energy(
    matrices: &simgap_model::StructuralMatrices,
    motion: &simgap_integrate::Motion,
    k: usize,
) -> f64 {
    let x = motion.displacement.col(k).as_mat();
    let v = motion.velocity.col(k).as_mat();
    0.5 * ((v.transpose() * &matrices.mass_matrix * v)[(0, 0)]
        + (x.transpose() * &matrices.stiffness_matrix * x)[(0, 0)])
}

/// Symmetric positive definite, from the entries of a factor.
fn positive(entries: &[f64], floor: f64) -> Mat<f64> {
    let factor = Mat::from_fn(3, 3, |i, j| entries[3 * i + j]);
    let mut matrix = &factor * factor.transpose();
    for i in 0..3 {
        matrix[(i, i)] += floor;
    }
    matrix
}

fn structure(entries: &[f64]) -> simgap_model::StructuralMatrices {
    simgap_model::StructuralMatrices {
        mass_matrix: positive(&entries[..9], 1.0),
        damping_matrix: Mat::zeros(3, 3),
        stiffness_matrix: positive(&entries[9..], 0.5),
    }
}

/// Rounding of 300 steps with ω h up to about 20, where Ω² a is 400 times the state it adds to.
const KEPT_ENERGY: f64 = 1e-10;

proptest! {
    // No file of failures is kept: what it holds belongs into a test of its own.
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn prop_trapezoidal_rule_keeps_energy(
        entries in proptest::collection::vec(-1.0..1.0_f64, 18),
        x in proptest::collection::vec(-1.0..1.0_f64, 3),
        v in proptest::collection::vec(0.1..1.0_f64, 3),
        h in 0.01..5.0_f64,
    ) {
        let matrices = structure(&entries);
        let problem = Problem::new(&matrices).unwrap().with_initial_state(&x, &v).unwrap();
        let grid = TimeGrid::new(0.0, h, 301).unwrap();
        let kept = simulate(&problem, &grid, TRAPEZOIDAL).unwrap().motion;
        let start = energy(&matrices, &kept, 0);
        for k in 0..301 {
            let change = (energy(&matrices, &kept, k) - start).abs();
            prop_assert!(change <= KEPT_ENERGY * start, "{change:e} of {start:e}");
        }
    }

    /// The lowest ω is at least √(0.5/10), so that ω h ≥ 4 in every mode: nothing is resolved, and
    /// all of it dies, by 0.85 a step at least, squared, over 300 steps.
    #[test]
    fn prop_what_is_not_resolved_dies(
        entries in proptest::collection::vec(-1.0..1.0_f64, 18),
        v in proptest::collection::vec(0.1..1.0_f64, 3),
        h in 20.0..1000.0_f64,
    ) {
        let matrices = structure(&entries);
        let problem = Problem::new(&matrices).unwrap().with_initial_state(&[0.0; 3], &v).unwrap();
        let grid = TimeGrid::new(0.0, h, 301).unwrap();
        for method in [Method::Park, rho(0.2), hht(0.2)] {
            let motion = simulate(&problem, &grid, method).unwrap().motion;
            let left = energy(&matrices, &motion, 300) / energy(&matrices, &motion, 0);
            prop_assert!(left < 0.85_f64.powi(600), "{method:?}: {left:e}");
        }
    }

    #[test]
    fn prop_linear_problems_superpose(
        entries in proptest::collection::vec(-1.0..1.0_f64, 18),
        first in proptest::collection::vec(-1.0..1.0_f64, 60),
        second in proptest::collection::vec(-1.0..1.0_f64, 60),
        scale in -2.0..2.0_f64,
    ) {
        let matrices = structure(&entries);
        let force = |values: &dyn Fn(usize) -> f64| Mat::from_fn(3, 20, |i, k| values(3 * k + i));
        let a = force(&|at| first[at]);
        let b = force(&|at| second[at]);
        let both = force(&|at| first[at] + scale * second[at]);
        let grid = TimeGrid::new(0.0, 0.05, 20).unwrap();
        for method in [Method::Park, TRAPEZOIDAL, rho(0.3), Method::RungeKutta4] {
            let respond = |samples: &Mat<f64>| {
                let problem = Problem::new(&matrices)
                    .unwrap()
                    .with_excitation(Excitation::Sampled(samples.as_ref()))
                    .unwrap();
                simulate(&problem, &grid, method).unwrap().motion.displacement
            };
            let error = respond(&both) - respond(&a) - faer::Scale(scale) * respond(&b);
            prop_assert!(error.norm_max() < 1e-13, "{method:?}");
        }
    }
}
