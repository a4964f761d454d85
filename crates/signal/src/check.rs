//! Argument checks shared by all modules.

use crate::SignalError;

/// At least `needed` entries, all finite.
pub(crate) fn finite(what: &'static str, values: &[f64], needed: usize) -> Result<(), SignalError> {
    if values.len() < needed {
        return Err(SignalError::TooShort {
            what,
            found: values.len(),
            needed,
        });
    }
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(SignalError::NonFinite {
            what,
            index,
            value: values[index],
        }),
        None => Ok(()),
    }
}

/// Two arguments of one length.
pub(crate) fn same_len(
    what: &'static str,
    found: usize,
    with: &'static str,
    needed: usize,
) -> Result<(), SignalError> {
    if found == needed {
        Ok(())
    } else {
        Err(SignalError::LengthMismatch {
            what,
            found,
            with,
            needed,
        })
    }
}

/// Two finite curves of one length: what every agreement metric asks for.
pub(crate) fn pair(measured: &[f64], predicted: &[f64], needed: usize) -> Result<(), SignalError> {
    finite("measured", measured, needed)?;
    same_len("predicted", predicted.len(), "measured", measured.len())?;
    finite("predicted", predicted, needed)
}

/// A positive finite number.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), SignalError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(SignalError::OutOfRange {
            what,
            value,
            needed: "a positive finite number",
        })
    }
}

/// Median by selection; `scratch` is reordered. An empty slice gives NaN.
///
/// ```
/// assert_eq!(simgap_signal::median(&mut [5.0, 1.0, 2.0, 4.0]), 3.0);
/// ```
#[must_use]
pub fn median(scratch: &mut [f64]) -> f64 {
    let n = scratch.len();
    if n == 0 {
        return f64::NAN;
    }
    let (below, upper, _) = scratch.select_nth_unstable_by(n / 2, f64::total_cmp);
    if n % 2 == 1 {
        return *upper;
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * (lower + *upper)
}
