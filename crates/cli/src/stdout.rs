//! What is written on stdout.

use std::io::Write as _;

use crate::error::CliError;

/// Text on stdout, in colours where a terminal shows them and `NO_COLOR` does not forbid it.
pub(crate) fn say(text: &str) -> Result<(), CliError> {
    print(anstream::stdout().lock(), text)
}

/// Text on stdout as it is.
pub(crate) fn say_plain(text: &str) -> Result<(), CliError> {
    print(std::io::stdout().lock(), text)
}

fn print(mut out: impl std::io::Write, text: &str) -> Result<(), CliError> {
    let possible = can_be_written().and_then(|()| out.write_all(text.as_bytes()));
    written(possible.and_then(|()| out.flush()))
}

/// The library takes a stdout that is open for reading alone for one that nobody looks at; the
/// system does not.
fn can_be_written() -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd as _;
        let stdout = std::io::stdout().as_fd().try_clone_to_owned()?;
        std::fs::File::from(stdout).write(&[]).map(drop)?;
    }
    Ok(())
}

/// A reader that closes the pipe early, as `head` does, has seen what it wanted.
pub(crate) fn written(result: std::io::Result<()>) -> Result<(), CliError> {
    match result {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(CliError::Stdout { found: error })
        }
        _ => Ok(()),
    }
}
