//! A sine sweep that follows the printed numbers. The measured one is lost.

use std::f64::consts::TAU;

use simgap_record::{Channel, Record};

use crate::channel::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};
use crate::error::{not_negative, positive};
use crate::{MoldError, OneDof, STANDARD_GRAVITY};

/// What a rebuilt sweep follows,
///
/// ```text
/// φ(t) = 2π (f₀ t + (f₁ − f₀) t²/(2 T)),    f(t) = φ̇/2π                             (1)
/// y(t) = A sin φ                                                                   (2)
/// α(t) = a₀ + ½ Δα(f) cos φ          Table 3, linear between its rows              (3)
/// F(t) = m ÿ + c ẏ + k y + m g − α                                                  (4)
/// ```
///
/// The samples of y are taken late by τ and early by τ in turn; those of F are not.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SweepPlan {
    /// f₀ and f₁, Hz.
    pub freqs_hz: [f64; 2],
    /// A, m.
    pub amplitude: f64,
    /// a₀, N.
    pub centre_force: f64,
    /// Frequency (Hz) and Δα (N), in order of frequency; constant beyond the ends.
    pub stroke_force: Vec<[f64; 2]>,
    /// τ, s.
    pub timing_error_s: f64,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// T, s.
    pub duration_s: f64,
}

/// A rebuilt sweep, with the statement that it was not measured.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRecord {
    /// Channels [`FORCE_CHANNEL`] and [`DISPLACEMENT_CHANNEL`].
    pub record: Record,
    /// f at each sample, Hz.
    pub freq_hz: Vec<f64>,
    /// What the record is and is not, for readers.
    pub statement: String,
}

/// The sweep of section 3.1, 1 to 7 Hz with 2 mm, in a minute (**assumed**), with the force of Table 3. The table
/// has no row for 7 Hz: no stroke is assumed there.
///
/// # Errors
/// [`MoldError::Table`] if a fixture was damaged.
pub fn published_sweep(sample_rate_hz: f64, timing_error_s: f64) -> Result<SweepPlan, MoldError> {
    let (table2, table3) = (simgap_tables::table2()?, simgap_tables::table3()?);
    let excitations: Vec<f64> = table2.rows.iter().map(|row| row.excitation.si()).collect();
    let rows = &table3.rows;
    let mut stroke_force: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| [row.excitation.si(), row.peak_to_peak.si()])
        .collect();
    let ends = [excitations.first(), excitations.last()].map(|end| end.copied().unwrap_or(1.0));
    stroke_force.push([ends[1], 0.0]);
    Ok(SweepPlan {
        freqs_hz: ends,
        amplitude: simgap_tables::stated_values()?.amplitude.si(),
        centre_force: rows.iter().map(|row| row.centre.si()).sum::<f64>() / rows.len() as f64,
        stroke_force,
        timing_error_s,
        sample_rate_hz,
        duration_s: 60.0,
    })
}

/// Builds the sweep a plan describes. The same plan gives the same samples.
///
/// ```
/// use simgap_mold::{OneDof, published_sweep, rebuild_sweep};
/// let sweep = rebuild_sweep(&OneDof::published()?, &published_sweep(100.0, 0.6e-3)?)?;
/// assert_eq!(sweep.record.len(), 6000);
/// assert!(sweep.freq_hz[0] == 1.0 && sweep.freq_hz[5999] > 6.99);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
///
/// # Errors
/// [`MoldError::Parameter`] for a plan out of range, [`MoldError::Record`] for a record too short.
pub fn rebuild_sweep(mold: &OneDof, plan: &SweepPlan) -> Result<SweepRecord, MoldError> {
    let rate = positive("sample rate", plan.sample_rate_hz)?;
    let duration = positive("duration", plan.duration_s)?;
    for freq in plan.freqs_hz {
        positive("frequency of the sweep", freq)?;
        positive(
            "half the sample rate less the frequency of the sweep",
            0.5 * rate - freq,
        )?;
    }
    not_negative("amplitude", plan.amplitude)?;
    let count = (duration * rate).round() as usize;
    let (mut displacement, mut force, mut freq_hz) = (vec![], vec![], vec![]);
    for n in 0..count {
        let time = n as f64 / rate;
        let late = if n % 2 == 0 { 1.0 } else { -1.0 } * plan.timing_error_s;
        displacement.push(plan.amplitude * plan.phase(time + late)[0].sin()); // (2)
        force.push(plan.force(mold, time));
        freq_hz.push(plan.phase(time)[1] / TAU);
    }
    let channels = vec![
        Channel::new(FORCE_CHANNEL, "N", force),
        Channel::new(DISPLACEMENT_CHANNEL, "m", displacement),
    ];
    let [from, to] = plan.freqs_hz;
    Ok(SweepRecord {
        record: Record::from_uniform("rebuilt-sweep", 0.0, rate.recip(), channels)?,
        freq_hz,
        statement: format!(
            "rebuilt from the printed tables, not measured: a sweep from {from} to {to} Hz with {} mm in {duration} s \
             (assumed), unknown force of Table 3 with an assumed phase, every other sample of y taken {:.4} ms late, \
             the others as early, sampled at {rate} Hz",
            1e3 * plan.amplitude,
            1e3 * plan.timing_error_s
        ),
    })
}

impl SweepPlan {
    /// φ, φ̇ and φ̈ of (1).
    fn phase(&self, time: f64) -> [f64; 3] {
        let [from, to] = self.freqs_hz;
        let rise = (to - from) / self.duration_s;
        [
            TAU * (from + 0.5 * rise * time) * time,
            TAU * (from + rise * time),
            TAU * rise,
        ]
    }

    /// F of (4).
    fn force(&self, mold: &OneDof, time: f64) -> f64 {
        let [phase, rate, rise] = self.phase(time);
        let (sin, cos) = phase.sin_cos();
        let velocity = self.amplitude * rate * cos;
        let acceleration = self.amplitude * (rise * cos - rate * rate * sin);
        let unknown = self.centre_force + 0.5 * self.stroke(rate / TAU) * cos; // (3)
        mold.mass_kg() * (acceleration + STANDARD_GRAVITY)
            + mold.damping() * velocity
            + mold.stiffness() * self.amplitude * sin
            - unknown
    }

    /// Δα at a frequency.
    fn stroke(&self, freq_hz: f64) -> f64 {
        let rows = &self.stroke_force;
        let above = rows.iter().position(|[freq, _]| *freq >= freq_hz);
        match above {
            Some(0) => rows[0][1],
            Some(i) => {
                let ([low, from], [high, to]) = (rows[i - 1], rows[i]);
                from + (to - from) * (freq_hz - low) / (high - low)
            }
            None => rows.last().map_or(0.0, |row| row[1]),
        }
    }
}
