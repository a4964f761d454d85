//! Universal files, dataset 58 (functions at nodes), as text and as binary 58b (UC SDRL).
//!
//! A dataset stands between two lines that hold -1 alone and begins with its number. Dataset 58 has
//! eleven lines of description, then values: pairs of abscissa and ordinate where the spacing is
//! uneven, ordinates alone where it is even. In 58b the values are bytes, whose number stands in
//! the first line. Only real functions of time are read.

use crate::base::{Base, Uniform};
use crate::bytes::Stored;
use crate::faults::FormatFault;
use crate::note::Note;
use crate::raw::{Raw, RawColumn};
use crate::uff_lines::{Lines, fortran};
use crate::{Place, Unit, UnitKind};

/// Lines that describe a function.
const DESCRIPTION: usize = 11;
/// Functions that are read from one file.
const MOST_FUNCTIONS: usize = 4096;
/// Code of time as abscissa.
const TIME: u32 = 17;

/// Reads all functions of time, each on its time base.
pub(crate) fn read(bytes: &[u8], notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    let mut lines = Lines::new(bytes);
    let mut raw = Raw::default();
    while let Some(start) = lines.next() {
        if start.trim() != "-1" {
            continue;
        }
        let Some(number) = lines.next() else { break };
        if !matches!(number.trim_start().as_bytes(), [b'5', b'8', ..]) {
            lines.skip_dataset();
            continue;
        }
        let Some(function) = function(&mut lines, &number, notes)? else {
            continue;
        };
        if raw.columns.len() >= MOST_FUNCTIONS {
            return Err(FormatFault::TooMuch {
                most: MOST_FUNCTIONS as u64,
                what: "functions",
            });
        }
        keep(function, &mut raw);
    }
    if raw.bases.is_empty() {
        return Err(FormatFault::Unsupported {
            found: "no real function of time".to_owned(),
            instead: "export time records as dataset 58",
        });
    }
    Ok(raw)
}

/// A function of time.
struct Function {
    name: String,
    unit: String,
    base: Base,
    values: Vec<f64>,
}

fn keep(function: Function, raw: &mut Raw) {
    let Function {
        mut name,
        unit,
        base,
        values,
    } = function;
    let taken = |raw: &Raw, name: &str| raw.columns.iter().any(|column| column.name == name);
    let mut count = 2;
    let plain = name.clone();
    while taken(raw, &name) {
        name = format!("{plain} ({count})");
        count += 1;
    }
    let base = Some(raw.base(base));
    raw.columns.push(RawColumn {
        name,
        unit,
        values,
        base,
        ..RawColumn::default()
    });
}

/// What the lines of description say.
struct Description {
    name: String,
    unit: String,
    stored: Stored,
    count: u64,
    even: bool,
    /// Seconds per unit of the abscissa.
    in_seconds: f64,
    start: f64,
    step: f64,
}

/// Reads a dataset 58 up to its end; `None` for what is no real function of time.
fn function(
    lines: &mut Lines<'_>,
    number: &str,
    notes: &mut Vec<Note>,
) -> Result<Option<Function>, FormatFault> {
    let binary = Binary::of(number, lines)?;
    let first_line = lines.line + 1;
    let mut text = Vec::with_capacity(DESCRIPTION);
    for _ in 0..DESCRIPTION {
        text.push(
            lines
                .next()
                .ok_or_else(|| lines.cut_off("a description of eleven lines", 1, 0))?,
        );
    }
    let described = Description::of(&text, first_line)?;
    let values = match &binary {
        Some(binary) => Err(lines.bytes(binary.length)?),
        None => Ok(lines.numbers()?),
    };
    if binary.is_some() {
        lines.skip_dataset();
    }
    let described = match described {
        Ok(described) => described,
        Err((column, because)) => {
            notes.push(Note::LeftOut { column, because });
            return Ok(None);
        }
    };
    let Description {
        stored,
        count,
        even,
        ..
    } = described;
    let values = match (values, &binary) {
        (Ok(values), _) => values,
        (Err(bytes), Some(binary)) => binary.numbers(bytes, stored, count, even),
        (Err(_), None) => vec![],
    };
    let needed = if even { count } else { count.saturating_mul(2) };
    if (values.len() as u64) < needed {
        return Err(lines.cut_off("values of a function", needed, values.len() as u64));
    }
    // Not more than there are values.
    let count = count as usize;
    let (base, values) = if even {
        let base = Uniform {
            start_s: described.start,
            step_s: described.step,
            rows: count,
        };
        (Base::Even(base), values[..count].to_vec())
    } else {
        let pairs = || values.chunks_exact(2).take(count);
        let stamps = pairs().map(|pair| pair[0] * described.in_seconds).collect();
        (Base::Stamps(stamps), pairs().map(|pair| pair[1]).collect())
    };
    let Description { name, unit, .. } = described;
    Ok(Some(Function {
        name,
        unit,
        base,
        values,
    }))
}

impl Description {
    /// Reads the eleven lines; the inner error says why a sound function is left out.
    fn of(
        text: &[String],
        first_line: u64,
    ) -> Result<Result<Description, (String, String)>, FormatFault> {
        let at = |k: usize| Place::Line(first_line + k as u64);
        let fault = |k: usize, needed| FormatFault::Malformed {
            at: at(k),
            found: format!("'{}'", crate::words::shortened(text[k].trim())),
            needed,
        };
        let words = |k: usize| text[k].split_whitespace().collect::<Vec<_>>();
        let kind: u32 = word(&words(5), 0).ok_or_else(|| fault(5, "the type of a function"))?;
        let form = words(6);
        let shape = "data type, number of values, spacing, start and step";
        let real: u32 = word(&form, 0).ok_or_else(|| fault(6, shape))?;
        let count: u64 = word(&form, 1).ok_or_else(|| fault(6, shape))?;
        let spacing: u32 = word(&form, 2).ok_or_else(|| fault(6, shape))?;
        let number = |k: usize| form.get(k).and_then(|word| fortran(word));
        let (start, step) = (number(3), number(4));
        let abscissa: u32 = word(&words(7), 0).unwrap_or(0);
        let name = name_of(text);
        let left_out = |because: &str| Ok(Err((name.clone(), because.to_owned())));
        if abscissa != TIME && !(abscissa == 0 && kind == 1) {
            return left_out("it is no function of time");
        }
        let stored = match real {
            2 => Stored::F32,
            4 => Stored::F64,
            _ => return left_out("its values are complex"),
        };
        let (Some(start), Some(step)) = (start, step) else {
            return Err(fault(6, shape));
        };
        let unit = Unit::parse(&unit_of(&text[7]));
        let in_seconds = if unit.kind() == UnitKind::Time {
            unit.si_factor()
        } else {
            1.0
        };
        Ok(Ok(Description {
            unit: unit_of(&text[8]),
            name,
            stored,
            count,
            even: spacing != 0,
            in_seconds,
            start: start * in_seconds,
            step: step * in_seconds,
        }))
    }
}

fn word<T: std::str::FromStr>(words: &[&str], index: usize) -> Option<T> {
    words.get(index)?.parse().ok()
}

/// The first line, or node and direction of the response where it is empty.
fn name_of(text: &[String]) -> String {
    let first = text[0].trim();
    if !first.is_empty() && !first.eq_ignore_ascii_case("NONE") {
        return first.to_owned();
    }
    // Response entity, node and direction stand in columns 31 to 55 of the sixth line.
    let response: String = text[5].chars().skip(30).take(25).collect();
    let words: Vec<&str> = response.split_whitespace().collect();
    match words[..] {
        [.., node, direction] => format!("{node}:{direction}"),
        _ => "function".to_owned(),
    }
}

/// The label of the units: the last 20 of the characters after four numbers and a first label.
fn unit_of(line: &str) -> String {
    let label: String = line.chars().skip(46).take(21).collect();
    let label = label.trim();
    if label.eq_ignore_ascii_case("NONE") {
        return String::new();
    }
    label.to_owned()
}

/// How the values of a dataset 58b are stored.
struct Binary {
    big_endian: bool,
    length: u64,
}

impl Binary {
    /// `58b`, order of bytes, format of numbers, lines of description, bytes.
    fn of(number: &str, lines: &Lines<'_>) -> Result<Option<Binary>, FormatFault> {
        let Some(rest) = number.trim_start().strip_prefix("58b") else {
            return Ok(None);
        };
        let words: Vec<&str> = rest.split_whitespace().collect();
        let fault = || FormatFault::Malformed {
            at: Place::Line(lines.line),
            found: format!("'{}'", crate::words::shortened(number.trim())),
            needed: "58b, order of bytes, format of numbers, 11 lines, number of bytes",
        };
        let order: u32 = word(&words, 0).ok_or_else(fault)?;
        let format: u32 = word(&words, 1).ok_or_else(fault)?;
        let length: u64 = word(&words, 3).ok_or_else(fault)?;
        if format != 2 {
            return Err(FormatFault::Unsupported {
                found: format!("floating-point format {format}"),
                instead: "export with IEEE 754 numbers",
            });
        }
        Ok(Some(Binary {
            big_endian: order == 2,
            length,
        }))
    }

    /// The values; an uneven function of double precision has abscissas of single precision,
    /// unless there are bytes for double precision.
    fn numbers(&self, bytes: &[u8], stored: Stored, count: u64, even: bool) -> Vec<f64> {
        if even || stored == Stored::F32 {
            return stored.numbers(bytes, self.big_endian);
        }
        let doubles = bytes.len() as u64 == count.saturating_mul(16);
        if doubles {
            return stored.numbers(bytes, self.big_endian);
        }
        bytes
            .chunks_exact(12)
            .flat_map(|pair| {
                let (abscissa, ordinate) = pair.split_at(4);
                [
                    Stored::F32.number(abscissa, self.big_endian),
                    Stored::F64.number(ordinate, self.big_endian),
                ]
            })
            .collect()
    }
}
