//! `simgap completions` and `simgap man`: both from the definition of the arguments.

use std::path::Path;

use clap::CommandFactory as _;
use clap::builder::PossibleValuesParser;
use simgap_app::folder::Folder;
use simgap_effects::catalogue;
use simgap_record::Batch;

use crate::args::{Cli, CompletionsArgs, ManArgs};
use crate::error::CliError;
use crate::stdout::say_plain;

/// Name of the program.
const NAME: &str = "simgap";

pub(crate) fn completions(args: &CompletionsArgs) -> Result<(), CliError> {
    // The kinds of the catalogue are completed; elsewhere an unknown one has a better message than
    // the list of all.
    let kinds = || PossibleValuesParser::new(catalogue().iter().map(|effect| effect.kind()));
    let mut command = Cli::command()
        .mut_subcommand("effects", |c| {
            c.mut_arg("kind", |kind| kind.value_parser(kinds()))
        })
        .mut_subcommand("diagnose", |c| {
            c.mut_arg("withhold", |kind| kind.value_parser(kinds()))
        });
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, NAME, &mut script);
    say_plain(&String::from_utf8_lossy(&script))
}

pub(crate) fn man(args: &ManArgs) -> Result<(), CliError> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut pages = vec![(NAME.to_string(), page(command.clone()))];
    for part in command.get_subcommands() {
        let name = format!("{NAME}-{}", part.get_name());
        pages.push((name, page(part.clone())));
    }
    let Some(out) = &args.out else {
        return say_plain(&pages.swap_remove(0).1);
    };
    let file = |name: &str| out.join(format!("{name}.1"));
    let files: Vec<_> = pages.iter().map(|(name, _)| file(name)).collect();
    let folder = Folder::make(out, &[], &files)?;
    let mut batch = Batch::default();
    for (name, text) in &pages {
        batch.add(&file(name), text)?;
    }
    batch.commit()?;
    folder.keep();
    say_plain(&listed(out, pages.len()))
}

fn listed(out: &Path, count: usize) -> String {
    format!("{count} pages in {}\n", out.display())
}

fn page(command: clap::Command) -> String {
    let mut text = Vec::new();
    // A Vec takes whatever is written to it.
    let source = format!("{NAME} {}", env!("CARGO_PKG_VERSION"));
    let _ = clap_mangen::Man::new(command)
        .source(source)
        .render(&mut text);
    String::from_utf8_lossy(&text).into_owned()
}
