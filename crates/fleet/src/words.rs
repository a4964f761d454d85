//! Findings in words.

use std::collections::BTreeMap;

use simgap_estimate::NORMAL_95;

use crate::course::Course;
use crate::factor::Explanation;
use crate::observe::{Cause, Estimate, Quantity};
use crate::population::Population;
use crate::scope::Scope;

/// Names that a sentence lists.
const LISTED: usize = 12;

pub(crate) fn common(cause: &Cause, all: usize, count: usize) -> String {
    format!(
        "{cause}: named in {count} of {all} diagnoses, without a difference between machines, days or conditions. \
         It is common to all: the model is wrong there."
    )
}

pub(crate) fn division(cause: &Cause, scope: Scope, all: &[Explanation]) -> String {
    let Some(best) = all.first() else {
        return String::new();
    };
    let [n, k] = best.inside;
    let [others, strays] = best.outside;
    let counts =
        format!("named in {k} of {n} diagnoses there and in {strays} of {others} elsewhere");
    let places: Vec<String> = all.iter().map(|e| levels(&e.factor, &e.levels)).collect();
    match scope {
        Scope::Undecided => format!(
            "{cause}: {}; {counts}. These differ together, so the data cannot tell which of them it is: nobody is to blame.",
            places.join(", or ")
        ),
        Scope::Condition => format!(
            "{cause}: {}; {counts}. It belongs to the measurement or the conditions there: no machine is to blame.",
            places.join(", or ")
        ),
        Scope::Machine | Scope::Common => format!("{cause}: {}; {counts}.", places.join(", or ")),
    }
}

pub(crate) fn shared_course(quantity: &Quantity, machines: usize, all: usize) -> String {
    format!(
        "{} of {}: changes over time in {machines} of {all} machines. It is common to them and no fault of one of them.",
        quantity.parameter, quantity.cause
    )
}

pub(crate) fn course(
    quantity: &Quantity,
    machine: &str,
    course: &Course,
    dates: &[String; 2],
    steps: &[String],
    apart: &BTreeMap<String, Vec<String>>,
) -> String {
    let [from, to] = course.ends();
    let verb = if to > from { "grows" } else { "falls" };
    let how = match course {
        Course::Line {
            slope,
            slope_ci95: [low, high],
            ..
        } => format!(
            "{verb} from {} to {} between {} and {}, by {} each day (95 %: {} to {})",
            number(from),
            number(to),
            dates[0],
            dates[1],
            number(*slope),
            number(*low),
            number(*high)
        ),
        Course::Steps { levels, .. } => {
            let levels: Vec<String> = levels.iter().map(|&level| number(level)).collect();
            format!(
                "{verb} in {} at {}: {}",
                if steps.len() == 1 {
                    "one step"
                } else {
                    "steps"
                },
                listed(steps),
                levels.join(", then ")
            )
        }
    };
    let subject = format!(
        "{} of {}: machine {machine}, where it",
        quantity.parameter, quantity.cause
    );
    format!("{subject} {how}.{}", undecided(apart))
}

pub(crate) fn shifted(quantity: &Quantity, found: &Population, half: f64) -> String {
    format!(
        "{} of {}: {} in the mean of {} machines (95 %: {} to {}), where the model file has 1. The model is wrong there.",
        quantity.parameter,
        quantity.cause,
        number(found.mean),
        found.machines,
        number(found.mean - half),
        number(found.mean + half)
    )
}

pub(crate) fn apart(
    quantity: &Quantity,
    machine: &str,
    own: Estimate,
    fleet: Estimate,
    apart: &BTreeMap<String, Vec<String>>,
) -> String {
    let half = NORMAL_95 * own.std;
    format!(
        "{} of {}: machine {machine} lies apart with {} (95 %: {} to {}), the others have {}.{}",
        quantity.parameter,
        quantity.cause,
        number(own.value),
        number(own.value - half),
        number(own.value + half),
        number(fleet.value),
        undecided(apart)
    )
}

/// What differs together with the machine.
fn undecided(apart: &BTreeMap<String, Vec<String>>) -> String {
    let others = apart.iter().filter(|(factor, _)| *factor != "machine");
    let others: Vec<String> = others
        .map(|(factor, names)| levels(factor, names))
        .collect();
    match others.is_empty() {
        true => String::new(),
        false => format!(
            " This machine or {}: they differ together, so the data cannot tell which of them it is, and nobody is to blame.",
            others.join(", or ")
        ),
    }
}

fn levels(factor: &str, names: &[String]) -> String {
    format!("{factor} {}", listed(names))
}

fn listed(names: &[String]) -> String {
    let shown = |name: &String| {
        if name.is_empty() {
            "(not stated)".to_owned()
        } else {
            name.clone()
        }
    };
    let first: Vec<String> = names.iter().take(LISTED).map(shown).collect();
    match names.len() > LISTED {
        true => format!("{} and {} more", first.join(", "), names.len() - LISTED),
        false => first.join(", "),
    }
}

/// Four significant digits, in powers of ten where it is very large or very small.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_numbers_have_four_digits() {
        let shown = [12345.6, 1.0, 0.1234567, 0.00123456, -2.5e-7, 3.2e9, 0.0].map(number);
        assert_eq!(
            shown,
            [
                "12346",
                "1.000",
                "0.1235",
                "0.001235",
                "-2.500e-7",
                "3.200e9",
                "0"
            ]
        );
    }
}
