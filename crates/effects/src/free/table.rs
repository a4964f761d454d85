//! A table between equally spaced nodes.

/// A start has this share of the typical force, or of the channel, in each node.
pub(super) const START: f64 = 0.05;

/// Nodes of a table in displacement, or in the value of a channel.
pub(super) const NODES: usize = 9;

/// By this share of the range of a motion or a signal the nodes reach beyond it on either side: the
/// corrected motion may be larger than the nominal one.
const MARGIN: f64 = 0.1;

/// A table between equally spaced nodes: linear between them, constant beyond.
///
/// ```text
/// f(x) = f₀ + Σₖ (fₖ₊₁ − fₖ) r(x − k),   r(x) = min(max(x, 0), 1),   x = (N − 1) (z − z_lower) / (z_upper − z_lower)
/// ```
///
/// The ramps r have no branches, so that eight sets of values run side by side.
#[inline(always)]
pub(super) fn table([lower, upper]: [f64; 2], values: &[f64; NODES], at: f64) -> f64 {
    let span = upper - lower;
    // A table of no width is a step.
    let span = if span == 0.0 { f64::MIN_POSITIVE } else { span };
    let x = (NODES - 1) as f64 * ((at - lower) / span);
    let mut sum = values[0];
    for k in 0..NODES - 1 {
        sum += (values[k + 1] - values[k]) * (x - k as f64).clamp(0.0, 1.0);
    }
    sum
}

/// A range with its margin.
pub(super) fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    let margin = MARGIN * (high - low);
    [low - margin, high + margin]
}
