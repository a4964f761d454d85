//! Arrow IPC files, which are Feather files of version 2.
//!
//! After a magic word come messages: a length, a description (FlatBuffers), a body. The first one is
//! the schema, the others are batches of rows: for each column marks of what is there and values,
//! plain or packed with LZ4 or Zstandard.

#[cfg(feature = "arrow")]
mod file;
mod flat;
pub(crate) mod schema;

#[cfg(feature = "arrow")]
pub(crate) use file::read;
