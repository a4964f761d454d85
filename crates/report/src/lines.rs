//! The answer alone, a sentence a line, for programs that lay out text themselves; and lines that fit a
//! terminal.

use simgap_diagnose::{Diagnosis, Status};

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
    lines.extend(particulars(diagnosis));
    let plain = |line: &String| -> String {
        let spaced = line
            .chars()
            .map(|c| if c.is_whitespace() { ' ' } else { c });
        spaced.filter(|c| !c.is_control()).collect()
    };
    lines.iter().map(plain).collect()
}

/// Lines of at most `width` characters; a longer word has a line of its own. Spaces that must not break
/// hold.
#[must_use]
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split(' ').filter(|w| !w.is_empty()) {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}
