//! The folder of the results: tried before the work, filled after it, never left half made.

use std::path::{Path, PathBuf};

use simgap_record::{ensure_replaceable, ensure_writable_dir};

use crate::AppError;

/// A folder that was made to be filled. Dropped without [`Folder::keep`], what was made of it
/// and is still empty is removed again.
pub struct Folder {
    made: Vec<PathBuf>,
}

impl Folder {
    /// Makes `out` and the folders `inside` it, writable, with neither a folder nor a
    /// device where one of `files` goes.
    ///
    /// # Errors
    /// [`AppError`] when it cannot be made or written to.
    pub fn make(out: &Path, inside: &[&str], files: &[PathBuf]) -> Result<Folder, AppError> {
        if let Some(taken) = files.iter().find(|file| file.is_dir()) {
            return Err(AppError::FolderInPlace {
                path: taken.clone(),
            });
        }
        files.iter().try_for_each(|file| ensure_replaceable(file))?;
        let mut folder = Folder { made: vec![] };
        for path in std::iter::once(out.to_path_buf()).chain(inside.iter().map(|i| out.join(i))) {
            let missing = path.ancestors().take_while(|part| {
                !part.as_os_str().is_empty() && std::fs::symlink_metadata(part).is_err()
            });
            // The innermost last, so that removal in reverse meets empty folders.
            let missing: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
            folder.made.extend(missing.into_iter().rev());
            ensure_writable_dir(&path)?;
        }
        Ok(folder)
    }

    /// Whether the folder can be made; nothing stays of the attempt.
    ///
    /// # Errors
    /// As [`Folder::make`].
    pub fn attempt(out: &Path, inside: &[&str], files: &[PathBuf]) -> Result<(), AppError> {
        Folder::make(out, inside, files).map(drop)
    }

    /// Keeps the folder.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for made in self.made.iter().rev() {
            let _ = std::fs::remove_dir(made);
        }
    }
}

/// Refuses to write over what is read.
///
/// # Errors
/// [`AppError::OverInput`].
pub fn not_an_input(out: &Path, inputs: &[&Path]) -> Result<(), AppError> {
    let Ok(target) = out.canonicalize() else {
        return Ok(());
    };
    let same = |input: &&&Path| input.canonicalize().is_ok_and(|path| path == target);
    match inputs.iter().find(same) {
        Some(_) => Err(AppError::OverInput { path: out.into() }),
        None => Ok(()),
    }
}
