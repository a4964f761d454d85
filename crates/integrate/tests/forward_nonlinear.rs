//! Forces of the motion: manufactured solutions, tangents, and what happens when there is none.
#![allow(clippy::unwrap_used)]

use crate::support::{observed_order, oscillator};
use simgap_integrate::{
    Excitation, GeneralizedAlpha, IntegrateError, Method, Newmark, NonlinearForce, Problem,
    Solution, Tangent, TimeGrid, simulate,
};
use simgap_model::StructuralMatrices;

fn methods() -> Vec<(&'static str, Method, f64)> {
    vec![
        ("park", Method::Park, 2.0),
        ("trapezoidal", Method::Newmark(Newmark::TRAPEZOIDAL), 2.0),
        ("central", Method::Newmark(Newmark::CENTRAL_DIFFERENCE), 2.0),
        (
            "generalized alpha",
            Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(0.6).unwrap()),
            2.0,
        ),
        ("runge-kutta 4", Method::RungeKutta4, 4.0),
    ]
}

/// Two masses coupled by a hardening spring and a quadratic damper, with a stiffness that breathes.
struct Coupling {
    analytic: bool,
}

const CUBIC: f64 = 30.0;
const QUADRATIC: f64 = 0.8;

impl NonlinearForce for Coupling {
    fn force(&self, time_s: f64, x: &[f64], v: &[f64], force: &mut [f64]) {
        let (d, rate) = (x[1] - x[0], v[1] - v[0]);
        let pull = CUBIC * d.powi(3) + QUADRATIC * rate * rate.abs() + time_s.sin() * d;
        force[0] -= pull;
        force[1] += pull;
    }

    fn tangent(&self, time_s: f64, x: &[f64], v: &[f64], tangent: &mut Tangent) -> bool {
        let (d, rate) = (x[1] - x[0], v[1] - v[0]);
        let stiffness = 3.0 * CUBIC * d * d + time_s.sin();
        let damping = 2.0 * QUADRATIC * rate.abs();
        for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
            tangent.stiffness[(i, j)] = sign * stiffness;
            tangent.damping[(i, j)] = sign * damping;
        }
        self.analytic
    }
}

fn two_masses() -> StructuralMatrices {
    StructuralMatrices {
        mass_matrix: faer::mat![[2.0, 0.3], [0.3, 1.0]],
        damping_matrix: faer::mat![[0.4, -0.1], [-0.1, 0.2]],
        stiffness_matrix: faer::mat![[40.0, -10.0], [-10.0, 20.0]],
    }
}

/// The motion that is prescribed: x, ẋ, ẍ.
fn wanted(t: f64) -> [[f64; 2]; 3] {
    [
        [(2.0 * t).sin(), 0.5 * (3.0 * t).cos()],
        [2.0 * (2.0 * t).cos(), -1.5 * (3.0 * t).sin()],
        [-4.0 * (2.0 * t).sin(), -4.5 * (3.0 * t).cos()],
    ]
}

/// Simulates under the force that makes `wanted` the exact solution.
fn manufactured(method: Method, steps: usize, analytic: bool) -> Solution {
    let matrices = two_masses();
    let coupling = Coupling { analytic };
    let force = |t: f64, out: &mut [f64]| {
        let [x, v, a] = wanted(t);
        out.fill(0.0);
        coupling.force(t, &x, &v, out);
        for i in 0..2 {
            for j in 0..2 {
                out[i] += matrices.mass_matrix[(i, j)] * a[j]
                    + matrices.damping_matrix[(i, j)] * v[j]
                    + matrices.stiffness_matrix[(i, j)] * x[j];
            }
        }
    };
    let [x, v, _] = wanted(0.0);
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&x, &v)
        .unwrap()
        .with_excitation(Excitation::Function(&force))
        .unwrap()
        .with_nonlinear_force(&coupling);
    let grid = TimeGrid::new(0.0, 2.0 / steps as f64, steps + 1).unwrap();
    simulate(&problem, &grid, method).unwrap()
}

fn error(solution: &Solution) -> f64 {
    let motion = &solution.motion;
    let mut largest = 0.0_f64;
    for (k, t) in motion.time_s.iter().enumerate() {
        let [x, v, a] = wanted(*t);
        for i in 0..2 {
            largest = largest
                .max((motion.displacement[(i, k)] - x[i]).abs())
                .max((motion.velocity[(i, k)] - v[i]).abs())
                .max((motion.acceleration[(i, k)] - a[i]).abs());
        }
    }
    largest
}

#[test]
fn order_on_a_manufactured_nonlinear_motion() {
    for (name, method, order) in methods() {
        let steps = if order > 2.0 { 400 } else { 1600 };
        let coarse = error(&manufactured(method, steps, true));
        let fine = error(&manufactured(method, 2 * steps, true));
        let found = observed_order(coarse, fine);
        assert!(
            (found - order).abs() < 0.1,
            "{name}: {found}, error {fine:e}"
        );
    }
}

#[test]
fn verify_supplied_and_differenced_tangents_agree() {
    for (name, method, order) in methods() {
        if order > 2.0 {
            continue;
        }
        let supplied = manufactured(method, 200, true);
        let differenced = manufactured(method, 200, false);
        for k in 0..=200 {
            for i in 0..2 {
                let difference =
                    supplied.motion.displacement[(i, k)] - differenced.motion.displacement[(i, k)];
                // Both stop at a residual of 1e-11 of the forces in every one of 200 steps.
                assert!(difference.abs() < 1e-9, "{name}: {difference:e}");
            }
        }
        let per_step = |solution: &Solution| {
            solution.work.newton_iterations as f64 / solution.work.steps as f64
        };
        // A right tangent converges quadratically: few corrections, and hardly more by differences.
        assert!(per_step(&supplied) < 4.0, "{name}: {}", per_step(&supplied));
        assert!(
            per_step(&differenced) < 4.5,
            "{name}: {}",
            per_step(&differenced)
        );
    }
}

#[test]
fn regress_work() {
    let mut table = String::new();
    for (name, method, _) in methods() {
        table += &format!("{name}: {:?}\n", manufactured(method, 200, true).work);
    }
    insta::assert_snapshot!(table);
}

/// Friction so steep that a plain Newton iteration would jump from side to side.
#[test]
fn verify_steep_friction_converges_and_stops_the_mass() {
    let matrices = oscillator(0.0, 0.0);
    let friction =
        |_t: f64, _x: &[f64], v: &[f64], g: &mut [f64]| g[0] = 2.0 * (v[0] / 1e-5).tanh();
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&[0.0], &[1.0])
        .unwrap()
        .with_nonlinear_force(&friction);
    let grid = TimeGrid::new(0.0, 1e-3, 1001).unwrap();
    for method in [
        Method::Park,
        Method::GeneralizedAlpha(GeneralizedAlpha::from_rho_infinity(0.0).unwrap()),
    ] {
        let motion = simulate(&problem, &grid, method).unwrap().motion;
        // Deceleration 2 m/s² from 1 m/s: at rest after 0.5 s and 0.25 m, one step more or less.
        assert!(
            (motion.displacement[(0, 1000)] - 0.25).abs() < 1e-3,
            "{method:?}"
        );
        assert!(motion.velocity[(0, 1000)].abs() < 1e-4, "{method:?}");
    }
}

fn refused(result: Result<Solution, IntegrateError>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn verify_refusals_name_what_was_found() {
    let grid = TimeGrid::new(0.0, 0.1, 200).unwrap();
    let trapezoidal = Method::Newmark(Newmark::TRAPEZOIDAL);
    // A jump leaves the residual nowhere to vanish.
    let jump =
        |_t: f64, _x: &[f64], v: &[f64], g: &mut [f64]| g[0] = if v[0] >= 0.3 { 9.0 } else { -9.0 };
    let base = oscillator(1.0, 0.0);
    let problem = Problem::new(&base)
        .unwrap()
        .with_initial_state(&[0.0], &[0.3])
        .unwrap()
        .with_nonlinear_force(&jump);
    let message = refused(simulate(&problem, &grid, trapezoidal));
    assert!(
        message.starts_with("no equilibrium at t = 0.2 s after 50 newton iterations"),
        "{message}"
    );

    let lost = |_t: f64, _x: &[f64], _v: &[f64], g: &mut [f64]| g[0] = f64::NAN;
    let problem = Problem::new(&base).unwrap().with_nonlinear_force(&lost);
    assert_eq!(
        refused(simulate(&problem, &grid, trapezoidal)),
        "the forces add up to NaN at t = 0.1 s, needed: finite"
    );

    let mut massless = oscillator(1.0, 0.0);
    massless.mass_matrix[(0, 0)] = 0.0;
    let problem = Problem::new(&massless).unwrap();
    let message = refused(simulate(&problem, &grid, trapezoidal));
    assert!(
        message.starts_with("the mass matrix is singular at t = 0 s"),
        "{message}"
    );

    let stiff = oscillator(1e3, 0.0);
    let problem = Problem::new(&stiff)
        .unwrap()
        .with_initial_state(&[1.0], &[0.0])
        .unwrap();
    let message = refused(simulate(&problem, &grid, Method::RungeKutta4));
    assert!(
        message.starts_with("the motion is not finite at t = "),
        "{message}"
    );

    let short = faer::Mat::<f64>::zeros(1, 199);
    let problem = Problem::new(&base)
        .unwrap()
        .with_excitation(Excitation::Sampled(short.as_ref()))
        .unwrap();
    assert_eq!(
        refused(simulate(&problem, &grid, Method::Park)),
        "the sampled force is 1 x 199, needed: 1 x 200"
    );
    let error = Problem::new(&base)
        .unwrap()
        .with_initial_state(&[0.0, 1.0], &[0.0])
        .map(|_| ());
    assert_eq!(
        error.unwrap_err().to_string(),
        "the initial displacement is 2 x 1, needed: 1 x 1"
    );
    let mut broken = oscillator(1.0, 0.0);
    broken.stiffness_matrix[(0, 0)] = f64::INFINITY;
    assert_eq!(
        Problem::new(&broken).map(|_| ()).unwrap_err().to_string(),
        "the stiffness matrix is inf at row 0, column 0, needed: finite"
    );
    assert_eq!(
        TimeGrid::new(0.0, -1.0, 3).unwrap_err().to_string(),
        "time step is -1 s, needed: finite and greater than 0"
    );
}
