//! An even time base in place of an uneven one.
//!
//! Between two stamps the curve is the cubic that takes their values and, at each of them, the
//! slope of the parabola through it and its two neighbours:
//!
//! ```text
//!   s = (t - t₀) / h,   h = t₁ - t₀
//!   y(t) = (1 + 2s)(1 - s)² y₀ + s (1 - s)² h m₀ + s² (3 - 2s) y₁ + s² (s - 1) h m₁     (1)
//!   mₖ   = (h₊ d₋ + h₋ d₊) / (h₋ + h₊),   d± the slopes of the steps h± beside stamp k    (2)
//! ```
//!
//! On even stamps the value halfway is (9 (y₀ + y₁) - (y₋₁ + y₂)) / 16. Of a sine of frequency f
//! it keeps, with x = π f h,
//!
//! ```text
//!   (9 cos x - cos 3x) / 8 = 1 - 3 x⁴ / 8 + O(x⁶)                                         (3)
//! ```
//!
//! which is 1 % less than 1 at x = 0.410.

/// x of equation (3) at which a sine loses 1 %: (9 cos x - cos 3x) / 8 = 0.99.
const ONE_PERCENT_X: f64 = 0.409_8;
/// A step is a gap, and no part of the usual spacing, when it is longer than so many medians.
const GAP_MEDIANS: f64 = 1.5;
/// This near to a stamp, in steps, its value is taken as it is.
pub(crate) const AT_STAMP: f64 = 1e-6;

/// Highest frequency of which a sine loses at most 1 % between stamps so far apart, Hz.
pub(crate) fn trusted_hz(longest_s: f64) -> f64 {
    ONE_PERCENT_X / (std::f64::consts::PI * longest_s)
}

/// The usual distance of rising stamps: the mean of those that are no gaps. A mean, because the
/// median of stamps rounded to a few decimals is one of the rounded steps.
pub(crate) fn usual_step(time_s: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let usual = steps.iter().filter(|&&step| step <= GAP_MEDIANS * median);
    let (sum, count) = usual.fold((0.0, 0.0), |(sum, count), step| (sum + step, count + 1.0));
    sum / count
}

/// Values at `start + k step`, k = 0 .. rows-1, of the curve (1) through samples at rising stamps.
pub(crate) fn on_grid(time_s: &[f64], values: &[f64], step_s: f64, rows: usize) -> Vec<f64> {
    let start = time_s.first().copied().unwrap_or(0.0);
    curve(
        time_s,
        values,
        (0..rows).map(|row| start + row as f64 * step_s),
    )
}

/// Values of the curve (1) at other rising stamps.
pub(crate) fn at_stamps(time_s: &[f64], values: &[f64], stamps: &[f64]) -> Vec<f64> {
    curve(time_s, values, stamps.iter().copied())
}

fn curve(time_s: &[f64], values: &[f64], stamps: impl Iterator<Item = f64>) -> Vec<f64> {
    let last = time_s.len().saturating_sub(2);
    let mut k = 0;
    stamps
        .map(|t| {
            while k < last && time_s[k + 1] <= t {
                k += 1;
            }
            between(time_s, values, k, t)
        })
        .collect()
}

/// Equation (1) between stamps k and k + 1.
fn between(time_s: &[f64], values: &[f64], k: usize, t: f64) -> f64 {
    let h = time_s[k + 1] - time_s[k];
    let s = ((t - time_s[k]) / h).clamp(0.0, 1.0);
    if s <= AT_STAMP {
        return values[k];
    }
    if s >= 1.0 - AT_STAMP {
        return values[k + 1];
    }
    let (m0, m1) = (slope(time_s, values, k), slope(time_s, values, k + 1));
    let r = 1.0 - s;
    (1.0 + 2.0 * s) * r * r * values[k]
        + s * r * r * h * m0
        + s * s * (3.0 - 2.0 * s) * values[k + 1]
        - s * s * r * h * m1 // (1)
}

/// Equation (2); at the ends the slope there of the parabola through three stamps.
fn slope(time_s: &[f64], values: &[f64], k: usize) -> f64 {
    let step = |k: usize| {
        let h = time_s[k + 1] - time_s[k];
        (h, (values[k + 1] - values[k]) / h)
    };
    let end =
        |(h, d): (f64, f64), (h_next, d_next): (f64, f64)| d + h * (d - d_next) / (h + h_next);
    if time_s.len() < 3 {
        return step(0).1;
    }
    if k == 0 {
        return end(step(0), step(1));
    }
    let (before, d_before) = step(k - 1);
    if k + 1 == time_s.len() {
        return end(step(k - 1), step(k - 2));
    }
    let (after, d_after) = step(k);
    (after * d_before + before * d_after) / (before + after) // (2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uneven(len: usize) -> Vec<f64> {
        (0..len)
            .map(|k| 0.01 * (k as f64 + 0.4 * (1.7 * k as f64).sin()))
            .collect()
    }

    #[test]
    fn verify_the_band_loses_one_percent() {
        let x = ONE_PERCENT_X;
        let kept = (9.0 * x.cos() - (3.0 * x).cos()) / 8.0;
        // Four digits of x, and the slope of (3) there is -0.1.
        assert!((kept - 0.99).abs() < 1e-5, "{kept}");
    }

    #[test]
    fn verify_a_parabola_is_kept_on_uneven_stamps() {
        let time = uneven(40);
        let parabola = |t: f64| 3.0 - 2.0 * t + 5.0 * t * t;
        let values: Vec<f64> = time.iter().map(|&t| parabola(t)).collect();
        let start = time[0];
        let found = on_grid(&time, &values, 0.007, 50);
        // The ends have a straight step and are of second order only.
        for (row, value) in found.iter().enumerate().skip(4).take(40) {
            let exact = parabola(start + row as f64 * 0.007);
            assert!((value - exact).abs() < 1e-12, "row {row}: {value} {exact}");
        }
    }

    #[test]
    fn order_of_the_interpolation_is_three_at_least() {
        let error = |len: usize| {
            let time: Vec<f64> = uneven(len).iter().map(|t| t * 100.0 / len as f64).collect();
            let values: Vec<f64> = time.iter().map(|t| (9.0 * t).sin()).collect();
            let step = usual_step(&time) * 0.83;
            let rows = (0.98 * time[len - 1] / step) as usize;
            let found = on_grid(&time, &values, step, rows);
            found
                .iter()
                .enumerate()
                .skip(rows / 20)
                .map(|(k, y)| (y - (9.0 * (time[0] + k as f64 * step)).sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(100) / error(400)).log2() / 2.0;
        assert!(order > 2.7, "{order}");
    }

    #[test]
    fn verify_the_usual_step_ignores_gaps_and_rounding() {
        let rounded: Vec<f64> = (0..2000)
            .filter(|k| !(500..507).contains(k))
            .map(|k| (f64::from(k) * 1.6384).round() * 1e-3)
            .collect();
        // Of the steps only those of 1 and 2 ms count; their mean is the true step.
        let step = usual_step(&rounded);
        assert!((step / 1.6384e-3 - 1.0).abs() < 1e-3, "{step}");
    }
}
