//! Numbers rounded for print, so that the last bits of another machine do not show.

/// A value rounded to so many significant digits; what is not finite stays as it is.
#[must_use]
pub fn round_to(value: f64, digits: usize) -> f64 {
    // The decimal way round: the text is the number that is meant.
    format!("{value:.*e}", digits.max(1) - 1)
        .parse()
        .unwrap_or(value)
}

/// A value in decimal notation with so many significant digits; exponents outside 10⁻⁴..10¹⁰.
///
/// ```
/// assert_eq!(xtask::reproduce::significant(0.000617391, 4), "0.0006174");
/// assert_eq!(xtask::reproduce::significant(8287639.0, 7), "8287639");
/// assert_eq!(xtask::reproduce::significant(-0.0, 3), "0");
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let rounded = round_to(value, digits);
    if rounded == 0.0 {
        return "0".to_owned();
    }
    if !rounded.is_finite() {
        return rounded.to_string();
    }
    let exponent = rounded.abs().log10().floor();
    if !(-4.0..10.0).contains(&exponent) {
        return format!("{rounded:.*e}", digits.max(1) - 1);
    }
    let decimals = (digits as f64 - 1.0 - exponent).max(0.0) as usize;
    format!("{rounded:.decimals$}")
}

/// The least and the largest of some values, "a to b"; one number where both are shown alike.
#[must_use]
pub fn range(values: &[f64], digits: usize) -> String {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (least, most) = (significant(least, digits), significant(most, digits));
    if least == most {
        least
    } else {
        format!("{least} to {most}")
    }
}
