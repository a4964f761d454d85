//! Where a record of friction with a state of its own may begin.

/// Share of its level to which it has slid where a record begins in motion.
const SLID: f64 = 0.9;

/// Values that begin at rest, or slid to within a tenth of the level on either side: a record begins while the machine moves as often as
/// at rest. `place` is that of the share of the level at the start.
pub(super) fn starts(values: &[f64], place: usize) -> Vec<Vec<f64>> {
    let begun = |share: f64| {
        let mut values = values.to_vec();
        values[place] = share;
        values
    };
    [0.0, SLID, -SLID].map(begun).to_vec()
}
