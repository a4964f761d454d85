//! What is asked of `cargo xtask machines`.

use std::path::PathBuf;

use crate::asked::AskingArgs;

/// Arguments of `cargo xtask machines`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folder of machines, each a folder with model.toml, train-1.csv ..., check.csv and truth.json
    #[arg(long, value_name = "DIR", default_value = "fixtures/machines")]
    pub(super) root: PathBuf,
    /// Folder for draws and answers
    #[arg(long, value_name = "DIR", default_value = "target/machines")]
    pub(super) out: PathBuf,
    /// Draws of white noise that is added to the outputs of each machine; none: the records as they are
    #[arg(long, default_value_t = 0)]
    pub(super) draws: usize,
    /// Its standard deviation, share of that of the output
    #[arg(long, default_value_t = 0.003)]
    pub(super) noise: f64,
    /// Only machines whose name holds this
    #[arg(long, value_name = "TEXT")]
    pub(super) only: Option<String>,
    #[command(flatten)]
    pub(super) asking: AskingArgs,
    /// Write the page docs/real-machines.md and the kinds that are named, answers.json beside the machines
    #[arg(long, conflicts_with_all = ["root", "draws", "only", "check"])]
    pub(super) write: bool,
    /// Fail where other kinds are named than answers.json says
    #[arg(long, conflicts_with = "draws")]
    pub(super) check: bool,
}
