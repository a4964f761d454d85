//! `cargo xtask demo-records`: the embedded records of `simgap demo`.
//!
//! The mold oscillator of the paper (Table 1) is driven by a known force and simulated with two
//! effects its model lacks, one in the machine and one in the measurement chain. The records are
//! generated, not measured; the folder says so.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use clap::Args;
use simgap_diagnose::{DiagnoseError, Request, diagnose};
use simgap_effects::{Placed, find};
use simgap_model::{Location, Model, ModelError};
use simgap_mold::{MoldError, OneDof};
use simgap_record::{Channel, Record, RecordError};
use simgap_report::chart::{ChartError, LineChart, Role, Series};
use simgap_simulate::{Run, SimulateError, Simulator};
use thiserror::Error;

use crate::generated::workspace_root;

/// Sampling as in the paper, and how much finer the truth is simulated.
const TIME_STEP_S: f64 = 0.01;
const OVERSAMPLING: usize = 100;
const DURATION_S: f64 = 20.0;
/// Hidden in the records: dry friction of the cylinders, and an alternating sample timing close
/// to what one reading of the paper's Table 4 finds (0.617 ms, `docs/reproduction`), a whole number
/// of fine steps.
const FRICTION_FORCE_N: f64 = 2_400.0;
const TIMING_S: f64 = 0.6e-3;
/// White noise of the displacement sensor.
const NOISE_M: f64 = 3e-6;
/// Where the records are kept, from the root of the workspace.
const FOLDER: &str = "fixtures/demo";
/// The picture of the README.
const PICTURE: &str = "docs/images/demo.svg";

const PROVENANCE: &str = "\
The embedded records of `simgap demo`: generated, not measured.

Made by `cargo xtask demo-records` from the one-degree-of-freedom mold oscillator of the paper
(Table 1), driven by a known pressure force and simulated 100 times finer than it is sampled. Two
effects that `model.toml` lacks are in the records, one in the machine and one in the measurement
chain; what they are is written in `xtask/src/demo_records.rs`, not in the records.
`cargo xtask demo-records --check` fails when the files are not what the program makes.
";

/// Arguments of `demo-records`.
#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Compare the committed files with what the program makes, write nothing.
    #[arg(long)]
    check: bool,
}

impl DemoArgs {
    /// Whether to compare only.
    #[must_use]
    pub fn is_check(&self) -> bool {
        self.check
    }
}

/// Why the records cannot be made.
#[derive(Debug, Error)]
pub enum DemoError {
    /// The mold.
    #[error(transparent)]
    Mold(#[from] MoldError),
    /// The model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The simulation.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The records.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The diagnosis.
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    /// The picture.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// A diagnosis without a check record.
    #[error("the diagnosis has no check record to draw")]
    NoSeries,
    /// An effect that the catalogue should have.
    #[error("the catalogue has no {0}")]
    NoEffect(&'static str),
}

/// Writes the records and the picture of their diagnosis, or compares the records; returns the
/// paths that differ. The picture is not compared: its last tenth of a pixel hangs on the machine.
///
/// # Errors
/// [`DemoError`] when a record cannot be made or written.
pub fn run(args: &DemoArgs) -> Result<Vec<PathBuf>, DemoError> {
    let folder = workspace_root().join(FOLDER);
    let mut differ = Vec::new();
    for (name, text) in files()? {
        let path = folder.join(name);
        let same = std::fs::read_to_string(&path).is_ok_and(|found| found == text);
        if !same {
            if !args.check {
                simgap_record::ensure_writable_dir(&folder)?;
                simgap_record::write_text_atomic(&path, &text)?;
            }
            differ.push(path);
        }
    }
    if !args.check {
        let path = workspace_root().join(PICTURE);
        simgap_record::write_text_atomic(&path, &picture(&folder)?)?;
        differ.push(path);
    }
    Ok(differ)
}

/// Measured, nominal and corrected displacement of the check record.
fn picture(folder: &Path) -> Result<String, DemoError> {
    let model = OneDof::published()?.model()?;
    let read = |name: &str| simgap_record::read_csv(&folder.join(name));
    let train = [read("train-1.csv")?, read("train-2.csv")?];
    let check = [read("check.csv")?];
    let request = Request::new(&model, &train, &check);
    let outcome = diagnose(&request, &|_| {})?;
    let Some(series) = outcome.series.first() else {
        return Err(DemoError::NoSeries);
    };
    let channel = &series.channels[0];
    let millimetres = |values: &[f64]| -> Vec<f64> { values.iter().map(|y| 1e3 * y).collect() };
    let mut chart = LineChart::new(
        "Mold displacement at 2 Hz, not used to find the cause",
        "time [s]",
        "y [mm]",
    );
    for (name, role, values) in [
        ("measured", Role::Measured, &channel.measured),
        ("model as given", Role::Nominal, &channel.nominal),
        ("corrected model", Role::Corrected, &channel.corrected),
    ] {
        chart = chart.with(Series::new(name, role, &series.time_s, millimetres(values)));
    }
    chart.x_range = Some([10.0, 12.0]);
    Ok(chart.to_svg()?)
}

fn files() -> Result<Vec<(&'static str, String)>, DemoError> {
    let model = OneDof::published()?.model()?;
    let drive = |freqs_hz: &'static [f64], amplitude_n: f64| {
        move |t: f64| -> f64 {
            freqs_hz
                .iter()
                .map(|f| amplitude_n * (TAU * f * t + 0.7 * f).sin())
                .sum()
        }
    };
    Ok(vec![
        ("README.md", PROVENANCE.to_string()),
        ("model.toml", model.to_toml()?),
        ("train-1.csv", record(&model, drive(&[1.0], 16_000.0), 1)?),
        ("train-2.csv", record(&model, drive(&[3.0], 14_000.0), 2)?),
        ("check.csv", record(&model, drive(&[2.0], 12_000.0), 3)?),
    ])
}

/// One record as CSV text, rounded to what a converter would deliver (0.1 um, 1 N).
fn record(model: &Model, drive: impl Fn(f64) -> f64, seed: u64) -> Result<String, DemoError> {
    let weight = -model.loads.iter().map(|load| load.value).sum::<f64>();
    let fine = TIME_STEP_S / OVERSAMPLING as f64;
    let count = (DURATION_S / TIME_STEP_S) as usize * OVERSAMPLING;
    let force: Vec<f64> = (0..count)
        .map(|i| weight + drive(i as f64 * fine))
        .collect();
    let channels = vec![Channel::new("F_pressure", "N", force)];
    let run = Run::new(model, &Record::from_uniform("fine", 0.0, fine, channels)?)?;
    let friction = placed(
        "coulomb_friction",
        Location::Between(["mold".into(), "ground".into()]),
        FRICTION_FORCE_N,
    )?;
    let displacement = Simulator::new(model, &[friction], 1)?
        .predict(&run, &[])?
        .swap_remove(0);
    let early_or_late = (TIMING_S / fine).round() as usize;
    let mut noise = Noise(seed);
    let mut text = String::from("t [s],F_pressure [N],y [m]\n");
    for n in 0..count / OVERSAMPLING {
        let at = n * OVERSAMPLING;
        let taken = if n.is_multiple_of(2) {
            at + early_or_late
        } else {
            at.saturating_sub(early_or_late)
        };
        let y = displacement[taken.min(count - 1)] + NOISE_M * noise.next();
        let force = run.inputs[0][at];
        text += &format!("{:.2},{:.0},{:.7}\n", n as f64 * TIME_STEP_S, force, y);
    }
    Ok(text)
}

fn placed(kind: &'static str, at: Location, value: f64) -> Result<Placed, DemoError> {
    let effect = find(kind).ok_or(DemoError::NoEffect(kind))?;
    Ok(Placed::new(effect, at, vec![value]))
}

/// White noise of unit variance, uniformly distributed: SplitMix64.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        (unit - 0.5) * 12.0_f64.sqrt()
    }
}
