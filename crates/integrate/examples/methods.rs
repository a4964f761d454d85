//! One free decay, three methods, and how far each is from the closed form.
//!
//! ```sh
//! cargo run -p simgap-integrate --example methods
//! ```
#![allow(clippy::print_stdout)]

use faer::mat;
use simgap_integrate::{Method, Newmark, Problem, TimeGrid, simulate};
use simgap_model::StructuralMatrices;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1 kg on 100 N/m, released 10 mm from rest: x = 0.01 cos(10 t).
    let matrices = StructuralMatrices {
        mass_matrix: mat![[1.0]],
        damping_matrix: mat![[0.0]],
        stiffness_matrix: mat![[100.0]],
    };
    let problem = Problem::new(&matrices)?.with_initial_state(&[0.01], &[0.0])?;
    let grid = TimeGrid::new(0.0, 0.01, 201)?;
    let newmark = Method::Newmark(Newmark::TRAPEZOIDAL);
    for (name, method) in [
        ("Park", Method::Park),
        ("Newmark", newmark),
        ("Runge-Kutta", Method::RungeKutta4),
    ] {
        let motion = simulate(&problem, &grid, method)?.motion;
        let error = motion.displacement[(0, 200)] - 0.01 * 20.0_f64.cos();
        println!("{name:12} {:9.3e} m off after 2 s", error.abs());
    }
    Ok(())
}
