//! What is made of many variables: objects out of the store of a file, and columns out of structures.

use super::{File, MATRIX, element, joined, text};
use crate::MIN_ROWS;
use crate::arrays::{Array, Workspace};
use crate::bytes::Bytes;
use crate::faults::FormatFault;
use crate::mat_objects::{MOST_WORDS, OBJECT, Reference, Store};

/// The class of the array of bytes that holds the store.
const BYTES: u32 = 9;
/// The class of the cell array in it.
const WRAPPER: &str = "FileWrapper__";

impl File<'_> {
    /// A variable that stands for an object, or the cells of the store.
    pub(super) fn opaque(&mut self, data: &mut Bytes<'_>, path: &str) -> Result<(), FormatFault> {
        const WHAT: &str = "an object";
        let name = text(element(data, WHAT)?.1)?;
        let path = joined(path, &name);
        // The name of the system of objects comes first.
        element(data, WHAT)?;
        let class = text(element(data, WHAT)?.1)?;
        let (kind, mut inner) = element(data, WHAT)?;
        if kind != MATRIX {
            self.left_out(path, OBJECT);
            return Ok(());
        }
        for _flags_sizes_name in 0..3 {
            element(&mut inner, WHAT)?;
        }
        if class == WRAPPER && self.is_store {
            return self.cells(&mut inner, "", u64::MAX, 0);
        }
        let (_, mut values) = element(&mut inner, WHAT)?;
        let mut words = vec![];
        while values.left() >= 4 && words.len() < MOST_WORDS {
            words.push(values.u32(WHAT)?);
        }
        if self.references.len() < super::MOST_ARRAYS {
            self.references.push(Reference { path, words });
        }
        Ok(())
    }

    /// The store: a file within the file, in an array of bytes without a name.
    pub(super) fn objects(&mut self, data: &mut Bytes<'_>, class: u32) -> Result<(), FormatFault> {
        // Its own head has no text.
        const HEAD: u64 = 8;
        const WHAT: &str = "the objects of MATLAB";
        if class != BYTES || self.store.is_some() {
            return Ok(());
        }
        let (_, mut inner) = element(data, WHAT)?;
        if (inner.left() as u64) < HEAD {
            return Ok(());
        }
        inner.take(HEAD, WHAT)?;
        let mut unread = vec![];
        let mut file = File {
            notes: &mut unread,
            workspace: Workspace::default(),
            references: vec![],
            store: None,
            is_store: true,
            inflated: self.inflated,
            values: self.values,
        };
        // Without it variables are read all the same, but for the objects.
        if file.element(&mut inner, "", 0).is_ok() {
            let (values, references) = (file.workspace, file.references);
            (self.inflated, self.values) = (file.inflated, file.values);
            self.store = Some(Store { values, references });
        }
        Ok(())
    }

    /// Takes a number by which an array of structures holds one value of a column.
    pub(super) fn take_scalar(&mut self, count: u64, path: &str, column: &mut Vec<f64>) {
        if count < MIN_ROWS as u64 {
            return;
        }
        let last = self.workspace.arrays.last();
        let is_one = last.is_some_and(|last| last.values.len() == 1 && last.path == path);
        if let Some(scalar) = self.workspace.arrays.pop_if(|_| is_one) {
            column.push(scalar.values[0] + scalar.origin);
        }
    }

    /// A column of as many numbers as there are structures.
    pub(super) fn column_of_scalars(&mut self, path: String, values: Vec<f64>, count: u64) {
        if values.len() >= MIN_ROWS && values.len() as u64 == count {
            self.workspace.arrays.push(Array {
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
