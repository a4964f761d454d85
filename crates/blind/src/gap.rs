//! How large a gap is that an unknown initial state cannot explain.

/// Mean.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Standard deviation.
pub(crate) fn std(values: &[f64]) -> f64 {
    let mean = mean(values);
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (square / values.len().max(1) as f64).sqrt()
}

/// For each channel, the rms of what is left of `with − without` over std(`with`), the measured
/// signal, after the part that another initial state would explain is taken out:
///
/// ```text
/// g = (y_with − y_without) / std(y_with),     all channels in one vector     (1)
/// r = g − Q Qᵀ g,   Q an orthonormal basis of the free responses             (2)
/// gap_c = rms(r_c)                                                           (3)
/// ```
pub(crate) fn visible_gap(
    with: &[Vec<f64>],
    without: &[Vec<f64>],
    free_responses: &[Vec<Vec<f64>>],
) -> Vec<f64> {
    let scale: Vec<f64> = with.iter().map(|y| 1.0 / std(y)).collect();
    let stacked = |signals: &[Vec<f64>]| -> Vec<f64> {
        signals
            .iter()
            .zip(&scale)
            .flat_map(|(signal, s)| signal.iter().map(move |v| v * s))
            .collect()
    };
    let mut rest: Vec<f64> = stacked(with)
        .iter()
        .zip(stacked(without))
        .map(|(a, b)| a - b)
        .collect(); // (1)
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for response in free_responses {
        let mut column = stacked(response);
        let before = norm(&column);
        // Twice, for rounding.
        for _ in 0..2 {
            for known in &basis {
                take_out(&mut column, known);
            }
        }
        let left = norm(&column);
        if left > INDEPENDENT * before && left.is_finite() {
            column.iter_mut().for_each(|v| *v /= left);
            basis.push(column);
        }
    }
    for column in &basis {
        take_out(&mut rest, column); // (2)
    }
    let mut from = 0;
    without
        .iter()
        .map(|signal| {
            let part = &rest[from..from + signal.len()];
            from += signal.len();
            norm(part) / (signal.len().max(1) as f64).sqrt() // (3)
        })
        .collect()
}

/// A free response that the others explain up to this share of its size adds nothing.
const INDEPENDENT: f64 = 1e-6;

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn take_out(from: &mut [f64], unit: &[f64]) {
    let part: f64 = from.iter().zip(unit).map(|(a, b)| a * b).sum();
    from.iter_mut().zip(unit).for_each(|(a, b)| *a -= part * b);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_gap_without_free_responses() {
        let without = vec![vec![1.0, -1.0, 1.0, -1.0]];
        let with = vec![vec![1.5, -0.5, 1.5, -0.5]];
        assert!((visible_gap(&with, &without, &[])[0] - 0.5).abs() < 1e-15);
    }

    #[test]
    fn verify_initial_state_explains_a_constant_on_a_free_mass() {
        let without = vec![vec![1.0, -1.0, 1.0, -1.0]];
        let with = vec![vec![1.5, -0.5, 1.5, -0.5]];
        let free = vec![vec![vec![3.0; 4]], vec![vec![0.0, 1.0, 2.0, 3.0]]];
        assert!(visible_gap(&with, &without, &free)[0] < 1e-15);
    }
}
