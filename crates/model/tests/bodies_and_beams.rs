//! Rigid bodies and beams: closed forms, limits, the model file.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use simgap_model::{Model, damped_modes, undamped_modes};

const HEAD: &str = "schema = \"simgap-model/1\"\nname = \"m\"\n";
const BODY: &str = "[[body]]\nname = \"mold\"\nmass = 33000.0\ninertia = 20000.0\n\
    [[point]]\nname = \"left\"\nbody = \"mold\"\noffset = -1.5\n\
    [[point]]\nname = \"right\"\nbody = \"mold\"\noffset = 1.5\n\
    [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"mold.left\"\n\
    [[output]]\nchannel = \"theta\"\nkind = \"roll\"\nat = \"mold\"\n";
const SPRINGS: &str = "[[spring]]\nname = \"l\"\nbetween = [\"mold.left\", \"ground\"]\nstiffness = 4e6\n\
    [[spring]]\nname = \"r\"\nbetween = [\"ground\", \"mold.right\"]\nstiffness = 4e6\n";

fn model(text: &str) -> Model {
    Model::from_toml(&format!("{HEAD}{text}")).unwrap()
}

fn refused(text: &str) -> String {
    Model::from_toml(&format!("{HEAD}{text}"))
        .unwrap_err()
        .to_string()
}

/// Eigenvalues of a few coordinates.
const ROUNDING: f64 = 1e-12;

#[test]
fn verify_heave_and_roll_of_a_body_on_two_springs() {
    let model = model(&format!("{BODY}{SPRINGS}"));
    let modes = undamped_modes(&model.matrices().unwrap()).unwrap();
    let heave = (8e6_f64 / 33000.0).sqrt() / TAU;
    // f_roll = f_heave b/r_g
    let roll = heave * 1.5 / (20000.0_f64 / 33000.0).sqrt();
    let found = &modes.natural_freq_hz;
    assert!((found[0] / heave - 1.0).abs() < ROUNDING, "{found:?}");
    assert!((found[1] / roll - 1.0).abs() < ROUNDING, "{found:?}");
}

#[test]
fn verify_a_point_is_a_row_over_heave_and_roll() {
    let model = model(&format!(
        "{BODY}{SPRINGS}[[load]]\nat = \"mold.right\"\nvalue = 100.0\n"
    ));
    // A load over one of two equal springs bends that spring alone.
    let at = model.equilibrium().unwrap();
    let point = |name: &str| model.node(name).unwrap().of(&at, &[]);
    assert!((point("mold.right") - 100.0 / 4e6).abs() < 1e-17);
    assert!(point("mold.left").abs() < 1e-17);
    // The response of an output at a point, and the roll, at a frequency.
    let response = model.output_response(2.0).unwrap();
    let squared = (TAU * 2.0).powi(2);
    let heave = 1.0 / (8e6 - squared * 33000.0);
    let roll = 1.0 / (8e6 * 1.5 * 1.5 - squared * 20000.0);
    assert!((response[(0, 0)].re / heave - 1.0).abs() < ROUNDING);
    assert!((response[(0, 1)].re / (-1.5 * roll) - 1.0).abs() < ROUNDING);
    assert!((response[(1, 1)].re / roll - 1.0).abs() < ROUNDING);
}

#[test]
fn verify_a_body_without_offset_is_a_mass() {
    let body = model(
        "[[body]]\nname = \"a\"\nmass = 3.0\ninertia = 1.0\n\
        [[point]]\nname = \"c\"\nbody = \"a\"\noffset = 0.0\n\
        [[spring]]\nname = \"s\"\nbetween = [\"a.c\", \"ground\"]\nstiffness = 12.0\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"a\"\n",
    );
    let matrices = body.matrices().unwrap();
    assert_eq!(matrices.stiffness_matrix[(0, 0)], 12.0);
    assert_eq!(matrices.stiffness_matrix[(0, 1)], 0.0);
    assert_eq!(matrices.stiffness_matrix[(1, 1)], 0.0);
}

fn beam(between: &str, more: &str) -> String {
    format!(
        "[[beam]]\nname = \"leaf\"\nbetween = [{between}]\nlength = 1.06\nwidth = 0.2\nthickness = 0.01\n\
        youngs_modulus = 2.1e11\ndensity = 7850.0\n{more}"
    )
}

const AT_MODE: &str = "[[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"leaf.mode1\"\n";
/// Bending wave speed measure of the beam above, h/L² √(E/ρ), 1/s.
fn scale() -> f64 {
    0.01 / (1.06 * 1.06) * (2.1e11_f64 / 7850.0).sqrt()
}

/// Roots x of cos x cosh x = 1 and cos x cosh x = −1 (`blevins1979`).
const CLAMPED: [f64; 2] = [4.730_040_744_862_704, 7.853_204_624_095_838];
const CANTILEVER: f64 = 1.875_104_068_711_961;

fn freq(root: f64) -> f64 {
    root * root / (TAU * 12.0_f64.sqrt()) * scale()
}

/// Cubic elements are off by about (x/N)⁴/1440.
const FORTY_ELEMENTS: f64 = 1e-6;

#[test]
fn verify_a_clamped_beam_has_the_frequencies_of_the_closed_form() {
    let text = beam("\"ground\", \"ground2\"", "elements = 40\nmodes = 2\n")
        + "[[input]]\nchannel = \"b\"\nkind = \"displacement\"\nat = \"ground2\"\n"
        + AT_MODE;
    let modes = undamped_modes(&model(&text).matrices().unwrap()).unwrap();
    for (found, root) in modes.natural_freq_hz.iter().zip(CLAMPED) {
        let ratio = found / freq(root);
        assert!(
            (ratio - 1.0).abs() < FORTY_ELEMENTS * (root / CLAMPED[0]).powi(4),
            "{ratio}"
        );
    }
    // f₁ = 1.028 h/L² √(E/ρ)
    assert!((modes.natural_freq_hz[0] / scale() - 1.028).abs() < 1e-4);
}

#[test]
fn verify_a_cantilever_has_the_frequency_of_the_closed_form() {
    let tip = "[[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"leaf.tip\"\n";
    let text = beam("\"ground\", \"leaf.tip\"", "elements = 40\nmodes = 12\n") + tip;
    let modes = undamped_modes(&model(&text).matrices().unwrap()).unwrap();
    let ratio = modes.natural_freq_hz[0] / freq(CANTILEVER);
    // Twelve modes kept: what is left out of the shape is of higher order.
    assert!((ratio - 1.0).abs() < FORTY_ELEMENTS, "{ratio}");
}

#[test]
fn verify_a_leaf_spring_under_a_mass_is_its_static_stiffness() {
    let text = beam("\"block\", \"ground\"", "modes = 0\n")
        + "[[mass]]\nname = \"block\"\nvalue = 1e6\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"block\"\n";
    let model = model(&text);
    let stiffness = 12.0 * 2.1e11 * 0.2 * 0.01_f64.powi(3) / 12.0 / 1.06_f64.powi(3);
    assert!((model.springs[0].stiffness / stiffness - 1.0).abs() < 1e-9);
    // 13/35 of the leaf moves with its end.
    let mass = model.matrices().unwrap().mass_matrix[(0, 0)];
    let leaf = 7850.0 * 0.2 * 0.01 * 1.06;
    assert!(((mass - 1e6) / leaf - 13.0 / 35.0).abs() < 1e-6);
}

/// Rigid translation of both ends carries the whole mass and bends nothing.
#[test]
fn verify_a_beam_between_two_blocks_translates_rigidly() {
    let text = beam("\"a\", \"b\"", "modes = 5\n")
        + "[[mass]]\nname = \"a\"\nvalue = 1.0\n[[mass]]\nname = \"b\"\nvalue = 1.0\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"a\"\n";
    let matrices = model(&text).matrices().unwrap();
    let sum = |m: &faer::Mat<f64>| m[(0, 0)] + m[(0, 1)] + m[(1, 0)] + m[(1, 1)];
    let leaf = 7850.0 * 0.2 * 0.01 * 1.06;
    assert!((sum(&matrices.mass_matrix) / (2.0 + leaf) - 1.0).abs() < 1e-9);
    assert!(sum(&matrices.stiffness_matrix).abs() < 1e-9 * matrices.stiffness_matrix[(0, 0)]);
    let modes = undamped_modes(&model(&text).matrices().unwrap()).unwrap();
    assert_eq!(modes.natural_freq_hz[0], 0.0);
}

#[test]
fn verify_files_are_written_as_they_are_read() {
    let own = beam(
        "\"mold.left\", \"ground\"",
        "damping_ratio = 0.02\nmodes = 3\n",
    );
    let text = format!("{BODY}{SPRINGS}{own}");
    let mut first = model(&text);
    let again = Model::from_toml(&first.to_toml().unwrap()).unwrap();
    assert_eq!(again.to_toml().unwrap(), first.to_toml().unwrap());
    assert_eq!(again.elements.bodies, first.elements.bodies);
    assert_eq!(again.masses, first.masses);
    // What effects have changed is written: a mass, an inertia, Young's modulus.
    let names: Vec<String> = first.masses.iter().map(|mass| mass.name.clone()).collect();
    assert_eq!(names[..3], ["mold", "mold.roll", "leaf.mode1"]);
    first.masses[0].value *= 1.1;
    first.masses[1].value *= 1.2;
    first.springs[2].stiffness *= 0.9;
    let again = Model::from_toml(&first.to_toml().unwrap()).unwrap();
    let (a, b) = (again.matrices().unwrap(), first.matrices().unwrap());
    for k in 0..names.len() * names.len() {
        let at = (k / names.len(), k % names.len());
        for (x, y) in [
            (&a.mass_matrix, &b.mass_matrix),
            (&a.damping_matrix, &b.damping_matrix),
            (&a.stiffness_matrix, &b.stiffness_matrix),
        ] {
            assert!((x[at] - y[at]).abs() <= 1e-12 * y[at].abs(), "{at:?}");
        }
    }
}

#[test]
fn verify_pole_sensitivities_against_finite_differences() {
    let text = format!(
        "{BODY}{SPRINGS}{}",
        beam(
            "\"mold.left\", \"ground\"",
            "damping_ratio = 0.02\nmodes = 2\n"
        )
    );
    let model = model(&text);
    let at = vec![0.0; model.dof_count()];
    let found = model.pole_sensitivities(&at).unwrap();
    // A thickness that is off, in the text of the file.
    let poles = |thickness: f64| {
        let text = text.replace("thickness = 0.01", &format!("thickness = {thickness:.12}"));
        let model = Model::from_toml(&format!("{HEAD}{text}")).unwrap();
        damped_modes(&model.matrices().unwrap()).unwrap()
    };
    let place = model
        .parameters()
        .iter()
        .position(|p| model.parameter_name(*p).ends_with(" thickness"));
    let step = 1e-7;
    let (high, low) = (poles(0.01 + step), poles(0.01 - step));
    for (k, pole) in found.iter().enumerate() {
        let slope = (high[k].eigenvalue - low[k].eigenvalue) / (2.0 * step);
        let own = pole.derivative.as_ref().unwrap()[place.unwrap()];
        assert!(
            (own - slope).norm() < 1e-5 * (slope.norm() + 1.0),
            "{own} {slope}"
        );
    }
}

#[test]
fn regress_messages() {
    let with = |beam: String| format!("{BODY}{SPRINGS}{beam}");
    let cases = [
        with("[[point]]\nname = \"top\"\nbody = \"mould\"\noffset = 1.0\n".into()),
        with("[[point]]\nname = \"roll\"\nbody = \"mold\"\noffset = 1.0\n".into()),
        with(String::new()).replace("inertia = 20000.0", "inertia = 0.0"),
        with(String::new()).replace("[\"mold.left\", \"ground\"]", "[\"mold.lft\", \"ground\"]"),
        with(beam("\"leaf.a\", \"leaf.b\"", "")),
        with(beam("\"mold.left\", \"ground\"", "elements = 1\n")),
        with(beam("\"mold.left\", \"ground\"", "modes = 39\n")),
        with(beam("\"mold.left\", \"ground\"", "thicknes = 1.0\n")),
        with(beam("\"mold.left\", \"ground\"", "")).replace("thickness = 0.01", "thickness = -1.0"),
        with(String::new()).replace("at = \"mold\"\n", "at = \"ground\"\n"),
    ];
    let messages: Vec<String> = cases.iter().map(|text| refused(text)).collect();
    insta::assert_snapshot!(messages.join("\n"));
}
