//! Small linear algebra.

use crate::machine::Machine;
use crate::plant::Node;

/// What is left of a signal without its part in the span of a basis.
#[must_use]
pub fn remainder(basis: &[Vec<f64>], mut signal: Vec<f64>) -> Vec<f64> {
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for column in basis {
        let size = dot(column, column).sqrt();
        let mut column = column.clone();
        for _ in 0..2 {
            for unit in &kept {
                take_off(&mut column, unit);
            }
        }
        let left = dot(&column, &column).sqrt();
        if size > 0.0 && left > 1e-9 * size {
            column.iter_mut().for_each(|v| *v /= left);
            kept.push(column);
        }
    }
    for _ in 0..2 {
        for unit in &kept {
            take_off(&mut signal, unit);
        }
    }
    signal
}

fn take_off(signal: &mut [f64], unit: &[f64]) {
    let share = dot(signal, unit);
    for (s, u) in signal.iter_mut().zip(unit) {
        *s -= share * u;
    }
}

/// Sum of products.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Displacements at which the springs hold the constant forces; `None` where they cannot.
#[must_use]
pub fn rest(machine: &Machine) -> Option<Vec<f64>> {
    let n = machine.dof();
    let mut k = vec![vec![0.0; n + 1]; n];
    for &(a, b, stiffness) in &machine.springs {
        for (p, q) in [(a, b), (b, a)] {
            if let Node::Mass(i) = p {
                k[i][i] += stiffness;
                if let Node::Mass(j) = q {
                    k[i][j] -= stiffness;
                }
            }
        }
    }
    for &(mass, value) in &machine.pendulum {
        k[mass][mass] += value;
    }
    for &(mass, force) in &machine.constant {
        k[mass][n] += force;
    }
    solve(k)
}

/// Gauss with pivots on an augmented matrix.
fn solve(mut a: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = a.len();
    let largest = a.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    for i in 0..n {
        let pivot = (i..n).max_by(|&p, &q| a[p][i].abs().total_cmp(&a[q][i].abs()))?;
        if a[pivot][i].abs() <= 1e-9 * largest {
            return None;
        }
        a.swap(i, pivot);
        for r in i + 1..n {
            let f = a[r][i] / a[i][i];
            for c in i..=n {
                a[r][c] -= f * a[i][c];
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| a[i][j] * x[j]).sum();
        x[i] = (a[i][n] - known) / a[i][i];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_remainder_is_orthogonal_to_the_basis() {
        let basis = vec![vec![1.0, 1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0, 3.0]];
        let left = remainder(&basis, vec![1.0, 4.0, 9.0, 16.0]);
        // The line of least squares through the squares leaves 1, −1, −1, 1.
        for (l, w) in left.iter().zip([1.0, -1.0, -1.0, 1.0]) {
            assert!((l - w).abs() < 1e-12, "{left:?}");
        }
    }

    #[test]
    fn verify_springs_in_a_row_hold_a_force() {
        let machine = Machine {
            masses: vec![1.0, 1.0],
            springs: vec![
                (Node::Mass(0), Node::Ground, 100.0),
                (Node::Mass(1), Node::Mass(0), 50.0),
            ],
            constant: vec![(1, 10.0)],
            ..Machine::default()
        };
        let x = rest(&machine).unwrap();
        assert!((x[0] - 0.1).abs() < 1e-12 && (x[1] - 0.3).abs() < 1e-12);
        let free = Machine {
            springs: vec![(Node::Mass(1), Node::Mass(0), 50.0)],
            ..machine
        };
        assert!(rest(&free).is_none());
    }
}
