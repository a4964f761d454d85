//! How much is read, and how little is enough.

/// Most rows that are read: 80 minutes at 1 kHz. Reading stops there.
pub const MAX_ROWS: usize = 5_000_000;

/// Longest line that is read, bytes. Keeps a file without line ends out of memory.
pub const MAX_LINE_BYTES: usize = 1 << 20;

/// Fewest rows a record may have: with less, nothing of a motion can be told.
pub const MIN_ROWS: usize = 8;

/// No file but a CSV of the contract's own form is read that is longer: such a file is held in
/// memory whole.
pub const MAX_FILE_BYTES: u64 = 1 << 30;
