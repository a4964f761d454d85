//! Project tasks, one module per subcommand.

pub mod demo_records;
pub mod effects_docs;
pub mod reproduce;
pub mod tidy;
