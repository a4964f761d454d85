//! What is odd about records before the physics, for people and for programs.

use serde::Serialize;
use simgap_record::AuditFinding;

use crate::text::named;

/// Where the text of a named line begins.
const INDENT: usize = 14;

/// A finding in a file.
#[derive(Serialize)]
pub(crate) struct Entry {
    record: String,
    topic: &'static str,
    text: String,
}

impl Entry {
    pub(crate) fn new(finding: &AuditFinding) -> Entry {
        Entry {
            record: finding.record.clone(),
            topic: finding.topic.name(),
            text: finding.text.clone(),
        }
    }
}

/// The findings, a line each; nothing where there are none.
pub(crate) fn told(findings: &[AuditFinding]) -> String {
    let mut text = String::new();
    for (i, finding) in findings.iter().enumerate() {
        let name = if i == 0 { "audit" } else { "" };
        named(&mut text, name, &finding.to_string(), INDENT);
    }
    if !findings.is_empty() {
        text.push('\n');
    }
    text
}
