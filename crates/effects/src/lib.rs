//! The catalogue of unmodelled effects: one file per effect, physical and measurement.
//!
//! An effect says what it is called, where it can sit, which parameters it has and what it does;
//! fit, report, documentation, tests and withheld cases follow from that. To add one, write its
//! file and add its line to the list in `catalogue.rs`.
//!
//! ```
//! use simgap_effects::{Action, SiteKind, catalogue, find};
//! use simgap_integrate::exact::MemberMotion;
//!
//! assert_eq!(catalogue().len(), 56);
//! let spring = find("cubic_stiffness").ok_or("not in the catalogue")?;
//! assert_eq!(spring.parameters()[0].unit, "N/m^3");
//! // 2000 N/m³ at 0.1 m: 2 N.
//! let Action::Force(law) = spring.action(&[2000.0]) else {
//!     return Err("not a force".into());
//! };
//! let motion = MemberMotion { displacement: 0.1, ..MemberMotion::default() };
//! assert!((law.force(motion) - 2.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod catalogue;
mod effect;
mod equivalent;
mod error;
mod free;
mod kinds;
mod line;
mod own_law;
mod parameter;
mod place;
mod prior;
mod scale;
mod signal_map;
mod wave;

pub use catalogue::{catalogue, find};
pub use effect::{
    Action, Clock, Effect, Family, LINES, LawOfModel, ModelChange, Parameter, SiteKind, SiteScale,
    unit_of_rotation, usual_prior,
};
pub use equivalent::{Equivalent, equivalents, equivalents_beside, likelier_line};
pub use error::EffectError;
pub use free::{VELOCITY_NODES, find_law, free_laws};
pub use line::Line;
pub use own_law::{catalogue_of, find_in, find_of, own_laws};
pub use place::{Placed, places_of, same_place, sites};
pub use prior::{EXACT, LocalPrior, Prior, SLIPPED, SLIPS, Slip, slip_of};
pub use signal_map::{Sampled, SignalMap, most_beyond};
pub use wave::Wave;
