//! Exact first-order-hold propagation of the linear part with nonlinear forces on top.

mod columns;
mod dry;
pub mod elementary;
mod expm;
mod joint;
mod kernel;
pub mod lanes;
mod law;
mod march;
mod members;
mod plant;
mod propagator;
mod role;
mod secant;
mod together;

pub use expm::matrix_exponential;
pub use lanes::{LaneLaw, gather};
pub use law::{Element, Followed, ForceLaw, MemberMotion, Port, Tangent};
pub use march::{Excitation, Snapshot};
pub use propagator::ExactPropagator;
