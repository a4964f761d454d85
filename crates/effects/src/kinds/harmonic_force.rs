//! A force at one frequency that the inputs do not hold.

use std::f64::consts::{FRAC_PI_2, TAU};

use simgap_integrate::exact::{ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::line::Line;

/// A force at one frequency that the inputs do not hold: an unbalance, a pump, another machine.
///
/// ```text
/// F(t) = A sin(2π f t + φ),   t on the clock of the record
/// ```
/// A positive force pushes the mass in the positive direction. Every record has a phase of its own.
///
/// Reference: \[DenHartog1956\], chapter 2.
pub(crate) struct HarmonicForce;

struct Law {
    amplitude: f64,
    omega: f64,
    phase: f64,
}

impl Law {
    /// What the amplitude has to be multiplied by for the straight lines between points `step_s` apart to push as much
    /// at the frequency of the force as the force itself: those through a tone hold sin²x / x² of it, x = ω h / 2. Points
    /// fewer than two a period do not show the tone.
    #[inline(always)]
    fn in_straight_lines(&self, step_s: f64) -> f64 {
        let half = (0.5 * self.omega * step_s).min(FRAC_PI_2);
        if half > 0.0 {
            let ratio = half / elementary::sin(half);
            ratio * ratio
        } else {
            1.0
        }
    }
}

impl ForceLaw for Law {
    lanes!(amplitude, omega, phase);

    /// Negative, for a member force pushes its first node back. Inlined, or the lanes would call it set by set.
    #[inline(always)]
    fn force(&self, motion: MemberMotion) -> f64 {
        let amplitude = self.amplitude * self.in_straight_lines(motion.step_s);
        -amplitude * elementary::sin(self.omega * motion.time_s + self.phase)
    }

    fn is_spread_over_steps(&self) -> bool {
        true
    }

    /// The two forces have one sine in common.
    fn beyond_step(&self, motion: MemberMotion) -> f64 {
        let sine = elementary::sin(self.omega * motion.time_s + self.phase);
        let amplitude = self.amplitude * self.in_straight_lines(motion.step_s);
        amplitude * sine - self.amplitude * sine
    }
}

impl Effect for HarmonicForce {
    fn kind(&self) -> &'static str {
        "harmonic_force"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Mass
    }

    fn summary(&self) -> &'static str {
        "a force at one frequency acts that the inputs do not hold"
    }

    fn equation(&self) -> &'static str {
        "F = A sin(2 pi f t + phi)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[DenHartog1956], chapter 2")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("amplitude_n", "N", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let lines = scale.lines_hz.into_iter().filter(|line| *line > 0.0);
        lines
            .map(|line| vec![0.1 * scale.force_n, line, 0.0])
            .collect()
    }

    fn clock(&self) -> Option<Clock> {
        Some(Clock {
            amplitude: 0,
            frequency: 1,
            phase: 2,
        })
    }

    fn line(&self, values: &[f64]) -> Option<Line> {
        self.clock().map(|clock| clock.line(values))
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
                "tone_pickup",
                "with one output a tone on the cable looks the same",
            ),
            (
                "attached_mode",
                "a lightly damped mode rings at one frequency",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a record with the drive off and a second sensor: what shakes the machine shows in both"
    }
}
