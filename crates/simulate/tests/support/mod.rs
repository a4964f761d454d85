//! Shared by the integration tests: models, runs without a file.
#![allow(dead_code, unreachable_pub)]

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_simulate::{Run, Simulator};

pub fn model(text: &str) -> Model {
    Model::from_toml(&format!(
        "schema = \"simgap-model/1\"\nname = \"m\"\n{text}"
    ))
    .unwrap()
}

/// One mass on a spring and a damper to `to`, with an output in displacement.
pub fn oscillator(mass: f64, stiffness: f64, damping: f64, to: &str) -> String {
    format!(
        r#"
[[mass]]
name = "block"
value = {mass:?}
[[spring]]
name = "k"
between = ["block", "{to}"]
stiffness = {stiffness:?}
[[damper]]
name = "c"
between = ["block", "{to}"]
damping = {damping:?}
"#
    )
}

pub fn force_input(at: &str) -> String {
    format!("[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"{at}\"\n")
}

pub fn base_input(at: &str) -> String {
    format!("[[input]]\nchannel = \"b\"\nkind = \"displacement\"\nat = \"{at}\"\n")
}

pub fn output(channel: &str, kind: &str, at: &str) -> String {
    format!("[[output]]\nchannel = \"{channel}\"\nkind = \"{kind}\"\nat = \"{at}\"\n")
}

pub fn force_output(channel: &str, a: &str, b: &str) -> String {
    format!("[[output]]\nchannel = \"{channel}\"\nkind = \"force\"\nbetween = [\"{a}\", \"{b}\"]\n")
}

/// A run of inputs alone.
pub fn run(time_step_s: f64, len: usize, inputs: Vec<Vec<f64>>) -> Run {
    assert!(inputs.iter().all(|signal| signal.len() == len));
    Run {
        first_index: 0,
        name: "made here".into(),
        start_s: 0.0,
        time_step_s,
        len,
        inputs,
        measured: vec![],
        mended: simgap_simulate::Mended::default(),
    }
}

/// A signal of time, sampled.
pub fn sampled(time_step_s: f64, len: usize, signal: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..len).map(|k| signal(k as f64 * time_step_s)).collect()
}

pub fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

pub fn placed(kind: &str, at: Location, values: &[f64]) -> Placed {
    let effect = find(kind).unwrap_or_else(|| panic!("no {kind} in the catalogue"));
    assert_eq!(effect.parameters().len(), values.len());
    Placed::new(effect, at, values.to_vec())
}

/// Predicts with effects and a number of steps between samples.
pub fn predict(
    model: &Model,
    effects: &[Placed],
    substeps: usize,
    run: &Run,
    initial: &[f64],
) -> Vec<Vec<f64>> {
    let simulator = Simulator::new(model, effects, substeps).unwrap();
    simulator.predict(run, initial).unwrap()
}

/// Largest modulus of the difference of two series.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    difference.fold(0.0, f64::max)
}

/// Times of the rising zero crossings, by linear interpolation.
pub fn rising_zeros(signal: &[f64], time_step_s: f64) -> Vec<f64> {
    let pairs = signal.windows(2).enumerate();
    pairs
        .filter(|(_, w)| w[0] < 0.0 && w[1] >= 0.0)
        .map(|(k, w)| (k as f64 + w[0] / (w[0] - w[1])) * time_step_s)
        .collect()
}

/// Complete elliptic integral of the first kind, K(k) = π / (2 agm(1, √(1 − k²))).
pub fn elliptic_k(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

/// Jacobi's cn(u, k), by the arithmetic-geometric mean (\[Abramowitz1964\], 16.4).
pub fn jacobi_cn(u: f64, modulus: f64) -> f64 {
    let mut a = vec![1.0];
    let mut c = vec![modulus];
    let mut b = (1.0 - modulus * modulus).sqrt();
    while c[c.len() - 1].abs() > 1e-15 {
        let top = a[a.len() - 1];
        a.push(0.5 * (top + b));
        c.push(0.5 * (top - b));
        b = (top * b).sqrt();
    }
    let last = a.len() - 1;
    let mut phi = f64::powi(2.0, last as i32) * a[last] * u;
    for n in (1..=last).rev() {
        phi = 0.5 * (phi + (c[n] / a[n] * phi.sin()).asin());
    }
    phi.cos()
}
