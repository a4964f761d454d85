//! What can go wrong, with what was found, what is needed and where.

/// Errors of time integration, forward and inverse.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IntegrateError {
    /// A time step that is not finite and positive.
    #[error("time step is {found_s} s, needed: finite and greater than 0")]
    TimeStep {
        /// The step given, s.
        found_s: f64,
    },
    /// Fewer samples than the formula reaches over.
    #[error("{what} has {found} samples, needed: at least {needed}")]
    TooFewSamples {
        /// Which series.
        what: &'static str,
        /// Number of samples given.
        found: usize,
        /// Least number of samples.
        needed: usize,
    },
    /// A value of the input is NaN or infinite.
    #[error("{what} is {found} at sample {sample}, needed: finite")]
    NotFinite {
        /// Which series.
        what: &'static str,
        /// Index of the sample (column), from 0.
        sample: usize,
        /// The value found.
        found: f64,
    },
    /// An entry of a matrix or of the initial state is NaN or infinite.
    #[error("{what} is {found} at row {row}, column {column}, needed: finite")]
    EntryNotFinite {
        /// Which matrix or vector.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value found.
        found: f64,
    },
    /// A matrix or vector of the wrong size.
    #[error("{what} is {found_rows} x {found_cols}, needed: {needed_rows} x {needed_cols}")]
    Shape {
        /// Which matrix or vector.
        what: &'static str,
        /// Rows found.
        found_rows: usize,
        /// Columns found.
        found_cols: usize,
        /// Rows needed.
        needed_rows: usize,
        /// Columns needed.
        needed_cols: usize,
    },
    /// A parameter of a method outside its valid range.
    #[error("{name} is {found}, needed: {needed}")]
    Parameter {
        /// Name of the parameter.
        name: &'static str,
        /// The value given.
        found: f64,
        /// The valid range in words.
        needed: &'static str,
    },
    /// A matrix that has to be inverted has no inverse.
    #[error(
        "{what} is singular at t = {time_s} s: pivot {pivot} is {found:e} of its column, needed: more than {needed:e}"
    )]
    Singular {
        /// Which matrix.
        what: &'static str,
        /// Time of the step, s.
        time_s: f64,
        /// Index of the pivot, from 0.
        pivot: usize,
        /// The pivot relative to the largest entry of its column before elimination.
        found: f64,
        /// Least relative pivot.
        needed: f64,
    },
    /// Newton's iteration did not reach equilibrium within one step.
    #[error(
        "no equilibrium at t = {time_s} s after {iterations} newton iterations: residual {residual_n:e} N, needed: {tolerance_n:e} N or less"
    )]
    NotConverged {
        /// Time of the step, s.
        time_s: f64,
        /// Iterations done.
        iterations: usize,
        /// Largest entry of the residual, N.
        residual_n: f64,
        /// What it must come down to, N.
        tolerance_n: f64,
    },
    /// The forces of a step are NaN or infinite where Newton's iteration starts.
    #[error("the forces add up to {found} at t = {time_s} s, needed: finite")]
    ForceNotFinite {
        /// Time of the step, s.
        time_s: f64,
        /// Largest entry of the residual.
        found: f64,
    },
    /// The motion grew out of the range of numbers.
    #[error(
        "the motion is not finite at t = {time_s} s, needed: a stable step, found {time_step_s} s"
    )]
    Unstable {
        /// Time of the step, s.
        time_s: f64,
        /// The step in use, s.
        time_step_s: f64,
    },
    /// The adaptive step shrank to nothing.
    #[error("the step shrank to {found_s:e} s at t = {time_s} s, needed: more than {needed_s:e} s")]
    StepTooSmall {
        /// Time of the step, s.
        time_s: f64,
        /// The step that was tried, s.
        found_s: f64,
        /// Least step that still moves the clock, s.
        needed_s: f64,
    },
    /// The adaptive method used up its allowance of steps.
    #[error(
        "{found} steps were spent at t = {time_s} s, needed: the end at {end_s} s within that many"
    )]
    TooManySteps {
        /// Time reached, s.
        time_s: f64,
        /// Steps spent, rejected ones included.
        found: usize,
        /// End of the time grid, s.
        end_s: f64,
    },
    /// The eigenvalues of an amplification matrix could not be computed.
    #[error(
        "the eigenvalues of a {rows} x {rows} matrix did not converge, needed: finite entries of moderate size"
    )]
    Eigenvalues {
        /// Rows of the matrix.
        rows: usize,
    },
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, IntegrateError>;

/// Refuses a time step that is not finite and positive.
pub(crate) fn check_time_step(time_step_s: f64) -> Result<()> {
    if time_step_s.is_finite() && time_step_s > 0.0 {
        Ok(())
    } else {
        Err(IntegrateError::TimeStep {
            found_s: time_step_s,
        })
    }
}

/// Refuses a series with a value that is not finite.
pub(crate) fn check_finite(what: &'static str, values: &[f64]) -> Result<()> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(sample) => Err(IntegrateError::NotFinite {
            what,
            sample,
            found: values[sample],
        }),
    }
}

/// Refuses a series shorter than `needed`.
pub(crate) fn check_length(what: &'static str, found: usize, needed: usize) -> Result<()> {
    if found >= needed {
        Ok(())
    } else {
        Err(IntegrateError::TooFewSamples {
            what,
            found,
            needed,
        })
    }
}
