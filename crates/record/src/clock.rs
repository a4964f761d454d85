//! The unit of a time base: what the file says, what the name says, or what the stamps can only be.
//!
//! Milliseconds read as seconds make every answer wrong and none suspicious. So a unit is taken
//! from the map, the header or the name; else from stamps that can be but one thing (a count since
//! 1970, days of a calendar); else seconds are assumed and told, unless the stamps speak against
//! them. Then the choice is the user's.

use crate::Unit;
use crate::error::RecordError;
use crate::faults::SelectionFault;
use crate::heading::Heading;
use crate::map::ChannelMap;
use crate::note::Note;
use crate::resample::usual_step;
use crate::time_names::unit_in_name;
use crate::words::{digits, shortened};

/// Seconds since 1970 of the years 2000 and 2100, and of 2100 in seconds since 1904.
const FROM_2000: f64 = 946_684_800.0;
const TO_2100: f64 = 4_102_444_800.0;
const TO_2100_FROM_1904: f64 = 6_185_289_600.0;
/// Days of the years 2000 to 2100 as spreadsheets count them, and as MATLAB does.
const DAYS: [(f64, f64); 2] = [(36_526.0, 73_051.0), (730_486.0, 767_011.0)];
/// Longest step of a record of a machine, s, and shortest.
const LONGEST_S: f64 = 10.0;
const SHORTEST_S: f64 = 1e-7;
/// A name for parts of a second is doubted up to this step, s: seconds under it would be of 10 Hz or
/// more in ms, and of 500 Hz or more in us.
const DOUBTED_MS_S: f64 = 1.01e-4;
const DOUBTED_S: f64 = 2e-6;
/// From here on time counts from the first stamp, s: three years are no time of a run.
const COUNTED_FROM_S: f64 = 1e8;
/// A step without a unit from here on may be any.
const ANY_UNIT: f64 = 1.0;

/// Stamps as a file holds them.
#[derive(Debug, Clone)]
pub(crate) struct Stamps {
    pub(crate) values: Vec<f64>,
    /// What the values are counted from, in their own unit.
    pub(crate) origin: f64,
}

/// The stamps and their unit.
pub(crate) fn clocked(
    file: &str,
    heading: &Heading,
    map: &ChannelMap,
    stamps: Stamps,
    notes: &mut Vec<Note>,
) -> Result<(Vec<f64>, Unit), RecordError> {
    let (first, step) = first_and_step(&stamps);
    let unit = unit_of(file, heading, map, (first, step), notes)?;
    let Stamps { mut values, origin } = stamps;
    if unit.to_si(first.abs()) >= COUNTED_FROM_S || origin != 0.0 {
        let start = values.first().copied().unwrap_or(0.0);
        values.iter_mut().for_each(|t| *t -= start);
        notes.push(Note::CountedFrom {
            column: heading.name.clone(),
            first: format!("{first} {unit}"),
        });
    }
    Ok((values, unit))
}

/// The first stamp and the usual step, in the unit of the file.
fn first_and_step(stamps: &Stamps) -> (f64, f64) {
    let first = stamps.values.first().copied().unwrap_or(0.0);
    (stamps.origin + first, usual_step(&stamps.values))
}

fn unit_of(
    file: &str,
    heading: &Heading,
    map: &ChannelMap,
    (first, step): (f64, f64),
    notes: &mut Vec<Note>,
) -> Result<Unit, RecordError> {
    let name = heading.name.as_str();
    let given = map.time().and_then(|entry| entry.unit.as_deref());
    if let Some(symbol) = given.or((!heading.unit.is_empty()).then_some(&heading.unit)) {
        let unit = Unit::parse(symbol);
        if unit.kind() != crate::UnitKind::Time {
            let fault = SelectionFault::TimeUnit {
                name: shortened(name),
                unit: shortened(symbol),
            };
            return Err(refused(file, fault));
        }
        // What a map says is the user's word.
        if given.is_none() && is_beyond(&unit, first) {
            let because = format!("is in [{}], but begins at {first:e}", shortened(symbol));
            return Err(open(file, name, because, first, step));
        }
        return Ok(unit);
    }
    if let Some(symbol) = unit_in_name(name) {
        let unit = Unit::parse(symbol);
        let parts = matches!(symbol, "ms" | "us" | "ns");
        if is_beyond(&unit, first) {
            let because = format!("is named for {symbol}, but begins at {first:e}");
            return Err(open(file, name, because, first, step));
        }
        let doubted = if symbol == "ms" {
            DOUBTED_MS_S
        } else {
            DOUBTED_S
        };
        if parts && step > 0.0 && unit.to_si(step) < doubted {
            let because = format!("is named for {symbol}, but its step is {}", digits(step));
            return Err(open(file, name, because, first, step));
        }
        notes.push(Note::UnitFromName {
            column: heading.name.clone(),
            unit: symbol,
        });
        return Ok(unit);
    }
    let symbol = match without_a_word(first, step) {
        Ok(None) => {
            notes.push(Note::SecondsAssumed {
                column: heading.name.clone(),
            });
            return Ok(Unit::parse("s"));
        }
        Ok(Some(symbol)) => symbol,
        Err(because) => return Err(open(file, name, because, first, step)),
    };
    notes.push(Note::UnitFromStamps {
        column: heading.name.clone(),
        unit: symbol,
        first,
    });
    Ok(Unit::parse(symbol))
}

/// Whether a stamp is later than any date of this century, by any count.
fn is_beyond(unit: &Unit, first: f64) -> bool {
    let last_day = DAYS.iter().fold(0.0, |last: f64, &(_, to)| last.max(to));
    let in_days = unit.si_factor() == 86_400.0;
    if in_days {
        first > last_day
    } else {
        unit.to_si(first) > TO_2100_FROM_1904
    }
}

/// The unit that stamps of no unit can only have; `None` where nothing speaks against seconds, and
/// as the error what does.
fn without_a_word(first: f64, step: f64) -> Result<Option<&'static str>, String> {
    if let Some(symbol) = since_an_epoch(first, step) {
        return Ok(Some(symbol));
    }
    let of_calendar = DAYS.iter().any(|&(from, to)| (from..to).contains(&first));
    if of_calendar && step > 0.0 && step < 1e-3 {
        match (is_round(step), is_round(step * 86_400.0)) {
            (false, true) => return Ok(Some("d")),
            // No record of a machine has so many samples a second.
            _ if step < SHORTEST_S => return Ok(Some("d")),
            (true, false) => {}
            _ => {
                return Err(format!(
                    "has no unit; it begins at {first}, which may be days of a calendar or seconds"
                ));
            }
        }
    }
    if step >= ANY_UNIT || first.abs() >= 1e9 {
        return Err(format!(
            "has no unit, and its first stamp {first} and step {} settle none",
            digits(step)
        ));
    }
    Ok(None)
}

/// The unit in which the first stamp is a date of this century.
fn since_an_epoch(first: f64, step: f64) -> Option<&'static str> {
    let units = [
        ("s", 1.0, TO_2100_FROM_1904),
        ("ms", 1e-3, TO_2100),
        ("us", 1e-6, TO_2100),
        ("ns", 1e-9, TO_2100),
    ];
    units.iter().find_map(|&(symbol, factor, to)| {
        let dated = (FROM_2000..to).contains(&(first * factor));
        let stepped = (SHORTEST_S..=LONGEST_S).contains(&(step * factor));
        (dated && stepped).then_some(symbol)
    })
}

/// Whether a step, or the rate it makes, has few digits: eighths of a power of ten.
fn is_round(step: f64) -> bool {
    let eighths = |x: f64| {
        let part = 8.0 * x / 10_f64.powf(x.log10().floor());
        (part - part.round()).abs() < 1e-3 * part
    };
    step > 0.0 && (eighths(step) || eighths(1.0 / step))
}

fn refused(file: &str, fault: SelectionFault) -> RecordError {
    RecordError::Selection {
        file: file.to_owned(),
        fault,
    }
}

/// The refusal that spells the choice out: the flags, and the sample rate that each makes.
fn open(file: &str, name: &str, because: String, first: f64, step: f64) -> RecordError {
    let name = shortened(name);
    let units = ["s", "ms", "us", "ns", "d"];
    let fits = |symbol: &&str| {
        let unit = Unit::parse(symbol);
        let dated = unit.to_si(first) <= TO_2100_FROM_1904 || *symbol == "d";
        let days = *symbol != "d" || DAYS.iter().any(|&(from, to)| (from..to).contains(&first));
        dated && days && (SHORTEST_S..=LONGEST_S).contains(&unit.to_si(step))
    };
    let flag = |symbol: &str| {
        let rate = digits(1.0 / Unit::parse(symbol).to_si(step));
        format!("--map \"t={name} [{symbol}]\" ({rate} Hz)")
    };
    let choices: Vec<String> = units.into_iter().filter(fits).map(flag).collect();
    let choices = if choices.is_empty() {
        format!("--map \"t={name} [UNIT]\"")
    } else {
        choices.join(" or ")
    };
    refused(
        file,
        SelectionFault::TimeChoice {
            name,
            because,
            choices,
        },
    )
}
