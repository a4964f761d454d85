//! What columns of time are called, and which unit a name says.

/// What time columns are called, in small letters.
const WORDS: [&str; 26] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "time stamp",
    "datetime",
    "date time",
    "date/time",
    "zeit",
    "zeitstempel",
    "temps",
    "tiempo",
    "tempo",
    "elapsed",
    "elapsed time",
    "relative time",
    "time elapsed",
    "x_value",
    "tout",
    "stamp",
    "datenum",
    "uptime",
    "rosbagtimestamp",
    "messzeit",
    "x-axis",
    "x_time",
];

/// Units as names say them.
const UNITS: [(&str, &[&str]); 7] = [
    (
        "s",
        &["s", "sec", "secs", "second", "seconds", "sek", "sekunden"],
    ),
    (
        "ms",
        &[
            "ms",
            "msec",
            "msecs",
            "millis",
            "millisec",
            "millisecond",
            "milliseconds",
            "millisekunden",
        ],
    ),
    (
        "us",
        &[
            "us",
            "µs",
            "usec",
            "usecs",
            "micros",
            "microsec",
            "microsecond",
            "microseconds",
        ],
    ),
    (
        "ns",
        &[
            "ns",
            "nsec",
            "nsecs",
            "nanos",
            "nanosec",
            "nanosecond",
            "nanoseconds",
        ],
    ),
    ("min", &["min", "mins", "minute", "minutes", "minuten"]),
    ("h", &["hour", "hours", "stunden"]),
    ("d", &["day", "days", "tage", "datenum"]),
];

/// Whether a column of this name is one of time.
pub(crate) fn is_time_name(name: &str) -> bool {
    let name = plain(name);
    let is_word = |name: &str| WORDS.contains(&name.to_lowercase().as_str());
    is_word(name) || split(name).is_some_and(|(stem, _)| is_word(stem))
}

/// Whether a name is a unit of time and nothing else: `millis`.
pub(crate) fn is_unit_name(name: &str) -> bool {
    let name = plain(name).to_lowercase();
    // One letter is the name of anything.
    name.chars().count() > 1 && unit_word(&name).is_some()
}

/// The unit that a name of a time column says: `time_ms`, `timeMs`, `t (ms)`, `millis`.
pub(crate) fn unit_in_name(name: &str) -> Option<&'static str> {
    let name = plain(name);
    if is_unit_name(name) {
        return unit_word(&name.to_lowercase());
    }
    split(name).map(|(_, unit)| unit)
}

/// Without the signs of a comment.
fn plain(name: &str) -> &str {
    name.trim_start_matches(['%', '#']).trim()
}

fn unit_word(word: &str) -> Option<&'static str> {
    let known = UNITS.iter().find(|(_, words)| words.contains(&word));
    known.map(|(unit, _)| *unit)
}

/// The name without its unit, and the unit.
fn split(name: &str) -> Option<(&str, &'static str)> {
    let marks = ['_', ' ', '-', '.', '/', '(', '[', ','];
    let end = name.trim_end_matches([')', ']', ' ']);
    if let Some(at) = end.rfind(marks) {
        let unit = unit_word(&end[at + 1..].to_lowercase());
        let stem = end[..at].trim_end_matches(marks);
        let stem = stem
            .strip_suffix("_in")
            .or_else(|| stem.strip_suffix(" in"))
            .unwrap_or(stem);
        return unit.map(|unit| (stem, unit));
    }
    // `timeMs`, `TimeUS`: the unit begins with the only capital after small letters.
    let at = end
        .rfind(|c: char| c.is_ascii_lowercase())
        .filter(|&at| at + 1 < end.len());
    let inner = end.char_indices().rev().find(|&(at, c)| {
        c.is_ascii_uppercase() && end[..at].ends_with(|c: char| c.is_ascii_lowercase())
    });
    let from = inner.map(|(at, _)| at).or(at.map(|at| at + 1))?;
    let unit = unit_word(&end.get(from..)?.to_lowercase())?;
    Some((&end[..from], unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_names_of_time_and_their_units() {
        let cases = [
            ("t", true, None),
            ("Time", true, None),
            ("t_ms", true, Some("ms")),
            ("time_ms", true, Some("ms")),
            ("Time_ms", true, Some("ms")),
            ("timeMs", true, Some("ms")),
            ("TimeUS", true, Some("us")),
            ("timestamp_ns", true, Some("ns")),
            ("%time", true, None),
            ("Time(ms)", true, Some("ms")),
            ("time in ms", true, Some("ms")),
            ("elapsed_seconds", true, Some("s")),
            ("datenum", true, Some("d")),
            ("Status", false, None),
            ("press", false, None),
            ("rise_time", false, None),
            ("gain_ms", false, Some("ms")),
            ("µ", false, None),
            ("é", false, None),
        ];
        for (name, is_time, unit) in cases {
            assert_eq!(is_time_name(name), is_time, "{name}");
            assert_eq!(unit_in_name(name), unit, "{name}");
        }
        assert!(is_unit_name("millis") && !is_unit_name("s"));
    }
}
