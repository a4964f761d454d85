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
        "[[spring]]\nname = \"s\"\nbetween = [\"a\", \"base\"]\nstiffness = 0.1\n\
         [[input]]\nchannel = \"u\"\nkind = \"displacement\"\nat = \"base\"\ngain = 2.5\n\
         [[pendulum]]\nat = \"a\"\nvalue = 0.48\n[[load]]\nat = \"a\"\nvalue = -3.0\n\
         [[effect]]\nkind = \"coulomb_friction\"\nbetween = [\"a\", \"ground\"]\nfriction_force_n = 2100\n",
    );
    let model = Model::from_toml(&text).unwrap();
    assert_eq!(model.effects[0].parameters["friction_force_n"], 2100.0);
    assert_eq!(
        model.effects[0].at,
        Location::Between(["a".into(), "ground".into()])
    );
    let again = Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(model, again);
}
