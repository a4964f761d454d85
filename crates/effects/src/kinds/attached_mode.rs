//! A mass that the model lacks rides on one that it has.

use std::f64::consts::TAU;

use simgap_model::{Damper, Location, Mass, Model, Spring};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale, usual_prior};
use crate::prior::Prior;

/// A mass that the model lacks rides on one that it has: a panel, a hose, a flexible load, seen at
/// its host as one more mode.
///
/// ```text
/// mₐ z̈ + cₐ (ż − ẋ) + kₐ (z − x) = 0,   F = cₐ (ż − ẋ) + kₐ (z − x)   on the host      (1)
/// kₐ = mₐ ω²,   cₐ = 2 ζ mₐ ω,   ω = 2π f                                            (2)
/// ```
///
/// The mass of the host stays what the model says; f and ζ are those of the attachment on a host
/// that is held. At the first sample of a record the hidden mass is off the place and the speed at
/// which it would ride along by values of that record's own.
///
/// Reference: \[DenHartog1956\], chapter 3.
pub(crate) struct AttachedMode;

/// Name of the hidden mass.
const NAME: &str = "(attached)";

/// Natural frequencies tried at the most.
const MOST_OCTAVES: i32 = 10;
/// Masses over that of the host that a force at one frequency may come from.
const HEAVIER: [f64; 3] = [0.1, 1.0, 10.0];

/// Damping ratio of a mode that rings on through the longest record, T: ζ = 1 / (ω T).
pub(super) fn rings_on(scale: &SiteScale, freq: f64) -> f64 {
    1.0 / (TAU * freq * scale.duration_s)
}

/// Whether a mode of a decay rate, 1/s, dies away along the longest record, or like the mass that it moves where that hardly
/// does: one that nothing damps is a tone.
pub(super) fn dies_away(decay_per_s: f64, scale: &SiteScale) -> bool {
    let of_host = scale.damping_n_s_per_m / (2.0 * scale.mass_kg);
    decay_per_s * scale.duration_s > DIES_AWAY * (of_host * scale.duration_s).min(1.0)
}

pub(super) fn unused_name(model: &Model, stem: &str) -> String {
    let taken = |name: &str| model.masses.iter().any(|mass| mass.name == name);
    let mut name = stem.to_string();
    while taken(&name) {
        name.push('\'');
    }
    name
}

fn attach(model: &mut Model, at: &Location, [mass, freq_hz, damping_ratio]: [f64; 3]) {
    let Location::Mass(host) = at else {
        return;
    };
    if mass <= 0.0 {
        return;
    }
    let name = unused_name(model, NAME);
    let omega = TAU * freq_hz;
    let between = [name.clone(), host.clone()];
    model.masses.push(Mass {
        name: name.clone(),
        value: mass,
        uncertainty: None,
    });
    // (2)
    model.springs.push(Spring {
        name: name.clone(),
        between: between.clone(),
        stiffness: mass * omega * omega,
        uncertainty: None,
    });
    model.dampers.push(Damper {
        name,
        between,
        damping: 2.0 * damping_ratio * mass * omega,
        uncertainty: None,
    });
}

/// Natural frequencies half an octave apart, from the strongest line of the motion upwards as far as
/// the sample rate goes.
pub(super) fn octaves(scale: &SiteScale) -> impl Iterator<Item = f64> + use<> {
    let first = scale.motion_hz[0].max(2.0 / scale.duration_s);
    let nyquist = 0.5 / scale.time_step_s;
    let each = (0..MOST_OCTAVES).map(move |i| first * 2.0_f64.powf(0.5 * f64::from(i)));
    each.take_while(move |freq| *freq < nyquist)
}

/// What two modes of a mass on a spring, of which the model has one, say of the other.
pub(super) struct Hidden {
    /// Natural frequency of the other on a host that is held, squared, Hz².
    pub(super) own: f64,
    /// By how much more the squares of both together exceed those of each alone, Hz².
    pub(super) coupling: f64,
}

/// What pairs of lines that the model leaves say of a hidden mode, if they are the modes of the host and of it,
///
/// ```text
/// f₁² f₂² = f₀² fₕ²,   f₁² + f₂² = f₀² + fₕ² + c,   f₀ of the host alone
/// ```
pub(super) fn of_pairs_of_lines(scale: &SiteScale) -> Vec<Hidden> {
    let host = scale.stiffness_n_per_m / scale.mass_kg / (TAU * TAU);
    let lines = scale.lines_hz.iter().filter(|f| **f > 0.0);
    let squares: Vec<f64> = lines.map(|f| f * f).collect();
    let pairs = (0..squares.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let hidden = pairs.map(|(i, j)| {
        let own = squares[i] * squares[j] / host;
        let coupling = squares[i] + squares[j] - host - own;
        Hidden { own, coupling }
    });
    hidden
        .filter(|hidden| hidden.coupling > 0.0 && hidden.own.is_finite())
        .collect()
}

/// Smallest attached mass, as a share of its host.
const LIGHTEST: f64 = 1e-5;
/// With more damping a hidden mass does not vibrate.
pub(super) const RINGS: f64 = 1.0;
/// Share of its amplitude, about, that a mode loses along a record at the least, or of the decay of the mass that it moves.
const DIES_AWAY: f64 = 0.1;

impl Effect for AttachedMode {
    fn kind(&self) -> &'static str {
        "attached_mode"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Mass
    }

    fn summary(&self) -> &'static str {
        "a mass that the model lacks vibrates on one that it has: a further mode"
    }

    fn equation(&self) -> &'static str {
        "m_a z'' + c_a (z' - x') + k_a (z - x) = 0, k_a = m_a (2 pi f)^2, c_a = 4 pi zeta f m_a"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[DenHartog1956], chapter 3")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("attached_mass_kg", "kg", 0.0, f64::INFINITY),
                Parameter::shape("natural_freq_hz", "Hz", 0.0, f64::INFINITY),
                Parameter::shape("damping_ratio", "1", 1e-4, 2.0),
                Parameter::size(
                    "start_displacement_m",
                    "m",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                )
                .of_record(),
                Parameter::size(
                    "start_velocity_m_per_s",
                    "m/s",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                )
                .of_record(),
            ]
        }
    }

    /// A mass that hangs on another is seldom heavier than it.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        match place {
            0 => Prior::Size {
                median: 0.1 * scale.mass_kg,
                log_std: 1.0,
            },
            _ => usual_prior(self, place, scale),
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let nyquist = 0.5 / scale.time_step_s;
        let mut freqs: Vec<f64> = scale.lines_hz.to_vec();
        for motion in scale.motion_hz.into_iter().take(1) {
            freqs.extend([0.6, 1.5, 3.0].map(|factor| factor * motion));
        }
        if freqs.iter().all(|freq| *freq <= 0.0) {
            let usual = scale.velocity_m_per_s / scale.displacement_m / TAU;
            freqs.extend([0.7, 1.5, 3.0].map(|factor| factor * usual));
        }
        let mut starts = vec![];
        for freq in freqs.into_iter().filter(|f| *f > 0.0 && *f < nyquist) {
            for damping_ratio in [0.02, 0.15] {
                starts.push(vec![0.1 * scale.mass_kg, freq, damping_ratio, 0.0, 0.0]);
            }
        }
        for Hidden { own, coupling } in of_pairs_of_lines(scale) {
            let (mass, freq) = (coupling / own * scale.mass_kg, own.sqrt());
            if freq < nyquist {
                starts.push(vec![mass, freq, rings_on(scale, freq), 0.0, 0.0]);
            }
        }
        starts
    }

    /// A lighter one is no mass but a force that dies away, carried by a start kilometres off; one that does not
    /// ring is a force that lags the motion, and no mode; nor does a record show one above half its sample rate, or one that
    /// takes longer than the record to swing once, or that does not die away.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        values[0] >= LIGHTEST * scale.mass_kg
            && values[1] < 0.5 / scale.time_step_s
            && values[1] * scale.duration_s > 1.0
            && dies_away(values[2] * TAU * values[1], scale)
            && values[2] < RINGS
    }

    fn turns_into(&self) -> &'static [&'static str] {
        &["mass_error"]
    }

    fn resembles(&self) -> &'static [&'static str] {
        &["flexible_support", "harmonic_force"]
    }

    /// A factor q on the host is a mass m (q − 1) that moves with it. A force at one frequency is a mass that rings on ([`rings_on`]). A support of stiffness kₛ and mass mₛ behind
    /// a spring k is a softer spring and a hidden mass: kₐ = k² / (k + kₛ), ω² = (k + kₛ) / mₛ.
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        if kind == "flexible_support" {
            let (own, both) = (scale.stiffness_n_per_m, scale.stiffness_n_per_m + values[0]);
            let omega = (both / values[1]).sqrt();
            let mass = own * own / both / (omega * omega);
            let damping_ratio = values[2] * (values[0] / both).sqrt();
            let start = vec![mass, omega / TAU, damping_ratio, 0.0, 0.0];
            let is_finite = start.iter().all(|value| value.is_finite());
            return if is_finite { vec![start] } else { vec![] };
        }
        if kind == "harmonic_force" {
            let freq = values[1];
            let ratio = rings_on(scale, freq);
            let masses = HEAVIER.map(|heavier| heavier * scale.mass_kg);
            return masses.map(|mass| vec![mass, freq, ratio, 0.0, 0.0]).into();
        }
        let added = (values[0] - 1.0) * scale.mass_kg;
        if !(added > 0.0 && added.is_finite()) {
            return vec![];
        }
        octaves(scale)
            .flat_map(|freq| [0.02, 0.15].map(|ratio| vec![added, freq, ratio, 0.0, 0.0]))
            .collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        let own = [values[0], values[1], values[2]];
        Action::Mode {
            change: Box::new(move |model, at| attach(model, at, own)),
            start: [values[3], values[4]],
        }
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "mass_error",
                "well below its natural frequency the hidden mass only adds to its host",
            ),
            (
                "harmonic_force",
                "excited in a narrow band, a mode and a tone look alike",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a sine sweep through the suspected frequency: a mode answers in proportion to the input and turns the phase"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_ring_or_rings_between_the_samples_is_no_mode() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        let nyquist_hz = 0.5 / scale.time_step_s;
        let is_mode = |freq_hz: f64, damping_ratio: f64| {
            let values = [0.1 * scale.mass_kg, freq_hz, damping_ratio, 0.0, 0.0];
            AttachedMode.has_support(&values, &scale)
        };
        assert!(is_mode(0.9 * nyquist_hz, 0.3));
        assert!(!is_mode(0.9 * nyquist_hz, 1.1));
        assert!(!is_mode(1.3 * nyquist_hz, 0.3));
    }
}
