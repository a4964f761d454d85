//! A seal on the published numbers.

use crate::TableError;
use crate::paper::{TABLE1, TABLE2, TABLE3, TABLE4, TABLE5};
use crate::stated::STATED;

/// Committed checksums of the fixtures' text, by file name.
///
/// A published number is never rewritten by a tool; a correction of the transcription is made by
/// hand, here and in the fixture, and says why.
pub const CHECKSUMS: [(&str, u64); 6] = [
    ("table1.toml", 0x8e56_944f_8441_994f),
    ("table2.toml", 0xef20_0782_1e31_3c00),
    ("table3.toml", 0x6387_d58c_85c6_ddc7),
    ("table4.toml", 0xe394_98eb_f29a_0c3b),
    ("table5.toml", 0x3c19_4f36_8dc6_15b9),
    ("stated.toml", 0xcc6d_f589_5728_e927),
];

/// FNV-1a, 64 bits, of a text.
///
/// ```text
/// h₀ = 14695981039346656037,   hᵢ = (hᵢ₋₁ ⊕ byteᵢ) · 1099511628211  mod 2⁶⁴      (1)
/// ```
///
/// Each step of (1) is a bijection of h, so two texts of equal length that differ in one byte
/// never share a checksum. Valid for any text. Reference: `fnv`.
///
/// ```
/// assert_eq!(simgap_tables::fixture_checksum("a"), 0xaf63_dc4c_8601_ec8c);
/// ```
#[must_use]
pub fn fixture_checksum(text: &str) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
    text.bytes().fold(OFFSET, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(PRIME)
    }) // (1)
}

/// Compares the embedded fixtures with [`CHECKSUMS`].
///
/// # Errors
/// [`TableError::Checksum`] for the first fixture whose text changed.
pub fn verify_checksums() -> Result<(), TableError> {
    let texts = [TABLE1, TABLE2, TABLE3, TABLE4, TABLE5, STATED];
    for ((file, needed), text) in CHECKSUMS.into_iter().zip(texts) {
        let found = fixture_checksum(text);
        if found != needed {
            return Err(TableError::Checksum {
                file,
                found,
                needed,
            });
        }
    }
    Ok(())
}
