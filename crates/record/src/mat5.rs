//! MATLAB level 5: what `save -v6` and `save -v7` write (MAT-File Format, The MathWorks).
//!
//! A header of 128 bytes, then elements: a tag of 8 bytes with type and size, the data, and
//! bytes up to the next multiple of 8. An element of up to 4 bytes shares its tag's 8 bytes. A
//! variable is an element of type matrix, which holds further elements: flags, dimensions, name,
//! values; or it is compressed (zlib) into an element without padding.

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use crate::MAX_FILE_BYTES;
use crate::arrays::Array;
use crate::bytes::{Bytes, Stored};
use crate::faults::FormatFault;
use crate::raw::within_limit;

/// Structures within structures that are read.
const DEEPEST: usize = 4;
/// Variables and fields that are looked at.
const MOST_ARRAYS: usize = 10_000;

const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;

/// All real two-dimensional numeric arrays of a file.
pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Array>, FormatFault> {
    let mut header = Bytes::new(bytes, 0, false);
    header.take(124, "the header")?;
    let big_endian = match header.take(4, "the header")? {
        [_, _, b'I', b'M'] => false,
        [_, _, b'M', b'I'] => true,
        other => {
            return Err(FormatFault::Malformed {
                at: crate::Place::Byte(124),
                found: format!("{other:02x?}"),
                needed: "the version and order of bytes of a MATLAB 5 file (level 4 has no such header: save with -v7)",
            });
        }
    };
    let mut file = File {
        arrays: Vec::new(),
        inflated: 0,
        values: 0,
    };
    let mut rest = Bytes::new(&bytes[128..], 128, big_endian);
    while rest.left() > 0 {
        file.element(&mut rest, "", 0)?;
    }
    Ok(file.arrays)
}

struct File {
    arrays: Vec<Array>,
    /// Bytes that came out of compressed elements so far.
    inflated: u64,
    /// Numbers so far.
    values: u64,
}

/// An element: its type and its data.
fn element<'a>(bytes: &mut Bytes<'a>, what: &'static str) -> Result<(u32, Bytes<'a>), FormatFault> {
    let tag = bytes.u32(what)?;
    let (kind, short) = (tag & 0xffff, tag >> 16);
    if short > 0 {
        let mut data = bytes.part(4, what)?;
        return Ok((kind, data.part(u64::from(short), what)?));
    }
    let size = bytes.u32(what)?;
    let data = bytes.part(u64::from(size), what)?;
    if tag != COMPRESSED {
        bytes.align(8);
    }
    Ok((tag, data))
}

impl File {
    fn element(
        &mut self,
        bytes: &mut Bytes<'_>,
        path: &str,
        depth: usize,
    ) -> Result<(), FormatFault> {
        let (kind, mut data) = element(bytes, "an element")?;
        match kind {
            MATRIX => self.matrix(&mut data, path, depth),
            COMPRESSED if depth == 0 => {
                let base = data.position();
                let inflated = self.inflate(&mut data)?;
                // Places within are those of the compressed element.
                let mut inner = Bytes::new(&inflated, base, data.big_endian());
                while inner.left() > 0 {
                    self.element(&mut inner, path, depth + 1)?;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn inflate(&mut self, data: &mut Bytes<'_>) -> Result<Vec<u8>, FormatFault> {
        let at = data.place();
        let left = data.left() as u64;
        let compressed = data.take(left, "a compressed element")?;
        let most = MAX_FILE_BYTES - self.inflated;
        let mut inflated = Vec::new();
        ZlibDecoder::new(compressed)
            .take(most + 1)
            .read_to_end(&mut inflated)
            .map_err(|error| FormatFault::Malformed {
                at,
                found: format!("a compressed element that cannot be unpacked ({error})"),
                needed: "a whole one",
            })?;
        self.inflated += inflated.len() as u64;
        if self.inflated > MAX_FILE_BYTES {
            return Err(FormatFault::TooMuch {
                most: MAX_FILE_BYTES,
                what: "unpacked bytes",
            });
        }
        Ok(inflated)
    }

    fn matrix(
        &mut self,
        data: &mut Bytes<'_>,
        path: &str,
        depth: usize,
    ) -> Result<(), FormatFault> {
        if data.left() == 0 {
            // An empty field.
            return Ok(());
        }
        let (_, mut flags) = element(data, "the flags of a variable")?;
        let flags = flags.u32("the flags of a variable")?;
        let (class, complex) = (flags & 0xff, flags & 0x800 != 0);
        let (_, mut dimensions) = element(data, "the dimensions of a variable")?;
        let mut sizes = Vec::new();
        while dimensions.left() >= 4 && sizes.len() < 3 {
            sizes.push(u64::from(dimensions.u32("the dimensions of a variable")?));
        }
        let own = text(element(data, "the name of a variable")?.1)?;
        let path = match (path, own.as_str()) {
            ("", own) => own.to_owned(),
            (path, "") => path.to_owned(),
            (path, own) => format!("{path}.{own}"),
        };
        let [rows, columns] = sizes[..] else {
            return Ok(());
        };
        match class {
            2 => self.fields(data, &path, rows.saturating_mul(columns), depth),
            6..=15 if !complex => self.numbers(data, path, rows, columns),
            _ => Ok(()),
        }
    }

    fn fields(
        &mut self,
        data: &mut Bytes<'_>,
        path: &str,
        count: u64,
        depth: usize,
    ) -> Result<(), FormatFault> {
        const WHAT: &str = "the fields of a structure";
        let length = u64::from(element(data, WHAT)?.1.u32(WHAT)?);
        let mut names = element(data, WHAT)?.1;
        if depth >= DEEPEST || length == 0 {
            return Ok(());
        }
        let mut fields = Vec::new();
        while names.left() as u64 >= length {
            let field = names.part(length, WHAT)?;
            fields.push(text(field)?);
        }
        for index in 0..count {
            if data.left() == 0 {
                break;
            }
            for field in &fields {
                let path = match count {
                    1 => format!("{path}.{field}"),
                    _ => format!("{path}({}).{field}", index + 1),
                };
                self.element(data, &path, depth + 1)?;
            }
        }
        Ok(())
    }

    fn numbers(
        &mut self,
        data: &mut Bytes<'_>,
        path: String,
        rows: u64,
        columns: u64,
    ) -> Result<(), FormatFault> {
        if self.arrays.len() == MOST_ARRAYS {
            return Err(FormatFault::TooMuch {
                most: MOST_ARRAYS as u64,
                what: "variables",
            });
        }
        let at = data.place();
        let (kind, mut values) = element(data, "the values of a variable")?;
        let stored = match kind {
            1 => Stored::I8,
            2 => Stored::U8,
            3 => Stored::I16,
            4 => Stored::U16,
            5 => Stored::I32,
            6 => Stored::U32,
            7 => Stored::F32,
            9 => Stored::F64,
            12 => Stored::I64,
            13 => Stored::U64,
            _ => {
                return Err(FormatFault::Malformed {
                    at,
                    found: format!("values of type {kind}"),
                    needed: "one of the ten types of numbers",
                });
            }
        };
        let bytes = values.left() as u64;
        let needed = rows
            .saturating_mul(columns)
            .saturating_mul(stored.size() as u64);
        if bytes != needed {
            return Err(FormatFault::Truncated {
                at,
                what: "the values of a variable",
                needed,
                left: bytes,
            });
        }
        self.values = self.values.saturating_add(rows.saturating_mul(columns));
        within_limit(self.values)?;
        let big_endian = values.big_endian();
        let values = stored.numbers(values.take(bytes, "the values of a variable")?, big_endian);
        // Both are at most the number of bytes.
        self.arrays.push(Array {
            path,
            unit: String::new(),
            rows: rows as usize,
            columns: columns as usize,
            values,
        });
        Ok(())
    }
}

/// A name: ASCII up to the first zero.
fn text(mut bytes: Bytes<'_>) -> Result<String, FormatFault> {
    let all = bytes.take(bytes.left() as u64, "a name")?;
    let end = all.iter().position(|&byte| byte == 0).unwrap_or(all.len());
    Ok(String::from_utf8_lossy(&all[..end]).into_owned())
}
