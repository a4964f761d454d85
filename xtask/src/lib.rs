//! Project tasks, one module per subcommand.

pub mod blind_check;
pub mod demo_records;
pub mod reproduce;
