//! Project tasks, one module per subcommand.

pub mod asked;
pub mod blind_check;
pub mod demo_records;
pub mod effects_docs;
pub mod generated;
pub mod machines;
mod mold_records;
pub mod reproduce;
pub mod rigs;
mod slide_records;
pub mod stability;
pub mod tidy;
pub mod tutorial_records;
