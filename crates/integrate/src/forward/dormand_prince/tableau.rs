//! Coefficients of the pair of Dormand and Prince, RK5(4)7M (Dormand and Prince 1980, Table 2), and
//! of its continuous extension of order four (Hairer, Nørsett and Wanner 1993, II.6).
//!
//! Row sums, order conditions and the conditions of the extension are asserted below; a change of
//! any digit breaks one of them.

/// Number of stages; the last is the first of the next step.
pub(super) const STAGES: usize = 7;

/// Nodes c.
pub(super) const NODES: [f64; STAGES] =
    [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// FitOptions a of the stages; the last row is the solution of order five.
pub(super) const STAGE_WEIGHTS: [[f64; STAGES - 1]; STAGES] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// FitOptions of the solution of order five less those of order four.
pub(super) const ERROR_WEIGHTS: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// FitOptions of the last term of the continuous extension.
const EXTENSION_WEIGHTS: [f64; STAGES] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// FitOptions b(θ) of the stages at the fraction θ of a step:
///
/// ```text
/// y(t + θh) = y + h Σ b_i(θ) k_i
/// b(θ) = θ b + θ(1 − θ)(e₁ − b) + θ²(1 − θ)(2b − e₁ − e₇) + θ²(1 − θ)² d
/// ```
pub(super) fn extension(theta: f64) -> [f64; STAGES] {
    let rest = 1.0 - theta;
    std::array::from_fn(|i| {
        let b = if i < STAGES - 1 {
            STAGE_WEIGHTS[STAGES - 1][i]
        } else {
            0.0
        };
        let first = if i == 0 { 1.0 } else { 0.0 };
        let last = if i == STAGES - 1 { 1.0 } else { 0.0 };
        theta * (b + rest * (first - b))
            + theta * theta * rest * (2.0 * b - first - last + rest * EXTENSION_WEIGHTS[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of sums of terms up to 12 in size.
    const ROUNDING: f64 = 2e-14;

    type FitOptions = [f64; STAGES];

    fn solution() -> FitOptions {
        std::array::from_fn(|i| if i < 6 { STAGE_WEIGHTS[6][i] } else { 0.0 })
    }

    /// (A u)_i.
    fn stages(u: FitOptions) -> FitOptions {
        std::array::from_fn(|i| (0..6).map(|j| STAGE_WEIGHTS[i][j] * u[j]).sum())
    }

    fn times(u: FitOptions, v: FitOptions) -> FitOptions {
        std::array::from_fn(|i| u[i] * v[i])
    }

    /// The elementary weights of all rooted trees up to order five with 1/γ of each.
    fn trees() -> Vec<(usize, FitOptions, f64)> {
        let one = [1.0; STAGES];
        let c = NODES;
        let c2 = times(c, c);
        let c3 = times(c2, c);
        let (ac, ac2, ac3) = (stages(c), stages(c2), stages(c3));
        let aac = stages(ac);
        vec![
            (1, one, 1.0),
            (2, c, 1.0 / 2.0),
            (3, c2, 1.0 / 3.0),
            (3, ac, 1.0 / 6.0),
            (4, c3, 1.0 / 4.0),
            (4, times(c, ac), 1.0 / 8.0),
            (4, ac2, 1.0 / 12.0),
            (4, aac, 1.0 / 24.0),
            (5, times(c2, c2), 1.0 / 5.0),
            (5, times(c2, ac), 1.0 / 10.0),
            (5, times(ac, ac), 1.0 / 20.0),
            (5, times(c, ac2), 1.0 / 15.0),
            (5, times(c, aac), 1.0 / 30.0),
            (5, ac3, 1.0 / 20.0),
            (5, stages(times(c, ac)), 1.0 / 40.0),
            (5, stages(ac2), 1.0 / 60.0),
            (5, stages(aac), 1.0 / 120.0),
        ]
    }

    fn weigh(b: &FitOptions, tree: &FitOptions) -> f64 {
        b.iter().zip(tree).map(|(x, y)| x * y).sum()
    }

    #[test]
    fn verify_row_sums_are_the_nodes() {
        for i in 0..STAGES {
            let sum: f64 = STAGE_WEIGHTS[i].iter().sum();
            assert!((sum - NODES[i]).abs() < ROUNDING, "stage {i}");
            assert!(
                (i..6).all(|j| STAGE_WEIGHTS[i][j] == 0.0),
                "stage {i} is explicit"
            );
        }
    }

    #[test]
    fn verify_solution_meets_all_conditions_of_order_five() {
        for (number, (_, tree, weight)) in trees().iter().enumerate() {
            let found = weigh(&solution(), tree);
            assert!((found - weight).abs() < ROUNDING, "tree {number}: {found}");
        }
    }

    #[test]
    fn verify_embedded_solution_is_of_order_four_and_no_more() {
        let b = solution();
        let embedded: FitOptions = std::array::from_fn(|i| b[i] - ERROR_WEIGHTS[i]);
        let mut worst_of_order_five = 0.0_f64;
        for (order, tree, weight) in trees() {
            let error = (weigh(&embedded, &tree) - weight).abs();
            if order <= 4 {
                assert!(error < ROUNDING);
            } else {
                worst_of_order_five = worst_of_order_five.max(error);
            }
        }
        assert!(worst_of_order_five > 1e-4);
    }

    #[test]
    fn verify_extension_is_of_order_four_everywhere_and_smooth() {
        for tenth in 0..=10 {
            let theta = f64::from(tenth) / 10.0;
            let b = extension(theta);
            for (order, tree, weight) in trees() {
                if order <= 4 {
                    let needed = weight * theta.powi(order as i32);
                    assert!(
                        (weigh(&b, &tree) - needed).abs() < ROUNDING,
                        "theta {theta}"
                    );
                }
            }
        }
        // Values and slopes at both ends: y, y₁, k₁ and k₇.
        assert!(extension(0.0).iter().all(|w| *w == 0.0));
        let step = 1e-6;
        for i in 0..STAGES {
            assert!((extension(1.0)[i] - solution()[i]).abs() < ROUNDING);
            let left = (extension(step)[i] - extension(0.0)[i]) / step;
            let right = (extension(1.0)[i] - extension(1.0 - step)[i]) / step;
            // One-sided differences: second derivative, up to 30, times the step.
            assert!((left - f64::from(u8::from(i == 0))).abs() < 1e-4);
            assert!((right - f64::from(u8::from(i == 6))).abs() < 1e-4);
        }
    }
}
