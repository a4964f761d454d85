//! What kind of case is asked for.

use std::fmt;

use simgap_effects::{Family, SiteKind, catalogue, find};

use crate::BlindError;
use crate::random::Random;

/// What a case is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Recipe {
    /// The model is right to the last digit; the gap is noise.
    Noise,
    /// Every nominal parameter is off within the tolerance, nothing else.
    SmallErrors,
    /// One catalogue kind at a random legal place. A nominal parameter is well off.
    Kind(String),
    /// Two nominal parameters, each well off.
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
            Recipe::SmallErrors => f.write_str("small errors of the parameters"),
            Recipe::Kind(kind) | Recipe::Foreign(kind) => f.write_str(kind),
            Recipe::TwoParameters => f.write_str("two parameters"),
            Recipe::Pair(a, b) => write!(f, "{a} and {b}"),
        }
    }
}

/// The recipes of a campaign, in an order that gives nothing away.
///
/// | share | recipe |
/// |---|---|
/// | 18 of 25 | the catalogue in turn, one kind at a time |
/// | 3 of 25 | a pair of kinds; every sixth two wrong parameters |
/// | 2 of 25 | a foreign effect |
/// | 2 of 25 | nothing: noise with exact parameters, noise with parameters within the tolerance |
///
/// With `only`, every case has one of these kinds instead (`noise`, `small_errors`,
/// `two_parameters`, `pair` and `foreign` are accepted as well).
///
/// # Errors
/// [`BlindError::UnknownKind`] for a kind that does not exist, [`BlindError::NoPlant`] for one that no drawn machine has.
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
            match i % PERIOD {
                0 => Recipe::Noise,
                1 => Recipe::SmallErrors,
                2 | 3 => Recipe::Foreign(lists.foreign.next()),
                4 if (i / PERIOD).is_multiple_of(2) => Recipe::TwoParameters,
                4..=6 => lists.pair(&mut random),
                _ => Recipe::Kind(lists.all.next()),
            }
        } else {
            match only[i % only.len()].as_str() {
                "noise" => Recipe::Noise,
                "small_errors" => Recipe::SmallErrors,
                "two_parameters" => Recipe::TwoParameters,
                "pair" => lists.pair(&mut random),
                "foreign" => Recipe::Foreign(lists.foreign.next()),
                kind if find(kind).is_some() => {
                    is_drawn(kind)?;
                    Recipe::Kind(kind.to_string())
                }
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

/// Cases after which the shares repeat.
const PERIOD: usize = 25;

pub(crate) fn known_kinds() -> String {
    let special = ["noise", "small_errors", "two_parameters", "pair", "foreign"];
    special
        .into_iter()
        .chain(catalogue().iter().map(|effect| effect.kind()))
        .collect::<Vec<_>>()
        .join(", ")
}

/// The kinds of the catalogue of which a case can be drawn. A parameter of a simulator of the user's (`parameter_error`)
/// is none: every machine that is drawn here is made of masses and members or of a hydraulic axis, and has no such parameter.
///
/// ```
/// let kinds = simgap_blind::drawn_kinds();
/// assert!(kinds.contains(&"bulk_modulus") && !kinds.contains(&"parameter_error"));
/// ```
#[must_use]
pub fn drawn_kinds() -> Vec<&'static str> {
    let drawn = catalogue().iter();
    let drawn = drawn.filter(|effect| effect.site() != SiteKind::Parameter);
    drawn.map(|effect| effect.kind()).collect()
}

/// Refuses a kind of the catalogue that no machine which is drawn here has a place for.
pub(crate) fn is_drawn(kind: &str) -> Result<(), BlindError> {
    let drawn = drawn_kinds();
    match find(kind).is_some() && !drawn.contains(&kind) {
        true => Err(BlindError::NoPlant {
            found: kind.to_string(),
            drawn: drawn.join(", "),
        }),
        false => Ok(()),
    }
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
    /// Of the catalogue.
    all: Round,
    /// Of the catalogue without its nominal parameters.
    effects: Vec<String>,
    foreign: Round,
}

impl Lists {
    fn new(random: &mut Random) -> Lists {
        let names = |keep: &dyn Fn(Family) -> bool| -> Vec<String> {
            // No plant that is drawn here has a hydraulic drive.
            let drawn = catalogue().iter().filter(|e| e.site().is_mechanical());
            let kept = drawn.filter(|effect| keep(effect.family()));
            kept.map(|effect| effect.kind().to_string()).collect()
        };
        let foreign = crate::foreign_effects();
        let foreign = foreign.iter().map(|effect| effect.kind().to_string());
        Lists {
            all: Round::new(random, names(&|_| true)),
            effects: names(&|family| family != Family::NominalParameter),
            foreign: Round::new(random, foreign.collect()),
        }
    }

    fn pair(&self, random: &mut Random) -> Recipe {
        let kinds = &self.effects;
        let first = random.below(kinds.len());
        let second = (first + 1 + random.below(kinds.len() - 1)) % kinds.len();
        Recipe::Pair(kinds[first].clone(), kinds[second].clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_three_hundred_cases_hold_every_kind_several_times() -> Result<(), BlindError> {
        let recipes = schedule(3, 300, &[])?;
        let count = |wanted: &dyn Fn(&Recipe) -> bool| recipes.iter().filter(|r| wanted(r)).count();
        for effect in catalogue().iter().filter(|e| e.site().is_mechanical()) {
            let recipe = Recipe::Kind(effect.kind().to_string());
            assert!(count(&|r| *r == recipe) >= 4, "{recipe}");
        }
        assert_eq!(count(&|r| *r == Recipe::Noise), 12);
        assert_eq!(count(&|r| *r == Recipe::SmallErrors), 12);
        assert_eq!(count(&|r| *r == Recipe::TwoParameters), 6);
        assert_eq!(count(&|r| matches!(r, Recipe::Pair(..))), 30);
        assert_eq!(count(&|r| matches!(r, Recipe::Foreign(_))), 24);
        assert_eq!(recipes, schedule(3, 300, &[])?);
        assert_ne!(recipes, schedule(4, 300, &[])?);
        Ok(())
    }

    #[test]
    fn verify_a_kind_that_no_machine_has_is_refused() {
        let message = schedule(1, 3, &["parameter_error".to_string()])
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        let needed = "recipe \"parameter_error\": a kind of the simulators of users, no drawn machine has a place for it; \
            needed is one of: mass_error, ";
        assert!(message.starts_with(needed), "{message}");
    }

    #[test]
    fn verify_unknown_kind_is_refused() {
        let message = schedule(1, 3, &["gremlins".to_string()])
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default();
        assert!(
            message.starts_with(
                "recipe \"gremlins\": unknown kind, needed is one of: noise, small_errors, two_parameters, pair, foreign, mass_error"
            ),
            "{message}"
        );
    }
}
