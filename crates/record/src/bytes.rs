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

    #[cfg(feature = "xlsx")]
    pub(crate) fn u16(&mut self, what: &'static str) -> Result<u16, FormatFault> {
        self.array(what).map(u16::from_le_bytes)
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

    /// All numbers in some bytes and what they are counted from: integers of 64 bits beyond 2^53, as
    /// nanoseconds since 1970 are, keep their differences.
    pub(crate) fn counted(self, bytes: &[u8], big_endian: bool) -> (Vec<f64>, f64) {
        if !matches!(self, Stored::I64 | Stored::U64) {
            return (self.numbers(bytes, big_endian), 0.0);
        }
        let integers: Vec<i128> = bytes
            .chunks_exact(8)
            .map(|chunk| {
                let mut b = [0; 8];
                b.copy_from_slice(chunk);
                if big_endian {
                    b.reverse();
                }
                match self {
                    Stored::I64 => i128::from(i64::from_le_bytes(b)),
                    _ => i128::from(u64::from_le_bytes(b)),
                }
            })
            .collect();
        counted(&integers)
    }

    /// One integer of 64 or 32 bits, little-endian.
    #[cfg(feature = "arrow")]
    pub(crate) fn integer(self, chunk: &[u8]) -> i128 {
        let mut b = [0; 8];
        let size = chunk.len().min(8);
        b[..size].copy_from_slice(&chunk[..size]);
        match self {
            Stored::U64 => i128::from(u64::from_le_bytes(b)),
            Stored::I32 => i128::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            _ => i128::from(i64::from_le_bytes(b)),
        }
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

/// Integers as doubles, and what they are counted from: 0, or the first one where they have more
/// digits than a double.
pub(crate) fn counted(integers: &[i128]) -> (Vec<f64>, f64) {
    const EXACT: i128 = 1 << 53;
    let far = integers.iter().any(|k| k.abs() > EXACT);
    let origin = integers.first().copied().filter(|_| far).unwrap_or(0);
    let values = integers.iter().map(|k| (k - origin) as f64).collect();
    (values, origin as f64)
}

#[cfg(any(feature = "arrow", feature = "matlab73", feature = "parquet"))]
/// A number of half precision: sign, five bits of exponent, ten of fraction.
pub(crate) fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    sign * match exponent {
        0 => fraction * 2_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2_f64.powi(exponent - 15),
    }
}

#[cfg(all(test, feature = "matlab73"))]
mod tests {
    use super::half;

    #[test]
    fn verify_half_precision() {
        let cases = [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65_504.0),
            (0x0001, 2_f64.powi(-24)),
            (0x3555, 0.333_251_953_125),
        ];
        for (bits, value) in cases {
            assert_eq!(half(bits), value, "{bits:#x}");
        }
        assert!(half(0x7c01).is_nan());
    }
}
