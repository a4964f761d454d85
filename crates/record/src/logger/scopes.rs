//! Exports of oscilloscopes that are no plain tables: Tektronix TDS, Rigol, GW Instek.

use super::cells::split;
use super::told::{keyed, lacks, told, value};
use crate::base::{Base, Uniform};
use crate::error::RecordError;
use crate::note::Note;
use crate::raw::{Raw, RawColumn};
use crate::{MAX_ROWS, Unit, UnitKind};

const TEKTRONIX: &str = "Tektronix oscilloscope";
const RIGOL: &str = "Rigol oscilloscope";
const INSTEK: &str = "GW Instek oscilloscope";

/// `F0000CH1.CSV`: settings in the first three cells of each line, time and value in the fourth and
/// fifth.
pub(super) fn is_tektronix(lines: &[&str]) -> bool {
    let Some(cells) = lines.first().and_then(|line| split(line, ',')) else {
        return false;
    };
    let is_number = |k: usize| {
        cells
            .get(k)
            .is_some_and(|c| c.trim().parse::<f64>().is_ok())
    };
    cells[0].trim() == "Record Length" && is_number(3) && is_number(4)
}

pub(super) fn tektronix(file: &str, text: &str, notes: &mut Vec<Note>) -> Result<Raw, RecordError> {
    let lines: Vec<&str> = super::text::lines(text).take(64).collect();
    let word = |key: &str, otherwise: &str| {
        keyed(&lines, ',', key).map_or_else(|| otherwise.to_owned(), |(_, value)| value)
    };
    let x_unit = word("Horizontal Units", "s");
    let in_s = seconds(file, &lines, "Horizontal Units", &x_unit, TEKTRONIX)?;
    let (mut time, mut values) = (Vec::new(), Vec::new());
    for (k, line) in super::text::lines(text).enumerate() {
        let Some(cells) = split(line, ',').filter(|cells| cells.len() >= 5) else {
            continue;
        };
        if time.len() == MAX_ROWS {
            let file = file.to_owned();
            return Err(RecordError::TooManyRows { file });
        }
        time.push(value(file, k, "time", &cells[3], false)? * in_s);
        values.push(value(file, k, "value", &cells[4], false)?);
    }
    told(
        notes,
        "read as an export of a Tektronix oscilloscope, time and values in the columns 4 and 5",
    );
    let name = word("Source", "CH1");
    Ok(one(
        name,
        word("Vertical Units", "V"),
        values,
        Base::Stamps(time),
    ))
}

/// The line that ends with `Start,Increment`.
pub(super) fn rigol_header(lines: &[&str]) -> Option<usize> {
    lines.iter().take(4).position(|line| {
        let Some(cells) = split(line, ',') else {
            return false;
        };
        let has = |word: &str| cells.iter().any(|cell| cell.eq_ignore_ascii_case(word));
        has("Start")
            && has("Increment")
            && cells
                .first()
                .is_some_and(|cell| cell.eq_ignore_ascii_case("X"))
    })
}

/// Sequence numbers, channels, and start and step beside their units in the line below the names.
pub(super) fn rigol(
    file: &str,
    text: &str,
    header: usize,
    notes: &mut Vec<Note>,
) -> Result<Raw, RecordError> {
    let mut lines = super::text::lines(text).enumerate().skip(header);
    let mut cells = || {
        let (_, line) = lines.next()?;
        let cells = split(line, ',')?;
        Some(
            cells
                .into_iter()
                .map(|c| c.into_owned())
                .collect::<Vec<_>>(),
        )
    };
    let (names, units) = (cells().unwrap_or_default(), cells().unwrap_or_default());
    let number = |word: &str| {
        let at = names
            .iter()
            .position(|name| name.eq_ignore_ascii_case(word));
        at.and_then(|at| units.get(at)?.trim().parse::<f64>().ok())
    };
    let (start_s, step_s) = (number("Start"), number("Increment"));
    let (Some(start_s), Some(step_s)) = (start_s, step_s.filter(|step| *step > 0.0)) else {
        let found = "no start and step found below 'Start,Increment'".to_owned();
        return Err(lacks(file, header + 1, found, "a number below each", RIGOL));
    };
    let channels: Vec<usize> = (1..names.len())
        .take_while(|&k| !names[k].eq_ignore_ascii_case("Start"))
        .filter(|&k| !names[k].is_empty())
        .collect();
    let mut columns = vec![Vec::new(); channels.len()];
    let mut first = None;
    for (k, line) in lines {
        let Some(cells) = split(line, ',').filter(|cells| !cells[0].is_empty()) else {
            continue;
        };
        first = first.or(Some(value(file, k, "X", &cells[0], false)?));
        for (column, &at) in columns.iter_mut().zip(&channels) {
            let cell = cells.get(at).map_or("", |cell| cell.as_ref());
            column.push(value(file, k, &names[at], cell, false)?);
            if column.len() > MAX_ROWS {
                let file = file.to_owned();
                return Err(RecordError::TooManyRows { file });
            }
        }
    }
    told(
        notes,
        "read as an export of a Rigol oscilloscope, time from its start and increment",
    );
    let mut raw = Raw::default();
    let base = raw.base(Base::Even(Uniform {
        start_s: start_s + first.unwrap_or(0.0) * step_s,
        step_s,
        rows: columns.first().map_or(0, Vec::len),
    }));
    for (values, at) in columns.into_iter().zip(channels) {
        raw.columns.push(RawColumn {
            name: names[at].clone(),
            unit: plain_unit(units.get(at).map_or("", String::as_str)),
            values,
            base: Some(base),
            ..RawColumn::default()
        });
    }
    Ok(raw)
}

/// The line that says `t0 = ..., tInc = ...` behind the names, as the later scopes write it; the
/// first and the step.
pub(super) fn rigol_inline(lines: &[&str]) -> Option<(usize, f64, f64)> {
    lines.iter().take(4).enumerate().find_map(|(at, line)| {
        let cells = split(line, ',')?;
        let number = |word: &str| {
            let mut pairs = cells.iter().filter_map(|cell| cell.split_once('='));
            let (_, number) = pairs.find(|(key, _)| key.trim().eq_ignore_ascii_case(word))?;
            number.trim().trim_end_matches('s').parse::<f64>().ok()
        };
        let is_timed = cells
            .iter()
            .any(|cell| crate::time_names::is_time_name(cell));
        let step = number("tInc").filter(|step| *step > 0.0 && !is_timed)?;
        Some((at, number("t0")?, step))
    })
}

/// Channels, each named with its unit (`CH1V`), in the first columns.
pub(super) fn rigol_later(
    file: &str,
    text: &str,
    (header, start_s, step_s): (usize, f64, f64),
    notes: &mut Vec<Note>,
) -> Result<Raw, RecordError> {
    let mut lines = super::text::lines(text).enumerate().skip(header);
    let line = lines.next().map_or("", |(_, line)| line);
    let names = split(line, ',').unwrap_or_default();
    let names: Vec<&str> = names
        .iter()
        .map(|name| name.trim())
        .take_while(|name| !name.contains('='))
        .collect();
    let mut columns = vec![Vec::new(); names.len()];
    for (k, line) in lines {
        let cells = split(line, ',').unwrap_or_default();
        if cells.iter().all(|cell| cell.is_empty()) {
            continue;
        }
        for (at, (column, name)) in columns.iter_mut().zip(&names).enumerate() {
            let cell = cells.get(at).map_or("", |cell| cell.as_ref());
            column.push(value(file, k, name, cell, false)?);
            if column.len() > MAX_ROWS {
                let file = file.to_owned();
                return Err(RecordError::TooManyRows { file });
            }
        }
    }
    told(
        notes,
        "read as an export of a Rigol oscilloscope, time from t0 and tInc",
    );
    let mut raw = Raw::default();
    let base = raw.base(Base::Even(Uniform {
        start_s,
        step_s,
        rows: columns.first().map_or(0, Vec::len),
    }));
    for (values, name) in columns.into_iter().zip(names) {
        let (name, unit) = ["V", "A", "W"]
            .into_iter()
            .filter_map(|unit| Some((name.strip_suffix(unit)?, unit)))
            .find(|(channel, _)| channel.ends_with(|c: char| c.is_ascii_digit()))
            .unwrap_or((name, ""));
        raw.columns.push(RawColumn {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
            base: Some(base),
            ..RawColumn::default()
        });
    }
    Ok(raw)
}

/// Settings, one a line, then `Waveform Data` and the values.
pub(super) fn is_instek(text: &str, lines: &[&str]) -> bool {
    keyed(lines, ',', "Memory Length").is_some() && text.contains("Waveform Data")
}

pub(super) fn instek(file: &str, text: &str, notes: &mut Vec<Note>) -> Result<Raw, RecordError> {
    let lines: Vec<&str> = super::text::lines(text).take(64).collect();
    let word = |key: &str| keyed(&lines, ',', key).map(|(_, value)| value);
    let data = lines
        .iter()
        .position(|line| line.trim_start().starts_with("Waveform Data"));
    let data = data.unwrap_or(lines.len());
    let (mut time, mut values) = (Vec::new(), Vec::new());
    for (k, line) in super::text::lines(text).enumerate().skip(data + 1) {
        let cells = split(line, ',').unwrap_or_default();
        let mut cells: Vec<&str> = cells.iter().map(|cell| cell.as_ref()).collect();
        while cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        match cells[..] {
            [] => continue,
            [x] => values.push(value(file, k, "value", x, false)?),
            [t, x, ..] => {
                time.push(value(file, k, "time", t, false)?);
                values.push(value(file, k, "value", x, false)?);
            }
        }
        if values.len() > MAX_ROWS {
            let file = file.to_owned();
            return Err(RecordError::TooManyRows { file });
        }
    }
    let name = word("Source").unwrap_or_else(|| "CH1".to_owned());
    let unit = word("Vertical Units").unwrap_or_default();
    if time.len() == values.len() {
        told(
            notes,
            "read as an export of a GW Instek oscilloscope, times beside the values",
        );
        return Ok(one(name, unit, values, Base::Stamps(time)));
    }
    let step = word("Sampling Period").and_then(|word| word.trim().parse::<f64>().ok());
    let Some(step_s) = step.filter(|step| *step > 0.0) else {
        let found = "no 'Sampling Period' found".to_owned();
        return Err(lacks(
            file,
            data,
            found,
            "the sampling period above 'Waveform Data'",
            INSTEK,
        ));
    };
    // Fast files hold what the converter counted, not what it measured.
    told(
        notes,
        "read as a fast export of a GW Instek oscilloscope: values are counts of its converter, to be scaled \
         by a gain in the model",
    );
    let base = Base::Even(Uniform {
        start_s: 0.0,
        step_s,
        rows: values.len(),
    });
    Ok(one(name, "counts".to_owned(), values, base))
}

fn one(name: String, unit: String, values: Vec<f64>, base: Base) -> Raw {
    let mut raw = Raw::default();
    let base = raw.base(base);
    raw.columns.push(RawColumn {
        name,
        unit: plain_unit(&unit),
        values,
        base: Some(base),
        ..RawColumn::default()
    });
    raw
}

fn plain_unit(unit: &str) -> String {
    match unit.trim() {
        "Volt" | "Volts" | "volt" => "V".to_owned(),
        unit => unit.to_owned(),
    }
}

/// Seconds of a unit of time.
fn seconds(
    file: &str,
    lines: &[&str],
    key: &str,
    symbol: &str,
    program: &'static str,
) -> Result<f64, RecordError> {
    let unit = Unit::parse(symbol);
    if unit.kind() == UnitKind::Time {
        return Ok(unit.si_factor());
    }
    let line = keyed(lines, ',', key).map_or(0, |(line, _)| line);
    let found = format!("the axis is in [{}]", crate::words::shortened(symbol));
    Err(lacks(file, line, found, "a record over time", program))
}
