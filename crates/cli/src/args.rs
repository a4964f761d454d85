//! Arguments.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use simgap_effects::catalogue;

/// Tells why the real machine does not move like the model.
#[derive(Parser)]
#[command(name = "simgap", version, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Find where the gap between a model and records lies, which effect causes it, how far it closes.
    Diagnose(DiagnoseArgs),
    /// Predict the outputs of a model file, effects included, from a record's inputs.
    Simulate(SimulateArgs),
    /// Diagnose an embedded record of the mold oscillator and write the report.
    Demo(DemoArgs),
    /// List the catalogue of effects with their equations and parameters.
    Effects,
}

/// How the result is printed.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// A summary for people.
    Human,
    /// The text of diagnosis.json.
    Json,
}

#[derive(Args)]
pub(crate) struct DiagnoseArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Record to learn from (CSV); may be given several times.
    #[arg(long, required = true, value_name = "CSV")]
    pub(crate) train: Vec<PathBuf>,
    /// Record to judge by; without one the last third of each training record is held back.
    #[arg(long, value_name = "CSV")]
    pub(crate) check: Vec<PathBuf>,
    /// Folder for diagnosis.json, corrected.toml, predictions/ and report.html.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Take a kind out of the catalogue; may be given several times.
    #[arg(long, value_name = "KIND")]
    pub(crate) withhold: Vec<String>,
    /// Threads; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<usize>,
    /// Seed of anything random; the diagnosis has nothing random so far.
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub(crate) seed: u64,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct SimulateArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Record whose inputs drive the model (CSV).
    #[arg(long, value_name = "CSV")]
    pub(crate) record: PathBuf,
    /// Predictions (CSV).
    #[arg(long, value_name = "CSV")]
    pub(crate) out: PathBuf,
    /// Start at rest at zero displacement, even where measured outputs would give the initial state.
    #[arg(long)]
    pub(crate) from_rest: bool,
}

#[derive(Args)]
pub(crate) struct DemoArgs {
    /// Folder for the embedded model and records and for the results.
    #[arg(long, value_name = "DIR", default_value = "simgap-demo")]
    pub(crate) out: PathBuf,
}

/// The catalogue as text.
pub(crate) fn effects_table() -> String {
    let mut text = String::new();
    for effect in catalogue() {
        let _ = writeln!(text, "{}\n    {}", effect.kind(), effect.summary());
        let _ = writeln!(text, "    {}", effect.equation());
        let _ = writeln!(text, "    placed by {}", effect.site().place());
        for parameter in effect.parameters() {
            let _ = writeln!(text, "    {} [{}]", parameter.name, parameter.unit);
        }
    }
    text
}
