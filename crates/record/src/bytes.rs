//! Numbers out of bytes, never beyond their end.

use crate::error::Place;
use crate::faults::FormatFault;

/// Bytes of a file that are read from front to back.
#[derive(Debug, Clone)]
pub(crate) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
    /// Where the first of these bytes stands in the file.
    base: u64,
    big_endian: bool,
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(data: &'a [u8], base: u64, big_endian: bool) -> Bytes<'a> {
        Bytes {
            data,
            at: 0,
            base,
            big_endian,
        }
    }

    /// The same bytes in another order.
    pub(crate) fn ordered(self, big_endian: bool) -> Bytes<'a> {
        Bytes { big_endian, ..self }
    }

    pub(crate) fn big_endian(&self) -> bool {
        self.big_endian
    }

    /// Where the next byte stands in the file.
    pub(crate) fn position(&self) -> u64 {
        self.base + self.at as u64
    }

    pub(crate) fn place(&self) -> Place {
        Place::Byte(self.position())
    }

    pub(crate) fn left(&self) -> usize {
        self.data.len() - self.at
    }

    /// The next bytes. However many are claimed, nothing is allocated.
    pub(crate) fn take(&mut self, count: u64, what: &'static str) -> Result<&'a [u8], FormatFault> {
        let left = self.left();
        match usize::try_from(count) {
            Ok(count) if count <= left => {
                let taken = &self.data[self.at..self.at + count];
                self.at += count;
                Ok(taken)
            }
            _ => Err(FormatFault::Truncated {
                at: self.place(),
                what,
                needed: count,
                left: left as u64,
            }),
        }
    }

    /// The next bytes as a reader of their own.
    pub(crate) fn part(
        &mut self,
        count: u64,
        what: &'static str,
    ) -> Result<Bytes<'a>, FormatFault> {
        let base = self.position();
        Ok(Bytes::new(self.take(count, what)?, base, self.big_endian))
    }

    /// Passes over the bytes up to the next multiple of so many, or to the end.
    pub(crate) fn align(&mut self, to: usize) {
        let over = self.at % to;
        if over > 0 {
            self.at = (self.at + to - over).min(self.data.len());
        }
    }

    fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], FormatFault> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u64, what)?);
        if self.big_endian {
            array.reverse();
        }
        Ok(array)
    }

    pub(crate) fn u32(&mut self, what: &'static str) -> Result<u32, FormatFault> {
        self.array(what).map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self, what: &'static str) -> Result<u64, FormatFault> {
        self.array(what).map(u64::from_le_bytes)
    }
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stored {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Stored {
    pub(crate) fn size(self) -> usize {
        match self {
            Stored::I8 | Stored::U8 => 1,
            Stored::I16 | Stored::U16 => 2,
            Stored::I32 | Stored::U32 | Stored::F32 => 4,
            Stored::I64 | Stored::U64 | Stored::F64 => 8,
        }
    }

    /// All numbers of this kind in some bytes; a rest too short for one is left.
    pub(crate) fn numbers(self, bytes: &[u8], big_endian: bool) -> Vec<f64> {
        bytes
            .chunks_exact(self.size())
            .map(|chunk| self.number(chunk, big_endian))
            .collect()
    }

    /// One number; 64-bit integers beyond 2^53 are rounded.
    pub(crate) fn number(self, chunk: &[u8], big_endian: bool) -> f64 {
        let mut b = [0; 8];
        let size = chunk.len().min(8);
        b[..size].copy_from_slice(&chunk[..size]);
        if big_endian {
            b[..size].reverse();
        }
        let [b0, b1, b2, b3, ..] = b;
        match self {
            Stored::I8 => f64::from(b0 as i8),
            Stored::U8 => f64::from(b0),
            Stored::I16 => f64::from(i16::from_le_bytes([b0, b1])),
            Stored::U16 => f64::from(u16::from_le_bytes([b0, b1])),
            Stored::I32 => f64::from(i32::from_le_bytes([b0, b1, b2, b3])),
            Stored::U32 => f64::from(u32::from_le_bytes([b0, b1, b2, b3])),
            Stored::I64 => i64::from_le_bytes(b) as f64,
            Stored::U64 => u64::from_le_bytes(b) as f64,
            Stored::F32 => f64::from(f32::from_le_bytes([b0, b1, b2, b3])),
            Stored::F64 => f64::from_le_bytes(b),
        }
    }
}
