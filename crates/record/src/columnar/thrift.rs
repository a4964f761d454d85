//! A look at the Thrift that a Parquet file describes itself with, before the crate reads it.
//!
//! The crate passes over a field that it does not know, and over a list of flags in it without
//! taking a byte for each: six bytes keep it busy for two seconds, and a file has room for many of
//! them. Neither the directory nor the head of a page has such a list.

/// Structures within structures that are looked into, as many as by the crate.
const DEEPEST: u32 = 64;

/// The field of the head of a page that tells the length of what follows.
const PACKED_LENGTH: u64 = 3;

/// Whether a structure can be passed over, and takes a byte for all that it claims.
pub(crate) fn is_sound(structure: &[u8]) -> bool {
    Look::at(structure).structure(0).is_some()
}

/// Whether that holds for the heads of all pages of a chunk.
pub(crate) fn are_sound(chunk: &[u8]) -> bool {
    let mut rest = chunk;
    while !rest.is_empty() {
        let mut look = Look::at(rest);
        let Some(Some(length)) = look.structure(0) else {
            return false;
        };
        let Some(next) = look.rest.get(length..) else {
            return false;
        };
        rest = next;
    }
    true
}

struct Look<'a> {
    rest: &'a [u8],
}

impl<'a> Look<'a> {
    fn at(rest: &'a [u8]) -> Look<'a> {
        Look { rest }
    }

    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    fn pass(&mut self, count: u64) -> Option<()> {
        self.rest = self.rest.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    /// Seven bits of a byte, the lowest first, while the eighth is set.
    fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    /// Passes over a structure; the length of a page, if it tells one.
    fn structure(&mut self, depth: u32) -> Option<Option<usize>> {
        if depth == DEEPEST {
            return None;
        }
        let (mut field, mut length) = (0, None);
        loop {
            let head = self.byte()?;
            let kind = head & 0x0f;
            if kind == 0 {
                return Some(length);
            }
            field = match u64::from(head >> 4) {
                0 => unfolded(self.varint()?),
                step => field + step,
            };
            // A flag stands in the kind.
            if kind > 2 {
                let before = self.rest;
                self.value(kind, depth)?;
                if field == PACKED_LENGTH && kind == 5 {
                    let told = unfolded(Look::at(before).varint()?);
                    length = usize::try_from(told).ok();
                }
            }
        }
    }

    /// Passes over a value that is no flag.
    fn value(&mut self, kind: u8, depth: u32) -> Option<()> {
        match kind {
            3 => self.pass(1),
            4..=6 => self.varint().map(drop),
            7 => self.pass(8),
            8 => {
                let count = self.varint()?;
                self.pass(count)
            }
            9 | 10 => self.list(depth),
            12 => self.structure(depth + 1).map(drop),
            13 => self.pass(16),
            // Maps are not used in Parquet.
            _ => None,
        }
    }

    fn list(&mut self, depth: u32) -> Option<()> {
        if depth == DEEPEST {
            return None;
        }
        let head = self.byte()?;
        let count = match u64::from(head >> 4) {
            15 => self.varint()?,
            count => count,
        };
        for _ in 0..count {
            self.value(head & 0x0f, depth + 1)?;
        }
        Some(())
    }
}

/// A signed number out of an unsigned one; a negative one is beyond all that is asked for.
fn unfolded(folded: u64) -> u64 {
    if folded & 1 == 0 {
        folded >> 1
    } else {
        u64::MAX >> 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_what_is_passed_over() {
        // Field 1 a number, field 2 text, field 4 a flag, field 6 a list of two structures.
        let sound = [
            0x15, 0x08, 0x18, 0x02, b'a', b'b', 0x21, 0x29, 0x2c, 0, 0, 0,
        ];
        assert!(is_sound(&sound));
        for cut in 0..sound.len() {
            assert!(!is_sound(&sound[..cut]), "{cut}");
        }
        // A list of two thousand million flags.
        assert!(!is_sound(&[0x19, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x07, 0]));
        // Two pages, whose third field tells 2 and 1 bytes after the head.
        let pages = [0x35, 0x04, 0, 7, 7, 0x35, 0x02, 0, 7];
        assert!(are_sound(&pages));
        assert!(!are_sound(&pages[..8]));
    }
}
