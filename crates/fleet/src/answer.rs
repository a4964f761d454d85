//! One unit of work, answered: the same bytes wherever it is done.

use std::io::Read as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};
use simgap_app::AppError;
use simgap_app::diagnosis::{Question, distinct_stems};
use simgap_app::input::{self, Input, RecordOptions};
use simgap_app::text::{file_name, shown};
use simgap_diagnose::{Cancel, DiagnoseError, Limit};

use crate::FleetError;
use crate::row::{Row, rows};
use crate::table;
use crate::unit::Unit;

/// An answered unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answered {
    /// The bytes of its file of the table; `None` where the table has them already.
    pub bytes: Option<Vec<u8>>,
    /// Why the diagnosis failed, if it did.
    pub failed: Option<String>,
}

/// Answers a unit: reads its model and its records, diagnoses, and gives the file of the table. A diagnosis that fails is
/// a row with its reason.
///
/// # Errors
/// [`FleetError::Cancelled`] when the work was ended, [`FleetError::Encode`] when the rows cannot be written as Parquet.
pub fn answer(unit: &Unit, cancel: &Cancel) -> Result<Answered, FleetError> {
    let digest = digest(unit);
    if unit.known.as_ref() == Some(&digest) {
        return Ok(Answered {
            bytes: None,
            failed: None,
        });
    }
    // A defect ends one diagnosis and not the fleet: nothing of it is seen afterwards.
    let asked = catch_unwind(AssertUnwindSafe(|| asked(unit, cancel)));
    let found = match asked {
        Ok(Ok(rows)) => rows,
        Ok(Err(_)) if cancel.is_cancelled() => return Err(FleetError::Cancelled),
        Ok(Err(error)) => vec![Row::failed(reason(unit, &error))],
        Err(_) => vec![Row::failed(
            "a defect of simgap ended the diagnosis, needed is a report of it with these records"
                .to_owned(),
        )],
    };
    let failed = found.iter().find_map(|row| row.reason.clone());
    Ok(Answered {
        bytes: Some(table::encode(unit, &found, &digest)?),
        failed,
    })
}

fn asked(unit: &Unit, cancel: &Cancel) -> Result<Vec<Row>, AppError> {
    let paths = |names: &[String]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
    let (train, check) = (paths(&unit.train), paths(&unit.check));
    distinct_stems(if check.is_empty() { &train } else { &check })?;
    let path = Path::new(&unit.model);
    let model = input::model(path)?;
    let options = RecordOptions {
        map: unit.map.clone(),
        columns: unit.columns.clone(),
        mend: unit.mend,
    };
    let read = |paths: &[PathBuf]| -> Result<Vec<Input>, AppError> {
        let inputs = paths
            .iter()
            .map(|path| input::record(path, &model, &options));
        inputs.collect()
    };
    let (train, check) = (read(&train)?, read(&check)?);
    let question = Question {
        model: &model,
        model_file: Some(path),
        train: &train,
        check: &check,
        records: &options,
        withheld: &unit.withhold,
        seed: 0,
        limit: Limit::default(),
        plant: None,
        cancel: cancel.clone(),
    };
    question.refuse_repeats()?;
    question.answer(&|_| {}).map(|answer| rows(&answer))
}

/// The reason as the table keeps it: with names of files and not their folders, which differ between workers.
fn reason(unit: &Unit, error: &AppError) -> String {
    if let (AppError::Diagnose(DiagnoseError::NoRecord), true) = (error, unit.train.is_empty()) {
        return "no record to learn from: all are named by check".to_owned();
    }
    let files = unit.train.iter().chain(&unit.check).chain([&unit.model]);
    let text = files.fold(error.to_string(), |text, file| {
        text.replace(file.as_str(), &file_name(Path::new(file)))
    });
    shown(&text)
}

/// SHA-256 of everything that the answer depends on: version, model, records, how they are read, what is withheld.
/// A file that cannot be read counts by its name.
fn digest(unit: &Unit) -> String {
    let mut hash = Sha256::new();
    let mut add = |what: &str, bytes: &[u8]| {
        hash.update(format!("{what} {}\n", bytes.len()));
        hash.update(bytes);
    };
    add("version", env!("CARGO_PKG_VERSION").as_bytes());
    let withheld = unit.withhold.iter().map(|kind| ("withhold", kind));
    let mapped = unit.map.iter().map(|entry| ("map", entry));
    let columns = unit.columns.iter().map(|names| ("columns", names));
    for (what, text) in withheld.chain(mapped).chain(columns) {
        add(what, text.as_bytes());
    }
    if unit.mend {
        add("mend", b"");
    }
    let model = [("model", &unit.model)].into_iter();
    let train = unit.train.iter().map(|path| ("train", path));
    let check = unit.check.iter().map(|path| ("check", path));
    for (what, path) in model.chain(train).chain(check) {
        let path = Path::new(path);
        add(what, file_name(path).as_bytes());
        match file_digest(path) {
            Ok(digest) => add("content", &digest),
            Err(_) => add("unreadable", b""),
        }
    }
    hex(&hash.finalize())
}

/// SHA-256 of a file, block by block.
fn file_digest(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut file = std::fs::File::open(path)?;
    let mut hash = Sha256::new();
    let mut block = vec![0; 1 << 16];
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hash.finalize().to_vec()),
            read => hash.update(&block[..read]),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
