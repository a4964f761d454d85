//! Arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::record_args::RecordArgs;

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
    /// Compare a measured with a simulated trace, without a model file.
    Compare(CompareArgs),
    /// Poles, modes and frequency responses of a model file.
    Modes(ModesArgs),
    /// What each parameter of a model file does to its poles, ranked.
    Sensitivity(SensitivityArgs),
    /// Diagnose many machines by a plan: a table of answers, and what differs between machines and days.
    Fleet(FleetArgs),
    /// Diagnose an embedded record of the mold oscillator and write the report.
    Demo(DemoArgs),
    /// Write a commented model file to start from, with the columns of a record.
    Init(InitArgs),
    /// Say what records hold: columns, units, time base, quality.
    Check(CheckArgs),
    /// List the catalogue of effects, or explain one of them.
    Effects(EffectsArgs),
    /// Print the completions of a shell.
    Completions(CompletionsArgs),
    /// Print the manual page, or write those of all commands.
    Man(ManArgs),
}

/// How the result is printed.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// A summary for people.
    Human,
    /// JSON for machines.
    Json,
}

#[derive(Args)]
pub(crate) struct DiagnoseArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Record to learn from (CSV, MAT, UFF and more); may be given several times.
    #[arg(long, required = true, value_name = "RECORD")]
    pub(crate) train: Vec<PathBuf>,
    /// Record to judge by; without one the last third of each training record is held back.
    #[arg(long, value_name = "RECORD")]
    pub(crate) check: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) records: RecordArgs,
    /// Folder for diagnosis.json, corrected.toml, predictions/ and report.html.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Take a kind out of the catalogue; may be given several times.
    #[arg(long, value_name = "KIND")]
    pub(crate) withhold: Vec<String>,
    /// Threads; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) jobs: Option<usize>,
    /// Also writes `sets.json`: every set of effects that was fitted, with the terms that decide between them.
    #[arg(long)]
    pub(crate) sets: bool,
    /// Seconds after which the search ends with the best answer so far; without it the search ends after so much work, the same
    /// on every machine, about a minute of one core.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) budget: Option<f64>,
    /// Seed of anything random; the diagnosis has nothing random so far.
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub(crate) seed: u64,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

/// A time to spend.
fn seconds(text: &str) -> Result<f64, &'static str> {
    let seconds = text.parse().ok();
    let seconds = seconds.filter(|seconds: &f64| seconds.is_finite() && *seconds >= 0.0);
    seconds.ok_or("no time to spend")
}

#[derive(Args)]
pub(crate) struct SimulateArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Record whose inputs drive the model (CSV, MAT, UFF and more).
    #[arg(long, value_name = "RECORD")]
    pub(crate) record: PathBuf,
    #[command(flatten)]
    pub(crate) records: RecordArgs,
    /// Predictions (CSV).
    #[arg(long, value_name = "CSV")]
    pub(crate) out: PathBuf,
    /// Start at rest at zero displacement, even where measured outputs would give the initial state.
    #[arg(long)]
    pub(crate) from_rest: bool,
}

#[derive(Args)]
pub(crate) struct FleetArgs {
    /// Plan (TOML, schema simgap-plan/1): where records lie, and the model of each machine.
    pub(crate) plan: PathBuf,
    /// Folder for the table, fleet.html, fleet.json and models/; what it holds of an earlier run is not done again.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Diagnoses at the same time; the result does not depend on it [default: all cores].
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<usize>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct DemoArgs {
    /// Folder for the embedded model and records and for the results.
    #[arg(long, value_name = "DIR", default_value = "simgap-demo")]
    pub(crate) out: PathBuf,
}

#[derive(Args)]
pub(crate) struct EffectsArgs {
    /// Kind to explain, such as coulomb_friction; without one all are listed.
    pub(crate) kind: Option<String>,
    /// Model file; the laws that it holds are listed too.
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<PathBuf>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct CheckArgs {
    /// Record to look at (CSV, MAT, UFF and more); may be several.
    #[arg(required = true, value_name = "RECORD")]
    pub(crate) records: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: RecordArgs,
    /// Model file to look at the records with: sizes, signs, shifts, channels that nothing moves.
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<PathBuf>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct CompletionsArgs {
    /// Shell that is to complete.
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Args)]
pub(crate) struct ManArgs {
    /// Folder for the pages of all commands; without it the first page goes to stdout.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct CompareArgs {
    /// Measured record (CSV, MAT, UFF and more); --map is about this one.
    #[arg(long, value_name = "RECORD")]
    pub(crate) measured: PathBuf,
    /// Record of any simulator (CSV, MAT, UFF and more); its steps may be uneven.
    #[arg(long, value_name = "RECORD")]
    pub(crate) simulated: PathBuf,
    #[command(flatten)]
    pub(crate) reading: RecordArgs,
    /// Columns to compare where their names differ; may be given several times [default: columns of
    /// the same name].
    #[arg(long, value_name = "MEASURED=SIMULATED")]
    pub(crate) pair: Vec<String>,
    /// Column of both that drives the machine and is not compared; may be given several times. A
    /// column that is the same in both is taken for one.
    #[arg(long, value_name = "COLUMN")]
    pub(crate) input: Vec<String>,
    /// Take both records to begin at the same moment, whatever their stamps say.
    #[arg(long)]
    pub(crate) align_start: bool,
    /// Folder for comparison.json, comparison.html and compared.csv; without it nothing is written.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct ModesArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Folder for modes.json and modes.svg; without it nothing is written.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

#[derive(Args)]
pub(crate) struct SensitivityArgs {
    /// Model file (TOML, schema simgap-model/1).
    pub(crate) model: PathBuf,
    /// Tolerance of every parameter, percent: how far it moves a frequency is told beside the slope.
    #[arg(long, value_name = "PERCENT", default_value_t = 2.0)]
    pub(crate) tolerance: f64,
    /// Folder for sensitivity.json and sensitivity.svg; without it nothing is written.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// What is printed.
    #[arg(long, value_enum, default_value = "human")]
    pub(crate) format: Format,
}

/// Machines to start from.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Like {
    /// One mass on a spring and a damper, driven by a force.
    Oscillator,
    /// Two masses in a row, the first driven by a force.
    TwoMass,
    /// One mass on a base that moves.
    Base,
    /// A positioning axis: a mass on a guide, without a spring.
    Axis,
}

#[derive(Args)]
pub(crate) struct InitArgs {
    /// Machine to start from [default: what the columns of the record look like].
    #[arg(long, value_enum)]
    pub(crate) like: Option<Like>,
    /// Record whose columns are filled in (CSV, MAT, UFF and more).
    #[arg(long, value_name = "RECORD")]
    pub(crate) record: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: RecordArgs,
    /// Model file to write; without it the text goes to stdout.
    #[arg(long, value_name = "TOML")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite a file that is there.
    #[arg(long)]
    pub(crate) force: bool,
}
