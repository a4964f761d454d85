//! Which case of a seed has which role and kind.

use serde::{Deserialize, Serialize};

use crate::kinds::{EFFECTS, FOREIGN, PARAMETERS};
use crate::rng::Rng;

/// What a case is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// One effect of the catalogue.
    Single,
    /// Two.
    Pair,
    /// None.
    Clean,
    /// One or two nominal parameters are wrong.
    Parameters,
    /// A law that the catalogue lacks.
    Foreign,
    /// A slip in the set-up: unit, sign, cable.
    Slip,
    /// One large cause among smaller ones, as in every real machine.
    Mixed,
}

/// All roles with their shares in a hundred cases; those without a share are drawn where they are asked for.
pub const ROLES: [(Role, usize); 7] = [
    (Role::Single, 45),
    (Role::Pair, 12),
    (Role::Clean, 12),
    (Role::Parameters, 17),
    (Role::Foreign, 9),
    (Role::Slip, 5),
    (Role::Mixed, 0),
];

/// Kinds of slips.
pub const SLIPS: [&str; 5] = [
    "unit_output",
    "sign_output",
    "not_connected",
    "sign_input",
    "unit_input",
];

impl Role {
    /// The name in the truth.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Role::Single => "single",
            Role::Pair => "pair",
            Role::Clean => "clean",
            Role::Parameters => "parameters",
            Role::Foreign => "foreign",
            Role::Slip => "slip",
            Role::Mixed => "mixed",
        }
    }

    /// The role of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Role> {
        let role = ROLES.iter().find(|(role, _)| role.name() == name);
        role.map(|(role, _)| *role)
    }
}

/// Restriction of all cases to a role or a kind.
#[derive(Debug, Clone, Default)]
pub struct Filter {
    /// Only this role.
    pub role: Option<Role>,
    /// Only this kind, as a single effect or foreign law.
    pub kind: Option<&'static str>,
}

/// What a case is to be.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// Its role.
    pub role: Role,
    /// Kinds of the catalogue, a foreign law or a slip; empty for clean and parameters.
    pub kinds: Vec<&'static str>,
}

/// The role of each case of a block of a hundred.
fn block(seed: u64, block: usize) -> Vec<Role> {
    let mut list: Vec<Role> = ROLES
        .iter()
        .flat_map(|(role, share)| vec![*role; *share])
        .collect();
    Rng::new(&format!("rigs/plan/{seed}/{block}")).shuffle(&mut list);
    list
}

/// The kind of number `index` of a list that is gone through in a new order each time.
fn in_turn(list: &[&'static str], label: &str, seed: u64, index: usize) -> &'static str {
    let round = index / list.len();
    let mut order = list.to_vec();
    Rng::new(&format!("rigs/{label}/{seed}/{round}")).shuffle(&mut order);
    order[index % list.len()]
}

/// What case `number` (from 1 on) of a seed is to be.
#[must_use]
pub fn wanted(seed: u64, number: usize, filter: &Filter) -> Wanted {
    wanted_instead(seed, number, filter, 0)
}

/// The same with another last kind, the `instead`-th after the one whose turn it is: for a case that no machine shows.
#[must_use]
pub fn wanted_instead(seed: u64, number: usize, filter: &Filter, instead: usize) -> Wanted {
    if let Some(kind) = filter.kind {
        let role = match kind.starts_with("foreign_") {
            true => Role::Foreign,
            false => Role::Single,
        };
        return Wanted {
            role: filter.role.unwrap_or(role),
            kinds: vec![kind],
        };
    }
    let place = number.saturating_sub(1);
    let (role, index) = match filter.role {
        Some(role) => (role, place),
        None => {
            let own = block(seed, place / 100);
            let role = own[place % 100];
            let before = own[..place % 100].iter().filter(|r| **r == role).count();
            let each = ROLES.iter().find(|r| r.0 == role).map_or(0, |r| r.1);
            (role, place / 100 * each + before)
        }
    };
    let kinds = match role {
        Role::Single => vec![in_turn(&EFFECTS, "single", seed, index + instead)],
        Role::Pair => vec![
            in_turn(&EFFECTS, "pair/a", seed, index),
            in_turn(&EFFECTS, "pair/b", seed, index + instead),
        ],
        Role::Foreign => vec![in_turn(&FOREIGN, "foreign", seed, index + instead)],
        Role::Slip => vec![in_turn(&SLIPS, "slip", seed, index + instead)],
        Role::Mixed => {
            let mut all = EFFECTS.to_vec();
            all.extend(PARAMETERS);
            vec![in_turn(&all, "mixed", seed, index + instead)]
        }
        Role::Clean | Role::Parameters => vec![],
    };
    Wanted { role, kinds }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_shares_and_kinds_are_spread_evenly() {
        let plan: Vec<Wanted> = (1..=200)
            .map(|n| wanted(7, n, &Filter::default()))
            .collect();
        for (role, share) in ROLES {
            assert_eq!(plan.iter().filter(|w| w.role == role).count(), 2 * share);
        }
        let singles = plan.iter().filter(|w| w.role == Role::Single);
        let mut counts = vec![0; EFFECTS.len()];
        for single in singles {
            counts[EFFECTS.iter().position(|k| *k == single.kinds[0]).unwrap()] += 1;
        }
        assert!(counts.iter().all(|c| (2..=3).contains(c)), "{counts:?}");
    }
}
