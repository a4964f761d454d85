//! Laws of the user's as effects: what is refused, what follows from the text, where they sit.
#![allow(clippy::unwrap_used, clippy::panic)]

use simgap_effects::{
    Placed, Prior, SiteScale, catalogue, catalogue_of, find_in, find_of, own_laws, places_of,
};
use simgap_model::{EffectEntry, Law, LawParameter, Location, Model};

const MODEL: &str = r#"schema = "simgap-model/1"
name = "m"
[[mass]]
name = "slide"
value = 2.0
[[mass]]
name = "arm"
value = 1.0
[[spring]]
name = "k"
between = ["slide", "ground"]
stiffness = 1000.0
[[spring]]
name = "l"
between = ["arm", "slide"]
stiffness = 1000.0
[[output]]
channel = "y"
kind = "displacement"
at = "slide"
"#;

fn law(name: &str, force: &str, parameters: Vec<LawParameter>) -> Law {
    Law {
        name: name.into(),
        summary: Some("drag of cold grease".into()),
        between: vec![],
        force: force.into(),
        parameters,
    }
}

fn with(laws: Vec<Law>) -> Model {
    let mut model = Model::from_toml(MODEL).unwrap();
    model.laws = laws;
    model.check().unwrap();
    model
}

fn grease() -> Law {
    let parameters = vec![
        LawParameter::of_size("c", "N", 20.0),
        LawParameter {
            name: "v0".into(),
            unit: "m/s".into(),
            value: Some(0.05),
            uncertainty: Some(0.2),
            ..LawParameter::default()
        },
        LawParameter {
            name: "k".into(),
            unit: "1/m^2".into(),
            lower: Some(0.0),
            upper: Some(1e5),
            ..LawParameter::default()
        },
    ];
    law("grease", "c * tanh(v / v0) * (1 + k * d^2)", parameters)
}

#[test]
fn verify_a_law_is_an_effect_of_its_model() {
    let model = with(vec![grease()]);
    assert_eq!(catalogue_of(&model).len(), catalogue().len() + 1);
    let effect = find_of(&model, "grease").unwrap();
    assert!(find_of(&with(vec![]), "grease").is_none());
    // The same law, of whatever model, is the same effect.
    let again = find_of(&with(vec![grease()]), "grease").unwrap();
    assert!(std::ptr::eq(effect.parameters(), again.parameters()));
    assert_eq!(effect.summary(), "drag of cold grease");
    assert_eq!(effect.equation(), "F = c * tanh(v / v0) * (1 + k * d^2)");
    let neutral: Vec<Option<f64>> = effect.parameters().iter().map(|p| p.neutral).collect();
    assert_eq!(neutral, [Some(0.0), None, None]);
    let scale = SiteScale::plain(0.01, 0.1, 100.0);
    assert_eq!(effect.prior(0, &scale), Prior::size(20.0));
    assert_eq!(
        effect.prior(1, &scale),
        Prior::Normal {
            mean: 0.05,
            std: 0.2 * 0.05
        }
    );
    assert_eq!(effect.prior(2, &scale), Prior::Uniform { width: 1e5 });
    // The usual shape, and two more for each of the two shapes.
    let starts = effect.starts(&scale);
    assert_eq!(starts.len(), 5);
    assert_eq!(starts[0][1..], [0.05, 5e4]);
    for values in &starts {
        assert!(
            values[0] > 0.0 && values.iter().all(|v| v.is_finite()),
            "{values:?}"
        );
    }
    // A twentieth of the typical force at the largest.
    let largest = starts[0][0] * (0.14_f64 / 0.05).tanh() * (1.0 + 5e4 * 0.014_f64.powi(2));
    assert!((largest - 5.0).abs() < 1e-9, "{largest}");
}

#[test]
fn verify_a_law_sits_where_it_is_stated() {
    let model = with(vec![grease()]);
    let effect = find_of(&model, "grease").unwrap();
    let friction = find_of(&model, "coulomb_friction").unwrap();
    assert_eq!(places_of(&model, effect), places_of(&model, friction));
    let pair = ["slide".to_string(), "ground".to_string()];
    let stated = with(vec![Law {
        between: vec![pair.clone()],
        ..grease()
    }]);
    let effect = find_of(&stated, "grease").unwrap();
    assert_eq!(
        places_of(&stated, effect),
        [Location::Between(pair.clone())]
    );
    let entry = |a: &str, b: &str| EffectEntry {
        kind: "grease".into(),
        at: Location::Between([a.into(), b.into()]),
        parameters: [("c", 1.0), ("v0", 0.1), ("k", 0.0)]
            .map(|(name, value)| (name.to_string(), value))
            .into(),
    };
    assert!(Placed::from_entry(&stated, &entry("ground", "slide")).is_ok());
    let elsewhere = Placed::from_entry(&stated, &entry("arm", "slide"));
    let told = elsewhere.err().unwrap().to_string();
    assert_eq!(
        told,
        "[[effect]] \"grease\": it sits between arm and slide, needed is a place of its [[law]]: between slide and ground"
    );
    assert!(find_in(&stated, "tabulated_force", &Location::Between(pair)).is_some());
}

/// What is not refused by the reader of the model file: what only the catalogue and the force itself tell.
#[test]
fn regress_messages() {
    let c = || LawParameter::of_size("c", "N", 20.0);
    let cases = [
        (
            "kind of the catalogue",
            law("coulomb_friction", "c * v", vec![c()]),
        ),
        ("free law", law("tabulated_force", "c * v", vec![c()])),
        ("no size", law("grease", "tanh(c * v)", vec![c()])),
        ("constant beside it", law("grease", "c * v + 1", vec![c()])),
        ("infinite at rest", law("grease", "c / v", vec![c()])),
        (
            "no number at rest",
            law("grease", "c * v / abs(v)", vec![c()]),
        ),
        (
            "no number about rest",
            law("grease", "c * ln(1 + sqrt(d))", vec![c()]),
        ),
        (
            "too many parameters",
            law(
                "grease",
                &(0..13)
                    .map(|k| format!("c{k}"))
                    .collect::<Vec<_>>()
                    .join(" + "),
                (0..13)
                    .map(|k| LawParameter::of_size(&format!("c{k}"), "N", 1.0))
                    .collect(),
            ),
        ),
    ];
    let lines: Vec<String> = cases
        .into_iter()
        .map(|(name, law)| match own_laws(&with(vec![law])) {
            Ok(_) => format!("{name}: NOT REFUSED"),
            Err(error) => format!("{name}: {error}"),
        })
        .collect();
    insta::assert_snapshot!(lines.join("\n"));
}

/// The terms that a loss is usually made of are told by their force, not by a name.
#[test]
fn verify_terms_of_a_loss_are_known() {
    let is_loss = |force: &str, names: &[&str]| {
        let parameters = names
            .iter()
            .map(|name| LawParameter::of_size(name, "1", 1.0));
        let model = with(vec![law("own", force, parameters.collect())]);
        find_of(&model, "own").unwrap().is_loss_term()
    };
    assert!(is_loss("c * v * abs(v)", &["c"]));
    assert!(is_loss("c * v^3", &["c"]));
    assert!(!is_loss("c * v^2", &["c"]));
    assert!(!is_loss("c * d^3", &["c"]));
    assert!(!is_loss("c * tanh(v / w)", &["c", "w"]));
}

/// A model that is put together in code may never have been checked.
#[test]
fn verify_a_law_that_was_not_checked_is_refused() {
    let mut c = LawParameter::of_size("c", "N", 20.0);
    c.lower = Some(f64::NAN);
    for law in [
        law("grease", "c * v", vec![c]),
        law(
            "grease",
            "c * w",
            vec![LawParameter::of_size("c", "N", 20.0)],
        ),
    ] {
        let mut model = with(vec![]);
        model.laws = vec![law];
        assert!(own_laws(&model).is_err());
        assert_eq!(catalogue_of(&model).len(), catalogue().len());
    }
}
