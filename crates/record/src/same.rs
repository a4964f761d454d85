//! Records that hold the same samples, and what is odd about several records together.

use std::fmt;

use crate::quality::{Defect, quality};
use crate::{Channel, Record};

/// Values that differ by less than this share are one, written in two units.
const SAME: f64 = 1e-12;

/// The row of `whole` at which the samples of `part` begin, where all of them stand there one after
/// the other in the channels of these names; stamps do not count. `None` also where a channel is
/// missing or none of them ever changes.
///
/// ```
/// use simgap_record::{Channel, Record, found_within};
///
/// let values = |from: i32| (from..from + 50).map(|k| f64::from(k * k % 37)).collect();
/// let whole = Record::from_uniform("A.csv", 0.0, 0.01, vec![Channel::new("y", "m", values(0))])?;
/// let part = whole.slice(20..40)?;
/// assert_eq!(found_within(&part, &whole, &["y"]), Some(20));
/// assert_eq!(found_within(&whole, &part, &["y"]), None);
/// # Ok::<(), simgap_record::RecordError>(())
/// ```
#[must_use]
pub fn found_within(part: &Record, whole: &Record, channels: &[&str]) -> Option<usize> {
    let pairs = channels
        .iter()
        .map(|name| Some((part.channel(name)?, whole.channel(name)?)));
    let pairs: Vec<(&Channel, &Channel)> = pairs.collect::<Option<_>>()?;
    let (pivot, at) = pairs
        .iter()
        .find_map(|pair| Some((*pair, farthest(&pair.0.values)?)))?;
    // Most rows are told apart by the one that is farthest from the mean.
    (0..(whole.len() + 1).checked_sub(part.len())?).find(|&first| {
        is_same(pivot, at, first)
            && pairs
                .iter()
                .all(|pair| (0..part.len()).all(|row| is_same(*pair, row, first)))
    })
}

/// Whether a sample of a channel stands in another one, so many rows later.
fn is_same((a, b): (&Channel, &Channel), row: usize, first: usize) -> bool {
    let (x, y) = (a.values[row], b.values[first + row]);
    if a.unit == b.unit {
        return x == y;
    }
    let (x, y) = (a.unit.to_si(x), b.unit.to_si(y));
    a.unit.kind() == b.unit.kind() && (x - y).abs() <= SAME * x.abs().max(y.abs())
}

/// The row farthest from the mean; `None` of values that are all the same.
fn farthest(values: &[f64]) -> Option<usize> {
    let first = *values.first()?;
    if values.iter().all(|value| *value == first) {
        return None;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let off = |row: &usize| (values[*row] - mean).abs();
    (0..values.len()).max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// What an audit looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum AuditTopic {
    /// The time base, against itself and against the motion there should be.
    Clock,
    /// Samples that were filled.
    Missing,
    /// Values at the end of a range.
    Clipping,
    /// Samples that are the same in two places.
    Identical,
    /// Channels that are late or early against others.
    Offset,
    /// Sizes against those of a model.
    Units,
    /// Directions against those of a model.
    Sign,
    /// Channels that nothing moves.
    Unmoved,
}

impl AuditTopic {
    /// Its name in files and on terminals.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            AuditTopic::Clock => "clock",
            AuditTopic::Missing => "missing",
            AuditTopic::Clipping => "clipping",
            AuditTopic::Identical => "identical",
            AuditTopic::Offset => "offset",
            AuditTopic::Units => "units",
            AuditTopic::Sign => "sign",
            AuditTopic::Unmoved => "unmoved",
        }
    }
}

/// Something to look at before the physics: most of what looks like a strange machine is a strange record.
#[derive(Debug, Clone, PartialEq)]
pub struct AuditFinding {
    /// Name of the record.
    pub record: String,
    /// What it is about.
    pub topic: AuditTopic,
    /// One sentence.
    pub text: String,
}

impl fmt::Display for AuditFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.record, self.text)
    }
}

/// Looks at records before a model is asked: clock, filled samples, clipping, what is the same in two
/// places.
#[must_use]
pub fn audit(records: &[&Record]) -> Vec<AuditFinding> {
    let mut found = Vec::new();
    for (i, record) in records.iter().enumerate() {
        let mut add = |topic, text| {
            found.push(AuditFinding {
                record: record.name().to_owned(),
                topic,
                text,
            });
        };
        for finding in quality(record) {
            let topic = match finding.defect {
                Defect::TimeJitter { .. } => AuditTopic::Clock,
                Defect::Clipped { .. } => AuditTopic::Clipping,
                _ => continue,
            };
            add(topic, finding.to_string());
        }
        if record.is_resampled() {
            let text = "its time base was uneven: kinds that live in single samples are not sought";
            add(AuditTopic::Clock, text.to_owned());
        }
        for channel in record.channels() {
            if let Some(filled) = record.filled(&channel.name) {
                let count = filled.iter().filter(|filled| **filled).count();
                let text = format!(
                    "{count} of {} samples of '{}' were missing and are filled",
                    record.len(),
                    channel.name
                );
                add(AuditTopic::Missing, text);
            }
        }
        for text in same_columns(record) {
            add(AuditTopic::Identical, text);
        }
        for earlier in &records[..i] {
            if let Some(text) = same_in(record, earlier) {
                add(AuditTopic::Identical, text);
            }
        }
    }
    found
}

/// Columns of a record that hold the same samples.
fn same_columns(record: &Record) -> Vec<String> {
    let channels = record.channels();
    let mut told = Vec::new();
    for (k, channel) in channels.iter().enumerate() {
        let same = |other: &&Channel| other.values == channel.values;
        let earlier = channels[..k].iter().find(same);
        if let (Some(earlier), Some(_)) = (earlier, farthest(&channel.values)) {
            told.push(format!(
                "columns '{}' and '{}' hold the same samples",
                earlier.name, channel.name
            ));
        }
    }
    told
}

/// The columns that two records have in common to the last sample.
fn same_in(record: &Record, earlier: &Record) -> Option<String> {
    let is_same = |channel: &&Channel| {
        let other = earlier.channel(&channel.name);
        farthest(&channel.values).is_some()
            && other.is_some_and(|other| other.values == channel.values)
    };
    let same: Vec<String> = record
        .channels()
        .iter()
        .filter(is_same)
        .map(|channel| format!("'{}'", channel.name))
        .collect();
    let column = if same.len() == 1 { "column" } else { "columns" };
    let holds = if same.len() == 1 { "holds" } else { "hold" };
    (!same.is_empty()).then(|| {
        let (names, earlier) = (same.join(", "), earlier.name());
        format!("{column} {names} {holds} the same samples as in {earlier}")
    })
}
