//! The distribution of a value over the machines of a fleet.
//!
//! Each machine has an estimate y_i ± s_i of its own value; the values themselves scatter with τ about μ:
//!
//! ```text
//! Q = Σ (y_i − μ_0)² / s_i²,   μ_0 the mean with weights 1/s_i²                             (1)
//! τ² = max(0, (Q − (n − 1)) / (Σ s_i⁻² − Σ s_i⁻⁴ / Σ s_i⁻²))                                (2)
//! μ = Σ w_i y_i / Σ w_i,   w_i = 1/(s_i² + τ²)                                              (3)
//! σ² = max(τ² + 1/Σ w_i, (median s_i)²)                                                      (4)
//! ```
//!
//! σ is how far the value of the next machine may be from μ. Scatter below the error of one machine cannot be seen, so that
//! σ is not below it.
//!
//! Reference: `dersimonian1986`.

use simgap_signal::median;

use crate::observe::Estimate;

/// Fewest machines that are called a fleet.
pub(crate) const LEAST_MACHINES: usize = 3;
/// Standard deviations from the middle of a large fleet beyond which a machine is outlying.
const OUTLYING: f64 = 4.0;
/// How much further of a small one: over n − 2. The median absolute deviation of few values is uncertain itself; with this a
/// fleet of normal values has an outlying machine in about one of 150 cases, from 4 machines to 50 (40 000 fleets each).
const OF_FEW: f64 = 32.0;
/// The median absolute deviation of a normal distribution times this is its standard deviation.
const MAD_TO_STD: f64 = 1.482_602;

/// A value over the fleet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Population {
    /// Machines.
    pub machines: usize,
    /// μ.
    pub mean: f64,
    /// Standard error of μ.
    pub mean_std: f64,
    /// τ: scatter between machines.
    pub between: f64,
    /// σ: scatter of the next machine.
    pub next: f64,
}

/// The mean of the diagnoses of one machine, with weights 1/s²; its standard error counts that they scatter by more than
/// their own say.
#[must_use]
pub fn mean(estimates: &[Estimate]) -> Option<Estimate> {
    let total: f64 = estimates.iter().map(|e| e.std.powi(-2)).sum();
    if estimates.is_empty() || !total.is_finite() {
        return None;
    }
    let value = estimates
        .iter()
        .map(|e| e.value * e.std.powi(-2))
        .sum::<f64>()
        / total;
    let misfit: f64 = estimates
        .iter()
        .map(|e| ((e.value - value) / e.std).powi(2))
        .sum();
    let scatter = (misfit / (estimates.len().max(2) - 1) as f64).max(1.0);
    Some(Estimate {
        value,
        std: (scatter / total).sqrt(),
    })
}

/// The distribution of a value over machines; `None` below three of them.
#[must_use]
pub fn population(machines: &[Estimate]) -> Option<Population> {
    if machines.len() < LEAST_MACHINES {
        return None;
    }
    let weights = || machines.iter().map(|e| e.std.powi(-2));
    let (sum, squares): (f64, f64) = (weights().sum(), weights().map(|w| w * w).sum());
    let plain = machines
        .iter()
        .map(|e| e.value * e.std.powi(-2))
        .sum::<f64>()
        / sum;
    let q: f64 = machines
        .iter()
        .map(|e| ((e.value - plain) / e.std).powi(2))
        .sum();
    let between = ((q - (machines.len() - 1) as f64) / (sum - squares / sum)).max(0.0);
    let weight = |e: &Estimate| 1.0 / (e.std.powi(2) + between);
    let total: f64 = machines.iter().map(weight).sum();
    Some(Population {
        machines: machines.len(),
        mean: machines.iter().map(|e| e.value * weight(e)).sum::<f64>() / total,
        mean_std: total.powf(-0.5),
        between: between.sqrt(),
        next: (between + 1.0 / total)
            .sqrt()
            .max(median_of(machines.iter().map(|e| e.std))),
    })
}

/// Places of values that lie apart. With D the median of |y − median|, which is robust against them,
///
/// ```text
/// |y_i − median| > (4 + 32/(n − 2)) sqrt((1.4826 D)² + s_i²)                               (5)
/// ```
///
/// None below four values.
#[must_use]
pub fn outlying(values: &[Estimate]) -> Vec<usize> {
    if values.len() <= LEAST_MACHINES {
        return vec![];
    }
    let middle = median_of(values.iter().map(|e| e.value));
    let deviation = median_of(values.iter().map(|e| (e.value - middle).abs()));
    let spread = MAD_TO_STD * deviation;
    let limit = OUTLYING + OF_FEW / (values.len() - 2) as f64;
    let is_apart = |e: &Estimate| (e.value - middle).abs() > limit * spread.hypot(e.std);
    let places = values.iter().enumerate().filter(|(_, e)| is_apart(e));
    places.map(|(place, _)| place).collect()
}

fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], std: f64) -> Vec<Estimate> {
        values
            .iter()
            .map(|&value| Estimate { value, std })
            .collect()
    }

    /// With equal standard errors (2) is the variance of the values less s².
    #[test]
    fn verify_the_scatter_between_machines() {
        let machines = of(&[1.0, 2.0, 3.0, 4.0, 5.0], 0.5);
        let found = population(&machines);
        let between = (2.5f64 - 0.25).sqrt();
        assert!(found.is_some_and(|p| (p.between - between).abs() < 1e-12));
        assert!(found.is_some_and(|p| (p.mean - 3.0).abs() < 1e-12));
        assert!(found.is_some_and(|p| (p.next - (2.25f64 + 2.5 / 5.0).sqrt()).abs() < 1e-12));
        // Machines that differ by no more than their errors are one.
        let alike = population(&of(&[1.0, 1.1, 0.9, 1.0], 0.5));
        assert!(alike.is_some_and(|p| p.between == 0.0 && p.next == 0.5));
        assert_eq!(population(&machines[..2]), None);
    }

    #[test]
    fn verify_who_lies_apart() {
        assert_eq!(outlying(&of(&[1.0, 1.1, 0.9, 1.05, 1.02, 3.0], 0.01)), [5]);
        // With such errors nobody does.
        assert_eq!(
            outlying(&of(&[1.0, 1.1, 0.9, 1.05, 1.02, 3.0], 1.0)),
            [0; 0]
        );
        assert_eq!(outlying(&of(&[1.0, 1.1, 9.0], 0.01)), [0; 0]);
    }

    /// Ten thousand fleets of eight normal values: one in 150, with three of its standard deviations (√(10⁴/150) = 8).
    #[test]
    fn verify_how_often_a_sound_machine_lies_apart() {
        let mut state = 1u64;
        let mut even = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
        };
        let mut normal = || (-2.0 * even().ln()).sqrt() * (std::f64::consts::TAU * even()).cos();
        let fleets = 10_000;
        let alarms = (0..fleets).filter(|_| {
            let values: Vec<f64> = (0..8).map(|_| normal()).collect();
            !outlying(&of(&values, 1e-3)).is_empty()
        });
        let alarms = alarms.count();
        assert!(alarms < fleets / 150 + 3 * 8, "{alarms} of {fleets}");
        assert!(alarms > 10, "{alarms} of {fleets}");
    }

    #[test]
    fn verify_the_mean_of_a_machine() {
        let found = mean(&of(&[1.0, 3.0], 1.0));
        // χ² of 2 with one degree of freedom doubles the variance of 1/2.
        assert!(
            found.is_some_and(|e| (e.value - 2.0).abs() < 1e-12 && (e.std - 1.0).abs() < 1e-12)
        );
        assert_eq!(mean(&[]), None);
    }
}
