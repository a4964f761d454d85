//! Which samples of a record were not measured where they stand: filled, or moved to an even clock.

use std::ops::Range;

use crate::resample::AT_STAMP;

/// A sample that is moved by less than this share of a step is as good as not moved: what a clock
/// is off without being told, see [`crate::Defect::TimeJitter`].
const UNMOVED_STEPS: f64 = 0.02;
/// A sample was lost where two stamps are so many steps apart, give or take what a clock jitters ...
const LOST_STEPS: f64 = 1.9;
/// ... and it would stand so many steps from both of them.
const ALONE_STEPS: f64 = 0.5;

/// What was done to the samples of a record.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Mended {
    /// For each channel, whether a sample was filled; empty where none was.
    filled: Vec<Vec<bool>>,
    /// Whether samples stand at other times than they were taken at.
    is_resampled: bool,
}

impl Mended {
    /// Adds the next channel, of which some samples are missing.
    pub(crate) fn push(&mut self, values: &[f64]) {
        let any = values.iter().any(|value| value.is_nan());
        let missing = any.then(|| values.iter().map(|value| value.is_nan()).collect());
        self.filled.push(missing.unwrap_or_default());
    }

    pub(crate) fn is_resampled(&self) -> bool {
        self.is_resampled
    }

    /// The filled samples of a channel; `None` where none was.
    pub(crate) fn filled(&self, channel: usize) -> Option<&[bool]> {
        let filled = self.filled.get(channel)?;
        filled.contains(&true).then_some(filled.as_slice())
    }

    /// The same after the stamps were replaced by `rows` even ones. What is made of a filled
    /// sample, or stands in a gap, is filled.
    pub(crate) fn resampled(self, time_s: &[f64], step_s: f64, rows: usize) -> Mended {
        let start = time_s.first().copied().unwrap_or(0.0);
        let last = time_s.len().saturating_sub(2);
        let (mut k, mut is_resampled) = (0, false);
        let mut made_of: Vec<(usize, usize)> = Vec::with_capacity(rows);
        let mut in_gap: Vec<bool> = Vec::with_capacity(rows);
        for row in 0..rows {
            let t = start + row as f64 * step_s;
            while k < last && time_s[k + 1] <= t {
                k += 1;
            }
            let (before, after) = (t - time_s[k], time_s[k + 1] - t);
            let near = before.min(after) / step_s;
            let gap = before + after > LOST_STEPS * step_s && near > ALONE_STEPS;
            made_of.push(match near <= AT_STAMP {
                true if before <= after => (k, k),
                true => (k + 1, k + 1),
                false => (k, k + 1),
            });
            in_gap.push(gap);
            is_resampled |= !gap && near > UNMOVED_STEPS;
        }
        let of_channel = |filled: Vec<bool>| -> Vec<bool> {
            let was = |row: usize| filled.get(row).copied().unwrap_or(false);
            let rows = made_of.iter().zip(&in_gap);
            rows.map(|(&(a, b), gap)| *gap || was(a) || was(b))
                .collect()
        };
        Mended {
            filled: self.filled.into_iter().map(of_channel).collect(),
            is_resampled,
        }
    }

    /// Of some of the channels, by their place.
    pub(crate) fn of_channels(&self, kept: &[usize]) -> Mended {
        let filled = |k: &usize| self.filled.get(*k).cloned().unwrap_or_default();
        Mended {
            filled: kept.iter().map(filled).collect(),
            is_resampled: self.is_resampled,
        }
    }

    /// Of a range of rows.
    pub(crate) fn slice(&self, range: Range<usize>) -> Mended {
        let cut = |filled: &Vec<bool>| filled.get(range.clone()).unwrap_or_default().to_vec();
        Mended {
            filled: self.filled.iter().map(cut).collect(),
            is_resampled: self.is_resampled,
        }
    }
}
