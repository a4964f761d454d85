//! Writing the generated files, or comparing them with what is committed.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use super::ReproduceError;

/// Directories that hold nothing but generated files.
const GENERATED: [&str; 2] = ["docs/reproduction", "fixtures/reproduction"];

/// What became of the generated files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// So many were written.
    Written(usize),
    /// So many are committed as generated.
    Same(usize),
    /// These are not; each line names a file and what is wrong.
    Differs(Vec<String>),
}

impl Outcome {
    /// Whether the exit status is zero.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        !matches!(self, Self::Differs(_))
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Written(count) => write!(f, "reproduce-paper: {count} files written"),
            Self::Same(count) => write!(f, "reproduce-paper: {count} files are as generated"),
            Self::Differs(lines) => {
                write!(f, "reproduce-paper: {} files differ", lines.len())?;
                lines.iter().try_for_each(|line| write!(f, "\n  {line}"))
            }
        }
    }
}

/// The workspace this program was built in.
pub(crate) fn workspace_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn in_file(path: &Path) -> impl Fn(std::io::Error) -> ReproduceError + '_ {
    |source| ReproduceError::File {
        path: path.to_owned(),
        source,
    }
}

/// Writes every file and removes generated files that are no longer generated.
pub(crate) fn write(
    root: &Path,
    files: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    for directory in GENERATED {
        let path = root.join(directory);
        fs::create_dir_all(&path).map_err(in_file(&path))?;
    }
    for stale in stale(root, files)? {
        let path = root.join(stale);
        fs::remove_file(&path).map_err(in_file(&path))?;
    }
    for (name, text) in files {
        let path = root.join(name);
        fs::write(&path, text).map_err(in_file(&path))?;
    }
    Ok(Outcome::Written(files.len()))
}

/// Compares byte for byte.
pub(crate) fn compare(
    root: &Path,
    files: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    let mut lines: Vec<String> = Vec::new();
    for (name, text) in files {
        let path = root.join(name);
        match fs::read(&path) {
            Ok(found) if found == text.as_bytes() => {}
            Ok(found) => lines.push(format!("{name}: {}", first_difference(&found, text))),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                lines.push(format!("{name}: missing"));
            }
            Err(error) => return Err(in_file(&path)(error)),
        }
    }
    lines.extend(
        stale(root, files)?
            .into_iter()
            .map(|name| format!("{name}: not generated")),
    );
    Ok(if lines.is_empty() {
        Outcome::Same(files.len())
    } else {
        Outcome::Differs(lines)
    })
}

fn first_difference(found: &[u8], text: &str) -> String {
    let at = found
        .iter()
        .zip(text.as_bytes())
        .take_while(|(a, b)| a == b)
        .count();
    let line = 1 + text.as_bytes()[..at]
        .iter()
        .filter(|byte| **byte == b'\n')
        .count();
    format!("differs from line {line} on")
}

/// Files in the generated directories that are not generated.
fn stale(root: &Path, files: &BTreeMap<String, String>) -> Result<Vec<String>, ReproduceError> {
    let mut names = Vec::new();
    for directory in GENERATED {
        let path = root.join(directory);
        let entries = match fs::read_dir(&path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
            Err(error) => return Err(in_file(&path)(error)),
        };
        for entry in entries {
            let entry = entry.map_err(in_file(&path))?;
            let name = format!("{directory}/{}", entry.file_name().to_string_lossy());
            if !files.contains_key(&name) {
                names.push(name);
            }
        }
    }
    names.sort();
    Ok(names)
}
