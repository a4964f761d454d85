//! Free laws: what a place would need if no entry of the catalogue were asked.
//!
//! A residual that such a law explains at a place, and no entry does, comes from a law that the
//! catalogue lacks. They implement [`Effect`] to be scored and fitted like any entry. A model file
//! can hold one, so that a corrected model of an unknown cause can be simulated; none of them is
//! in the catalogue, because a table of values names no cause.

mod tabulated_curve;
mod tabulated_force;

use simgap_model::Location;

use crate::{Effect, find};

pub use tabulated_force::VELOCITY_NODES;

use tabulated_curve::TabulatedCurve;
use tabulated_force::TabulatedForce;

/// A start has this share of the typical force, or of the channel, in each node.
const START: f64 = 0.05;
/// Nodes of a table in displacement, or in the value of a channel.
const NODES: usize = 9;
/// By this share of the range of a motion or a signal the nodes reach beyond it on either side: the
/// corrected motion may be larger than the nominal one.
const MARGIN: f64 = 0.1;

/// A table between equally spaced nodes: linear between them, constant beyond.
///
/// ```text
/// f(x) = f₀ + Σₖ (fₖ₊₁ − fₖ) r(x − k),   r(x) = min(max(x, 0), 1),   x = (N − 1) (z − z_lower) / (z_upper − z_lower)
/// ```
///
/// The ramps r have no branches, so that eight sets of values run side by side.
#[inline(always)]
fn table([lower, upper]: [f64; 2], values: &[f64; NODES], at: f64) -> f64 {
    let span = upper - lower;
    // A table of no width is a step.
    let span = if span == 0.0 { f64::MIN_POSITIVE } else { span };
    let x = (NODES - 1) as f64 * ((at - lower) / span);
    let mut sum = values[0];
    for k in 0..NODES - 1 {
        sum += (values[k + 1] - values[k]) * (x - k as f64).clamp(0.0, 1.0);
    }
    sum
}

/// A range with its margin.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let margin = MARGIN * (high - low);
    [low - margin, high + margin]
}

static FORCE: TabulatedForce = TabulatedForce;
static OF_INPUT: TabulatedCurve = TabulatedCurve { is_input: true };
static OF_CHANNEL: TabulatedCurve = TabulatedCurve { is_input: false };

/// The free laws: of a member, an input and a channel.
///
/// They are linear in their node values, and vanish where these are zero.
///
/// ```
/// use simgap_effects::{find, free_laws};
///
/// assert!(free_laws().iter().all(|law| find(law.kind()).is_none()));
/// ```
#[must_use]
pub fn free_laws() -> [&'static dyn Effect; 3] {
    [&FORCE, &OF_INPUT, &OF_CHANNEL]
}

/// The effect of a name that a model file may hold at a place: of the catalogue, or a free law.
///
/// ```
/// use simgap_effects::{SiteKind, find_law};
/// use simgap_model::Location;
///
/// let curve = find_law("tabulated_curve", &Location::Input("u".into())).ok_or("no such law")?;
/// assert_eq!(curve.site(), SiteKind::Input);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn find_law(kind: &str, at: &Location) -> Option<&'static dyn Effect> {
    let mut named: Vec<&'static dyn Effect> = free_laws().into();
    named.retain(|law| law.kind() == kind);
    let fits = named.iter().copied().find(|law| law.site().accepts(at));
    // At a wrong place any of them says which place it needs.
    find(kind).or(fits).or(named.first().copied())
}
