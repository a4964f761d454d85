//! Types of HDF5 that its reader does not turn into doubles itself: half precision, flags, and the
//! members of records.

use hdf5_pure::{Datatype, DatatypeByteOrder};

use crate::bytes::{Stored, half};

/// What the elements of a dataset are.
pub(crate) enum Form {
    /// Numbers that the reader of the format knows.
    Plain,
    /// Others that are decoded here.
    Single(Number),
    /// Records of so many bytes.
    Record { size: usize, members: Vec<Member> },
    /// None, and why.
    Unread(&'static str),
}

/// A member of a record; why it is not read as the error.
pub(crate) struct Member {
    pub(crate) name: String,
    pub(crate) offset: usize,
    pub(crate) number: Result<Number, &'static str>,
}

/// How a number is stored.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    kind: Kind,
    pub(crate) size: usize,
    big_endian: bool,
}

#[derive(Clone, Copy)]
enum Kind {
    Half,
    Stored(Stored),
}

impl Form {
    /// Of complex numbers the real part is a member of a record where it is asked for.
    pub(crate) fn of(datatype: &Datatype, with_real_parts: bool) -> Form {
        if let Datatype::Compound { size, members } = datatype {
            let member = |member: &hdf5_pure::CompoundMember| Member {
                name: member.name.clone(),
                offset: usize::try_from(member.byte_offset).unwrap_or(usize::MAX),
                number: Number::of(&member.datatype),
            };
            let complex = members.len() == 2
                && members
                    .iter()
                    .all(|m| matches!(m.name.as_str(), "r" | "i" | "real" | "imag"));
            if complex && !with_real_parts {
                return Form::Unread("its values are complex");
            }
            return Form::Record {
                size: *size as usize,
                members: members.iter().map(member).collect(),
            };
        }
        Number::of(datatype).map_or_else(Form::Unread, Form::Single)
    }
}

impl Number {
    fn of(datatype: &Datatype) -> Result<Number, &'static str> {
        let big = |order: &DatatypeByteOrder| matches!(order, DatatypeByteOrder::BigEndian);
        let (kind, size, big_endian) = match datatype {
            Datatype::FloatingPoint {
                size,
                byte_order,
                layout,
            } => {
                let kind = match (size, layout.exponent_size) {
                    (2, 5) => Kind::Half,
                    (4, 8) => Kind::Stored(Stored::F32),
                    (8, 11) => Kind::Stored(Stored::F64),
                    _ => return Err("its numbers are of a precision that is not known"),
                };
                (kind, *size, big(byte_order))
            }
            Datatype::FixedPoint {
                size,
                byte_order,
                layout,
            } => {
                let stored = match (size, layout.signed) {
                    (1, true) => Stored::I8,
                    (1, false) => Stored::U8,
                    (2, true) => Stored::I16,
                    (2, false) => Stored::U16,
                    (4, true) => Stored::I32,
                    (4, false) => Stored::U32,
                    (8, true) => Stored::I64,
                    (8, false) => Stored::U64,
                    _ => return Err("its integers are of a size that is not known"),
                };
                (Kind::Stored(stored), *size, big(byte_order))
            }
            // Flags of NumPy.
            Datatype::Enumeration { base_type, .. } => return Number::of(base_type),
            Datatype::String { .. }
            | Datatype::VariableLength {
                is_string: true, ..
            } => {
                return Err("it holds text");
            }
            Datatype::VariableLength { .. } => return Err("it holds lists"),
            Datatype::Reference { .. } => return Err("it holds references, as cells of MATLAB do"),
            Datatype::Array { .. } => return Err("its elements are arrays"),
            _ => return Err("its elements are no numbers"),
        };
        Ok(Number {
            kind,
            size: size as usize,
            big_endian,
        })
    }

    /// A column of records of a size.
    pub(crate) fn column(self, raw: &[u8], offset: usize, size: usize) -> Vec<f64> {
        let end = offset.saturating_add(self.size);
        raw.chunks_exact(size.max(1))
            .filter_map(|record| record.get(offset..end))
            .map(|bytes| match self.kind {
                Kind::Stored(stored) => stored.number(bytes, self.big_endian),
                Kind::Half => {
                    let pair = [bytes[0], bytes[1]];
                    half(if self.big_endian {
                        u16::from_be_bytes(pair)
                    } else {
                        u16::from_le_bytes(pair)
                    })
                }
            })
            .collect()
    }
}
