//! One cylinder under servo control: oil, valve and controller as one impedance.

use std::f64::consts::TAU;

use faer::c64;
use simgap_model::{Block, Cylinder, Valve};

use crate::MoldError;
use crate::error::{finite, not_negative, positive};

/// A proportional controller with an integrator, in the time T where there is one,
///
/// ```text
/// u = G (1 + 1/(T s)) (r − y)                                                         (1)
/// ```
///
/// u is the share of the full opening that the valve is told, r the set point, y the displacement at the cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Controller {
    /// G, 1/m.
    pub gain_per_m: f64,
    /// T, s; none for a controller without integrator.
    pub integral_time_s: Option<f64>,
}

/// A double-acting cylinder with equal areas, its valve and its controller.
///
/// ```text
/// (V/2β) ṗ = K_q x − A v − C_l p,      p = p₁ − p₂,   V = A L/2                       (2)
/// ẍ/ω₀² + 2 ζ₀ ẋ/ω₀ + x = u,           F = A p                                        (3)
/// K_q = Q_N √((p_s/2)/Δp_N) about p₁ = p₂; less with a load, [`flow_gain`](Self::flow_gain)
/// ```
///
/// | symbol | field | unit |
/// |---|---|---|
/// | r | `offset_m`, from the centre of mass; negative to the left | m |
/// | A, L | `area_m2`, `oil_length_m` of both chambers, piston in the middle | m², m |
/// | β | `bulk_modulus_pa` | Pa |
/// | C_l | `leakage` past the piston | m³/(s Pa) |
/// | Q_N, Δp_N | `rated_flow` of an edge of the open valve, at `rated_drop_pa` | m³/s, Pa |
/// | ω₀/2π, ζ₀ | `spool_freq_hz`, `spool_damping_ratio` | Hz, 1 |
/// | p_s | `supply_pa`; the tank is at zero | Pa |
///
/// Valid for motions small beside L and openings below one.
///
/// Reference: `merritt1967`, chapters 5, 6 and 8.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ServoDrive {
    /// r, m.
    pub offset_m: f64,
    /// A, m².
    pub area_m2: f64,
    /// L, m.
    pub oil_length_m: f64,
    /// β, Pa.
    pub bulk_modulus_pa: f64,
    /// C_l, m³/(s Pa).
    pub leakage: f64,
    /// Q_N, m³/s.
    pub rated_flow: f64,
    /// Δp_N, Pa.
    pub rated_drop_pa: f64,
    /// ω₀/2π, Hz.
    pub spool_freq_hz: f64,
    /// ζ₀.
    pub spool_damping_ratio: f64,
    /// p_s, Pa.
    pub supply_pa: f64,
    /// Set point less displacement to opening.
    pub controller: Controller,
}

impl ServoDrive {
    /// **Assumed** values of ordinary size, for half of the paper's mold: 0.02 m² over 80 mm of oil at 1.4 GPa, which two
    /// of make 2.8 GN/m; a valve of 200 l/min at 3.5 MPa per edge with its spool at 60 Hz; 21 MPa; a gain that closes
    /// the loop at about 17 1/s. None of them is printed.
    ///
    /// ```
    /// let drive = simgap_mold::ServoDrive::assumed(1.5);
    /// assert!((drive.oil_stiffness() - 1.4e9).abs() < 1.0);
    /// ```
    #[must_use]
    pub fn assumed(offset_m: f64) -> Self {
        Self {
            offset_m,
            area_m2: 0.02,
            oil_length_m: 0.08,
            bulk_modulus_pa: 1.4e9,
            leakage: 1e-11,
            rated_flow: 3.3e-3,
            rated_drop_pa: 3.5e6,
            spool_freq_hz: 60.0,
            spool_damping_ratio: 0.8,
            supply_pa: 21e6,
            controller: Controller {
                gain_per_m: 60.0,
                integral_time_s: None,
            },
        }
    }

    pub(crate) fn check(&self) -> Result<(), MoldError> {
        finite("offset of a cylinder", self.offset_m)?;
        positive("piston area", self.area_m2)?;
        positive("length of oil", self.oil_length_m)?;
        positive("bulk modulus", self.bulk_modulus_pa)?;
        not_negative("leakage", self.leakage)?;
        positive("rated flow", self.rated_flow)?;
        positive("rated pressure drop", self.rated_drop_pa)?;
        positive("frequency of the spool", self.spool_freq_hz)?;
        positive("damping ratio of the spool", self.spool_damping_ratio)?;
        positive("supply pressure", self.supply_pa)?;
        finite("gain of the controller", self.controller.gain_per_m)?;
        if let Some(time) = self.controller.integral_time_s {
            positive("integral time of the controller", time)?;
        }
        Ok(())
    }

    /// Volume of oil on each side, m³.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        0.5 * self.area_m2 * self.oil_length_m
    }

    /// 2 β A²/V, stiffness of the oil with the valve shut, N/m.
    #[must_use]
    pub fn oil_stiffness(&self) -> f64 {
        2.0 * self.bulk_modulus_pa * self.area_m2 * self.area_m2 / self.volume_m3()
    }

    /// p₁ and p₂ that carry a steady force (N) about half the supply pressure, Pa.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a force that asks for more than the supply.
    pub fn pressures_pa(&self, force: f64) -> Result<[f64; 2], MoldError> {
        let half = 0.5 * force / self.area_m2;
        let mean = 0.5 * self.supply_pa;
        positive(
            "half the supply pressure less what the load takes",
            mean - half.abs(),
        )?;
        Ok([mean + half, mean - half])
    }

    /// K_q, flow for each unit of the opening while the cylinder carries a steady force (N), m³/s.
    ///
    /// # Errors
    /// As [`pressures_pa`](Self::pressures_pa).
    pub fn flow_gain(&self, force: f64) -> Result<f64, MoldError> {
        let [p1, _] = self.pressures_pa(force)?;
        Ok(self.valve("servo", "cylinder").opening_gain(0, p1))
    }

    /// K_v = K_q G/A, 1/s: the speed of the cylinder for each metre of error.
    ///
    /// # Errors
    /// As [`pressures_pa`](Self::pressures_pa).
    pub fn velocity_gain(&self, force: f64) -> Result<f64, MoldError> {
        Ok(self.flow_gain(force)? * self.controller.gain_per_m / self.area_m2)
    }

    /// G (1 + 1/(T s)) over ẍ/ω₀² + ..., from the error to the opening.
    fn opening_per_error(&self, s: c64) -> c64 {
        let scaled = s / (TAU * self.spool_freq_hz);
        let spool = (scaled * scaled + 2.0 * self.spool_damping_ratio * scaled + 1.0).inv();
        let integral = match self.controller.integral_time_s {
            Some(time) => 1.0 + (s * time).inv(),
            None => c64::new(1.0, 0.0),
        };
        self.controller.gain_per_m * integral * spool
    }

    /// Force against a displacement and force for a set point, per metre, at s = iω, of (1) to (3),
    ///
    /// ```text
    /// −F/y = A (A s + K_q X(s)) / (V s/(2β) + C_l),    F/r = A K_q X(s) / (V s/(2β) + C_l)      (4)
    /// X(s) = G (1 + 1/(T s)) / (s²/ω₀² + 2 ζ₀ s/ω₀ + 1)
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a frequency that is not positive; as [`pressures_pa`](Self::pressures_pa).
    pub fn stiffness_and_drive(&self, freq_hz: f64, load: f64) -> Result<[c64; 2], MoldError> {
        let s = c64::new(0.0, TAU * positive("frequency", freq_hz)?);
        let opens = self.flow_gain(load)? * self.opening_per_error(s);
        let oil = s * (0.5 * self.volume_m3() / self.bulk_modulus_pa) + self.leakage;
        let per_flow = self.area_m2 * oil.inv();
        Ok([per_flow * (s * self.area_m2 + opens), per_flow * opens]) // (4)
    }

    /// The cylinder as an element of a model file.
    pub(crate) fn cylinder(
        &self,
        name: &str,
        node: &str,
        force: f64,
    ) -> Result<Cylinder, MoldError> {
        Ok(Cylinder {
            name: name.to_owned(),
            between: [node.to_owned(), simgap_model::GROUND.to_owned()],
            areas: [self.area_m2; 2],
            dead_volumes: [0.0; 2],
            stroke: self.oil_length_m,
            position: None,
            bulk_modulus: self.bulk_modulus_pa,
            leakage: self.leakage,
            external_leakage: 0.0,
            pressures: self.pressures_pa(force)?,
        })
    }

    /// The valve as an element of a model file.
    pub(crate) fn valve(&self, name: &str, cylinder: &str) -> Valve {
        Valve {
            name: name.to_owned(),
            cylinder: cylinder.to_owned(),
            from: None,
            rated_flow: self.rated_flow,
            rated_drop: self.rated_drop_pa,
            natural_freq: self.spool_freq_hz,
            damping_ratio: self.spool_damping_ratio,
            supply: self.supply_pa,
            tank: 0.0,
            overlap: 0.0,
            asymmetry: 0.0,
            supply_droop: 0.0,
        }
    }

    /// The controller as an element of a model file: from a reference block and a node to the opening.
    pub(crate) fn block(&self, name: &str, reference: &str, node: &str) -> Block {
        let gain = self.controller.gain_per_m;
        let (numerator, denominator) = match self.controller.integral_time_s {
            Some(time) => (vec![gain, gain / time], vec![1.0, 0.0]),
            None => (vec![gain], vec![1.0]),
        };
        Block {
            name: name.to_owned(),
            numerator,
            denominator,
            plus: vec![reference.to_owned()],
            minus: vec![node.to_owned()],
            force: None,
        }
    }
}
