//! The records of `fixtures/mold-on-cylinders`, with which `docs/hydraulics.md` works.
//!
//! The mold of the folder's model file moves with air in the oil of its left cylinder. Its set point is a sum of sines from 1 to
//! 27 Hz that sets in smoothly; positions and pressures are sampled at 400 Hz with noise of their sensors. The records are
//! generated, not measured; the folder says so.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_record::{Channel, Record};
use simgap_simulate::{Run, Simulator};

use crate::demo_records::{DemoError, Noise};

/// Where the files are kept, from the root of the workspace.
pub(crate) const FOLDER: &str = "fixtures/mold-on-cylinders";
const MODEL: &str = include_str!("../../fixtures/mold-on-cylinders/model.toml");
/// Sampling, and how much finer the truth is simulated.
const TIME_STEP_S: f64 = 0.0025;
const OVERSAMPLING: usize = 10;
/// How the set point sets in.
const ONSET_S: f64 = 0.3;
/// Hidden in the records: bulk modulus of the left cylinder over that of the model.
const AIR: f64 = 0.7;
/// White noise of the sensors: 5 µm, and 0.2 bar of 250.
const NOISE_M: f64 = 5e-6;
const NOISE_PA: f64 = 2e4;

const PROVENANCE: &str = "\
The model of `docs/hydraulics.md`, and its records: generated, not measured.

`model.toml` is made up after the machine of the paper, with hydraulics of ordinary size. The records are made by
`cargo xtask tutorial-records` from it with an effect that it lacks; which one is written in
`xtask/src/mold_records.rs`, not in the files. `cargo xtask tutorial-records --check` fails when the records are not
what the program makes.
";

/// The files of the folder but for the model.
pub(crate) fn files() -> Result<Vec<(&'static str, String)>, DemoError> {
    let train = [
        (1.0, 2e-3),
        (2.3, 1e-3),
        (4.1, 6e-4),
        (7.0, 4e-4),
        (13.0, 2e-4),
        (19.0, 2e-4),
        (27.0, 1.5e-4),
    ];
    let check = [
        (2.0, 2e-3),
        (3.0, 1e-3),
        (5.3, 5e-4),
        (11.0, 2e-4),
        (17.0, 2e-4),
        (23.0, 1.5e-4),
    ];
    Ok(vec![
        ("README.md", PROVENANCE.to_string()),
        ("train.csv", record(&train, 3.0, 1)?),
        ("check.csv", record(&check, 1.5, 2)?),
    ])
}

/// One record under several sines of the set point (Hz, m).
fn record(sines: &[(f64, f64)], duration_s: f64, seed: u64) -> Result<String, DemoError> {
    let model = Model::from_toml(MODEL)?;
    let fine = TIME_STEP_S / OVERSAMPLING as f64;
    let count = (duration_s / TIME_STEP_S) as usize * OVERSAMPLING;
    let set_point = |t: f64| -> f64 {
        let onset = 1.0 - (-(t / ONSET_S).powi(2)).exp();
        let sum: f64 = sines.iter().map(|(f, a)| a * (TAU * f * t + f).sin()).sum();
        onset * sum
    };
    let wanted: Vec<f64> = (0..count).map(|i| set_point(i as f64 * fine)).collect();
    let channels = vec![Channel::new("r", "1", wanted)];
    let run = Run::new(&model, &Record::from_uniform("fine", 0.0, fine, channels)?)?;
    let kind = "bulk_modulus";
    let effect = find(kind).ok_or(DemoError::NoEffect(kind))?;
    let chambers = Location::Between(["left.p1".into(), "left.p2".into()]);
    let air = Placed::new(effect, chambers, vec![AIR]);
    let outputs = Simulator::new(&model, &[air], 1)?.predict(&run, &[])?;
    let mut noise = Noise(seed);
    let mut text = "t [s],r [1]".to_string();
    for output in &model.outputs {
        let unit = if output.channel.starts_with('y') {
            "mm"
        } else {
            "bar"
        };
        let _ = write!(text, ",{} [{unit}]", output.channel);
    }
    text.push('\n');
    for at in (0..count).step_by(OVERSAMPLING) {
        let _ = write!(text, "{:.4},{:.6}", at as f64 * fine, run.inputs[0][at]);
        for (output, values) in model.outputs.iter().zip(&outputs) {
            let _ = if output.channel.starts_with('y') {
                write!(text, ",{:.4}", 1e3 * (values[at] + NOISE_M * noise.next()))
            } else {
                write!(
                    text,
                    ",{:.2}",
                    1e-5 * (values[at] + NOISE_PA * noise.next())
                )
            };
        }
        text.push('\n');
    }
    Ok(text)
}
