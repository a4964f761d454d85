//! Where the gap lies, which effect causes it, how far it shrinks.
//!
//! [`diagnose`] takes a nominal model and records, and returns the answer ([`Diagnosis`]), the
//! corrected model and the predictions. It never sees what the cause is: records and model only.
//!
//! ```text
//! records -> runs -> nominal prediction -> search over small sets of effects
//!                                              |  score, fit, evidence
//!                             verdict <- rivals, held-back data
//!                                              |
//!                         gap on the check records, where it lies
//! ```

mod answer;
pub mod compare;
mod data;
mod diagnosis;
mod error;
mod evidence;
mod gap;
mod locate;
mod parity;
mod pipeline;
mod remainder;
mod search;
mod stand_in;
mod structure;
mod verdict;

pub use diagnosis::*;
pub use error::DiagnoseError;
pub use pipeline::{Outcome, Progress, Request, diagnose};
