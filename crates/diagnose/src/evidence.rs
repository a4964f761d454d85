//! How much the data speak for a set of effects.
//!
//! ```text
//! E = −J − ½ k ln N_eff − ½ Σ_j min(ln(1 + w² λ_j), ln N_eff) − p ln(σ_free / σ_0)     (1)
//! N_eff = Σ_c ρ_c N,   ρ_c = N_eff,c / N of the residual                    (2)
//! p_i = exp(E_i / T) / Σ_j exp(E_j / T)                                     (3)
//! ```
//!
//! J is the objective of the fit, k the number of parameters of the effects but for hidden masses, λ_j
//! the information on those of hidden masses in units of their values, w how far off they may be before, in
//! the same units, p the number of nominal parameters which left the prior σ_0 for one as wide as σ_free. (1)
//! is the Bayesian information criterion with the number of samples that are independent, \[Schwarz1978\].
//! Hidden masses are seen in a few directions only, and cost what the data narrow each of them down; the
//! temperature T in (3) allows for what (2) does not see.

use simgap_effects::{Family, Parameter, Placed};
use simgap_estimate::{Fit, Problem, Weights};
use simgap_signal::correlation::effective_sample_count;

/// T of (3), calibrated on generated cases.
const TEMPERATURE: f64 = 2.0;

/// ln(σ_free / σ_0) of (1): known to a third instead of a fiftieth.
const FREED: f64 = 2.8;

/// w of (1): the order of magnitude is known.
const KNOWN_BEFORE: f64 = 2.0;

/// Share of independent samples in the discrepancy of each channel, (2).
pub(crate) fn independence(fit: &Fit, channels: usize) -> Vec<f64> {
    (0..channels)
        .map(|c| {
            let (mut effective, mut total) = (0.0, 0.0);
            for run in &fit.discrepancy {
                let count = run[c].len() as f64;
                effective += effective_sample_count(&run[c]).unwrap_or(count).min(count);
                total += count;
            }
            (effective / f64::max(total, 1.0)).clamp(1e-4, 1.0)
        })
        .collect()
}

/// N_eff of (1).
pub(crate) fn effective_samples(problem: &Problem, weights: &Weights) -> f64 {
    let count: f64 = problem.runs.iter().map(|run| run.len as f64).sum();
    (count * weights.independence.iter().sum::<f64>()).max(2.0)
}

/// E of (1).
pub(crate) fn evidence(fit: &Fit, effective_samples: f64) -> f64 {
    let effects = fit.estimate.effects.iter();
    let freed = effects.filter(|placed| is_nominal(placed)).count() as f64;
    -fit.objective - penalty(fit, effective_samples) - freed * FREED
}

/// The second and the third term of (1).
fn penalty(fit: &Fit, effective_samples: f64) -> f64 {
    let most = effective_samples.ln();
    let seen = |known: &f64| (KNOWN_BEFORE.powi(2) * known.max(0.0)).ln_1p().min(most);
    let hidden = fit.information.iter().map(seen);
    let known = count(fit, |placed| !placed.action().adds_mass());
    0.5 * (known * most + hidden.sum::<f64>())
}

/// Parameters of the effects, whatever the data see of them. One that every record has of its own counts
/// once for each.
pub(crate) fn freedom(fit: &Fit) -> f64 {
    count(fit, |_| true)
}

/// Parameters of some of the effects, nominal parameters aside, and shapes that are chosen and not fitted.
fn count(fit: &Fit, of: impl Fn(&Placed) -> bool) -> f64 {
    let runs = fit.estimate.initial.len();
    let times = |parameter: &Parameter| if parameter.per_record { runs } else { 1 };
    let effects = fit.estimate.effects.iter();
    let effects = effects.filter(|placed| !is_nominal(placed) && of(placed));
    let fitted = effects.flat_map(|placed| {
        let parameters = placed.effect.parameters().iter().enumerate();
        let is_fitted = |&(i, parameter): &(usize, &Parameter)| {
            parameter.neutral.is_some() || !placed.effect.is_chosen(i)
        };
        parameters.filter(is_fitted)
    });
    fitted.map(|(_, parameter)| times(parameter)).sum::<usize>() as f64
}

pub(crate) fn is_nominal(placed: &Placed) -> bool {
    placed.effect.family() == Family::NominalParameter
}

/// p_i of (3).
pub(crate) fn probabilities(evidence: &[f64]) -> Vec<f64> {
    let best = evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let raw: Vec<f64> = evidence
        .iter()
        .map(|e| ((e - best) / TEMPERATURE).exp())
        .collect();
    let sum: f64 = raw.iter().sum();
    raw.iter().map(|p| p / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_probabilities() {
        let p = probabilities(&[-1000.0, -1000.0 + TEMPERATURE * 3.0_f64.ln()]);
        assert!((p[0] - 0.25).abs() < 1e-12 && (p[1] - 0.75).abs() < 1e-12);
    }
}
