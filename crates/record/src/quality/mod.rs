//! Defects a measurement chain leaves in a record, read off one channel at a time.
//!
//! A finding is a hint with a starting value, not a verdict: what looks like a defect may be
//! physics, and is judged later by the same evidence. Each check is tuned to stay silent on clean
//! data, so a mild defect may go unseen.

mod alternation;
mod edges;
mod lattice;
mod repeats;
mod spikes;
mod stamps;

use std::fmt;

use crate::Record;
use crate::error::digits;

/// Which end of its range a channel is stuck at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The largest value.
    Upper,
    /// The smallest value.
    Lower,
}

/// What is odd about a column. Levels, steps and amplitudes are in the unit of the header.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Defect {
    /// All values are the same.
    Flat {
        /// That value.
        value: f64,
    },
    /// The extreme value is held for whole runs of samples, as by a limited range.
    Clipped {
        /// Which end.
        edge: Edge,
        /// The value held.
        level: f64,
        /// Share of samples at that value.
        fraction: f64,
        /// Most samples in a row.
        longest_run: usize,
    },
    /// All values lie on a lattice, as from a converter or an encoder.
    Quantised {
        /// Distance of neighbouring levels.
        step: f64,
        /// Levels between the smallest and the largest value, both counted.
        levels: usize,
    },
    /// Values repeat the one before more often than their spread allows, as when a sample is lost
    /// and the last one held. Also seen where an input is a staircase.
    Repeated {
        /// Share of samples that repeat, without those to be expected on a lattice.
        fraction: f64,
        /// Number of runs of repeats.
        runs: usize,
        /// Most repeats in a row.
        longest_run: usize,
    },
    /// Single samples far off the curve through their neighbours.
    Spikes {
        /// Their rows, rising.
        rows: Vec<usize>,
        /// Height of the largest one, with its sign.
        largest: f64,
        /// Robust standard deviation of a single sample about the curve through its neighbours.
        noise: f64,
    },
    /// A component that changes sign at every sample: a line at half the sample rate.
    Alternation {
        /// Amplitude of `(-1)^row`, with its sign.
        amplitude: f64,
        /// Amplitude over its standard error.
        significance: f64,
    },
    /// Time stamps off the uniform grid.
    TimeJitter {
        /// Root mean square deviation, steps.
        rms_steps: f64,
        /// Largest deviation, steps.
        worst_steps: f64,
        /// The unit of the last decimal, s, if rounding to it explains the deviations.
        rounded_to_s: Option<f64>,
    },
}

/// A defect and the column it is seen in.
#[derive(Debug, Clone, PartialEq)]
pub struct QualityFinding {
    /// Name of the column; `t` for the time base.
    pub channel: String,
    /// Symbol of its unit.
    pub unit: String,
    /// What is odd.
    pub defect: Defect,
}

/// Looks for defects in the time base and in every channel, in the order of the record.
///
/// | Defect | Sign | Not judged |
/// |---|---|---|
/// | [`Defect::Flat`] | one value only | |
/// | [`Defect::Clipped`] | runs of 3 and more at the extreme value, exactly | fewer than 6 different values |
/// | [`Defect::Quantised`] | at least 98 % of the levels within 0.1 step of a lattice | more than 65 536 levels; ramps |
/// | [`Defect::Repeated`] | more equal neighbours than neighbours one or two levels apart | a lattice coarser than a quarter of the median change |
/// | [`Defect::Spikes`] | second differences in the ratio 1 : -2 : 1, ten robust deviations high | neighbouring outliers |
/// | [`Defect::Alternation`] | `(-1)^row` in 16 tapered parts, 8 standard errors | fewer than 256 rows; half a step of a lattice |
/// | [`Defect::TimeJitter`] | a stamp more than 0.02 of a step off the uniform grid | |
///
/// Filled samples are neither repeats nor spikes ([`Record::filled`]); in a record that was resampled
/// ([`Record::is_resampled`]) these and alternations are not sought.
///
/// ```
/// use simgap_record::{Channel, Defect, Record, quality};
///
/// let sine = (0..500).map(|k| (0.05 * f64::from(k)).sin().min(0.8)).collect();
/// let record = Record::from_uniform("A.csv", 0.0, 0.01, vec![Channel::new("y", "mm", sine)])?;
/// let findings = quality(&record);
/// assert!(matches!(findings[0].defect, Defect::Clipped { level: 0.8, .. }));
/// assert!(findings[0].to_string().starts_with("y is held at its largest value 0.8 mm"));
/// # Ok::<(), simgap_record::RecordError>(())
/// ```
#[must_use]
pub fn quality(record: &Record) -> Vec<QualityFinding> {
    let jitter =
        stamps::jitter(record.time_s(), record.time_step_s()).map(|defect| QualityFinding {
            channel: "t".to_owned(),
            unit: "s".to_owned(),
            defect,
        });
    let of_channels = record.channels().iter().flat_map(|channel| {
        let filled = record.filled(&channel.name).unwrap_or_default();
        let mut defects = defects(&channel.values, filled);
        // Of samples that stand between those taken, none is single.
        defects.retain(|defect| !(record.is_resampled() && is_of_single_samples(defect)));
        defects.into_iter().map(|defect| QualityFinding {
            channel: channel.name.clone(),
            unit: channel.unit.symbol().to_owned(),
            defect,
        })
    });
    jitter.into_iter().chain(of_channels).collect()
}

fn is_of_single_samples(defect: &Defect) -> bool {
    matches!(
        defect,
        Defect::Repeated { .. } | Defect::Spikes { .. } | Defect::Alternation { .. }
    )
}

/// The defects of one column of finite values, of which some may be filled.
fn defects(values: &[f64], filled: &[bool]) -> Vec<Defect> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let levels = lattice::distinct(&sorted);
    if let [(value, _)] = levels[..] {
        return vec![Defect::Flat { value }];
    }
    let lattice = lattice::lattice(values, &levels);
    let mut found = Vec::new();
    for edge in [Edge::Upper, Edge::Lower] {
        found.extend(edges::clipped(values, &levels, lattice, edge));
    }
    let held: Vec<f64> = found
        .iter()
        .filter_map(|defect| match defect {
            Defect::Clipped { level, .. } => Some(*level),
            _ => None,
        })
        .collect();
    found.extend(lattice.map(|l| Defect::Quantised {
        step: l.step,
        levels: l.levels,
    }));
    found.extend(repeats::repeated((values, filled), &levels, lattice, &held));
    found.extend(spikes::spikes((values, filled), lattice));
    found.extend(alternation::alternation(values, lattice));
    found
}

impl fmt::Display for QualityFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let QualityFinding {
            channel,
            unit,
            defect,
        } = self;
        let percent = |fraction: f64| format!("{:.2} %", 100.0 * fraction);
        match defect {
            Defect::Flat { value } => {
                write!(f, "{channel} is flat at {} {unit}", digits(*value))
            }
            Defect::Clipped {
                edge,
                level,
                fraction,
                longest_run,
            } => {
                let end = if *edge == Edge::Upper {
                    "largest"
                } else {
                    "smallest"
                };
                let (level, share) = (digits(*level), percent(*fraction));
                write!(
                    f,
                    "{channel} is held at its {end} value {level} {unit} for {share} of "
                )?;
                write!(f, "the samples, up to {longest_run} in a row")
            }
            Defect::Quantised { step, levels } => {
                let step = digits(*step);
                write!(
                    f,
                    "{channel} lies on a lattice of step {step} {unit}, {levels} levels wide"
                )
            }
            Defect::Repeated {
                fraction,
                runs,
                longest_run,
            } => {
                let share = percent(*fraction);
                write!(
                    f,
                    "{channel} repeats the value before in {share} of the samples, in "
                )?;
                write!(f, "{runs} runs of up to {longest_run}")
            }
            Defect::Spikes {
                rows,
                largest,
                noise,
            } => {
                let (count, largest, noise) = (rows.len(), digits(*largest), digits(*noise));
                write!(
                    f,
                    "{channel} has {count} single outliers of up to {largest} {unit}, with "
                )?;
                write!(f, "{noise} {unit} of noise about its curve")
            }
            Defect::Alternation {
                amplitude,
                significance,
            } => {
                let amplitude = digits(*amplitude);
                write!(
                    f,
                    "{channel} alternates from sample to sample by {amplitude} {unit} "
                )?;
                write!(f, "({significance:.0} standard errors)")
            }
            Defect::TimeJitter {
                rms_steps,
                worst_steps,
                rounded_to_s,
            } => {
                write!(
                    f,
                    "stamps are {rms_steps:.3} of a step off a uniform grid (rms), "
                )?;
                write!(f, "{worst_steps:.3} at worst")?;
                match rounded_to_s {
                    Some(unit) => write!(f, ", by rounding to {unit} s"),
                    None => Ok(()),
                }
            }
        }
    }
}
