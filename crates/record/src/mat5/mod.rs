//! MATLAB level 5: what `save -v6` and `save -v7` write (MAT-File Format, The MathWorks).
//!
//! A header of 128 bytes, then elements: a tag of 8 bytes with type and size, the data, and
//! bytes up to the next multiple of 8. An element of up to 4 bytes shares its tag's 8 bytes. A
//! variable is an element of type matrix, which holds further elements: flags, dimensions, name,
//! values; or it is compressed (zlib) into an element without padding.

mod level4;
mod objects;

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use crate::arrays::{Array, Workspace};
use crate::bytes::{Bytes, Stored};
use crate::faults::FormatFault;
use crate::mat_objects::{self, OBJECT, Reference, Store};
use crate::note::Note;
use crate::raw::within_limit;
use crate::{MAX_FILE_BYTES, MIN_ROWS};

/// Structures within structures that are read.
const DEEPEST: usize = 4;
/// Variables and fields that are looked at.
const MOST_ARRAYS: usize = 10_000;

/// Dimensions of an array that are looked at.
const MOST_DIMENSIONS: usize = 16;
/// Classes of variables that are no plain numbers.
const CELL: u32 = 1;
const STRUCTURE: u32 = 2;
const OBJECT_CLASS: u32 = 3;
const CHARACTERS: u32 = 4;
const SPARSE: u32 = 5;
const OPAQUE: u32 = 17;
const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;

/// All real two-dimensional numeric arrays of a file.
pub(crate) fn read(bytes: &[u8], notes: &mut Vec<Note>) -> Result<Workspace, FormatFault> {
    if level4::is_level_4(bytes) {
        return Err(FormatFault::Unsupported {
            found: "a file of MATLAB 4".to_owned(),
            instead: "save it with -v7 in MATLAB, or as CSV",
        });
    }
    let mut header = Bytes::new(bytes, 0, false);
    header.take(124, "the header")?;
    let big_endian = match header.take(4, "the header")? {
        [_, _, b'I', b'M'] => false,
        [_, _, b'M', b'I'] => true,
        other => {
            return Err(FormatFault::Malformed {
                at: crate::Place::Byte(124),
                found: format!("{other:02x?}"),
                needed: "the version and order of bytes of a MATLAB 5 file",
            });
        }
    };
    let mut file = File {
        notes,
        workspace: Workspace::default(),
        references: vec![],
        store: None,
        is_store: false,
        inflated: 0,
        values: 0,
    };
    let mut rest = Bytes::new(&bytes[128..], 128, big_endian);
    while rest.left() > 0 {
        file.element(&mut rest, "", 0)?;
    }
    let File {
        mut workspace,
        references,
        store,
        ..
    } = file;
    mat_objects::resolve(&mut workspace, references, store, notes);
    Ok(workspace)
}

struct File<'n> {
    notes: &'n mut Vec<Note>,
    workspace: Workspace,
    /// Variables that stand for objects, and what the objects hold.
    references: Vec<Reference>,
    store: Option<Store>,
    /// Whether this is what the objects hold.
    is_store: bool,
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

impl File<'_> {
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
        if class == OPAQUE {
            return self.opaque(data, path);
        }
        let (_, mut dimensions) = element(data, "the dimensions of a variable")?;
        let mut sizes = Vec::new();
        while dimensions.left() >= 4 && sizes.len() < MOST_DIMENSIONS {
            sizes.push(u64::from(dimensions.u32("the dimensions of a variable")?));
        }
        let own = text(element(data, "the name of a variable")?.1)?;
        if path.is_empty() && own.is_empty() && !self.is_store {
            return self.objects(data, class);
        }
        let path = joined(path, &own);
        let count = sizes
            .iter()
            .fold(1_u64, |count, &size| count.saturating_mul(size));
        // A signal of Simulink has a row for each step in the last of three dimensions.
        if sizes.len() > 2 {
            sizes.retain(|&size| size != 1);
            sizes.resize(sizes.len().max(2), 1);
        }
        let long = count >= MIN_ROWS as u64;
        let [rows, columns] = sizes[..] else {
            if long {
                self.left_out(path, "it has more than two dimensions");
            }
            return Ok(());
        };
        match class {
            CELL => self.cells(data, &path, count, depth),
            STRUCTURE => self.fields(data, &path, count, depth),
            OBJECT_CLASS => {
                self.left_out(path, OBJECT);
                Ok(())
            }
            CHARACTERS => self.characters(data, path),
            SPARSE if long => {
                self.left_out(path, "it is a sparse matrix; save full(x)");
                Ok(())
            }
            6..=15 if complex && !self.is_store => {
                if long {
                    self.left_out(path, "its values are complex; save real(x) and imag(x)");
                }
                Ok(())
            }
            6..=15 => self.numbers(data, path, rows, columns),
            _ => Ok(()),
        }
    }

    fn left_out(&mut self, column: String, because: &str) {
        self.notes.push(Note::LeftOut {
            column,
            because: because.to_owned(),
        });
    }

    /// Cells hold variables without names.
    fn cells(
        &mut self,
        data: &mut Bytes<'_>,
        path: &str,
        count: u64,
        depth: usize,
    ) -> Result<(), FormatFault> {
        if depth >= DEEPEST {
            return Ok(());
        }
        for index in 0..count {
            if data.left() == 0 {
                break;
            }
            self.element(data, &format!("{path}{{{}}}", index + 1), depth + 1)?;
        }
        Ok(())
    }

    /// A text, which may be the name or the unit of the numbers beside it.
    fn characters(&mut self, data: &mut Bytes<'_>, path: String) -> Result<(), FormatFault> {
        const LONGEST: usize = 200;
        let (kind, mut values) = element(data, "a text")?;
        let all = values.take(values.left() as u64, "a text")?;
        let big_endian = values.big_endian();
        let text: String = match kind {
            4 | 17 => {
                let pairs = all.chunks_exact(2).take(LONGEST);
                let units = pairs.map(|pair| match big_endian {
                    true => u16::from_be_bytes([pair[0], pair[1]]),
                    false => u16::from_le_bytes([pair[0], pair[1]]),
                });
                char::decode_utf16(units)
                    .map(|c| c.unwrap_or(' '))
                    .collect()
            }
            _ => String::from_utf8_lossy(&all[..all.len().min(LONGEST)]).into_owned(),
        };
        if self.workspace.texts.len() < MOST_ARRAYS {
            self.workspace.texts.insert(path, text);
        }
        Ok(())
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
        if fields.is_empty() {
            // However many such structures there are said to be, they hold nothing.
            return Ok(());
        }
        let mut columns = vec![Vec::new(); fields.len()];
        for index in 0..count {
            if data.left() == 0 {
                break;
            }
            for (field, column) in fields.iter().zip(&mut columns) {
                let path = match count {
                    1 => format!("{path}.{field}"),
                    _ => format!("{path}({}).{field}", index + 1),
                };
                self.element(data, &path, depth + 1)?;
                self.take_scalar(count, &path, column);
            }
        }
        for (field, values) in fields.iter().zip(columns) {
            self.column_of_scalars(format!("{path}.{field}"), values, count);
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
        if self.workspace.arrays.len() == MOST_ARRAYS {
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
        let taken = values.take(bytes, "the values of a variable")?;
        let (values, origin) = stored.counted(taken, big_endian);
        // Both are at most the number of bytes.
        self.workspace.arrays.push(Array {
            path,
            unit: String::new(),
            rows: rows as usize,
            columns: columns as usize,
            values,
            origin,
        });
        Ok(())
    }
}

fn joined(path: &str, own: &str) -> String {
    match (path, own) {
        ("", own) => own.to_owned(),
        (path, "") => path.to_owned(),
        (path, own) => format!("{path}.{own}"),
    }
}

/// A name: ASCII up to the first zero.
fn text(mut bytes: Bytes<'_>) -> Result<String, FormatFault> {
    let all = bytes.take(bytes.left() as u64, "a name")?;
    let end = all.iter().position(|&byte| byte == 0).unwrap_or(all.len());
    Ok(String::from_utf8_lossy(&all[..end]).into_owned())
}
