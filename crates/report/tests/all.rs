//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod browser;
mod chart;
mod common;
mod page;
mod summary;
