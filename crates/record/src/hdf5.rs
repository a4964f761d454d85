//! MATLAB 7.3 and HDF5 in general, by the crate `hdf5-pure`.
//!
//! `save -v7.3` writes an HDF5 file after a header of 512 bytes: a dataset for each variable, its
//! class in the attribute `MATLAB_class`, a group for each structure. MATLAB counts the first index
//! fastest and HDF5 the last, so the sizes stand the other way round.

use std::collections::HashMap;

use hdf5_pure::{AttrValue, DType, Dataset, Group};

use crate::MIN_ROWS;
use crate::arrays::{Array, Workspace};
use crate::bytes::counted;
use crate::faults::FormatFault;
use crate::foreign::{guarded, one_line};
use crate::hdf5_newest;
use crate::hdf5_types::{Form, Member};
use crate::mat_objects::{self, Reference};
use crate::note::Note;
use crate::raw::within_limit;

/// Packed best, a byte stands for a hundred numbers; those nobody wrote take no byte at all.
const MOST_NUMBERS_PER_BYTE: u64 = 1000;
/// Groups within groups that are read.
pub(crate) const DEEPEST: usize = 4;
/// Groups and datasets that are looked at: links may run in circles.
const MOST_OBJECTS: usize = 10_000;
type Attributes = HashMap<String, AttrValue>;

/// All real numeric arrays of a file of up to two dimensions.
pub(crate) fn read(mut bytes: Vec<u8>, notes: &mut Vec<Note>) -> Result<Workspace, FormatFault> {
    hdf5_newest::as_known(&mut bytes);
    let is_matlab = bytes.starts_with(b"MATLAB 7.3");
    let (mut walk, store) = guarded("the file", || {
        let most = MOST_NUMBERS_PER_BYTE.saturating_mul(bytes.len() as u64);
        let file = hdf5_pure::File::from_bytes(bytes).map_err(damaged("the head of the file"))?;
        let mut walk = Walk {
            most,
            is_matlab,
            ..Walk::default()
        };
        walk.group(&file.root(), "", 0)?;
        let store = walk.store(&file);
        Ok((walk, store))
    })?;
    notes.append(&mut walk.left_out);
    let mut workspace = Workspace {
        arrays: walk.arrays,
        texts: walk.texts,
    };
    mat_objects::resolve(&mut workspace, walk.references, store, notes);
    Ok(workspace)
}

#[derive(Default)]
pub(crate) struct Walk {
    pub(crate) arrays: Vec<Array>,
    pub(crate) texts: HashMap<String, String>,
    /// Variables that stand for objects of MATLAB.
    pub(crate) references: Vec<Reference>,
    pub(crate) left_out: Vec<Note>,
    pub(crate) objects: usize,
    /// Numbers so far.
    pub(crate) values: u64,
    /// Most that a file of this length can hold.
    pub(crate) most: u64,
    /// Whether MATLAB wrote the file, and whether these are the cells that hold its objects.
    pub(crate) is_matlab: bool,
    pub(crate) is_store: bool,
}

impl Walk {
    pub(crate) fn group(
        &mut self,
        group: &Group,
        path: &str,
        depth: usize,
    ) -> Result<(), FormatFault> {
        let what = match path {
            "" => "the list of variables".to_owned(),
            path => format!("group '{path}'"),
        };
        for (name, dataset) in group.iter_datasets().map_err(damaged(&what))? {
            self.count()?;
            let path = joined(path, &name);
            self.dataset(&dataset, &path, depth)?;
        }
        if depth == DEEPEST {
            return Ok(());
        }
        for (name, group) in group.iter_groups().map_err(damaged(&what))? {
            self.count()?;
            // What MATLAB keeps for itself: `#refs#`, `#subsystem#`.
            if !name.starts_with('#') {
                self.group(&group, &joined(path, &name), depth + 1)?;
            }
        }
        Ok(())
    }

    pub(crate) fn count(&mut self) -> Result<(), FormatFault> {
        self.objects += 1;
        if self.objects > MOST_OBJECTS {
            return Err(FormatFault::TooMuch {
                most: MOST_OBJECTS as u64,
                what: "groups and datasets",
            });
        }
        Ok(())
    }

    pub(crate) fn dataset(
        &mut self,
        dataset: &Dataset,
        path: &str,
        depth: usize,
    ) -> Result<(), FormatFault> {
        match self.read(dataset, path, depth) {
            // What no reader of ours knows is no reason to refuse the rest.
            Err(FormatFault::Unsupported { found, instead }) => {
                let because = format!("it is {found}; {instead}");
                self.leave_out(path, &because, MIN_ROWS as u64);
                Ok(())
            }
            other => other,
        }
    }

    fn read(&mut self, dataset: &Dataset, path: &str, depth: usize) -> Result<(), FormatFault> {
        let what = format!("dataset '{path}'");
        let damaged = damaged(&what);
        let kind = dataset.dtype().map_err(&damaged)?;
        let form = if is_number(&kind) {
            Form::Plain
        } else if let Ok(datatype) = dataset.datatype() {
            Form::of(&datatype, self.is_store)
        } else {
            Form::Unread("its type is not known")
        };
        let attributes = dataset.attrs().map_err(&damaged)?;
        let class = text(&attributes, "MATLAB_class");
        if attributes.contains_key("MATLAB_empty") {
            return Ok(());
        }
        let is_object = attributes.contains_key("MATLAB_object_decode");
        if is_object || self.is_of_matlab(class, &kind) {
            return self.of_matlab(dataset, path, depth, class.filter(|_| !is_object));
        }
        let (outer, inner) = match dataset.shape().map_err(&damaged)?[..] {
            [] => (1, 1),
            [rows] => (1, rows),
            [outer, inner] => (outer, inner),
            _ => {
                self.leave_out(path, "it has more than two dimensions", MIN_ROWS as u64);
                return Ok(());
            }
        };
        let count = outer.saturating_mul(inner);
        self.values = self.values.saturating_add(count);
        within_limit(self.values)?;
        if self.values > self.most {
            return Err(FormatFault::TooMuch {
                most: self.most,
                what: "numbers in a file of this length",
            });
        }
        // A chunk is unpacked whole, however few of its numbers belong to the dataset.
        if let Some(chunk) = dataset.chunk_shape().map_err(&damaged)? {
            within_limit(chunk.into_iter().fold(1, u64::saturating_mul))?;
        }
        let (values, origin) = match form {
            Form::Plain if matches!(kind, DType::I64) => {
                let integers = dataset.read_i64().map_err(&damaged)?;
                counted(&integers.into_iter().map(i128::from).collect::<Vec<_>>())
            }
            Form::Plain if matches!(kind, DType::U64) => {
                let integers = dataset.read_u64().map_err(&damaged)?;
                counted(&integers.into_iter().map(i128::from).collect::<Vec<_>>())
            }
            Form::Plain => (dataset.read_f64().map_err(&damaged)?, 0.0),
            Form::Unread(because) => {
                self.leave_out(path, because, count);
                return Ok(());
            }
            Form::Single(number) => {
                let raw = dataset.read_raw().map_err(&damaged)?;
                (number.column(&raw, 0, number.size), 0.0)
            }
            Form::Record { size, members } => {
                let raw = dataset.read_raw().map_err(&damaged)?;
                if outer == 1 || inner == 1 {
                    self.members(path, &raw, size, members);
                }
                return Ok(());
            }
        };
        if values.len() as u64 != count {
            return Err(FormatFault::Damaged {
                what: one_line(&what),
                reason: format!("{} numbers where {count} should be", values.len()),
            });
        }
        // Both are at most the number of values.
        let (outer, inner) = (outer as usize, inner as usize);
        let unit = text(&attributes, "units").or_else(|| text(&attributes, "unit"));
        let unit = unit.unwrap_or_default().to_owned();
        let (rows, columns, values) = if class.is_some() || outer == 1 {
            (inner, outer, values)
        } else {
            (outer, inner, by_columns(&values, outer, inner))
        };
        self.arrays.push(Array {
            path: path.to_owned(),
            unit,
            rows,
            columns,
            values,
            origin,
        });
        Ok(())
    }

    /// Tells of something as long as a record that is not read.
    pub(crate) fn leave_out(&mut self, path: &str, because: &str, count: u64) {
        if count >= MIN_ROWS as u64 {
            self.left_out.push(Note::LeftOut {
                column: path.to_owned(),
                because: because.to_owned(),
            });
        }
    }

    /// The columns of a table of records, as NumPy and PyTables store it.
    fn members(&mut self, path: &str, raw: &[u8], size: usize, members: Vec<Member>) {
        for Member {
            name,
            offset,
            number,
        } in members
        {
            let path = joined(path, &name);
            match number {
                Err(because) => self.leave_out(&path, because, MIN_ROWS as u64),
                Ok(number) => {
                    let values = number.column(raw, offset, size);
                    self.arrays.push(Array {
                        path,
                        unit: String::new(),
                        rows: values.len(),
                        columns: 1,
                        values,
                        origin: 0.0,
                    });
                }
            }
        }
    }
}

/// Numbers stored row by row, column by column.
fn by_columns(values: &[f64], rows: usize, columns: usize) -> Vec<f64> {
    let column = |k: usize| values.iter().skip(k).step_by(columns).copied();
    let mut turned = Vec::with_capacity(rows * columns);
    (0..columns).for_each(|k| turned.extend(column(k)));
    turned
}

fn is_number(kind: &DType) -> bool {
    use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    matches!(
        kind,
        F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64
    )
}

pub(crate) fn text<'a>(attributes: &'a Attributes, name: &str) -> Option<&'a str> {
    attributes.get(name).and_then(AttrValue::as_str)
}

pub(crate) fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        return name.to_owned();
    }
    format!("{path}.{name}")
}

pub(crate) fn damaged<E: std::fmt::Display>(what: &str) -> impl Fn(E) -> FormatFault {
    move |error| {
        let text = error.to_string();
        let reason = text.strip_prefix("HDF5 format error: ").unwrap_or(&text);
        if reason.contains("version 2 B-tree chunk index") {
            return FormatFault::Unsupported {
                found: format!("{} with more than one unlimited size", one_line(what)),
                instead: "write it with one at most (maxshape), or for an older version, with libver='earliest' in h5py",
            };
        }
        FormatFault::Damaged {
            what: one_line(what),
            reason: one_line(reason),
        }
    }
}
