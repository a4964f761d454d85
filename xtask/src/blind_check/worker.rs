//! The process that diagnoses one case. It is given a folder with a model and records, and nothing
//! else.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use serde::{Deserialize, Serialize};
use simgap_diagnose::{Outcome, Request, diagnose};
use simgap_model::Model;
use simgap_record::{Record, read_csv};

use super::files::{CHECK, MODEL, TRAIN};

/// What a worker is given.
#[derive(Debug, Clone, clap::Args)]
pub struct WorkerArgs {
    /// Folder with model.toml, a.csv and b.csv to learn from, c.csv to judge by.
    pub folder: PathBuf,
    /// Kinds to take out of the catalogue.
    #[arg(long, value_name = "KIND")]
    pub withhold: Vec<String>,
}

/// What a worker answers.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Reply {
    /// As `diagnosis.json` holds it.
    pub(super) diagnosis: serde_json::Value,
    /// For each check record, each output, predicted by the nominal model.
    pub(super) nominal: Vec<Vec<Vec<f64>>>,
    /// By the corrected model.
    pub(super) corrected: Vec<Vec<Vec<f64>>>,
    /// Time of the diagnosis on one thread.
    pub(super) seconds: f64,
}

/// Diagnoses the case of a folder; prints the answer as JSON.
#[allow(clippy::print_stdout, clippy::print_stderr)]
#[must_use]
pub fn main(args: &WorkerArgs) -> ExitCode {
    match answer(args) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn answer(args: &WorkerArgs) -> Result<String, Box<dyn std::error::Error + Send + Sync>> {
    let model = Model::from_toml(&std::fs::read_to_string(args.folder.join(MODEL))?)?;
    let train = TRAIN
        .iter()
        .map(|file| read_csv(&args.folder.join(file)))
        .collect::<Result<Vec<Record>, _>>()?;
    let check = [read_csv(&args.folder.join(CHECK))?];
    let request = Request {
        withheld: &args.withhold,
        ..Request::new(&model, &train, &check)
    };
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let begun = Instant::now();
    let outcome = one_thread.install(|| diagnose(&request, &|_| ()))?;
    let seconds = begun.elapsed().as_secs_f64();
    Ok(serde_json::to_string(&reply(&outcome, seconds)?)?)
}

fn reply(outcome: &Outcome, seconds: f64) -> Result<Reply, serde_json::Error> {
    let predicted = |of: fn(&simgap_diagnose::ChannelSeries) -> &Vec<f64>| {
        let records = outcome.series.iter();
        let channels = |record: &simgap_diagnose::CheckSeries| {
            record.channels.iter().map(|c| of(c).clone()).collect()
        };
        records.map(channels).collect()
    };
    Ok(Reply {
        diagnosis: serde_json::to_value(&outcome.diagnosis)?,
        nominal: predicted(|channel| &channel.nominal),
        corrected: predicted(|channel| &channel.corrected),
        seconds,
    })
}

/// Reads a reply.
pub(super) fn read(path: &Path) -> Result<Reply, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    serde_json::from_str(&text).map_err(|error| format!("no answer that can be read: {error}"))
}
