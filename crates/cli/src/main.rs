//! The simgap command line. What it promises is in `docs/contract.md`; exit status 0 means done,
//! 2 that the input is bad, with one line that says what, where and what is needed.
#![allow(clippy::print_stderr)]

mod args;
mod audit;
mod check;
mod compare;
mod demo;
mod diagnose;
mod effects;
mod error;
mod fleet;
mod init;
mod modes;
mod pointer;
mod progress;
mod record_args;
mod sensitivity;
mod shell;
mod simulate;
mod stdout;
mod text;
mod usage;

use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use stdout::written;

/// Exit status for bad input.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args_os()
        .map(|argument| argument.to_string_lossy().into_owned())
        .collect();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => match usage::one_line(&error, &arguments) {
            Some(line) => return refuse(&line),
            None => {
                // Help or version, as asked for.
                return match written(error.print()) {
                    Ok(()) => ExitCode::SUCCESS,
                    Err(error) => refuse(&error.to_string()),
                };
            }
        },
    };
    let done = match &cli.command {
        Command::Diagnose(args) => diagnose::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Fleet(args) => fleet::run_fleet(args),
        Command::Demo(args) => demo::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Modes(args) => modes::run(args),
        Command::Sensitivity(args) => sensitivity::run(args),
        Command::Init(args) => init::run(args),
        Command::Check(args) => check::run(args),
        Command::Effects(args) => effects::run(args),
        Command::Completions(args) => shell::completions(args),
        Command::Man(args) => shell::man(args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => refuse(&error.to_string()),
    }
}

/// One line on stderr, whatever the names in it hold.
fn refuse(message: &str) -> ExitCode {
    let line: String = message
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    // Where stderr cannot be written either, the exit status tells.
    let _ = writeln!(std::io::stderr(), "simgap: {line}");
    // One line is promised; a person at a terminal is also shown the place.
    let err = anstream::stderr();
    let person = err.current_choice() != anstream::ColorChoice::Never;
    let person = person || std::io::stderr().is_terminal();
    if let Some(picture) = person.then(|| pointer::picture(message)).flatten() {
        let _ = err.lock().write_all(picture.as_bytes());
    }
    ExitCode::from(BAD_INPUT)
}
