//! Dynamics whose own mode no record shows, beside the nominal parameters that they turn into.
//!
//! A support that gives way is a softer spring below its own mode, an attached mass a heavier one. Where the
//! answer names parameters, the data may not contradict such dynamics either.

use rayon::prelude::*;
use simgap_effects::{Effect, Placed};
use simgap_estimate::{Base, EstimateError, Start, score_outright};
use simgap_model::{GROUND, Location};

use crate::difference::{identified, relevant, replacement};
use crate::evidence::{is_nominal, probabilities};
use crate::hypothesis::{Hypothesis, add_scored, name, rank, remove, sort};
use crate::search::Search;
use crate::verdict::{INDISTINGUISHABLE, Judged, Swap};

/// A nominal parameter on its own may be behind re-estimated ones by this evidence, and what turns into it is
/// still looked for.
const BEHIND: f64 = 4.0;
/// Hidden masses are fitted from this many of the values at which they act as the parameter does.
const STARTS: usize = 2;

impl Search<'_> {
    /// Hidden masses, fitted from where they act as a fitted nominal parameter of their place does.
    pub(crate) fn fit_out_of_sight(
        &self,
        base: &Hypothesis,
        singles: &[Hypothesis],
        linear: &Base<'_>,
    ) -> Result<Vec<Hypothesis>, EstimateError> {
        let limits = singles
            .iter()
            .filter(|single| single.evidence > base.evidence - BEHIND);
        let limits = limits.filter_map(|single| match single.effects() {
            [limit] if is_nominal(limit) => Some(limit),
            _ => None,
        });
        let pairs: Vec<_> = limits
            .flat_map(|limit| self.candidates.iter().map(move |known| (limit, known)))
            .filter(|(limit, (candidate, _))| {
                turns_into((candidate.effect, &candidate.at), limit).is_some()
            })
            .collect();
        let starts = pairs
            .into_par_iter()
            .map(|(limit, (candidate, scale))| {
                let kind = limit.effect.kind();
                let shapes = candidate.effect.grown_from(kind, &limit.values, scale);
                let best = score_outright(linear, candidate, &shapes).unwrap_or_default();
                let best = best.into_iter().take(STARTS);
                best.map(|score| add_scored(&base.fit.estimate, score))
                    .collect::<Vec<Start>>()
            })
            .collect::<Vec<_>>();
        self.fit_all(&starts.concat(), linear)
    }
}

/// The kind of an effect that dynamics at its place turn into where their own mode is out of sight.
pub(crate) fn turns_into(
    (dynamics, at): (&dyn Effect, &Location),
    limit: &Placed,
) -> Option<&'static str> {
    let kind = limit.effect.kind();
    let turns = *at == limit.at && dynamics.turns_into().contains(&kind);
    turns.then_some(kind)
}

/// A start in which every nominal parameter that it does not name is adjusted under its prior.
pub(crate) fn adjusted(start: &Start, nominal: &[Placed]) -> Start {
    let named: Vec<String> = start.effects.iter().map(name).collect();
    let others = nominal.iter().filter(|p| !named.contains(&name(p)));
    Start {
        nominal: others.cloned().collect(),
        ..start.clone()
    }
}

/// Adds to named nominal parameters the dynamics that turn into them, or into parameters that fit as well in
/// their place. `set` is the named set as it was judged, with all other parameters held; `settled` the same
/// with the others, `nominal`, under their prior, as the dynamics leave them. The best set with such dynamics is
/// returned where it is better than the named one.
pub(crate) fn add_rivals_out_of_sight(
    search: &Search<'_>,
    [set, settled]: [&Hypothesis; 2],
    nominal: &[Placed],
    judged: &mut [Judged],
) -> Result<Option<Hypothesis>, EstimateError> {
    let named = judged.iter().enumerate();
    let found = named
        .map(|(i, judged)| out_of_sight_of(search, settled, (i, judged), nominal))
        .collect::<Result<Vec<_>, _>>()?;
    let mut better: Option<Hypothesis> = None;
    for (i, judged) in judged.iter_mut().enumerate() {
        let limits = &found[i].1;
        // What takes the place of several named parameters is a rival of each.
        let lacks = |rival: &&Hypothesis| !rival.key().contains(&name(&judged.placed));
        let all = found.iter().flat_map(|(rivals, _)| rivals);
        let mut rivals: Vec<Hypothesis> = all.filter(lacks).cloned().collect();
        rank(&mut rivals);
        rivals.retain(|rival| identified(rival, settled));
        for rival in &mut rivals {
            if !relevant(search, &rival.fit, &settled.fit) {
                // It moves nothing that counts: as likely as the parameter at the most.
                rival.evidence = rival.evidence.min(settled.evidence);
            }
        }
        sort(&mut rivals);
        let mut evidence = vec![settled.evidence];
        evidence.extend(rivals.iter().map(|rival| rival.evidence));
        let shares = probabilities(&evidence);
        for (rival, share) in rivals.iter().zip(&shares[1..]) {
            let Some(placed) = replacement(settled, rival) else {
                continue;
            };
            judged.swap_probabilities.push(judged.probability * share);
            judged.swaps.push(Swap {
                placed: placed.clone(),
                evidence: set.evidence + rival.evidence - settled.evidence,
                misfit: rival.fit.objective - settled.fit.objective,
                turns_into: limits
                    .iter()
                    .find_map(|limit| turns_into((placed.effect, &placed.at), limit)),
                estimate: rival.fit.estimate.clone(),
            });
        }
        judged.probability *= shares[0];
        let best = better.as_ref().unwrap_or(settled).evidence;
        better = rivals
            .into_iter()
            .find(|rival| rival.evidence > best)
            .or(better);
    }
    Ok(better)
}

/// The sets with dynamics in the place of the i-th effect, or of a parameter that fits as well there, and these
/// parameters.
fn out_of_sight_of(
    search: &Search<'_>,
    settled: &Hypothesis,
    (i, judged): (usize, &Judged),
    nominal: &[Placed],
) -> Result<(Vec<Hypothesis>, Vec<Placed>), EstimateError> {
    let mut limits = vec![judged.placed.clone()];
    let mut rivals = search.grow(settled, i)?;
    let equals = judged.swaps.iter();
    let equals = equals.filter(|swap| is_nominal(&swap.placed) && swap.misfit < INDISTINGUISHABLE);
    for swap in equals {
        let instead = search.fit(&adjusted(&swap.estimate, nominal))?;
        let mut effects = instead.effects().iter();
        if let Some(place) = effects.position(|placed| name(placed) == name(&swap.placed)) {
            rivals.extend(search.grow(&instead, place)?);
            limits.push(swap.placed.clone());
        }
    }
    Ok((rivals, limits))
}

/// A start without the other parameters that an effect of it turns into: it takes the place of all.
pub(crate) fn without_limits(mut start: Start, dynamics: &Placed) -> Start {
    let is_limit = |placed: &Placed| turns_into((dynamics.effect, &dynamics.at), placed).is_some();
    while let Some(i) = start.effects.iter().position(is_limit) {
        start = remove(&start, i);
    }
    start
}

/// The spring, of a mass and its spring to the ground.
pub(crate) fn spring_to_ground<'a>(one: &'a Location, other: &'a Location) -> Option<&'a Location> {
    match (one, other) {
        (Location::Mass(mass), spring @ Location::Between(pair))
        | (spring @ Location::Between(pair), Location::Mass(mass)) => {
            let joins = pair.contains(mass) && pair.iter().any(|node| node == GROUND);
            joins.then_some(spring)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_mass_and_its_spring_to_the_ground_the_spring_has_the_sizes() {
        let mass = |name: &str| Location::Mass(name.into());
        let spring = |a: &str, b: &str| Location::Between([a.into(), b.into()]);
        let leg = spring("table", GROUND);
        assert_eq!(spring_to_ground(&mass("table"), &leg), Some(&leg));
        assert_eq!(spring_to_ground(&leg, &mass("table")), Some(&leg));
        assert_eq!(spring_to_ground(&mass("arm"), &leg), None);
        let between = spring("table", "arm");
        assert_eq!(spring_to_ground(&mass("table"), &between), None);
        assert_eq!(spring_to_ground(&leg, &leg), None);
    }
}
