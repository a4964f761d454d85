//! What each effect of a set explains of the motion, and what is no cause but an adjustment.

use simgap_effects::Placed;
use simgap_estimate::EstimateError;

use crate::asked::Asked;
use crate::candidate_model::{BENT, CandidateModel, is_nominal, name, remove};
use crate::search::Search;
use crate::shapley::shapley_values;

/// What each effect of a set explains, as a share of the motion, mean square: the Shapley value of each law and of all wrong nominal
/// parameters together; of each of these a part in proportion to what the others leave where it is kept as given.
pub(crate) fn explained(
    search: &Search<'_>,
    asked: &Asked,
    set: &CandidateModel,
) -> Result<Vec<f64>, EstimateError> {
    let all: Vec<usize> = (0..set.effects().len()).collect();
    let (parameters, laws): (Vec<usize>, Vec<usize>) =
        all.iter().partition(|i| is_nominal(&set.effects()[**i]));
    let among = Among { search, asked, set };
    let together = usize::from(!parameters.is_empty());
    let mut values = shapley_values(laws.len() + together, |players| {
        let mut part: Vec<usize> = laws.clone();
        part.retain(|law| players.iter().any(|k| laws.get(*k) == Some(law)));
        if players.contains(&laws.len()) {
            part.extend(&parameters);
        }
        among.left(&part).map(|left| -left)
    })?;
    let of_parameters = values.split_off(laws.len()).into_iter().sum::<f64>();
    let mut explained = vec![0.0; all.len()];
    for (law, value) in laws.iter().zip(values) {
        explained[*law] = value;
    }
    let least = among.left(&all)?;
    let without = parameters.iter().map(|parameter| {
        let mut others = all.clone();
        others.retain(|other| other != parameter);
        Ok((among.left(&others)? - least).max(0.0))
    });
    let without = without.collect::<Result<Vec<f64>, EstimateError>>()?;
    let sum: f64 = without.iter().sum();
    for (parameter, lost) in parameters.into_iter().zip(without) {
        explained[parameter] = of_parameters * lost / sum.max(f64::MIN_POSITIVE);
    }
    Ok(explained)
}

/// The parts of a set.
struct Among<'a> {
    search: &'a Search<'a>,
    asked: &'a Asked,
    set: &'a CandidateModel,
}

impl Among<'_> {
    /// Share of the motion that some effects of the set leave, mean square, at the most all of it in each channel. The wrong nominal
    /// parameters that are not among them are as given.
    fn left(&self, part: &[usize]) -> Result<f64, EstimateError> {
        let effects = self.set.effects();
        let given = |i: &usize| is_nominal(&effects[*i]) && !part.contains(i);
        let given: Vec<String> = (0..effects.len())
            .filter(given)
            .map(|i| name(&effects[i]))
            .collect();
        let variance = match given.is_empty() {
            true => {
                let known = self.asked.part(self.search, self.set, part)?;
                known.fit.variance.clone()
            }
            false => {
                let mut start = self.set.fit.estimate.clone();
                for i in (0..effects.len()).rev().filter(|i| !part.contains(i)) {
                    start = remove(&start, i, self.search.nominal);
                }
                start
                    .nominal
                    .retain(|placed| !given.contains(&name(placed)));
                self.search.fit(&start)?.fit.variance
            }
        };
        let motion = self.search.problem.output_std();
        let channels = variance.iter().zip(&motion);
        let shares = channels.map(|(left, motion)| (left / (motion * motion)).min(1.0));
        Ok(shares.sum())
    }
}

/// Whether an effect is a nominal parameter that is off by no more than is to be expected of what the model states.
pub(crate) fn is_adjustment(search: &Search<'_>, placed: &Placed) -> bool {
    let off = |value: &f64| (value - 1.0) / search.problem.stated_std(placed);
    is_nominal(placed)
        && placed
            .values
            .iter()
            .map(|value| off(value).powi(2))
            .sum::<f64>()
            <= 2.0 * BENT
}
