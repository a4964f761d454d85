//! The mold on a flexible support, Eq. (4).

use std::f64::consts::TAU;

use simgap_model::{
    Damper, FrfKind, GROUND, Mass, Model, Spring, frequency_response, undamped_modes,
};

use crate::MoldError;
use crate::error::{not_negative, positive};
use crate::one_dof::{displacement_output, pressure_input};

/// Mold m₁ and support m₂ with two degrees of freedom,
///
/// ```text
/// [ m₁  0  ] { ÿ₁ }   [ c₁ + c_leaf   −c_leaf     ] { ẏ₁ }   [ k₁ + k_leaf   −k_leaf     ] { y₁ }   { F }
/// [ 0   m₂ ] { ÿ₂ } + [ −c_leaf       c_leaf + c₃ ] { ẏ₂ } + [ −k_leaf       k_leaf + k₂ ] { y₂ } = { 0 }   (4)
/// ```
///
/// | symbol | method | unit | published |
/// |---|---|---|---|
/// | m₁, m₂ | [`mold_mass_kg`](Self::mold_mass_kg), [`support_mass_kg`](Self::support_mass_kg) | kg | 33 000, 7 000 |
/// | k₁ | [`mold_stiffness`](Self::mold_stiffness), mold to ground | N/m | 3.3·10⁹ |
/// | k_leaf | [`leaf_stiffness`](Self::leaf_stiffness), mold to support | N/m | Table 5 |
/// | k₂ | [`support_stiffness`](Self::support_stiffness), support to ground | N/m | Table 5 |
///
/// | c₁, c_leaf, c₃ | [`dampings`](Self::dampings), beside the springs | N s/m | not printed |
///
/// k₃ of Eq. (4) and k₂ of Table 5 are the same spring. Eq. (4) names dampers but no value is
/// printed: none is assumed until [`with_damping`](Self::with_damping) sets them. Weight is left out; Eq. (4) has none. Valid for positive
/// masses and stiffnesses (k₁, k_leaf, k₂ may be zero one at a time).
///
/// Reference: `park-mold`, Eq. (4) and Table 5.
///
/// ```
/// let mold = simgap_mold::TwoDof::published(1.0)?;
/// let [lower, upper] = mold.modes_hz()?;
/// assert!((lower - 50.17).abs() < 0.01 && (upper - 52.79).abs() < 0.01);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct TwoDof {
    mold_mass_kg: f64,
    support_mass_kg: f64,
    mold_stiffness: f64,
    leaf_stiffness: f64,
    support_stiffness: f64,
    dampings: [f64; 3],
}

impl TwoDof {
    /// Masses `[m₁, m₂]` in kg and stiffnesses `[k₁, k_leaf, k₂]` in N/m.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a mass that is not positive or a negative stiffness.
    pub fn new(masses_kg: [f64; 2], stiffnesses: [f64; 3]) -> Result<Self, MoldError> {
        Ok(Self {
            mold_mass_kg: positive("mass of the mold", masses_kg[0])?,
            support_mass_kg: positive("mass of the support", masses_kg[1])?,
            mold_stiffness: not_negative("k1", stiffnesses[0])?,
            leaf_stiffness: not_negative("k_leaf", stiffnesses[1])?,
            support_stiffness: not_negative("k2", stiffnesses[2])?,
            dampings: [0.0; 3],
        })
    }

    /// The same with dampers `[c₁, c_leaf, c₃]`, N s/m.
    ///
    /// ```
    /// let mold = simgap_mold::TwoDof::published(1.0)?.with_damping([2.0e4, 1.0e3, 5.0e3])?;
    /// let modes = simgap_model::damped_modes(&mold.model()?.matrices()?)?;
    /// assert!(modes.iter().all(|mode| mode.damping_ratio > 0.0));
    /// # Ok::<(), simgap_mold::MoldError>(())
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a negative damping.
    pub fn with_damping(mut self, dampings: [f64; 3]) -> Result<Self, MoldError> {
        for (name, value) in ["c1", "c_leaf", "c3"].into_iter().zip(dampings) {
            not_negative(name, value)?;
        }
        self.dampings = dampings;
        Ok(self)
    }

    /// c₁, c_leaf and c₃, N s/m.
    #[must_use]
    pub fn dampings(&self) -> [f64; 3] {
        self.dampings
    }

    /// The printed values for one excitation, 1 to 6 Hz.
    ///
    /// # Errors
    /// [`MoldError::NoRow`] for any other excitation.
    pub fn published(excitation_freq_hz: f64) -> Result<Self, MoldError> {
        let table = simgap_tables::table5()?;
        let stated = simgap_tables::stated_values()?;
        let row = table
            .rows
            .iter()
            .find(|row| row.excitation.si() == excitation_freq_hz)
            .ok_or(MoldError::NoRow {
                table: "Table 5",
                found: excitation_freq_hz,
                has: "1, 2, 3, 4, 5, 6 Hz",
            })?;
        Self::new(
            [stated.mold_mass.si(), stated.support_mass.si()],
            [
                table.mold_stiffness.si(),
                row.leaf_stiffness.si(),
                row.support_stiffness.si(),
            ],
        )
    }

    /// m₁, kg.
    #[must_use]
    pub fn mold_mass_kg(&self) -> f64 {
        self.mold_mass_kg
    }

    /// m₂, kg.
    #[must_use]
    pub fn support_mass_kg(&self) -> f64 {
        self.support_mass_kg
    }

    /// k₁, N/m.
    #[must_use]
    pub fn mold_stiffness(&self) -> f64 {
        self.mold_stiffness
    }

    /// k_leaf, N/m.
    #[must_use]
    pub fn leaf_stiffness(&self) -> f64 {
        self.leaf_stiffness
    }

    /// k₂ (k₃ in Eq. (4)), N/m.
    #[must_use]
    pub fn support_stiffness(&self) -> f64 {
        self.support_stiffness
    }

    /// Undamped natural frequencies of the coupled system, lower and upper, Hz.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the eigenvalues are not found.
    pub fn modes_hz(&self) -> Result<[f64; 2], MoldError> {
        let modes = undamped_modes(&self.model()?.matrices()?)?.natural_freq_hz;
        Ok([modes[0], modes[1]])
    }

    /// Natural frequency of each mass with the other held: √((k₁+k_leaf)/m₁)/2π and
    /// √((k_leaf+k₂)/m₂)/2π, Hz.
    #[must_use]
    pub fn held_freqs_hz(&self) -> [f64; 2] {
        [
            ((self.mold_stiffness + self.leaf_stiffness) / self.mold_mass_kg).sqrt() / TAU,
            ((self.leaf_stiffness + self.support_stiffness) / self.support_mass_kg).sqrt() / TAU,
        ]
    }

    /// Amplitude of the force on m₁ (N) that moves m₁ by `amplitude` (m) at a frequency (Hz),
    /// steady state: amplitude / |H₁₁|.
    ///
    /// # Errors
    /// [`MoldError::Model`] at a natural frequency, where the receptance H₁₁ is not finite.
    pub fn force_amplitude(&self, amplitude: f64, freq_hz: f64) -> Result<f64, MoldError> {
        let receptance =
            frequency_response(&self.model()?.matrices()?, freq_hz, FrfKind::Receptance)?;
        Ok(amplitude / receptance[(0, 0)].norm())
    }

    /// Amplitude of y₂/y₁ in steady state at a frequency (Hz).
    ///
    /// # Errors
    /// As [`force_amplitude`](Self::force_amplitude).
    pub fn support_motion_ratio(&self, freq_hz: f64) -> Result<f64, MoldError> {
        let receptance =
            frequency_response(&self.model()?.matrices()?, freq_hz, FrfKind::Receptance)?;
        Ok((receptance[(1, 0)] / receptance[(0, 0)]).norm())
    }

    /// The model file of Eq. (4): input `F_pressure` on the mold, output `y`.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the lumped model refuses a part.
    pub fn model(&self) -> Result<Model, MoldError> {
        let (mold, support, ground) = ("mold".to_owned(), "support".to_owned(), GROUND.to_owned());
        let spring = |name: &str, a: &str, b: &str, stiffness: f64| Spring {
            name: name.to_owned(),
            between: [a.to_owned(), b.to_owned()],
            stiffness,
            uncertainty: None,
        };
        let members = [
            ["k1", "c1", &mold, &ground],
            ["k_leaf", "c_leaf", &mold, &support],
            ["k2", "c3", &support, &ground],
        ];
        let stiffnesses = [
            self.mold_stiffness,
            self.leaf_stiffness,
            self.support_stiffness,
        ];
        let dampers = members.iter().zip(self.dampings);
        let model = Model {
            name: "mold-2dof".to_owned(),
            dampers: dampers
                .filter(|(_, damping)| *damping > 0.0)
                .map(|([_, name, a, b], damping)| Damper {
                    name: (*name).to_owned(),
                    between: [(*a).to_owned(), (*b).to_owned()],
                    damping,
                    uncertainty: None,
                })
                .collect(),
            springs: members
                .iter()
                .zip(stiffnesses)
                .map(|([name, _, a, b], stiffness)| spring(name, a, b, stiffness))
                .collect(),
            masses: vec![
                Mass {
                    name: mold,
                    value: self.mold_mass_kg,
                    uncertainty: None,
                },
                Mass {
                    name: support,
                    value: self.support_mass_kg,
                    uncertainty: None,
                },
            ],
            inputs: vec![pressure_input()],
            outputs: vec![displacement_output()],
            ..Model::default()
        };
        model.check()?;
        Ok(model)
    }
}
