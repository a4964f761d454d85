//! The three matrices of a linear structure.

use faer::Mat;

/// Mass, damping and stiffness matrices of a linear structure,
///
/// ```text
/// M ẍ + C ẋ + K x = F
/// ```
///
/// | symbol | field | unit | shape |
/// |---|---|---|---|
/// | M | `mass_matrix` | kg | n × n |
/// | C | `damping_matrix` | N s/m | n × n |
/// | K | `stiffness_matrix` | N/m | n × n |
///
/// For rotation read kg m², N m s/rad and N m/rad.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StructuralMatrices {
    /// M, kg.
    #[serde(with = "crate::serial::rows")]
    pub mass_matrix: Mat<f64>,
    /// C, N s/m.
    #[serde(with = "crate::serial::rows")]
    pub damping_matrix: Mat<f64>,
    /// K, N/m.
    #[serde(with = "crate::serial::rows")]
    pub stiffness_matrix: Mat<f64>,
}

impl StructuralMatrices {
    /// Number of degrees of freedom n.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.mass_matrix.nrows()
    }
}
