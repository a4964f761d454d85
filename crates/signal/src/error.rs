//! The one error type of this crate.

/// What was wrong with the arguments of a signal routine.
///
/// Each variant says what was found, what is needed, and which argument it concerns.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// The argument has too few entries for the routine to mean anything.
    #[error("{what} has {found} entries, at least {needed} are needed")]
    TooShort {
        /// Name of the argument.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries needed.
        needed: usize,
    },
    /// Two arguments that go together have different lengths.
    #[error("{what} has {found} entries, {needed} are needed to match {with}")]
    LengthMismatch {
        /// Name of the argument.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Name of the argument it must match.
        with: &'static str,
        /// Entries of that argument.
        needed: usize,
    },
    /// A NaN or an infinity.
    #[error("{what} is {value} at index {index}, a finite number is needed")]
    NonFinite {
        /// Name of the argument.
        what: &'static str,
        /// Index of the first entry that is not finite.
        index: usize,
        /// That entry.
        value: f64,
    },
    /// A number outside its legal range.
    #[error("{what} is {value}, {needed} is needed")]
    OutOfRange {
        /// Name of the argument.
        what: &'static str,
        /// Value found.
        value: f64,
        /// The legal range in words.
        needed: &'static str,
    },
    /// A frequency that the sampling cannot show.
    #[error("{what} is {freq_hz} Hz, a value between 0 and {limit_hz} Hz is needed")]
    FrequencyRange {
        /// Name of the argument.
        what: &'static str,
        /// Frequency found, Hz.
        freq_hz: f64,
        /// Upper limit (not included), Hz.
        limit_hz: f64,
    },
    /// The signal is constant or zero where its variation is the divisor.
    #[error("{what} does not vary, a signal with some power is needed")]
    Flat {
        /// Name of the argument.
        what: &'static str,
    },
    /// The columns of a least-squares fit of lines are (nearly) dependent.
    #[error(
        "the line at {freq_hz} Hz cannot be told from the lines before it, \
         the mean or the trend on these times"
    )]
    NotSeparable {
        /// Frequency of the first line that adds nothing new, Hz.
        freq_hz: f64,
    },
}
