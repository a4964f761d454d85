//! Frequency response functions of the linear structure.

use std::f64::consts::TAU;

use faer::{Mat, c64};

use crate::{ModelError, StructuralMatrices};

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
    let factor = match kind {
        FrfKind::Receptance => c64::new(1.0, 0.0),
        FrfKind::Mobility => c64::new(0.0, omega),
        FrfKind::Accelerance => c64::new(-omega * omega, 0.0),
    };
    Ok(Mat::from_fn(n, n, |i, j| factor * receptance[(i, j)]))
}
