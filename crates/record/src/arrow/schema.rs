//! The columns that an Arrow schema describes (Arrow `Schema.fbs`, `Message.fbs`).

use super::flat::Table;

/// Codes of the head of a message.
pub(crate) const SCHEMA: u8 = 1;
pub(crate) const BATCH: u8 = 3;
/// Columns within columns that are looked at.
const DEEPEST: usize = 8;
/// Parts of a second by the code of a unit.
const PER_SECOND: [u32; 4] = [1, 1_000, 1_000_000, 1_000_000_000];

/// What the values of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Integer {
        bits: u32,
        signed: bool,
    },
    Float {
        bits: u32,
    },
    Flag,
    /// Counts parts of a second.
    Duration {
        per_second: u32,
    },
    /// The same, since 1970 or since midnight.
    Stamp {
        per_second: u32,
        bits: u32,
        of_day: bool,
    },
    /// Not read, and why.
    Other(&'static str),
}

/// A column, with the columns within it.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// Buffers of its own; of a view as many more as a batch says.
    pub(crate) buffers: usize,
    pub(crate) is_view: bool,
    pub(crate) children: Vec<Field>,
}

/// The columns of a message that holds a schema; `None` if it is none, or in another order of bytes.
pub(crate) fn fields(message: &[u8]) -> Option<Vec<Field>> {
    let message = Table::root(message)?;
    if message.byte(1) != SCHEMA {
        return None;
    }
    of_schema(&message.table(2)?)
}

/// The columns of a schema.
pub(crate) fn of_schema(schema: &Table<'_>) -> Option<Vec<Field>> {
    if schema.i16(0, 0) != 0 {
        return None;
    }
    let fields = schema.tables(1);
    Some(fields.iter().map(|field| column(field, 0)).collect())
}

fn column(field: &Table<'_>, depth: usize) -> Field {
    let name = field.text(0).unwrap_or_default().to_owned();
    if field.table(4).is_some() {
        return Field {
            name,
            kind: Kind::Other("it holds categories"),
            buffers: 2,
            is_view: false,
            children: Vec::new(),
        };
    }
    let code = field.byte(2);
    let kind = field
        .table(3)
        .map_or(Kind::Other("its type is not told"), |of| kind(code, &of));
    let children = if depth < DEEPEST {
        field
            .tables(5)
            .iter()
            .map(|child| column(child, depth + 1))
            .collect()
    } else {
        Vec::new()
    };
    Field {
        name,
        kind,
        buffers: buffers(code, field.table(3)),
        is_view: matches!(code, 23 | 24),
        children,
    }
}

fn kind(code: u8, of: &Table<'_>) -> Kind {
    let per_second = |unit: i16| {
        let unit = usize::try_from(unit).unwrap_or(0);
        PER_SECOND.get(unit).copied().unwrap_or(1)
    };
    match code {
        2 => Kind::Integer {
            bits: u32::try_from(of.i32(0, 0)).unwrap_or(0),
            signed: of.byte(1) != 0,
        },
        3 => Kind::Float {
            bits: match of.i16(0, 0) {
                0 => 16,
                1 => 32,
                _ => 64,
            },
        },
        6 => Kind::Flag,
        9 => Kind::Stamp {
            per_second: per_second(of.i16(0, 1)),
            bits: u32::try_from(of.i32(1, 32)).unwrap_or(0),
            of_day: true,
        },
        10 => Kind::Stamp {
            per_second: per_second(of.i16(0, 0)),
            bits: 64,
            of_day: false,
        },
        18 => Kind::Duration {
            per_second: per_second(of.i16(0, 1)),
        },
        4 | 5 | 15 | 19 | 20 | 23 | 24 => Kind::Other("it holds text"),
        7 => Kind::Other("its values are decimals of 16 bytes"),
        8 => Kind::Other("it holds dates without times of day"),
        12 | 16 | 17 | 21 | 25 | 26 => Kind::Other("it holds lists"),
        13 => Kind::Other("it holds structures"),
        _ => Kind::Other("its values are no numbers"),
    }
}

/// Buffers of a column by the code of its type, without those of the columns within.
fn buffers(code: u8, of: Option<Table<'_>>) -> usize {
    match code {
        1 | 22 => 0,
        // Of a union the offsets are there where it is dense.
        14 => 1 + usize::from(of.is_some_and(|of| of.i16(0, 0) == 1)),
        13 | 16 => 1,
        4 | 5 | 19 | 20 | 25 | 26 => 3,
        _ => 2,
    }
}
