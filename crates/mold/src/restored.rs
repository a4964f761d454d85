//! Stiffnesses that put the two modes exactly where they are wanted.

use std::f64::consts::TAU;

use crate::error::positive;
use crate::{MoldError, TwoDof};

impl TwoDof {
    /// The same masses, dampers and k₁, with k_leaf and k₂ solved for two given undamped modes.
    ///
    /// With λ = (2πf)² of the wanted modes, S = λ₁ + λ₂ and P = λ₁ λ₂, the trace and determinant
    /// of M⁻¹K give, for a = k₁ + k_leaf and b = k_leaf + k₂,
    ///
    /// ```text
    /// a/m₁ + b/m₂ = S                                                     (1)
    /// a b − (a − k₁)² = P m₁ m₂                                           (2)
    /// (1 + m₂/m₁) a² − (2 k₁ + m₂ S) a + k₁² + P m₁ m₂ = 0                (3)  (1) in (2)
    /// ```
    ///
    /// Of the two roots of (3) the one with positive k_leaf and k₂ is taken; for the paper's
    /// values there is exactly one. Valid for 0 < lower < upper.
    ///
    /// ```
    /// use simgap_mold::TwoDof;
    /// let restored = TwoDof::published(1.0)?.restored(49.0, 51.0)?;
    /// let [lower, upper] = restored.modes_hz()?;
    /// assert!((lower - 49.0).abs() < 1e-9 && (upper - 51.0).abs() < 1e-9);
    /// # Ok::<(), simgap_mold::MoldError>(())
    /// ```
    ///
    /// # Errors
    /// [`MoldError::NoStiffness`] if no positive pair does it, [`MoldError::Parameter`] for
    /// frequencies out of order.
    pub fn restored(&self, lower_hz: f64, upper_hz: f64) -> Result<Self, MoldError> {
        positive("lower mode", lower_hz)?;
        positive("upper mode less lower mode", upper_hz - lower_hz)?;
        let (m1, m2, k1) = (
            self.mold_mass_kg(),
            self.support_mass_kg(),
            self.mold_stiffness(),
        );
        let (lambda1, lambda2) = ((TAU * lower_hz).powi(2), (TAU * upper_hz).powi(2));
        let sum = lambda1 + lambda2;
        let product = lambda1 * lambda2;
        // (3)
        let square = 1.0 + m2 / m1;
        let linear = 2.0 * k1 + m2 * sum;
        let constant = k1 * k1 + product * m1 * m2;
        let discriminant = linear * linear - 4.0 * square * constant;
        let none = MoldError::NoStiffness { lower_hz, upper_hz };
        if discriminant < 0.0 {
            return Err(none);
        }
        for sign in [1.0, -1.0] {
            let a = (linear + sign * discriminant.sqrt()) / (2.0 * square);
            let leaf = a - k1;
            let support = m2 * (sum - a / m1) - leaf; // (1)
            if leaf > 0.0 && support > 0.0 {
                return Self::new([m1, m2], [k1, leaf, support])?.with_damping(self.dampings());
            }
        }
        Err(none)
    }
}
