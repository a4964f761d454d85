//! What effects move the outputs by, with everything else as it is.

use simgap_estimate::Fit;

/// Practical relevance: an effect, but for a wrong nominal parameter beyond what the model states, is not worth a name that moves every
/// output by less than this share of its motion, rms.
const OF_MOTION: f64 = 0.003;

/// What two fits of the same records differ by in each output, rms.
pub(crate) fn between(with: &Fit, without: &Fit) -> Vec<f64> {
    let runs = || with.discrepancy.iter().zip(&without.discrepancy);
    let channels = 0..with.variance.len();
    let of_channel = channels.map(|c| {
        let (mut square, mut count) = (0.0, 0.0);
        for (with, without) in runs() {
            let pairs = with[c].iter().zip(&without[c]);
            square += pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            count += with[c].len() as f64;
        }
        (square / f64::max(count, 1.0)).sqrt()
    });
    of_channel.collect()
}

/// Which outputs are moved by enough of their motion for a name.
pub(crate) fn is_enough<'a>(
    moved: &'a [f64],
    motion: &'a [f64],
) -> impl Iterator<Item = bool> + 'a {
    let outputs = moved.iter().zip(motion);
    outputs.map(|(by, motion)| is_a_cause(by / motion))
}

/// Whether what is left of an output above all noise, share of its motion, may have a cause that is worth a name.
#[must_use]
pub fn is_a_cause(share: f64) -> bool {
    share > OF_MOTION
}

/// Odds that what moves the outputs by such a share of their motion, rms, is one of the small things that every lumped model misses,
/// against a law of the catalogue: even at what an effect has to move for a name.
pub(crate) fn odds_of_small_cause(share: f64) -> f64 {
    (OF_MOTION / share).powi(2)
}
