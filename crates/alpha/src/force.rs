//! The unknown force of Eq. (3).

use faer::c64;
use simgap_integrate::inverse::{Differentiator, derive_motion};
use simgap_model::Model;
use simgap_record::{Quantity, Record};

use crate::AlphaError;
use crate::error::{all_finite, positive};

/// One mass on one spring and one damper.
///
/// | symbol | field | unit |
/// |---|---|---|
/// | m | `mass_kg` | kg |
/// | c | `damping` | N s/m |
/// | k | `stiffness` | N/m |
/// | −m g | `load` | N |
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Oscillator {
    /// m, kg.
    pub mass_kg: f64,
    /// c, N s/m.
    pub damping: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// Known constant force, N; −m g for a mold that moves upwards positive.
    pub load: f64,
}

impl Oscillator {
    /// Mass, damping, stiffness and load of a model with one degree of freedom.
    ///
    /// # Errors
    /// [`AlphaError::DegreesOfFreedom`] for any other model.
    pub fn from_model(model: &Model) -> Result<Self, AlphaError> {
        let found = model.dof_count();
        if found != 1 {
            return Err(AlphaError::DegreesOfFreedom {
                name: model.name.clone(),
                found,
            });
        }
        let matrices = model.matrices()?;
        Ok(Self {
            mass_kg: matrices.mass_matrix[(0, 0)],
            damping: matrices.damping_matrix[(0, 0)],
            stiffness: matrices.stiffness_matrix[(0, 0)],
            load: model.load_vector()[0],
        })
    }

    /// Force per displacement when a derivative is a factor D: m D² + c D + k, N/m. With
    /// D = iω this is the dynamic stiffness.
    #[must_use]
    pub fn force_per_displacement(&self, rate: c64) -> c64 {
        rate * rate * self.mass_kg + rate * self.damping + self.stiffness
    }
}

/// The unknown force and the motion it was computed from, one value per sample.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct UnknownForce {
    /// v, m/s.
    pub velocity: Vec<f64>,
    /// a, m/s².
    pub acceleration: Vec<f64>,
    /// α, N.
    pub unknown_force: Vec<f64>,
    /// Samples at the start that rest on the substitute formulas of the differentiator's start;
    /// leave them out of fits.
    pub settling_samples: usize,
}

/// The force that Eq. (3) lacks,
///
/// ```text
/// v = D y,  a = D v                         D: the chosen formula                 (1)
/// α = m a + c v + k y − F + m g             (m ÿ + c ẏ + k y = F − m g + α)       (2)
/// ```
///
/// | symbol | argument | unit | shape |
/// |---|---|---|---|
/// | y | `displacement` | m | samples |
/// | F | `force` | N | samples |
/// | h | `time_step_s` | s | scalar |
///
/// With Park's formula this is the paper's section 2.1.3. A formula that is wrong near the
/// Nyquist frequency is wrong there twice; see [`force_gain`](crate::force_gain).
///
/// ```
/// use simgap_alpha::{Oscillator, unknown_force};
/// use simgap_integrate::inverse::Differentiator;
/// let plant = Oscillator { mass_kg: 2.0, damping: 1.0, stiffness: 3.0, load: -20.0 };
/// // At rest at 1 m with 4 N applied: α = 3 − 4 + 20.
/// let found = unknown_force(&plant, &[1.0; 20], &[4.0; 20], 0.01, Differentiator::Park)?;
/// assert!(found.unknown_force.iter().all(|force| (force - 19.0).abs() < 1e-9));
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// [`AlphaError::Length`], [`AlphaError::Parameter`], and those of the differentiator.
///
/// Reference: `park-mold`, Eq. (3).
pub fn unknown_force(
    plant: &Oscillator,
    displacement: &[f64],
    force: &[f64],
    time_step_s: f64,
    differentiator: Differentiator,
) -> Result<UnknownForce, AlphaError> {
    if force.len() != displacement.len() {
        return Err(AlphaError::Length {
            what: "force",
            found: force.len(),
            needed: displacement.len(),
        });
    }
    positive("time step", time_step_s)?;
    all_finite("force", force)?;
    let motion = derive_motion(differentiator, displacement, time_step_s)?; // (1)
    let unknown_force = (0..force.len())
        .map(|n| {
            plant.mass_kg * motion.acceleration[n]
                + plant.damping * motion.velocity[n]
                + plant.stiffness * displacement[n]
                - force[n]
                - plant.load // (2)
        })
        .collect();
    Ok(UnknownForce {
        velocity: motion.velocity,
        acceleration: motion.acceleration,
        unknown_force,
        settling_samples: 2 * (differentiator.least_samples() - 1),
    })
}

/// [`unknown_force`] of two channels of a record.
///
/// # Errors
/// As [`unknown_force`], and those of the record's channels.
pub fn unknown_force_of_record(
    plant: &Oscillator,
    record: &Record,
    displacement_channel: &str,
    force_channel: &str,
    differentiator: Differentiator,
) -> Result<UnknownForce, AlphaError> {
    let displacement = record.si_values(displacement_channel, Quantity::Displacement)?;
    let force = record.si_values(force_channel, Quantity::Force)?;
    unknown_force(
        plant,
        &displacement,
        &force,
        record.time_step_s(),
        differentiator,
    )
}
