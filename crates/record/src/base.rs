//! Time bases of their own that the channels of one file have, and how they come to one.
//!
//! Channels of TDMS, MDF, LVM and universal files each say when they begin and how they are
//! spaced. A channel that begins later or was sampled at another rate is no column beside the others: it is cut to
//! the span that all share and, where its stamps are others, interpolated to the stamps of the
//! reference.

use crate::MIN_ROWS;
use crate::resample::at_stamps;

/// Time bases are one if their steps and starts differ by less than this share of a step: universal
/// files have six digits.
const SAME: f64 = 1e-5;

/// A time base, s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Base {
    Even(Uniform),
    Stamps(Vec<f64>),
}

/// Evenly spaced stamps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Uniform {
    pub(crate) start_s: f64,
    pub(crate) step_s: f64,
    pub(crate) rows: usize,
}

impl Base {
    pub(crate) fn rows(&self) -> usize {
        match self {
            Base::Even(even) => even.rows,
            Base::Stamps(stamps) => stamps.len(),
        }
    }

    pub(crate) fn stamps(&self) -> Vec<f64> {
        match self {
            Base::Even(even) => {
                let stamp = |k: usize| even.start_s + k as f64 * even.step_s;
                (0..even.rows).map(stamp).collect()
            }
            Base::Stamps(stamps) => stamps.clone(),
        }
    }

    /// The same stamps to within what a file prints.
    pub(crate) fn is_like(&self, other: &Base) -> bool {
        match (self, other) {
            (Base::Even(a), Base::Even(b)) => {
                a.rows == b.rows
                    && (a.step_s - b.step_s).abs() <= SAME * a.step_s.abs().max(b.step_s.abs())
                    && (a.start_s - b.start_s).abs() <= SAME * a.step_s.abs()
            }
            _ => self == other,
        }
    }

    /// First and last stamp; `None` where there are too few rows or the stamps do not rise.
    fn span(&self) -> Option<(f64, f64)> {
        if self.rows() < MIN_ROWS {
            return None;
        }
        match self {
            Base::Even(even) => {
                let end = even.start_s + (even.rows as f64 - 1.0) * even.step_s;
                (even.step_s > 0.0 && end.is_finite()).then_some((even.start_s, end))
            }
            Base::Stamps(stamps) => {
                let rising = stamps.windows(2).all(|pair| pair[0] < pair[1]);
                let (first, last) = (*stamps.first()?, *stamps.last()?);
                (rising && first.is_finite() && last.is_finite()).then_some((first, last))
            }
        }
    }

    /// Mean step, for a choice among bases.
    pub(crate) fn mean_step(&self) -> f64 {
        let rows = self.rows().max(2) as f64 - 1.0;
        self.span()
            .map_or(f64::INFINITY, |(first, last)| (last - first) / rows)
    }
}

/// The rows of a reference that lie within the spans of all bases.
pub(crate) fn shared_rows<'a>(
    reference: &[f64],
    bases: impl Iterator<Item = &'a Base>,
) -> Option<(usize, usize)> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    let step = match reference {
        [first, .., last] => (last - first) / (reference.len() as f64 - 1.0),
        _ => return None,
    };
    for base in bases {
        let (first, last) = base.span()?;
        from = from.max(first - SAME * step);
        to = to.min(last + SAME * step);
    }
    let start = reference.iter().position(|&t| t >= from)?;
    let end = reference.iter().rposition(|&t| t <= to)? + 1;
    (end >= start + MIN_ROWS).then_some((start, end))
}

/// Values of a channel at the stamps of the reference, and whether they had to be interpolated. Its
/// base spans those stamps.
pub(crate) fn at(base: &Base, values: &[f64], stamps: &[f64]) -> (Vec<f64>, bool) {
    if let (Base::Even(even), [first, second, ..]) = (base, stamps) {
        let shift = (first - even.start_s) / even.step_s;
        let rows = stamps.len() as f64 - 1.0;
        let drift = (stamps[stamps.len() - 1] - first) / even.step_s - rows;
        let whole = (shift - shift.round()).abs() <= 1e-3 && drift.abs() <= 1e-3;
        let even_too = ((second - first) / even.step_s - 1.0).abs() <= 1e-3;
        // Rounding of a start may put the first stamp a hair before the channel's own.
        let skipped = shift.round().max(0.0) as usize;
        if whole && even_too && skipped + stamps.len() <= values.len() {
            return (values[skipped..skipped + stamps.len()].to_vec(), false);
        }
    }
    (at_stamps(&base.stamps(), values, stamps), true)
}
