//! What is asked of `cargo xtask blind-check`.

use std::path::PathBuf;

use simgap_blind::{Level, TUNE_SEEDS};

/// What to run.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// Cases to generate.
    #[arg(long, default_value_t = 60)]
    pub cases: usize,
    /// Seed of the campaign: 1 to 999 to set thresholds, 1000 to 1999 to report.
    #[arg(long, default_value_t = TUNE_SEEDS.start)]
    pub seed: u64,
    /// How much noise, how wrong the parameters, how small the gaps of these cases.
    #[arg(long, value_enum, default_value_t = LevelArg::Standard)]
    pub level: LevelArg,
    /// Further cases of the hard level.
    #[arg(long, default_value_t = 0)]
    pub hard: usize,
    /// Only these kinds, separated by commas (also: noise, small_errors, two_parameters, pair, foreign).
    #[arg(long, value_delimiter = ',')]
    pub kinds: Vec<String>,
    /// Further cases of this kind, diagnosed with the kind taken out of the catalogue; repeatable.
    #[arg(long, value_name = "KIND")]
    pub withhold: Vec<String>,
    /// The same for every kind of the catalogue that a drawn machine can have.
    #[arg(long)]
    pub withhold_each: bool,
    /// Cases for each kind that is withheld.
    #[arg(long, default_value_t = 1)]
    pub withheld_cases: usize,
    /// Only the case of this number.
    #[arg(long)]
    pub only: Option<usize>,
    /// Processes at a time; one for each processor if left out. The result does not depend on it.
    #[arg(long)]
    pub jobs: Option<usize>,
    /// Writes the page as Markdown.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Keeps the folders of the cases, the answers and the opened truths here.
    #[arg(long)]
    pub keep: Option<PathBuf>,
    /// Scores the answers that an earlier run of the same campaign kept here, and asks for none.
    #[arg(long, value_name = "DIR")]
    pub answers: Option<PathBuf>,
    /// Fails when the figures are below the floors.
    #[arg(long)]
    pub check_thresholds: bool,
    /// Tells of every case, not only of those that are not right.
    #[arg(long)]
    pub details: bool,
    /// A short run on its own seed, held against the floors.
    #[arg(long)]
    pub short: bool,
}

/// [`Level`] on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum LevelArg {
    /// Noise 34 to 46 dB below the signal, parameters off by up to 2 %, gaps of 10 to 50 %.
    Standard,
    /// Noise 26 to 34 dB below the signal, parameters off by up to 5 %, gaps of 6 to 20 %.
    Hard,
}

impl From<LevelArg> for Level {
    fn from(level: LevelArg) -> Level {
        match level {
            LevelArg::Standard => Level::Standard,
            LevelArg::Hard => Level::Hard,
        }
    }
}
