//! The simgap command line. What it promises is in `docs/contract.md`; exit status 0 means done,
//! 2 that the input is bad, with one line that says what, where and what is needed.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod args;
mod demo;
mod diagnose;
mod error;
mod input;
mod progress;
mod simulate;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

/// Exit status for bad input.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match &cli.command {
        Command::Diagnose(args) => diagnose::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Demo(args) => demo::run(args),
        Command::Effects => {
            print!("{}", args::effects_table());
            Ok(())
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("simgap: {error}");
            ExitCode::from(BAD_INPUT)
        }
    }
}
