//! The same motion from other forces and masses.
//!
//! A motion does not change where every mass and every force on the plant is multiplied by one number, stiffnesses, dampings
//! and the gain of a force input among them. A drive that counts for less is found as well as masses and springs that
//! count for more: one wrong value in the place of several. From a set with several wrong nominal values the set is proposed in
//! which their median is right, with everything else in proportion; parameters that are then near what the model states are removed.

use simgap_effects::Placed;
use simgap_estimate::Start;
use simgap_model::{InputKind, Location, Model, NominalQuantity};

use crate::candidate_model::{CandidateModel, add};
use crate::search::Search;

impl Search<'_> {
    /// A set with at least two wrong forces or masses, rescaled.
    pub(crate) fn rescale(&self, set: &CandidateModel) -> Vec<CandidateModel> {
        let model = &self.problem.model;
        let in_proportion = set.effects().iter().filter(|p| is_in_proportion(p, model));
        let mut factors: Vec<f64> = in_proportion.map(|placed| placed.values[0]).collect();
        factors.sort_by(f64::total_cmp);
        let median = factors.get(factors.len() / 2).copied();
        let Some(factor) = median.filter(|factor| *factor > 0.0 && factors.len() > 1) else {
            return vec![];
        };
        let Ok(rescaled) = self.fit(&rescaled(&set.fit.estimate, factor, model)) else {
            return vec![];
        };
        let mut sets = self.with_parameters_named(vec![rescaled.clone()]);
        sets.push(rescaled);
        sets.retain(|set| self.is_allowed(set));
        sets
    }
}

/// A start with every mass and every force divided by a factor.
fn rescaled(start: &Start, factor: f64, model: &Model) -> Start {
    let mut next = start.clone();
    for placed in &mut next.effects {
        let parameters = placed.effect.parameters().iter();
        let is_factor = is_in_proportion(placed, model);
        for (value, parameter) in placed.values.iter_mut().zip(parameters) {
            if is_factor || is_force_or_mass(parameter.unit) {
                *value /= factor;
            }
        }
    }
    for placed in &start.nominal {
        if is_in_proportion(placed, model) {
            let mut off = placed.clone();
            off.values[0] /= factor;
            next = add(&next, off);
        }
    }
    next
}

/// Whether a wrong nominal value is a factor on a mass or a force.
fn is_in_proportion(placed: &Placed, model: &Model) -> bool {
    match (placed.effect.nominal_quantity(), &placed.at) {
        (None | Some(NominalQuantity::OutputGain | NominalQuantity::PlantParameter), _) => false,
        (Some(NominalQuantity::InputGain), Location::Input(channel)) => {
            let mut inputs = model.inputs.iter();
            inputs.any(|input| input.channel == *channel && input.kind == InputKind::Force)
        }
        _ => true,
    }
}

/// Whether a unit is that of a force, of what makes one of a motion, or of a mass.
fn is_force_or_mass(unit: &str) -> bool {
    unit.starts_with('N') || unit.starts_with("kg")
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;

    use super::*;
    use crate::candidate_model::name;

    #[test]
    fn a_plant_and_its_drive_in_proportion() {
        let text = "schema = \"simgap-model/1\"\nname = \"slide\"\n\
            [[mass]]\nname = \"m\"\nvalue = 2.0\n\
            [[damper]]\nname = \"c\"\nbetween = [\"m\", \"ground\"]\ndamping = 1.0\n\
            [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"m\"\n\
            [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"m\"\n";
        let model = Model::from_toml(text).unwrap();
        let mass = Location::Mass("m".into());
        let ground = Location::Between(["m".into(), "ground".into()]);
        let placed = |kind: &str, at: &Location, value: f64| {
            Placed::new(find(kind).unwrap(), at.clone(), vec![value])
        };
        let start = Start {
            effects: vec![
                placed("mass_error", &mass, 1.25),
                placed("coulomb_friction", &ground, 0.5),
                placed("sensor_gain", &Location::Channel("y".into()), 1.25),
            ],
            nominal: vec![
                placed("damping_error", &ground, 1.0),
                placed("input_gain", &Location::Input("u".into()), 1.0),
            ],
            initial: vec![],
        };
        let next = rescaled(&start, 1.25, &model);
        let values: Vec<(String, f64)> = next
            .effects
            .iter()
            .map(|p| (name(p), p.values[0]))
            .collect();
        let needed = [
            ("mass_error mass m", 1.0),
            ("coulomb_friction between m and ground", 0.4),
            ("sensor_gain channel y", 1.25),
            ("damping_error between m and ground", 0.8),
            ("input_gain input u", 0.8),
        ];
        assert_eq!(
            values,
            needed.map(|(name, value)| (name.to_string(), value))
        );
        assert!(next.nominal.is_empty());
    }
}
