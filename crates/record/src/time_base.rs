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

/// Stamps that are off their grid by more than this share of a step are no clock's noise: a sine of
/// ten samples a period is wrong by 3 % there.
const STEADY_FRACTION: f64 = 0.05;
/// Stamps rounded to a unit fill a band of one unit about their grid; the search for the grid and
/// the digits of a double widen it by a little.
const ROUNDED_UNITS: f64 = 1.02;
/// A slip of half a step is rounding where the unit is half a step.
const FINE_UNIT: f64 = 0.55;
/// Decimals that are looked at.
const MOST_DECIMALS: i32 = 12;
/// A stamp is a whole number of units when it is this close to one.
const WHOLE: f64 = 1e-3;

/// The step of the best uniform grid, or what keeps the stamps from having one.
///
/// Stamps may be off the grid by [`STEADY_FRACTION`] of a step. Beyond that, up to
/// [`UNEVEN_FRACTION`], they pass only if nothing but the rounding of what was printed moves them:
/// 0.02 and 0.03 s by turns are an even 0.025 s where stamps are whole hundredths, and a real
/// alternation where they have three decimals.
pub(crate) fn check_even(time_s: &[f64]) -> Result<f64, TimeFault> {
    if let Some(row) = time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(TimeFault::Order { row: row + 1 });
    }
    let step = best_step(time_s);
    let worst = grid_deviations(time_s, step).fold(0.0, |worst: f64, d| worst.max(d.abs()));
    if worst <= STEADY_FRACTION || is_rounding(time_s, step, worst) {
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

/// Whether some even time base, rounded to the unit of these stamps, gives them.
///
/// A lost sample looks like the rounding of a slow clock where the unit is a whole step. So units of
/// more than [`FINE_UNIT`] steps explain nothing beyond [`UNEVEN_FRACTION`] about the best grid.
fn is_rounding(time_s: &[f64], step: f64, worst: f64) -> bool {
    // A stamp is moved by half a unit; the best grid lies up to another half off.
    let Some(unit) = unit_of(time_s, step).filter(|unit| *unit >= worst * step) else {
        return false;
    };
    let near = worst <= UNEVEN_FRACTION || unit <= FINE_UNIT * step;
    near && band(time_s, step) <= ROUNDED_UNITS * unit
}

/// The largest power of ten of at most a step, or place of single precision, that all stamps are whole
/// multiples of.
fn unit_of(time_s: &[f64], step: f64) -> Option<f64> {
    let end = time_s.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
    let whole = |t: &f64, unit: f64| (t / unit - (t / unit).round()).abs() < WHOLE;
    let decimal = (-3..=MOST_DECIMALS)
        .map(|decimals| 1.0 / 10_f64.powi(decimals))
        .filter(|&unit| unit <= step && unit > 1e-15 * end / WHOLE)
        .find(|&unit| time_s.iter().all(|t| whole(t, unit)));
    let single = || {
        let stored = time_s.iter().all(|&t| f64::from(t as f32) == t);
        stored.then(|| end * f64::from(f32::EPSILON))
    };
    decimal.or_else(single)
}

/// Width of the narrowest band of even slope that holds all stamps: the least over h of
///
/// ```text
///   w(h) = max (tₖ - k h) - min (tₖ - k h)                                                (2)
/// ```
///
/// which is convex in h. A line of least squares is drawn away by a slip near an end; this is not.
fn band(time_s: &[f64], step: f64) -> f64 {
    const ROUNDS: usize = 60;
    let start = time_s.first().copied().unwrap_or(0.0);
    let width = |h: f64| {
        let rest = |(k, t): (usize, &f64)| t - start - k as f64 * h;
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = time_s
            .iter()
            .enumerate()
            .map(rest)
            .fold(ends, |(low, high), r| (r.min(low), r.max(high)));
        high - low
    };
    // A slope further off than this makes a band of more than two steps by itself.
    let reach = 2.0 * step / (time_s.len() as f64 - 1.0);
    let (mut low, mut high) = (step - reach, step + reach);
    for _ in 0..ROUNDS {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if width(a) <= width(b) {
            high = b;
        } else {
            low = a;
        }
    }
    width((low + high) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(rate: f64, unit: f64, rows: usize) -> Vec<f64> {
        let stamp = |k: usize| (k as f64 / rate / unit).round() * unit;
        (0..rows).map(stamp).collect()
    }

    #[test]
    fn verify_rounding_is_told_from_a_real_alternation() {
        // 40 Hz in hundredths: 0.02 and 0.03 s by turns, 0.1 of a step off.
        assert_eq!(
            check_even(&printed(40.0, 0.01, 400)).map(|h| (h * 1e5).round()),
            Ok(2500.0)
        );
        let real = |k: usize| 0.025 * k as f64 + if k % 2 == 1 { 0.004_9 } else { 0.0 };
        let real: Vec<f64> = (0..400).map(real).collect();
        assert!(
            matches!(check_even(&real), Err(TimeFault::Uneven { .. })),
            "{:?}",
            check_even(&real)
        );
    }

    #[test]
    fn verify_a_slip_of_half_a_step_is_rounding_only_where_stamps_are_coarse() {
        for at in [20, 100, 180] {
            let slip = |k: usize| 0.02 * k as f64 + if k >= at { 0.01 } else { 0.0 };
            let coarse: Vec<f64> = (0..200).map(slip).collect();
            assert!(check_even(&coarse).is_ok(), "{at}");
            let fine: Vec<f64> = coarse
                .iter()
                .enumerate()
                .map(|(k, t)| t + 1e-4 * (k % 2) as f64)
                .collect();
            assert!(
                matches!(check_even(&fine), Err(TimeFault::Uneven { row, .. }) if row == at),
                "{at}"
            );
        }
        // Two slips close together are no steady clock.
        let twice = |k: usize| {
            0.02 * k as f64 + if k >= 100 { 0.01 } else { 0.0 } + if k >= 110 { 0.01 } else { 0.0 }
        };
        let twice: Vec<f64> = (0..200).map(twice).collect();
        assert!(check_even(&twice).is_err());
    }

    #[test]
    fn verify_a_lost_sample_is_no_rounding() {
        for rows in [20, 200, 2000] {
            let lost: Vec<f64> = printed(100.0, 0.01, rows + 1)
                .into_iter()
                .enumerate()
                .filter(|(k, _)| *k != rows / 2)
                .map(|(_, t)| t)
                .collect();
            assert!(check_even(&lost).is_err(), "{rows}");
        }
    }

    #[test]
    fn verify_stamps_of_single_precision_are_rounded() {
        let single = |k: usize| f64::from((100_000.0 + 0.02 * k as f64) as f32);
        let stamps: Vec<f64> = (0..500).map(single).collect();
        let step = check_even(&stamps).unwrap_or(f64::NAN);
        assert!((step / 0.02 - 1.0).abs() < 1e-3, "{step}");
    }
}
