//! `cargo xtask blind-check`: generated cases, diagnosed without their truth, and scored.
//!
//! The only place where the diagnosis and the withheld truth meet, and they do not meet before the
//! diagnosis is done:
//!
//! ```text
//! 1  draw all cases; each a folder as a user would have it; the truths one text     draw
//!    its digest is told
//! 2  diagnose each in a process of its own that is given the folder and no more     ask, worker
//! 3  open the truths if they still have the digest; hold the answers against them   open, page
//! ```

mod ask;
mod draw;
mod error;
mod files;
mod floors;
mod open;
mod page;
mod plan;
mod worker;

use std::path::PathBuf;
use std::process::ExitCode;

use rayon::prelude::*;
use simgap_blind::{Level, Score, TUNE_SEEDS, Totals};

pub use error::BlindCheckError;
pub use worker::{WorkerArgs, main as worker_main};

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
    /// The same for every kind of the catalogue.
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

/// Runs the subcommand; prints the tables.
#[allow(clippy::print_stdout, clippy::print_stderr)]
#[must_use]
pub fn main(args: &Args) -> ExitCode {
    let done = std::env::current_exe()
        .map_err(BlindCheckError::Program)
        .and_then(|program| run(args, &program, &|line| eprintln!("{line}")));
    match done {
        Ok(report) => {
            println!("{}", report.text);
            for fault in &report.faults {
                eprintln!("below its floor: {fault}");
            }
            if report.faults.is_empty() {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            }
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// The tables and what is below its floor.
#[derive(Debug)]
pub struct Report {
    /// Tables and the cases that went wrong.
    pub text: String,
    /// Digest of the sealed truths.
    pub digest: String,
    /// The score of each case.
    pub scores: Vec<Score>,
    /// One line for each figure below its floor.
    pub faults: Vec<String>,
}

/// Generates, diagnoses and scores. `program` is this program, which is started once for each case;
/// `tell` is told of progress and of the digest before anything is diagnosed.
///
/// # Errors
/// [`BlindCheckError`] when a case cannot be generated or a file cannot be written. An error of
/// the diagnosis is a failed case, not an error.
pub fn run(
    args: &Args,
    program: &std::path::Path,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Report, BlindCheckError> {
    let planned = plan::plan(args)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.jobs.unwrap_or(0))
        .build()?;
    let places = files::Places::new(args.keep.as_deref(), program)?;
    let sealed = pool.install(|| draw::draw(plan::seed(args), &planned, &places))?;
    tell(&format!(
        "{} cases drawn; SHA-256 of their sealed truths: {}",
        planned.len(),
        sealed.digest
    ));
    let answered = |case: &plan::Planned| match &args.answers {
        Some(kept) => ask::kept(kept, case),
        None => ask::ask(&places, case, tell),
    };
    let answers: Vec<ask::Answered> = pool.install(|| planned.par_iter().map(answered).collect());
    let judged = pool.install(|| open::open(&sealed, &planned, &answers, &places))?;
    let scores: Vec<Score> = judged.iter().map(|j| j.score.clone()).collect();
    let of_level = |level: Level| -> Totals {
        let such = scores.iter().filter(|score| score.level == level);
        Totals::of(&such.cloned().collect::<Vec<_>>())
    };
    let (standard, hard) = (of_level(Level::Standard), of_level(Level::Hard));
    let tables = page::tables(&standard, &hard, &judged);
    if let Some(path) = &args.out {
        files::write(path, &page::page(args, &sealed.digest, &tables))?;
    }
    let faults = if args.check_thresholds || args.short {
        let failed = judged.iter().filter(|j| j.is_failed).count();
        floors::below(&standard, failed)
    } else {
        vec![]
    };
    Ok(Report {
        text: format!("{tables}\n{}", page::details(&judged, args.details)),
        digest: sealed.digest,
        scores,
        faults,
    })
}
