//! Dynamic time warping of two curves of one length inside a band.

/// What the best warping path adds up to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WarpedSums {
    /// Σ |x_i - y_j| along the path.
    pub(super) difference: f64,
    /// Σ |y_j| along the path.
    pub(super) reference: f64,
}

#[derive(Clone, Copy)]
struct Cell {
    cost: f64,
    sums: WarpedSums,
}

const OUTSIDE: Cell = Cell {
    cost: f64::INFINITY,
    sums: WarpedSums {
        difference: 0.0,
        reference: 0.0,
    },
};

/// Warps `x` onto `y` (same length, at least 1) with |i - j| < `radius`.
///
/// ```text
/// D(i,j) = (x_i - y_j)² + min( D(i-1,j), D(i,j-1), D(i-1,j-1) ),   first of equals taken
/// ```
///
/// The sums along the path are carried with the costs, so that memory is one row of the band and no
/// path is traced back.
pub(super) fn warped_sums(x: &[f64], y: &[f64], radius: usize) -> WarpedSums {
    let n = x.len().min(y.len());
    let radius = radius.max(1);
    let mut above = vec![OUTSIDE; n];
    let mut row = vec![OUTSIDE; n];
    for i in 0..n {
        // Both ends of the band only move right: cells beyond `to` are still OUTSIDE in both buffers, and
        // those left behind are not looked at again.
        let from = (i + 1).saturating_sub(radius);
        let to = (i + radius).min(n);
        for j in from..to {
            let best = if i == 0 && j == 0 {
                Cell {
                    cost: 0.0,
                    ..OUTSIDE
                }
            } else {
                let left = if j > from { row[j - 1] } else { OUTSIDE };
                let up = if i > 0 { above[j] } else { OUTSIDE };
                let diagonal = if i > 0 && j > 0 {
                    above[j - 1]
                } else {
                    OUTSIDE
                };
                let mut best = up;
                for other in [left, diagonal] {
                    if other.cost < best.cost {
                        best = other;
                    }
                }
                best
            };
            let difference = (x[i] - y[j]).abs();
            row[j] = Cell {
                cost: best.cost + difference * difference,
                sums: WarpedSums {
                    difference: best.sums.difference + difference,
                    reference: best.sums.reference + y[j].abs(),
                },
            };
        }
        std::mem::swap(&mut above, &mut row);
    }
    above[n - 1].sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slow and obvious way: the whole matrix, and the path traced back from its corner.
    fn oracle(x: &[f64], y: &[f64], radius: usize) -> WarpedSums {
        let n = x.len();
        let mut cost = vec![vec![f64::INFINITY; n]; n];
        let before = |cost: &[Vec<f64>], i: usize, j: usize| {
            let mut steps = Vec::new();
            if i > 0 {
                steps.push((cost[i - 1][j], i - 1, j));
            }
            if j > 0 {
                steps.push((cost[i][j - 1], i, j - 1));
            }
            if i > 0 && j > 0 {
                steps.push((cost[i - 1][j - 1], i - 1, j - 1));
            }
            // min_by keeps the first of equals
            steps.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
        };
        for i in 0..n {
            for j in 0..n {
                if i.abs_diff(j) < radius {
                    let past = before(&cost, i, j).map_or(0.0, |b| b.0);
                    cost[i][j] = past + (x[i] - y[j]).powi(2);
                }
            }
        }
        let (mut i, mut j) = (n - 1, n - 1);
        let mut sums = WarpedSums {
            difference: 0.0,
            reference: 0.0,
        };
        loop {
            sums.difference += (x[i] - y[j]).abs();
            sums.reference += y[j].abs();
            match before(&cost, i, j) {
                Some((_, a, b)) => (i, j) = (a, b),
                None => return sums,
            }
        }
    }

    #[test]
    fn verify_sums_are_those_of_the_traced_path() {
        // Sums of at most 200 numbers of order one.
        const ROUNDING: f64 = 1e-12;
        let mut state = 7u64;
        let mut digit = |most: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 33) % most) as f64
        };
        for round in 0..40 {
            for n in [1usize, 2, 5, 23, 60] {
                // Small integers make ties, which both must break alike.
                let x: Vec<f64> = (0..n).map(|_| digit(4)).collect();
                let y: Vec<f64> = (0..n).map(|_| digit(3) - 1.0).collect();
                for radius in [1, 2, 6, n] {
                    let (got, want) = (warped_sums(&x, &y, radius), oracle(&x, &y, radius));
                    let error = (got.difference - want.difference).abs()
                        + (got.reference - want.reference).abs();
                    assert!(error < ROUNDING, "{round} {n} {radius}: {got:?} {want:?}");
                }
            }
        }
    }
}
