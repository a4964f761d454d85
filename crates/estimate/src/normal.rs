//! Normal equations of the weighted least-squares step.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::gram::Gram;
use crate::layout::Layout;
use crate::linearise::Linearised;
use crate::products::inner_products;
use crate::signals::Signals;

/// H = Jᵀ W J + prior, g = Jᵀ W r − prior gradient, in units of the scales; the products of J are those of its runs.
pub(crate) fn normal_equations(
    layout: &Layout,
    theta: &[f64],
    at: &Linearised,
    grams: &[Gram],
    weights: &[f64],
) -> (Mat<f64>, Vec<f64>) {
    let len = layout.len();
    let mut hessian = Mat::zeros(len, len);
    for (run, gram) in grams.iter().enumerate() {
        let index = layout.entries(run).collect::<Vec<_>>();
        add_symmetric(&mut hessian, &index, &gram.weighted(weights));
    }
    let mut gradient = projected(layout, at, &at.discrepancy, weights);
    for i in 0..len {
        let [_, slope, curvature] = layout.prior_at(i, theta[i]);
        hessian[(i, i)] += curvature * layout.scale[i].powi(2);
        gradient[i] -= slope * layout.scale[i];
    }
    (hessian, gradient)
}

/// Adds products that are given below the diagonal and on it, by the entries of their rows.
fn add_symmetric(sum: &mut Mat<f64>, index: &[usize], products: &Mat<f64>) {
    for a in 0..products.nrows() {
        for b in 0..=a {
            sum[(index[a], index[b])] += products[(a, b)];
            if a != b {
                sum[(index[b], index[a])] += products[(a, b)];
            }
        }
    }
}

/// Jᵀ W s of signals of all runs, in units of the scales.
pub(crate) fn projected(
    layout: &Layout,
    at: &Linearised,
    signals: &[Signals],
    weights: &[f64],
) -> Vec<f64> {
    let mut projected = vec![0.0; layout.len()];
    for (run, columns) in at.columns.iter().enumerate() {
        let columns: Vec<&Signals> = columns.iter().map(AsRef::as_ref).collect();
        let products = inner_products(&columns, &[&signals[run]], weights, |_, _| true);
        for (place, entry) in layout.entries(run).enumerate() {
            projected[entry] += products[(place, 0)];
        }
    }
    projected
}

/// A diagonal entry below this share of the largest belongs to a direction the data do not see.
const UNSEEN: f64 = 1e-24;

/// Solves (H + λ diag H) δ = g over the entries that are free to move; the others stay.
pub(crate) fn damped_step(
    hessian: &Mat<f64>,
    gradient: &[f64],
    free: &[usize],
    damping: f64,
) -> Option<Vec<f64>> {
    let (factor, kept, scale) = factorise(hessian, free, damping)?;
    let rhs = Mat::from_fn(kept.len(), 1, |i, _| gradient[kept[i]] / scale[i]);
    let solution = factor.solve(rhs);
    let mut step = vec![0.0; gradient.len()];
    for (i, &entry) in kept.iter().enumerate() {
        step[entry] = solution[(i, 0)] / scale[i];
    }
    step.iter().all(|value| value.is_finite()).then_some(step)
}

/// Diagonal of H⁻¹ over the free entries; infinite where the data see nothing.
pub(crate) fn variances(hessian: &Mat<f64>, free: &[usize]) -> Vec<f64> {
    let mut variance = vec![f64::INFINITY; hessian.nrows()];
    // A whisper of damping keeps a singular H factorisable; its directions come out at 1e12 of the
    // well-seen ones, which is as good as infinite.
    let Some((factor, kept, scale)) = factorise(hessian, free, 1e-12) else {
        return variance;
    };
    let inverse = factor.solve(Mat::<f64>::identity(kept.len(), kept.len()));
    for (i, &entry) in kept.iter().enumerate() {
        let value = inverse[(i, i)];
        variance[entry] = if value < 1e10 {
            value / (scale[i] * scale[i])
        } else {
            f64::INFINITY
        };
    }
    variance
}

pub(crate) type Factor = faer::linalg::solvers::Llt<f64>;

/// Cholesky factor of H scaled to a unit diagonal, over the free entries that are seen.
pub(crate) fn factorise(
    hessian: &Mat<f64>,
    free: &[usize],
    damping: f64,
) -> Option<(Factor, Vec<usize>, Vec<f64>)> {
    let largest = free.iter().map(|&i| hessian[(i, i)]).fold(0.0, f64::max);
    let kept: Vec<usize> = free
        .iter()
        .copied()
        .filter(|&i| hessian[(i, i)] > UNSEEN * largest)
        .collect();
    let scale: Vec<f64> = kept.iter().map(|&i| hessian[(i, i)].sqrt()).collect();
    let matrix = Mat::from_fn(kept.len(), kept.len(), |i, j| {
        let value = hessian[(kept[i], kept[j])] / (scale[i] * scale[j]);
        if i == j {
            value * (1.0 + damping)
        } else {
            value
        }
    });
    let factor = matrix.llt(Side::Lower).ok()?;
    Some((factor, kept, scale))
}
