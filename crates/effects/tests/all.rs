//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod catalogue;
mod common;
mod free_laws;
mod laws;
mod laws_chain;
mod laws_events;
mod laws_hydraulic;
mod laws_input;
mod laws_machine;
mod laws_memory;
mod laws_modes;
mod own_laws;
mod sites;
