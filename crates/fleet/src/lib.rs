//! Many machines: a plan says where their records lie, each machine and day is one diagnosis, the answers go into a table,
//! and a report tells what is common to all machines, what is one machine's own, and what cannot be told from a day.
//!
//! ```text
//! plan ──▶ units ──▶ answer (anywhere) ──▶ table: machine=M/date=D/diagnosis.parquet ──▶ observations ──▶ findings ──▶ page
//! ```
//!
//! A unit is a line of JSON and its answer the bytes of one Parquet file, so that any engine can do the work: the threads of
//! [`run`], or whatever calls [`answer`]. The same inputs give the same bytes. Nothing here prints or reads a clock.

mod answer;
mod charts;
pub mod course;
mod error;
pub mod factor;
pub mod findings;
pub mod observe;
mod page;
pub mod pattern;
mod plan;
pub mod population;
mod prior;
mod report;
mod row;
mod run;
pub mod scope;
mod table;
mod time;
mod unit;
mod words;

pub use answer::{Answered, answer};
pub use error::FleetError;
pub use pattern::is_remote;
pub use plan::{MachineEntry, Plan, SCHEMA};
pub use prior::NominalOfFleet;
pub use report::{Fleet, ModelOfFleet, report};
pub use row::{FIXED_COLUMNS, Role, Row};
pub use run::{Counts, Done, answer_alone, longest_first, resumed, run};
pub use table::{Table, encode};
pub use unit::{Unit, units};
