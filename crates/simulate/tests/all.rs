//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod batch;
mod bodies;
mod forced;
mod held;
mod linear;
mod nonlinear;
mod outside;
mod own_laws;
mod run;
mod servo;
mod support;
