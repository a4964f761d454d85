//! Tables of FlatBuffers, in which Arrow describes itself: every offset is checked, none is trusted.
//!
//! A table begins with the distance back to its list of fields (2-byte places from the start of the
//! table, 0 for a field that is left out); texts and lists stand behind offsets.

/// A table in some bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Table<'a> {
    bytes: &'a [u8],
    at: usize,
    fields: usize,
    /// Bytes of the list of fields.
    length: usize,
}

impl<'a> Table<'a> {
    /// The outermost table.
    pub(crate) fn root(bytes: &'a [u8]) -> Option<Table<'a>> {
        let at = number::<4>(bytes, 0).map(u32::from_le_bytes)?;
        Table::at(bytes, usize::try_from(at).ok()?)
    }

    fn at(bytes: &'a [u8], at: usize) -> Option<Table<'a>> {
        let back = i64::from(number::<4>(bytes, at).map(i32::from_le_bytes)?);
        let fields = usize::try_from(i64::try_from(at).ok()?.checked_sub(back)?).ok()?;
        let length = number::<2>(bytes, fields).map(u16::from_le_bytes)?;
        Some(Table {
            bytes,
            at,
            fields,
            length: usize::from(length),
        })
    }

    /// Where a field stands; `None` if it is left out.
    fn field(&self, index: usize) -> Option<usize> {
        let place = 4 + 2 * index;
        if place + 2 > self.length {
            return None;
        }
        let offset = number::<2>(self.bytes, self.fields + place).map(u16::from_le_bytes)?;
        (offset != 0).then(|| self.at + usize::from(offset))
    }

    /// Where what a field points to stands.
    fn pointed(&self, index: usize) -> Option<usize> {
        let at = self.field(index)?;
        let offset = number::<4>(self.bytes, at).map(u32::from_le_bytes)?;
        at.checked_add(usize::try_from(offset).ok()?)
    }

    pub(crate) fn byte(&self, index: usize) -> u8 {
        let at = self.field(index);
        at.and_then(|at| self.bytes.get(at).copied()).unwrap_or(0)
    }

    pub(crate) fn i16(&self, index: usize, otherwise: i16) -> i16 {
        let read = |at| number::<2>(self.bytes, at).map(i16::from_le_bytes);
        self.field(index).and_then(read).unwrap_or(otherwise)
    }

    pub(crate) fn i32(&self, index: usize, otherwise: i32) -> i32 {
        let read = |at| number::<4>(self.bytes, at).map(i32::from_le_bytes);
        self.field(index).and_then(read).unwrap_or(otherwise)
    }

    pub(crate) fn i64(&self, index: usize) -> i64 {
        let read = |at| number::<8>(self.bytes, at).map(i64::from_le_bytes);
        self.field(index).and_then(read).unwrap_or(0)
    }

    pub(crate) fn table(&self, index: usize) -> Option<Table<'a>> {
        Table::at(self.bytes, self.pointed(index)?)
    }

    pub(crate) fn text(&self, index: usize) -> Option<&'a str> {
        let (at, length) = self.list(index, 1)?;
        std::str::from_utf8(self.bytes.get(at..at + length)?).ok()
    }

    /// Start and length of a list whose entries have so many bytes, all of them there.
    fn list(&self, index: usize, size: usize) -> Option<(usize, usize)> {
        let at = self.pointed(index)?;
        let length = number::<4>(self.bytes, at).map(u32::from_le_bytes)?;
        let length = usize::try_from(length).ok()?;
        let end = length.checked_mul(size)?.checked_add(at)?.checked_add(4)?;
        (end <= self.bytes.len()).then_some((at + 4, length))
    }

    /// Tables of a list.
    pub(crate) fn tables(&self, index: usize) -> Vec<Table<'a>> {
        let Some((start, length)) = self.list(index, 4) else {
            return Vec::new();
        };
        (0..length)
            .filter_map(|k| {
                let at = start + 4 * k;
                let offset = number::<4>(self.bytes, at).map(u32::from_le_bytes)?;
                Table::at(self.bytes, at.checked_add(usize::try_from(offset).ok()?)?)
            })
            .collect()
    }

    /// Pairs of numbers of a list.
    pub(crate) fn pairs(&self, index: usize) -> Vec<(i64, i64)> {
        let Some((start, length)) = self.list(index, 16) else {
            return Vec::new();
        };
        let one = |at: usize| number::<8>(self.bytes, at).map_or(0, i64::from_le_bytes);
        (0..length)
            .map(|k| (one(start + 16 * k), one(start + 16 * k + 8)))
            .collect()
    }

    /// Blocks of a footer: offset, bytes of the description, bytes of the body.
    #[cfg(feature = "arrow")]
    pub(crate) fn blocks(&self, index: usize) -> Vec<(i64, i32, i64)> {
        let Some((start, length)) = self.list(index, 24) else {
            return Vec::new();
        };
        let long = |at: usize| number::<8>(self.bytes, at).map_or(0, i64::from_le_bytes);
        let short = |at: usize| number::<4>(self.bytes, at).map_or(0, i32::from_le_bytes);
        (0..length)
            .map(|k| start + 24 * k)
            .map(|at| (long(at), short(at + 8), long(at + 16)))
            .collect()
    }

    /// Numbers of a list.
    pub(crate) fn numbers(&self, index: usize) -> Vec<i64> {
        let Some((start, length)) = self.list(index, 8) else {
            return Vec::new();
        };
        let one = |k: usize| number::<8>(self.bytes, start + 8 * k).map_or(0, i64::from_le_bytes);
        (0..length).map(one).collect()
    }
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}
