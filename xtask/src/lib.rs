//! Project tasks, one module per subcommand.

pub mod blind_check;
pub mod demo_records;
pub mod effects_docs;
pub mod generated;
mod mold_records;
pub mod reproduce;
pub mod rigs;
mod slide_records;
pub mod tidy;
pub mod tutorial_records;
