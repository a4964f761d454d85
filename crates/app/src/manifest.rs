//! What a command wrote into a folder of results, kept there in a file, so that the next run can
//! take away what it no longer writes and leave alone what others put there.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};
use simgap_record::Batch;

use crate::AppError;
use crate::folder::Folder;

/// The file in the folder.
const NAME: &str = ".simgap-files.json";
/// Its schema.
const SCHEMA: &str = "simgap-files/1";
/// No list of files is longer, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// The list: what each command wrote last.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Manifest {
    schema: String,
    commands: BTreeMap<String, Vec<Written>>,
}

/// A file as it was written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Written {
    /// Path in the folder, with slashes.
    file: String,
    bytes: u64,
    /// FNV-1a, 64 bits, of its bytes.
    fnv1a: String,
}

/// A folder that is being filled with a result. Nothing in it changes before [`Results::finish`],
/// which replaces all files together.
pub struct Results<'a> {
    out: &'a Path,
    command: &'static str,
    batch: Batch,
    written: Vec<Written>,
}

impl<'a> Results<'a> {
    /// A folder to be filled by a command, whose name the list of files keeps.
    #[must_use]
    pub fn new(out: &'a Path, command: &'static str) -> Results<'a> {
        Results {
            out,
            command,
            batch: Batch::default(),
            written: vec![],
        }
    }

    /// Adds a file, by its path in the folder.
    ///
    /// # Errors
    /// [`AppError::Record`] when it cannot be written there.
    pub fn add(&mut self, file: &Path, text: &str) -> Result<(), AppError> {
        self.batch.add(&self.out.join(file), text)?;
        self.written.push(Written::of(file, text.as_bytes()));
        Ok(())
    }

    /// Adds columns as CSV.
    ///
    /// # Errors
    /// [`AppError::Record`] when they cannot be written there.
    pub fn add_csv(
        &mut self,
        file: &Path,
        headers: &[String],
        columns: &[&[f64]],
    ) -> Result<(), AppError> {
        let path = self.out.join(file);
        let text = self.batch.add_csv(&path, headers, columns)?;
        self.written.push(Written::of(file, text.as_bytes()));
        Ok(())
    }

    /// Puts the files in their places, and takes away those of the command's earlier run that are
    /// not among them and are still as it wrote them.
    ///
    /// # Errors
    /// [`AppError`] when a file cannot be put in its place; none is replaced then.
    pub fn finish(self, folder: Folder) -> Result<(), AppError> {
        // Dropped before the folder, which can be removed only then.
        let Results {
            out,
            command,
            mut batch,
            written,
        } = self;
        let path = out.join(NAME);
        let mut manifest = read(&path);
        let earlier = manifest.commands.remove(command).unwrap_or_default();
        let is_kept = |old: &Written| written.iter().any(|new| new.file == old.file);
        let stale: Vec<Written> = earlier.into_iter().filter(|old| !is_kept(old)).collect();
        // Until the stale files are gone they stay listed: a run that is cut short forgets none.
        let mut list = |written: Vec<Written>| {
            manifest.commands.insert(command.to_string(), written);
            crate::json(&manifest)
        };
        let during = list([written.as_slice(), &stale].concat())?;
        let after = list(written)?;
        batch.add(&path, &during)?;
        let mut last = Batch::default();
        last.add(&path, &after)?;
        batch.commit()?;
        folder.keep();
        for old in &stale {
            remove(out, old);
        }
        Ok(last.commit()?)
    }
}

impl Written {
    fn of(file: &Path, bytes: &[u8]) -> Written {
        let parts: Vec<_> = file.iter().map(|part| part.to_string_lossy()).collect();
        Written {
            file: parts.join("/"),
            bytes: bytes.len() as u64,
            fnv1a: format!("{:016x}", fnv1a(bytes)),
        }
    }

    /// The place in a folder; `None` for a path that leads out of it.
    fn place(&self, out: &Path) -> Option<PathBuf> {
        let path = Path::new(&self.file);
        let inside = path.components().all(|c| matches!(c, Component::Normal(_)));
        (inside && !self.file.is_empty()).then(|| out.join(path))
    }
}

/// The list in a folder, empty where there is none or none that can be understood.
fn read(path: &Path) -> Manifest {
    let small = std::fs::metadata(path).is_ok_and(|there| there.len() <= MOST_BYTES);
    let text = small.then(|| std::fs::read_to_string(path).ok()).flatten();
    let found = text.and_then(|text| serde_json::from_str::<Manifest>(&text).ok());
    let known = found.filter(|manifest| manifest.schema == SCHEMA);
    known.unwrap_or_else(|| Manifest {
        schema: SCHEMA.to_string(),
        ..Manifest::default()
    })
}

/// Removes a file that is as it was written, and its folder if that is empty then.
fn remove(out: &Path, old: &Written) {
    let Some(path) = old.place(out) else {
        return;
    };
    let is_file = std::fs::symlink_metadata(&path)
        .is_ok_and(|there| there.is_file() && there.len() == old.bytes);
    let same = is_file
        && std::fs::read(&path).is_ok_and(|bytes| format!("{:016x}", fnv1a(&bytes)) == old.fnv1a);
    if same && std::fs::remove_file(&path).is_ok() {
        let folder = path.parent().filter(|folder| *folder != out);
        let _ = folder.map(std::fs::remove_dir);
    }
}

/// The hash of Fowler, Noll and Vo, 64 bits: h ← (h xor byte) · prime.
fn fnv1a(bytes: &[u8]) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
    bytes.iter().fold(OFFSET, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(PRIME)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values of the authors' own table.
    #[test]
    fn verify_the_hash() {
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn verify_no_path_leads_out_of_the_folder() {
        let place = |file: &str| {
            let written = Written {
                file: file.into(),
                bytes: 0,
                fnv1a: String::new(),
            };
            written.place(Path::new("out"))
        };
        assert_eq!(place("a/b.csv"), Some("out/a/b.csv".into()));
        for file in ["", "..", "../x", "a/../../x", "/etc/passwd"] {
            assert_eq!(place(file), None, "{file}");
        }
    }
}
