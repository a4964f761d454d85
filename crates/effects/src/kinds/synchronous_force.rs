//! A force in proportion to the velocity times a carrier.

use std::f64::consts::TAU;

use simgap_integrate::exact::{ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use super::carrier::carriers_hz;
use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};

/// A force in proportion to the velocity times a carrier: a damping that swings in time, a brake or a drive whose
/// torque ripples with its supply. It vanishes where nothing moves, as a tone does not.
///
/// ```text
/// F = c_a sin(2π f t + φ) v,   t on the clock of the record
/// ```
/// In proportion to the displacement this is `time_varying_stiffness`. Every record has a phase of its own.
///
/// Reference: \[Nayfeh1979\], chapter 5.
pub(crate) struct SynchronousForce;

/// A start has this share of the typical force.
const START: f64 = 0.1;

struct Law {
    amplitude: f64,
    omega: f64,
    phase: f64,
}

impl ForceLaw for Law {
    lanes!(amplitude, omega, phase);

    fn force(&self, motion: MemberMotion) -> f64 {
        let carrier = elementary::sin(self.omega * motion.time_s + self.phase);
        self.amplitude * carrier * motion.velocity
    }
}

impl Effect for SynchronousForce {
    fn kind(&self) -> &'static str {
        "synchronous_force"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "a force at one frequency that grows with the velocity: a damping that swings in time"
    }

    fn equation(&self) -> &'static str {
        "F = c_a sin(2 pi f t + phi) v"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Nayfeh1979], chapter 5")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("damping_amplitude_n_s_per_m", "N s/m", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let amplitude = START * scale.force_n / scale.velocity_m_per_s;
        let carriers = carriers_hz(scale).into_iter();
        carriers.map(|freq| vec![amplitude, freq, 0.0]).collect()
    }

    fn clock(&self) -> Option<Clock> {
        Some(Clock {
            amplitude: 0,
            frequency: 1,
            phase: 2,
        })
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            amplitude: values[0],
            omega: TAU * values[1],
            phase: values[2],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "harmonic_force",
                "of a motion at constant speed both are a force at one frequency",
            ),
            (
                "time_varying_stiffness",
                "of a motion at one frequency a carrier times the displacement leaves the same two lines",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same motion at two frequencies: the lines grow with the velocity, those of a stiffness with the displacement"
    }
}
