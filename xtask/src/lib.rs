//! Project tasks, one module per subcommand.

pub mod demo_records;
pub mod reproduce;
