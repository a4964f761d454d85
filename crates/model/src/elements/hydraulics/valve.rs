//! A servo valve that feeds a cylinder.

mod in_model;

use serde::{Deserialize, Serialize};

use super::flow::{Edges, root};
use crate::ModelError;
use crate::refuse::{finite_positive, item, node_name};

/// A four-way valve between supply, tank and the chambers of a cylinder, its spool a second-order system.
///
/// ```text
/// ẍ/ω² + 2 ζ ẋ/ω + x = u,   ω = 2π f₀                                                                (1)
/// o = x less the overlap, at most 1 either way;   K = Q_N/√Δp_N                                       (2)
/// x > 0:   Q₁ =  K o (1 + a) √(p_s − p₁),   Q₂ = −K o (1 + a) √(p₂ − p_t)                              (3)
/// x < 0:   Q₁ =  K o (1 − a) √(p₁ − p_t),   Q₂ = −K o (1 − a) √(p_s − p₂)                              (4)
/// ```
///
/// with √Δ for Δ/(Δ² + δ²)^¼, δ = 50 kPa, of either sign: the square root of turbulent flow, Q = C_d w x √(2 Δp/ρ), with
/// the finite slope of laminar flow at small drops.
///
/// | Symbol | Field | Unit |
/// |---|---|---|
/// | x | the node `name.spool`: share of the full opening | 1 |
/// | u | command, from an input of kind `command` or from a block | 1 |
/// | Q_N, Δp_N | `rated_flow` of one edge, fully open, at `rated_drop` | m³/s, Pa |
/// | f₀, ζ | `natural_freq`, `damping_ratio` | Hz, 1 |
/// | p_s, p_t | `supply`, `tank` | Pa |
/// | | `overlap`: share of the opening that passes nothing | 1 |
/// | a | `asymmetry` of the two directions | 1 |
/// | R | `supply_droop`: p_s falls by R Q while the valve draws Q | Pa s/m³ |
///
/// Reference: `merritt1967`, chapters 3 and 5.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Valve {
    /// Unique among valves.
    pub name: String,
    /// Name of the cylinder it feeds.
    pub cylinder: String,
    /// Name of the block that commands it, if one does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Q_N, m³/s.
    pub rated_flow: f64,
    /// Δp_N, Pa.
    pub rated_drop: f64,
    /// f₀, Hz.
    pub natural_freq: f64,
    /// ζ.
    pub damping_ratio: f64,
    /// p_s, Pa.
    pub supply: f64,
    /// p_t, Pa.
    #[serde(default)]
    pub tank: f64,
    /// Share of the opening.
    #[serde(default)]
    pub overlap: f64,
    /// a.
    #[serde(default)]
    pub asymmetry: f64,
    /// R, Pa s/m³.
    #[serde(default)]
    pub supply_droop: f64,
}

impl Valve {
    /// Name of the node of the spool.
    #[must_use]
    pub fn spool(&self) -> String {
        format!("{}.spool", self.name)
    }

    /// K, m³/(s √Pa).
    #[must_use]
    pub fn flow_gain(&self) -> f64 {
        self.rated_flow / self.rated_drop.sqrt()
    }

    /// The edges at a chamber (0 or 1).
    #[must_use]
    pub fn edges(&self, chamber: usize) -> Edges {
        Edges {
            flow_gain: self.flow_gain(),
            overlap: self.overlap,
            asymmetry: self.asymmetry,
            supply: self.supply,
            tank: self.tank,
            supply_droop: self.supply_droop,
            fills: if chamber == 0 { 1.0 } else { -1.0 },
        }
    }

    /// Flow into a chamber (0 or 1), m³/s, at a spool position and the pressure of the chamber, Pa: (2) to (4).
    #[must_use]
    pub fn flow(&self, chamber: usize, spool: f64, pressure: f64) -> f64 {
        self.edges(chamber).flow(spool, pressure)[0]
    }

    /// Flow into a chamber for each unit of the spool about a valve that opens either way, m³/s, at a pressure: the mean
    /// of the two directions, overlap and droop left out.
    #[must_use]
    pub fn opening_gain(&self, chamber: usize, pressure: f64) -> f64 {
        let [filling, _] = root(self.supply - pressure);
        let [emptying, _] = root(pressure - self.tank);
        let (forward, back, sign) = if chamber == 0 {
            (filling, emptying, 1.0)
        } else {
            (emptying, filling, -1.0)
        };
        let a = self.asymmetry;
        0.5 * sign * self.flow_gain() * ((1.0 + a) * forward + (1.0 - a) * back)
    }

    fn check(&self) -> Result<(), ModelError> {
        let place = item("valve", &self.name);
        node_name(&place, &self.name)?;
        for (quantity, value) in [
            ("rated_flow", self.rated_flow),
            ("rated_drop", self.rated_drop),
            ("natural_freq", self.natural_freq),
            ("damping_ratio", self.damping_ratio),
            ("supply", self.supply),
        ] {
            finite_positive(&place, quantity, value)?;
        }
        let ranges = [
            ("tank", self.tank, self.supply, "0 to the supply pressure"),
            ("overlap", self.overlap, 1.0, "0 to 1"),
            ("asymmetry", self.asymmetry.abs(), 1.0, "-1 to 1"),
            (
                "supply_droop",
                self.supply_droop,
                f64::MAX,
                "a number that is not negative",
            ),
        ];
        for (quantity, found, most, needed) in ranges {
            if !(0.0..=most).contains(&found) {
                return Err(ModelError::Value {
                    place,
                    quantity: quantity.into(),
                    found,
                    needed,
                });
            }
        }
        Ok(())
    }
}
