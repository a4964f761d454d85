//! What MATLAB 7.3 keeps by references: cells, arrays of structures, texts, objects.
//!
//! A cell array is a dataset of references to what its cells hold; an array of structures is a group
//! with such a dataset for each field. The store of objects is a cell array in `#subsystem#`.

use hdf5_pure::{DType, Dataset, File, Object};

use crate::MIN_ROWS;
use crate::faults::FormatFault;
use crate::hdf5::{DEEPEST, Walk, damaged};
use crate::mat_objects::{MOST_WORDS, Reference, Store};

/// Cells of an array that are looked at.
const MOST_CELLS: usize = 1000;
/// Characters of a text, at most.
const LONGEST: u64 = 200;

impl Walk {
    /// Whether a dataset is none of numbers, but one by a habit of MATLAB.
    pub(crate) fn is_of_matlab(&self, class: Option<&str>, kind: &DType) -> bool {
        matches!(class, Some("char" | "cell" | "function_handle" | "string"))
            || (self.is_matlab && matches!(kind, DType::ObjectReference))
    }

    /// A text, a cell array, a field of an array of structures, or an object, which has no class here.
    pub(crate) fn of_matlab(
        &mut self,
        dataset: &Dataset,
        path: &str,
        depth: usize,
        class: Option<&str>,
    ) -> Result<(), FormatFault> {
        let what = format!("dataset '{path}'");
        let damaged = damaged(&what);
        let sizes = dataset.shape().map_err(&damaged)?;
        let count = sizes.into_iter().fold(1, u64::saturating_mul);
        let is_reference = matches!(dataset.dtype().map_err(&damaged)?, DType::ObjectReference);
        match class {
            Some("char") if count <= LONGEST => {
                let units = dataset.read_u16().map_err(&damaged)?;
                let text = char::decode_utf16(units)
                    .map(|c| c.unwrap_or(' '))
                    .collect();
                self.texts.insert(path.to_owned(), text);
            }
            _ if is_reference => return self.cells(dataset, path, depth, count),
            // An object that stands for itself.
            None if count <= MOST_WORDS as u64 => {
                let words = dataset.read_u32().map_err(&damaged)?;
                let path = path.to_owned();
                self.references.push(Reference { path, words });
            }
            _ => {}
        }
        Ok(())
    }

    fn cells(
        &mut self,
        dataset: &Dataset,
        path: &str,
        depth: usize,
        count: u64,
    ) -> Result<(), FormatFault> {
        if depth >= DEEPEST {
            return Ok(());
        }
        if count > MOST_CELLS as u64 {
            let because = format!("it is an array of {count} cells or structures");
            self.leave_out(path, &because, MIN_ROWS as u64);
            return Ok(());
        }
        let class = dataset.attrs().ok();
        let is_cell = class.is_some_and(|a| a.contains_key("MATLAB_class"));
        let what = format!("dataset '{path}'");
        // A reference to nothing is no reason to refuse the rest.
        let Ok(cells) = dataset.dereference().map_err(damaged(&what)) else {
            return Ok(());
        };
        for (k, cell) in cells.into_iter().enumerate() {
            self.count()?;
            let path = match path.rsplit_once('.') {
                Some((array, field)) if !is_cell => format!("{array}({}).{field}", k + 1),
                _ => format!("{path}{{{}}}", k + 1),
            };
            match cell {
                Object::Group(group) => self.group(&group, &path, depth + 1)?,
                Object::Dataset(dataset) => self.dataset(&dataset, &path, depth + 1)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// What the objects of the file hold, where it has any.
    pub(crate) fn store(&mut self, file: &File) -> Option<Store> {
        if self.references.is_empty() {
            return None;
        }
        let group = file.group("#subsystem#").ok()?;
        let cells = group.dataset("MCOS").ok()?.dereference().ok()?;
        let mut walk = Walk {
            objects: self.objects,
            values: self.values,
            most: self.most,
            is_matlab: true,
            is_store: true,
            ..Walk::default()
        };
        for (k, cell) in cells.into_iter().enumerate() {
            let path = format!("{{{}}}", k + 1);
            let read = match cell {
                Object::Group(group) => walk.group(&group, &path, 1),
                Object::Dataset(dataset) => walk.dataset(&dataset, &path, 1),
                _ => Ok(()),
            };
            read.ok()?;
        }
        Some(Store {
            values: crate::arrays::Workspace {
                arrays: walk.arrays,
                texts: walk.texts,
            },
            references: walk.references,
        })
    }
}
