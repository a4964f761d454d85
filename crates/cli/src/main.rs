//! The simgap command line. What it promises is in `docs/contract.md`; exit status 0 means done,
//! 2 that the input is bad, with one line that says what, where and what is needed.
#![allow(clippy::print_stderr)]

mod args;
mod check;
mod compare;
mod demo;
mod diagnose;
mod effects;
mod error;
mod folder;
mod init;
mod input;
mod modes;
mod pointer;
mod progress;
mod record_args;
mod sensitivity;
mod shell;
mod simulate;
mod text;
mod usage;

use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use error::CliError;

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
                // Help or version, as asked for; a closed pipe is nobody's fault.
                let _ = error.print();
                return ExitCode::SUCCESS;
            }
        },
    };
    let done = match &cli.command {
        Command::Diagnose(args) => diagnose::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Demo(args) => demo::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Modes(args) => modes::run(args),
        Command::Sensitivity(args) => sensitivity::run(args),
        Command::Init(args) => init::run(args),
        Command::Check(args) => check::run(args),
        Command::Effects(args) => effects::run(args),
        Command::Completions(args) => {
            shell::completions(args);
            Ok(())
        }
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
    eprintln!("simgap: {line}");
    // One line is promised; a person at a terminal is also shown the place.
    let err = anstream::stderr();
    let person = err.current_choice() != anstream::ColorChoice::Never;
    let person = person || std::io::stderr().is_terminal();
    if let Some(picture) = person.then(|| pointer::picture(message)).flatten() {
        let _ = err.lock().write_all(picture.as_bytes());
    }
    ExitCode::from(BAD_INPUT)
}

/// Text on stdout, in colours where a terminal shows them and `NO_COLOR` does not forbid it.
pub(crate) fn say(text: &str) {
    print(anstream::stdout().lock(), text);
}

/// Text on stdout as it is.
pub(crate) fn say_plain(text: &str) {
    print(std::io::stdout().lock(), text);
}

/// A reader that closes the pipe early, as `head` does, has seen what it wanted.
fn print(mut out: impl std::io::Write, text: &str) {
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// The text of `--format json`.
pub(crate) fn json(value: &impl serde::Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(value).map_err(|error| CliError::Json {
        found: error.to_string(),
    })?;
    Ok(text + "\n")
}
