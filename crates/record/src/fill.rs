//! Values in place of those that are missing.
//!
//! A missing sample gets the value of the cubic through the two samples on either side of the gap, which
//! is off a sine of frequency f by a share of (2π f Δt)⁴; a longer gap, in which noise would bend the
//! cubic, a straight line. At an end of the record the nearest sample is held.

/// Longest gap that a cubic bridges, samples.
const LONGEST_CUBIC: usize = 3;

/// Fills what is NaN, where there is any number at all; most missing in a row.
pub(crate) fn fill(values: &mut [f64]) -> usize {
    let (mut longest, mut start) = (0, 0);
    while start < values.len() {
        if !values[start].is_nan() {
            start += 1;
            continue;
        }
        let rest = &values[start..];
        let gap = rest.iter().position(|v| !v.is_nan()).unwrap_or(rest.len());
        let end = start + gap;
        longest = longest.max(gap);
        for row in start..end {
            values[row] = bridged(values, start..end, row);
        }
        start = end;
    }
    longest
}

/// The value at a row of a gap.
fn bridged(values: &[f64], gap: std::ops::Range<usize>, row: usize) -> f64 {
    let number = |row: Option<usize>| {
        let row = row?;
        let value = values.get(row).copied().filter(|value| !value.is_nan())?;
        Some((row as f64 - gap.start as f64, value))
    };
    let before = [2, 1].map(|back| number(gap.start.checked_sub(back)));
    let after = [0, 1].map(|on| number(Some(gap.end + on)));
    let x = (row - gap.start) as f64;
    match (before, after) {
        ([Some(a), Some(b)], [Some(c), Some(d)]) if gap.len() <= LONGEST_CUBIC => {
            lagrange(&[a, b, c, d], x)
        }
        ([_, Some(b)], [Some(c), _]) => lagrange(&[b, c], x),
        ([_, Some((_, b))], _) => b,
        (_, [Some((_, c)), _]) => c,
        _ => f64::NAN,
    }
}

/// Σᵢ yᵢ Πⱼ≠ᵢ (x − xⱼ) / (xᵢ − xⱼ)
fn lagrange(points: &[(f64, f64)], x: f64) -> f64 {
    let weight = |i: usize| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others
            .map(|(_, (xj, _))| (x - xj) / (points[i].0 - xj))
            .product::<f64>()
    };
    (0..points.len()).map(|i| points[i].1 * weight(i)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOST: f64 = f64::NAN;

    #[test]
    fn verify_short_gaps_keep_a_cubic_and_long_ones_a_line() {
        let cubic = |k: usize| {
            let x = k as f64;
            1.0 - x + 0.3 * x * x - 0.02 * x * x * x
        };
        let mut values: Vec<f64> = (0..30).map(cubic).collect();
        for k in [4, 9, 10, 15, 16, 17] {
            values[k] = LOST;
        }
        assert_eq!(fill(&mut values), 3);
        for (k, value) in values.iter().enumerate() {
            assert!((value - cubic(k)).abs() < 1e-10, "{k}: {value}");
        }
        let mut line = vec![0.0, 7.0, LOST, LOST, LOST, LOST, 2.0, 0.0];
        assert_eq!(fill(&mut line), 4);
        let needed = [0.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 0.0];
        for (value, needed) in line.iter().zip(needed) {
            assert!((value - needed).abs() < 1e-12, "{line:?}");
        }
    }

    #[test]
    fn verify_ends_are_held() {
        let mut values = vec![LOST, LOST, 3.0, 4.0, LOST];
        assert_eq!(fill(&mut values), 2);
        assert_eq!(values, [3.0, 3.0, 3.0, 4.0, 4.0]);
        // One number on a side makes a straight line, none a constant.
        let mut values = vec![2.0, LOST, 4.0, 5.0, 7.0];
        fill(&mut values);
        assert_eq!(values[1], 3.0);
        let mut nothing = vec![LOST; 4];
        assert_eq!(fill(&mut nothing), 4);
        assert!(nothing.iter().all(|v| v.is_nan()));
    }
}
