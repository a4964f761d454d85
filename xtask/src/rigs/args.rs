//! What is asked of `cargo xtask rigs`.

use std::path::PathBuf;

use crate::asked::AskingArgs;

/// Arguments of `cargo xtask rigs`.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Seed of the cases: 1 to 999 while developing, 1000 to 1999 for reports
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Number of cases
    #[arg(long, default_value_t = 100)]
    pub(super) cases: usize,
    /// Folder for cases, answers, truths and the score
    #[arg(long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Only cases of this role: single, pair, clean, parameters, foreign, slip or mixed
    #[arg(long)]
    pub(super) role: Option<String>,
    /// Only cases with this kind
    #[arg(long)]
    pub(super) kind: Option<String>,
    #[command(flatten)]
    pub(super) asking: AskingArgs,
    /// Draw the cases and ask for nothing
    #[arg(long)]
    pub(super) draw_only: bool,
}
