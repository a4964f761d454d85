//! Numbers as an engineer writes them.

/// A share between 0 and 1 in per cent: `97 %`, `0.4 %`, `< 0.1 %`, with a space that does not break; a dash if not finite.
pub(crate) fn percent(share: f64) -> String {
    let p = 100.0 * share;
    match p {
        p if !p.is_finite() => "–".to_owned(),
        p if p > 0.0 && p < 0.1 => "< 0.1\u{a0}%".to_owned(),
        p if p > 99.9 && p < 100.0 => "> 99.9\u{a0}%".to_owned(),
        p if p > 0.0 && p < 1.0 || p > 99.0 && p < 100.0 => format!("{p:.1}\u{a0}%"),
        p => with_true_minus(&format!("{p:.0}")) + "\u{a0}%",
    }
}

/// A relative change to two digits, with its sign: `+0.12 %`, `−8.5 %`, `+230 %`.
pub(crate) fn change(relative: f64) -> String {
    let sign = if relative > 0.0 { "+" } else { "" };
    format!("{sign}{}\u{a0}%", significant(100.0 * relative, 2))
}

/// A gap below this is told as such.
const NO_GAP: f64 = 1e-5;

/// A ratio such as a gap, to three digits: `0.412`, `0.0210`, `1.73`; a dash if not finite.
pub(crate) fn ratio(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value > 0.0 && value < NO_GAP {
        return "< 10⁻⁵".to_owned();
    }
    significant(value, 3)
}

/// To so many digits, without trailing zeros after the point.
pub(crate) fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if text.contains('.') && !text.contains('·') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The decimal numbers of a text that have more digits to four: "68.3301 Hz" is "68.33 Hz", "2.0000 Hz"
/// is "2 Hz".
pub(crate) fn fewer_digits(text: &str) -> String {
    let part = |c: char| c.is_alphanumeric() || matches!(c, '.' | '_');
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(part) {
        let (before, from) = rest.split_at(start);
        let (word, after) = from.split_at(from.find(|c| !part(c)).unwrap_or(from.len()));
        out.push_str(before);
        let point = word.trim_end_matches('.');
        let digits = point.chars().filter(char::is_ascii_digit).count();
        let number = digits + 1 == point.chars().count() && point.contains('.');
        match point.parse::<f64>() {
            Ok(value) if number && digits > 4 => {
                out.push_str(&trimmed(value, 4));
                out.push_str(&word[point.len()..]);
            }
            _ => out.push_str(word),
        }
        rest = after;
    }
    out + rest
}

/// "2.9–3.1 Hz", to three digits without trailing zeros.
pub(crate) fn range(from: f64, to: f64, unit: &str) -> String {
    format!("{}–{}\u{a0}{unit}", trimmed(from, 3), trimmed(to, 3))
}

/// `value` to `digits` significant digits, in tenfold notation where it would be long.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    let exponent = exponent_of(value, digits);
    at_resolution(value, exponent + 1 - digits as i32)
}

/// `value` rounded to 10^`resolution`; numbers that would need more than six places on either
/// side of the point are written with a power of ten.
pub(crate) fn at_resolution(value: f64, resolution: i32) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let exponent = decimal_exponent(value).max(resolution);
    if !(-4..6).contains(&exponent) && value != 0.0 {
        let decimals = (exponent - resolution).clamp(0, 12) as usize;
        // Twice, since one power of ten may overflow where two do not.
        let half = exponent / 2;
        let mantissa = value / 10f64.powi(half) / 10f64.powi(exponent - half);
        let power = crate::chart::superscript(exponent);
        return with_true_minus(&format!("{mantissa:.decimals$}")) + "·10" + &power;
    }
    let decimals = (-resolution).clamp(0, 12) as usize;
    let step = 10f64.powi(resolution.max(0));
    let rounded = (value / step).round() * step;
    let shown = if resolution > 0 { rounded } else { value };
    with_true_minus(&format!("{shown:.decimals$}"))
}

/// The power of ten of the first digit; 0 for zero.
pub(crate) fn decimal_exponent(value: f64) -> i32 {
    exponent_of(value, 6)
}

/// The power of ten of the first digit once the value is rounded to `digits`.
fn exponent_of(value: f64, digits: usize) -> i32 {
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    // The formatter rounds properly at powers of ten, which log10 may miss by one.
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.rsplit('e')
        .next()
        .and_then(|e| e.parse().ok())
        .unwrap_or(0)
}

/// With − for the hyphen, and no sign on zero.
pub(crate) fn with_true_minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_percent() {
        let cases = [
            (0.974, "97\u{a0}%"),
            (1.0, "100\u{a0}%"),
            (0.0, "0\u{a0}%"),
            (0.0042, "0.4\u{a0}%"),
            (1e-9, "< 0.1\u{a0}%"),
            (0.9966, "99.7\u{a0}%"),
            (0.99999, "> 99.9\u{a0}%"),
            (-0.12, "−12\u{a0}%"),
            (f64::NAN, "–"),
        ];
        for (share, text) in cases {
            assert_eq!(percent(share), text);
        }
    }

    #[test]
    fn verify_changes_and_numbers_in_a_text() {
        assert_eq!(change(-0.001_2), "−0.12\u{a0}%");
        assert_eq!(change(0.085), "+8.5\u{a0}%");
        assert_eq!(change(2.345), "+230\u{a0}%");
        assert_eq!(ratio(1.1e-9), "< 10⁻⁵");
        assert_eq!(
            fewer_digits("near 68.3301 Hz, 2.0000 Hz of train-1.csv, v1.2.3 and 1.00."),
            "near 68.33 Hz, 2 Hz of train-1.csv, v1.2.3 and 1.00."
        );
    }

    #[test]
    fn verify_significant_digits() {
        let cases = [
            (0.412, "0.412"),
            (0.02099, "0.0210"),
            (0.0, "0.00"),
            (9.999, "10.0"),
            (2104.3, "2100"),
            (-3.4159, "−3.42"),
            (1.2345e9, "1.23·10⁹"),
            (1.2345e-7, "1.23·10⁻⁷"),
            (1e300, "1.00·10³⁰⁰"),
            (5e-324, "4.94·10⁻³²⁴"),
        ];
        for (value, text) in cases {
            assert_eq!(significant(value, 3), text, "{value}");
        }
        assert_eq!(at_resolution(2104.3, 1), "2100");
        assert_eq!(at_resolution(2104.36, -1), "2104.4");
        assert_eq!(ratio(f64::INFINITY), "–");
        assert_eq!(range(0.0, 6.0, "s"), "0–6\u{a0}s");
        assert_eq!(range(2.9, 3.1, "Hz"), "2.9–3.1\u{a0}Hz");
    }
}
