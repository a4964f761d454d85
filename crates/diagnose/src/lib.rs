//! Where the gap lies, which effect causes it, how far it shrinks.

mod diagnosis;

pub use diagnosis::*;
