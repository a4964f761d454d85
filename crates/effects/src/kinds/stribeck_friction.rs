//! Dry friction that falls from a break-away level to a sliding level.

use simgap_integrate::exact::{ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Dry friction that falls from a break-away level to a sliding level.
///
/// ```text
/// F = (Fc + (Fs - Fc) exp(-(v/vs)^2)) sgn(v), |F| <= Fs at rest
/// ```
pub(crate) struct StribeckFriction;

/// Stribeck speeds to start from, as shares of the typical speed.
const SHARES: [f64; 3] = [0.05, 0.2, 0.6];

/// Friction at rest over that while sliding, at the most: 1 to 3 is what is measured; more is
/// another law \[Armstrong1994\].
const MOST_OVER_SLIDING: f64 = 10.0;

struct Law {
    sliding: f64,
    excess: f64,
    /// 1/vs: a product costs less than a quotient.
    per_velocity: f64,
}

impl ForceLaw for Law {
    lanes!(sliding, excess, per_velocity);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn dry_level(&self, speed: f64) -> Option<f64> {
        let ratio = speed * self.per_velocity;
        Some(self.sliding + self.excess * elementary::exp(-ratio * ratio))
    }
}

impl Effect for StribeckFriction {
    fn kind(&self) -> &'static str {
        "stribeck_friction"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "dry friction that is higher at low speed than while sliding"
    }

    fn equation(&self) -> &'static str {
        "F = (Fc + (Fs - Fc) exp(-(v/vs)^2)) sgn(v), |F| <= Fs at rest"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[
            Parameter {
                name: "friction_force_n",
                unit: "N",
                lower: 0.0,
                upper: f64::INFINITY,
                neutral: Some(0.0),
                per_record: false,
            },
            Parameter {
                name: "breakaway_force_n",
                unit: "N",
                lower: 0.0,
                upper: f64::INFINITY,
                neutral: Some(0.0),
                per_record: false,
            },
            Parameter {
                name: "stribeck_velocity_m_per_s",
                unit: "m/s",
                lower: 1e-9,
                upper: f64::INFINITY,
                neutral: None,
                per_record: false,
            },
        ]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        SHARES
            .iter()
            .map(|share| {
                let velocity = share * scale.velocity_m_per_s;
                vec![0.1 * scale.force_n, 0.15 * scale.force_n, velocity]
            })
            .collect()
    }

    fn contains(&self) -> &'static [&'static str] {
        &["coulomb_friction"]
    }

    fn grown_from(&self, _kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        SHARES
            .iter()
            .map(|share| {
                vec![
                    0.9 * values[0],
                    1.3 * values[0],
                    share * scale.velocity_m_per_s,
                ]
            })
            .collect()
    }

    /// Friction at rest is not below that while sliding.
    fn make_physical(&self, values: &mut [f64]) {
        for (value, parameter) in values.iter_mut().zip(self.parameters()) {
            *value = value.clamp(parameter.lower, parameter.upper);
        }
        values[1] = values[1].max(values[0]);
    }

    fn has_support(&self, values: &[f64], _: &SiteScale) -> bool {
        values[1] <= MOST_OVER_SLIDING * values[0]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            sliding: values[0],
            excess: values[1] - values[0],
            per_velocity: 1.0 / values[2],
        }))
    }

    fn experiment(&self) -> &'static str {
        "slow motion through several speeds below the Stribeck speed, forwards and back"
    }
}
