//! A spring whose stiffness swings in time.

use std::f64::consts::TAU;

use simgap_integrate::exact::{ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use super::carrier::carriers_hz;
use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring whose stiffness swings in time: a gear mesh, a rotating shaft that is not round.
///
/// ```text
/// F = k_a sin(2π f t + φ) d,   t on the clock of the record
/// ```
/// Every record has a phase of its own.
///
/// Reference: \[Nayfeh1979\], chapter 5.
pub(crate) struct TimeVaryingStiffness;

struct Law {
    amplitude: f64,
    omega: f64,
    phase: f64,
}

/// Half periods in a record that a sweep goes up to.
const SWEPT: usize = 256;

/// A tenth of the spring, at a frequency.
fn start(freq: f64, scale: &SiteScale) -> Vec<f64> {
    vec![0.1 * scale.stiffness_n_per_m, freq, 0.0]
}

impl ForceLaw for Law {
    lanes!(amplitude, omega, phase);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.amplitude
            * elementary::sin(self.omega * motion.time_s + self.phase)
            * motion.displacement
    }
}

impl Effect for TimeVaryingStiffness {
    fn kind(&self) -> &'static str {
        "time_varying_stiffness"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spring
    }

    fn summary(&self) -> &'static str {
        "the stiffness of the spring swings in time"
    }

    fn equation(&self) -> &'static str {
        "F = k_a sin(2 pi f t + phi) d"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Nayfeh1979], chapter 5")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("stiffness_amplitude_n_per_m", "N/m", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    /// A motion at one frequency and a stiffness at another leave lines at their sum and difference.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let carriers = carriers_hz(scale).into_iter();
        carriers.map(|freq| start(freq, scale)).collect()
    }

    /// Beside a motion of many frequencies it leaves no line of its own. Half a period more in the record for each, up
    /// to four times the frequency of the motion (twice that at which it excites a mode), or as far as [`SWEPT`] goes.
    fn sweep(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let step = 0.5 / scale.duration_s;
        let nyquist = 0.5 / scale.time_step_s;
        let motion = scale.motion_hz[0];
        let most = if motion > 0.0 {
            nyquist.min(4.0 * motion)
        } else {
            nyquist
        };
        (2..=SWEPT)
            .map(|half_periods| half_periods as f64 * step)
            .take_while(|freq| *freq < most)
            .map(|freq| start(freq, scale))
            .collect()
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
        &[(
            "harmonic_force",
            "of a member under a constant load both are a force at one frequency",
        )]
    }

    fn experiment(&self) -> &'static str {
        "the same excitation at several amplitudes: its lines grow with the motion, those of a force do not"
    }
}
