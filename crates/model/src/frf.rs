//! Frequency response functions of the linear structure.

use std::f64::consts::TAU;

use faer::{Mat, c64};

use crate::{Form, Model, ModelError, Node, Reading, StructuralMatrices};

/// Which motion a frequency response relates to force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrfKind {
    /// Displacement per force, m/N.
    Receptance,
    /// Velocity per force, m/(N s).
    Mobility,
    /// Acceleration per force, 1/kg.
    Accelerance,
}

/// Frequency response matrix at one frequency,
///
/// ```text
/// receptance   H(ω) = (K + iωC − ω²M)⁻¹
/// mobility     iω H(ω)
/// accelerance  −ω² H(ω)
/// ```
///
/// | symbol | argument | unit | shape |
/// |---|---|---|---|
/// | ω / 2π | `freq_hz` | Hz, finite | scalar |
/// | result | | m/N, m/(N s), 1/kg | n × n, row: motion, column: force |
///
/// # Errors
/// [`ModelError::Singular`] at a frequency where an undamped structure resonates, and at 0 Hz
/// when a mass is free.
///
/// Reference: \[Ewins2000\], chapter 2.
pub fn frequency_response(
    structure: &StructuralMatrices,
    freq_hz: f64,
    kind: FrfKind,
) -> Result<Mat<c64>, ModelError> {
    let n = structure.dof_count();
    let omega = TAU * freq_hz;
    let dynamic_stiffness = Mat::from_fn(n, n, |i, j| {
        c64::new(
            structure.stiffness_matrix[(i, j)] - omega * omega * structure.mass_matrix[(i, j)],
            omega * structure.damping_matrix[(i, j)],
        )
    });
    let receptance =
        crate::dense::inverse_complex(&dynamic_stiffness).ok_or_else(|| ModelError::Singular {
            matrix: "dynamic stiffness matrix",
            context: format!("at {freq_hz} Hz"),
        })?;
    let factor = kind.factor(omega);
    Ok(Mat::from_fn(n, n, |i, j| factor * receptance[(i, j)]))
}

impl FrfKind {
    /// What the motion is of the displacement.
    fn factor(self, omega: f64) -> c64 {
        match self {
            FrfKind::Receptance => c64::new(1.0, 0.0),
            FrfKind::Mobility => c64::new(0.0, omega),
            FrfKind::Accelerance => c64::new(-omega * omega, 0.0),
        }
    }
}

impl Model {
    /// Response of every output to a harmonic force on each mass, about rest and with moving bases held,
    ///
    /// ```text
    /// displacement, velocity, acceleration   the row of its node of H(ω), iω H(ω), −ω² H(ω)
    /// force between a and b                  (k + iωc) (row of a − row of b)
    /// ```
    ///
    /// | symbol | argument | unit | shape |
    /// |---|---|---|---|
    /// | ω / 2π | `freq_hz` | Hz, finite | scalar |
    /// | k, c | | N/m, N s/m of the members between a and b | |
    /// | result | | unit of the output per N | row: output, column: force |
    ///
    /// # Errors
    /// Those of [`frequency_response`] and [`Model::tangent_matrices`].
    pub fn output_response(&self, freq_hz: f64) -> Result<Mat<c64>, ModelError> {
        let structure = self.tangent_matrices()?;
        let receptance = frequency_response(&structure, freq_hz, FrfKind::Receptance)?;
        let omega = TAU * freq_hz;
        let motion = |node: Node, force: usize| {
            node.terms()
                .map(|(i, weight)| weight * receptance[(i, force)])
                .fold(c64::new(0.0, 0.0), |sum, part| sum + part)
        };
        let readings = self.outputs.iter().map(|output| self.reading(output));
        let readings = readings.collect::<Result<Vec<Reading>, _>>()?;
        let response = |reading: &Reading, force: usize| {
            let [a, b] = reading.nodes.map(|node| motion(node, force));
            let of_motion = |kind: FrfKind| kind.factor(omega) * (a - b);
            match reading.form {
                Form::Displacement => of_motion(FrfKind::Receptance),
                Form::Velocity => of_motion(FrfKind::Mobility),
                Form::Acceleration => of_motion(FrfKind::Accelerance),
                Form::Members { stiffness, damping } => {
                    c64::new(stiffness, omega * damping) * (a - b)
                }
                Form::Rate { scale, .. } => of_motion(FrfKind::Mobility) * scale,
                Form::Orifice { gain, .. } => (a - b) * gain,
                Form::Signal => c64::new(0.0, 0.0),
            }
        };
        Ok(Mat::from_fn(
            self.outputs.len(),
            self.dof_count(),
            |row, force| response(&readings[row], force),
        ))
    }
}
