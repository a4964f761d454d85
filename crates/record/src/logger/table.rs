//! How a table of text is taken apart.

use super::cells::Dialect;
use crate::heading::Heading;

/// How a table is taken apart. Lines count from 0 here.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    pub(crate) dialect: Dialect,
    /// No number that was looked at has a decimal sign.
    pub(crate) undecided: bool,
    /// `None` where the names were given.
    pub(crate) header: Option<usize>,
    pub(crate) units: Option<usize>,
    /// Line of the first row.
    pub(crate) first_row: usize,
    pub(crate) headings: Vec<Heading>,
}
