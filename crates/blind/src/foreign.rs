//! Effects that are not in the catalogue. The right answer to them is `unknown`.

use simgap_effects::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use simgap_integrate::exact::{ForceLaw, MemberMotion};

/// One force law with a size and one shape parameter.
struct Foreign {
    kind: &'static str,
    summary: &'static str,
    equation: &'static str,
    /// Size and shape at a site, from its displacement, velocity and force.
    start: fn(&SiteScale) -> [f64; 2],
    /// F of displacement, velocity, size and shape.
    force: fn(f64, f64, f64, f64) -> f64,
}

static FOREIGN: &[Foreign] = &[
    Foreign {
        kind: "foreign_saturating_spring",
        summary: "a spring whose force stops growing",
        equation: "F = F0 tanh(d / d0)",
        start: |scale| [0.3 * scale.force_n, 0.4 * scale.displacement_m],
        force: |d, _, size, shape| size * (d / shape).tanh(),
    },
    Foreign {
        kind: "foreign_root_friction",
        summary: "friction that grows with the square root of the speed",
        equation: "F = r v / (v^2 + v0^2)^(1/4)",
        start: |scale| {
            let root = scale.velocity_m_per_s.sqrt();
            [0.2 * scale.force_n / root, 0.05 * scale.velocity_m_per_s]
        },
        force: |_, v, size, shape| size * v / (v * v + shape * shape).sqrt().sqrt(),
    },
    Foreign {
        kind: "foreign_preload_spring",
        summary: "a preload that must be overcome on either side",
        equation: "F = F0 d / (|d| + d0)",
        start: |scale| [0.3 * scale.force_n, 0.1 * scale.displacement_m],
        force: |d, _, size, shape| size * d / (d.abs() + shape),
    },
    Foreign {
        kind: "foreign_travel_damping",
        summary: "damping that grows with the distance from the middle",
        equation: "F = c (d / d0)^2 v",
        start: |scale| {
            let damping = 0.1 * scale.force_n / scale.velocity_m_per_s;
            [damping, scale.displacement_m]
        },
        force: |d, v, size, shape| size * (d / shape) * (d / shape) * v,
    },
    Foreign {
        kind: "foreign_eddy_brake",
        summary: "a brake that is strongest at one speed",
        equation: "F = 2 F0 (v / v0) / (1 + (v / v0)^2)",
        start: |scale| [0.15 * scale.force_n, 0.4 * scale.velocity_m_per_s],
        force: |_, v, size, shape| {
            let ratio = v / shape;
            2.0 * size * ratio / (1.0 + ratio * ratio)
        },
    },
];

struct Law {
    force: fn(f64, f64, f64, f64) -> f64,
    size: f64,
    shape: f64,
}

impl ForceLaw for Law {
    fn force(&self, motion: MemberMotion) -> f64 {
        (self.force)(motion.displacement, motion.velocity, self.size, self.shape)
    }
}

impl Effect for Foreign {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn equation(&self) -> &'static str {
        self.equation
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[
            Parameter {
                name: "size",
                unit: "as the equation needs",
                lower: 0.0,
                upper: f64::INFINITY,
                neutral: Some(0.0),
                per_record: false,
            },
            Parameter {
                name: "shape",
                unit: "m or m/s",
                lower: 0.0,
                upper: f64::INFINITY,
                neutral: None,
                per_record: false,
            },
        ]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![(self.start)(scale).to_vec()]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            force: self.force,
            size: values[0],
            shape: values[1],
        }))
    }

    fn experiment(&self) -> &'static str {
        ""
    }
}

/// The effects of this crate that the catalogue does not have.
///
/// They implement [`Effect`] to be simulated like any other; no model file can name them.
///
/// ```
/// for effect in simgap_blind::foreign_effects() {
///     assert!(simgap_effects::find(effect.kind()).is_none());
/// }
/// ```
#[must_use]
pub fn foreign_effects() -> Vec<&'static dyn Effect> {
    FOREIGN.iter().map(|effect| effect as &dyn Effect).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_foreign_forces_are_finite_and_vanish_with_their_size() {
        for foreign in FOREIGN {
            for d in [-2.0, -1e-3, 0.0, 0.5] {
                for v in [-3.0, 0.0, 1e-6, 1.0] {
                    assert!((foreign.force)(d, v, 10.0, 0.3).is_finite());
                    assert_eq!((foreign.force)(d, v, 0.0, 0.3), 0.0);
                }
            }
        }
    }
}
