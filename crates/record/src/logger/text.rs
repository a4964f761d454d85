//! Bytes to text.

use std::borrow::Cow;

use crate::error::RecordError;
use crate::faults::TextFault;
use crate::note::Note;

/// As many bytes are looked at to tell UTF-16 without a byte order mark.
const LOOKED_AT: usize = 4096;

/// The text of a file, and a note if it is not UTF-8.
pub(crate) fn decode<'a>(
    file: &str,
    bytes: &'a [u8],
) -> Result<(Cow<'a, str>, Option<Note>), RecordError> {
    let (text, encoding) = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => (utf8_or_latin(rest), None),
        [0xff, 0xfe, rest @ ..] => (utf16(rest, u16::from_le_bytes), Some("UTF-16")),
        [0xfe, 0xff, rest @ ..] => (utf16(rest, u16::from_be_bytes), Some("UTF-16")),
        _ => match zero_half(bytes) {
            Some(1) => (utf16(bytes, u16::from_le_bytes), Some("UTF-16")),
            Some(_) => (utf16(bytes, u16::from_be_bytes), Some("UTF-16")),
            None => (utf8_or_latin(bytes), None),
        },
    };
    if let Some(at) = text.find(is_binary) {
        let line = 1 + text[..at].matches('\n').count() as u64;
        return Err(RecordError::Text {
            file: file.to_owned(),
            fault: TextFault::NotText { line },
        });
    }
    let latin = matches!(&text, Cow::Owned(_)) && encoding.is_none();
    let encoding = encoding.or(latin.then_some("Latin-1"));
    Ok((text, encoding.map(|encoding| Note::Encoding { encoding })))
}

/// Characters that no table holds.
fn is_binary(c: char) -> bool {
    c == '\0'
        || (c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{b}' | '\u{c}' | '\u{1a}'))
}

/// Which bytes of each pair are zero, if all of one half are and few of the other: 0 or 1.
fn zero_half(bytes: &[u8]) -> Option<usize> {
    let pairs = bytes[..bytes.len().min(LOOKED_AT)].chunks_exact(2);
    let count = pairs.len();
    let zeros = pairs.fold([0, 0], |[a, b], pair| {
        [a + usize::from(pair[0] == 0), b + usize::from(pair[1] == 0)]
    });
    let mostly = |zeros: usize| count >= 8 && zeros * 10 > count * 9;
    match zeros {
        [0, odd] if mostly(odd) => Some(1),
        [even, 0] if mostly(even) => Some(0),
        _ => None,
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Cow<'_, str> {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let text: String = char::decode_utf16(units)
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect();
    Cow::Owned(text)
}

/// Every byte is a character of Latin-1, so that this never fails.
fn utf8_or_latin(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
    }
}

/// The lines of a text, however they end; a lone carriage return ends one only if no line feed
/// does.
pub(crate) fn lines(text: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    if text.contains('\n') {
        Box::new(text.lines())
    } else {
        Box::new(text.split('\r'))
    }
}
