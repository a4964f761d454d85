//! `simgap simulate`.

use std::path::Path;

use simgap_app::folder::{Folder, not_an_input};
use simgap_app::input;
use simgap_app::simulation::simulate;
use simgap_record::write_csv_atomic;

use crate::args::SimulateArgs;
use crate::error::CliError;
use crate::stdout::say;

pub(crate) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    not_an_input(&args.out, &[&args.model, &args.record])?;
    let (folder, files) = (parent(&args.out), [args.out.clone()]);
    Folder::attempt(folder, &[], &files)?;
    let model = input::model(&args.model)?;
    let record = input::record_of_inputs(&args.record, &model, &args.records.options())?;
    let found = simulate(&model, &record, args.from_rest)?;
    let columns: Vec<&[f64]> = found.columns.iter().map(Vec::as_slice).collect();
    let folder = Folder::make(folder, &[], &files)?;
    write_csv_atomic(&args.out, &found.headers, &columns)?;
    folder.keep();
    let notes = found.notes.iter().map(|note| format!("note: {note}\n"));
    say(&format!(
        "{}\n{}",
        args.out.display(),
        notes.collect::<String>()
    ))
}

/// The folder a file goes to.
fn parent(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
