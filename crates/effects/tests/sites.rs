//! Where effects can sit, and what is said when one cannot.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::common::{self, MODEL, model};
use simgap_effects::{EffectError, Placed, SiteKind, catalogue, places_of, sites};
use simgap_model::{EffectEntry, Location, Model};

fn names(kind: SiteKind) -> Vec<String> {
    sites(&model(), kind)
        .iter()
        .map(Location::to_string)
        .collect()
}

#[test]
fn verify_sites_are_what_the_model_has() {
    let all = [
        "between carriage and ground",
        "between carriage and load",
        "between load and ground",
    ];
    assert_eq!(names(SiteKind::Member), all);
    assert_eq!(names(SiteKind::Spring), all[..2]);
    assert_eq!(names(SiteKind::Damper), all[1..]);
    assert_eq!(names(SiteKind::NoSpring), all[2..]);
    assert_eq!(names(SiteKind::NoDamper), all[..1]);
    assert_eq!(names(SiteKind::Mass), ["mass carriage", "mass load"]);
    assert_eq!(names(SiteKind::Pendulum), ["mass carriage"]);
    assert_eq!(names(SiteKind::Load), ["mass load"]);
    assert_eq!(names(SiteKind::Input), ["input u"]);
    assert_eq!(names(SiteKind::Channel), ["channel y"]);
}

#[test]
fn verify_a_free_mass_still_has_a_tie_to_the_ground() {
    let text = "schema = \"simgap-model/1\"\nname = \"axis\"\n\
        [[mass]]\nname = \"slide\"\nvalue = 95.0\n\
        [[output]]\nchannel = \"q\"\nkind = \"displacement\"\nat = \"slide\"\n";
    let axis = Model::from_toml(text).unwrap();
    for kind in [SiteKind::Member, SiteKind::NoSpring, SiteKind::NoDamper] {
        let found = sites(&axis, kind);
        assert_eq!(found.len(), 1, "{kind:?}");
        assert_eq!(found[0].to_string(), "between slide and ground");
    }
    assert!(sites(&axis, SiteKind::Spring).is_empty());
    assert!(sites(&axis, SiteKind::Input).is_empty());
}

#[test]
fn verify_a_member_the_model_lacks_may_join_what_nothing_joins() {
    let chain = Model::from_toml(
        "schema = \"simgap-model/1\"\nname = \"chain\"\n\
        [[mass]]\nname = \"a\"\nvalue = 1.0\n[[mass]]\nname = \"b\"\nvalue = 1.0\n\
        [[mass]]\nname = \"c\"\nvalue = 1.0\n\
        [[spring]]\nname = \"k0\"\nbetween = [\"base\", \"a\"]\nstiffness = 100.0\n\
        [[spring]]\nname = \"k1\"\nbetween = [\"a\", \"b\"]\nstiffness = 100.0\n\
        [[spring]]\nname = \"k2\"\nbetween = [\"b\", \"c\"]\nstiffness = 100.0\n\
        [[input]]\nchannel = \"z\"\nkind = \"displacement\"\nat = \"base\"\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"c\"\n",
    )
    .unwrap();
    let found: Vec<String> = sites(&chain, SiteKind::NoSpring)
        .iter()
        .map(Location::to_string)
        .collect();
    assert_eq!(
        found,
        [
            "between a and ground",
            "between b and ground",
            "between c and ground",
            "between a and c",
            "between b and base",
            "between c and base",
        ]
    );
    assert_eq!(sites(&chain, SiteKind::Member).len(), 6);
}

/// What is said of one `[[effect]]` at the end of the model file.
fn said(effect: &str) -> String {
    let text = format!("{MODEL}\n[[effect]]\n{effect}\n");
    let model = Model::from_toml(&text).unwrap_or_else(|error| panic!("{effect}: {error}"));
    match Placed::from_entry(&model, &model.effects[0]) {
        Ok(_) => panic!("{effect}: accepted"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn regress_messages() {
    let cases = [
        // A parameter is missing.
        "kind = \"coulomb_friction\"\nbetween = [\"load\", \"ground\"]",
        "kind = \"stribeck_friction\"\nbetween = [\"load\", \"ground\"]\nfriction_force_n = 1.0",
        "kind = \"clipping\"\nchannel = \"y\"",
        // A parameter the effect does not have.
        "kind = \"coulomb_friction\"\nbetween = [\"load\", \"ground\"]\nfriction_n = 1.0",
        // Outside the physical range, just and far.
        "kind = \"coulomb_friction\"\nbetween = [\"load\", \"ground\"]\nfriction_force_n = -1e-9",
        "kind = \"alternating_gain\"\nchannel = \"y\"\ngain_difference = 1.5\neven_share = 0.5",
        // The wrong kind of place.
        "kind = \"coulomb_friction\"\nmass = \"load\"\nfriction_force_n = 1.0",
        "kind = \"sensor_bias\"\ninput = \"u\"\nbias = 1.0",
        "kind = \"input_gain\"\nchannel = \"y\"\ngain_factor = 1.1",
        "kind = \"mass_error\"\nbetween = [\"load\", \"ground\"]\nmass_factor = 1.1",
    ];
    let messages: Vec<String> = cases.iter().map(|case| said(case)).collect();
    insta::assert_snapshot!(messages.join("\n"));
}

/// Model files of an earlier version lack values that have been added to a law: they mean the law as it was.
#[test]
fn verify_what_a_model_file_may_leave_out() {
    let read = |effect: &str| {
        let text = format!("{MODEL}\n[[effect]]\n{effect}\n");
        let model = Model::from_toml(&text).unwrap();
        Placed::from_entry(&model, &model.effects[0])
            .unwrap()
            .values
    };
    let at = "between = [\"load\", \"ground\"]";
    let found = read(&format!(
        "kind = \"end_stop\"\n{at}\nupper_stop_m = 0.1\nlower_stop_m = 0.2\ncontact_stiffness_n_per_m = 3e4"
    ));
    assert_eq!(found, [0.1, 0.2, 3e4, 0.0]);
    // A stop on one side, a sensor that saturates on one.
    let found = read(&format!(
        "kind = \"end_stop\"\n{at}\nlower_stop_m = 0.2\ncontact_stiffness_n_per_m = 3e4"
    ));
    assert_eq!(found, [f64::MAX, 0.2, 3e4, 0.0]);
    let found = read("kind = \"clipping\"\nchannel = \"y\"\nupper_level = 0.3");
    assert_eq!(found, [0.3, f64::MIN]);
    let found = read(&format!(
        "kind = \"bilinear_stiffness\"\n{at}\nstiffness_change_n_per_m = 50.0"
    ));
    assert_eq!(found, [50.0, 0.0, f64::MAX]);
    let at = "channel = \"y\"";
    for (kind, value) in [
        ("alternating_gain", "gain_difference = 0.1"),
        ("alternating_timing", "timing_s = 0.1"),
    ] {
        assert_eq!(
            read(&format!("kind = \"{kind}\"\n{at}\n{value}")),
            [0.1, 0.5]
        );
    }
    let found = read(&format!("kind = \"quantisation\"\n{at}\nstep = 0.1"));
    assert_eq!(found, [0.1, 0.0]);
}

#[test]
fn verify_an_unknown_kind_is_answered_with_the_catalogue() {
    let message = said("kind = \"gremlin\"\nmass = \"load\"");
    let start = "[[effect]] \"gremlin\": unknown kind, needed is one of: ";
    assert!(message.starts_with(start), "{message}");
    let known: Vec<&str> = message[start.len()..].split(", ").collect();
    let kinds: Vec<&str> = catalogue().iter().map(|effect| effect.kind()).collect();
    assert_eq!(known, kinds);
}

#[test]
fn verify_values_that_are_no_numbers_are_refused() {
    for &effect in catalogue() {
        let model = match effect.site() {
            SiteKind::Parameter => common::simulator(),
            _ => common::hydraulic(),
        };
        let at = sites(&model, effect.site()).swap_remove(0);
        let good = effect.starts(&common::scale()).swap_remove(0);
        for index in 0..good.len() {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut values = good.clone();
                values[index] = bad;
                let entry = Placed::new(effect, at.clone(), values).to_entry();
                let refused = Placed::from_entry(&model, &entry);
                assert!(
                    matches!(refused, Err(EffectError::OutOfRange { .. })),
                    "{}: {bad} was accepted",
                    effect.kind()
                );
            }
        }
    }
}

const BODY: &str = r#"
[[body]]
name = "table"
mass = 5.0
inertia = 2.0

[[point]]
name = "left"
body = "table"
offset = -0.5

[[beam]]
name = "leaf"
between = ["table.left", "load"]
length = 0.5
width = 0.05
thickness = 0.002
youngs_modulus = 2.1e11
density = 7850.0
"#;

#[test]
fn verify_points_of_bodies_are_places_and_modes_of_beams_are_none() {
    let model = Model::from_toml(&format!("{MODEL}{BODY}")).unwrap();
    let names = |kind: SiteKind| -> Vec<String> {
        sites(&model, kind)
            .iter()
            .map(ToString::to_string)
            .collect()
    };
    let members = names(SiteKind::Member);
    for place in [
        "table.left and load",
        "table.left and ground",
        "table.roll and ground",
    ] {
        assert!(
            members.contains(&format!("between {place}")),
            "{place} of {members:?}"
        );
    }
    let all = [SiteKind::Member, SiteKind::NoSpring, SiteKind::Mass]
        .map(&names)
        .concat();
    assert!(all.iter().all(|place| !place.contains("mode1")), "{all:?}");
    // What turns is not joined to what moves along, nor a body to its own points.
    let apart = names(SiteKind::NoDamper);
    for nonsense in [
        "table and table.roll",
        "table.roll and carriage",
        "table and table.left",
    ] {
        let [a, b] = [0, 1].map(|k| nonsense.split(" and ").nth(k).unwrap());
        let either = [
            format!("between {a} and {b}"),
            format!("between {b} and {a}"),
        ];
        assert!(
            !either.iter().any(|place| apart.contains(place)),
            "{nonsense}"
        );
    }
    // A point has no mass of its own that could be wrong.
    let entry = |kind: &str, value: (&str, f64)| EffectEntry {
        kind: kind.into(),
        at: Location::Mass("table.left".into()),
        parameters: [(value.0.to_string(), value.1)].into(),
    };
    assert!(Placed::from_entry(&model, &entry("mass_error", ("mass_factor", 1.1))).is_err());
    assert!(Placed::from_entry(&model, &entry("constant_force", ("force_n", 1.0))).is_ok());
}

#[test]
fn verify_hydraulic_effects_sit_on_cylinders_and_valves_alone() {
    let model = common::hydraulic();
    let place = |kind| sites(&model, kind)[0].to_string();
    assert_eq!(place(SiteKind::Chambers), "between drive.p1 and drive.p2");
    assert_eq!(place(SiteKind::Spool), "mass servo.spool");
    let plain = common::model();
    for kind in [SiteKind::Member, SiteKind::NoSpring, SiteKind::Mass] {
        assert_eq!(sites(&model, kind), sites(&plain, kind));
    }
}

fn refused(entry: &EffectEntry) -> String {
    match Placed::from_entry(&model(), entry) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn verify_a_place_that_is_not_in_the_model_is_refused() {
    let mut entry = Placed::new(
        common::effect("coulomb_friction"),
        Location::Between(["load".into(), "ceiling".into()]),
        vec![1.0],
    )
    .to_entry();
    assert!(refused(&entry).contains("ceiling"), "{}", refused(&entry));
    entry.at = Location::Between(["load".into(), "load".into()]);
    assert!(refused(&entry).contains("load"), "{}", refused(&entry));
}

/// A port takes forces and laws to the ground; what needs a mass there is refused.
#[test]
fn verify_ports_and_parameters_of_a_simulator_are_places() {
    let model = common::simulator();
    let of = |kind: &str| -> Vec<String> {
        let places = places_of(&model, common::effect(kind)).into_iter();
        places.map(|at| at.to_string()).collect()
    };
    for kind in [
        "coulomb_friction",
        "viscous_damping",
        "linear_stiffness",
        "end_stop",
    ] {
        assert_eq!(of(kind), ["between joint and ground"], "{kind}");
    }
    assert_eq!(of("constant_force"), ["mass joint"]);
    assert_eq!(of("parameter_error"), ["parameter inertia"]);
    assert_eq!(of("sensor_delay"), ["channel q"]);
    for kind in [
        "mass_error",
        "attached_mode",
        "flexible_support",
        "backlash",
        "stiffness_error",
    ] {
        assert_eq!(of(kind), [""; 0], "{kind}");
    }
    let entry = |kind: &str, value: &str| EffectEntry {
        kind: kind.into(),
        at: Location::Mass("joint".into()),
        parameters: [(value.to_string(), 1.0)].into(),
    };
    assert!(Placed::from_entry(&model, &entry("constant_force", "force_n")).is_ok());
    let refused = Placed::from_entry(&model, &entry("mass_error", "mass_factor"));
    assert!(matches!(refused, Err(EffectError::WrongPlace { .. })));
}
