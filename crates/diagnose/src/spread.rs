//! How far predictions of the check records may be off because the parameters are known no better.
//!
//! A lightly damped machine that was trained beside a resonance and is checked at it is predicted worse by a true set than noise lets
//! expect, and as much worse as [`simgap_estimate::spread`] says.

use simgap_effects::Placed;
use simgap_estimate::{Fit, FitOptions, Problem, Start, spread};
use simgap_inference::name;

use crate::gap::{Prediction, total};

/// Largest spread of a channel by which a set is judged, over its standard deviation: a set whose parameters say nothing is
/// no explanation.
const MOST: f64 = 0.02;

/// The spread over the motion of the check records, of all channels together; none where the model cannot be simulated beside the
/// fit.
pub(crate) fn spread_of_check(
    check: &Problem,
    (train, estimate, weights): (&Problem, &Fit, &FitOptions),
    corrected: &Prediction,
) -> f64 {
    // What a record has of its own is that of the check records.
    let of_check = |placed: &Placed| {
        let mut own = corrected.own.iter();
        let own = own.find(|own| name(own) == name(placed));
        own.unwrap_or(placed).clone()
    };
    let begun = Start {
        effects: estimate.estimate.effects.iter().map(of_check).collect(),
        nominal: estimate.estimate.nominal.clone(),
        initial: corrected.initial.clone(),
    };
    let squares = spread((train, estimate, weights), check, &begun).unwrap_or_default();
    let channels = squares.iter().zip(check.output_std());
    let shares = channels.map(|(square, std)| {
        let share = square.sqrt() / std;
        if share < MOST { share } else { MOST }
    });
    total(&shares.collect::<Vec<f64>>())
}
