//! The frame of the machine: its leaf springs and its span.

use super::Context;

/// **Assumed**: length, width and thickness of leaf springs of steel, m. Nothing is printed.
pub(crate) const LEAVES_M: [[f64; 3]; 2] = [[1.06, 0.2, 0.010], [1.50, 0.2, 0.020]];

/// Leaf springs of the machine (Fig. 8).
pub(crate) const LEAF_COUNT: usize = 4;

/// Half span over radius of gyration that puts the roll at the torsional mode of the text.
pub(crate) fn span_ratio(context: &Context) -> f64 {
    context.stated.torsional_mode.si() / context.mold.natural_freq_hz()
}
