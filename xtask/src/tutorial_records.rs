//! `cargo xtask tutorial-records [--check]`: the logger files that `docs/tutorial.md` works with, and those of
//! `docs/hydraulics.md` (`mold_records`) and `docs/own-laws.md` (`slide_records`).
//!
//! A table on leaf springs is simulated with an effect that the tutorial's model lacks, and written
//! as a data logger would: lines before the header, a row of units, semicolons, decimal commas, a
//! column that nobody needs. The records are generated, not measured; the folder says so.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use clap::Args;
use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_record::{Channel, Record};
use simgap_simulate::{Run, Simulator};

use crate::demo_records::{DemoError, Noise};
use crate::generated::workspace_root;
use crate::{mold_records, slide_records};

/// Where the files are kept, from the root of the workspace.
pub const FOLDER: &str = "fixtures/tutorial";
/// Sampling, and how much finer the truth is simulated.
const TIME_STEP_S: f64 = 0.01;
const OVERSAMPLING: usize = 50;
const DURATION_S: f64 = 14.0;
/// The table as it is: the model of the tutorial has its spring at 5200 N/m and no friction.
const MASS_KG: f64 = 24.0;
const STIFFNESS_N_PER_M: f64 = 5270.0;
const DAMPING_N_S_PER_M: f64 = 55.0;
const FRICTION_FORCE_N: f64 = 7.0;
/// White noise of the position sensor: enough that the force between two samples, which no logger
/// knows, does not show.
const NOISE_M: f64 = 2e-5;

const PROVENANCE: &str = "\
The logger files of `docs/tutorial.md`: generated, not measured.

Made by `cargo xtask tutorial-records` from a table on leaf springs that is pushed to and fro. The
table has an effect that the tutorial's model lacks; which one is written in
`xtask/src/tutorial_records.rs`, not in the files. `cargo xtask tutorial-records --check` fails when
the files are not what the program makes.
";

/// Arguments of `tutorial-records`.
#[derive(Debug, Args)]
pub struct TutorialArgs {
    /// Compare the committed files with what the program makes, write nothing
    #[arg(long)]
    check: bool,
}

/// Writes the files, or compares them; one line for each that differs.
///
/// # Errors
/// [`DemoError`] when a record cannot be made or written.
pub fn run(args: &TutorialArgs) -> Result<Vec<String>, DemoError> {
    if args.check {
        return differences();
    }
    for (folder, name, text) in all_files()? {
        let folder = workspace_root().join(folder);
        simgap_record::ensure_writable_dir(&folder)?;
        simgap_record::write_text_atomic(&folder.join(name), &text)?;
    }
    Ok(vec![])
}

/// How the committed files differ from what the program makes.
///
/// # Errors
/// As [`run`].
pub fn differences() -> Result<Vec<String>, DemoError> {
    let differ = all_files()?.into_iter().filter(|(folder, name, text)| {
        let path = workspace_root().join(folder).join(name);
        !std::fs::read_to_string(path).is_ok_and(|found| &found == text)
    });
    let line =
        |(folder, name, _)| format!("{folder}/{name}: differs, run `cargo xtask tutorial-records`");
    Ok(differ.map(line).collect())
}

/// Folder, name and text of each file.
fn all_files() -> Result<Vec<(&'static str, &'static str, String)>, DemoError> {
    let table = files()?
        .into_iter()
        .map(|(name, text)| (FOLDER, name, text));
    let mold = mold_records::files()?.into_iter();
    let mold = mold.map(|(name, text)| (mold_records::FOLDER, name, text));
    let slide = slide_records::files()?.into_iter();
    let slide = slide.map(|(name, text)| (slide_records::FOLDER, name, text));
    Ok(table.chain(mold).chain(slide).collect())
}

fn files() -> Result<Vec<(&'static str, String)>, DemoError> {
    Ok(vec![
        ("README.md", PROVENANCE.to_string()),
        (
            "run1.csv",
            record(&[(0.7, 30.0), (1.9, 16.0), (3.1, 22.0)], 1)?,
        ),
        (
            "run2.csv",
            record(&[(0.5, 24.0), (1.4, 20.0), (2.7, 18.0)], 2)?,
        ),
    ])
}

/// One record under several sines (Hz, N), as a logger writes it.
fn record(sines: &[(f64, f64)], seed: u64) -> Result<String, DemoError> {
    let model = Model::from_toml(&format!(
        "schema = \"simgap-model/1\"\nname = \"table\"\n[[mass]]\nname = \"table\"\nvalue = {MASS_KG}\n\
         [[spring]]\nname = \"leaf\"\nbetween = [\"table\", \"ground\"]\nstiffness = {STIFFNESS_N_PER_M}\n\
         [[damper]]\nname = \"damper\"\nbetween = [\"table\", \"ground\"]\ndamping = {DAMPING_N_S_PER_M}\n\
         [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"table\"\n\
         [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"table\"\n"
    ))?;
    let fine = TIME_STEP_S / OVERSAMPLING as f64;
    let count = (DURATION_S / TIME_STEP_S) as usize * OVERSAMPLING;
    let push = |t: f64| -> f64 { sines.iter().map(|(f, n)| n * (TAU * f * t + f).sin()).sum() };
    let force: Vec<f64> = (0..count).map(|i| push(i as f64 * fine)).collect();
    let channels = vec![Channel::new("u", "N", force)];
    let run = Run::new(&model, &Record::from_uniform("fine", 0.0, fine, channels)?)?;
    let kind = "coulomb_friction";
    let effect = find(kind).ok_or(DemoError::NoEffect(kind))?;
    let guide = Location::Between(["table".into(), "ground".into()]);
    let friction = Placed::new(effect, guide, vec![FRICTION_FORCE_N]);
    let position = Simulator::new(&model, &[friction], 1)?
        .predict(&run, &[])?
        .swap_remove(0);
    let mut noise = Noise(seed);
    let mut text = format!(
        "Logger QX-8;channel group 1;;\nFeed table, run {seed};;;\n\
         Time;Force_1;Pos_Table;Supply\ns;N;mm;V\n"
    );
    for n in 0..count / OVERSAMPLING {
        let at = n * OVERSAMPLING;
        let millimetres = 1e3 * (position[at] + NOISE_M * noise.next());
        let row = format!(
            "{:.2};{:.2};{:.4};{:.1}",
            n as f64 * TIME_STEP_S,
            run.inputs[0][at],
            millimetres,
            24.0 + 0.05 * noise.next()
        );
        let _ = writeln!(text, "{}", row.replace('.', ","));
    }
    Ok(text)
}
