//! What a campaign holds.

use simgap_blind::{Level, Recipe, drawn_kinds, schedule};

use super::{Args, BlindCheckError};

/// Cases of the short run, one of each.
const SHORT: [&str; 12] = [
    "noise",
    "small_errors",
    "foreign",
    "stiffness_error",
    "coulomb_friction",
    "cubic_stiffness",
    "backlash",
    "attached_mode",
    "input_delay",
    "sensor_lag",
    "quantisation",
    "alternating_gain",
];
/// Seed of the short run: neither one to tune with nor one to report.
const SHORT_SEED: u64 = 5000;
/// Hard cases have an order of their own.
const HARD: u64 = 1 << 32;

/// One case to draw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Planned {
    pub(super) number: usize,
    pub(super) recipe: Recipe,
    pub(super) level: Level,
    /// The kind that is taken out of the catalogue.
    pub(super) withheld: Option<String>,
}

impl Planned {
    /// Number only: it says nothing of the effect.
    pub(super) fn name(&self) -> String {
        format!("case-{:04}", self.number)
    }
}

/// The seed of a campaign.
pub(super) fn seed(args: &Args) -> u64 {
    if args.short { SHORT_SEED } else { args.seed }
}

/// The cases in the order of their numbers.
pub(super) fn plan(args: &Args) -> Result<Vec<Planned>, BlindCheckError> {
    if args.short {
        let kinds: Vec<String> = SHORT.iter().map(|kind| (*kind).to_string()).collect();
        let recipes = schedule(SHORT_SEED, SHORT.len(), &kinds)?;
        return Ok(numbered(of_level(recipes, Level::Standard)));
    }
    let mut all = of_level(
        schedule(args.seed, args.cases, &args.kinds)?,
        args.level.into(),
    );
    let hard = schedule(args.seed.wrapping_add(HARD), args.hard, &args.kinds)?;
    all.extend(of_level(hard, Level::Hard));
    for kind in withheld(args)? {
        for _ in 0..args.withheld_cases {
            let recipe = Recipe::Kind(kind.clone());
            all.push((recipe, args.level.into(), Some(kind.clone())));
        }
    }
    let mut planned = numbered(all);
    planned.retain(|case| args.only.is_none_or(|only| only == case.number));
    Ok(planned)
}

type Unnumbered = (Recipe, Level, Option<String>);

fn of_level(recipes: Vec<Recipe>, level: Level) -> Vec<Unnumbered> {
    let all = recipes.into_iter();
    all.map(|recipe| (recipe, level, None)).collect()
}

fn numbered(all: Vec<Unnumbered>) -> Vec<Planned> {
    all.into_iter()
        .enumerate()
        .map(|(number, (recipe, level, withheld))| Planned {
            number,
            recipe,
            level,
            withheld,
        })
        .collect()
}

/// The kinds to withhold, each once.
fn withheld(args: &Args) -> Result<Vec<String>, BlindCheckError> {
    let mut kinds: Vec<String> = vec![];
    for kind in &args.withhold {
        if !drawn_kinds().contains(&kind.as_str()) {
            // Its message lists what there is.
            schedule(args.seed, 1, std::slice::from_ref(kind))?;
        }
        kinds.push(kind.clone());
    }
    if args.withhold_each {
        kinds.extend(drawn_kinds().into_iter().map(str::to_string));
    }
    kinds.sort();
    kinds.dedup();
    Ok(kinds)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Cli {
        #[command(flatten)]
        args: Args,
    }

    fn planned(words: &[&str]) -> Result<Vec<Planned>, BlindCheckError> {
        let words = ["blind-check", "--cases", "0"].iter().chain(words);
        plan(&Cli::parse_from(words).args)
    }

    #[test]
    fn verify_every_kind_that_is_withheld_can_be_drawn() -> Result<(), BlindCheckError> {
        let planned = planned(&["--withhold-each"])?;
        let withheld: Vec<&str> = planned
            .iter()
            .filter_map(|p| p.withheld.as_deref())
            .collect();
        let mut drawn = drawn_kinds();
        drawn.sort_unstable();
        assert_eq!(withheld, drawn);
        assert!(!withheld.contains(&"parameter_error"));
        Ok(())
    }

    #[test]
    fn verify_a_kind_that_no_machine_has_cannot_be_withheld() {
        let refused = planned(&["--withhold", "parameter_error"]);
        let message = refused.err().map(|error| error.to_string());
        let message = message.unwrap_or_default();
        assert!(
            message.starts_with("recipe \"parameter_error\""),
            "{message}"
        );
    }
}
