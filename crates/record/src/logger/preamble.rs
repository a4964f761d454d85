//! The sampling that lines above a table tell, where no column holds the time.

use super::cells::{Dialect, number, split};
use crate::{Unit, UnitKind};

/// What the step is called, in small letters and digits alone.
const STEPS: [&str; 22] = [
    "sampleinterval",
    "samplinginterval",
    "samplingperiod",
    "sampleperiod",
    "sampletime",
    "samplingtime",
    "timeinterval",
    "timestep",
    "interval",
    "deltat",
    "deltatime",
    "deltax",
    "dt",
    "xincrement",
    "xincr",
    "xinc",
    "increment",
    "clk",
    "hresolution",
    "abtastzeit",
    "abtastintervall",
    "zeitschritt",
];
/// And the rate.
const RATES: [&str; 10] = [
    "samplerate",
    "samplingrate",
    "samplingfrequency",
    "samplefrequency",
    "samplespersecond",
    "fs",
    "rate",
    "scanrate",
    "abtastrate",
    "abtastfrequenz",
];

/// What names the sampling, and the step, s.
pub(super) fn sampling<'a>(
    lines: impl Iterator<Item = &'a str>,
    dialect: Dialect,
) -> Option<(String, f64)> {
    lines.filter_map(|line| of_line(line, dialect)).next()
}

fn of_line(line: &str, dialect: Dialect) -> Option<(String, f64)> {
    let plain = line.trim_start_matches(['#', '%', '*', ' ', '\t']);
    // `key<separator>value`, and in any table also `key: value` and `key = value`.
    let cells = split(plain, dialect.separator)?;
    let by_cells = match &cells[..] {
        [key, value, rest @ ..] => {
            let unit = rest.first().map_or("", |cell| cell.as_ref());
            told(key, value, unit, dialect)
        }
        _ => None,
    };
    by_cells.or_else(|| {
        let (key, value) = plain.split_once([':', '='])?;
        told(key, value, "", dialect)
    })
}

fn told(key: &str, value: &str, beside: &str, dialect: Dialect) -> Option<(String, f64)> {
    let key = key.trim_matches(|c: char| c.is_whitespace() || matches!(c, ':' | '=' | '"'));
    let (name, in_key) = match key.split_once(['[', '(']) {
        Some((name, unit)) => (name, unit.trim_end_matches([']', ')'])),
        None => (key, ""),
    };
    let plain: String = name.chars().filter(|c| c.is_ascii_alphanumeric()).collect();
    let plain = plain.to_ascii_lowercase();
    let is_rate = RATES.contains(&plain.as_str());
    if !is_rate && !STEPS.contains(&plain.as_str()) {
        return None;
    }
    let value = value.trim().trim_matches('"').trim();
    let end = value.find(|c: char| !matches!(c, '0'..='9' | '.' | ',' | '+' | '-' | 'e' | 'E'));
    let (digits, after) = value.split_at(end.unwrap_or(value.len()));
    let decimal = dialect.decimal_comma && !digits.contains('.');
    let value = number(digits.trim_end_matches(','), decimal)?;
    let unit = [after.trim(), in_key, beside.trim()]
        .into_iter()
        .find(|unit| !unit.is_empty());
    let step_s = if is_rate {
        1.0 / (value * hertz(unit.unwrap_or("Hz"))?)
    } else {
        let unit = Unit::parse(unit.unwrap_or("s"));
        if unit.kind() != UnitKind::Time {
            return None;
        }
        unit.to_si(value)
    };
    (step_s.is_finite() && step_s > 0.0).then(|| (key.to_owned(), step_s))
}

fn hertz(unit: &str) -> Option<f64> {
    Some(match unit.trim() {
        "Hz" | "hz" | "HZ" | "1/s" | "S/s" | "Sa/s" | "samples/s" | "SPS" => 1.0,
        "kHz" | "KHz" | "kS/s" | "kSa/s" => 1e3,
        "MHz" | "MS/s" | "MSa/s" => 1e6,
        _ => return None,
    })
}
