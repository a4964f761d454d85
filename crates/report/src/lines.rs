//! The answer alone, a sentence a line, for programs that lay out text themselves.

use simgap_diagnose::{Diagnosis, Status};
use simgap_model::Location;

use crate::wording::{headline, particulars};

/// What is named, with values, intervals and probabilities; nothing where nothing is named.
///
/// Control characters in names are dropped, and spaces that must not break are plain.
#[must_use]
pub fn answer_lines(diagnosis: &Diagnosis) -> Vec<String> {
    if matches!(diagnosis.verdict.status, Status::None | Status::Unknown) {
        return vec![];
    }
    let mut lines = vec![headline(diagnosis)];
    lines.extend(particulars(diagnosis, &|_: &Location| String::new()));
    let plain = |line: &String| -> String {
        let spaced = line
            .chars()
            .map(|c| if c.is_whitespace() { ' ' } else { c });
        spaced.filter(|c| !c.is_control()).collect()
    };
    lines.iter().map(plain).collect()
}
