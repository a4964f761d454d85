//! The model file: what is legal, what is refused and with which words.
#![allow(clippy::unwrap_used)]

use simgap_model::{Location, Model};

const HEAD: &str = "schema = \"simgap-model/1\"\nname = \"m\"\n";
const MASS: &str = "[[mass]]\nname = \"a\"\nvalue = 2.0\n";
const OUT: &str = "[[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"a\"\n";

fn refused(text: &str) -> String {
    Model::from_toml(text).unwrap_err().to_string()
}

fn with(extra: &str) -> String {
    format!("{HEAD}{MASS}{OUT}{extra}")
}

#[test]
fn regress_messages() {
    let cases = [
        ("not toml", "schema = ".to_string()),
        (
            "schema",
            "schema = \"simgap-model/9\"\nname = \"m\"\n".into(),
        ),
        (
            "unknown key",
            with("[[spring]]\nname = \"s\"\nbetween = [\"a\", \"ground\"]\nstifness = 1.0\n"),
        ),
        (
            "text for number",
            with("[[spring]]\nname = \"s\"\nbetween = [\"a\", \"ground\"]\nstiffness = \"big\"\n"),
        ),
        (
            "unknown node",
            with("[[spring]]\nname = \"s\"\nbetween = [\"a\", \"groud\"]\nstiffness = 1.0\n"),
        ),
        (
            "both ends",
            with("[[damper]]\nname = \"d\"\nbetween = [\"a\", \"a\"]\ndamping = 1.0\n"),
        ),
        ("duplicate mass", with(MASS)),
        (
            "duplicate spring",
            with("spring = []\n").replace(
                "spring = []\n",
                &"[[spring]]\nname = \"s\"\nbetween = [\"a\", \"ground\"]\nstiffness = 1.0\n"
                    .repeat(2),
            ),
        ),
        ("duplicate output", with(OUT)),
        (
            "negative mass",
            format!("{HEAD}[[mass]]\nname = \"a\"\nvalue = -2.0\n{OUT}"),
        ),
        (
            "ground moves",
            format!("{HEAD}[[mass]]\nname = \"ground\"\nvalue = 2.0\n{OUT}"),
        ),
        ("no output", format!("{HEAD}{MASS}")),
        (
            "output kind",
            with("[[output]]\nchannel = \"z\"\nkind = \"force\"\nat = \"a\"\n"),
        ),
        (
            "input at",
            with("[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"b\"\n"),
        ),
        (
            "input gain",
            with("[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"a\"\ngain = 0.0\n"),
        ),
        (
            "base is a mass",
            with("[[input]]\nchannel = \"u\"\nkind = \"displacement\"\nat = \"a\"\n"),
        ),
        (
            "uncertainty of zero",
            with("[[load]]\nat = \"a\"\nvalue = 1.0\nuncertainty = 0.0\n"),
        ),
        (
            "uncertainty in percent",
            with("[[pendulum]]\nat = \"a\"\nvalue = 1.0\nuncertainty = 20.0\n"),
        ),
        ("nan", with("[[load]]\nat = \"a\"\nvalue = nan\n")),
        (
            "effect without place",
            with("[[effect]]\nkind = \"coulomb_friction\"\nfriction_force_n = 3.0\n"),
        ),
        (
            "effect with two places",
            with("[[effect]]\nkind = \"x\"\nmass = \"a\"\nchannel = \"y\"\n"),
        ),
        (
            "effect channel",
            with("[[effect]]\nkind = \"sensor_bias\"\nchannel = \"z\"\nbias = 3.0\n"),
        ),
    ];
    let lines: Vec<String> = cases
        .iter()
        .map(|(name, text)| format!("{name}: {}", refused(text)))
        .collect();
    assert!(lines.iter().all(|line| !line.contains('\n')));
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn verify_legal_oddities() {
    // A mass without a spring, a free decay without inputs.
    Model::from_toml(&with("")).unwrap();
    // No mass at all: a damper driven by a prescribed displacement, its force measured.
    let damper = format!(
        "{HEAD}[[damper]]\nname = \"d\"\nbetween = [\"rod\", \"ground\"]\ndamping = 5.0\n\
         [[input]]\nchannel = \"x\"\nkind = \"displacement\"\nat = \"rod\"\n\
         [[output]]\nchannel = \"f\"\nkind = \"force\"\nbetween = [\"rod\", \"ground\"]\n"
    );
    assert_eq!(Model::from_toml(&damper).unwrap().dof_count(), 0);
}

#[test]
fn prop_text_round_trip() {
    let text = with(
        "[[spring]]\nname = \"s\"\nbetween = [\"a\", \"base\"]\nstiffness = 0.1\nuncertainty = 0.3\n\
         [[input]]\nchannel = \"u\"\nkind = \"displacement\"\nat = \"base\"\ngain = 2.5\nuncertainty = 0.05\n\
         [[pendulum]]\nat = \"a\"\nvalue = 0.48\nuncertainty = 0.1\n[[load]]\nat = \"a\"\nvalue = -3.0\n\
         [[effect]]\nkind = \"coulomb_friction\"\nbetween = [\"a\", \"ground\"]\nfriction_force_n = 2100\n",
    );
    let model = Model::from_toml(&text).unwrap();
    assert_eq!(model.effects[0].parameters["friction_force_n"], 2100.0);
    assert_eq!(
        model.effects[0].at,
        Location::Between(["a".into(), "ground".into()])
    );
    assert_eq!(model.springs[0].uncertainty, Some(0.3));
    assert_eq!(model.loads[0].uncertainty, None);
    let again = Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(model, again);
}

#[test]
fn verify_uncertainty_is_checked_in_every_table() {
    let tables = [
        "[[mass]]\nname = \"b\"\nvalue = 1.0",
        "[[spring]]\nname = \"s\"\nbetween = [\"a\", \"ground\"]\nstiffness = 1.0",
        "[[damper]]\nname = \"d\"\nbetween = [\"a\", \"ground\"]\ndamping = 1.0",
        "[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"a\"",
        "[[output]]\nchannel = \"z\"\nkind = \"velocity\"\nat = \"a\"",
        "[[load]]\nat = \"a\"\nvalue = 1.0",
        "[[pendulum]]\nat = \"a\"\nvalue = 1.0",
    ];
    for table in tables {
        let stated = |value: &str| with(&format!("{table}\nuncertainty = {value}\n"));
        for legal in ["1e-6", "0.02", "10.0"] {
            Model::from_toml(&stated(legal)).unwrap();
        }
        for wrong in ["0.0", "-0.1", "10.1", "nan", "inf"] {
            let line = refused(&stated(wrong));
            assert!(line.contains("uncertainty"), "{table}: {line}");
        }
    }
}
