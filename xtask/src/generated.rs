//! Files that are generated and committed: writing them, and comparing them with what is committed.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A generated file cannot be read, written or removed.
#[derive(Debug, Error)]
#[error("{}: {source}", .path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What the system says.
    pub source: std::io::Error,
}

fn refused(path: &Path) -> impl Fn(std::io::Error) -> FileError + '_ {
    |source| FileError {
        path: path.to_owned(),
        source,
    }
}

/// How a file differs from what is generated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// It is not there.
    Missing,
    /// Its text differs from this line on, counted from one.
    FromLine(usize),
    /// It lies among generated files, and nothing generates it.
    Strange,
}

/// The workspace this program was built in.
pub(crate) fn workspace_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Writes every file, and removes those in `folders`, which hold nothing but generated files, that are
/// no longer generated. Paths are from `root`.
pub(crate) fn write(
    root: &Path,
    folders: &[&str],
    files: &BTreeMap<String, String>,
) -> Result<(), FileError> {
    for folder in folders {
        let path = root.join(folder);
        fs::create_dir_all(&path).map_err(refused(&path))?;
    }
    for strange in strangers(root, folders, files)? {
        let path = root.join(strange);
        fs::remove_file(&path).map_err(refused(&path))?;
    }
    for (name, text) in files {
        let path = root.join(name);
        fs::write(&path, text).map_err(refused(&path))?;
    }
    Ok(())
}

/// Every file that is not as generated, byte for byte, by name; strange files last.
pub(crate) fn compare(
    root: &Path,
    folders: &[&str],
    files: &BTreeMap<String, String>,
) -> Result<Vec<(String, Change)>, FileError> {
    let mut changes = Vec::new();
    for (name, text) in files {
        let path = root.join(name);
        match fs::read(&path) {
            Ok(found) if found == text.as_bytes() => {}
            Ok(found) => {
                let line = first_difference(&found, text);
                changes.push((name.clone(), Change::FromLine(line)));
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                changes.push((name.clone(), Change::Missing));
            }
            Err(error) => return Err(refused(&path)(error)),
        }
    }
    let strangers = strangers(root, folders, files)?;
    changes.extend(strangers.into_iter().map(|name| (name, Change::Strange)));
    Ok(changes)
}

/// The line that holds the first byte in which two texts differ, counted from one.
fn first_difference(found: &[u8], text: &str) -> usize {
    let pairs = found.iter().zip(text.as_bytes());
    let same = pairs.take_while(|(a, b)| a == b);
    1 + same.filter(|(byte, _)| **byte == b'\n').count()
}

/// Files in the folders that are not generated.
fn strangers(
    root: &Path,
    folders: &[&str],
    files: &BTreeMap<String, String>,
) -> Result<Vec<String>, FileError> {
    let mut names = Vec::new();
    for folder in folders {
        let path = root.join(folder);
        let entries = match fs::read_dir(&path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == ErrorKind::NotFound => continue,
            Err(error) => return Err(refused(&path)(error)),
        };
        for entry in entries {
            let entry = entry.map_err(refused(&path))?;
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if !files.contains_key(&name) {
                names.push(name);
            }
        }
    }
    names.sort();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_first_different_line_is_named() {
        assert_eq!(first_difference(b"a\nb\n", "a\nc\n"), 2);
        assert_eq!(first_difference(b"a\n", "a\nc\n"), 2);
        assert_eq!(first_difference(b"b\n", "a\n"), 1);
    }

    #[test]
    fn verify_every_change_is_seen_and_mended() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let files: BTreeMap<String, String> = ["made/a", "made/b"]
            .map(|name| (name.to_owned(), "1\n2\n".to_owned()))
            .into();
        assert_eq!(compare(root, &["made"], &files).unwrap().len(), 2);
        write(root, &["made"], &files).unwrap();
        assert_eq!(compare(root, &["made"], &files).unwrap(), vec![]);
        fs::write(root.join("made/a"), "1\n3\n").unwrap();
        fs::remove_file(root.join("made/b")).unwrap();
        fs::write(root.join("made/c"), "").unwrap();
        let changes = [
            ("made/a".to_owned(), Change::FromLine(2)),
            ("made/b".to_owned(), Change::Missing),
            ("made/c".to_owned(), Change::Strange),
        ];
        assert_eq!(compare(root, &["made"], &files).unwrap(), changes);
        write(root, &["made"], &files).unwrap();
        assert_eq!(compare(root, &["made"], &files).unwrap(), vec![]);
    }
}
