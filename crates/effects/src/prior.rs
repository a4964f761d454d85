//! Prior distributions of the parameters of effects.
//!
//! Every parameter has one, proper and in proportion to what moves at its place ([`crate::SiteScale`]). A distribution is used
//! through its normal approximation in a coordinate u of the value in which it is near normal:
//!
//! ```text
//! p(u) = w · N(u; m, s²)                                                   (1)
//! ```
//!
//! | Distribution | u | m, s | w |
//! |---|---|---|---|
//! | size | ln \|v − v₀\| | ln median, `log_std` | ½ where both signs are physical |
//! | factor | ln \|v\| | 0, `log_std` | 1 − [`SLIPPED`] where slips of units are possible |
//! | factor, beside a slip f | ln \|v\| | ln \|f\|, [`EXACT`] | [`SLIPPED`] over the number of slips |
//! | factor that may be zero | ln v above 1, v − 1 below | 0, `log_std` | 1 |
//! | normal | v | mean, std | 1 |
//! | uniform | v | v, width/√2π | 1 |
//!
//! v₀ is the value at which the effect vanishes ([`Parameter::neutral`]).

use crate::parameter::Parameter;

/// Spread of a size in powers of e: 95 % of what is met lies within a factor of twenty of the typical size.
pub(crate) const SIZE_LOG_STD: f64 = 1.5;
/// Spread of a nominal value that is wrong: a factor of two is an everyday error.
const FACTOR_LOG_STD: f64 = std::f64::consts::LN_2;
/// Probability that a wrong gain is a slip of units or of the sign.
pub const SLIPPED: f64 = 0.2;
/// Spread of a gain about the slip that it is: as well as nominal values are known.
pub const EXACT: f64 = 0.03;

/// A gain that a slip of units or of the sign makes, and what an engineer calls it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// Factor on the gain.
    pub factor: f64,
    /// Name, such as `mm for m`.
    pub name: &'static str,
}

const fn slip(factor: f64, name: &'static str) -> Slip {
    Slip { factor, name }
}

/// The slips that gains of inputs and outputs are looked through for.
pub const SLIPS: [Slip; 15] = [
    slip(-1.0, "the opposite sign"),
    slip(1e3, "a thousandth of the unit (such as mm for m)"),
    slip(1e-3, "a thousand times the unit (such as kN for N)"),
    slip(1e6, "a millionth of the unit"),
    slip(1e-6, "a million times the unit"),
    slip(1e2, "a hundredth of the unit (such as cm for m)"),
    slip(1e-2, "a hundred times the unit"),
    slip(9.806_65, "kgf or g instead of N or m/s²"),
    slip(1.0 / 9.806_65, "g instead of m/s², or N instead of kgf"),
    slip(
        std::f64::consts::TAU,
        "turns instead of rad, or Hz instead of rad/s",
    ),
    slip(1.0 / std::f64::consts::TAU, "rad instead of turns"),
    slip(180.0 / std::f64::consts::PI, "degrees instead of rad"),
    slip(std::f64::consts::PI / 180.0, "rad instead of degrees"),
    slip(25.4, "inches and mm"),
    slip(60.0, "minutes and seconds"),
];

/// What is known of a parameter before any data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prior {
    /// Log-normal in the distance from where the effect vanishes.
    Size {
        /// Typical distance.
        median: f64,
        /// Standard deviation of its logarithm.
        log_std: f64,
    },
    /// Log-normal about one; a slip of units or of the sign where these are possible.
    Factor {
        /// Standard deviation of its logarithm.
        log_std: f64,
        /// Whether slips are possible.
        slips: bool,
    },
    /// Log-normal about one above one, normal below it down to zero: of what may not be there at all.
    UpToNothing {
        /// Standard deviation of its logarithm.
        log_std: f64,
    },
    /// Normal.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        std: f64,
    },
    /// Even over a range.
    Uniform {
        /// Length of the range.
        width: f64,
    },
}

/// The normal approximation (1) of a prior at a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalPrior {
    /// u.
    pub coordinate: f64,
    /// dv/du.
    pub slope: f64,
    /// m.
    pub mean: f64,
    /// s.
    pub std: f64,
    /// ln w.
    pub log_weight: f64,
}

/// The slip that a factor is within the error of a nominal value.
#[must_use]
pub fn slip_of(factor: f64) -> Option<Slip> {
    let near = |slip: &&Slip| {
        let ratio = factor / slip.factor;
        ratio > 0.0 && ratio.ln().abs() < 4.0 * EXACT
    };
    SLIPS.iter().find(near).copied()
}

impl Prior {
    /// Whether a value has a well-known cause that acts on many places alike: the unit of a logger.
    #[must_use]
    pub fn has_a_common_cause(&self, value: f64) -> bool {
        match self {
            Prior::Factor { slips, .. } => *slips && slip_of(value).is_some(),
            _ => false,
        }
    }

    /// The prior of a wrong nominal value.
    #[must_use]
    pub const fn factor() -> Prior {
        Prior::Factor {
            log_std: FACTOR_LOG_STD,
            slips: false,
        }
    }

    /// The prior of a wrong nominal value of what a machine may lack altogether, such as a damper.
    #[must_use]
    pub const fn factor_or_nothing() -> Prior {
        Prior::UpToNothing {
            log_std: FACTOR_LOG_STD,
        }
    }

    /// The prior of a wrong gain.
    #[must_use]
    pub const fn gain() -> Prior {
        Prior::Factor {
            log_std: FACTOR_LOG_STD,
            slips: true,
        }
    }

    /// The prior of a size about a typical one.
    #[must_use]
    pub const fn size(median: f64) -> Prior {
        Prior::Size {
            median,
            log_std: SIZE_LOG_STD,
        }
    }

    /// (1) at a value of a parameter. A size of nothing is taken as a billionth of a typical one.
    #[must_use]
    pub fn local(&self, value: f64, parameter: &Parameter) -> LocalPrior {
        match *self {
            Prior::Size { median, log_std } => {
                let neutral = parameter.neutral.filter(|n| n.is_finite()).unwrap_or(0.0);
                let distance = (value - neutral).abs().max(1e-9 * median).min(1e9 * median);
                let both_signs = parameter.lower < neutral && parameter.upper > neutral;
                LocalPrior {
                    coordinate: distance.ln(),
                    slope: distance,
                    mean: median.ln(),
                    std: log_std,
                    log_weight: if both_signs { 0.5_f64.ln() } else { 0.0 },
                }
            }
            Prior::Factor { log_std, slips } => {
                let size = value.abs().max(1e-12);
                let local = |mean: f64, std: f64, weight: f64| LocalPrior {
                    coordinate: size.ln(),
                    slope: size,
                    mean,
                    std,
                    log_weight: weight.ln(),
                };
                match slip_of(value).filter(|_| slips) {
                    Some(slip) => {
                        let weight = SLIPPED / SLIPS.len() as f64;
                        local(slip.factor.abs().ln(), EXACT, weight)
                    }
                    // A negative factor that is no slip of the sign is as unlikely as a wild one.
                    None if value < 0.0 => local(0.0, log_std, SLIPPED / SLIPS.len() as f64),
                    None if slips => local(0.0, log_std, 1.0 - SLIPPED),
                    None => local(0.0, log_std, 1.0),
                }
            }
            Prior::UpToNothing { log_std } => {
                let is_more = value > 1.0;
                LocalPrior {
                    coordinate: if is_more { value.ln() } else { value - 1.0 },
                    slope: if is_more { value } else { 1.0 },
                    mean: 0.0,
                    std: log_std,
                    log_weight: 0.0,
                }
            }
            Prior::Normal { mean, std } => LocalPrior {
                coordinate: value,
                slope: 1.0,
                mean,
                std,
                log_weight: 0.0,
            },
            Prior::Uniform { width } => LocalPrior {
                coordinate: value,
                slope: 1.0,
                mean: value,
                std: width / std::f64::consts::TAU.sqrt(),
                log_weight: 0.0,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SiteScale, find};

    #[test]
    fn verify_a_size_is_log_normal() {
        let parameter = Parameter::size("force_n", "N", 0.0, f64::INFINITY);
        let local = Prior::size(2.0).local(4.0, &parameter);
        assert_eq!(local.coordinate, 4.0_f64.ln());
        assert_eq!((local.slope, local.mean), (4.0, 2.0_f64.ln()));
        assert_eq!(local.log_weight, 0.0);
        let either = Parameter::size("force_n", "N", f64::NEG_INFINITY, f64::INFINITY);
        let local = Prior::size(2.0).local(-4.0, &either);
        assert_eq!(
            (local.coordinate, local.log_weight),
            (4.0_f64.ln(), 0.5_f64.ln())
        );
    }

    #[test]
    fn verify_slips_are_known_by_their_factor() {
        assert_eq!(slip_of(-1.01).map(|slip| slip.factor), Some(-1.0));
        assert_eq!(slip_of(990.0).map(|slip| slip.factor), Some(1e3));
        assert_eq!(slip_of(0.003), None);
        assert_eq!(slip_of(1.0), None);
        let parameter = Parameter::factor("gain_factor");
        let slipped = Prior::gain().local(1010.0, &parameter);
        let wild = Prior::gain().local(300.0, &parameter);
        let density = |local: LocalPrior| {
            let apart = (local.coordinate - local.mean) / local.std;
            local.log_weight - 0.5 * apart * apart - local.std.ln()
        };
        assert!(density(slipped) > density(wild) + 20.0);
    }

    #[test]
    fn verify_what_may_be_missing_costs_little() {
        let parameter = Parameter::factor("damping_factor");
        let apart = |value: f64| {
            let local = Prior::factor_or_nothing().local(value, &parameter);
            (local.coordinate - local.mean) / local.std
        };
        assert!((apart(2.0) - 1.0).abs() < 1e-12);
        assert!((apart(0.0) + 1.0 / FACTOR_LOG_STD).abs() < 1e-12);
        assert!((apart(1.0 + 1e-9) - apart(1.0 - 1e-9)).abs() < 1e-8);
    }

    #[test]
    fn verify_usual_values_are_usual() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        for effect in crate::catalogue() {
            for values in effect.usual(&scale) {
                for (place, parameter) in effect.parameters().iter().enumerate() {
                    let prior = effect.prior(place, &scale);
                    let local = prior.local(values[place], parameter);
                    let apart = (local.coordinate - local.mean) / local.std;
                    let shown = format!("{} {}: {prior:?}", effect.kind(), parameter.name);
                    assert!(local.std > 0.0 && local.std.is_finite(), "{shown}");
                    assert!(apart.abs() < 3.5, "{shown} at {}", values[place]);
                }
            }
        }
        let gain = find("sensor_gain").map(|effect| effect.prior(0, &scale));
        assert_eq!(gain, Some(Prior::gain()));
    }
}
