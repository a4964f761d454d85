//! Single samples off the curve through their neighbours.

use super::finding::Defect;
use super::lattice::Lattice;

/// Robust standard deviations a second difference must reach: out of reach for Gaussian noise.
const THRESHOLD: f64 = 10.0;
/// Normal distribution: standard deviation over median magnitude.
const DEVIATION_PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// A second difference of white noise of deviation 1 has the deviation sqrt(1 + 4 + 1).
const SECOND_DIFFERENCE_GAIN: f64 = 2.449_489_742_783_178;
/// Rows over which the local spread is taken: a record grows louder and quieter.
const BLOCK: usize = 64;
/// A spike h at row i makes second differences h, -2h, h: the outer ones, over minus the middle
/// one, are 1/2 give or take the noise, which is 0.1 of the middle one at the threshold.
const OUTER_SHARE: std::ops::RangeInclusive<f64> = 0.25..=0.75;
/// On a lattice second differences of a slow curve are 0 or one step: spread in steps.
const LATTICE_DEVIATION: f64 = 0.5;

/// The defect, if there is any spike but those of filled samples and beside them.
///
/// ```text
/// cᵢ = yᵢ₋₁ - 2 yᵢ + yᵢ₊₁                                          (1)
/// σᵢ = 1.4826 max(median of |c| > 0, median of |c| about i)         (2)
/// spike at i:  |cᵢ| > 10 σᵢ,  -cᵢ₋₁/cᵢ and -cᵢ₊₁/cᵢ in 0.25 .. 0.75  (3)
/// height h = -cᵢ/2                                                  (4)
/// ```
///
/// A smooth curve cannot meet (3): neighbouring second differences have one sign. So a decay from
/// a large amplitude, or an impact, is none.
pub(super) fn spikes(
    (values, filled): (&[f64], &[bool]),
    lattice: Option<Lattice>,
) -> Option<Defect> {
    let bends: Vec<f64> = values
        .windows(3)
        .map(|y| y[0] - 2.0 * y[1] + y[2])
        .collect(); // (1)
    let floor = lattice.map_or(0.0, |l| LATTICE_DEVIATION * l.step);
    // Where a value is held there is no bend and nothing to learn about the noise.
    let bent: Vec<f64> = bends.iter().copied().filter(|&bend| bend != 0.0).collect();
    if bent.is_empty() {
        return None;
    }
    let global = (DEVIATION_PER_MEDIAN * median_magnitude(&bent)).max(floor);
    let local: Vec<f64> = bends
        .chunks(BLOCK)
        .map(|block| global.max(DEVIATION_PER_MEDIAN * median_magnitude(block))) // (2)
        .collect();
    let mut rows = Vec::new();
    let mut largest = 0.0_f64;
    for i in 1..bends.len() - 1 {
        let middle = bends[i];
        let outer = |k: usize| OUTER_SHARE.contains(&(-bends[k] / middle));
        let measured = !filled.get(i..i + 3).unwrap_or_default().contains(&true);
        if measured && middle.abs() > THRESHOLD * local[i / BLOCK] && outer(i - 1) && outer(i + 1) {
            rows.push(i + 1); // (3): the bend of index i is about row i + 1
            let height = -middle / 2.0; // (4)
            if height.abs() > largest.abs() {
                largest = height;
            }
        }
    }
    let noise = global / SECOND_DIFFERENCE_GAIN;
    (!rows.is_empty()).then_some(Defect::Spikes {
        rows,
        largest,
        noise,
    })
}

fn median_magnitude(values: &[f64]) -> f64 {
    let mut magnitudes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    let middle = magnitudes.len() / 2;
    *magnitudes.select_nth_unstable_by(middle, f64::total_cmp).1
}
