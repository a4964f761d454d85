//! Plants that noise of the inputs leads away.
//!
//! A slide without a spring integrates the noise of its drive: over a record the true model parts from the machine by many
//! times what the sensor adds, and a spring that does not exist or a mass that is wrong keeps it nearer. There the residuals
//! that effects are judged by are [whitened](simgap_estimate::Whitening): what counts is what every sample adds to those before
//! it. The filters come from what is known of the noise alone, that seen on the inputs, simulated, and that of the
//! sensors; not from the discrepancy, which holds the effect. Where a converter's steps are coarse, what it rounds away is no noise
//! that a filter could know.

use simgap_estimate::{EstimateError, Fit, Problem, Weights, Whitening};

use crate::gap::noise_variance;
use crate::input_noise::draws;

/// A channel wanders that the noise of the inputs moves by more than this multiple of what its sensor adds, rms, and by more
/// than this share of its motion.
const WANDERS: f64 = 2.0;
const MUCH: f64 = 0.01;
/// Samples that a filter looks back.
const ORDER: usize = 32;

/// The filters of a problem in which some channel wanders, from what the noise of its inputs does and what the fit of the model
/// as given leaves of white noise; `None` where none does, and where a channel is stored in coarse steps. `others` are runs that say more of the noise.
pub(crate) fn whitening(
    problem: &Problem,
    fit: &Fit,
    weights: &Weights,
    others: &[simgap_simulate::Run],
) -> Result<Option<Whitening>, EstimateError> {
    let drawn = draws(problem, &[], weights, others)?;
    let channels = 0..problem.model.outputs.len();
    if channels.clone().any(|c| problem.lattice_of(c).is_some()) {
        return Ok(None);
    }
    let sensors = noise_variance(&fit.discrepancy, &vec![false; channels.len()]);
    let coloured: Vec<Vec<&[f64]>> = channels
        .map(|c| {
            let draws = drawn.iter().flat_map(|run| &run.left);
            draws.map(|draw| draw[c].as_slice()).collect()
        })
        .collect();
    let finite = coloured
        .iter()
        .flatten()
        .all(|signal| signal.iter().all(|r| r.is_finite()));
    let wanders = coloured.iter().zip(&sensors).zip(problem.motion_std());
    let mut wanders = wanders.map(|((signals, sensor), std)| {
        let count: usize = signals.iter().map(|signal| signal.len()).sum();
        let square: f64 = signals
            .iter()
            .flat_map(|signal| signal.iter())
            .map(|r| r * r)
            .sum();
        let rms = (square / count.max(1) as f64).sqrt();
        rms > WANDERS * sensor.sqrt() && rms > MUCH * std
    });
    let is_led_away = finite && wanders.any(|wanders| wanders);
    Ok(is_led_away.then(|| Whitening::of_noise(&coloured, &sensors, ORDER)))
}
