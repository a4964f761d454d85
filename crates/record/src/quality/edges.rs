//! Is an extreme value held?

use super::finding::{Defect, Edge};
use super::lattice::Lattice;

/// Two equal samples may straddle the crest of a smooth curve; three may not.
const LEAST_RUN: usize = 3;
/// One run must be this long: shorter ones may be a lost sample held at the crest.
const LONE_RUN: usize = 8;
/// With fewer different values, it is a set of positions or a staircase.
const LEAST_LEVELS: usize = 6;
/// On a lattice: how many times more samples at the edge than in the band below it. The top level
/// of a quantised sine holds up to 2.5 times the level below, and 1.4 times the band.
const CROWDING: usize = 4;
/// Width of that band, as a share of the range ...
const BAND_SHARE: f64 = 0.02;
/// ... and at least so many steps of the lattice.
const BAND_STEPS: f64 = 2.5;

/// The defect at one edge, if any. `levels` are the different values, rising, with their numbers.
pub(super) fn clipped(
    values: &[f64],
    levels: &[(f64, usize)],
    lattice: Option<Lattice>,
    edge: Edge,
) -> Option<Defect> {
    let (&(smallest, low_count), &(largest, high_count)) = (levels.first()?, levels.last()?);
    let (level, count) = match edge {
        Edge::Upper => (largest, high_count),
        Edge::Lower => (smallest, low_count),
    };
    if levels.len() < LEAST_LEVELS {
        return None;
    }
    let runs: Vec<usize> = values
        .chunk_by(|a, b| a == b)
        .filter(|run| run[0] == level)
        .map(<[f64]>::len)
        .collect();
    let longest_run = runs.iter().copied().max()?;
    let long_runs = runs.iter().filter(|&&run| run >= LEAST_RUN).count();
    if long_runs < 2 && longest_run < LONE_RUN {
        return None;
    }
    if let Some(lattice) = lattice {
        let band = (BAND_SHARE * (largest - smallest)).max(BAND_STEPS * lattice.step);
        let near = |value: f64| value != level && (value - level).abs() <= band;
        let below: usize = levels.iter().filter(|l| near(l.0)).map(|l| l.1).sum();
        if count < CROWDING * (below + 1) {
            return None;
        }
    }
    let fraction = count as f64 / values.len() as f64;
    Some(Defect::Clipped {
        edge,
        level,
        fraction,
        longest_run,
    })
}
