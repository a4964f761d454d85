//! Free laws: what a place would need if no entry of the catalogue were asked.
//!
//! A residual that such a law explains at a place, and no entry does, comes from a law that the
//! catalogue lacks. They implement [`Effect`] to be scored and fitted like any entry. A model file
//! can hold one, so that a corrected model of an unknown cause can be simulated; none of them is
//! in the catalogue, because a table of values names no cause.

mod table;
mod tabulated_curve;
mod tabulated_force;

use simgap_model::Location;

use crate::{Effect, find};

pub use tabulated_force::VELOCITY_NODES;

use tabulated_curve::TabulatedCurve;
use tabulated_force::TabulatedForce;

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
