//! Do the values lie on a lattice?

/// More levels than this are no defect: 16 bits.
const MOST_LEVELS: f64 = 65_536.0;
/// Fewest levels that make a lattice when most values occur more than once ...
const LEAST_LEVELS: usize = 6;
/// ... and when they do not, so that chance cannot line them up: 0.2^14 with
/// [`OFF_LATTICE`], two levels being spent on origin and step.
const LEAST_SINGLE_LEVELS: usize = 16;
/// A level may be this fraction of a step off: rounding of the printed value.
const OFF_LATTICE: f64 = 0.1;
/// Share of levels that must be on the lattice.
const ON_LATTICE_SHARE: f64 = 0.98;
/// From this index on, the span so far gives the step better than the smallest gaps do.
const TRUSTED_SPAN: f64 = 20.0;
/// A ramp or a triangle is on a lattice too: so large a share of its changes are of one size.
const RAMP_SHARE: f64 = 0.95;

/// Levels `origin + k step`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lattice {
    pub(super) step: f64,
    pub(super) levels: usize,
}

/// Different values with their numbers, rising.
pub(super) fn distinct(sorted: &[f64]) -> Vec<(f64, usize)> {
    let mut levels: Vec<(f64, usize)> = Vec::new();
    for &value in sorted {
        match levels.last_mut() {
            Some((last, count)) if *last == value => *count += 1,
            _ => levels.push((value, 1)),
        }
    }
    levels
}

/// The lattice of the values, if there is one. `levels` are their different values.
pub(super) fn lattice(values: &[f64], levels: &[(f64, usize)]) -> Option<Lattice> {
    // Outliers beside the lattice occur once: where most values occur often, ask those only.
    let often: Vec<f64> = levels.iter().filter(|l| l.1 >= 2).map(|l| l.0).collect();
    let singles = levels.iter().filter(|l| l.1 == 1).count();
    let (used, least) = if 2 * singles <= values.len() {
        (often, LEAST_LEVELS)
    } else {
        (levels.iter().map(|l| l.0).collect(), LEAST_SINGLE_LEVELS)
    };
    if used.len() < least {
        return None;
    }
    let step = fitted_step(&used)?;
    let mut changes: Vec<f64> = values
        .windows(2)
        .map(|pair| ((pair[1] - pair[0]) / step).abs().round())
        .collect();
    let middle = changes.len() / 2;
    let median = *changes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let alike = changes.iter().filter(|&&change| change == median).count();
    if median > 0.0 && alike as f64 > RAMP_SHARE * changes.len() as f64 {
        return None;
    }
    let span = (used[used.len() - 1] - used[0]) / step;
    Some(Lattice {
        step,
        levels: span.round() as usize + 1,
    })
}

/// The step of the lattice through rising levels, by least squares.
fn fitted_step(levels: &[f64]) -> Option<f64> {
    let gaps = || levels.windows(2).map(|pair| pair[1] - pair[0]);
    let smallest = gaps().fold(f64::INFINITY, f64::min);
    let range = levels[levels.len() - 1] - levels[0];
    if range.is_nan() || range / smallest > 1.5 * MOST_LEVELS {
        return None;
    }
    // Printed values are rounded, the smallest gap most of all: take the mean of its like.
    let like = || gaps().filter(|&gap| gap < 1.5 * smallest);
    let first_guess = like().sum::<f64>() / like().count() as f64;
    let mut index = 0.0;
    let mut indices = vec![0.0];
    for pair in levels.windows(2) {
        let guess = if index > TRUSTED_SPAN {
            (pair[0] - levels[0]) / index
        } else {
            first_guess
        };
        index += ((pair[1] - pair[0]) / guess).round().max(1.0);
        indices.push(index);
    }
    if index > MOST_LEVELS {
        return None;
    }
    let count = levels.len() as f64;
    let mean_index = indices.iter().sum::<f64>() / count;
    let mean_level = levels.iter().map(|l| l - levels[0]).sum::<f64>() / count;
    let (mut product, mut square) = (0.0, 0.0);
    for (index, level) in indices.iter().zip(levels) {
        product += (index - mean_index) * (level - levels[0] - mean_level);
        square += (index - mean_index) * (index - mean_index);
    }
    let step = product / square;
    let on_lattice = |(index, level): &(&f64, &f64)| {
        let off = (*level - levels[0] - mean_level) / step - (*index - mean_index);
        off.abs() <= OFF_LATTICE
    };
    let on = indices.iter().zip(levels).filter(on_lattice).count();
    (on as f64 >= ON_LATTICE_SHARE * count).then_some(step)
}
