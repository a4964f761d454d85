//! Why there is no page.

use crate::chart::ChartError;

/// Why a page cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The lists of a check record do not go together.
    #[error(
        "channel `{channel}` of check record `{record}` has {found} {what} values for {needed} times, equally many are needed"
    )]
    LengthMismatch {
        /// File name of the record.
        record: String,
        /// Output channel.
        channel: String,
        /// `measured`, `nominal` or `corrected`.
        what: &'static str,
        /// Values found.
        found: usize,
        /// Time stamps.
        needed: usize,
    },
    /// A picture failed.
    #[error("the page cannot be drawn: {0}")]
    Chart(#[from] ChartError),
}
