//! A spring that remembers its way (Bouc-Wen).

use simgap_integrate::exact::{Followed, ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use super::slid;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring that remembers its way and yields (Bouc-Wen).
///
/// ```text
/// F = k z
/// dz/dd = 1 − (β sgn(z ḋ) + γ) |z / u_y|ⁿ,   γ = 1 − β                              (1)
/// ```
///
/// For n that is not whole, |z|ⁿ stands for what is linear in n between the whole numbers beside it.
/// With β + γ = 1 the force levels off at k u_y. In the usual letters, ż = A ḋ − β′ |ḋ| |z|ⁿ⁻¹ z −
/// γ′ ḋ |z|ⁿ, the yield displacement is (A / (β′ + γ′))^(1/n).
///
/// Reference: \[Ikhouane2007\], chapter 2.
pub(crate) struct Hysteresis;

/// Largest step of (2), in yield displacements over n, before [`reach`] stretches it.
const STEP: f64 = 0.25;
/// From here on the force has levelled off.
const LEVEL: f64 = 1.0 - 1e-10;

struct Law {
    stiffness: f64,
    yield_displacement: f64,
    loop_share: f64,
    exponent: f64,
    start: f64,
}

impl Law {
    /// dy/dx of (1), where y = s z / u_y and x = |Δd| / u_y for a move of sign s:
    ///
    /// ```text
    /// dy/dx = 1 − yⁿ  for y > 0,   1 + (2β − 1) |y|ⁿ  for y < 0                 (2)
    /// ```
    #[inline(always)]
    fn slope(&self, y: f64) -> f64 {
        let yielding = if y < 0.0 {
            1.0 - 2.0 * self.loop_share
        } else {
            1.0
        };
        1.0 - yielding * power(y.abs(), self.exponent)
    }

    /// One step of (2) by the classical Runge-Kutta method, from y where `way` is ahead: y after it and
    /// how far it went.
    #[inline(always)]
    fn step(&self, y: f64, way: f64) -> (f64, f64) {
        let longest = STEP / self.exponent * reach(y);
        // Against its own force z moves this much faster at most.
        let back = longest / (2.0 * self.loop_share).max(1.0);
        let h = way.min(if y < 0.0 { back } else { longest });
        let k1 = self.slope(y);
        let k2 = self.slope(y + 0.5 * h * k1);
        let k3 = self.slope(y + 0.5 * h * k2);
        let k4 = self.slope(y + h * k3);
        let next = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        // (2) has a kink at zero: the step ends there.
        let crosses = y < 0.0 && next > 0.0;
        let to_zero = self.way_to_zero(y, k1);
        (
            if crosses { 0.0 } else { next },
            if crosses { to_zero } else { h },
        )
    }

    /// The way ∫ dy / (dy/dx) from y < 0, where dy/dx is `slope`, to zero, where it is 1, by Simpson's rule.
    #[inline(always)]
    fn way_to_zero(&self, y: f64, slope: f64) -> f64 {
        let middle = self.slope(0.5 * y);
        // 1/a + 4/b + 1 in one division.
        -y * (middle + 4.0 * slope + slope * middle) / (6.0 * slope * middle)
    }
}

/// How much longer a step may be where little is left of the way to the level. There 1 − y falls as e⁻ⁿˣ:
/// a step of h is off by (n h)⁵/120 of 1 − y, so that steps twice as long where 1 − y is below 1/2⁵ are
/// as good. Not further than by 8: at n h = 4 the method is unstable.
#[inline(always)]
fn reach(y: f64) -> f64 {
    const LEFT: f64 = 1.0 / 32.0;
    let doubled = |below: f64| if 1.0 - y < below { 2.0 } else { 1.0 };
    doubled(LEFT) * doubled(LEFT * LEFT) * doubled(LEFT * LEFT * LEFT)
}

/// |z|ⁿ for a whole n up to 4; between whole numbers linear in n, which costs no logarithm.
#[inline(always)]
fn power(size: f64, exponent: f64) -> f64 {
    let square = size * size;
    let (below, share) = if exponent < 2.0 {
        (size, exponent - 1.0)
    } else if exponent < 3.0 {
        (square, exponent - 2.0)
    } else {
        (square * size, exponent - 3.0)
    };
    below * (1.0 - share + share * size)
}

impl ForceLaw for Law {
    lanes!(stiffness, yield_displacement, loop_share, exponent, start);

    fn force(&self, _: MemberMotion) -> f64 {
        self.stiffness * self.yield_displacement * self.start
    }

    fn remembers(&self) -> bool {
        true
    }

    fn first_memory(&self) -> f64 {
        self.start
    }

    /// (2) along the move; the memory is z / u_y.
    #[inline(always)]
    fn follow_step(
        &self,
        memory: f64,
        left: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        let moved = (to.displacement - from.displacement) / self.yield_displacement;
        // Depends on the move alone: in lanes the division is taken out of the loop over its steps.
        let share_per_yield = 1.0 / moved.abs();
        let (s, way) = (moved.signum(), moved.abs() * left);
        let y = s * memory;
        let ahead = way > 0.0 && y < LEVEL;
        let (next, went) = self.step(y, way);
        let z = if ahead {
            s * next.clamp(-1.0, 1.0)
        } else {
            memory
        };
        Followed {
            force: self.stiffness * self.yield_displacement * z,
            memory: z,
            left: if ahead && went < way {
                (left - went * share_per_yield).max(0.0)
            } else {
                0.0
            },
        }
    }
}

/// Springs that yield within the motion and beyond it, of a stiffness that may follow from where.
fn starts(stiffness: impl Fn(f64) -> f64, scale: &SiteScale) -> Vec<Vec<f64>> {
    let mut starts = vec![];
    for share in [0.1, 0.4, 1.2] {
        let yields_at = share * scale.displacement_m;
        for exponent in [1.0, 2.0] {
            starts.push(vec![stiffness(yields_at), yields_at, 0.5, exponent, 0.0]);
        }
    }
    starts
}

impl Effect for Hysteresis {
    fn kind(&self) -> &'static str {
        "hysteresis"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "the force depends on the way the member came: a loop that yields"
    }

    fn equation(&self) -> &'static str {
        "F = k z, dz/dd = 1 - (beta sgn(z d') + 1 - beta) |z / u_y|^n"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Ikhouane2007], chapter 2")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("hysteretic_stiffness_n_per_m", "N/m", 0.0, f64::INFINITY),
                Parameter::shape("yield_displacement_m", "m", 0.0, f64::INFINITY),
                Parameter::shape("loop_share", "1", 0.05, 2.0),
                Parameter::shape("exponent", "1", 1.0, 4.0),
                Parameter::size("start_share", "1", -1.0, 1.0).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        starts(|yields_at| 0.1 * scale.force_n / yields_at, scale)
    }

    /// It yields along the travel of a record: short of that there is no loop, and a spring with another origin in each record is none.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        values[1] <= scale.travel_m
    }

    /// Short of the yield displacement it is a spring.
    fn turns_into(&self) -> &'static [&'static str] {
        &["linear_stiffness"]
    }

    fn grown_from(&self, _kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        match values[0] > 0.0 {
            true => starts(|_| values[0], scale),
            false => vec![],
        }
    }

    fn shrunk_to(&self, _kind: &str, values: &[f64], _: &SiteScale) -> Option<Vec<f64>> {
        Some(vec![values[0]])
    }

    fn own_starts(&self, values: &[f64]) -> Vec<Vec<f64>> {
        slid::starts(values, 4)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            stiffness: values[0],
            yield_displacement: values[1].max(f64::MIN_POSITIVE),
            loop_share: values[2],
            exponent: values[3],
            start: values[4],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "presliding_friction",
                "Dahl friction is this law with n = 1 and gamma = 0",
            ),
            (
                "coulomb_friction",
                "where the yield displacement is small against the motion",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow cycles of growing amplitude: the loops keep their shape at any speed and open with the amplitude"
    }
}
