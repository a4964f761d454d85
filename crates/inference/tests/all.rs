//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used)]

mod common;
mod initial_states;
mod part;
