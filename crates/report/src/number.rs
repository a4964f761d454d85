//! Numbers as an engineer writes them.

/// A share between 0 and 1 in per cent: `97 %`, `0.4 %`, `< 0.1 %`; a dash if not finite.
pub(crate) fn percent(share: f64) -> String {
    let p = 100.0 * share;
    match p {
        p if !p.is_finite() => "–".to_owned(),
        p if p > 0.0 && p < 0.1 => "< 0.1 %".to_owned(),
        p if p > 99.9 && p < 100.0 => "> 99.9 %".to_owned(),
        p if (0.0..1.0).contains(&p) && p > 0.0 => format!("{p:.1} %"),
        p if p > 99.0 && p < 100.0 => format!("{p:.1} %"),
        p => format!("{:.0} %", p + 0.0).replace('-', "−"),
    }
}
