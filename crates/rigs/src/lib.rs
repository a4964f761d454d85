//! Machines with a withheld cause, simulated by code of their own.
//!
//! The cases are written from the contract of the command line alone: no other crate of the workspace takes part, so
//! that an error of the program is not repeated in the truth. [`draw_case`] gives the files of a case and
//! its truth, [`score`](score::score) compares answers with truths. Equal seeds and numbers give
//! equal bytes.

pub mod accept;
pub mod answer;
pub mod bench;
pub mod case;
mod cause;
pub mod chain;
mod deviate;
mod draft;
pub mod effect;
pub mod excite;
pub mod families;
mod faults;
mod foreign;
pub mod grid;
pub mod kinds;
pub mod law;
pub mod linear;
pub mod machine;
pub mod march;
mod mixed;
pub mod page;
pub mod plan;
pub mod plant;
mod records;
pub mod rng;
mod scale;
pub mod score;
mod size;
mod sizing;
pub mod truth;

pub use answer::Diagnosis;
pub use case::{Case, RigError, draw_case};
pub use page::page;
pub use plan::{Filter, Role};
pub use score::{Answer, Score, score};
pub use truth::Truth;
