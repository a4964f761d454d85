//! Is a column of stamps an even time base, and of which step?

/// A stamp may be this fraction of a step away from the best uniform grid.
///
/// Stamps rounded to 3 decimals at 610 Hz are 0.305 of a step off at worst and must pass. One
/// missing sample must not: it stretches the step of the best grid to 1 + e steps, e <= 4/21 (in
/// the middle of the shortest record), and tears the residuals of its neighbours apart by
/// 2 / (1 + e) - 1 >= 0.68 of a step, so that one of the two is at least 0.34 off.
pub const UNEVEN_FRACTION: f64 = 0.33;

/// Step of the uniform grid closest to the stamps in the least-squares sense.
///
/// ```text
///        Σ (k - k̄) (tₖ - t̄)
///   h =  ──────────────────── ,   k = 0 .. n-1                (1)
///            Σ (k - k̄)²
/// ```
///
/// Rounding of printed stamps averages out in (1), where the distance between the first and the
/// last stamp would keep theirs. Times count from the first stamp: a record that starts late
/// loses no digits. Needs two stamps at least.
pub(crate) fn best_step(time_s: &[f64]) -> f64 {
    let start = time_s.first().copied().unwrap_or(0.0);
    let middle = (time_s.len() as f64 - 1.0) / 2.0;
    let (mut product, mut square) = (0.0, 0.0);
    for (k, &t) in time_s.iter().enumerate() {
        let from_middle = k as f64 - middle;
        // Σ (k - k̄) t̄ vanishes, so t̄ need not be known.
        product += from_middle * (t - start);
        square += from_middle * from_middle;
    }
    product / square // (1)
}

/// Distance of every stamp from the best uniform grid, in steps.
pub(crate) fn grid_deviations(time_s: &[f64], step: f64) -> impl Iterator<Item = f64> {
    let start = time_s.first().copied().unwrap_or(0.0);
    let count = time_s.len() as f64;
    let mean = time_s.iter().map(|t| t - start).sum::<f64>() / count;
    let middle = (count - 1.0) / 2.0;
    time_s
        .iter()
        .enumerate()
        .map(move |(k, &t)| (t - start - mean) / step - (k as f64 - middle))
}

/// What is wrong with a column of finite stamps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum TimeFault {
    /// The stamp of this row is not later than the one before.
    Order {
        /// Row of the later stamp.
        row: usize,
    },
    /// Not evenly spaced.
    Uneven {
        /// Row of the stamp that ends the oddest step.
        row: usize,
        /// That step, s.
        found: f64,
        /// Median step, s.
        usual: f64,
    },
}

/// The step of the best uniform grid, or what keeps the stamps from having one.
pub(crate) fn check_even(time_s: &[f64]) -> Result<f64, TimeFault> {
    if let Some(row) = time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(TimeFault::Order { row: row + 1 });
    }
    let step = best_step(time_s);
    if grid_deviations(time_s, step).all(|deviation| deviation.abs() <= UNEVEN_FRACTION) {
        return Ok(step);
    }
    let mut steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let usual = *steps
        .clone()
        .select_nth_unstable_by(middle, f64::total_cmp)
        .1;
    let oddity = |step: f64| (step - usual).abs();
    let (row, found) = steps
        .drain(..)
        .enumerate()
        .max_by(|a, b| oddity(a.1).total_cmp(&oddity(b.1)).then(b.0.cmp(&a.0)))
        .unwrap_or((0, usual));
    Err(TimeFault::Uneven {
        row: row + 1,
        found,
        usual,
    })
}
