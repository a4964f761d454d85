//! A file that is made beside another one.

use std::io;
use std::path::Path;

/// The folder that a file is in.
pub(crate) fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A file beside the target that vanishes unless it is renamed.
pub(crate) fn new_file_in(dir: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".simgap-").suffix(".part");
    #[cfg(unix)]
    {
        // A temporary file is private by default; a result is for everyone the umask allows.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // Without the random name of the file beside: a message repeats itself to the letter.
    builder
        .tempfile_in(dir)
        .map_err(|refused| io::Error::from(refused.kind()))
}
