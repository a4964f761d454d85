//! From motion to its derivatives: measured displacement to velocity and acceleration.
//!
//! Two families. The finite differences of [`Differentiator`] are local and carry no parameter;
//! noise of standard deviation σ leaves them as σ‖c‖/h. The smoother of [`kalman_smoother`] weighs
//! the whole record by a stated noise model and reports how sure it is.
//!
//! What each does to a sine of any frequency up to Nyquist is known in closed form:
//! [`transfer`] and [`smoother_transfer`].

mod differentiator;
mod estimate;
mod flat_start;
mod likelihood;
mod matrix3;
mod smoother;
mod transfer;

pub use differentiator::{
    BACKWARD_EULER_WEIGHTS, BDF2_WEIGHTS, CENTRAL_FOURTH_WEIGHTS, CENTRAL_SECOND_WEIGHTS,
    DerivedMotion, Differentiator, PARK_WEIGHTS, central_difference, derive_motion, differentiate,
    park_derivative,
};
pub use likelihood::{MaximumLikelihood, fit_noise_model};
pub use smoother::{NoiseModel, SmoothedMotion, kalman_smoother};
pub use transfer::{exact_transfer, smoother_transfer, transfer};
