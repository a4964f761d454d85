//! Hydraulic elements: states of first order as coordinates of which only the rate counts.
//!
//! A pressure p obeys an equation of first order. As the rate of a coordinate q it stands in the equations of the plant
//! beside displacements, and whatever propagates, linearises and observes these does so with pressures:
//!
//! ```text
//! q̇ = (p − p₀)/P,   P = 1 MPa                                                                      (1)
//! (V/β) ṗ = Q                       is   M q̈ = P Q,   M = P² V/β                                     (2)
//! Q = −A v                          is   C entries + P A, and − P A for the force A p on the rod     (3)
//! Q = −C_l (p₁ − p₂)                is   a damper P² C_l between the two coordinates                 (4)
//! ```
//!
//! q itself, the integral of a pressure, enters no equation. P keeps the entries of M, C and K within a few decades of
//! each other.

mod cylinder;
mod flow;
mod valve;

pub use cylinder::Cylinder;
pub use flow::Edges;
pub use valve::Valve;

/// P of (1), Pa.
pub const PRESSURE_UNIT_PA: f64 = 1e6;
