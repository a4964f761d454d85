//! `cargo xtask`: project tasks, one subcommand per module of the library.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use xtask::{
    blind_check, demo_records, effects_docs, machines, reproduce, rigs, stability, tidy,
    tutorial_records,
};

#[derive(Parser)]
#[command(name = "xtask", about = "Project tasks")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Regenerate every table, peak and figure of the paper from the committed code
    ReproducePaper(reproduce::Args),
    /// Make the embedded records of `simgap demo`
    DemoRecords(demo_records::DemoArgs),
    /// Diagnose generated cases whose effect is withheld, and score the answers
    BlindCheck(blind_check::Args),
    /// Diagnose the case of a folder; started by blind-check, once for each case
    #[command(hide = true)]
    BlindWorker(blind_check::WorkerArgs),
    /// Draw machines with a withheld cause, have the program diagnose them, and score the answers
    Rigs(rigs::Args),
    /// Have the program diagnose real machines whose cause is known, and score the answers
    Machines(machines::Args),
    /// Whether generated machines get the same answer whatever their noise and the order of their records
    Stability(stability::Args),
    /// Write docs/effects.md from the catalogue of effects
    EffectsDocs(effects_docs::Args),
    /// Make the logger files that docs/tutorial.md works with
    TutorialRecords(tutorial_records::TutorialArgs),
    /// Check the rules that keep the workspace in shape
    Tidy,
}

#[allow(clippy::print_stdout, clippy::print_stderr)]
fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::ReproducePaper(args) => reproduce::run(&args),
        Task::DemoRecords(args) => return demo(&args),
        Task::BlindCheck(args) => return blind_check::main(&args),
        Task::BlindWorker(args) => return blind_check::worker_main(&args),
        Task::Rigs(args) => return told(rigs::run(&args)),
        Task::Machines(args) => return told(machines::run(&args)),
        Task::Stability(args) => return told(stability::run(&args)),
        Task::EffectsDocs(args) => return finish(effects_docs::run(&args)),
        Task::TutorialRecords(args) => return finish(tutorial_records::run(&args)),
        Task::Tidy => return finish(tidy::run()),
    };
    match outcome {
        Ok(outcome) => {
            println!("{outcome}");
            if outcome.is_clean() {
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

#[allow(clippy::print_stdout, clippy::print_stderr)]
fn demo(args: &demo_records::DemoArgs) -> ExitCode {
    match demo_records::run(args) {
        Ok(differ) => {
            for path in &differ {
                println!(
                    "{}: {}",
                    if args.is_check() {
                        "differs"
                    } else {
                        "written"
                    },
                    path.display()
                );
            }
            if args.is_check() && !differ.is_empty() {
                ExitCode::FAILURE
            } else {
                ExitCode::SUCCESS
            }
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints a page.
#[allow(clippy::print_stdout, clippy::print_stderr)]
fn told<E: std::fmt::Display>(page: Result<String, E>) -> ExitCode {
    match page {
        Ok(text) => {
            print!("{text}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints what is wrong; nothing wrong is success.
#[allow(clippy::print_stdout, clippy::print_stderr)]
fn finish<E: std::fmt::Display>(wrong: Result<Vec<String>, E>) -> ExitCode {
    match wrong {
        Ok(lines) => {
            lines.iter().for_each(|line| println!("{line}"));
            if lines.is_empty() {
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
