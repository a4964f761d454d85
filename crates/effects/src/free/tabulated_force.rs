//! A force tabulated over displacement and velocity.

use simgap_integrate::exact::{ForceLaw, LaneLaw, MemberMotion, gather};

use super::table::{NODES, START, table, widened};
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale, usual_prior};
use crate::prior::Prior;

/// A force tabulated over displacement and velocity.
///
/// ```text
/// F = f(d) + g(v)
/// ```
///
/// | Symbol | Meaning | Unit |
/// |---|---|---|
/// | f | table of nine equally spaced nodes from `displacement_lower_m` to `displacement_upper_m` | N |
/// | g | table with nodes at the shares [`VELOCITY_NODES`] of `velocity_limit_m_per_s`, to either side; g(0) = 0 | N |
///
/// Linear between nodes and constant beyond them. The nodes in velocity are closer to each other
/// near rest, where friction jumps.
pub(crate) struct TabulatedForce;

/// Nodes in velocity on either side.
const SIDE: usize = 5;

/// Where the nodes in velocity lie on either side of rest, as shares of the velocity limit.
pub const VELOCITY_NODES: [f64; SIDE] = [0.02, 0.1, 0.25, 0.5, 1.0];

/// The velocity limit is this multiple of the rms velocity.
const FASTEST: f64 = 3.0;

const SHAPES: usize = 3;
const ALL: usize = SHAPES + NODES + 2 * SIDE;

#[derive(Clone, Copy)]
struct Law {
    displacement_range_m: [f64; 2],
    velocity_limit: f64,
    of_displacement: [f64; NODES],
    /// From the fastest backward motion to the fastest forward one, without rest.
    of_velocity: [f64; 2 * SIDE],
}

impl Law {
    fn split(&self) -> [f64; ALL] {
        let mut all = [0.0; ALL];
        all[..2].copy_from_slice(&self.displacement_range_m);
        all[2] = self.velocity_limit;
        all[SHAPES..SHAPES + NODES].copy_from_slice(&self.of_displacement);
        all[SHAPES + NODES..].copy_from_slice(&self.of_velocity);
        all
    }

    fn join(all: [f64; ALL]) -> Law {
        Law {
            displacement_range_m: [all[0], all[1]],
            velocity_limit: all[2],
            of_displacement: std::array::from_fn(|k| all[SHAPES + k]),
            of_velocity: std::array::from_fn(|k| all[SHAPES + NODES + k]),
        }
    }

    /// g(v): outwards from rest, on the side of the motion; the other side adds nothing.
    #[inline(always)]
    fn of_velocity(&self, velocity: f64) -> f64 {
        let speed = velocity / self.velocity_limit;
        let sides = [-speed, speed];
        let mut sum = 0.0;
        for side in 0..2 {
            let (mut from, mut before) = (0.0, 0.0);
            for (k, to) in VELOCITY_NODES.into_iter().enumerate() {
                let node = if side == 0 { SIDE - 1 - k } else { SIDE + k };
                let value = self.of_velocity[node];
                let share = ((sides[side] - from) / (to - from)).clamp(0.0, 1.0);
                sum += (value - before) * share;
                (from, before) = (to, value);
            }
        }
        sum
    }
}

impl ForceLaw for Law {
    fn lanes(&self, peers: &[&dyn ForceLaw]) -> Option<Box<dyn LaneLaw>> {
        gather(peers, Law::split, Law::join)
    }

    fn force(&self, motion: MemberMotion) -> f64 {
        let of_displacement = table(
            self.displacement_range_m,
            &self.of_displacement,
            motion.displacement,
        );
        of_displacement + self.of_velocity(motion.velocity)
    }
}

impl Effect for TabulatedForce {
    fn kind(&self) -> &'static str {
        "tabulated_force"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "a force that depends on displacement and velocity as a table says, whatever its cause"
    }

    fn equation(&self) -> &'static str {
        "F = f(d) + g(v), each linear between nodes and constant beyond"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const NAMES: [&str; NODES + 2 * SIDE] = [
            "force_d0_n",
            "force_d1_n",
            "force_d2_n",
            "force_d3_n",
            "force_d4_n",
            "force_d5_n",
            "force_d6_n",
            "force_d7_n",
            "force_d8_n",
            "force_v0_n",
            "force_v1_n",
            "force_v2_n",
            "force_v3_n",
            "force_v4_n",
            "force_v5_n",
            "force_v6_n",
            "force_v7_n",
            "force_v8_n",
            "force_v9_n",
        ];
        const PARAMETERS: [Parameter; ALL] = {
            let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
            let mut all = [Parameter::shape("displacement_lower_m", "m", low, high); ALL];
            all[1] = Parameter::shape("displacement_upper_m", "m", low, high);
            all[2] = Parameter::shape("velocity_limit_m_per_s", "m/s", f64::MIN_POSITIVE, high);
            let mut node = 0;
            while node < NAMES.len() {
                all[SHAPES + node] = Parameter::size(NAMES[node], "N", low, high);
                node += 1;
            }
            all
        };
        &PARAMETERS
    }

    /// Of either sign, as large as what is typical of the place.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        match self.is_chosen(place) {
            true => usual_prior(self, place, scale),
            false => Prior::Normal {
                mean: 0.0,
                std: scale.force_n,
            },
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mut start = vec![START * scale.force_n; ALL];
        start[..2].copy_from_slice(&widened(scale.displacement_range_m));
        start[2] = FASTEST * scale.velocity_m_per_s;
        vec![start]
    }

    /// Only the node values are fitted: in them the law is linear.
    fn is_chosen(&self, place: usize) -> bool {
        place < SHAPES
    }

    /// A node that is left out holds no force.
    fn left_out(&self, parameter: &str) -> Option<f64> {
        parameter.starts_with("force_").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        let all = std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0));
        Action::Force(Box::new(Law::join(all)))
    }

    fn experiment(&self) -> &'static str {
        "slow loading forwards and back over the whole travel, then the same motion at three speeds: \
         force against displacement and against velocity show what kind of law is missing"
    }
}
