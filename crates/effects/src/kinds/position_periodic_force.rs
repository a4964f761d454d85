//! A force that repeats along the travel.

use std::f64::consts::TAU;
use std::iter::successors;

use simgap_integrate::exact::{ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use crate::Wave;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A force that repeats along the travel: cogging, a screw, a row of teeth.
///
/// ```text
/// F = a sin(2π d / p) + b cos(2π d / p)
/// ```
/// Where nothing shows at which d a record begins, a shift of all d turns a and b into each other: b is then what it was at the
/// start of a fit, and the places at which the records begin say the rest. p is no longer than the travel of a record.
///
/// Reference: \[Otten1997\], cogging of a linear motor.
pub(crate) struct PositionPeriodicForce;

struct Law {
    sine: f64,
    cosine: f64,
    per_metre: f64,
}

impl ForceLaw for Law {
    lanes!(sine, cosine, per_metre);

    fn force(&self, motion: MemberMotion) -> f64 {
        let (sin, cos) = elementary::sin_cos(self.per_metre * motion.displacement);
        self.sine * sin + self.cosine * cos
    }
}

/// Periods within the travel of a record: what is not seen whole does not repeat, and is any smooth curve.
const FEWEST: f64 = 1.0;
const MOST: f64 = 30.0;
/// From one start to the next: a sixth of the periods, and at the most half a period, by which two waves part over the
/// range as far as a fit can follow.
const STEP: f64 = 1.17;
const MOST_STEP: f64 = 0.5;
/// Number of usual ones.
const USUAL: i32 = 22;

/// Small forces with so many periods over the travel.
fn of_periods(scale: &SiteScale, counts: impl Iterator<Item = f64>) -> Vec<Vec<f64>> {
    let force = 0.05 * scale.force_n;
    counts
        .map(|periods| vec![force, force, scale.travel_m / periods])
        .collect()
}

impl Effect for PositionPeriodicForce {
    fn kind(&self) -> &'static str {
        "position_periodic_force"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "a force repeats along the travel, such as cogging"
    }

    fn equation(&self) -> &'static str {
        "F = a sin(2 pi d / p) + b cos(2 pi d / p)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Otten1997], cogging of a linear motor")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("sine_n", "N", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::size("cosine_n", "N", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::shape("period_m", "m", 1e-12, f64::INFINITY),
            ]
        }
    }

    /// The fit finds a period only near by: the starts are close to each other.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let next = |periods: &f64| Some((periods * STEP).min(periods + MOST_STEP));
        of_periods(
            scale,
            successors(Some(FEWEST), next).take_while(|periods| *periods < MOST),
        )
    }

    /// From one period to 27, each a sixth more.
    fn usual(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        of_periods(scale, (0..USUAL).map(|k| FEWEST * STEP.powi(k)))
    }

    fn wave(&self) -> Option<Wave> {
        Some(Wave {
            sine: 0,
            cosine: 1,
            period: 2,
        })
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            sine: values[0],
            cosine: values[1],
            per_metre: TAU / values[2],
        }))
    }

    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        FEWEST * values[2] <= scale.travel_m
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "cubic_stiffness",
                "a period about as long as the travel bends the force like a soft spring",
            ),
            (
                "harmonic_force",
                "at constant speed the period in space is one in time",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow motion over the whole travel in both directions: the force repeats at the same places"
    }
}
