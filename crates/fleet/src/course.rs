//! How a value of one machine goes over time: constant, along a line, or in steps.
//!
//! Each estimate y_i has its standard error s_i. Segments of equal level are found exactly, by dynamic programming over where
//! the last of them begins (optimal partitioning):
//!
//! ```text
//! C(i, j) = Σ_{i≤n<j} (y_n − ȳ_ij)² / s_n²                                                 (1)
//! F(m, j) = min_i F(m−1, i) + C(i, j),   F(1, j) = C(0, j)                                 (2)
//! ```
//!
//! and a line by weighted least squares. The course is the one with the least
//!
//! ```text
//! BIC = χ²/φ + k ln n,   φ = max(1, min_k χ²_k / (n − k))                                  (3)
//! ```
//!
//! k numbers are estimated: 1 for a constant, 2 for a line, 2m − 1 for m segments. φ counts that diagnoses scatter by more than
//! their standard errors say.
//!
//! Reference: `jackson2005`.
//!
//! Reference: `schwarz1978`.

use simgap_estimate::NORMAL_95;

use crate::observe::Estimate;

/// Most segments.
const MOST_SEGMENTS: usize = 4;
/// Fewest estimates in a segment: one odd day is no change.
const LEAST_IN_SEGMENT: usize = 3;
/// Fewest estimates that a course is told of.
const LEAST: usize = 6;

/// How a value goes.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Along a line.
    Line {
        /// Value at the first and at the last time.
        ends: [f64; 2],
        /// Change for each unit of time.
        slope: f64,
        /// 95 % interval of the slope.
        slope_ci95: [f64; 2],
    },
    /// In steps.
    Steps {
        /// Places of the first estimate after each step.
        at: Vec<usize>,
        /// The levels, one more than there are steps.
        levels: Vec<f64>,
    },
}

impl Course {
    /// The first and the last value.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        match self {
            Course::Line { ends, .. } => *ends,
            Course::Steps { levels, .. } => {
                let first = levels.first().copied().unwrap_or_default();
                [first, levels.last().copied().unwrap_or_default()]
            }
        }
    }
}

/// The course of estimates over rising times; `None` for a constant, or where there are too few. `least_gain` is the
/// difference of BIC to a constant that is asked for, the larger the more series are looked at.
#[must_use]
pub fn course(times: &[f64], estimates: &[Estimate], least_gain: f64) -> Option<Course> {
    let n = estimates.len();
    if n < LEAST || times.len() != n {
        return None;
    }
    let sums = Sums::new(estimates);
    let segments = segments(&sums, n);
    let line = line(times, estimates)?;
    let constant = sums.misfit(0, n);
    let mut fits: Vec<(f64, usize)> = segments
        .iter()
        .enumerate()
        .map(|(m, (misfit, _))| (*misfit, 2 * m + 1))
        .collect();
    fits.push((line.misfit, 2));
    let scatter = fits
        .iter()
        .map(|(misfit, k)| misfit / (n - k) as f64)
        .fold(f64::INFINITY, f64::min)
        .max(1.0);
    let bic = |misfit: f64, k: usize| misfit / scatter + k as f64 * (n as f64).ln();
    let none = bic(constant, 1);
    let straight = bic(line.misfit, 2);
    let stepped = segments.iter().enumerate().skip(1);
    let stepped = stepped
        .map(|(m, (misfit, at))| (bic(*misfit, 2 * m + 1), at))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let best_step = stepped.as_ref().map_or(f64::INFINITY, |(value, _)| *value);
    if none - straight.min(best_step) < least_gain {
        return None;
    }
    if straight <= best_step {
        let half = NORMAL_95 * line.slope_std * scatter.sqrt();
        return Some(Course::Line {
            ends: [times[0], times[n - 1]].map(|t| line.level + line.slope * (t - line.middle)),
            slope: line.slope,
            slope_ci95: [line.slope - half, line.slope + half],
        });
    }
    let at = stepped.map(|(_, at)| at.clone()).unwrap_or_default();
    let bounds: Vec<usize> = [0]
        .into_iter()
        .chain(at.iter().copied())
        .chain([n])
        .collect();
    let levels = bounds.windows(2).map(|pair| sums.level(pair[0], pair[1]));
    Some(Course::Steps {
        levels: levels.collect(),
        at,
    })
}

/// Sums of weights, weighted values and weighted squares up to each place, about the weighted mean.
struct Sums {
    middle: f64,
    sums: Vec<[f64; 3]>,
}

impl Sums {
    fn new(estimates: &[Estimate]) -> Sums {
        let weight = |e: &Estimate| e.std.powi(-2);
        let total: f64 = estimates.iter().map(weight).sum();
        let middle = estimates.iter().map(|e| weight(e) * e.value).sum::<f64>() / total;
        let mut sums = vec![[0.0; 3]];
        for e in estimates {
            let (w, y) = (weight(e), e.value - middle);
            let [a, b, c] = sums[sums.len() - 1];
            sums.push([a + w, b + w * y, c + w * y * y]);
        }
        Sums { middle, sums }
    }

    fn of(&self, from: usize, to: usize) -> [f64; 3] {
        let (a, b) = (self.sums[from], self.sums[to]);
        [b[0] - a[0], b[1] - a[1], b[2] - a[2]]
    }

    /// C of (1).
    fn misfit(&self, from: usize, to: usize) -> f64 {
        let [w, wy, wyy] = self.of(from, to);
        (wyy - wy * wy / w).max(0.0)
    }

    fn level(&self, from: usize, to: usize) -> f64 {
        let [w, wy, _] = self.of(from, to);
        self.middle + wy / w
    }
}

/// F(m, n) of (2) with where the segments after the first begin, for m = 1, 2 and so on, as far as there is room.
fn segments(sums: &Sums, n: usize) -> Vec<(f64, Vec<usize>)> {
    let first: Vec<f64> = (0..=n)
        .map(|j| {
            if j < LEAST_IN_SEGMENT {
                f64::INFINITY
            } else {
                sums.misfit(0, j)
            }
        })
        .collect();
    let mut layers = vec![first];
    let mut begins: Vec<Vec<usize>> = vec![vec![0; n + 1]];
    let mut found = vec![(sums.misfit(0, n), vec![])];
    for m in 1..MOST_SEGMENTS {
        let before = &layers[m - 1];
        let mut layer = vec![f64::INFINITY; n + 1];
        let mut begin = vec![0; n + 1];
        for j in (m + 1) * LEAST_IN_SEGMENT..=n {
            for i in m * LEAST_IN_SEGMENT..=j - LEAST_IN_SEGMENT {
                let misfit = before[i] + sums.misfit(i, j);
                if misfit < layer[j] {
                    (layer[j], begin[j]) = (misfit, i);
                }
            }
        }
        if !layer[n].is_finite() {
            break;
        }
        begins.push(begin);
        let mut at = vec![];
        let mut j = n;
        for begin in begins.iter().skip(1).rev() {
            j = begin[j];
            at.push(j);
        }
        at.reverse();
        found.push((layer[n], at));
        layers.push(layer);
    }
    found
}

struct Line {
    middle: f64,
    level: f64,
    slope: f64,
    slope_std: f64,
    misfit: f64,
}

/// Weighted least squares; `None` where all times are the same.
fn line(times: &[f64], estimates: &[Estimate]) -> Option<Line> {
    let all = || {
        times
            .iter()
            .zip(estimates)
            .map(|(t, e)| (*t, e.value, e.std.powi(-2)))
    };
    let total: f64 = all().map(|(_, _, w)| w).sum();
    let middle = all().map(|(t, _, w)| w * t).sum::<f64>() / total;
    let level = all().map(|(_, y, w)| w * y).sum::<f64>() / total;
    let spread: f64 = all().map(|(t, _, w)| w * (t - middle).powi(2)).sum();
    if spread <= 0.0 {
        return None;
    }
    let slope = all()
        .map(|(t, y, w)| w * (t - middle) * (y - level))
        .sum::<f64>()
        / spread;
    let left = |(t, y, w): (f64, f64, f64)| w * (y - level - slope * (t - middle)).powi(2);
    Some(Line {
        middle,
        level,
        slope,
        slope_std: spread.powf(-0.5),
        misfit: all().map(left).sum(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even scatter of about one standard error, without any chance: fractional parts of multiples of the golden ratio.
    fn series(level: impl Fn(usize) -> f64, std: f64) -> (Vec<f64>, Vec<Estimate>) {
        let scatter = |n: usize| 12f64.sqrt() * ((0.618_034 * n as f64).fract() - 0.5);
        let times = (0..25).map(|n| n as f64).collect();
        let estimates = (0..25).map(|n| Estimate {
            value: level(n) + std * scatter(n),
            std,
        });
        (times, estimates.collect())
    }

    #[test]
    fn verify_what_stays_is_no_course() {
        let (times, estimates) = series(|_| 3.0, 0.1);
        assert_eq!(course(&times, &estimates, 6.0), None);
        // One odd day is none either.
        let (times, estimates) = series(|n| if n == 12 { 4.0 } else { 3.0 }, 0.1);
        assert_eq!(course(&times, &estimates, 6.0), None);
    }

    #[test]
    fn verify_a_line_and_its_slope() {
        let (times, estimates) = series(|n| 1.0 + 0.1 * n as f64, 0.1);
        let Some(Course::Line {
            slope, slope_ci95, ..
        }) = course(&times, &estimates, 6.0)
        else {
            unreachable!("a line")
        };
        // s/√Σ(t − t̄)² = 0.1/√1300, and 1.96 of it on either side.
        assert!((slope - 0.1).abs() < 1.96 * 0.1 / 1300f64.sqrt());
        // No narrower, and as much wider as this scatter, whose mean square is near one, says: less than a tenth.
        let half = (slope_ci95[1] - slope) / (1.96 * 0.1 / 1300f64.sqrt());
        assert!((0.9999..1.1).contains(&half), "{half}");
    }

    #[test]
    fn verify_steps_are_found_where_they_are() {
        let (times, estimates) = series(
            |n| [1.0, 2.0, 0.5][usize::from(n >= 8) + usize::from(n >= 17)],
            0.1,
        );
        let Some(Course::Steps { at, levels }) = course(&times, &estimates, 6.0) else {
            unreachable!("steps")
        };
        assert_eq!(at, [8, 17]);
        // Means of eight or nine estimates.
        assert!(
            levels
                .iter()
                .zip([1.0, 2.0, 0.5])
                .all(|(found, true_level)| (found - true_level).abs() < 0.1)
        );
    }

    /// Against trying every place of two steps.
    #[test]
    fn verify_the_partition_is_the_best_of_all() {
        let (_, estimates) = series(|n| ((n * n) % 7) as f64, 0.5);
        let sums = Sums::new(&estimates);
        let mut best = f64::INFINITY;
        for i in 3..=19 {
            for j in i + 3..=22 {
                best = best.min(sums.misfit(0, i) + sums.misfit(i, j) + sums.misfit(j, 25));
            }
        }
        let found = &segments(&sums, 25)[2];
        assert!((found.0 - best).abs() < 1e-9 * best);
    }
}
