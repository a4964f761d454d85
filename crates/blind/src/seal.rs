//! Answers that are laid down before the questions are asked.
//!
//! The truths of a campaign are one text, one line a case. Its SHA-256 digest is published before
//! anything is diagnosed and holds the text to what it was; each line also holds the digests of the
//! files that the diagnosis is given.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::{BlindError, Truth};

/// One case as it is sealed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SealedCase {
    /// Number only, such as `case-0017`.
    pub name: String,
    /// SHA-256 of each file that the diagnosis is given, by name.
    pub files: BTreeMap<String, String>,
    /// What it is not given.
    pub truth: Truth,
}

/// SHA-256 in hexadecimal digits.
///
/// The digest is that of FIPS 180-4.
///
/// ```
/// let digest = simgap_blind::sha256(b"abc");
/// assert!(digest.starts_with("ba7816bf8f01cfea") && digest.len() == 64);
/// ```
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The text of the truths; its digest is [`sha256`] of it.
///
/// # Errors
/// [`BlindError::Seal`] for a truth that is no text.
pub fn seal(cases: &[SealedCase]) -> Result<String, BlindError> {
    let mut text = String::new();
    for case in cases {
        text.push_str(&serde_json::to_string(case).map_err(BlindError::Seal)?);
        text.push('\n');
    }
    Ok(text)
}

/// The truths again, if they are still those of the digest.
///
/// # Errors
/// [`BlindError::BrokenSeal`] when the text has another digest, [`BlindError::Seal`] when it is no
/// text of truths.
pub fn open(text: &str, digest: &str) -> Result<Vec<SealedCase>, BlindError> {
    let found = sha256(text.as_bytes());
    if found != digest {
        return Err(BlindError::BrokenSeal {
            found,
            needed: digest.to_string(),
        });
    }
    text.lines()
        .map(|line| serde_json::from_str(line).map_err(BlindError::Seal))
        .collect()
}
