//! A tabulated curve of a channel.

use super::table::{NODES, START, table, widened};
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale, usual_prior};
use crate::prior::Prior;
use crate::signal_map::{Sampled, SignalMap};

/// A tabulated curve instead of a straight line between what goes into a channel and what comes out.
///
/// ```text
/// z' = z + h(z)
/// ```
///
/// h is a table of nine equally spaced nodes from `lower_level` to `upper_level`: linear between
/// them, constant beyond. Of an input, z is what was measured and z' what drives the plant; of an
/// output, z is the true value and z' what the sensor delivers.
pub(crate) struct TabulatedCurve {
    pub(super) is_input: bool,
}

const SHAPES: usize = 2;
const ALL: usize = SHAPES + NODES;

struct Curve {
    range: [f64; 2],
    change: [f64; NODES],
}

impl SignalMap for Curve {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let curved = |&z: &f64| z + table(self.range, &self.change, z);
        signal.values.iter().map(curved).collect()
    }
}

const fn parameters(unit: &'static str) -> [Parameter; ALL] {
    const NAMES: [&str; NODES] = [
        "change_0", "change_1", "change_2", "change_3", "change_4", "change_5", "change_6",
        "change_7", "change_8",
    ];
    let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut all = [Parameter::shape("lower_level", unit, low, high); ALL];
    all[1] = Parameter::shape("upper_level", unit, low, high);
    let mut node = 0;
    while node < NODES {
        all[SHAPES + node] = Parameter::size(NAMES[node], unit, low, high);
        node += 1;
    }
    all
}

impl Effect for TabulatedCurve {
    fn kind(&self) -> &'static str {
        "tabulated_curve"
    }

    fn family(&self) -> Family {
        if self.is_input {
            Family::Dynamics
        } else {
            Family::Measurement
        }
    }

    fn site(&self) -> SiteKind {
        if self.is_input {
            SiteKind::Input
        } else {
            SiteKind::Channel
        }
    }

    fn summary(&self) -> &'static str {
        "a channel follows a curve that a table gives, whatever its cause"
    }

    fn equation(&self) -> &'static str {
        "z' = z + h(z), h linear between nodes and constant beyond"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const OF_INPUT: [Parameter; ALL] = parameters("unit of the input");
        const OF_OUTPUT: [Parameter; ALL] = parameters("unit of the output");
        if self.is_input { &OF_INPUT } else { &OF_OUTPUT }
    }

    /// Of either sign, as large as what is typical of the place.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        match self.is_chosen(place) {
            true => usual_prior(self, place, scale),
            false => Prior::Normal {
                mean: 0.0,
                std: scale.signal,
            },
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mut start = vec![START * scale.signal; ALL];
        start[..SHAPES].copy_from_slice(&widened(scale.signal_range));
        vec![start]
    }

    /// Only the node values are fitted: in them the law is linear.
    fn is_chosen(&self, place: usize) -> bool {
        place < SHAPES
    }

    /// A node that is left out changes nothing.
    fn left_out(&self, parameter: &str) -> Option<f64> {
        parameter.starts_with("change_").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let curve = Box::new(Curve {
            range: [value(0), value(1)],
            change: std::array::from_fn(|k| value(SHAPES + k)),
        });
        if self.is_input {
            Action::Input(curve)
        } else {
            Action::Output(curve)
        }
    }

    fn experiment(&self) -> &'static str {
        "a slow staircase of known values over the whole range"
    }
}
