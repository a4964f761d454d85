//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod in_place;
mod intervals;
mod mended;
mod search;
mod starts;
mod support;
