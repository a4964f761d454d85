//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod audit;
mod between_samples;
mod check_records;
mod common;
mod compare;
mod free_decay;
mod free_plants;
mod mended;
mod own_laws;
mod records_apart;
mod simulators;
mod traps;
mod unconnected;
