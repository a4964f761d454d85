//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod errors;
mod formats;
mod instruments;
mod loggers;
mod mended;
mod motion;
mod quality;
mod reading;
mod units;
mod variants;
mod writing;
