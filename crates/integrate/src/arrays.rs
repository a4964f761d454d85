//! Motions as `ndarray` arrays, behind the feature `ndarray`.

use faer::Mat;
use ndarray::{Array2, ArrayView1};

use crate::Motion;
use crate::inverse::{DerivedMotion, SmoothedMotion};

impl Motion {
    /// Displacement, velocity and acceleration (m, m/s, m/s²) as arrays, samples × degrees of freedom each: a column is
    /// one degree of freedom.
    ///
    /// ```
    /// use simgap_integrate::{Method, Problem, TimeGrid, simulate};
    /// use simgap_model::StructuralMatrices;
    /// let one = ndarray::arr2(&[[1.0]]);
    /// let matrices = StructuralMatrices::from_arrays(&one, &(0.0 * &one), &(100.0 * &one))?;
    /// let problem = Problem::new(&matrices)?.with_initial_state(&[0.01], &[0.0])?;
    /// let solution = simulate(&problem, &TimeGrid::new(0.0, 1e-3, 1001)?, Method::RungeKutta4)?;
    /// let [displacement, ..] = solution.motion.to_arrays();
    /// assert_eq!(displacement.dim(), (1001, 1));
    /// assert!((displacement[(1000, 0)] - 0.01 * 10.0_f64.cos()).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn to_arrays(&self) -> [Array2<f64>; 3] {
        let array = |matrix: &Mat<f64>| {
            Array2::from_shape_fn((matrix.ncols(), matrix.nrows()), |(k, i)| matrix[(i, k)])
        };
        [&self.displacement, &self.velocity, &self.acceleration].map(array)
    }

    /// Time of each sample, s; nothing is copied.
    #[must_use]
    pub fn time_s_view(&self) -> ArrayView1<'_, f64> {
        ArrayView1::from(&self.time_s)
    }
}

impl DerivedMotion {
    /// Velocity, m/s, and acceleration, m/s², one per sample; nothing is copied.
    #[must_use]
    pub fn views(&self) -> [ArrayView1<'_, f64>; 2] {
        [&self.velocity, &self.acceleration].map(ArrayView1::from)
    }
}

impl SmoothedMotion {
    /// Displacement, m, velocity, m/s, and acceleration, m/s², one per sample; nothing is copied.
    #[must_use]
    pub fn views(&self) -> [ArrayView1<'_, f64>; 3] {
        let all = [&self.displacement, &self.velocity, &self.acceleration];
        all.map(ArrayView1::from)
    }
}
