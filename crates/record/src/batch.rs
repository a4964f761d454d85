//! Files that are written together: all of them, or none.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use crate::RecordError;
use crate::csv_write::checked_csv;
use crate::new_file::{new_file_in, parent};

/// Symbolic links that lead to a file, one after the other.
const MOST_LINKS: usize = 40;

/// Files that are written together.
///
/// [`Batch::add`] writes each beside its place, so that a full disk is met before anything is
/// changed; [`Batch::commit`] renames them all. What is dropped before is gone without a trace.
///
/// A symbolic link is written through, and what is no regular file (a device, a FIFO, a socket) is
/// refused.
///
/// ```
/// use simgap_record::Batch;
///
/// let dir = tempfile::tempdir()?;
/// let [a, b] = ["a.txt", "b.txt"].map(|name| dir.path().join(name));
/// let mut batch = Batch::default();
/// batch.add(&a, "one\n")?;
/// batch.add(&b, "two\n")?;
/// assert!(!a.exists());
/// batch.commit()?;
/// assert_eq!(std::fs::read_to_string(b)?, "two\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct Batch {
    staged: Vec<Staged>,
}

/// A file that is written and not yet in its place.
#[derive(Debug)]
struct Staged {
    /// Path as given.
    label: String,
    target: PathBuf,
    new: TempPath,
}

/// What stood in a place before.
enum Before {
    Nothing,
    /// Another name of the old file, which vanishes when dropped.
    File(TempPath),
    /// A file that could not be given another name.
    Lost,
}

impl Batch {
    /// Writes a file beside its place.
    ///
    /// # Errors
    ///
    /// [`RecordError::Unwritable`] when the place is no regular file, or when the system refuses.
    pub fn add(&mut self, path: &Path, content: impl AsRef<[u8]>) -> Result<(), RecordError> {
        let stage = || {
            let target = target(path)?;
            let mut file = new_file_in(parent(&target))?;
            // The file itself: its wrapper would tell a random name.
            file.as_file_mut().write_all(content.as_ref())?;
            Ok((target, file.into_temp_path()))
        };
        let label = path.display().to_string();
        let (target, new) = stage().map_err(|source| unwritable(&label, source))?;
        self.staged.push(Staged { label, target, new });
        Ok(())
    }

    /// As [`Batch::add`], of columns as CSV; see [`crate::write_csv_atomic`]. Gives the text.
    ///
    /// # Errors
    ///
    /// As [`crate::write_csv_atomic`].
    pub fn add_csv(
        &mut self,
        path: &Path,
        headers: &[String],
        columns: &[&[f64]],
    ) -> Result<String, RecordError> {
        let text = checked_csv(path, headers, columns)?;
        self.add(path, &text)?;
        Ok(text)
    }

    /// Puts all files in their places. Where one cannot be, those before it are taken back.
    ///
    /// # Errors
    ///
    /// [`RecordError::Unwritable`] when the system refuses; everything is then as it was.
    pub fn commit(self) -> Result<(), RecordError> {
        let mut done: Vec<(PathBuf, Before)> = Vec::with_capacity(self.staged.len());
        for Staged { label, target, new } in self.staged {
            let before = before(&target);
            if let Err(refused) = new.persist(&target) {
                done.into_iter().rev().for_each(take_back);
                return Err(unwritable(&label, refused.error));
            }
            done.push((target, before));
        }
        Ok(())
    }
}

fn unwritable(label: &str, source: io::Error) -> RecordError {
    RecordError::Unwritable {
        path: label.to_owned(),
        source,
    }
}

fn before(target: &Path) -> Before {
    if fs::symlink_metadata(target).is_err() {
        return Before::Nothing;
    }
    // Another name of the same file takes no space and leaves the old one in its place.
    let mut builder = tempfile::Builder::new();
    builder.prefix(".simgap-").suffix(".old");
    let named = builder.make_in(parent(target), |name| fs::hard_link(target, name));
    named.map_or(Before::Lost, |file| Before::File(file.into_temp_path()))
}

/// As well as it goes: there is no second way.
fn take_back((target, before): (PathBuf, Before)) {
    match before {
        Before::Nothing => {
            let _ = fs::remove_file(&target);
        }
        Before::File(old) => {
            let _ = old.persist(&target);
        }
        Before::Lost => {}
    }
}

/// Refuses a place where a file would replace something else.
///
/// # Errors
///
/// [`RecordError::Unwritable`] for a device, a FIFO or a socket, also behind a symbolic link.
pub fn ensure_replaceable(path: &Path) -> Result<(), RecordError> {
    let label = || path.display().to_string();
    target(path)
        .map(drop)
        .map_err(|source| unwritable(&label(), source))
}

/// The place that a path leads to: that behind symbolic links, whether there is a file or not.
pub(crate) fn target(path: &Path) -> io::Result<PathBuf> {
    if let Ok(there) = fs::metadata(path)
        && let Some(what) = special(&there.file_type())
    {
        let needed = "a file or nothing there is needed";
        let refused = format!("it is a {what}, which is never replaced; {needed}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, refused));
    }
    let mut place = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let is_link = fs::symlink_metadata(&place).is_ok_and(|there| there.is_symlink());
        if !is_link {
            return Ok(place);
        }
        place = parent(&place).join(fs::read_link(&place)?);
    }
    Err(io::Error::other("the symbolic link leads in a circle"))
}

/// What is neither a file nor a directory.
fn special(kind: &fs::FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return Some("pipe (FIFO)");
        }
        if kind.is_socket() {
            return Some("socket");
        }
    }
    (!kind.is_file() && !kind.is_dir()).then_some("device")
}
