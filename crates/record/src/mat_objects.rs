//! Tables, timetables, durations and dates of MATLAB, as MAT files of both kinds keep them.
//!
//! A variable says the number of its object alone. What the object holds stands in a store beside
//! the variables, which is a cell array: the first cell describes classes and objects in words of 32
//! bits, values of properties stand from the third on. The layout is not published; this is what
//! `mat-io` 1.0 writes and `hdf5-pure` 0.47 reads.
//!
//! ```text
//! version, number of names, 8 offsets | names | classes | saved | objects | normal | ...
//! class:          package, name, 0, 0
//! object:         class, 0, 0, its number in saved, its number in normal, 0
//! saved, normal:  count, (name, kind, value) of each property, up to a multiple of 8 bytes
//! ```
//!
//! Objects, classes and names count from 1.

use std::collections::HashMap;

use crate::arrays::{Array, Workspace};
use crate::note::Note;

/// The first word of a variable that stands for an object.
const MAGIC: u32 = 0xdd00_0000;
/// Cells of the store before the values of properties.
const RESERVED: usize = 2;
/// The kind of a property whose value is a cell of the store.
const IN_A_CELL: u32 = 1;
/// From here on a time is a date, ms.
const DATED_MS: f64 = 1e11;
/// Words by which a variable says which object it is, at most.
pub(crate) const MOST_WORDS: usize = 64;
/// Columns of a table that are looked at.
const MOST_COLUMNS: usize = 1000;
const MOST_COLUMNS_OF_ALL: usize = 10_000;
/// Why other objects are left out.
pub(crate) const OBJECT: &str =
    "it is a timeseries or another object of MATLAB; save its numbers, such as x.Time and x.Data";

/// A variable that stands for an object.
#[derive(Debug)]
pub(crate) struct Reference {
    pub(crate) path: String,
    /// What the variable holds: the mark, the number of sizes, sizes, objects, class.
    pub(crate) words: Vec<u32>,
}

/// What the objects of a file hold.
#[derive(Debug, Default)]
pub(crate) struct Store {
    /// Its cells are called `{1}`, `{2}`, and so on.
    pub(crate) values: Workspace,
    pub(crate) references: Vec<Reference>,
}

/// Adds the numbers of objects to the variables, and tells which have none.
pub(crate) fn resolve(
    workspace: &mut Workspace,
    references: Vec<Reference>,
    store: Option<Store>,
    notes: &mut Vec<Note>,
) {
    let mut objects = store.and_then(Objects::new);
    for Reference { path, words } in references {
        let found = objects
            .as_mut()
            .and_then(|objects| objects.arrays(&path, &words, notes));
        match found {
            Some(arrays) => workspace.arrays.extend(arrays),
            None => notes.push(left_out(path, OBJECT)),
        }
    }
}

fn left_out(column: String, because: &str) -> Note {
    Note::LeftOut {
        column,
        because: because.to_owned(),
    }
}

/// Values of properties: the cell, counted from 1, by name.
type Properties = HashMap<String, usize>;

struct Objects {
    /// The description, in words and in bytes.
    words: Vec<u32>,
    names: Vec<String>,
    /// Where the parts of the description begin, words.
    parts: [usize; 5],
    /// Where the lists of properties begin, words.
    saved: Vec<usize>,
    normal: Vec<usize>,
    arrays: HashMap<String, Array>,
    texts: HashMap<String, String>,
    references: HashMap<String, Vec<u32>>,
    /// Columns of tables so far: many variables may stand for one object.
    columns: usize,
}

impl Objects {
    fn new(store: Store) -> Option<Objects> {
        let Store { values, references } = store;
        let arrays = values.arrays.into_iter();
        let mut arrays: HashMap<String, Array> =
            arrays.map(|array| (array.path.clone(), array)).collect();
        let description = arrays.remove("{1}")?.values;
        let bytes: Vec<u8> = description.into_iter().map(|value| value as u8).collect();
        let words: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        let version = *words.first()?;
        if !(2..=4).contains(&version) {
            return None;
        }
        let mut parts = [0; 5];
        for (part, word) in parts.iter_mut().zip(words.get(2..7)?) {
            *part = *word as usize / 4;
        }
        let names = bytes.get(40..4 * parts[0])?.split(|&byte| byte == 0);
        let mut objects = Objects {
            names: names
                .map(|name| String::from_utf8_lossy(name).into_owned())
                .collect(),
            parts,
            saved: vec![],
            normal: vec![],
            arrays,
            texts: values.texts,
            references: references.into_iter().map(|r| (r.path, r.words)).collect(),
            columns: 0,
            words,
        };
        objects.within();
        objects.saved = objects.lists(parts[1], parts[2]);
        objects.normal = objects.lists(parts[3], parts[4]);
        Some(objects)
    }

    /// Within the store an object is a plain array of the words that a variable has for one.
    fn within(&mut self) {
        let is_one = |array: &Array| {
            array.values.len() <= MOST_WORDS && array.values.first() == Some(&f64::from(MAGIC))
        };
        let found = self.arrays.extract_if(|_, array| is_one(array));
        let found = found.map(|(path, array)| {
            let words = array.values.into_iter().map(|word| word as u32);
            (path, words.collect())
        });
        self.references.extend(found);
    }

    /// Where each list of properties of a part begins.
    fn lists(&self, from: usize, to: usize) -> Vec<usize> {
        let (mut lists, mut at) = (vec![], from);
        while let Some(&count) = self.words.get(at).filter(|_| at < to) {
            lists.push(at);
            let end = at.saturating_add(1).saturating_add(3 * count as usize);
            at = end.next_multiple_of(2);
        }
        lists
    }

    /// Class and properties of the only object of a variable.
    fn object(&self, words: &[u32]) -> Option<(&str, Properties)> {
        let sizes = *words.get(1)? as usize;
        let [id, _class] = words.get(sizes.checked_add(2)?..)? else {
            return None;
        };
        let word = |part: usize, entry: u32, size: usize, field: usize| {
            let at = self.parts[part] + entry as usize * size + field;
            self.words.get(at).copied()
        };
        let class = word(2, *id, 6, 0)?;
        let name = |index: u32| self.names.get((index as usize).checked_sub(1)?);
        let class = name(word(0, class, 4, 1)?)?;
        let (saved, normal) = (word(2, *id, 6, 3)?, word(2, *id, 6, 4)?);
        let list = match saved {
            0 => self.normal.get(normal as usize),
            saved => self.saved.get(saved as usize),
        };
        let at = *list?;
        let count = *self.words.get(at)? as usize;
        let all = self.words.get(at + 1..(at + 1).checked_add(3 * count)?)?;
        let kept = all.chunks_exact(3).filter(|triple| triple[1] == IN_A_CELL);
        let pairs = kept.filter_map(|triple| {
            Some((name(triple[0])?.clone(), triple[2] as usize + RESERVED + 1))
        });
        Some((class, pairs.collect()))
    }

    /// The numbers of a variable; `None` if it is of a class that has none for us.
    fn arrays(&mut self, path: &str, words: &[u32], notes: &mut Vec<Note>) -> Option<Vec<Array>> {
        (words.first() == Some(&MAGIC)).then_some(())?;
        let (class, properties) = self.object(words)?;
        let cell = |name: &str| properties.get(name).map(|cell| format!("{{{cell}}}"));
        match class {
            "table" => {
                let (data, names) = (cell("data")?, cell("varnames")?);
                let units = cell("props").map(|props| props + ".VariableUnits");
                Some(self.columns(path, [&data, &names, &units.unwrap_or_default()], notes))
            }
            "timetable" => {
                let all = cell("any")?;
                let [data, names, units] =
                    ["data", "varNames", "varUnits"].map(|field| format!("{all}.{field}"));
                let columns = self.columns(path, [&data, &names, &units], notes);
                let rows = columns.iter().map(|column| column.rows).max()?;
                let mut time = self.row_times(&format!("{all}.rowTimes"), rows)?;
                time.path = format!("{path}.Time");
                Some([vec![time], columns].concat())
            }
            _ => {
                let mut time = self.time(words)?;
                path.clone_into(&mut time.path);
                Some(vec![time])
            }
        }
    }

    /// The columns of a table, each with its name and unit.
    fn columns(
        &mut self,
        path: &str,
        [data, names, units]: [&str; 3],
        notes: &mut Vec<Note>,
    ) -> Vec<Array> {
        let mut columns = vec![];
        for k in 1..=MOST_COLUMNS {
            let Some(name) = self.texts.get(&format!("{names}{{{k}}}")) else {
                break;
            };
            self.columns += 1;
            if self.columns > MOST_COLUMNS_OF_ALL {
                break;
            }
            let (own, at) = (format!("{path}.{name}"), format!("{data}{{{k}}}"));
            let numbers = self.arrays.remove(&at);
            let words = self.references.remove(&at);
            match numbers.or_else(|| self.time(&words?)) {
                Some(mut column) => {
                    column.path = own;
                    if let Some(unit) = self.texts.get(&format!("{units}{{{k}}}")) {
                        unit.clone_into(&mut column.unit);
                    }
                    columns.push(column);
                }
                None => notes.push(left_out(own, "it holds no real numbers")),
            }
        }
        columns
    }

    /// A duration or a date, ms.
    fn time(&mut self, words: &[u32]) -> Option<Array> {
        let (class, properties) = self.object(words)?;
        let cell = match class {
            "duration" => properties.get("millis")?,
            // Since 1970; the imaginary part refines what a double holds.
            "datetime" => properties.get("data")?,
            _ => return None,
        };
        let cell = format!("{{{cell}}}");
        let real = || format!("{cell}.real");
        let mut time = match self.arrays.remove(&cell) {
            Some(time) => time,
            None => self.arrays.remove(&real())?,
        };
        "ms".clone_into(&mut time.unit);
        Some(time)
    }

    /// The times of so many rows: all of them, or the first and the step or rate.
    fn row_times(&mut self, at: &str, rows: usize) -> Option<Array> {
        if let Some(words) = self.references.remove(at) {
            return self.time(&words);
        }
        let scalar = |objects: &Objects, field: &str| {
            let array = objects.arrays.get(&format!("{at}.{field}"))?;
            array.values.first().copied()
        };
        let rate_hz = scalar(self, "sampleRate").filter(|rate| *rate > 0.0);
        let by_rate = scalar(self, "specifiedAsRate").is_some_and(|flag| flag != 0.0);
        let first = |objects: &mut Objects, field: &str| {
            let words = objects.references.remove(&format!("{at}.{field}"))?;
            objects.time(&words)?.values.first().copied()
        };
        let step = match rate_hz.filter(|_| by_rate) {
            Some(rate_hz) => 1e3 / rate_hz,
            None => first(self, "stepSize")?,
        };
        let start = first(self, "origin").unwrap_or(0.0);
        // A date would cost the step its digits.
        let (start, origin) = if start.abs() < DATED_MS {
            (start, 0.0)
        } else {
            (0.0, start)
        };
        Some(Array {
            path: String::new(),
            unit: "ms".to_owned(),
            rows,
            columns: 1,
            values: (0..rows).map(|k| start + k as f64 * step).collect(),
            origin,
        })
    }
}
