//! What goes together with a cause: machines, days, rigs, loads.
//!
//! A factor divides the diagnoses by its levels. Under "the cause belongs to some levels" it is named with one probability
//! in them and with another one elsewhere, both unknown and equally likely over \[0, 1\]. Of k named among n the marginal
//! likelihood is that of Beta and binomial:
//!
//! ```text
//! ln m(k, n) = ln ∫ pᵏ (1−p)ⁿ⁻ᵏ dp = ln k! + ln (n−k)! − ln (n+1)!                          (1)
//! Δ = ln m(k₁, n₁) + ln m(k₂, n₂) − ln m(k, n)                                              (2)
//! G = Δ − ln C(L, j)                                                                        (3)
//! ```
//!
//! with n₁ diagnoses in the j levels that are taken out of L, and n₂ in the others. G counts that j levels had to be chosen.
//! Two factors whose Δ is nearly the same divide the named from the others as well as each other: the data cannot tell them
//! apart, however many levels had to be chosen.

use std::collections::{BTreeMap, BTreeSet};

use crate::observe::Observation;

/// G from which a factor is taken to explain where a cause is named: odds of 400 to 1, against a few factors and some ten
/// causes that are asked for.
const EXPLAINS: f64 = 6.0;
/// Two factors whose Δ differ by less are not told apart: odds below 20 to 1.
const ALIKE: f64 = 3.0;

/// Something that differs between diagnoses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Factor {
    /// `machine`, `date`, or the name of a condition.
    pub name: String,
    /// Its levels, sorted.
    pub levels: Vec<String>,
    /// The level of each observation.
    pub of: Vec<usize>,
}

impl Factor {
    fn new(name: &str, values: &[&str]) -> Factor {
        let levels: BTreeSet<&str> = values.iter().copied().collect();
        let levels: Vec<String> = levels.into_iter().map(str::to_owned).collect();
        let index = |value: &&str| levels.iter().position(|level| level == value).unwrap_or(0);
        Factor {
            name: name.to_owned(),
            of: values.iter().map(index).collect(),
            levels,
        }
    }
}

/// The factors of observations: machine and date first, then the conditions; only what differs at all.
#[must_use]
pub fn factors(observations: &[Observation], conditions: &[String]) -> Vec<Factor> {
    let machines: Vec<&str> = observations.iter().map(|o| o.machine.as_str()).collect();
    let dates: Vec<&str> = observations.iter().map(|o| o.date.as_str()).collect();
    let mut factors = vec![
        Factor::new("machine", &machines),
        Factor::new("date", &dates),
    ];
    for condition in conditions {
        let values = observations.iter().map(|o| o.conditions.get(condition));
        let values: Vec<&str> = values.map(|v| v.map_or("", String::as_str)).collect();
        factors.push(Factor::new(condition, &values));
    }
    factors.retain(|factor| factor.levels.len() > 1);
    factors
}

/// A factor that explains where a cause is named.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// Name of the factor.
    pub factor: String,
    /// Levels that the cause belongs to.
    pub levels: Vec<String>,
    /// Observations in these levels, and how many of them name the cause.
    pub inside: [usize; 2],
    /// Observations in the others, and how many of them name it.
    pub outside: [usize; 2],
    /// Δ of (2), nat.
    pub separation: f64,
    /// G of (3), nat.
    pub gain: f64,
    /// Which observations are inside.
    units: Vec<usize>,
}

/// Where a cause is named, told by one factor, or by several that cannot be told apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Division {
    /// The best explanation first, then those that are as good.
    pub explanations: Vec<Explanation>,
}

/// Takes what explains a cause one after the other: the observations in the levels that are found are laid aside, and the
/// rest is asked again. Gives the divisions, and of the rest how many there are and how many of them name the cause.
#[must_use]
pub fn divisions(named: &[bool], factors: &[Factor]) -> (Vec<Division>, [usize; 2]) {
    let mut active: Vec<usize> = (0..named.len()).collect();
    let mut found = Vec::new();
    loop {
        let mut all: Vec<Explanation> = factors
            .iter()
            .filter_map(|factor| explanation(named, &active, factor))
            .filter(|one| one.gain > 0.0)
            .collect();
        // Of equal gains the first factor.
        all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let Some(best) = all.first().filter(|best| best.gain > EXPLAINS).cloned() else {
            let count = active.iter().filter(|&&unit| named[unit]).count();
            return (found, [active.len(), count]);
        };
        let is_alike = |one: &Explanation| one.separation > best.separation - ALIKE;
        all.retain(is_alike);
        active.retain(|unit| !best.units.contains(unit));
        found.push(Division { explanations: all });
    }
}

/// The levels of a factor that divide best, by (3).
fn explanation(named: &[bool], active: &[usize], factor: &Factor) -> Option<Explanation> {
    let mut counts: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    for &unit in active {
        let [all, with] = counts.entry(factor.of[unit]).or_default();
        *all += 1;
        *with += usize::from(named[unit]);
    }
    let total = counts
        .values()
        .fold([0, 0], |sum, c| [sum[0] + c[0], sum[1] + c[1]]);
    let mut order: Vec<(usize, [usize; 2])> = counts.into_iter().collect();
    let rate = |[all, with]: [usize; 2]| with as f64 / all as f64;
    order.sort_by(|a, b| {
        rate(b.1)
            .total_cmp(&rate(a.1))
            .then(b.1[0].cmp(&a.1[0]))
            .then(a.0.cmp(&b.0))
    });
    let levels = order.len();
    let mut inside = [0, 0];
    let mut best: Option<(usize, f64, f64, [usize; 2])> = None;
    for (place, (_, count)) in order.iter().enumerate().take(levels.saturating_sub(1)) {
        inside = [inside[0] + count[0], inside[1] + count[1]];
        let outside = [total[0] - inside[0], total[1] - inside[1]];
        if rate(inside) <= rate(outside) {
            continue;
        }
        let separation = ln_marginal(inside) + ln_marginal(outside) - ln_marginal(total);
        let gain = separation - ln_choose(levels, place + 1);
        if best.is_none_or(|(_, _, known, _)| gain > known) {
            best = Some((place + 1, separation, gain, inside));
        }
    }
    let (taken, separation, gain, inside) = best?;
    let taken: Vec<usize> = order.iter().take(taken).map(|(level, _)| *level).collect();
    let mut names: Vec<String> = taken.iter().map(|&l| factor.levels[l].clone()).collect();
    names.sort();
    let units = active
        .iter()
        .copied()
        .filter(|&unit| taken.contains(&factor.of[unit]));
    Some(Explanation {
        factor: factor.name.clone(),
        levels: names,
        inside,
        outside: [total[0] - inside[0], total[1] - inside[1]],
        separation,
        gain,
        units: units.collect(),
    })
}

/// ln m of (1), of n observations and k that name the cause.
fn ln_marginal([n, k]: [usize; 2]) -> f64 {
    ln_factorial(k) + ln_factorial(n - k) - ln_factorial(n + 1)
}

fn ln_choose(n: usize, k: usize) -> f64 {
    ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k)
}

fn ln_factorial(n: usize) -> f64 {
    (2..=n).map(|i| (i as f64).ln()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twelve machines over ten days, and where they stand.
    fn observed(
        rig: impl Fn(usize) -> &'static str,
        date: impl Fn(usize, usize) -> String,
    ) -> Vec<Factor> {
        let (mut machines, mut dates, mut rigs) = (vec![], vec![], vec![]);
        for machine in 0..12 {
            for day in 0..10 {
                machines.push(format!("m{machine:02}"));
                dates.push(date(machine, day));
                rigs.push(rig(machine));
            }
        }
        fn of<T: AsRef<str>>(name: &str, values: &[T]) -> Factor {
            Factor::new(name, &values.iter().map(AsRef::as_ref).collect::<Vec<_>>())
        }
        let mut factors = vec![
            of("machine", &machines),
            of("date", &dates),
            of("rig", &rigs),
        ];
        factors.retain(|factor| factor.levels.len() > 1);
        factors
    }

    fn told(named: &[bool], factors: &[Factor]) -> Vec<String> {
        let (divisions, rest) = divisions(named, factors);
        let told = divisions.iter().map(|division| {
            let all = division.explanations.iter();
            let all = all.map(|e| format!("{} {}", e.factor, e.levels.join(" ")));
            all.collect::<Vec<_>>().join(" or ")
        });
        told.chain([format!("{} of {}", rest[1], rest[0])])
            .collect()
    }

    #[test]
    fn verify_a_machine_and_a_day_are_told() {
        let factors = observed(
            |m| if m < 6 { "a" } else { "b" },
            |_, day| format!("d{day}"),
        );
        // Machine 3 on most of its days, all machines on day 7, and a stray one.
        let named: Vec<bool> = (0..120)
            .map(|unit| {
                let (machine, day) = (unit / 10, unit % 10);
                day == 7 || (machine == 3 && day > 2) || unit == 55
            })
            .collect();
        assert_eq!(
            told(&named, &factors),
            ["date d7", "machine m03", "1 of 99"]
        );
        let none = [false; 120];
        assert_eq!(told(&none, &factors), ["0 of 120"]);
        let all = [true; 120];
        assert_eq!(told(&all, &factors), ["120 of 120"]);
    }

    #[test]
    fn verify_a_machine_on_days_of_its_own_is_not_told_from_them() {
        // Machines 4 and 5 were measured in another week than the rest.
        let week = |machine| {
            if machine == 4 || machine == 5 {
                'x'
            } else {
                'd'
            }
        };
        let factors = observed(|_| "a", |machine, _| week(machine).to_string());
        let named: Vec<bool> = (0..120).map(|unit| matches!(unit / 10, 4 | 5)).collect();
        assert_eq!(
            told(&named, &factors),
            ["date x or machine m04 m05", "0 of 100"]
        );
        // And where a machine of the rest was there as well, it is the machines.
        let week = |machine| if (4..=6).contains(&machine) { 'x' } else { 'd' };
        let factors = observed(|_| "a", |machine, _| week(machine).to_string());
        assert_eq!(told(&named, &factors), ["machine m04 m05", "0 of 100"]);
    }

    #[test]
    fn verify_a_rig_of_one_machine_is_not_told_from_it() {
        let factors = observed(
            |m| if m == 2 { "b" } else { "a" },
            |_, day| format!("d{day}"),
        );
        let named: Vec<bool> = (0..120)
            .map(|unit| unit / 10 == 2 && unit % 10 > 1)
            .collect();
        assert_eq!(told(&named, &factors), ["rig b or machine m02", "0 of 110"]);
    }

    /// ∫ p² (1−p) dp = 1/12.
    #[test]
    fn verify_the_marginal_likelihood() {
        assert!((ln_marginal([3, 2]).exp() - 1.0 / 12.0).abs() < 1e-15);
        assert!((ln_choose(6, 2).exp() - 15.0).abs() < 1e-12);
    }
}
