//! What is odd about a column, as data and in words.

use std::fmt;

use crate::words::digits;

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
