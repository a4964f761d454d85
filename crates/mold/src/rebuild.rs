//! Records that follow the printed numbers. The measured data is lost.

use std::f64::consts::TAU;

use simgap_record::{Channel, Record};

use crate::channel::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};
use crate::noise::Normal;
use crate::plan::{check, force_per_displacement};
use crate::{MoldError, OneDof, Reading, RebuildPlan, STANDARD_GRAVITY};

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
    let motion = Motion::new(mold, &plan)?;
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

/// One line of the motion and the force it takes.
struct MotionLine {
    omega: f64,
    amplitude: f64,
    /// m D² + c D + k, real and imaginary part, N/m.
    stiffness: [f64; 2],
}

/// The smooth motion of (1).
struct Motion {
    lines: Vec<MotionLine>,
}

impl Motion {
    fn new(mold: &OneDof, plan: &RebuildPlan) -> Result<Self, MoldError> {
        let base = plan.excitation_freq_hz;
        let harmonics = plan
            .lines_hz
            .iter()
            .filter(|line| **line > base && **line < 0.5 * plan.sample_rate_hz)
            .map(|line| {
                let order = line / base;
                (
                    *line,
                    plan.amplitude * plan.harmonic_share / (order * order),
                )
            });
        let lines = std::iter::once((base, plan.amplitude))
            .chain(harmonics)
            .map(|(freq_hz, amplitude)| {
                let stiffness = force_per_displacement(mold, freq_hz, plan.derivative)?;
                Ok(MotionLine {
                    omega: TAU * freq_hz,
                    amplitude,
                    stiffness,
                })
            })
            .collect::<Result<Vec<_>, MoldError>>()?;
        Ok(Self { lines })
    }

    /// y of (1).
    fn displacement(&self, time: f64) -> f64 {
        self.lines
            .iter()
            .map(|line| line.amplitude * (line.omega * time).sin())
            .sum()
    }

    fn sampled_displacement(&self, plan: &RebuildPlan, n: usize, time: f64) -> f64 {
        match plan.reading {
            Reading::None => self.displacement(time),
            Reading::AlternatingTiming { timing_error_s } => {
                let late = if n.is_multiple_of(2) {
                    timing_error_s
                } else {
                    -timing_error_s
                };
                self.displacement(time + late)
            }
            Reading::FlexibleSupport {
                line_amplitude,
                base_hz,
            } => {
                let beat =
                    (TAU * plan.excitation_freq_hz * time).cos() * (TAU * base_hz * time).cos();
                self.displacement(time) + line_amplitude * beat
            }
        }
    }

    fn force(&self, mold: &OneDof, plan: &RebuildPlan, time: f64) -> f64 {
        let unknown = plan.centre_force
            + 0.5 * plan.stroke_force * (TAU * plan.excitation_freq_hz * time).cos(); // (2)
        let moving: f64 = self
            .lines
            .iter()
            .map(|line| {
                let (sin, cos) = (line.omega * time).sin_cos();
                line.amplitude * (line.stiffness[0] * sin + line.stiffness[1] * cos)
            })
            .sum();
        moving + mold.mass_kg() * STANDARD_GRAVITY - unknown // (3)
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
