//! `simgap init`: a commented model file to fill in, with the columns of a record where there is one.

mod guess;
mod template;

use std::path::Path;

use simgap_app::folder::{Folder, not_an_input};
use simgap_app::input::{self, Input};
use simgap_app::text::command;
use simgap_model::Model;
use simgap_record::{Record, write_text_atomic};

use crate::args::InitArgs;
use crate::error::CliError;
use crate::stdout::{say, say_plain};
use crate::text::{STRONG, figure, named, shown, styled, table};
use guess::{Roles, roles};

/// Where the text of a named line begins.
const INDENT: usize = 10;

pub(crate) fn run(args: &InitArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        if out.exists() && !args.force {
            return Err(CliError::Exists { path: out.clone() });
        }
        if let Some(record) = &args.record {
            not_an_input(out, &[record])?;
        }
    }
    let read = args.record.as_deref();
    let read = read
        .map(|path| input::table(path, &args.reading.options()))
        .transpose()?;
    let (record, notes) = match read {
        Some(Input { record, notes, .. }) => (Some(record), notes),
        None => (None, vec![]),
    };
    let roles = roles(args.like, record.as_deref());
    let text = template::model_file(&roles, record.as_deref());
    let path = || args.out.clone().unwrap_or_else(|| "model.toml".into());
    // What is handed out must be a model file, whatever the columns are called.
    Model::from_toml(&text).map_err(|error| CliError::Model {
        path: path(),
        error,
    })?;
    let Some(out) = &args.out else {
        return say_plain(&text);
    };
    let parent = match out.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let folder = Folder::make(parent, &[], std::slice::from_ref(out))?;
    write_text_atomic(out, &text)?;
    folder.keep();
    say(&told(args, &roles, record.as_deref(), &notes, out))
}

/// What was taken for what, and what to do now.
fn told(
    args: &InitArgs,
    roles: &Roles,
    record: Option<&Record>,
    notes: &[String],
    out: &Path,
) -> String {
    let mut text = String::new();
    if let Some(record) = record {
        text.push_str(&format!("{}\n", styled(STRONG, &shown(record.name()))));
        let rows: Vec<Vec<String>> = record
            .channels()
            .iter()
            .map(|channel| {
                let values = || channel.values.iter().copied();
                vec![
                    shown(&channel.name),
                    shown(channel.unit.symbol()),
                    figure(values().fold(f64::INFINITY, f64::min)),
                    figure(values().fold(f64::NEG_INFINITY, f64::max)),
                    roles.of(&channel.name),
                ]
            })
            .collect();
        let head = ["column", "unit", "smallest", "largest", "taken for"];
        table(&mut text, &head, &rows, &[2, 3]);
        text.push('\n');
    }
    for warning in &roles.warnings {
        named(&mut text, "mind", warning, INDENT);
    }
    for (i, note) in notes.iter().enumerate() {
        named(&mut text, if i == 0 { "notes" } else { "" }, note, INDENT);
    }
    let model = out.display();
    named(&mut text, "written", &model.to_string(), INDENT);
    let next = match &args.record {
        Some(_) => "put in your numbers, then",
        None => "put in your numbers and columns, then",
    };
    named(&mut text, "next", next, INDENT);
    // On a line of its own, whatever its length: it is there to be copied.
    text.push_str(&format!("{:INDENT$}{}\n", "", shown(&try_it(args, out))));
    text
}

/// The command that tries the model on the record.
fn try_it(args: &InitArgs, model: &Path) -> String {
    let record = args.record.as_deref().unwrap_or(Path::new("RECORD"));
    let word = |path: &Path| path.display().to_string();
    let mut words = vec!["simgap".into(), "simulate".into(), word(model)];
    words.extend(["--record".into(), word(record)]);
    for (name, value) in args.reading.options().words() {
        words.push(name.into());
        words.extend(value);
    }
    words.extend(["--out".into(), "predicted.csv".into()]);
    command(&words)
}
