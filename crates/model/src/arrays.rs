//! Matrices as `ndarray` arrays, behind the feature `ndarray`.

use faer::Mat;
use ndarray::Array2;

use crate::{ModelError, StructuralMatrices, UndampedModes};

fn array(matrix: &Mat<f64>) -> Array2<f64> {
    Array2::from_shape_fn((matrix.nrows(), matrix.ncols()), |(i, j)| matrix[(i, j)])
}

impl StructuralMatrices {
    /// M, C and K as arrays, n × n each.
    ///
    /// ```
    /// use simgap_model::StructuralMatrices;
    /// let [m, c, k] = [2.0, 0.1, 8.0].map(|value| ndarray::arr2(&[[value]]));
    /// let structure = StructuralMatrices::from_arrays(&m, &c, &k)?;
    /// assert_eq!(structure.to_arrays(), [m, c, k]);
    /// # Ok::<(), simgap_model::ModelError>(())
    /// ```
    #[must_use]
    pub fn to_arrays(&self) -> [Array2<f64>; 3] {
        [
            &self.mass_matrix,
            &self.damping_matrix,
            &self.stiffness_matrix,
        ]
        .map(array)
    }

    /// From M, C and K.
    ///
    /// # Errors
    /// [`ModelError::Shape`] unless all three are square and of one size.
    pub fn from_arrays(
        mass: &Array2<f64>,
        damping: &Array2<f64>,
        stiffness: &Array2<f64>,
    ) -> Result<Self, ModelError> {
        let n = mass.nrows();
        for (place, matrix) in [
            ("mass", mass),
            ("damping", damping),
            ("stiffness", stiffness),
        ] {
            if matrix.dim() != (n, n) {
                return Err(ModelError::Shape {
                    place: format!("{place} matrix"),
                    found: format!("{} x {}", matrix.nrows(), matrix.ncols()),
                    needed: format!("{n} x {n}"),
                });
            }
        }
        let of = |matrix: &Array2<f64>| Mat::from_fn(n, n, |i, j| matrix[(i, j)]);
        Ok(Self {
            mass_matrix: of(mass),
            damping_matrix: of(damping),
            stiffness_matrix: of(stiffness),
        })
    }
}

impl UndampedModes {
    /// Mode shapes as columns, n × n.
    #[must_use]
    pub fn mode_shape_array(&self) -> Array2<f64> {
        array(&self.mode_shape)
    }
}
