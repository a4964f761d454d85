//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bad_input;
mod commands;
mod common;
mod compare;
mod contract;
mod contract_runs;
mod init;
mod linear;
mod manners;
mod real_data;
mod records;
