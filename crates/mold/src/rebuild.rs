//! Records that follow the printed numbers. The measured data is lost.

use std::f64::consts::TAU;

use simgap_integrate::inverse::{Differentiator, transfer};
use simgap_record::{Channel, Record};

use crate::error::{not_negative, positive};
use crate::noise::Normal;
use crate::{MoldError, OneDof, STANDARD_GRAVITY};

/// Channel of the pressure force, N.
pub const FORCE_CHANNEL: &str = "F_pressure";

/// Channel of the mold displacement, m.
pub const DISPLACEMENT_CHANNEL: &str = "y";

/// Amplitude of the n-th harmonic of the displacement over n⁻² of the fundamental. Table 2 prints
/// which lines there are and not how high; 1 % is **assumed**, low enough to leave the 2 mm
/// stroke as it is and high enough to be seen in a spectrum.
pub const HARMONIC_SHARE: f64 = 0.01;

/// Why the displacement shows a line at 50 − f when it is sampled at 100 Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reading {
    /// No such line.
    None,
    /// The converter takes every other sample of the displacement late by τ and the others early:
    /// sample n is taken at n h + (−1)ⁿ τ.
    AlternatingTiming {
        /// τ, s.
        timing_error_s: f64,
    },
    /// The mold itself vibrates at base ∓ f: B cos(2πf t) cos(2π base t).
    FlexibleSupport {
        /// B, m: twice the amplitude of each of the two lines.
        line_amplitude: f64,
        /// Middle of the two lines, Hz; 50 in the paper.
        base_hz: f64,
    },
}

/// What a rebuilt record follows.
///
/// ```text
/// y(t)  = A sin(ωt) + Σ_n (A s / n²) sin(nωt)   over the lines of Table 2, n > 1     (1)
/// α(t)  = a₀ + (Δα/2) cos(ωt)                   Table 3                              (2)
/// F(t)  = m ÿ + c ẏ + k y + m g − α             Eq. (3)                              (3)
/// ```
///
/// The samples of y then carry the [`Reading`]; those of F do not, as Table 2 finds no high line
/// in the pressure.
///
/// | symbol | field | unit | source |
/// |---|---|---|---|
/// | ω/2π | `excitation_freq_hz` | Hz | rows of the tables |
/// | A | `amplitude` | m | section 3.1, 2 mm |
/// | s | `harmonic_share` | 1 | **assumed** ([`HARMONIC_SHARE`]) |
/// | n ω/2π | `lines_hz` | Hz | Table 2 |
/// | a₀ | `centre_force` | N | Table 3 |
/// | Δα | `stroke_force` | N | Table 3; its phase, that of the velocity, is **assumed** |
/// | | `noise_rms` | m | **assumed**, none unless asked for |
#[derive(Debug, Clone, PartialEq)]
pub struct RebuildPlan {
    /// Excitation f, Hz.
    pub excitation_freq_hz: f64,
    /// Amplitude A, m.
    pub amplitude: f64,
    /// Height of the harmonics, 1.
    pub harmonic_share: f64,
    /// Harmonics of Table 2, Hz; the fundamental and lines above the Nyquist frequency are left
    /// out when the record is built.
    pub lines_hz: Vec<f64>,
    /// a₀, N.
    pub centre_force: f64,
    /// max α − min α of the Fourier part, N.
    pub stroke_force: f64,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// Length, s.
    pub duration_s: f64,
    /// What makes the line at 50 − f.
    pub reading: Reading,
    /// Standard deviation of the noise on y, m.
    pub noise_rms: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// A record that follows a plan, with the statement that it was not measured.
#[derive(Debug, Clone, PartialEq)]
pub struct RebuiltRecord {
    /// Channels [`FORCE_CHANNEL`] and [`DISPLACEMENT_CHANNEL`]; its name begins with `rebuilt`.
    pub record: Record,
    /// What the record is and is not, for readers.
    pub statement: String,
    /// The plan it follows.
    pub plan: RebuildPlan,
}

/// The plan for one excitation of the paper, 1 to 6 Hz (the rows Tables 2, 3 and 4 share), without
/// noise and for 20 s.
///
/// # Errors
/// [`MoldError::NoRow`] for any other excitation.
pub fn published_plan(
    excitation_freq_hz: f64,
    sample_rate_hz: f64,
    reading: Reading,
) -> Result<RebuildPlan, MoldError> {
    let no_row = || MoldError::NoRow {
        table: "Table 3",
        found: excitation_freq_hz,
        has: "1, 2, 3, 4, 5, 6 Hz",
    };
    let (table2, table3) = (simgap_tables::table2()?, simgap_tables::table3()?);
    let stated = simgap_tables::stated_values()?;
    let force = table3
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or_else(no_row)?;
    let lines = table2
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or_else(no_row)?;
    Ok(RebuildPlan {
        excitation_freq_hz,
        amplitude: stated.amplitude.si(),
        harmonic_share: HARMONIC_SHARE,
        lines_hz: lines.displacement.lines_hz().to_vec(),
        centre_force: force.centre.si(),
        stroke_force: force.peak_to_peak.si(),
        sample_rate_hz,
        duration_s: 20.0,
        reading,
        noise_rms: 0.0,
        seed: 0,
    })
}

/// The amplitude B (m) of the displacement at 50 − f that the printed F₀ of Table 4 asks for, when
/// Park's formula is applied twice at the paper's sampling step:
///
/// ```text
/// B = F₀ / |m D² + c D + k|,     D = D(50 − f) of Park's formula
/// ```
///
/// # Errors
/// [`MoldError::NoRow`] for an excitation Table 4 does not have.
pub fn published_line_amplitude(excitation_freq_hz: f64) -> Result<f64, MoldError> {
    let (table4, stated) = (simgap_tables::table4()?, simgap_tables::stated_values()?);
    let row = table4
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or(MoldError::NoRow {
            table: "Table 4",
            found: excitation_freq_hz,
            has: "1, 2, 3, 4, 5, 6 Hz",
        })?;
    let mold = OneDof::published()?;
    let line_hz = stated.image_base.si() - excitation_freq_hz;
    let rate = transfer(Differentiator::Park, line_hz, stated.time_step.si())?;
    let force = rate * rate * mold.mass_kg() + rate * mold.damping() + mold.stiffness();
    Ok(row.amplitude.si() / force.norm())
}

/// Builds the record a plan describes for a mold. The same plan gives the same samples.
///
/// ```
/// use simgap_mold::{OneDof, Reading, published_plan, rebuild};
/// let reading = Reading::AlternatingTiming { timing_error_s: 0.6e-3 };
/// let rebuilt = rebuild(&OneDof::published()?, published_plan(1.0, 100.0, reading)?)?;
/// assert_eq!(rebuilt.record.len(), 2000);
/// assert!(rebuilt.statement.contains("not measured"));
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
///
/// # Errors
/// [`MoldError::Parameter`] for a plan out of range, [`MoldError::Record`] for a record too short.
pub fn rebuild(mold: &OneDof, plan: RebuildPlan) -> Result<RebuiltRecord, MoldError> {
    check(&plan)?;
    let motion = Motion::new(&plan);
    let count = (plan.duration_s * plan.sample_rate_hz).round() as usize;
    let time_step_s = 1.0 / plan.sample_rate_hz;
    let mut noise = Normal::new(plan.seed);
    let mut displacement = Vec::with_capacity(count);
    let mut force = Vec::with_capacity(count);
    for n in 0..count {
        let time = n as f64 / plan.sample_rate_hz;
        let mut y = motion.sampled_displacement(&plan, n, time);
        if plan.noise_rms > 0.0 {
            y += plan.noise_rms * noise.next();
        }
        displacement.push(y);
        force.push(motion.force(mold, &plan, time));
    }
    let channels = vec![
        Channel::new(FORCE_CHANNEL, "N", force),
        Channel::new(DISPLACEMENT_CHANNEL, "m", displacement),
    ];
    let record = Record::from_uniform(record_name(&plan), 0.0, time_step_s, channels)?;
    Ok(RebuiltRecord {
        record,
        statement: statement(&plan),
        plan,
    })
}

/// The smooth motion of (1) as pairs of frequency (rad/s) and amplitude (m).
struct Motion {
    lines: Vec<(f64, f64)>,
}

impl Motion {
    fn new(plan: &RebuildPlan) -> Self {
        let base = plan.excitation_freq_hz;
        let mut lines = vec![(TAU * base, plan.amplitude)];
        let harmonics = plan
            .lines_hz
            .iter()
            .filter(|line| **line > base && **line < 0.5 * plan.sample_rate_hz);
        for line in harmonics {
            let order = line / base;
            lines.push((
                TAU * line,
                plan.amplitude * plan.harmonic_share / (order * order),
            ));
        }
        Self { lines }
    }

    /// y, ẏ, ÿ of (1).
    fn at(&self, time: f64) -> [f64; 3] {
        self.lines
            .iter()
            .fold([0.0; 3], |[y, v, a], (omega, amplitude)| {
                let (sin, cos) = (omega * time).sin_cos();
                [
                    y + amplitude * sin,
                    v + amplitude * omega * cos,
                    a - amplitude * omega * omega * sin,
                ]
            })
    }

    fn sampled_displacement(&self, plan: &RebuildPlan, n: usize, time: f64) -> f64 {
        match plan.reading {
            Reading::None => self.at(time)[0],
            Reading::AlternatingTiming { timing_error_s } => {
                let late = if n.is_multiple_of(2) {
                    timing_error_s
                } else {
                    -timing_error_s
                };
                self.at(time + late)[0]
            }
            Reading::FlexibleSupport {
                line_amplitude,
                base_hz,
            } => {
                let beat =
                    (TAU * plan.excitation_freq_hz * time).cos() * (TAU * base_hz * time).cos();
                self.at(time)[0] + line_amplitude * beat
            }
        }
    }

    fn force(&self, mold: &OneDof, plan: &RebuildPlan, time: f64) -> f64 {
        let [y, v, a] = self.at(time);
        let unknown = plan.centre_force
            + 0.5 * plan.stroke_force * (TAU * plan.excitation_freq_hz * time).cos(); // (2)
        mold.mass_kg() * (a + STANDARD_GRAVITY) + mold.damping() * v + mold.stiffness() * y
            - unknown // (3)
    }
}

fn check(plan: &RebuildPlan) -> Result<(), MoldError> {
    positive("excitation frequency", plan.excitation_freq_hz)?;
    positive("amplitude", plan.amplitude)?;
    not_negative("harmonic share", plan.harmonic_share)?;
    positive("sample rate", plan.sample_rate_hz)?;
    positive("duration", plan.duration_s)?;
    not_negative("noise", plan.noise_rms)?;
    let finite = |name, value: f64| {
        if value.is_finite() {
            Ok(())
        } else {
            Err(MoldError::Parameter {
                name,
                found: value,
                needed: "finite",
            })
        }
    };
    finite("centre force", plan.centre_force)?;
    finite("stroke force", plan.stroke_force)?;
    match plan.reading {
        Reading::None => Ok(()),
        Reading::AlternatingTiming { timing_error_s } => finite("timing error", timing_error_s),
        Reading::FlexibleSupport {
            line_amplitude,
            base_hz,
        } => {
            finite("line amplitude", line_amplitude)?;
            positive("base frequency", base_hz).map(|_| ())
        }
    }
}

fn record_name(plan: &RebuildPlan) -> String {
    let reading = match plan.reading {
        Reading::None => "plain",
        Reading::AlternatingTiming { .. } => "alternating-timing",
        Reading::FlexibleSupport { .. } => "flexible-support",
    };
    format!(
        "rebuilt-{}hz-{reading}-at-{}hz",
        plan.excitation_freq_hz, plan.sample_rate_hz
    )
}

fn statement(plan: &RebuildPlan) -> String {
    let reading = match plan.reading {
        Reading::None => "no line at 50 - f".to_owned(),
        Reading::AlternatingTiming { timing_error_s } => format!(
            "every other sample of y taken {:.4} ms late, the others as early",
            1e3 * timing_error_s
        ),
        Reading::FlexibleSupport {
            line_amplitude,
            base_hz,
        } => format!(
            "the mold vibrating at {base_hz} -+ f with {:.3} um together",
            1e6 * line_amplitude
        ),
    };
    format!(
        "rebuilt from the printed tables, not measured: {} Hz, {} mm, harmonics of Table 2 with an \
         assumed height, unknown force of Table 3 with an assumed phase, {reading}, sampled at {} Hz",
        plan.excitation_freq_hz,
        1e3 * plan.amplitude,
        plan.sample_rate_hz
    )
}
