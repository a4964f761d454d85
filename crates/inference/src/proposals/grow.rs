//! One effect of a set in the place of which a related one stands: a law that contains it, a special case of it, dynamics
//! that act as it does below their own mode.

use rayon::prelude::*;
use simgap_effects::{Effect, Placed};
use simgap_estimate::{
    Base, Candidate, EstimateError, Start, linearise_at, score_in_place_of, score_outright,
};
use simgap_model::{GROUND, InputKind, Location, Model};

use crate::candidate_model::{
    CandidateModel, NominalPrior, add_scored, is_nominal, name, remove, replace,
};
use crate::proposals::add::FINISHED;
use crate::search::Search;

/// Hidden masses are fitted from this many of the values at which they act as the parameter does.
const STARTS: usize = 2;
/// Single nominal parameters whose dynamics are tried.
const LIMITS: usize = 4;

impl Search<'_> {
    /// The sets in which one effect has grown into one that contains it, turns into it or resembles it.
    pub(crate) fn grow(
        &self,
        base: &CandidateModel,
        index: usize,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let grown = self.grown(base, index);
        if grown.iter().all(|(_, shapes)| shapes.is_empty()) {
            return Ok(vec![]);
        }
        let linear = linearise_at(self.problem, &base.fit, &self.options)?;
        // What would not all be fitted the whole way is fitted from the best values, by score; so is what begins anywhere in each record,
        // for that is what the score tells.
        let [few, more] = FINISHED;
        let mut starts = vec![];
        for (candidate, shapes) in grown {
            let begins_anywhere = |values: &Vec<f64>| candidate.effect.own_starts(values).len() > 1;
            let placed: Vec<Placed> =
                if shapes.len() > few + more || shapes.iter().any(begins_anywhere) {
                    let best = score_in_place_of(&linear, index, candidate, &shapes)?;
                    best.into_iter()
                        .take(few)
                        .map(|score| score.start)
                        .collect()
                } else {
                    let of = |values| Placed::new(candidate.effect, candidate.at.clone(), values);
                    shapes.into_iter().map(of).collect()
                };
            starts.extend(placed.into_iter().map(|grown| {
                let start = replace(&base.fit.estimate, index, grown.clone(), self.nominal);
                without_limits(start, &grown, self.nominal)
            }));
        }
        Ok(self.fit_all(&starts, &linear))
    }

    /// The sets in which one effect has shrunk to a special case it contains, or to what it turns into.
    pub(crate) fn shrink(&self, base: &CandidateModel, index: usize) -> Vec<CandidateModel> {
        let old = &base.effects()[index];
        let at_place = self.space.candidates.iter();
        let at_place = at_place.filter(|(candidate, _)| candidate.at == old.at);
        let starts: Vec<Start> = at_place
            .filter_map(|(candidate, scale)| {
                let kind = candidate.effect.kind();
                let is_special = old.effect.contains().contains(&kind);
                if !is_special && !old.effect.turns_into().contains(&kind) {
                    return None;
                }
                let values = old.effect.shrunk_to(kind, &old.values, scale);
                let values = values.or_else(|| {
                    // The first values of a larger effect are those of its special case.
                    let starts = is_special.then(|| candidate.effect.starts(scale))?;
                    let mut values = starts.into_iter().next()?;
                    values
                        .iter_mut()
                        .zip(&old.values)
                        .for_each(|(value, old)| *value = *old);
                    Some(values)
                })?;
                let mut small = Placed::new(candidate.effect, old.at.clone(), values);
                let mut estimated = base.fit.estimate.nominal.iter();
                if let Some(beside) = estimated.find(|p| name(p) == name(&small)) {
                    small.values[0] += beside.values[0] - 1.0;
                }
                small.effect.make_physical(&mut small.values);
                Some(replace(&base.fit.estimate, index, small, self.nominal))
            })
            .collect();
        let fitted = starts.par_iter().filter_map(|start| self.fit(start).ok());
        fitted.collect()
    }

    /// Hidden masses, fitted from where they act as a fitted nominal parameter of their place does.
    pub(crate) fn fit_dynamics_of_parameters(
        &self,
        base: &CandidateModel,
        singles: &[CandidateModel],
        linear: &Base<'_>,
    ) -> Vec<CandidateModel> {
        let limits = singles.iter().filter_map(|single| match single.effects() {
            [limit] if is_nominal(limit) => Some(limit),
            _ => None,
        });
        let pairs: Vec<_> = limits
            .take(LIMITS)
            .flat_map(|limit| {
                self.space
                    .candidates
                    .iter()
                    .map(move |known| (limit, known))
            })
            .filter(|(limit, (candidate, _))| turns_into((candidate.effect, &candidate.at), limit))
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

    /// What an effect of a set grows into, from which values.
    fn grown(&self, base: &CandidateModel, index: usize) -> Vec<(&Candidate, Vec<Vec<f64>>)> {
        let old = &base.effects()[index];
        let kind = old.effect.kind();
        let larger = self
            .space
            .candidates
            .iter()
            .filter_map(|(candidate, scale)| {
                let effect = candidate.effect;
                if base.holds(candidate) {
                    return None;
                }
                let mut smaller = effect.contains().iter().chain(effect.turns_into());
                let is_alike = effect.resembles().contains(&kind);
                if candidate.at == old.at {
                    let grows = is_alike || smaller.any(|known| *known == kind);
                    return grows.then_some((candidate, *scale));
                }
                if drives_member(&self.problem.model, &candidate.at, &old.at) {
                    return is_alike.then_some((candidate, *scale));
                }
                // Of a mass and its spring to the ground, the spring has the sizes.
                let spring = spring_to_ground(&candidate.at, &old.at)?;
                Some((candidate, self.space.scale_at(spring)?)).filter(|_| is_alike)
            });
        larger
            .map(|(candidate, scale)| {
                let shapes = candidate.effect.grown_from(kind, &old.values, &scale);
                (candidate, shapes)
            })
            .collect()
    }
}

/// Whether dynamics at a place turn into an effect of it where their own mode is above all motion.
pub(crate) fn turns_into((dynamics, at): (&dyn Effect, &Location), limit: &Placed) -> bool {
    *at == limit.at && dynamics.turns_into().contains(&limit.effect.kind())
}

/// A start without the other parameters that an effect of it turns into: it takes the place of all.
fn without_limits(mut start: Start, dynamics: &Placed, nominal: NominalPrior) -> Start {
    let is_limit = |placed: &Placed| turns_into((dynamics.effect, &dynamics.at), placed);
    while let Some(i) = start.effects.iter().position(is_limit) {
        start = remove(&start, i, nominal);
    }
    start
}

/// The spring, of a mass and its spring to the ground.
fn spring_to_ground<'a>(one: &'a Location, other: &'a Location) -> Option<&'a Location> {
    match (one, other) {
        (Location::Mass(mass), spring @ Location::Between(pair))
        | (spring @ Location::Between(pair), Location::Mass(mass)) => {
            let joins = pair.contains(mass) && pair.iter().any(|node| node == GROUND);
            joins.then_some(spring)
        }
        _ => None,
    }
}

/// Whether one place is an input that is a force, and the other a member between the mass that it drives and the ground.
fn drives_member(model: &Model, one: &Location, other: &Location) -> bool {
    let ((Location::Input(channel), Location::Between(pair))
    | (Location::Between(pair), Location::Input(channel))) = (one, other)
    else {
        return false;
    };
    let mut inputs = model.inputs.iter();
    inputs.any(|input| {
        let is_force = input.channel == *channel && input.kind == InputKind::Force;
        is_force && pair.contains(&input.at) && pair.iter().any(|node| node == GROUND)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_drives_the_members_of_its_mass_to_the_ground() {
        let text = "schema = \"simgap-model/1\"\nname = \"cart\"\n\
            [[mass]]\nname = \"cart\"\nvalue = 2.0\n[[mass]]\nname = \"load\"\nvalue = 1.0\n\
            [[damper]]\nname = \"c\"\nbetween = [\"cart\", \"ground\"]\ndamping = 3.0\n\
            [[spring]]\nname = \"k\"\nbetween = [\"cart\", \"load\"]\nstiffness = 50.0\n\
            [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"cart\"\n\
            [[output]]\nchannel = \"v\"\nkind = \"velocity\"\nat = \"load\"\n";
        let model = Model::from_toml(text).unwrap();
        let drive = Location::Input("u".into());
        let between = |a: &str, b: &str| Location::Between([a.into(), b.into()]);
        let drives = |at: &Location| drives_member(&model, &drive, at);
        assert!(drives(&between("ground", "cart")));
        assert!(drives_member(&model, &between("cart", GROUND), &drive));
        assert!(!drives(&between("cart", "load")) && !drives(&between("load", GROUND)));
        assert!(!drives(&Location::Mass("cart".into())));
    }

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
