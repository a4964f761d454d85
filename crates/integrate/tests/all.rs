//! The integration tests, one program: each file is one of its modules.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod exact;
mod exchange;
mod forward_adaptive;
mod forward_closed_form;
mod forward_energy;
mod forward_nonlinear;
mod forward_stability;
mod inverse_differences;
mod inverse_smoother;
mod lanes;
mod support;
