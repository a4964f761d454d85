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

mod args;
mod ask;
mod draw;
mod error;
mod files;
mod floors;
mod judged;
mod open;
mod page;
mod plan;
mod worker;

use std::process::ExitCode;

use rayon::prelude::*;
use simgap_blind::{Level, Score, Totals};

pub use args::{Args, LevelArg};
pub use error::BlindCheckError;
pub use worker::{WorkerArgs, main as worker_main};

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
