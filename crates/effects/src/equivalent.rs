//! The same thing by another name.

use simgap_model::{InputKind, Location, Model, OutputKind, damped_modes};

use crate::{Action, Placed, same_place};

/// What cannot be told from an effect on a plant, whatever the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Equivalent {
    /// Catalogue name.
    pub kind: &'static str,
    /// Where it would act.
    pub at: Location,
    /// Why the two are the same.
    pub because: &'static str,
}

/// The effects of the catalogue that act on the outputs of this model exactly as `kind` at `at`.
///
/// | Effect | is also | where | because |
/// |---|---|---|---|
/// | `constant_force` | `sensor_bias`, `constant_force` on another mass | no pendulum, every mass held by springs, one displacement output; a `load_error` too | a constant force shifts the rest position |
/// | `constant_force` | `sensor_bias` | one mass with damper, without spring, one velocity output; a `load_error` too | a constant force shifts the final speed |
/// | `load_error` | `constant_force` on the same mass | every mass with a load | a load that is off by a factor is a further constant force |
/// | `input_gain` | `sensor_gain` | linear, one input, one output | the response is proportional to the input |
/// | `input_gain` | `mass_error` | one mass that nothing holds | only force over mass counts |
/// | `input_gain` | `damping_error`, `stiffness_error` | one member alone on a stand | only their product counts |
/// | `input_delay` | `sensor_delay` | one input, one output | no law of the plant knows the time |
/// | `input_lag` | `sensor_lag` | linear, one input, one output | linear elements in a row commute |
/// | `harmonic_force` | `tone_pickup` | linear, one output | the steady response is a tone |
/// | `presliding_friction` | `hysteresis` | the same place | Dahl's law is Bouc and Wen's with n = 1, γ = 0 |
/// | `end_stop` on one side, no harder than 4.5 times the spring beside it ([`equivalents_beside`]) | `bilinear_stiffness` | the same place | a soft stop is a spring that is stiffer beyond a point |
/// | `bilinear_stiffness` with one side three times as stiff as the other | `end_stop` | the same place | a soft stop is a spring that is stiffer beyond a point |
///
/// Each row holds in both directions but the last three, which need a law to take special values. The initial state is unknown to the diagnosis and explains transients.
///
/// ```
/// use simgap_effects::equivalents;
/// use simgap_model::{Location, Model};
/// let model = Model::from_toml(r#"
/// schema = "simgap-model/1"
/// name = "one mass"
/// [[mass]]
/// name = "table"
/// value = 2.0
/// [[spring]]
/// name = "leaf"
/// between = ["table", "ground"]
/// stiffness = 800.0
/// [[output]]
/// channel = "y"
/// kind = "displacement"
/// at = "table"
/// "#)?;
/// let same = equivalents("sensor_bias", &Location::Channel("y".into()), &model);
/// assert_eq!(same[0].kind, "constant_force");
/// # Ok::<(), simgap_model::ModelError>(())
/// ```
#[must_use]
pub fn equivalents(kind: &str, at: &Location, model: &Model) -> Vec<Equivalent> {
    let mut classes = vec![];
    // What is the same on a simulator, the records say.
    if !model.is_external() {
        classes.extend(loaded(model));
        classes.extend(rest_position(model));
        classes.extend(final_speed(model));
        classes.extend(proportional(model));
        classes.extend(late(model));
        classes.extend(commuting(model));
    }
    let mut found: Vec<Equivalent> = Vec::new();
    for (members, because) in classes {
        if !members.iter().any(|(k, a)| *k == kind && same_place(a, at)) {
            continue;
        }
        for (other, place) in members {
            let is_it = other == kind && same_place(&place, at);
            let mut known = found.iter();
            if is_it || known.any(|f| f.kind == other && same_place(&f.at, &place)) {
                continue;
            }
            found.push(Equivalent {
                kind: other,
                at: place,
                because,
            });
        }
    }
    if kind == "presliding_friction" {
        found.push(Equivalent {
            kind: "hysteresis",
            at: at.clone(),
            because: "Dahl's law is Bouc and Wen's with n = 1 and γ = 0",
        });
    }
    found
}

/// As [`equivalents`] of the i-th of several effects, on the plant as the others leave it: a missing spring
/// beside the effect holds the plant, a nonlinear force breaks every equivalence but that of delays.
#[must_use]
pub fn equivalents_beside(effects: &[Placed], i: usize, model: &Model) -> Vec<Equivalent> {
    let Some(placed) = effects.get(i) else {
        return vec![];
    };
    if model.is_external() {
        return equivalents(placed.effect.kind(), &placed.at, model);
    }
    let mut model = model.clone();
    let mut only_delays = false;
    for (j, other) in effects.iter().enumerate() {
        if j == i {
            continue;
        }
        match other.action() {
            Action::Model(change) => change(&mut model, &other.at),
            Action::Member(_) | Action::Mode { .. } => only_delays = true,
            Action::Force(_) => {
                only_delays |= !["constant_force", "harmonic_force"].contains(&other.effect.kind());
            }
            _ => {}
        }
    }
    let mut same = equivalents(placed.effect.kind(), &placed.at, &model);
    if only_delays {
        same.retain(|other| ["input_delay", "sensor_delay"].contains(&other.kind));
        return same;
    }
    same.extend(soft_stop(placed, &model));
    same.retain(|other| other.kind != "hysteresis" || !damps_before_sliding(placed, &model));
    same
}

/// Damping ratio of a mass on the stiffness before sliding from which on friction is not Dahl's.
const DAMPED: f64 = 0.03;

/// Whether a friction that gives before it slides has bristles with a damper: no loop of displacement alone does.
fn damps_before_sliding(placed: &Placed, model: &Model) -> bool {
    let (Location::Between(pair), [friction, displacement, damping_time, _]) =
        (&placed.at, &placed.values[..])
    else {
        return false;
    };
    let masses = model.masses.iter().filter(|m| pair.contains(&m.name));
    let lightest = masses.map(|mass| mass.value).min_by(f64::total_cmp);
    let own_time = lightest.map(|mass| (mass * displacement / friction).sqrt());
    own_time.is_some_and(|time| 0.5 * damping_time > DAMPED * time)
}

/// A contact stiffness above this multiple of that of the spring beside it is a stop, and no spring.
pub(crate) const SOFT: f64 = 3.0;
/// Within this factor of [`SOFT`] it may be called either.
const EITHER: f64 = 1.5;
/// Of two stops the one that is this many times as far away is not reached.
const UNREACHED: f64 = 5.0;

/// A stop on one side whose contact is about as soft as the spring of its place; a spring that is about as stiff as
/// a stop beyond a point.
fn soft_stop(placed: &Placed, model: &Model) -> Option<Equivalent> {
    let Location::Between(pair) = &placed.at else {
        return None;
    };
    let beside = model.springs.iter();
    let beside = beside.filter(|spring| simgap_model::same_pair(&spring.between, pair));
    let stiffness: f64 = beside.map(|spring| spring.stiffness).sum();
    let kind = match (placed.effect.kind(), &placed.values[..]) {
        ("end_stop", [upper, lower, contact, _]) => {
            let on_one_side = upper.max(*lower) > UNREACHED * upper.min(*lower);
            let is_soft = *contact <= EITHER * SOFT * stiffness;
            (on_one_side && is_soft).then_some("bilinear_stiffness")?
        }
        ("bilinear_stiffness", [change, ..]) => {
            let sides = [stiffness, stiffness + change];
            let (soft, stiff) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
            (stiff - soft >= SOFT / EITHER * soft).then_some("end_stop")?
        }
        _ => return None,
    };
    Some(Equivalent {
        kind,
        at: placed.at.clone(),
        because: "a soft stop is a spring that is stiffer beyond a point",
    })
}

/// Multiple of the highest natural frequency above which a plant hardly answers a force.
const BEYOND_THE_PLANT: f64 = 2.0;
/// Mains, and how far off they may be.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
const MAINS_OFF: f64 = 0.005;

/// Which of the two a line is likelier to be where a harmonic force and a tone picked up by the only sensor do the same:
/// a tone at the frequency of mains or far above the modes of the plant, which would have to be shaken by a large force
/// to answer there, and a force below. `None` for other effects, and on a plant that does not vibrate.
#[must_use]
pub fn likelier_line(placed: &Placed, model: &Model) -> Option<&'static str> {
    let kinds = ["harmonic_force", "tone_pickup"];
    if !kinds.contains(&placed.effect.kind()) {
        return None;
    }
    let mut named = placed.effect.parameters().iter().zip(&placed.values);
    let (_, &frequency) = named.find(|(parameter, _)| parameter.name == "frequency_hz")?;
    let modes = damped_modes(&model.tangent_matrices().ok()?).ok()?;
    let highest = modes
        .iter()
        .map(|mode| mode.natural_freq_hz)
        .fold(0.0, f64::max);
    let is_mains = |mains: f64| (frequency / mains - 1.0).abs() < MAINS_OFF;
    if MAINS_HZ.into_iter().any(is_mains) {
        return Some("tone_pickup");
    }
    let is_tone = frequency > BEYOND_THE_PLANT * highest;
    (highest > 0.0).then(|| kinds[usize::from(is_tone)])
}

/// Effects that do the same, and why.
type Class = (Vec<(&'static str, Location)>, &'static str);

fn linear(model: &Model) -> bool {
    superposes(model) && model.loads.is_empty()
}

/// Whether the motion under two forces is the sum of those under each.
fn superposes(model: &Model) -> bool {
    model.pendulums.is_empty() && model.effects.is_empty()
}

/// A constant force on every mass, and what is one.
fn forces(model: &Model) -> Vec<(&'static str, Location)> {
    let at = |mass: &simgap_model::Mass| ("constant_force", Location::Mass(mass.name.clone()));
    let mut forces: Vec<_> = model.masses.iter().map(at).collect();
    forces.extend(load_errors(model));
    forces
}

/// Masses whose loads do not cancel.
fn load_errors(model: &Model) -> Vec<(&'static str, Location)> {
    let each = model.masses.iter().zip(model.load_vector());
    each.filter(|(_, load)| *load != 0.0)
        .map(|(mass, _)| ("load_error", Location::Mass(mass.name.clone())))
        .collect()
}

fn loaded(model: &Model) -> Vec<Class> {
    let because = "a load that is off by a factor is a further constant force";
    let with_force = |error: (&'static str, Location)| {
        let force = ("constant_force", error.1.clone());
        (vec![error, force], because)
    };
    load_errors(model).into_iter().map(with_force).collect()
}

fn rest_position(model: &Model) -> Option<Class> {
    let held = model
        .static_deflection(&vec![1.0; model.dof_count()])
        .is_ok();
    let mut displacements = model
        .outputs
        .iter()
        .filter(|output| output.kind == OutputKind::Displacement);
    let (Some(only), None) = (displacements.next(), displacements.next()) else {
        return None;
    };
    if !(held && superposes(model) && model.dof_count() > 0) {
        return None;
    }
    let mut members = forces(model);
    members.push(("sensor_bias", Location::Channel(only.channel.clone())));
    let because =
        "a constant force shifts the rest position, and only one displacement is measured";
    Some((members, because))
}

fn final_speed(model: &Model) -> Option<Class> {
    let [only] = model.outputs.as_slice() else {
        return None;
    };
    let free = model.springs.is_empty() && !model.dampers.is_empty();
    if !(superposes(model) && free && model.dof_count() == 1 && only.kind == OutputKind::Velocity) {
        return None;
    }
    let mut members = forces(model);
    members.push(("sensor_bias", Location::Channel(only.channel.clone())));
    Some((members, "a constant force shifts the final speed"))
}

fn proportional(model: &Model) -> Option<Class> {
    let ([input], [output]) = (model.inputs.as_slice(), model.outputs.as_slice()) else {
        return None;
    };
    if !linear(model) {
        return None;
    }
    let mut members = vec![
        ("input_gain", Location::Input(input.channel.clone())),
        ("sensor_gain", Location::Channel(output.channel.clone())),
    ];
    if let ([mass], [], []) = (
        model.masses.as_slice(),
        model.springs.as_slice(),
        model.dampers.as_slice(),
    ) {
        members.push(("mass_error", Location::Mass(mass.name.clone())));
    }
    if model.masses.is_empty() && input.kind == InputKind::Displacement {
        match (model.springs.as_slice(), model.dampers.as_slice()) {
            ([], [damper]) => {
                members.push(("damping_error", Location::Between(damper.between.clone())));
            }
            ([spring], []) => {
                members.push(("stiffness_error", Location::Between(spring.between.clone())));
            }
            _ => {}
        }
    }
    let because = "the response is proportional to the input, and there is one of each";
    Some((members, because))
}

fn late(model: &Model) -> Option<Class> {
    let ([input], [output]) = (model.inputs.as_slice(), model.outputs.as_slice()) else {
        return None;
    };
    let members = vec![
        ("input_delay", Location::Input(input.channel.clone())),
        ("sensor_delay", Location::Channel(output.channel.clone())),
    ];
    let because =
        "a plant that is driven later answers later, and there is one input and one output";
    Some((members, because))
}

fn commuting(model: &Model) -> Vec<Class> {
    let [output] = model.outputs.as_slice() else {
        return vec![];
    };
    if !linear(model) {
        return vec![];
    }
    let sensor = || Location::Channel(output.channel.clone());
    let mut classes = vec![];
    if let [input] = model.inputs.as_slice() {
        let input = Location::Input(input.channel.clone());
        classes.push((
            vec![("input_lag", input), ("sensor_lag", sensor())],
            "linear elements in a row commute, and there is one input and one output",
        ));
    }
    if model.dof_count() > 0 {
        let mut tones = vec![("tone_pickup", sensor())];
        for mass in &model.masses {
            tones.push(("harmonic_force", Location::Mass(mass.name.clone())));
        }
        classes.push((
            tones,
            "the steady response to a harmonic force is a tone, and there is one output",
        ));
    }
    classes
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::find;

    #[test]
    fn a_line_far_above_the_modes_or_at_mains_is_a_tone() {
        // One mode at 20 Hz.
        let text = "schema = \"simgap-model/1\"\nname = \"table\"\n\
            [[mass]]\nname = \"table\"\nvalue = 1.0\n\
            [[spring]]\nname = \"leaf\"\nbetween = [\"table\", \"ground\"]\nstiffness = 15791.0\n\
            [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"table\"\n";
        let model = Model::from_toml(text).unwrap();
        let force = |frequency_hz: f64| {
            let effect = find("harmonic_force").unwrap();
            let at = Location::Mass("table".into());
            likelier_line(
                &Placed::new(effect, at, vec![1.0, frequency_hz, 0.0]),
                &model,
            )
        };
        assert_eq!(force(13.0), Some("harmonic_force"));
        assert_eq!(force(31.0), Some("harmonic_force"));
        assert_eq!(force(45.0), Some("tone_pickup"));
        assert_eq!(force(50.1), Some("tone_pickup"));
        let mut axis = model.clone();
        axis.springs.clear();
        let drive = Placed::new(
            find("harmonic_force").unwrap(),
            Location::Mass("table".into()),
            vec![1.0, 13.0, 0.0],
        );
        assert_eq!(
            likelier_line(&drive, &axis),
            None,
            "a free mass has no modes"
        );
        let bias = Placed::new(
            find("sensor_bias").unwrap(),
            Location::Channel("y".into()),
            vec![1.0],
        );
        assert_eq!(likelier_line(&bias, &model), None);
    }
}
