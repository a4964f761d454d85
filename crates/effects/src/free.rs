//! Laws of any shape: what a place would need if no entry of the catalogue were asked.
//!
//! A residual that such a law explains at a place, and no entry does, comes from a law that the
//! catalogue lacks. They implement [`Effect`] to be scored like any entry; no model file can name
//! them.

use simgap_integrate::exact::{ForceLaw, MemberMotion, gather};

use crate::prior::{Prior, usual_prior};
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Functions of displacement and velocity in [`FreeForce`].
const FORCES: usize = 17;
/// Functions of a value in [`FreeCurve`].
const CURVES: usize = 6;
/// A start has this share of the typical force, or of the channel, in each function.
const START: f64 = 0.05;

/// Rises from −1 to 1 with slope `1 / width` at 0.
fn sigmoid(x: f64, width: f64) -> f64 {
    x / (x * x + width * width).sqrt()
}

/// |x| without its corner.
fn rounded(x: f64) -> f64 {
    const CORNER: f64 = 0.1;
    (x * x + CORNER * CORNER).sqrt() - CORNER
}

/// A force that depends on displacement and velocity in any smooth way.
///
/// ```text
/// F = Σ_k c_k φ_k(x, w),   x = (d − d_m) / d_s,   w = v / v_s
/// φ = σ(x; 0.05), σ(x; 0.3), σ(x; 1), |x|, x², x³,
///     σ(w; 0.05), σ(w; 0.2), σ(w; 0.8), |w|, w², w |w|, w³,
///     x w, |x| w, x² w, x w²,           σ(x; b) = x / √(x² + b²)
/// ```
struct FreeForce;

#[derive(Clone, Copy)]
struct Force {
    middle_m: f64,
    scale_m: f64,
    scale_m_per_s: f64,
    factors: [f64; FORCES],
}

impl Force {
    fn split(&self) -> [f64; FORCES + 3] {
        let mut all = [0.0; FORCES + 3];
        all[..3].copy_from_slice(&[self.middle_m, self.scale_m, self.scale_m_per_s]);
        all[3..].copy_from_slice(&self.factors);
        all
    }

    fn join(all: [f64; FORCES + 3]) -> Force {
        Force {
            middle_m: all[0],
            scale_m: all[1],
            scale_m_per_s: all[2],
            factors: std::array::from_fn(|k| all[k + 3]),
        }
    }
}

impl ForceLaw for Force {
    fn lanes(&self, peers: &[&dyn ForceLaw]) -> Option<Box<dyn simgap_integrate::exact::LaneLaw>> {
        gather(peers, Force::split, Force::join)
    }

    fn force(&self, motion: MemberMotion) -> f64 {
        let x = (motion.displacement - self.middle_m) / self.scale_m;
        let w = motion.velocity / self.scale_m_per_s;
        let functions = [
            sigmoid(x, 0.05),
            sigmoid(x, 0.3),
            sigmoid(x, 1.0),
            rounded(x),
            x * x,
            x * x * x,
            sigmoid(w, 0.05),
            sigmoid(w, 0.2),
            sigmoid(w, 0.8),
            rounded(w),
            w * w,
            w * w.abs(),
            w * w * w,
            x * w,
            rounded(x) * w,
            x * x * w,
            x * w * w,
        ];
        let terms = self.factors.iter().zip(functions);
        terms.map(|(factor, function)| factor * function).sum()
    }
}

impl Effect for FreeForce {
    fn kind(&self) -> &'static str {
        "a force of any shape"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "a force that depends on displacement and velocity in a way that no entry describes"
    }

    fn equation(&self) -> &'static str {
        "F = sum of c_k phi_k(d, v)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const SHAPES: [Parameter; 3] = [
            Parameter::shape("middle_m", "m", f64::NEG_INFINITY, f64::INFINITY),
            Parameter::shape("scale_m", "m", 0.0, f64::INFINITY),
            Parameter::shape("scale_m_per_s", "m/s", 0.0, f64::INFINITY),
        ];
        const FACTOR: Parameter =
            Parameter::size("factor_n", "N", f64::NEG_INFINITY, f64::INFINITY);
        const ALL: [Parameter; FORCES + 3] = {
            let mut all = [FACTOR; FORCES + 3];
            all[0] = SHAPES[0];
            all[1] = SHAPES[1];
            all[2] = SHAPES[2];
            all
        };
        &ALL
    }

    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        free_prior(self, place, scale, scale.force_n)
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.displacement_range_m;
        let start = Force {
            middle_m: 0.5 * (low + high),
            scale_m: scale.displacement_m,
            scale_m_per_s: scale.velocity_m_per_s,
            factors: [START * scale.force_n; FORCES],
        };
        vec![start.split().to_vec()]
    }

    fn action(&self, values: &[f64]) -> Action {
        let all = std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0));
        Action::Force(Box::new(Force::join(all)))
    }

    fn experiment(&self) -> &'static str {
        "slow loading forwards and back over the whole travel, then the same motion at three speeds: \
         force against displacement and against velocity show what kind of law is missing"
    }
}

/// A curve instead of a straight line between what goes in and what comes out.
///
/// ```text
/// z' = z + Σ_k c_k φ_k(x),   x = (z − z_m) / z_s
/// φ = σ(x; 0.1), σ(x; 0.5), |x|, x², x |x|, x³
/// ```
struct FreeCurve {
    kind: &'static str,
    site: SiteKind,
}

struct Curve {
    middle: f64,
    scale: f64,
    factors: [f64; CURVES],
}

impl SignalMap for Curve {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let curved = |&z: &f64| {
            let x = (z - self.middle) / self.scale;
            let functions = [
                sigmoid(x, 0.1),
                sigmoid(x, 0.5),
                rounded(x),
                x * x,
                x * x.abs(),
                x * x * x,
            ];
            let terms = self.factors.iter().zip(functions);
            z + terms
                .map(|(factor, function)| factor * function)
                .sum::<f64>()
        };
        signal.values.iter().map(curved).collect()
    }
}

impl Effect for FreeCurve {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn family(&self) -> Family {
        match self.site {
            SiteKind::Input => Family::Dynamics,
            _ => Family::Measurement,
        }
    }

    fn site(&self) -> SiteKind {
        self.site
    }

    fn summary(&self) -> &'static str {
        "a curve that no entry describes"
    }

    fn equation(&self) -> &'static str {
        "z' = z + sum of c_k phi_k(z)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const FACTOR: Parameter = Parameter::size("factor", "1", f64::NEG_INFINITY, f64::INFINITY);
        const ALL: [Parameter; CURVES + 2] = {
            let mut all = [FACTOR; CURVES + 2];
            all[0] = Parameter::shape("middle", "1", f64::NEG_INFINITY, f64::INFINITY);
            all[1] = Parameter::shape("scale", "1", 0.0, f64::INFINITY);
            all
        };
        &ALL
    }

    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        free_prior(self, place, scale, scale.signal)
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.signal_range;
        let mut start = vec![START * scale.signal; CURVES + 2];
        start[0] = 0.5 * (low + high);
        start[1] = scale.signal;
        vec![start]
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let curve = Curve {
            middle: value(0),
            scale: value(1),
            factors: std::array::from_fn(|k| value(k + 2)),
        };
        match self.site {
            SiteKind::Input => Action::Input(Box::new(curve)),
            _ => Action::Output(Box::new(curve)),
        }
    }

    fn experiment(&self) -> &'static str {
        "a slow staircase of known values over the whole range"
    }
}

/// A factor of either sign, as large as what is typical of the place.
fn free_prior(law: &dyn Effect, place: usize, scale: &SiteScale, std: f64) -> Prior {
    match law.parameters().get(place).and_then(|p| p.neutral) {
        Some(mean) => Prior::Normal { mean, std },
        None => usual_prior(law, place, scale),
    }
}

static FREE_FORCE: FreeForce = FreeForce;
static FREE_INPUT: FreeCurve = FreeCurve {
    kind: "an input curve of any shape",
    site: SiteKind::Input,
};
static FREE_SENSOR: FreeCurve = FreeCurve {
    kind: "a sensor curve of any shape",
    site: SiteKind::Channel,
};

/// The laws of any shape: of a member, an input and a channel.
///
/// They are not in the catalogue: no one learns the name of a cause from them, only that there is a
/// law where the catalogue has none.
///
/// ```
/// use simgap_effects::{find, free_laws};
///
/// assert!(free_laws().iter().all(|law| find(law.kind()).is_none()));
/// ```
#[must_use]
pub fn free_laws() -> [&'static dyn Effect; 3] {
    [&FREE_FORCE, &FREE_INPUT, &FREE_SENSOR]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_free_laws_vanish_with_their_factors() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        for law in free_laws() {
            let mut values = law.starts(&scale).swap_remove(0);
            assert_eq!(values.len(), law.parameters().len());
            for (value, parameter) in values.iter_mut().zip(law.parameters()) {
                *value = parameter.neutral.unwrap_or(*value);
            }
            match law.action(&values) {
                Action::Force(force) => {
                    let motion = MemberMotion {
                        displacement: 2e-3,
                        velocity: -0.2,
                        time_s: 0.0,
                        step_s: 0.0,
                    };
                    assert_eq!(force.force(motion), 0.0);
                }
                Action::Input(map) | Action::Output(map) => {
                    let signal = [0.5, -0.7];
                    assert_eq!(map.apply(Sampled::from_start(&signal, 1e-3)), signal);
                }
                _ => panic!("a law of any shape is a force or a curve"),
            }
        }
    }
}
