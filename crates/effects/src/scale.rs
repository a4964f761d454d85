//! Typical sizes at a site.

/// Strongest lines that starting frequencies are taken from.
pub const LINES: usize = 4;

/// Typical sizes at a site, from which an effect takes its starting values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiteScale {
    /// rms of the displacement across the site about its mean, m.
    pub displacement_m: f64,
    /// rms of the velocity across the site about its mean, m/s.
    pub velocity_m_per_s: f64,
    /// Typical force at the site, N: the largest rms of what accelerates the masses it joins, of what drives them, and of what its nominal
    /// springs and dampers carry. A slow machine moves against its losses, and hardly against its inertia.
    pub force_n: f64,
    /// rms of the channel about its mean, in model units (input and output sites).
    pub signal: f64,
    /// Sampling interval, s.
    pub time_step_s: f64,
    /// Length of the longest record, s.
    pub duration_s: f64,
    /// Smallest and largest displacement across the site, m.
    pub displacement_range_m: [f64; 2],
    /// Largest travel across the site within one record, m: records of an axis may lie anywhere along it.
    pub travel_m: f64,
    /// Smallest and largest value of the channel as measured, in model units (input and output sites).
    pub signal_range: [f64; 2],
    /// Step of the values of the channel, in model units; zero where there is none to be seen.
    pub signal_step: f64,
    /// The level nearest to zero of the steps, in model units.
    pub signal_level: f64,
    /// Stiffness of the nominal springs at the site, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping of the nominal dampers at the site, N s/m.
    pub damping_n_s_per_m: f64,
    /// Whether the model has a spring at the site.
    pub has_spring: bool,
    /// Whether the model has a damper at the site.
    pub has_damper: bool,
    /// Mass of the lighter of the masses at the site, kg.
    pub mass_kg: f64,
    /// Strongest lines of what the nominal model leaves (channel sites: of this channel), Hz; zero
    /// where there are fewer.
    pub lines_hz: [f64; LINES],
    /// Strongest lines of what is left of a channel times its signal, and times the rate of its signal, Hz: a carrier of either; at an
    /// input, of what gains and delays leave of every channel times the rate of the input. Zero where there are fewer, and at every other site.
    pub carriers_hz: [f64; LINES],
    /// By how much the channel, at an input all channels together, come later than the nominal model predicts, s; zero at every other
    /// site.
    pub late_s: f64,
    /// Strongest lines of the motion, Hz.
    pub motion_hz: [f64; LINES],
}

impl SiteScale {
    /// A scale of the sizes every site has; the rest is unknown.
    #[must_use]
    pub fn plain(displacement_m: f64, velocity_m_per_s: f64, force_n: f64) -> SiteScale {
        SiteScale {
            displacement_m,
            velocity_m_per_s,
            force_n,
            signal: 1.0,
            time_step_s: 1e-3,
            duration_s: 1.0,
            displacement_range_m: [-1.4 * displacement_m, 1.4 * displacement_m],
            travel_m: 2.8 * displacement_m,
            signal_range: [-1.4, 1.4],
            signal_step: 0.0,
            signal_level: 0.0,
            stiffness_n_per_m: force_n / displacement_m,
            damping_n_s_per_m: force_n / velocity_m_per_s,
            has_spring: true,
            has_damper: true,
            mass_kg: 1.0,
            lines_hz: [0.0; LINES],
            carriers_hz: [0.0; LINES],
            late_s: 0.0,
            motion_hz: [0.0; LINES],
        }
    }

    /// The same with the nominal members of the site, whose stiffnesses and dampings sum up to these; where the model has none, the sizes of
    /// the motion stay.
    #[must_use]
    pub fn with_members(self, stiffness_n_per_m: f64, damping_n_s_per_m: f64) -> SiteScale {
        let (has_spring, has_damper) = (stiffness_n_per_m > 0.0, damping_n_s_per_m > 0.0);
        let own = |has: bool, nominal: f64, of_motion: f64| if has { nominal } else { of_motion };
        SiteScale {
            has_spring,
            has_damper,
            stiffness_n_per_m: own(has_spring, stiffness_n_per_m, self.stiffness_n_per_m),
            damping_n_s_per_m: own(has_damper, damping_n_s_per_m, self.damping_n_s_per_m),
            ..self
        }
    }
}
