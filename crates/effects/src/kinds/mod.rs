//! One file per effect.

pub(crate) mod alternating_gain;
pub(crate) mod alternating_timing;
pub(crate) mod clipping;
pub(crate) mod constant_force;
pub(crate) mod coulomb_friction;
pub(crate) mod cubic_stiffness;
pub(crate) mod damping_error;
pub(crate) mod input_gain;
pub(crate) mod linear_stiffness;
pub(crate) mod mass_error;
pub(crate) mod quadratic_damping;
pub(crate) mod quadratic_stiffness;
pub(crate) mod quantisation;
pub(crate) mod sensor_bias;
pub(crate) mod sensor_delay;
pub(crate) mod sensor_drift;
pub(crate) mod sensor_gain;
pub(crate) mod sensor_lag;
pub(crate) mod stiffness_error;
pub(crate) mod stribeck_friction;
pub(crate) mod tone_pickup;
pub(crate) mod viscous_damping;
