//! The records of `fixtures/greased-slide`, with which `docs/own-laws.md` works.
//!
//! A slide on a spring is pushed by a sum of sines. Its guide drags by a law that the catalogue lacks; force and position are
//! sampled at 250 Hz with noise of the sensor. The records are generated, not measured; the folder says so.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use simgap_model::Model;
use simgap_record::{Channel, Record};
use simgap_simulate::{Run, Simulator};

use crate::demo_records::{DemoError, Noise};

/// Where the files are kept, from the root of the workspace.
pub(crate) const FOLDER: &str = "fixtures/greased-slide";
/// Sampling, and how much finer the truth is simulated.
const TIME_STEP_S: f64 = 0.004;
const OVERSAMPLING: usize = 20;
/// White noise of the position sensor.
const NOISE_M: f64 = 2e-5;

/// The slide as it is; the model of the page has no grease.
const MACHINE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "slide"
value = 20.0
[[spring]]
name = "spring"
between = ["slide", "ground"]
stiffness = 20000.0
[[damper]]
name = "guide"
between = ["slide", "ground"]
damping = 60.0
[[input]]
channel = "force"
kind = "force"
at = "slide"
[[output]]
channel = "position"
kind = "displacement"
at = "slide"
[[law]]
name = "grease"
force = "c * tanh(v / v0) * (1 + k * d^2)"
[[law.parameter]]
name = "c"
unit = "N"
usual = 30.0
[[law.parameter]]
name = "v0"
unit = "m/s"
usual = 0.05
[[law.parameter]]
name = "k"
unit = "1/m^2"
usual = 6000.0
[[effect]]
kind = "grease"
between = ["slide", "ground"]
c = 30.0
v0 = 0.05
k = 6000.0
"#;

const PROVENANCE: &str = "\
The records of `docs/own-laws.md`: generated, not measured.

Made by `cargo xtask tutorial-records` from a slide with a drag that no kind of the catalogue has; which one is written in
`xtask/src/slide_records.rs`, not in the files. `cargo xtask tutorial-records --check` fails when the records are not what the
program makes.
";

/// The files of the folder.
pub(crate) fn files() -> Result<Vec<(&'static str, String)>, DemoError> {
    let train = [
        (0.7, 120.0),
        (1.9, 90.0),
        (3.3, 80.0),
        (4.7, 40.0),
        (7.1, 90.0),
        (11.0, 60.0),
    ];
    let check = [
        (0.9, 110.0),
        (2.3, 100.0),
        (3.9, 70.0),
        (5.6, 50.0),
        (8.3, 80.0),
    ];
    Ok(vec![
        ("README.md", PROVENANCE.to_string()),
        ("train.csv", record(&train, 8.0, 1)?),
        ("check.csv", record(&check, 4.0, 2)?),
    ])
}

/// One record under several sines (Hz, N).
fn record(sines: &[(f64, f64)], duration_s: f64, seed: u64) -> Result<String, DemoError> {
    let model = Model::from_toml(MACHINE)?;
    let fine = TIME_STEP_S / OVERSAMPLING as f64;
    let count = (duration_s / TIME_STEP_S) as usize * OVERSAMPLING;
    let push = |t: f64| -> f64 { sines.iter().map(|(f, n)| n * (TAU * f * t + f).sin()).sum() };
    let force: Vec<f64> = (0..count).map(|i| push(i as f64 * fine)).collect();
    let channels = vec![Channel::new("force", "N", force)];
    let run = Run::new(&model, &Record::from_uniform("fine", 0.0, fine, channels)?)?;
    let simulator = Simulator::of_file(&model, std::slice::from_ref(&run))?;
    let position = simulator.predict(&run, &[])?.swap_remove(0);
    let mut noise = Noise(seed);
    let mut text = "t [s],force [N],position [mm]\n".to_string();
    for at in (0..count).step_by(OVERSAMPLING) {
        let millimetres = 1e3 * (position[at] + NOISE_M * noise.next());
        let _ = writeln!(
            text,
            "{:.3},{:.3},{millimetres:.4}",
            at as f64 * fine,
            run.inputs[0][at]
        );
    }
    Ok(text)
}
