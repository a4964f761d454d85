//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
mod exchange;
mod iso18571;
mod lines;
mod metrics;
mod noise;
mod peaks;
mod spectrum;
mod welch;
