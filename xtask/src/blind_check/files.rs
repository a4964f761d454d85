//! Where the cases of a campaign lie.

use std::fs;
use std::path::{Path, PathBuf};

use super::BlindCheckError;

/// The files of a case, all that its diagnosis is given.
pub(super) const MODEL: &str = "model.toml";
/// Records to learn from.
pub(super) const TRAIN: [&str; 2] = ["a.csv", "b.csv"];
/// The record to judge by.
pub(super) const CHECK: &str = "c.csv";

/// Folders of a campaign: removed at its end unless they are kept.
pub(super) struct Places {
    /// One folder for each case.
    cases: PathBuf,
    /// What the workers said.
    answers: PathBuf,
    /// A copy of this program: a campaign is answered by one program, whatever is built meanwhile.
    pub(super) program: PathBuf,
    /// Where opened truths are laid, if they are kept.
    pub(super) opened: Option<PathBuf>,
    _temporary: tempfile::TempDir,
}

impl Places {
    pub(super) fn new(keep: Option<&Path>, program: &Path) -> Result<Places, BlindCheckError> {
        let temporary = tempfile::Builder::new().prefix("simgap-cases-").tempdir();
        let temporary = temporary.map_err(at(&std::env::temp_dir()))?;
        let root = keep.map_or_else(|| temporary.path().to_path_buf(), Path::to_path_buf);
        let copy = temporary.path().join("worker");
        fs::copy(program, &copy).map_err(at(program))?;
        let places = Places {
            cases: root.join("cases"),
            answers: root.join("answers"),
            program: copy,
            opened: keep.map(|folder| folder.join("truths.jsonl")),
            _temporary: temporary,
        };
        for folder in [&places.cases, &places.answers] {
            fs::create_dir_all(folder).map_err(at(folder))?;
        }
        Ok(places)
    }

    /// Folder of a case.
    pub(super) fn of_case(&self, name: &str) -> PathBuf {
        self.cases.join(name)
    }

    /// File that a worker writes its answer to, or its errors.
    pub(super) fn of_answer(&self, name: &str, extension: &str) -> PathBuf {
        self.answers.join(format!("{name}.{extension}"))
    }
}

/// File of an answer in a folder that is kept.
pub(super) fn answer(kept: &Path, name: &str, extension: &str) -> PathBuf {
    kept.join("answers").join(format!("{name}.{extension}"))
}

/// An error of a file.
pub(super) fn at(path: &Path) -> impl Fn(std::io::Error) -> BlindCheckError {
    let path = path.display().to_string();
    move |source| BlindCheckError::File {
        path: path.clone(),
        source,
    }
}

pub(super) fn write(path: &Path, text: &str) -> Result<(), BlindCheckError> {
    fs::write(path, text).map_err(at(path))
}

pub(super) fn read(path: &Path) -> Result<Vec<u8>, BlindCheckError> {
    fs::read(path).map_err(at(path))
}
