//! What keeps the readers of other crates to our rules: one line for a damaged file, no panic.

use crate::faults::FormatFault;
use crate::panics::without_panic;

/// Calls a reader of another crate, whose panics become errors.
///
/// Some checks of such readers are assertions: `parquet` 60 panics on one in 50 000 damaged files.
/// Nothing that the call changes is seen after a panic but counters, so there is nothing to be left
/// half done. The message of a panic is not printed, since what it says is in the error as far as
/// it helps; the hook that prints it is the process's, so ours hands on every other panic.
pub(crate) fn guarded<T>(
    what: &str,
    read: impl FnOnce() -> Result<T, FormatFault>,
) -> Result<T, FormatFault> {
    without_panic(read).unwrap_or_else(|| {
        Err(FormatFault::Damaged {
            what: what.to_owned(),
            reason: "its bytes contradict each other".to_owned(),
        })
    })
}

/// What another crate says, fit for one line of ours.
pub(crate) fn one_line(text: &str) -> String {
    const SHOWN: usize = 160;
    let mut line: String = text
        .chars()
        .take(SHOWN)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(SHOWN).is_some() {
        line.push('…');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_panic_of_a_reader_is_an_error() {
        let empty: [u8; 0] = [];
        let at = empty.len() + 3;
        let error = guarded("a page", || Ok(empty[at..][0])).err();
        let said = error.map(|error| error.to_string());
        let needed = "a page cannot be read (its bytes contradict each other); the file is cut off, \
                      damaged or of a form that is not known";
        assert_eq!(said.as_deref(), Some(needed));
        assert_eq!(guarded("a page", || Ok(7)).ok(), Some(7));
    }
}
