//! What is asked of `cargo xtask stability`.

use std::path::PathBuf;

use crate::asked::AskingArgs;

/// Arguments of `cargo xtask stability`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Seed of the cases: 1 to 999 while developing, 1000 to 1999 for reports
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Number of cases
    #[arg(long, default_value_t = 30)]
    pub(super) cases: usize,
    /// Draws of the noise of each; every other one with the training records in the other order
    #[arg(long, default_value_t = 20)]
    pub(super) redraws: usize,
    /// Only these kinds, separated by commas (also: noise, small_errors, two_parameters, pair, foreign)
    #[arg(long, value_delimiter = ',')]
    pub(super) kinds: Vec<String>,
    /// Folder for cases and answers
    #[arg(long, value_name = "DIR", default_value = "target/stability")]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) asking: AskingArgs,
}
