//! Priors of single values, as functions of a coordinate that is even over 0 to 1.
//!
//! Draws are from the prior π itself, or from a wide distribution q about the estimate and weighted, which gives the same
//! integral with fewer points:
//!
//! ```text
//! ∫ L π du = ∫ (L π/q) q du,   q(u) = 1 / (π b (1 + z²)),   z = (u − û)/b    (1)
//! ```
//!
//! u is the coordinate in which the prior is normal. The tails of q are heavy (Cauchy's distribution): a tenth of the points
//! lie further than 6 b from the estimate, whatever the fit says of its spread.

use std::f64::consts::{PI, TAU};

use simgap_effects::{Parameter, Prior};

use crate::random::normal_quantile;

/// b of (1) over the spread that the fit states.
const WIDER: f64 = 2.0;
/// Part of q on the other side of where a size vanishes, if both signs are physical.
const MIRRORED: f64 = 0.1;

/// What is known of a value before any data.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Law {
    /// The prior of a parameter of an effect.
    OfEffect(Prior, Parameter),
    Normal {
        mean: f64,
        std: f64,
    },
}

/// A law, and how values are drawn from it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Marginal {
    law: Law,
    estimate: f64,
    /// û and b of (1), if draws are from q.
    about: Option<[f64; 2]>,
}

impl Marginal {
    pub(crate) fn from_prior(law: Law, estimate: f64) -> Marginal {
        Marginal {
            law,
            estimate,
            about: None,
        }
    }

    /// Drawn about an estimate that has this spread in the units of the value. A law that is even over a range is drawn from
    /// as it is.
    pub(crate) fn about(law: Law, estimate: f64, spread: f64) -> Marginal {
        let about = match law {
            Law::OfEffect(Prior::Uniform { .. }, _) => None,
            Law::OfEffect(prior, parameter) => {
                let local = prior.local(estimate, &parameter);
                Some([
                    local.coordinate,
                    WIDER * (spread / local.slope).min(local.std),
                ])
            }
            Law::Normal { std, .. } => Some([estimate, WIDER * spread.min(std)]),
        };
        Marginal {
            law,
            estimate,
            about,
        }
    }

    /// A value, and ln π/q there.
    pub(crate) fn draw(&self, below: f64) -> (f64, f64) {
        let Some([centre, width]) = self.about else {
            return (self.of_prior(below), 0.0);
        };
        let both_signs = self.has_both_signs();
        let is_mirrored = both_signs && below < MIRRORED;
        let (part, share) = match (both_signs, is_mirrored) {
            (false, _) => (below, 1.0),
            (true, true) => (below / MIRRORED, MIRRORED),
            (true, false) => ((below - MIRRORED) / (1.0 - MIRRORED), 1.0 - MIRRORED),
        };
        let z = (PI * (part - 0.5)).tan();
        let u = centre + width * z;
        let log_drawn = share.ln() - (PI * width * (1.0 + z * z)).ln();
        let value = self.value_at(u, is_mirrored);
        (value, self.log_density(u) - log_drawn)
    }

    /// û and du of one unit of the value, about the estimate.
    pub(crate) fn coordinate(&self) -> [f64; 2] {
        match self.law {
            Law::Normal { .. } => [self.estimate, 1.0],
            Law::OfEffect(Prior::Uniform { .. }, _) => [self.estimate, 1.0],
            Law::OfEffect(prior, parameter) => {
                let local = prior.local(self.estimate, &parameter);
                [local.coordinate, 1.0 / local.slope]
            }
        }
    }

    pub(crate) fn estimate(&self) -> f64 {
        self.estimate
    }

    /// u − û of another value; infinite on the other side of where a size vanishes.
    pub(crate) fn step_to(&self, value: f64) -> f64 {
        match self.law {
            Law::Normal { .. } => value - self.estimate,
            Law::OfEffect(Prior::Uniform { width }, _) => {
                let step = value - self.estimate;
                step - width * (step / width).round()
            }
            Law::OfEffect(prior, parameter) => {
                let neutral = neutral(&parameter);
                if (value < neutral) != (self.estimate < neutral) {
                    return f64::INFINITY;
                }
                let coordinate = |value: f64| prior.local(value, &parameter).coordinate;
                coordinate(value) - coordinate(self.estimate)
            }
        }
    }

    /// (u − m)/s of the law.
    pub(crate) fn apart(&self, u: f64) -> f64 {
        match self.law {
            Law::Normal { mean, std } => (u - mean) / std,
            Law::OfEffect(prior, parameter) => {
                let local = prior.local(self.estimate, &parameter);
                (u - local.mean) / local.std
            }
        }
    }

    /// Standard deviation of the law in u, as the core takes it.
    pub(crate) fn std(&self) -> f64 {
        match self.law {
            Law::Normal { std, .. } => std,
            Law::OfEffect(prior, parameter) => prior.local(self.estimate, &parameter).std,
        }
    }

    /// The value at u, on the side of the estimate, and ln π there.
    pub(crate) fn at(&self, u: f64) -> (f64, f64) {
        let log_density = match self.law {
            Law::OfEffect(Prior::Uniform { width }, parameter) => {
                let inside = match parameter.per_record {
                    true => (u - self.estimate).abs() < 0.5 * width,
                    false => (parameter.lower..=parameter.upper).contains(&u),
                };
                if inside {
                    -width.ln()
                } else {
                    f64::NEG_INFINITY
                }
            }
            _ => self.log_density(u),
        };
        (self.value_at(u, false), log_density)
    }

    /// ln π, in the coordinate u.
    fn log_density(&self, u: f64) -> f64 {
        let log_weight = match self.law {
            Law::Normal { .. } => 0.0,
            Law::OfEffect(prior, parameter) => prior.local(self.estimate, &parameter).log_weight,
        };
        log_weight - 0.5 * self.apart(u).powi(2) - (self.std() * TAU.sqrt()).ln()
    }

    fn has_both_signs(&self) -> bool {
        match self.law {
            Law::OfEffect(Prior::Size { .. }, parameter) => {
                parameter.lower < neutral(&parameter) && parameter.upper > neutral(&parameter)
            }
            _ => false,
        }
    }

    /// The value at u; of a size on the side of the estimate, or on the other one.
    fn value_at(&self, u: f64, is_mirrored: bool) -> f64 {
        match self.law {
            Law::OfEffect(Prior::Size { .. }, parameter) => {
                let neutral = neutral(&parameter);
                let sign = if (self.estimate < neutral) == is_mirrored {
                    1.0
                } else {
                    -1.0
                };
                neutral + sign * u.exp()
            }
            Law::OfEffect(Prior::Factor { .. }, _) => u.exp(),
            Law::OfEffect(Prior::UpToNothing { .. }, _) => {
                if u > 0.0 {
                    u.exp()
                } else {
                    1.0 + u
                }
            }
            Law::OfEffect(Prior::Normal { .. } | Prior::Uniform { .. }, _) | Law::Normal { .. } => {
                u
            }
        }
    }

    /// The value of which that part of the prior lies below.
    fn of_prior(&self, below: f64) -> f64 {
        let (prior, parameter) = match self.law {
            Law::Normal { mean, std } => return mean + std * normal_quantile(below),
            Law::OfEffect(prior, parameter) => (prior, parameter),
        };
        let u = |mean: f64, std: f64, below: f64| mean + std * normal_quantile(below);
        match prior {
            Prior::Size { median, log_std } if self.has_both_signs() => {
                let part = f64::abs(2.0 * below - 1.0).max(f64::MIN_POSITIVE);
                let is_positive = below > 0.5;
                let is_mirrored = is_positive == (self.estimate < neutral(&parameter));
                self.value_at(u(median.ln(), log_std, part), is_mirrored)
            }
            Prior::Size { median, log_std } => self.value_at(u(median.ln(), log_std, below), false),
            Prior::Factor { log_std, slips } => {
                assert!(!slips, "a prior with slips is in no case");
                self.value_at(u(0.0, log_std, below), false)
            }
            Prior::UpToNothing { log_std } => self.value_at(u(0.0, log_std, below), false),
            Prior::Normal { mean, std } => u(mean, std, below),
            // A phase is even over a turn, whichever.
            Prior::Uniform { width } if parameter.per_record => {
                self.estimate + width * (below - 0.5)
            }
            Prior::Uniform { width } => parameter.lower + width * below,
        }
    }
}

fn neutral(parameter: &Parameter) -> f64 {
    parameter.neutral.filter(|n| n.is_finite()).unwrap_or(0.0)
}

/// The density that the catalogue states at a value is that of the map, 1/(dv/dt), times the weight of the draw.
#[test]
fn verify_draws_have_the_densities_of_the_core() {
    let either = Parameter::size("force_n", "N", f64::NEG_INFINITY, f64::INFINITY);
    let positive = Parameter::size("force_n", "N", 0.0, f64::INFINITY);
    let factor = Parameter::factor("factor");
    let phase = Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record();
    let cases = [
        (Prior::size(3.0), either),
        (Prior::size(3.0), positive),
        (Prior::factor(), factor),
        (Prior::factor_or_nothing(), factor),
        (
            Prior::Normal {
                mean: 2.0,
                std: 0.3,
            },
            either,
        ),
        (Prior::Uniform { width: TAU }, phase),
    ];
    for (prior, parameter) in cases {
        let law = Law::OfEffect(prior, parameter);
        for marginal in [
            Marginal::from_prior(law, 1.1),
            Marginal::about(law, 1.1, 0.02),
        ] {
            for below in [0.03, 0.2, 0.45, 0.62, 0.9] {
                let (value, log_weight) = marginal.draw(below);
                let step = 1e-6;
                let slope =
                    (marginal.draw(below + step).0 - marginal.draw(below - step).0) / (2.0 * step);
                let local = prior.local(value, &parameter);
                let apart = (local.coordinate - local.mean) / local.std;
                let log_density = local.log_weight
                    - 0.5 * apart * apart
                    - (local.std * TAU.sqrt() * local.slope).ln();
                let left = log_density + slope.abs().ln() - log_weight;
                assert!(left.abs() < 1e-4, "{marginal:?} at {value}: {left}");
            }
        }
    }
}
