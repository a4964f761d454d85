//! Dates and times of day as time stamps.

/// Nanoseconds of a second, and seconds of a day.
const NANOS: i64 = 1_000_000_000;
const DAY_S: i64 = 86_400;

/// How the numbers of a date are ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    YearMonthDay,
    DayMonthYear,
    /// `3/4/2024` or `3-4-2024`: the record as a whole may tell.
    Open,
}

/// A stamp taken apart: a date, a time of day, or both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RawStamp {
    /// The three numbers of the date, in the order written.
    pub(crate) date: Option<(Order, [u32; 3])>,
    /// Nanoseconds since midnight.
    pub(crate) clock: Option<i64>,
    /// Seconds ahead of UTC, as written.
    zone_s: i64,
}

/// Reads a date, a time of day, or a date and a time of day; ISO 8601 and its national variants.
pub(crate) fn parse_stamp(text: &str) -> Option<RawStamp> {
    let text = text.trim();
    // A duration as pandas writes it.
    let text = text.strip_prefix("0 days ").unwrap_or(text);
    if !text.starts_with(|c: char| c.is_ascii_digit()) || text.len() > 48 {
        return None;
    }
    let (first, rest) = match text.split_once([' ', 'T']) {
        Some((first, rest)) => (first, Some(rest.trim())),
        None => (text, None),
    };
    if first.contains(':') {
        let (clock, zone_s) = clock(text)?;
        return Some(RawStamp {
            date: None,
            clock: Some(clock),
            zone_s,
        });
    }
    let date = Some(date(first)?);
    let (clock, zone_s) = match rest {
        Some(rest) => {
            let (clock, zone_s) = clock(rest)?;
            (Some(clock), zone_s)
        }
        None => (None, 0),
    };
    Some(RawStamp {
        date,
        clock,
        zone_s,
    })
}

fn date(text: &str) -> Option<(Order, [u32; 3])> {
    let separator = text.chars().find(|c| !c.is_ascii_digit())?;
    if !matches!(separator, '-' | '.' | '/') {
        return None;
    }
    let mut parts = text.trim_end_matches('.').split(separator);
    let parts = [
        parts.next()?,
        parts.next()?,
        parts.next()?,
        parts.next().unwrap_or(""),
    ];
    let [a, b, c, ""] = parts else { return None };
    let digits = |part: &str, most: usize| {
        let fits = (1..=most).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
        if fits { part.parse::<u32>().ok() } else { None }
    };
    if a.len() == 4 {
        return Some((
            Order::YearMonthDay,
            [digits(a, 4)?, digits(b, 2)?, digits(c, 2)?],
        ));
    }
    let year = match c.len() {
        2 => 2000 + digits(c, 2)?,
        4 => digits(c, 4)?,
        _ => return None,
    };
    if let Some(month) = month(b) {
        return Some((Order::DayMonthYear, [digits(a, 2)?, month, year]));
    }
    let order = if separator == '.' {
        Order::DayMonthYear
    } else {
        Order::Open
    };
    Some((order, [digits(a, 2)?, digits(b, 2)?, year]))
}

/// The number of a month of English or German name.
fn month(name: &str) -> Option<u32> {
    const NAMES: [&[&str]; 12] = [
        &["jan"],
        &["feb"],
        &["mar", "mrz"],
        &["apr"],
        &["may", "mai"],
        &["jun"],
        &["jul"],
        &["aug"],
        &["sep"],
        &["oct", "okt"],
        &["nov"],
        &["dec", "dez"],
    ];
    let name = name.to_ascii_lowercase();
    let at = NAMES
        .iter()
        .position(|names| names.contains(&name.as_str()))?;
    u32::try_from(at + 1).ok()
}

/// `hh:mm[:ss[.fff]]` with AM or PM or an offset from UTC; nanoseconds, seconds of offset.
fn clock(text: &str) -> Option<(i64, i64)> {
    let upper = text.trim().to_ascii_uppercase();
    let (text, half) = match (upper.strip_suffix("AM"), upper.strip_suffix("PM")) {
        (Some(rest), _) => (rest.trim(), Some(0)),
        (_, Some(rest)) => (rest.trim(), Some(12)),
        _ => (upper.as_str(), None),
    };
    let (text, zone_s) = zone(text)?;
    let mut parts = text.split(':');
    let whole = |part: &str, below: i64| {
        let plain = (1..=2).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
        let value: i64 = if plain {
            part.parse().ok()?
        } else {
            return None;
        };
        (value < below).then_some(value)
    };
    let hour = whole(parts.next()?, 24)?;
    let minute = whole(parts.next()?, 60)?;
    let (second, nanos) = match parts.next() {
        None => (0, 0),
        Some(part) => {
            let (second, fraction) = part.split_once(['.', ',']).unwrap_or((part, ""));
            // 60 is a leap second.
            (whole(second, 61)?, nanos(fraction)?)
        }
    };
    // Some loggers put a colon before the milliseconds.
    let nanos = match parts.next() {
        None => nanos,
        Some(millis) if millis.len() == 3 && nanos == 0 => self::nanos(millis)?,
        Some(_) => return None,
    };
    if parts.next().is_some() {
        return None;
    }
    let hour = match half {
        None => hour,
        Some(_) if !(1..=12).contains(&hour) => return None,
        Some(half) => hour % 12 + half,
    };
    Some((((hour * 60 + minute) * 60 + second) * NANOS + nanos, zone_s))
}

/// Nanoseconds of a decimal fraction; digits beyond are dropped.
fn nanos(fraction: &str) -> Option<i64> {
    if !fraction.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let nine: String = fraction
        .chars()
        .chain("000000000".chars())
        .take(9)
        .collect();
    nine.parse().ok()
}

/// Splits `Z`, `+hh:mm`, `+hhmm` or `+hh` off a time of day.
fn zone(text: &str) -> Option<(&str, i64)> {
    if let Some(rest) = text.strip_suffix('Z') {
        return Some((rest.trim(), 0));
    }
    let Some(at) = text.find(['+', '-']) else {
        return Some((text, 0));
    };
    let sign = if text[at..].starts_with('-') { -1 } else { 1 };
    let digits: String = text[at + 1..].chars().filter(|&c| c != ':').collect();
    if !matches!(digits.len(), 2 | 4) || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let hours: i64 = digits[..2].parse().ok()?;
    let minutes: i64 = digits[2..].parse().unwrap_or(0);
    if hours > 18 || minutes > 59 {
        return None;
    }
    Some((text[..at].trim(), sign * (hours * 3600 + minutes * 60)))
}

/// Days since 1970-01-01 of the Gregorian calendar; `None` for a date there is not.
fn days(year: u32, month: u32, day: u32) -> Option<i64> {
    let leap = (year.is_multiple_of(4) && !year.is_multiple_of(100)) || year.is_multiple_of(400);
    let last = match month {
        1 | 3 | 5 | 7 | 8 | 10 | 12 => 31,
        4 | 6 | 9 | 11 => 30,
        2 if leap => 29,
        2 => 28,
        _ => return None,
    };
    if !(1..=last).contains(&day) || !(1..=9999).contains(&year) {
        return None;
    }
    let (year, month, day) = (i64::from(year), i64::from(month), i64::from(day));
    // Years from March on, so that the leap day is the last one.
    let y = if month <= 2 { year - 1 } else { year };
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let since_0 = 365 * y + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + day_of_year;
    Some(since_0 - 719_468)
}

/// What stamps of a whole column come to.
#[derive(Debug, PartialEq)]
pub(crate) struct Times {
    /// Seconds since the first stamp.
    pub(crate) seconds: Vec<f64>,
    /// How the stamps were read.
    pub(crate) form: &'static str,
    /// The order of day and month, where the record does not settle it and it matters.
    pub(crate) taken: Option<&'static str>,
}

const MONTH_FIRST: &str = "month/day/year";
const DAY_FIRST: &str = "day/month/year";

/// Stamps to seconds; the row of a date that does not exist is the error.
pub(crate) fn to_seconds(stamps: &[RawStamp]) -> Result<Times, usize> {
    if stamps.iter().all(|stamp| stamp.date.is_none()) {
        return Ok(Times {
            seconds: seconds_of(&clocks(stamps)),
            form: "times of day",
            taken: None,
        });
    }
    let open = |stamp: &RawStamp| matches!(stamp.date, Some((Order::Open, _)));
    if !stamps.iter().any(open) {
        let dots = matches!(stamps[0].date, Some((Order::DayMonthYear, _)));
        return Ok(Times {
            seconds: seconds_of(&instants(stamps, false)?),
            form: if dots {
                "day.month.year and time of day"
            } else {
                "year-month-day and time of day"
            },
            taken: None,
        });
    }
    let rising = |nanos: &[i128]| nanos.windows(2).all(|pair| pair[0] < pair[1]);
    let (month_first, day_first) = (instants(stamps, false), instants(stamps, true));
    let (nanos, form, taken) = match (month_first, day_first) {
        (Err(row), Err(_)) => return Err(row),
        (Ok(nanos), Err(_)) => (nanos, MONTH_FIRST, None),
        (Err(_), Ok(nanos)) => (nanos, DAY_FIRST, None),
        (Ok(month), Ok(day)) => match (rising(&month), rising(&day)) {
            (false, true) => (day, DAY_FIRST, None),
            (true, false) => (month, MONTH_FIRST, None),
            _ => {
                let same = seconds_of(&month) == seconds_of(&day);
                (month, MONTH_FIRST, (!same).then_some(MONTH_FIRST))
            }
        },
    };
    Ok(Times {
        seconds: seconds_of(&nanos),
        form: if form == MONTH_FIRST {
            "month/day/year and time of day"
        } else {
            "day/month/year and time of day"
        },
        taken,
    })
}

/// Times of day, a day later after each midnight.
fn clocks(stamps: &[RawStamp]) -> Vec<i128> {
    let day = DAY_S * NANOS;
    let (mut days, mut previous) = (0, 0);
    let mut nanos = Vec::with_capacity(stamps.len());
    for stamp in stamps {
        let clock = stamp.clock.unwrap_or(0);
        if clock < previous - day / 2 {
            days += 1;
        }
        previous = clock;
        nanos.push(i128::from(days) * i128::from(day) + i128::from(clock));
    }
    nanos
}

/// Nanoseconds since 1970 of dates and times of day.
fn instants(stamps: &[RawStamp], day_first: bool) -> Result<Vec<i128>, usize> {
    let one = |stamp: &RawStamp| {
        let (order, [a, b, c]) = stamp.date?;
        let day = match (order, day_first) {
            (Order::YearMonthDay, _) => days(a, b, c),
            (Order::DayMonthYear, _) | (Order::Open, true) => days(c, b, a),
            (Order::Open, false) => days(c, a, b),
        }?;
        let seconds = i128::from(day * DAY_S - stamp.zone_s);
        Some(seconds * i128::from(NANOS) + i128::from(stamp.clock.unwrap_or(0)))
    };
    let rows = stamps.iter().enumerate();
    rows.map(|(row, stamp)| one(stamp).ok_or(row)).collect()
}

/// Since the first one, so that no digits are lost to the years.
fn seconds_of(nanos: &[i128]) -> Vec<f64> {
    let first = nanos.first().copied().unwrap_or(0);
    nanos
        .iter()
        .map(|&n| (n - first) as f64 / NANOS as f64)
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn seconds(stamps: &[&str]) -> Times {
        let raw: Vec<RawStamp> = stamps.iter().map(|s| parse_stamp(s).unwrap()).collect();
        to_seconds(&raw).unwrap()
    }

    #[test]
    fn verify_days_of_known_dates() {
        assert_eq!(days(1970, 1, 1), Some(0));
        assert_eq!(days(2000, 3, 1), Some(11_017));
        assert_eq!(days(2024, 2, 29), Some(19_782));
        assert_eq!(days(2023, 2, 29), None);
        assert_eq!(days(1900, 2, 29), None);
        assert_eq!(days(2024, 13, 1), None);
    }

    #[test]
    fn verify_forms_of_stamps_agree() {
        let forms = [
            ["2024-02-29T23:59:59.5Z", "2024-03-01T00:00:00,750Z"],
            ["2024-02-29 23:59:59.5+01:00", "2024-02-29T23:00:00.75Z"],
            ["29.02.2024 23:59:59,500", "01.03.2024 00:00:00,750"],
            ["29.2.24 23:59:59.5", "1.3.24 0:00:00.75"],
            ["2/29/2024 11:59:59.5 PM", "3/1/2024 12:00:00.750 AM"],
            ["29/02/2024 23:59:59.5", "01/03/2024 00:00:00.75"],
            ["23:59:59.5", "00:00:00.75"],
        ];
        for form in forms {
            let times = seconds(&form);
            assert_eq!(times.seconds, [0.0, 1.25], "{form:?}");
            assert_eq!(times.taken, None, "{form:?}");
        }
    }

    #[test]
    fn verify_the_order_of_day_and_month_comes_from_the_record() {
        // Falls as month/day: 1 February after 1 December.
        let times = seconds(&["12/1/2024 10:00:00", "1/2/2024 10:00:00"]);
        assert_eq!(times.form, "day/month/year and time of day");
        assert_eq!(times.seconds[1], 20.0 * 86_400.0);
        // Both rise, and differ: told.
        let times = seconds(&["1/2/2024 10:00:00", "1/3/2024 10:00:00"]);
        assert_eq!(times.taken, Some(MONTH_FIRST));
        assert_eq!(times.seconds[1], 86_400.0);
        // One day only: it does not matter.
        let times = seconds(&["1/2/2024 10:00:00", "1/2/2024 10:00:01"]);
        assert_eq!((times.taken, times.seconds[1]), (None, 1.0));
    }

    #[test]
    fn verify_what_is_no_stamp() {
        for text in [
            "",
            "1.5",
            "12",
            "1.2.3.4",
            "2024-13",
            "24:00:00",
            "10:60",
            "x",
            "1-2",
            "10:00:00:00",
            "2024-01-01 noon",
            "1/2/3",
            "13:00 PM",
            "10:00+99:00",
            "é:1",
        ] {
            assert_eq!(parse_stamp(text), None, "{text}");
        }
        let raw = [parse_stamp("2024-02-30").unwrap()];
        assert_eq!(to_seconds(&raw), Err(0));
    }
}
