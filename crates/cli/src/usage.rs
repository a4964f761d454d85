//! Faults of the command line itself, in one line like every other.

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// What is wrong with the arguments and where help is; `None` when help or the version was asked
/// for, which is no fault.
pub(crate) fn one_line(error: &clap::Error, arguments: &[String]) -> Option<String> {
    let of = |kind| text(error, kind);
    let argument = of(ContextKind::InvalidArg);
    let value = of(ContextKind::InvalidValue);
    let fault = match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => return None,
        ErrorKind::MissingSubcommand | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            format!("no command is given, needed is one of: {}", commands())
        }
        ErrorKind::InvalidSubcommand => format!(
            "unknown command \"{}\", needed is one of: {}",
            of(ContextKind::InvalidSubcommand),
            commands()
        ),
        ErrorKind::MissingRequiredArgument => format!("missing is {argument}"),
        ErrorKind::UnknownArgument => format!("unknown argument \"{argument}\""),
        ErrorKind::ArgumentConflict => format!("{argument} is given more than once"),
        ErrorKind::InvalidValue if value.is_empty() => {
            format!("{argument} has no value, needed is one")
        }
        ErrorKind::InvalidValue => format!(
            "{argument} is \"{value}\", needed is one of: {}",
            of(ContextKind::ValidValue)
        ),
        ErrorKind::ValueValidation => {
            let needed = match &argument {
                percent if percent.contains("PERCENT") => "a number",
                seconds if seconds.contains("SECONDS") => "a number of seconds, zero or more",
                _ => "a whole number",
            };
            format!("{argument} is \"{value}\", needed is {needed}")
        }
        _ => first_line(&error.to_string()),
    };
    Some(format!("{fault}; see {} --help", command_of(arguments)))
}

/// A piece of what clap knows of its error.
fn text(error: &clap::Error, kind: ContextKind) -> String {
    match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        Some(ContextValue::Strings(texts)) => texts.join(", "),
        Some(ContextValue::Number(number)) => number.to_string(),
        _ => String::new(),
    }
}

fn first_line(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_string()
}

fn names() -> Vec<String> {
    use clap::CommandFactory;
    let names = crate::args::Cli::command();
    names
        .get_subcommands()
        .map(|command| command.get_name().to_string())
        .collect()
}

fn commands() -> String {
    names().join(", ")
}

/// `simgap`, with the subcommand if the arguments name one.
fn command_of(arguments: &[String]) -> String {
    match arguments.get(1).filter(|word| names().contains(word)) {
        Some(command) => format!("simgap {command}"),
        None => "simgap".to_string(),
    }
}
