//! The mold on a left and a right servo cylinder, loops closed.

use faer::{Mat, c64, mat};
use simgap_model::{
    Block, Body, DampedMode, Damper, GROUND, Input, InputKind, Load, Model, Output, OutputKind,
    Point, Spring, damped_modes_of,
};

use crate::error::{not_negative, positive};
use crate::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL, MoldError, STANDARD_GRAVITY, ServoDrive};

/// Channel of the set point, m.
pub const SET_POINT_CHANNEL: &str = "r";

const SIDES: [&str; 2] = ["left", "right"];
const REFERENCE: &str = "reference";

/// Poles at zero are found to a few units in the last place of the fastest one.
const ROUNDING_OF_POLES: f64 = 1e-13;

/// Heave y and roll θ of the mold on two servo cylinders, its guide (the leaf springs) and its weight,
///
/// ```text
/// [ D₁₁ D₁₂ ] { y }   { F + Σ R_i w     }       D₁₁ = k + iωc − ω² m + Σ Z_i
/// [ D₁₂ D₂₂ ] { θ } = { M + Σ R_i r_i w }       D₁₂ = Σ Z_i r_i,   D₂₂ = −ω² J + Σ Z_i r_i²          (1)
/// ```
///
/// | symbol | meaning | unit |
/// |---|---|---|
/// | m, J | mass, moment of inertia about the roll axis through the centre of mass | kg, kg m² |
/// | k, c | stiffness and damping of the guide, in heave alone | N/m, N s/m |
/// | Z_i, R_i | stiffness and drive of a cylinder ([`ServoDrive::stiffness_and_drive`]) | N/m |
/// | r_i | its offset | m |
/// | w | set point of both, channel [`SET_POINT_CHANNEL`] | m |
/// | F, M | force and moment from outside | N, N m |
///
/// The cylinders share the weight so that it does not roll the mold. Valid for small angles and motions.
///
/// [`model`](Self::model) is the same machine as a model file, its orifices nonlinear; (1) is its linear part about rest.
///
/// ```
/// use simgap_mold::{ServoDrive, ServoMold};
/// let drives = [ServoDrive::assumed(-1.5), ServoDrive::assumed(1.5)];
/// let mold = ServoMold::new([33_000.0, 19_000.0], [0.0, 3.0e5], drives)?;
/// assert!(mold.modes()?.iter().all(|mode| mode.eigenvalue.re < 0.0));
/// // Slowly, the cylinders follow.
/// assert!((mold.response_to_set_point(0.01)?[0].norm() - 1.0).abs() < 0.01);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ServoMold {
    mass_kg: f64,
    inertia: f64,
    guide: [f64; 2],
    drives: [ServoDrive; 2],
}

impl ServoMold {
    /// `[m, J]` in kg and kg m², `[k, c]` of the guide in N/m and N s/m, left and right drive.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a value out of range, for cylinders in one place and for a supply pressure that does not
    /// carry the weight.
    pub fn new(
        [mass_kg, inertia]: [f64; 2],
        [stiffness, damping]: [f64; 2],
        drives: [ServoDrive; 2],
    ) -> Result<Self, MoldError> {
        for drive in &drives {
            drive.check()?;
        }
        positive(
            "offset of the right cylinder less that of the left",
            drives[1].offset_m - drives[0].offset_m,
        )?;
        let mold = Self {
            mass_kg: positive("mass", mass_kg)?,
            inertia: positive("moment of inertia", inertia)?,
            guide: [
                not_negative("stiffness of the guide", stiffness)?,
                not_negative("damping of the guide", damping)?,
            ],
            drives,
        };
        for (drive, load) in drives.iter().zip(mold.loads()) {
            drive.pressures_pa(load)?;
        }
        Ok(mold)
    }

    /// Left and right drive.
    #[must_use]
    pub fn drives(&self) -> [ServoDrive; 2] {
        self.drives
    }

    /// What the left and the right cylinder carry of the weight, N.
    #[must_use]
    pub fn loads(&self) -> [f64; 2] {
        let [left, right] = self.drives.each_ref().map(|drive| drive.offset_m);
        let weight = self.mass_kg * STANDARD_GRAVITY;
        [
            weight * right / (right - left),
            -weight * left / (right - left),
        ]
    }

    /// Σ 2 β A²/V, stiffness of the oil of both cylinders with the valves shut, N/m.
    #[must_use]
    pub fn oil_stiffness(&self) -> f64 {
        self.drives.iter().map(ServoDrive::oil_stiffness).sum()
    }

    /// Z and R of each drive.
    fn drives_at(&self, freq_hz: f64) -> Result<[[c64; 2]; 2], MoldError> {
        let [left, right] = self.drives;
        let loads = self.loads();
        Ok([
            left.stiffness_and_drive(freq_hz, loads[0])?,
            right.stiffness_and_drive(freq_hz, loads[1])?,
        ])
    }

    /// Σ Z_i(ω), the stiffness of both drives in heave without mass and guide, N/m; Σ 2 β A²/V where the oil is all of it.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive.
    pub fn drive_stiffness(&self, freq_hz: f64) -> Result<c64, MoldError> {
        let [left, right] = self.drives_at(freq_hz)?;
        Ok(left[0] + right[0])
    }

    /// D(ω) of (1), heave first: N/m, N/rad and N m, N m/rad.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive.
    pub fn dynamic_stiffness(&self, freq_hz: f64) -> Result<Mat<c64>, MoldError> {
        let omega = std::f64::consts::TAU * positive("frequency", freq_hz)?;
        let mut sums = [c64::new(0.0, 0.0); 3];
        for (drive, [stiffness, _]) in self.drives.iter().zip(self.drives_at(freq_hz)?) {
            for (power, sum) in (0..).zip(&mut sums) {
                *sum += stiffness * drive.offset_m.powi(power);
            }
        }
        let [heave, coupling, roll] = sums;
        let guide = c64::new(self.guide[0], omega * self.guide[1]);
        let squared = omega * omega;
        Ok(mat![
            [heave + guide - squared * self.mass_kg, coupling],
            [coupling, roll - squared * self.inertia],
        ])
    }

    /// Heave (m/m) and roll (rad/m) for the set point of both drives, solved from (1).
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive.
    pub fn response_to_set_point(&self, freq_hz: f64) -> Result<[c64; 2], MoldError> {
        let mut push = [c64::new(0.0, 0.0); 2];
        for (drive, [_, drives]) in self.drives.iter().zip(self.drives_at(freq_hz)?) {
            push[0] += drives;
            push[1] += drives * drive.offset_m;
        }
        self.solved(freq_hz, push)
    }

    /// Heave (m/N) and roll (rad/N) for a force at the centre of mass, solved from (1).
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive.
    pub fn response_to_force(&self, freq_hz: f64) -> Result<[c64; 2], MoldError> {
        self.solved(freq_hz, [c64::new(1.0, 0.0), c64::new(0.0, 0.0)])
    }

    fn solved(&self, freq_hz: f64, [force, moment]: [c64; 2]) -> Result<[c64; 2], MoldError> {
        let d = self.dynamic_stiffness(freq_hz)?;
        let determinant = d[(0, 0)] * d[(1, 1)] - d[(0, 1)] * d[(1, 0)];
        Ok([
            (d[(1, 1)] * force - d[(0, 1)] * moment) / determinant,
            (d[(0, 0)] * moment - d[(1, 0)] * force) / determinant,
        ])
    }

    /// The poles of the closed loops about rest, lowest |λ| first.
    ///
    /// The mean pressure of a cylinder has no pole here: nothing in (2) and (3) of [`ServoDrive`] restores it and nothing
    /// reads it. In the model file it is a pole at zero, one for each cylinder, and is left out.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the eigenvalues are not found.
    pub fn modes(&self) -> Result<Vec<DampedMode>, MoldError> {
        let model = self.model()?;
        let mut modes = damped_modes_of(&model.matrices()?, &model.first_order())?;
        let sizes = modes.iter().map(|mode| mode.eigenvalue.norm());
        let fastest = sizes.fold(0.0, f64::max);
        modes.retain(|mode| mode.eigenvalue.norm() > ROUNDING_OF_POLES * fastest);
        Ok(modes)
    }

    /// The machine as a model file: set point `r` for both controllers and force `F_pressure` at the centre of mass (a
    /// disturbance here); outputs heave `y`, `roll`, and pressures `p1_left` to `p2_right`.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the model refuses a part.
    pub fn model(&self) -> Result<Model, MoldError> {
        let mut model = Model {
            name: "mold on two servo cylinders".to_owned(),
            ..Model::default()
        };
        let body = Body {
            name: "mold".to_owned(),
            points: SIDES
                .iter()
                .zip(&self.drives)
                .map(|(name, drive)| Point {
                    name: (*name).to_owned(),
                    offset_m: drive.offset_m,
                })
                .collect(),
        };
        model.add_body(body, self.mass_kg, self.inertia);
        for ((side, drive), load) in SIDES.iter().zip(&self.drives).zip(self.loads()) {
            let node = format!("mold.{side}");
            model.add_cylinder(drive.cylinder(side, &node, load)?)?;
        }
        for (side, drive) in SIDES.iter().zip(&self.drives) {
            let mut valve = drive.valve(&format!("servo {side}"), side);
            valve.from = Some(format!("controller {side}"));
            model.add_valve(valve)?;
        }
        model.add_block(Block {
            name: REFERENCE.to_owned(),
            numerator: vec![1.0],
            denominator: vec![1.0],
            plus: vec![],
            minus: vec![],
            force: None,
        })?;
        for (side, drive) in SIDES.iter().zip(&self.drives) {
            let name = format!("controller {side}");
            model.add_block(drive.block(&name, REFERENCE, &format!("mold.{side}")))?;
        }
        self.add_guide_and_channels(&mut model);
        model.check()?;
        Ok(model)
    }

    fn add_guide_and_channels(&self, model: &mut Model) {
        let [stiffness, damping] = self.guide;
        let between = || ["mold".to_owned(), GROUND.to_owned()];
        if stiffness > 0.0 {
            model.springs.push(Spring {
                name: "guide".to_owned(),
                between: between(),
                stiffness,
                uncertainty: None,
            });
        }
        if damping > 0.0 {
            model.dampers.push(Damper {
                name: "guide".to_owned(),
                between: between(),
                damping,
                uncertainty: None,
            });
        }
        model.loads.push(Load {
            at: "mold".to_owned(),
            value: -self.mass_kg * STANDARD_GRAVITY,
            uncertainty: None,
        });
        for (channel, kind, at) in [
            (SET_POINT_CHANNEL, InputKind::SetPoint, REFERENCE),
            (FORCE_CHANNEL, InputKind::Force, "mold"),
        ] {
            model.inputs.push(Input {
                channel: channel.to_owned(),
                kind,
                at: at.to_owned(),
                gain: None,
                uncertainty: None,
                between_samples: None,
            });
        }
        let mut output = |channel: String, kind: OutputKind, at: String| {
            model.outputs.push(Output {
                channel,
                kind,
                at: Some(at),
                between: None,
                gain: None,
                uncertainty: None,
            });
        };
        let mold = || "mold".to_owned();
        output(
            DISPLACEMENT_CHANNEL.to_owned(),
            OutputKind::Displacement,
            mold(),
        );
        output("roll".to_owned(), OutputKind::Roll, mold());
        for side in SIDES {
            for chamber in ["p1", "p2"] {
                output(
                    format!("{chamber}_{side}"),
                    OutputKind::Pressure,
                    format!("{side}.{chamber}"),
                );
            }
        }
    }
}
