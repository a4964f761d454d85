//! What kind of case is asked for.

use std::fmt;

use simgap_effects::{Family, catalogue, find};

use crate::BlindError;
use crate::random::Random;

/// What a case is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Recipe {
    /// The model is right; the gap is noise.
    Noise,
    /// One catalogue kind at a random legal place. A nominal parameter is off by 8 to 30 %.
    Kind(String),
    /// Two nominal parameters, each off by 8 to 30 %.
    TwoParameters,
    /// Two kinds of the catalogue.
    Pair(String, String),
    /// An effect that the catalogue does not have (see [`crate::foreign_effects`]).
    Foreign(String),
}

impl fmt::Display for Recipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Recipe::Noise => f.write_str("noise only"),
            Recipe::Kind(kind) | Recipe::Foreign(kind) => f.write_str(kind),
            Recipe::TwoParameters => f.write_str("two parameters"),
            Recipe::Pair(a, b) => write!(f, "{a} and {b}"),
        }
    }
}

/// The recipes of a campaign, in an order that gives nothing away.
///
/// Of ten cases one is noise alone, one or two have wrong parameters, one has a pair of effects,
/// one a foreign effect; the others go through the rest of the catalogue in turn. With `only`,
/// every case has one of these kinds instead (`noise`, `two_parameters`, `pair` and `foreign` are
/// accepted as well).
///
/// # Errors
/// [`BlindError::UnknownKind`] for a kind that does not exist.
///
/// ```
/// let recipes = simgap_blind::schedule(1, 40, &[])?;
/// assert_eq!(recipes.len(), 40);
/// assert!(recipes.contains(&simgap_blind::Recipe::Noise));
/// # Ok::<(), simgap_blind::BlindError>(())
/// ```
pub fn schedule(seed: u64, count: usize, only: &[String]) -> Result<Vec<Recipe>, BlindError> {
    let mut random = Random::of_case(seed, usize::MAX, 0);
    let mut lists = Lists::new(&mut random);
    let mut recipes = Vec::with_capacity(count);
    for i in 0..count {
        let recipe = if only.is_empty() {
            match i % 10 {
                0 => Recipe::Noise,
                1 if i % 30 == 21 => Recipe::TwoParameters,
                1 => Recipe::Kind(lists.parameters.next()),
                2 => lists.pair(&mut random),
                3 => Recipe::Foreign(lists.foreign.next()),
                _ => Recipe::Kind(lists.effects.next()),
            }
        } else {
            match only[i % only.len()].as_str() {
                "noise" => Recipe::Noise,
                "two_parameters" => Recipe::TwoParameters,
                "pair" => lists.pair(&mut random),
                "foreign" => Recipe::Foreign(lists.foreign.next()),
                kind if find(kind).is_some() => Recipe::Kind(kind.to_string()),
                kind if lists.foreign.kinds.iter().any(|known| known == kind) => {
                    Recipe::Foreign(kind.to_string())
                }
                kind => {
                    return Err(BlindError::UnknownKind {
                        found: kind.to_string(),
                        known: known_kinds(),
                    });
                }
            }
        };
        recipes.push(recipe);
    }
    random.shuffle(&mut recipes);
    Ok(recipes)
}

pub(crate) fn known_kinds() -> String {
    let special = ["noise", "two_parameters", "pair", "foreign"];
    special
        .into_iter()
        .chain(catalogue().iter().map(|effect| effect.kind()))
        .collect::<Vec<_>>()
        .join(", ")
}

/// A shuffled list that is gone through again and again.
struct Round {
    kinds: Vec<String>,
    next: usize,
}

impl Round {
    fn new(random: &mut Random, mut kinds: Vec<String>) -> Round {
        random.shuffle(&mut kinds);
        Round { kinds, next: 0 }
    }

    fn next(&mut self) -> String {
        let kind = self.kinds[self.next % self.kinds.len()].clone();
        self.next += 1;
        kind
    }
}

struct Lists {
    parameters: Round,
    effects: Round,
    foreign: Round,
}

impl Lists {
    fn new(random: &mut Random) -> Lists {
        let of = |nominal: bool| -> Vec<String> {
            catalogue()
                .iter()
                .filter(|effect| (effect.family() == Family::NominalParameter) == nominal)
                .map(|effect| effect.kind().to_string())
                .collect()
        };
        let foreign = crate::foreign_effects();
        let foreign = foreign.iter().map(|effect| effect.kind().to_string());
        Lists {
            parameters: Round::new(random, of(true)),
            effects: Round::new(random, of(false)),
            foreign: Round::new(random, foreign.collect()),
        }
    }

    fn pair(&self, random: &mut Random) -> Recipe {
        let kinds = &self.effects.kinds;
        let first = random.below(kinds.len());
        let second = (first + 1 + random.below(kinds.len() - 1)) % kinds.len();
        Recipe::Pair(kinds[first].clone(), kinds[second].clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_schedule_covers_the_catalogue() -> Result<(), BlindError> {
        let recipes = schedule(3, 200, &[])?;
        for effect in catalogue() {
            let recipe = Recipe::Kind(effect.kind().to_string());
            assert!(recipes.contains(&recipe), "{recipe}");
        }
        assert_eq!(recipes.iter().filter(|r| **r == Recipe::Noise).count(), 20);
        assert_eq!(recipes, schedule(3, 200, &[])?);
        assert_ne!(recipes, schedule(4, 200, &[])?);
        Ok(())
    }

    #[test]
    fn verify_unknown_kind_is_refused() {
        let message = schedule(1, 3, &["gremlins".to_string()])
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        assert!(
            message.starts_with(
                "recipe \"gremlins\": unknown kind, needed is one of: noise, two_parameters, pair, foreign, mass_error"
            ),
            "{message}"
        );
    }
}
