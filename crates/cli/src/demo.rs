//! `simgap demo`: the main job on embedded data.

use simgap_record::{Batch, ensure_writable_dir};

use crate::args::{DemoArgs, DiagnoseArgs, Format};
use crate::diagnose;
use crate::error::CliError;
use crate::record_args::RecordArgs;

/// Generated records of the mold oscillator; `fixtures/demo/README.md` says how they were made.
const FILES: [(&str, &str); 5] = [
    (
        "README.md",
        include_str!("../../../fixtures/demo/README.md"),
    ),
    (
        "model.toml",
        include_str!("../../../fixtures/demo/model.toml"),
    ),
    (
        "train-1.csv",
        include_str!("../../../fixtures/demo/train-1.csv"),
    ),
    (
        "train-2.csv",
        include_str!("../../../fixtures/demo/train-2.csv"),
    ),
    (
        "check.csv",
        include_str!("../../../fixtures/demo/check.csv"),
    ),
];

/// Writes the embedded files and diagnoses them as a user would.
pub(crate) fn run(args: &DemoArgs) -> Result<(), CliError> {
    ensure_writable_dir(&args.out)?;
    let mut batch = Batch::default();
    for (name, text) in FILES {
        batch.add(&args.out.join(name), text)?;
    }
    batch.commit()?;
    diagnose::run(&DiagnoseArgs {
        model: args.out.join("model.toml"),
        train: vec![args.out.join("train-1.csv"), args.out.join("train-2.csv")],
        check: vec![args.out.join("check.csv")],
        records: RecordArgs::default(),
        out: args.out.join("diagnosis"),
        withhold: vec![],
        jobs: None,
        budget: None,
        sets: false,
        seed: 0,
        format: Format::Human,
    })
}
