//! Effects that are not in the catalogue. The right answer to them is `unknown`.

use simgap_effects::{Action, Effect, Family, Parameter, Sampled, SignalMap, SiteKind, SiteScale};
use simgap_integrate::exact::{ForceLaw, MemberMotion};

/// One law with a size and one shape parameter.
struct Foreign {
    kind: &'static str,
    summary: &'static str,
    equation: &'static str,
    /// Size and shape at a site, from what is typical there.
    start: fn(&SiteScale) -> [f64; 2],
    law: Law,
}

/// What a law is of.
#[derive(Clone, Copy)]
enum Law {
    /// F of displacement, velocity, size and shape.
    Force(fn(f64, f64, f64, f64) -> f64),
    /// What arrives of an input, of its value, size and shape.
    Input(fn(f64, f64, f64) -> f64),
    /// What a sensor delivers, of the true value, size and shape.
    Sensor(fn(f64, f64, f64) -> f64),
}

static FOREIGN: &[Foreign] = &[
    Foreign {
        kind: "foreign_saturating_spring",
        summary: "a spring whose force stops growing",
        equation: "F = F0 tanh(d / d0)",
        start: |scale| [0.3 * scale.force_n, 0.4 * scale.displacement_m],
        law: Law::Force(|d, _, size, shape| size * (d / shape).tanh()),
    },
    Foreign {
        kind: "foreign_root_friction",
        summary: "friction that grows with the square root of the speed",
        equation: "F = r v / (v^2 + v0^2)^(1/4)",
        start: |scale| {
            let root = scale.velocity_m_per_s.sqrt();
            [0.2 * scale.force_n / root, 0.05 * scale.velocity_m_per_s]
        },
        law: Law::Force(|_, v, size, shape| size * v / (v * v + shape * shape).sqrt().sqrt()),
    },
    Foreign {
        kind: "foreign_preload_spring",
        summary: "a preload that must be overcome on either side",
        equation: "F = F0 d / (|d| + d0)",
        start: |scale| [0.3 * scale.force_n, 0.1 * scale.displacement_m],
        law: Law::Force(|d, _, size, shape| size * d / (d.abs() + shape)),
    },
    Foreign {
        kind: "foreign_travel_damping",
        summary: "damping that grows with the distance from the middle",
        equation: "F = c (d / d0)^2 v",
        start: |scale| {
            let damping = 0.1 * scale.force_n / scale.velocity_m_per_s;
            [damping, scale.displacement_m]
        },
        law: Law::Force(|d, v, size, shape| size * (d / shape) * (d / shape) * v),
    },
    Foreign {
        kind: "foreign_eddy_brake",
        summary: "a brake that is strongest at one speed",
        equation: "F = 2 F0 (v / v0) / (1 + (v / v0)^2)",
        start: |scale| [0.15 * scale.force_n, 0.4 * scale.velocity_m_per_s],
        law: Law::Force(|_, v, size, shape| {
            let ratio = v / shape;
            2.0 * size * ratio / (1.0 + ratio * ratio)
        }),
    },
    Foreign {
        kind: "foreign_weak_drive",
        summary: "a drive that delivers less and less the more is asked of it",
        equation: "u_plant = u / (1 + (s u / u0)^2)^(1/2)",
        start: |scale| [0.5, scale.signal],
        law: Law::Input(|u, size, shape| {
            let ratio = size * u / shape;
            u / (1.0 + ratio * ratio).sqrt()
        }),
    },
    Foreign {
        kind: "foreign_curved_sensor",
        summary: "a sensor whose gain depends on what it measures",
        equation: "y_measured = y + s y |y| / y0",
        start: |scale| [0.1, scale.signal],
        law: Law::Sensor(|y, size, shape| y + size * y * y.abs() / shape),
    },
];

struct ForceOf {
    force: fn(f64, f64, f64, f64) -> f64,
    size: f64,
    shape: f64,
}

impl ForceLaw for ForceOf {
    fn force(&self, motion: MemberMotion) -> f64 {
        (self.force)(motion.displacement, motion.velocity, self.size, self.shape)
    }
}

struct ValueOf {
    value: fn(f64, f64, f64) -> f64,
    size: f64,
    shape: f64,
}

impl SignalMap for ValueOf {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let values = signal.values.iter();
        let map = |&value: &f64| (self.value)(value, self.size, self.shape);
        values.map(map).collect()
    }
}

impl Effect for Foreign {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn family(&self) -> Family {
        match self.law {
            Law::Force(_) => Family::Force,
            Law::Input(_) => Family::Dynamics,
            Law::Sensor(_) => Family::Measurement,
        }
    }

    fn site(&self) -> SiteKind {
        match self.law {
            Law::Force(_) => SiteKind::Member,
            Law::Input(_) => SiteKind::Input,
            Law::Sensor(_) => SiteKind::Channel,
        }
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
                unit: "as the equation needs",
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
        let [size, shape] = [values[0], values[1]];
        match self.law {
            Law::Force(force) => Action::Force(Box::new(ForceOf { force, size, shape })),
            Law::Input(value) => Action::Input(Box::new(ValueOf { value, size, shape })),
            Law::Sensor(value) => Action::Output(Box::new(ValueOf { value, size, shape })),
        }
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
    fn prop_foreign_laws_are_finite_and_vanish_with_their_size() {
        for foreign in FOREIGN {
            for d in [-2.0, -1e-3, 0.0, 0.5] {
                for v in [-3.0, 0.0, 1e-6, 1.0] {
                    let [with, without] = match foreign.law {
                        Law::Force(force) => [force(d, v, 10.0, 0.3), force(d, v, 0.0, 0.3)],
                        Law::Input(value) | Law::Sensor(value) => {
                            [value(d, 10.0, 0.3), value(d, 0.0, 0.3) - d]
                        }
                    };
                    assert!(with.is_finite());
                    assert_eq!(without, 0.0, "{}", foreign.kind);
                }
            }
        }
    }
}
