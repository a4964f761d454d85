//! What holds for every entry of the catalogue, whatever it is: a new effect is tested here from
//! the moment it is listed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;

use crate::common::{self, force, hydraulic, model, model_at, scale, simulator};
use simgap_effects::{
    Action, Effect, Family, Parameter, Placed, Sampled, SiteKind, SiteScale, catalogue, sites,
};
use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_model::{Location, Model};

/// What an action does to the plant or to a signal of this sampling interval, as numbers that can be compared.
fn trace(action: &Action, at: &Location, time_step_s: f64) -> Vec<f64> {
    match action {
        Action::Model(change) | Action::Mode { change, .. } => {
            let mut model = model_at(at);
            change(&mut model, at);
            matrix_entries(&model)
        }
        Action::Member(build) => trace(&Action::Force(build(&model_at(at), at)), at, time_step_s),
        Action::Force(law) => {
            let mut trace = Vec::new();
            for displacement in [-0.011, -0.001, 0.0, 0.0045] {
                for velocity in [-0.05, -0.002, 0.0, 0.001, 0.04] {
                    trace.push(if law.remembers() {
                        moved(law.as_ref(), displacement)
                    } else {
                        force(law.as_ref(), displacement, velocity)
                    });
                    trace.push(law.dry_level(f64::abs(velocity)).unwrap_or(0.0));
                }
            }
            trace
        }
        Action::Input(map) | Action::Output(map) | Action::Sampling(map) => {
            let (values, measured) = (signal(), measured());
            map.apply(Sampled {
                measured: Some(&measured),
                ..Sampled::from_start(&values, time_step_s)
            })
        }
    }
}

/// The force of a law with memory after a move from zero.
fn moved(law: &dyn ForceLaw, displacement: f64) -> f64 {
    let from = MemberMotion::default();
    let to = MemberMotion {
        displacement,
        ..from
    };
    law.follow(law.first_memory(), from, to).force
}

/// The same without the effect.
fn untouched(action: &Action, at: &Location) -> Vec<f64> {
    match action {
        Action::Model(_) | Action::Mode { .. } => matrix_entries(&model_at(at)),
        Action::Force(_) | Action::Member(_) => vec![0.0; 40],
        Action::Input(_) | Action::Output(_) | Action::Sampling(_) => signal(),
    }
}

fn matrix_entries(model: &Model) -> Vec<f64> {
    let matrices = model.tangent_matrices().unwrap();
    let n = model.dof_count();
    let mut entries = model.load_vector();
    entries.extend(model.plant_parameters.iter().map(|one| one.value));
    for matrix in [
        &matrices.mass_matrix,
        &matrices.damping_matrix,
        &matrices.stiffness_matrix,
    ] {
        entries.extend((0..n).flat_map(|i| (0..n).map(move |j| matrix[(i, j)])));
    }
    // What of a valve is no entry of a matrix.
    for valve in &model.elements.valves {
        for spool in [-0.5, -0.01, 0.004, 0.3] {
            entries.extend([0, 1].map(|chamber| valve.flow(chamber, spool, 4e6)));
        }
    }
    entries
}

fn signal() -> Vec<f64> {
    (0..60).map(|i| 0.3 + (0.4 * f64::from(i)).sin()).collect()
}

/// The same as measured by a chain that loses samples and has spikes.
fn measured() -> Vec<f64> {
    let mut measured = signal();
    measured[15] += 9.0;
    let held = measured[30];
    measured[30..34].fill(held);
    measured
}

fn first_site(effect: &dyn Effect) -> Location {
    let model = match effect.site() {
        site if site.is_hydraulic() => hydraulic(),
        SiteKind::Parameter => simulator(),
        _ => model(),
    };
    sites(&model, effect.site())
        .into_iter()
        .next()
        .unwrap_or_else(|| panic!("{}: no site of {:?}", effect.kind(), effect.site()))
}

/// Neutral where there is a neutral value, else what the first start says.
fn neutral(effect: &dyn Effect) -> Vec<f64> {
    let shape = effect.starts(&scale()).swap_remove(0);
    let parameters = effect.parameters().iter();
    parameters
        .zip(shape)
        .map(|(parameter, start)| parameter.neutral.unwrap_or(start))
        .collect()
}

fn snake_case(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && !name.ends_with('_')
        && !name.contains("__")
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

#[test]
fn verify_kinds_are_unique_and_snake_case() {
    let mut seen = BTreeSet::new();
    for effect in catalogue() {
        let kind = effect.kind();
        assert!(snake_case(kind), "{kind}");
        assert!(seen.insert(kind), "{kind} is listed twice");
        assert_eq!(simgap_effects::find(kind).unwrap().kind(), kind);
    }
    assert!(simgap_effects::find("Coulomb_friction").is_none());
}

#[test]
fn verify_the_kinds_of_the_contract_that_are_here_keep_their_names() {
    // Names in files of users: more may be added, none renamed.
    let promised = [
        "mass_error",
        "stiffness_error",
        "damping_error",
        "input_gain",
        "viscous_damping",
        "linear_stiffness",
        "coulomb_friction",
        "stribeck_friction",
        "quadratic_damping",
        "cubic_stiffness",
        "quadratic_stiffness",
        "constant_force",
        "sensor_bias",
        "sensor_gain",
        "sensor_drift",
        "sensor_delay",
        "sensor_lag",
        "clipping",
        "quantisation",
        "alternating_timing",
        "alternating_gain",
        "tone_pickup",
        "dropouts",
        "outliers",
        "clock_skew",
        "asymmetric_damping",
        "backlash",
        "bilinear_stiffness",
        "end_stop",
        "force_limit",
        "presliding_friction",
        "hysteresis",
        "harmonic_force",
        "position_periodic_force",
        "time_varying_stiffness",
        "attached_mode",
        "flexible_support",
        "input_lag",
        "input_delay",
        "pendulum_error",
        "load_error",
        "parameter_error",
        "input_dead_zone",
        "input_saturation",
        "input_rate_limit",
        "held_input",
        "synchronous_force",
        "synchronous_tone",
        "gain_ripple",
        "internal_leakage",
        "external_leakage",
        "bulk_modulus",
        "valve_dead_band",
        "valve_asymmetry",
        "spool_lag",
        "supply_sag",
    ];
    for kind in promised {
        assert!(simgap_effects::find(kind).is_some(), "{kind} is gone");
    }
}

/// `N s^2/m^2` as the end of a name: `n_s2_per_m2`.
fn suffix_of(unit: &str) -> String {
    unit.to_lowercase()
        .replace('^', "")
        .replace('/', "_per_")
        .replace(' ', "_")
}

#[test]
fn verify_parameter_names_carry_their_unit() {
    assert_eq!(suffix_of("N s^2/m^2"), "n_s2_per_m2");
    for effect in catalogue() {
        let mut seen = BTreeSet::new();
        for Parameter { name, unit, .. } in effect.parameters() {
            let place = format!("{}: {name} [{unit}]", effect.kind());
            assert!(snake_case(name), "{place}");
            assert!(seen.insert(name), "{place} is there twice");
            // A ratio has no unit, and what acts on a channel has that of the channel; a rate of it is per
            // second.
            let own = unit.trim_start_matches("unit of the output");
            let own = own.trim_start_matches("unit of the input");
            if !["1", ""].contains(&own) {
                let suffix = format!("_{}", suffix_of(own).trim_start_matches('_'));
                assert!(name.ends_with(&suffix), "{place}: needed is {suffix}");
            }
        }
        assert!(!seen.is_empty(), "{} has no parameter", effect.kind());
    }
}

#[test]
fn verify_ranges_hold_the_neutral_value() {
    for effect in catalogue() {
        let mut vanishes = false;
        for parameter in effect.parameters() {
            let place = format!("{}: {}", effect.kind(), parameter.name);
            assert!(parameter.lower < parameter.upper, "{place}");
            if let Some(neutral) = parameter.neutral {
                let range = parameter.lower..=parameter.upper;
                assert!(range.contains(&neutral), "{place}");
                vanishes = true;
            }
        }
        assert!(vanishes, "{} has no neutral value", effect.kind());
    }
}

#[test]
fn verify_neutral_values_change_nothing() {
    for effect in catalogue() {
        let action = effect.action(&neutral(*effect));
        let at = first_site(*effect);
        assert_eq!(
            trace(&action, &at, scale().time_step_s),
            untouched(&action, &at),
            "{} at its neutral value",
            effect.kind()
        );
    }
}

#[test]
fn verify_starts_are_inside_the_range_and_visible() {
    let small = SiteScale {
        signal: 1e-6,
        signal_range: [-1e-6, 2e-6],
        signal_step: 1e-8,
        time_step_s: 1e-5,
        duration_s: 0.5,
        lines_hz: [700.0, 0.0, 0.0, 0.0],
        motion_hz: [90.0, 0.0, 0.0, 0.0],
        ..SiteScale::plain(1e-6, 1e-4, 1e-2)
    };
    for effect in catalogue() {
        let kind = effect.kind();
        for scale in [scale(), small] {
            let starts = effect.starts(&scale);
            assert!(!starts.is_empty(), "{kind} has no start");
            for start in starts {
                assert_eq!(start.len(), effect.parameters().len(), "{kind}");
                for (parameter, value) in effect.parameters().iter().zip(&start) {
                    let inside = (parameter.lower..=parameter.upper).contains(value);
                    let place = format!("{kind}: {} starts at {value}", parameter.name);
                    assert!(value.is_finite() && inside, "{place}");
                    // A hidden state may well begin at rest.
                    if !parameter.per_record {
                        assert_ne!(parameter.neutral, Some(*value), "{place}, which is neutral");
                    }
                }
                let action = effect.action(&start);
                assert_ne!(
                    trace(&action, &first_site(*effect), scale.time_step_s),
                    untouched(&action, &first_site(*effect)),
                    "{kind} at {start:?} does nothing"
                );
            }
        }
    }
}

#[test]
fn verify_families_act_where_they_belong() {
    for effect in catalogue() {
        let action = effect.action(&neutral(*effect));
        let fits = match effect.family() {
            Family::NominalParameter => matches!(action, Action::Model(_) | Action::Input(_)),
            Family::Force | Family::Dynamics => {
                !matches!(action, Action::Output(_) | Action::Sampling(_))
            }
            Family::Measurement => matches!(
                action,
                Action::Input(_) | Action::Output(_) | Action::Sampling(_)
            ),
        };
        assert!(fits, "{} of {:?}", effect.kind(), effect.family());
        let place = effect.site().place();
        let fits = match action {
            Action::Input(_) => place.starts_with("input"),
            Action::Output(_) | Action::Sampling(_) => place.starts_with("channel"),
            Action::Force(_) | Action::Model(_) | Action::Mode { .. } | Action::Member(_) => {
                ["between", "mass", "parameter"]
                    .iter()
                    .any(|word| place.starts_with(word))
            }
        };
        assert!(fits, "{} is placed by {place}", effect.kind());
    }
}

#[test]
fn verify_physical_values_stay_and_others_are_moved_inside() {
    for effect in catalogue() {
        let kind = effect.kind();
        for start in effect.starts(&scale()) {
            let mut values = start.clone();
            effect.make_physical(&mut values);
            assert_eq!(values, start, "{kind}");
        }
        let mut values = neutral(*effect);
        effect.make_physical(&mut values);
        assert_eq!(values, neutral(*effect), "{kind}");
        for outside in [-1e300, 1e300] {
            let mut values = vec![outside; effect.parameters().len()];
            effect.make_physical(&mut values);
            for (parameter, value) in effect.parameters().iter().zip(&values) {
                let range = parameter.lower..=parameter.upper;
                assert!(range.contains(value), "{kind}: {} {value}", parameter.name);
            }
            let again = values.clone();
            effect.make_physical(&mut values);
            assert_eq!(values, again, "{kind}: moved twice");
        }
    }
}

#[test]
fn verify_special_cases_are_in_the_catalogue_at_the_same_places() {
    let model = Model::from_toml(common::MODEL).unwrap();
    for effect in catalogue() {
        for special in effect.contains() {
            let place = format!("{} contains {special}", effect.kind());
            let special = simgap_effects::find(special).unwrap_or_else(|| panic!("{place}"));
            assert_ne!(special.kind(), effect.kind(), "{place}");
            let wide = simgap_effects::sites(&model, effect.site());
            let narrow = simgap_effects::sites(&model, special.site());
            assert!(!narrow.is_empty(), "{place}: nowhere");
            assert!(narrow.iter().all(|at| wide.contains(at)), "{place}");
            assert!(
                special.contains().is_empty(),
                "{place}, which contains more"
            );
            let fitted = special.starts(&scale()).swap_remove(0);
            let grown = effect.grown_from(special.kind(), &fitted, &scale());
            assert!(!grown.is_empty(), "{place}: nothing grows out of it");
            for values in grown {
                assert_eq!(values.len(), effect.parameters().len(), "{place}");
                let mut physical = values.clone();
                effect.make_physical(&mut physical);
                assert_eq!(physical, values, "{place}");
                let shrunk = effect.shrunk_to(special.kind(), &values, &scale());
                let count = special.parameters().len();
                assert!(shrunk.is_none_or(|small| small.len() == count), "{place}");
            }
        }
    }
}

#[test]
fn verify_what_dynamics_turn_into_lets_them_grow_at_the_same_place() {
    // Every member to the ground as well.
    let damper =
        "[[damper]]\nname = \"drive\"\nbetween = [\"carriage\", \"ground\"]\ndamping = 9.0\n";
    let model = Model::from_toml(&format!("{}\n{damper}", common::MODEL)).unwrap();
    let mut count = 0;
    for effect in catalogue() {
        for limit in effect.turns_into() {
            let pair = format!("{} turns into {limit}", effect.kind());
            let limit = simgap_effects::find(limit).unwrap_or_else(|| panic!("{pair}"));
            let at = sites(&model, effect.site());
            let places = sites(&model, limit.site());
            let (few, many) = match at.len() <= places.len() {
                true => (&at, &places),
                false => (&places, &at),
            };
            assert!(few.iter().all(|at| many.contains(at)), "{pair}");
            // Some values are in reach, others are not: a smaller or a larger factor, a negative stiffness.
            let values = [-1.25, 0.8, 1.25];
            let grown = values.map(|value| effect.grown_from(limit.kind(), &[value], &scale()));
            assert!(grown.iter().any(Vec::is_empty), "{pair}");
            assert!(grown.iter().any(|grown| !grown.is_empty()), "{pair}");
            for values in grown.concat() {
                let mut physical = values.clone();
                effect.make_physical(&mut physical);
                assert_eq!(physical, values, "{pair}");
                count += 1;
            }
        }
    }
    assert!(count > 0);
}

/// Far below where it yields, a law that yields carries what the spring carries that it turns into.
#[test]
fn verify_a_law_that_yields_turns_into_a_spring() {
    let mut count = 0;
    for effect in catalogue() {
        if !effect.turns_into().contains(&"linear_stiffness") {
            continue;
        }
        for mut values in effect.starts(&scale()) {
            // A thousand times further, and with it the friction it yields at; rates have died away.
            values[1] *= 1e3;
            let spring = effect.shrunk_to("linear_stiffness", &values, &scale());
            let stiffness = spring.unwrap()[0];
            let Action::Force(law) = effect.action(&values) else {
                panic!("{} is no force", effect.kind());
            };
            let to = MemberMotion {
                displacement: 0.1 * scale().displacement_m,
                ..MemberMotion::default()
            };
            let carried = law.follow(law.first_memory(), MemberMotion::default(), to);
            let share = carried.force / (stiffness * to.displacement);
            assert!((share - 1.0).abs() < 0.01, "{}: {share}", effect.kind());
            count += 1;
        }
    }
    assert!(count > 0);
}

#[test]
fn verify_every_kind_has_sites_and_survives_a_model_file() {
    for &effect in catalogue() {
        let model = match effect.site() {
            SiteKind::Parameter => simulator(),
            _ => hydraulic(),
        };
        let places = sites(&model, effect.site());
        assert!(!places.is_empty(), "{} has no site", effect.kind());
        for at in places {
            for values in effect.starts(&scale()) {
                let placed = Placed::new(effect, at.clone(), values);
                let mut written = model.clone();
                written.effects.push(placed.to_entry());
                let read = Model::from_toml(&written.to_toml().unwrap()).unwrap();
                let back = Placed::from_entry(&read, &read.effects[0]).unwrap();
                assert_eq!(back.effect.kind(), effect.kind());
                assert_eq!(back.at, placed.at, "{}", effect.kind());
                assert_eq!(back.values, placed.values, "{}", effect.kind());
            }
        }
    }
}

#[test]
fn verify_texts_can_be_put_into_sentences() {
    for effect in catalogue() {
        for text in [effect.summary(), effect.experiment()] {
            let place = format!("{}: \"{text}\"", effect.kind());
            assert!(text.len() > 20, "{place} says too little");
            assert!(!text.ends_with('.'), "{place} ends with a full stop");
            assert!(!text.starts_with(char::is_uppercase), "{place}");
        }
        assert!(effect.equation().contains('='), "{}", effect.kind());
    }
}

/// A source is a key of the page of references, and then perhaps the place there.
#[test]
fn verify_sources_are_listed_on_the_page_of_references() {
    let page = include_str!("../../../docs/references.md").to_lowercase();
    let mut sourced = 0;
    for effect in catalogue() {
        let Some(reference) = effect.reference() else {
            continue;
        };
        let key = reference
            .strip_prefix('[')
            .and_then(|r| r.split(']').next());
        let key = key
            .expect("a source begins with its key in brackets")
            .to_lowercase();
        let line = format!("- `{key}`:");
        assert!(
            page.contains(&line),
            "{}: {line} is not listed",
            effect.kind()
        );
        sourced += 1;
    }
    assert!(sourced > 10, "only {sourced} kinds name a source");
}

/// A mass on a spring whose ground gives way has the modes of the mass on a softer spring with a hidden one.
#[test]
fn verify_what_resembles_each_other_has_the_same_modes() {
    let text = "schema = \"simgap-model/1\"\nname = \"one mass\"\n[[mass]]\nname = \"table\"\nvalue = 3.0\n\
                [[spring]]\nname = \"leg\"\nbetween = [\"table\", \"ground\"]\nstiffness = 4000.0\n\
                [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"table\"\n";
    let model = Model::from_toml(text).unwrap();
    let sizes = SiteScale {
        stiffness_n_per_m: 4000.0,
        ..scale()
    };
    let (mut hidden, mut support) = (model.clone(), model);
    let of_support = [60_000.0, 1.7, 0.04, 0.0, 0.0];
    let find = |kind: &str| simgap_effects::find(kind).unwrap();
    let [mode, leg] = [find("attached_mode"), find("flexible_support")];
    let of_mode = mode.grown_from(leg.kind(), &of_support, &sizes).concat();
    let back = leg.grown_from(mode.kind(), &of_mode, &sizes).concat();
    for (value, other) in of_support.iter().zip(&back) {
        assert!((value - other).abs() <= 1e-12 * value.abs(), "{back:?}");
    }
    // What the hidden mass brings in stiffness, the spring loses.
    let omega = std::f64::consts::TAU * of_mode[1];
    hidden.springs[0].stiffness -= of_mode[0] * omega * omega;
    let table = Location::Mass("table".into());
    let to_ground = Location::Between(["table".into(), "ground".into()]);
    for (effect, values, model, at) in [
        (mode, &of_mode[..], &mut hidden, &table),
        (leg, &of_support[..], &mut support, &to_ground),
    ] {
        let Action::Mode { change, .. } = effect.action(values) else {
            panic!("{} adds a mass", effect.kind());
        };
        change(model, at);
    }
    let modes = |model: &Model| {
        let modes = simgap_model::undamped_modes(&model.matrices().unwrap()).unwrap();
        modes.natural_freq_hz
    };
    for (one, other) in modes(&hidden).iter().zip(modes(&support)) {
        assert!((one - other).abs() < 1e-9 * other, "{one} {other}");
    }
}
