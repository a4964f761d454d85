//! The mold as a rigid body that heaves and rolls on a left and a right cylinder.

use std::f64::consts::TAU;

use faer::{Mat, c64, mat};
use simgap_model::StructuralMatrices;

use crate::MoldError;
use crate::error::{finite, not_negative, positive};

/// One cylinder, as a spring and a damper to ground.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Cylinder {
    /// r, distance from the centre of mass, m; negative to the left.
    pub offset_m: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// c, N s/m.
    pub damping: f64,
}

/// Heave y (m) and roll θ (rad) of a rigid mold on two cylinders,
///
/// ```text
/// [ m 0 ] { ÿ }       [ 1  r  ] { ẏ }       [ 1  r  ] { y }   { F }
/// [ 0 J ] { θ̈ } + Σ c [ r  r² ] { θ̇ } + Σ k [ r  r² ] { θ } = { M }            (1)
/// ```
///
/// Valid for small angles.
///
/// ```
/// use simgap_mold::HeaveRoll;
/// let mold = HeaveRoll::symmetric(33_000.0, 1.0, [8_287_639.0, 313_779.0], 1.98)?;
/// // f_roll = f_heave b / r_g
/// assert!((mold.heave_freq_hz() - 2.522).abs() < 1e-3 && (mold.roll_freq_hz() - 4.994).abs() < 1e-2);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HeaveRoll {
    mass_kg: f64,
    inertia: f64,
    cylinders: [Cylinder; 2],
}

impl HeaveRoll {
    /// Mass (kg), moment of inertia about the roll axis through the centre of mass (kg m²), left and right
    /// cylinder.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for an inertia that is not positive, a negative stiffness or damping.
    pub fn new(mass_kg: f64, inertia: f64, cylinders: [Cylinder; 2]) -> Result<Self, MoldError> {
        for cylinder in &cylinders {
            finite("offset of a cylinder", cylinder.offset_m)?;
            not_negative("stiffness of a cylinder", cylinder.stiffness)?;
            not_negative("damping of a cylinder", cylinder.damping)?;
        }
        Ok(Self {
            mass_kg: positive("mass", mass_kg)?,
            inertia: positive("moment of inertia", inertia)?,
            cylinders,
        })
    }

    /// Two equal cylinders that share a total stiffness (N/m) and damping (N s/m), at ± `half_span` for a
    /// radius of gyration (m).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn symmetric(
        mass_kg: f64,
        radius_of_gyration_m: f64,
        [stiffness, damping]: [f64; 2],
        half_span_m: f64,
    ) -> Result<Self, MoldError> {
        let radius = positive("radius of gyration", radius_of_gyration_m)?;
        let side = |sign: f64| Cylinder {
            offset_m: sign * half_span_m,
            stiffness: 0.5 * stiffness,
            damping: 0.5 * damping,
        };
        Self::new(mass_kg, mass_kg * radius * radius, [side(-1.0), side(1.0)])
    }

    /// The same with the left cylinder stiffer and more damped by a share ε, the right one less by as much; in
    /// total as before.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] unless |ε| ≤ 1.
    pub fn with_mismatch(mut self, share: f64) -> Result<Self, MoldError> {
        not_negative("1 - |mismatch|", 1.0 - share.abs())?;
        for (cylinder, sign) in self.cylinders.iter_mut().zip([1.0, -1.0]) {
            cylinder.stiffness *= 1.0 + sign * share;
            cylinder.damping *= 1.0 + sign * share;
        }
        Ok(self)
    }

    /// Left and right cylinder.
    #[must_use]
    pub fn cylinders(&self) -> [Cylinder; 2] {
        self.cylinders
    }

    /// Σ k rⁿ and Σ c rⁿ.
    fn moment(&self, power: i32) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for cylinder in &self.cylinders {
            let arm = cylinder.offset_m.powi(power);
            sums[0] += cylinder.stiffness * arm;
            sums[1] += cylinder.damping * arm;
        }
        sums
    }

    /// √(Σk/m)/2π: heave with the roll held, Hz.
    #[must_use]
    pub fn heave_freq_hz(&self) -> f64 {
        (self.moment(0)[0] / self.mass_kg).sqrt() / TAU
    }

    /// √(Σk r²/J)/2π: roll with the heave held, Hz. Equal cylinders at ± b give f_heave b / r_g.
    #[must_use]
    pub fn roll_freq_hz(&self) -> f64 {
        (self.moment(2)[0] / self.inertia).sqrt() / TAU
    }

    /// Damping ratio of the roll with the heave held.
    #[must_use]
    pub fn roll_damping_ratio(&self) -> f64 {
        let [stiffness, damping] = self.moment(2);
        0.5 * damping / (stiffness * self.inertia).sqrt()
    }

    /// M, C and K of (1), heave first.
    #[must_use]
    pub fn matrices(&self) -> StructuralMatrices {
        let [heave, coupling, roll] = [0, 1, 2].map(|power| self.moment(power));
        let of = |i: usize| mat![[heave[i], coupling[i]], [coupling[i], roll[i]]];
        StructuralMatrices {
            mass_matrix: Mat::from_fn(2, 2, |i, j| match (i, j) {
                (0, 0) => self.mass_kg,
                (1, 1) => self.inertia,
                _ => 0.0,
            }),
            damping_matrix: of(1),
            stiffness_matrix: of(0),
        }
    }

    /// What a model with heave alone lacks while the mold heaves harmonically, per metre of heave, N/m: with
    /// D = K + iωC − ω²M of (1) and no moment from outside,
    ///
    /// ```text
    /// α / y = D₁₂² / D₂₂                                                                (2)
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive.
    pub fn unknown_force_per_heave(&self, freq_hz: f64) -> Result<c64, MoldError> {
        let omega = TAU * positive("frequency", freq_hz)?;
        let dynamic = |power: i32, inertia: f64| {
            let [stiffness, damping] = self.moment(power);
            c64::new(stiffness - omega * omega * inertia, omega * damping)
        };
        let coupling = dynamic(1, 0.0);
        Ok(coupling * coupling / dynamic(2, self.inertia)) // (2)
    }
}
