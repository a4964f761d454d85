//! A double-acting cylinder between two nodes.

mod in_model;

use serde::{Deserialize, Serialize};

use crate::ModelError;
use crate::refuse::{finite_positive, item, node_name};

/// A double-acting cylinder: the rod is node a, the housing node b of `between`.
///
/// ```text
/// (V₁/β) ṗ₁ = Q₁ − A₁ v − C_l (p₁ − p₂) − C_e p₁                                                     (1)
/// (V₂/β) ṗ₂ = Q₂ + A₂ v + C_l (p₁ − p₂) − C_e p₂                                                     (2)
/// F = A₁ p₁ − A₂ p₂                      pushes a forward and b back                                  (3)
/// V₁ = V₀₁ + A₁ s,    V₂ = V₀₂ + A₂ (S − s)                                                           (4)
/// ```
///
/// | Symbol | Field | Unit |
/// |---|---|---|
/// | A₁, A₂ | `areas` | m² |
/// | V₀₁, V₀₂ | `dead_volumes`, pipes to the valve included | m³ |
/// | S, s | `stroke`, `position`: about which the record moves | m |
/// | β | `bulk_modulus`: 1.4 to 1.7 GPa, 0.7 to 1.0 with air in the oil (`merritt1967`, chapter 2) | Pa |
/// | C_l, C_e | `leakage` past the piston, `external_leakage` of each chamber | m³/(s Pa) |
/// | p₀ | `pressures` at the start, about which pressures are computed | Pa |
/// | v | velocity of a less that of b | m/s |
///
/// The volumes are those at `position`: valid for motions that are small beside the columns of oil, s and S − s.
///
/// Reference: `merritt1967`, chapter 6.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Unique among cylinders; the pressures are the nodes `name.p1` and `name.p2`.
    pub name: String,
    /// Rod and housing.
    #[serde(deserialize_with = "crate::two::two")]
    pub between: [String; 2],
    /// A₁ and A₂, m².
    #[serde(deserialize_with = "crate::two::two")]
    pub areas: [f64; 2],
    /// V₀₁ and V₀₂, m³.
    #[serde(deserialize_with = "crate::two::two")]
    pub dead_volumes: [f64; 2],
    /// S, m.
    pub stroke: f64,
    /// s, m; half the stroke where it is not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// β, Pa.
    pub bulk_modulus: f64,
    /// C_l, m³/(s Pa).
    #[serde(default)]
    pub leakage: f64,
    /// C_e, m³/(s Pa).
    #[serde(default)]
    pub external_leakage: f64,
    /// p₀ of the two chambers, Pa.
    #[serde(deserialize_with = "crate::two::two")]
    #[serde(default)]
    pub pressures: [f64; 2],
}

impl Cylinder {
    /// The names of the nodes of the two pressures.
    #[must_use]
    pub fn chambers(&self) -> [String; 2] {
        [1, 2].map(|chamber| format!("{}.p{chamber}", self.name))
    }

    /// V₁ and V₂, m³, (4).
    #[must_use]
    pub fn volumes_m3(&self) -> [f64; 2] {
        let at = self.position.unwrap_or(0.5 * self.stroke);
        let columns = [at, self.stroke - at];
        [0, 1].map(|i| self.dead_volumes[i] + self.areas[i] * columns[i])
    }

    /// Stiffness of the shut-in oil, β (A₁²/V₁ + A₂²/V₂), N/m.
    #[must_use]
    pub fn oil_stiffness(&self) -> f64 {
        let volumes = self.volumes_m3();
        let each = [0, 1].map(|i| self.areas[i] * self.areas[i] / volumes[i]);
        self.bulk_modulus * (each[0] + each[1])
    }

    fn check(&self) -> Result<(), ModelError> {
        let place = item("cylinder", &self.name);
        node_name(&place, &self.name)?;
        finite_positive(&place, "stroke", self.stroke)?;
        finite_positive(&place, "bulk_modulus", self.bulk_modulus)?;
        for area in self.areas {
            finite_positive(&place, "areas", area)?;
        }
        for volume in self.volumes_m3() {
            finite_positive(&place, "volume at the position", volume)?;
        }
        let refused = |quantity: &str, found: f64, needed| ModelError::Value {
            place: place.clone(),
            quantity: quantity.into(),
            found,
            needed,
        };
        let in_stroke = |at: f64| (0.0..=self.stroke).contains(&at);
        if let Some(at) = self.position.filter(|at| !in_stroke(*at)) {
            return Err(refused("position", at, "0 to the stroke"));
        }
        for (quantity, value) in [
            ("leakage", self.leakage),
            ("external_leakage", self.external_leakage),
            ("dead_volumes", self.dead_volumes[0]),
            ("dead_volumes", self.dead_volumes[1]),
            ("pressures", self.pressures[0]),
            ("pressures", self.pressures[1]),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(refused(quantity, value, "a number that is not negative"));
            }
        }
        Ok(())
    }
}
