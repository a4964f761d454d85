//! What an estimated value means for the machine: against what the model itself has there, against
//! the motion of the check records, against the time between samples.

use simgap_diagnose::{NamedEffect, NamedParameter, PlaceMotion};
use simgap_effects::Parameter;
use simgap_model::{Location, same_pair};

use super::ReportInput;
use crate::number::{percent, significant, trimmed};
use crate::unit::{Prefixed, prefixed, quantity, raised};

/// What the machine has and does at the place of an effect, SI; zero where there is none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Surroundings {
    stiffness: f64,
    damping: f64,
    mass: f64,
    largest_displacement: f64,
    travel: f64,
    largest_velocity: f64,
    /// Largest force that the members of the model carry there.
    largest_force: f64,
    time_step_s: f64,
}

/// One sentence, empty where nothing can be said.
pub(super) fn sense(
    effect: &NamedEffect,
    parameter: &NamedParameter,
    input: &ReportInput<'_>,
) -> String {
    let law = input
        .effect(&effect.kind)
        .and_then(|e| e.parameters().iter().find(|p| p.name == parameter.name));
    let mut out = Vec::new();
    let value = parameter.value;
    if parameter.name.ends_with("factor") && value.is_finite() {
        let change = percent((value - 1.0).abs());
        let way = if value > 1.0 { "above" } else { "below" };
        out.push(format!("{change} {way} the model file"));
    }
    out.extend(law.into_iter().flat_map(|law| bounds(law, parameter)));
    let around = surroundings(&effect.at, input);
    out.extend(law.and_then(|law| total(law, parameter, &around)));
    out.extend(compared(parameter, &effect.at, &around));
    crate::wording::sentence(&out.join("; "))
}

/// Whether the value is possible, and whether it could be no effect at all.
fn bounds(law: &Parameter, parameter: &NamedParameter) -> Vec<String> {
    let mut out = Vec::new();
    let value = parameter.value;
    let [low, high] = parameter.ci95;
    let room = 1e-9 * value.abs();
    if value <= law.lower + room && law.lower.is_finite() && law.lower != 0.0
        || value >= law.upper - room && law.upper.is_finite()
    {
        out.push("at the end of what is possible".to_owned());
    }
    let neutral = law.neutral.filter(|n| n.is_finite());
    if let Some(neutral) = neutral.filter(|n| low <= *n && *n <= high) {
        out.push(format!("could be {}, no effect", trimmed(neutral, 1)));
    }
    out
}

/// What the place has with the model's own part, where a value adds to it.
fn total(law: &Parameter, parameter: &NamedParameter, around: &Surroundings) -> Option<String> {
    let unit = quantity(&parameter.name).unit;
    let own = match unit.as_str() {
        "N s/m" => around.damping,
        "N/m" => around.stiffness,
        _ => return None,
    };
    if own == 0.0 || law.neutral != Some(0.0) {
        return None;
    }
    let sum = own + parameter.value;
    let Prefixed { unit, factor } = prefixed(&raised(&parameter.unit), sum.abs());
    let doubt = if sum < 0.0 {
        ", which would drive the machine"
    } else {
        ""
    };
    let text = significant(sum * factor, 4);
    Some(format!("{text}\u{a0}{unit} with the model's own{doubt}"))
}

/// The value beside what is like it.
fn compared(parameter: &NamedParameter, at: &Location, around: &Surroundings) -> Option<String> {
    let size = parameter.value.abs();
    let x = around.largest_displacement;
    let v = around.largest_velocity;
    let on_machine = matches!(at, Location::Between(_) | Location::Mass(_));
    // The unit of a motion along a line tells what it is; a name without one is that of a law of the user's.
    let of_name = quantity(&parameter.name).unit;
    let unit = match of_name.is_empty() {
        true => raised(&parameter.unit),
        false => of_name,
    };
    let (part, whole, of) = match unit.as_str() {
        "N" if on_machine => (
            size,
            around.largest_force,
            "the largest force of the model's own members there",
        ),
        "N/m²" => (
            size * x,
            around.stiffness,
            "the spring there, at the largest displacement",
        ),
        "N/m³" => (
            size * x * x,
            around.stiffness,
            "the spring there, at the largest displacement",
        ),
        "N s²/m²" => (
            size * v,
            around.damping,
            "the damper there, at the largest velocity",
        ),
        "m" if on_machine => (size, around.travel, "the travel"),
        "m/s" if on_machine => (size, v, "the largest velocity"),
        "kg" => (size, around.mass, "the mass it sits on"),
        "s" => (size, around.time_step_s, "the time between samples"),
        _ => return None,
    };
    let share = part / whole;
    if !(share > 0.0 && share.is_finite()) {
        return None;
    }
    Some(if share < 2.0 {
        format!("{} of {of}", percent(share))
    } else {
        format!("{} times {of}", significant(share, 2))
    })
}

fn surroundings(at: &Location, input: &ReportInput<'_>) -> Surroundings {
    let mut out = Surroundings {
        time_step_s: input.series.iter().map(time_step).fold(0.0, f64::max),
        ..Surroundings::default()
    };
    let Some(model) = input.nominal else {
        return out;
    };
    let pair = match at {
        Location::Between(pair) => pair.clone(),
        Location::Mass(mass) => [mass.clone(), simgap_model::GROUND.to_owned()],
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => return out,
    };
    if let Location::Mass(name) = at {
        let here = model.masses.iter().find(|m| &m.name == name);
        out.mass = here.map_or(0.0, |m| m.value);
    }
    [out.stiffness, out.damping] = model.stiffness_and_damping(&pair);
    let here = |m: &&PlaceMotion| matches!(&m.at, Location::Between(own) if same_pair(own, &pair));
    for motion in input.motions.iter().filter(here) {
        move_along(&mut out, motion);
    }
    out
}

/// Widens the extremes by one record.
fn move_along(out: &mut Surroundings, motion: &PlaceMotion) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (x, v) in motion.displacement.iter().zip(&motion.velocity) {
        (low, high) = (low.min(*x), high.max(*x));
        out.largest_displacement = out.largest_displacement.max(x.abs());
        out.largest_velocity = out.largest_velocity.max(v.abs());
        let force = out.stiffness * x + out.damping * v;
        out.largest_force = out.largest_force.max(force.abs());
    }
    out.travel = out.travel.max(high - low);
}

fn time_step(series: &simgap_diagnose::CheckSeries) -> f64 {
    match (series.time_s.first(), series.time_s.last()) {
        (Some(first), Some(last)) if series.time_s.len() > 1 => {
            (last - first) / (series.time_s.len() - 1) as f64
        }
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str, value: f64, at: &Location) -> Option<String> {
        let around = Surroundings {
            stiffness: 1000.0,
            damping: 20.0,
            mass: 5.0,
            largest_displacement: 0.1,
            travel: 0.15,
            largest_velocity: 2.0,
            largest_force: 80.0,
            time_step_s: 1e-3,
        };
        let parameter = NamedParameter {
            name: name.into(),
            unit: String::new(),
            value,
            ci95: [0.9 * value, 1.1 * value],
        };
        compared(&parameter, at, &around)
    }

    #[test]
    fn verify_values_are_set_beside_what_is_like_them() {
        let at = Location::Between(["a".into(), "b".into()]);
        let force = "10\u{a0}% of the largest force of the model's own members there";
        assert_eq!(told("friction_force_n", -8.0, &at).as_deref(), Some(force));
        // 2·10⁴ N/m³ times 0.1² m² is a fifth of 1000 N/m.
        let cubic = "20\u{a0}% of the spring there, at the largest displacement";
        assert_eq!(
            told("cubic_stiffness_n_per_m3", 2e4, &at).as_deref(),
            Some(cubic)
        );
        assert_eq!(
            told("period_m", 0.6, &at).as_deref(),
            Some("4.0 times the travel")
        );
        let channel = Location::Channel("y".into());
        assert_eq!(
            told("timing_s", 2e-4, &channel).as_deref(),
            Some("20\u{a0}% of the time between samples")
        );
        assert_eq!(told("amplitude_n", 3.0, &channel), None);
        assert_eq!(told("exponent", 2.0, &at), None);
    }

    #[test]
    fn verify_extremes_of_a_motion() {
        let motion = PlaceMotion {
            record: "a.csv".into(),
            at: Location::Channel("unused".into()),
            displacement: vec![0.0, -0.2, 0.1],
            velocity: vec![1.0, 0.0, -3.0],
        };
        let mut out = Surroundings {
            stiffness: 100.0,
            damping: 10.0,
            ..Surroundings::default()
        };
        move_along(&mut out, &motion);
        assert_eq!((out.largest_displacement, out.largest_velocity), (0.2, 3.0));
        assert!((out.travel - 0.3).abs() < 1e-15);
        // 100 · 0.1 − 10 · 3 = −20, and 100 · −0.2 = −20.
        assert!((out.largest_force - 20.0).abs() < 1e-12);
    }
}
