//! The list of effects. One line each; everything else follows from it.

use crate::Effect;
use crate::kinds::*;

static CATALOGUE: &[&dyn Effect] = &[
    // Nominal parameters.
    &mass_error::MassError,
    &stiffness_error::StiffnessError,
    &damping_error::DampingError,
    &input_gain::InputGain,
    &pendulum_error::PendulumError,
    &load_error::LoadError,
    &parameter_error::ParameterError,
    // Forces.
    &viscous_damping::ViscousDamping,
    &linear_stiffness::LinearStiffness,
    &coulomb_friction::CoulombFriction,
    &stribeck_friction::StribeckFriction,
    &quadratic_damping::QuadraticDamping,
    &cubic_stiffness::CubicStiffness,
    &quadratic_stiffness::QuadraticStiffness,
    &constant_force::ConstantForce,
    &asymmetric_damping::AsymmetricDamping,
    &presliding_friction::PreslidingFriction,
    &hysteresis::Hysteresis,
    &backlash::Backlash,
    &bilinear_stiffness::BilinearStiffness,
    &end_stop::EndStop,
    &force_limit::ForceLimit,
    &harmonic_force::HarmonicForce,
    &position_periodic_force::PositionPeriodicForce,
    &time_varying_stiffness::TimeVaryingStiffness,
    &synchronous_force::SynchronousForce,
    // Missing dynamics.
    &attached_mode::AttachedMode,
    &flexible_support::FlexibleSupport,
    &input_lag::InputLag,
    &input_delay::InputDelay,
    &input_dead_zone::InputDeadZone,
    &input_saturation::InputSaturation,
    &input_rate_limit::InputRateLimit,
    &held_input::HeldInput,
    // Hydraulics.
    &internal_leakage::InternalLeakage,
    &external_leakage::ExternalLeakage,
    &bulk_modulus::BulkModulus,
    &valve_dead_band::ValveDeadBand,
    &valve_asymmetry::ValveAsymmetry,
    &spool_lag::SpoolLag,
    &supply_sag::SupplySag,
    // Measurement chain.
    &sensor_bias::SensorBias,
    &sensor_gain::SensorGain,
    &sensor_drift::SensorDrift,
    &sensor_delay::SensorDelay,
    &sensor_lag::SensorLag,
    &clipping::Clipping,
    &quantisation::Quantisation,
    &alternating_timing::AlternatingTiming,
    &alternating_gain::AlternatingGain,
    &tone_pickup::TonePickup,
    &synchronous_tone::SynchronousTone,
    &gain_ripple::GainRipple,
    &dropouts::Dropouts,
    &outliers::Outliers,
    &clock_skew::ClockSkew,
];

/// Every effect known, nominal parameters first.
#[must_use]
pub fn catalogue() -> &'static [&'static dyn Effect] {
    CATALOGUE
}

/// The effect of a name.
#[must_use]
pub fn find(kind: &str) -> Option<&'static dyn Effect> {
    CATALOGUE
        .iter()
        .copied()
        .find(|effect| effect.kind() == kind)
}
