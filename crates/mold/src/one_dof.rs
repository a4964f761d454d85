//! The mold on one spring and one damper, Eq. (1) to (3).

use std::f64::consts::TAU;

use simgap_model::{
    Damper, GROUND, Input, InputKind, Load, Mass, Model, Output, OutputKind, Spring,
};

use crate::MoldError;
use crate::error::{not_negative, positive};
use crate::plan::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};

/// Standard gravity, m/s² (exact by definition; `bipm-si`). The paper does not print its g.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// The mold with one degree of freedom,
///
/// ```text
/// m ÿ + c ẏ + k y = F − m g,     c = 2 ζ √(k m)                        (1)
/// ```
///
/// | symbol | meaning | unit | published (Table 1) |
/// |---|---|---|---|
/// | m | mass | kg | 33 000 |
/// | ζ | damping ratio | 1 | 0.3 |
/// | k | k_leaf + k_add, total stiffness | N/m | 8 287 639 |
/// | F | pressure force | N | |
///
/// The paper's k_leaf y_leaf, motion of the far end of the leaf spring, is taken as zero: y_leaf
/// is nowhere printed. Valid for m, k > 0 and ζ ≥ 0.
///
/// Reference: `park-mold`, Eq. (1) and Table 1.
///
/// ```
/// let mold = simgap_mold::OneDof::published()?;
/// assert!((mold.natural_freq_hz() - 2.522).abs() < 1e-3);
/// assert!((mold.damping() - 313_779.0).abs() < 1.0);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneDof {
    mass_kg: f64,
    damping_ratio: f64,
    stiffness: f64,
}

impl OneDof {
    /// A mold of mass (kg), damping ratio (1) and stiffness (N/m).
    ///
    /// # Errors
    /// [`MoldError::Parameter`] outside m, k > 0 and ζ ≥ 0.
    pub fn new(mass_kg: f64, damping_ratio: f64, stiffness: f64) -> Result<Self, MoldError> {
        Ok(Self {
            mass_kg: positive("mass", mass_kg)?,
            damping_ratio: not_negative("damping ratio", damping_ratio)?,
            stiffness: positive("stiffness", stiffness)?,
        })
    }

    /// The values of Table 1.
    ///
    /// # Errors
    /// [`MoldError::Table`] if the fixture was damaged.
    pub fn published() -> Result<Self, MoldError> {
        let table = simgap_tables::table1()?;
        Self::new(
            table.mass.si(),
            table.damping_ratio.si(),
            table.stiffness.si(),
        )
    }

    /// m, kg.
    #[must_use]
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// ζ.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// k, N/m.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// c = 2 ζ √(k m), N s/m.
    #[must_use]
    pub fn damping(&self) -> f64 {
        2.0 * self.damping_ratio * (self.stiffness * self.mass_kg).sqrt()
    }

    /// √(k/m) / 2π, Hz.
    #[must_use]
    pub fn natural_freq_hz(&self) -> f64 {
        (self.stiffness / self.mass_kg).sqrt() / TAU
    }

    /// f_n √(1 − ζ²), Hz; `None` for ζ ≥ 1, where the free motion does not swing.
    #[must_use]
    pub fn damped_freq_hz(&self) -> Option<f64> {
        let rest = 1.0 - self.damping_ratio * self.damping_ratio;
        (rest > 0.0).then(|| self.natural_freq_hz() * rest.sqrt())
    }

    /// f_n √(1 − 2ζ²), Hz, where the receptance is largest; `None` for ζ ≥ 1/√2, where it is
    /// largest at rest.
    #[must_use]
    pub fn resonance_freq_hz(&self) -> Option<f64> {
        let rest = 1.0 - 2.0 * self.damping_ratio * self.damping_ratio;
        (rest > 0.0).then(|| self.natural_freq_hz() * rest.sqrt())
    }

    /// k y, N: the force that holds the mold at a displacement (m).
    #[must_use]
    pub fn static_force(&self, displacement: f64) -> f64 {
        self.stiffness * displacement
    }

    /// The model file of Eq. (1): input `F_pressure` and weight on the mold, output `y`.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the lumped model refuses a part.
    pub fn model(&self) -> Result<Model, MoldError> {
        let mold = || "mold".to_owned();
        let to_ground = || [mold(), GROUND.to_owned()];
        let model = Model {
            name: "mold-1dof".to_owned(),
            masses: vec![Mass {
                name: mold(),
                value: self.mass_kg,
                uncertainty: None,
            }],
            springs: vec![Spring {
                name: "cylinder".to_owned(),
                between: to_ground(),
                stiffness: self.stiffness,
                uncertainty: None,
            }],
            dampers: vec![Damper {
                name: "cylinder".to_owned(),
                between: to_ground(),
                damping: self.damping(),
                uncertainty: None,
            }],
            inputs: vec![pressure_input()],
            outputs: vec![displacement_output()],
            loads: vec![Load {
                at: mold(),
                value: -self.mass_kg * STANDARD_GRAVITY,
                uncertainty: None,
            }],
            ..Model::default()
        };
        model.check()?;
        Ok(model)
    }
}

/// The pressure force on the mold.
pub(crate) fn pressure_input() -> Input {
    Input {
        channel: FORCE_CHANNEL.to_owned(),
        kind: InputKind::Force,
        at: "mold".to_owned(),
        gain: None,
        uncertainty: None,
    }
}

/// The measured displacement of the mold.
pub(crate) fn displacement_output() -> Output {
    Output {
        channel: DISPLACEMENT_CHANNEL.to_owned(),
        kind: OutputKind::Displacement,
        at: Some("mold".to_owned()),
        between: None,
        gain: None,
        uncertainty: None,
    }
}
