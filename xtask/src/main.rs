//! `cargo xtask`: project tasks, one subcommand per module of the library.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use xtask::{blind_check, demo_records, reproduce};

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
}

#[allow(clippy::print_stdout, clippy::print_stderr)]
fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::ReproducePaper(args) => reproduce::run(&args),
        Task::DemoRecords(args) => return demo(&args),
        Task::BlindCheck(args) => return blind_check::main(&args),
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
