//! Inner products of signals: one, and of many with many.
//!
//! To the last bit the same whatever instructions the processor has, and whatever number of threads.

use faer::Mat;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::signals::Signals;

/// Running sums of one dot product: enough additions that do not wait for each other.
const SUMS: usize = 32;

/// Σ xᵢ yᵢ
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    Arch::new().dispatch(Dot(x, y))
}

/// [`dot`] in the best instructions there are.
struct Dot<'a>(&'a [f64], &'a [f64]);

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Dot(x, y) = self;
        let mut sums = [0.0; SUMS];
        let (xs, ys) = (x.chunks_exact(SUMS), y.chunks_exact(SUMS));
        let rest = xs.remainder().iter().zip(ys.remainder());
        let rest: f64 = rest.map(|(p, q)| p * q).sum();
        for (p, q) in xs.zip(ys) {
            for k in 0..SUMS {
                sums[k] += p[k] * q[k];
            }
        }
        sums.iter().sum::<f64>() + rest
    }
}

/// Weighted inner product of two sets of signals.
pub(crate) fn inner(a: &Signals, b: &Signals, weights: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .zip(weights)
        .map(|((x, y), w)| w * dot(x, y))
        .sum()
}

/// Samples of every signal that are multiplied before the next are looked at: those of a tile stay in the first cache.
const BLOCK: usize = 512;
/// Signals of the left and of the right whose products are computed together: a sample that is loaded is used more
/// than once, and no addition waits for the one before.
const ROWS: usize = 4;
const COLUMNS: usize = 2;
/// Running sums of each of these products: one register of AVX-512, two of AVX2.
const LANES: usize = 8;

/// Products of [`ROWS`] signals with [`COLUMNS`].
type Tile = [[f64; COLUMNS]; ROWS];

/// Weighted inner products of each set of signals on the left with each on the right, where wanted; zero elsewhere.
pub(crate) fn inner_products(
    left: &[&Signals],
    right: &[&Signals],
    weights: &[f64],
    is_wanted: impl Fn(usize, usize) -> bool,
) -> Mat<f64> {
    let mut all = Mat::zeros(left.len(), right.len());
    for (c, weight) in weights.iter().enumerate() {
        add_scaled(&mut all, *weight, &products_of(left, right, c, &is_wanted));
    }
    all
}

pub(crate) fn add_scaled(sum: &mut Mat<f64>, factor: f64, other: &Mat<f64>) {
    for j in 0..sum.ncols() {
        for i in 0..sum.nrows() {
            sum[(i, j)] += factor * other[(i, j)];
        }
    }
}

/// Inner products of one channel of each set of signals on the left with that of each on the right, where wanted; zero elsewhere.
pub(crate) fn products_of(
    left: &[&Signals],
    right: &[&Signals],
    channel: usize,
    is_wanted: impl Fn(usize, usize) -> bool,
) -> Mat<f64> {
    let mut products = Mat::zeros(left.len(), right.len());
    let of_channel = |all: &[&'_ Signals]| all.iter().map(|s| s[channel].len()).min();
    let lengths = of_channel(left).into_iter().chain(of_channel(right));
    let len = lengths.min().unwrap_or(0);
    let cells = |(i, j): (usize, usize)| {
        let rows = i..(i + ROWS).min(left.len());
        let columns = j..(j + COLUMNS).min(right.len());
        let cells = rows.flat_map(move |row| columns.clone().map(move |column| (row, column)));
        cells.filter(|&(row, column)| is_wanted(row, column))
    };
    let corners = (0..left.len()).step_by(ROWS);
    let corners = corners.flat_map(|i| (0..right.len()).step_by(COLUMNS).map(move |j| (i, j)));
    let corners: Vec<(usize, usize)> = corners.filter(|&at| cells(at).count() > 0).collect();
    let of_block = |block: usize| {
        Arch::new().dispatch(Block {
            left,
            right,
            channel,
            corners: &corners,
            samples: [block * BLOCK, ((block + 1) * BLOCK).min(len)],
        })
    };
    let blocks = (0..len.div_ceil(BLOCK)).into_par_iter().map(of_block);
    // In the order of the blocks, whatever thread they came from.
    for block in blocks.collect::<Vec<_>>() {
        for (&(i, j), tile) in corners.iter().zip(block) {
            for (row, column) in cells((i, j)) {
                products[(row, column)] += tile[row - i][column - j];
            }
        }
    }
    products
}

/// The tiles with these corners, over some samples of a channel.
struct Block<'a> {
    left: &'a [&'a Signals],
    right: &'a [&'a Signals],
    channel: usize,
    corners: &'a [(usize, usize)],
    samples: [usize; 2],
}

impl WithSimd for Block<'_> {
    type Output = Vec<Tile>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<Tile> {
        let ([from, to], c) = (self.samples, self.channel);
        let mut tiles = Vec::with_capacity(self.corners.len());
        for &(i, j) in self.corners {
            // Beyond the last signal it is taken again, and its products are not looked at.
            let left = |r: usize| &self.left[(i + r).min(self.left.len() - 1)][c][from..to];
            let right = |r: usize| &self.right[(j + r).min(self.right.len() - 1)][c][from..to];
            tiles.push(dots(
                simd,
                std::array::from_fn(left),
                std::array::from_fn(right),
            ));
        }
        tiles
    }
}

/// Σ xᵢ yᵢ of each x with each y, all of one length.
#[inline(always)]
fn dots<S: Simd>(simd: S, left: [&[f64]; ROWS], right: [&[f64]; COLUMNS]) -> Tile {
    // Loops in the place of closures. Where one is not inlined, each sample is checked to be there and each sum is in memory.
    let count = left[0].len() / LANES;
    let mut xs = [&left[0].as_chunks::<LANES>().0[..count]; ROWS];
    let mut ys = [&right[0].as_chunks::<LANES>().0[..count]; COLUMNS];
    for (x, signal) in xs.iter_mut().zip(&left) {
        *x = &signal.as_chunks::<LANES>().0[..count];
    }
    for (y, signal) in ys.iter_mut().zip(&right) {
        *y = &signal.as_chunks::<LANES>().0[..count];
    }
    let mut sums = [[[simd.splat_f64s(0.0); LANES]; COLUMNS]; ROWS];
    let registers = LANES / S::F64_LANES;
    for n in 0..count {
        for c in 0..COLUMNS {
            let y = S::as_simd_f64s(&ys[c][n]).0;
            for r in 0..ROWS {
                let x = S::as_simd_f64s(&xs[r][n]).0;
                for k in 0..registers {
                    let product = simd.mul_f64s(x[k], y[k]);
                    sums[r][c][k] = simd.add_f64s(sums[r][c][k], product);
                }
            }
        }
    }
    let mut tile = [[0.0; COLUMNS]; ROWS];
    for r in 0..ROWS {
        for c in 0..COLUMNS {
            let mut lanes = [0.0; LANES];
            let registers = S::as_mut_simd_f64s(&mut lanes).0;
            for (register, sum) in registers.iter_mut().zip(sums[r][c]) {
                *register = sum;
            }
            let rest = left[r].iter().zip(right[c]).skip(count * LANES);
            let rest: f64 = rest.map(|(p, q)| p * q).sum();
            tile[r][c] = lanes.iter().sum::<f64>() + rest;
        }
    }
    tile
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signals of two channels that differ from set to set.
    fn signals(count: usize, len: usize, seed: u64) -> Vec<Signals> {
        let mut state = seed;
        let mut value = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut channel = || (0..len).map(|_| value()).collect();
        (0..count).map(|_| vec![channel(), channel()]).collect()
    }

    #[test]
    fn verify_products_of_many_are_those_of_two() {
        let weights = [2.0, 0.5];
        for (rows, columns, len) in [(1, 1, 3), (4, 2, 512), (5, 7, 1291), (2, 9, 0), (0, 3, 40)] {
            let (left, right) = (signals(rows, len, 1), signals(columns, len, 2));
            let (left, right): (Vec<_>, Vec<_>) = (left.iter().collect(), right.iter().collect());
            let is_wanted = |i: usize, j: usize| j <= i + 1;
            let found = inner_products(&left, &right, &weights, is_wanted);
            assert_eq!((found.nrows(), found.ncols()), (rows, columns));
            for (i, x) in left.iter().enumerate() {
                for (j, y) in right.iter().enumerate() {
                    let wanted = f64::from(u8::from(is_wanted(i, j))) * inner(x, y, &weights);
                    let off = (found[(i, j)] - wanted).abs();
                    assert!(off <= 1e-13 * len as f64, "{i}, {j} of {len}: off by {off}");
                }
            }
        }
    }

    #[test]
    fn verify_products_are_the_same_in_any_instructions() {
        let (left, right) = (signals(4, 301, 3), signals(2, 301, 4));
        let (left, right): (Vec<_>, Vec<_>) = (left.iter().collect(), right.iter().collect());
        let with = |arch: Arch| {
            arch.dispatch(Block {
                left: &left,
                right: &right,
                channel: 1,
                corners: &[(0, 0)],
                samples: [0, 301],
            })
        };
        assert_eq!(with(Arch::new()), with(Arch::Scalar));
    }
}
