//! Least squares for three unknowns.

/// Three unknowns by normal equations, each column scaled to one.
pub(super) fn least_squares(rows: &[[f64; 3]], right: &[f64]) -> Option<[f64; 3]> {
    let scale = [0, 1, 2].map(|j| rows.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt());
    let mut system = [[0.0; 4]; 3];
    for (row, value) in rows.iter().zip(right) {
        for i in 0..3 {
            for j in 0..3 {
                system[i][j] += row[i] * row[j] / (scale[i] * scale[j]);
            }
            system[i][3] += row[i] * value / scale[i];
        }
    }
    for at in 0..3 {
        let pivot = system[at][at];
        if pivot.is_nan() || pivot <= 1e-12 {
            return None;
        }
        for below in at + 1..3 {
            let factor = system[below][at] / pivot;
            for j in at..4 {
                system[below][j] -= factor * system[at][j];
            }
        }
    }
    let mut found = [0.0; 3];
    for at in (0..3).rev() {
        let known: f64 = (at + 1..3).map(|j| system[at][j] * found[j]).sum();
        found[at] = (system[at][3] - known) / system[at][at];
    }
    Some([0, 1, 2].map(|j| found[j] / scale[j]))
}
