//! The oil in a double-acting cylinder as a spring.

use crate::MoldError;
use crate::error::{not_negative, positive};

/// A double-acting cylinder with both ports shut.
///
/// | symbol | field | unit |
/// |---|---|---|
/// | A₁, A₂ | `areas_m2` | m² |
/// | V₁, V₂ | `volumes_m3`, oil on each side, pipes included | m³ |
///
/// ```
/// use simgap_mold::LockedCylinder;
/// // 0.02 m² over 40 mm of oil on each side, at 1.4 GPa.
/// let cylinder = LockedCylinder::centred(0.02, 0.08)?;
/// assert!((cylinder.stiffness(1.4e9)? - 1.4e9).abs() < 1.0);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LockedCylinder {
    /// A₁ and A₂, m².
    pub areas_m2: [f64; 2],
    /// V₁ and V₂, m³.
    pub volumes_m3: [f64; 2],
}

impl LockedCylinder {
    /// Equal areas (m²) with the piston in the middle of a length of oil (m), half of it on each side.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a value that is not positive.
    pub fn centred(area_m2: f64, oil_length_m: f64) -> Result<Self, MoldError> {
        let area = positive("piston area", area_m2)?;
        let volume = 0.5 * area * positive("length of oil", oil_length_m)?;
        Ok(Self {
            areas_m2: [area; 2],
            volumes_m3: [volume; 2],
        })
    }

    /// The same with the piston moved, m; positive towards side 2.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] where a side has no oil left.
    pub fn moved(mut self, displacement_m: f64) -> Result<Self, MoldError> {
        for (i, sign) in [1.0, -1.0].into_iter().enumerate() {
            let volume = self.volumes_m3[i] + sign * self.areas_m2[i] * displacement_m;
            self.volumes_m3[i] = positive("volume of oil on a side", volume)?;
        }
        Ok(self)
    }

    /// Stiffness of the shut oil,
    ///
    /// ```text
    /// k = β (A₁²/V₁ + A₂²/V₂)
    /// ```
    ///
    /// N/m, for a bulk modulus β in Pa: 1.4 to 1.7 GPa for mineral oil, 0.7 to 1.0 GPa with air in it. Least
    /// where A₁/V₁ = A₂/V₂ √(A₁/A₂): for equal areas in the middle.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a negative bulk modulus or a volume that is not positive.
    ///
    /// Reference: `merritt1967`, chapter 6.
    pub fn stiffness(&self, bulk_modulus_pa: f64) -> Result<f64, MoldError> {
        let modulus = not_negative("bulk modulus", bulk_modulus_pa)?;
        let mut sum = 0.0;
        for (area, volume) in self.areas_m2.iter().zip(&self.volumes_m3) {
            sum += area * area / positive("volume of oil on a side", *volume)?;
        }
        Ok(modulus * sum)
    }
}
