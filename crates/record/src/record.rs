//! A checked table of channels over one even time base.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use crate::channel::{Channel, Conversion};
use crate::error::{Place, RecordError};
use crate::faults::{MendFault, SelectionFault};
use crate::limits::{MAX_ROWS, MIN_ROWS};
use crate::mended::Mended;
use crate::overload::is_mark;
use crate::time_base::{TimeFault, check_even};
use crate::words::{name_list, shortened};
use crate::{Quantity, Unit, UnitKind};

/// A measured or generated record: channels of equal length over an evenly spaced time base.
///
/// Holds at least [`MIN_ROWS`] rows, finite values only, rising time stamps each within
/// [`crate::UNEVEN_FRACTION`] of a step of a uniform grid, and channels of different names.
///
/// ```
/// use simgap_record::{Channel, Record};
///
/// let force = Channel::new("u", "kN", vec![0.0; 100]);
/// let record = Record::from_uniform("generated", 0.0, 0.001, vec![force])?;
/// assert_eq!(record.len(), 100);
/// assert_eq!(record.time_step_s(), 0.001);
/// assert_eq!(
///     record.require("y").unwrap_err().to_string(),
///     "generated: column 'y' is needed, but the file has 'u'",
/// );
/// # Ok::<(), simgap_record::RecordError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    name: String,
    time_s: Vec<f64>,
    time_step_s: f64,
    time_conversion: Option<Conversion>,
    channels: Vec<Channel>,
    mended: Mended,
}

/// How the rows of a record are named in messages.
pub(crate) struct Origin<'a> {
    /// File or record.
    pub(crate) file: &'a str,
    /// Name of the time column.
    pub(crate) time_name: &'a str,
    /// Where the header stands.
    pub(crate) header: Place,
    /// Where a row stands.
    pub(crate) row: &'a dyn Fn(usize) -> Place,
}

impl Record {
    /// A record from stamps in seconds and channels.
    ///
    /// # Errors
    ///
    /// Whatever the reader of files refuses too: [`RecordError::TooFewRows`],
    /// [`RecordError::TooManyRows`], [`RecordError::LengthMismatch`],
    /// [`RecordError::DuplicateColumn`], [`RecordError::NotFinite`], [`RecordError::TimeOrder`],
    /// [`RecordError::UnevenTime`].
    pub fn new(
        name: impl Into<String>,
        time_s: Vec<f64>,
        channels: Vec<Channel>,
    ) -> Result<Record, RecordError> {
        let name = name.into();
        let origin = Origin {
            file: &name,
            time_name: "t",
            header: Place::Names,
            row: &Place::Row,
        };
        let time_step_s = checked_step(&origin, &time_s, &channels)?;
        Ok(Record {
            name,
            time_s,
            time_step_s,
            time_conversion: None,
            channels,
            mended: Mended::default(),
        })
    }

    /// A record over stamps `start_s + k time_step_s`, as many as the channels are long.
    ///
    /// [`Record::time_step_s`] is the given step to the last digit.
    ///
    /// # Errors
    ///
    /// [`RecordError::TimeStep`] for a start or step that is not finite or a step that is not
    /// positive, and the errors of [`Record::new`]. Without channels there are no rows.
    pub fn from_uniform(
        name: impl Into<String>,
        start_s: f64,
        time_step_s: f64,
        channels: Vec<Channel>,
    ) -> Result<Record, RecordError> {
        let name = name.into();
        if !(start_s.is_finite() && time_step_s.is_finite() && time_step_s > 0.0) {
            return Err(RecordError::TimeStep {
                file: name,
                start_s,
                time_step_s,
            });
        }
        let len = channels.first().map_or(0, |channel| channel.values.len());
        let time_s = (0..len).map(|k| start_s + k as f64 * time_step_s).collect();
        let record = Record::new(name, time_s, channels)?;
        Ok(Record {
            time_step_s,
            ..record
        })
    }

    /// A record from stamps in a unit of time, such as `ms`, and channels. The conversion to seconds is
    /// among [`Record::conversions_to`].
    ///
    /// # Errors
    ///
    /// [`RecordError::Selection`] for a unit of something else, and the errors of [`Record::new`].
    pub fn with_time_unit(
        name: impl Into<String>,
        (time_name, time_unit): (&str, &str),
        time: Vec<f64>,
        channels: Vec<Channel>,
    ) -> Result<Record, RecordError> {
        let name = name.into();
        let unit = Unit::parse(time_unit);
        if unit.kind() != UnitKind::Time {
            return Err(RecordError::Selection {
                file: name,
                fault: SelectionFault::TimeUnit {
                    name: shortened(time_name),
                    unit: shortened(time_unit),
                },
            });
        }
        let origin = Origin {
            file: &name,
            time_name,
            header: Place::Names,
            row: &Place::Row,
        };
        Record::from_file(name.clone(), &origin, &unit, time, channels)
    }

    /// A record from a file, with line numbers in its messages. Stamps in `time_unit`.
    pub(crate) fn from_file(
        name: String,
        origin: &Origin<'_>,
        time_unit: &Unit,
        mut time: Vec<f64>,
        channels: Vec<Channel>,
    ) -> Result<Record, RecordError> {
        let time_conversion = Conversion::of(origin.time_name, time_unit);
        if time_conversion.is_some() {
            time.iter_mut().for_each(|t| *t = time_unit.to_si(*t));
        }
        let time_step_s = checked_step(origin, &time, &channels)?;
        Ok(Record {
            name,
            time_s: time,
            time_step_s,
            time_conversion,
            channels,
            mended: Mended::default(),
        })
    }

    pub(crate) fn with_mended(self, mended: Mended) -> Record {
        Record { mended, ..self }
    }

    /// Which samples of the channel of that name were missing and filled; `None` where none was.
    #[must_use]
    pub fn filled(&self, name: &str) -> Option<&[bool]> {
        let channel = self.channels.iter().position(|c| c.name == name)?;
        self.mended.filled(channel)
    }

    /// Whether the samples stand at other times than they were taken at: an uneven time base was
    /// resampled. Single samples then say nothing of the chain that measured them.
    #[must_use]
    pub fn is_resampled(&self) -> bool {
        self.mended.is_resampled()
    }

    /// Name of the record: the file name, such as `C.csv`, of a record read from a file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Time stamps in seconds, as stamped.
    #[must_use]
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// Step of the uniform grid closest to the stamps (least squares), s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }

    /// Samples per second: the inverse of [`Record::time_step_s`].
    #[must_use]
    pub fn sample_rate_hz(&self) -> f64 {
        1.0 / self.time_step_s
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Always false: a record has at least [`MIN_ROWS`] rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// The channels in the order of the file, without the time column.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The channel of that name, if there is one.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The channel of that name.
    ///
    /// # Errors
    ///
    /// [`RecordError::MissingColumn`], which lists what the record has.
    pub fn require(&self, name: &str) -> Result<&Channel, RecordError> {
        self.channel(name)
            .ok_or_else(|| RecordError::MissingColumn {
                file: self.name.clone(),
                wanted: name.to_owned(),
                has: name_list(self.channels.iter().map(|channel| channel.name.as_str())),
            })
    }

    /// SI values of the channel of that name; as [`Channel::si_values`], with the record named
    /// in the error.
    ///
    /// # Errors
    ///
    /// [`RecordError::MissingColumn`], or [`RecordError::UnitMismatch`] in a
    /// [`RecordError::InRecord`].
    pub fn si_values(&self, name: &str, wanted: Quantity) -> Result<Cow<'_, [f64]>, RecordError> {
        self.require(name)?
            .si_values(wanted)
            .map_err(|source| RecordError::InRecord {
                file: self.name.clone(),
                source: Box::new(source),
            })
    }

    /// The conversions that taking these columns as these quantities applies, the time column's
    /// first.
    #[must_use]
    pub fn conversions_to(&self, wanted: &[(&str, Quantity)]) -> Vec<Conversion> {
        let of_channels = wanted
            .iter()
            .filter_map(|&(name, quantity)| self.channel(name)?.conversion(quantity));
        self.time_conversion
            .iter()
            .cloned()
            .chain(of_channels)
            .collect()
    }

    /// The same record with those channels alone whose name is asked for.
    #[must_use]
    pub fn with_channels(&self, is_kept: impl Fn(&str) -> bool) -> Record {
        let all = self.channels.iter().enumerate();
        let kept: Vec<usize> = all
            .filter(|(_, channel)| is_kept(&channel.name))
            .map(|(index, _)| index)
            .collect();
        Record {
            name: self.name.clone(),
            time_s: self.time_s.clone(),
            time_step_s: self.time_step_s,
            time_conversion: self.time_conversion.clone(),
            channels: kept.iter().map(|&k| self.channels[k].clone()).collect(),
            mended: self.mended.of_channels(&kept),
        }
    }

    /// The rows of a range as a record of the same name and time step.
    ///
    /// # Errors
    ///
    /// [`RecordError::RowRange`] when the range leaves the record, [`RecordError::TooFewRows`]
    /// when less than [`MIN_ROWS`] rows are left.
    pub fn slice(&self, range: Range<usize>) -> Result<Record, RecordError> {
        let Range { start, end } = range;
        if start > end || end > self.len() {
            let (file, len) = (self.name.clone(), self.len());
            return Err(RecordError::RowRange {
                file,
                start,
                end,
                len,
            });
        }
        if end - start < MIN_ROWS {
            let (file, found) = (self.name.clone(), end - start);
            return Err(RecordError::TooFewRows { file, found });
        }
        let channels = self.channels.iter().map(|channel| Channel {
            name: channel.name.clone(),
            unit: channel.unit.clone(),
            values: channel.values[start..end].to_vec(),
        });
        Ok(Record {
            name: self.name.clone(),
            time_s: self.time_s[start..end].to_vec(),
            // The whole record knows its step better than a part of it.
            time_step_s: self.time_step_s,
            time_conversion: self.time_conversion.clone(),
            channels: channels.collect(),
            mended: self.mended.slice(start..end),
        })
    }
}

/// All checks of a record; gives the step of its time base.
fn checked_step(
    origin: &Origin<'_>,
    time_s: &[f64],
    channels: &[Channel],
) -> Result<f64, RecordError> {
    let file = || origin.file.to_owned();
    if time_s.len() < MIN_ROWS {
        return Err(RecordError::TooFewRows {
            file: file(),
            found: time_s.len(),
        });
    }
    if time_s.len() > MAX_ROWS {
        return Err(RecordError::TooManyRows { file: file() });
    }
    check_names(origin, channels)?;
    for channel in channels {
        if channel.values.len() != time_s.len() {
            return Err(RecordError::LengthMismatch {
                file: file(),
                column: channel.name.clone(),
                found: channel.values.len(),
                needed: time_s.len(),
            });
        }
        check_finite(origin, &channel.name, &channel.values)?;
        check_marks(origin, channel)?;
    }
    check_finite(origin, origin.time_name, time_s)?;
    check_even(time_s).map_err(|fault| match fault {
        TimeFault::Order { row } => RecordError::TimeOrder {
            file: file(),
            at: (origin.row)(row),
            previous: time_s[row - 1],
            found: time_s[row],
        },
        TimeFault::Uneven { row, found, usual } => RecordError::UnevenTime {
            file: file(),
            at: (origin.row)(row),
            found,
            usual,
        },
    })
}

fn check_names(origin: &Origin<'_>, channels: &[Channel]) -> Result<(), RecordError> {
    let mut seen = HashMap::new();
    for (index, channel) in channels.iter().enumerate() {
        if let Some(first) = seen.insert(channel.name.as_str(), index) {
            return Err(RecordError::DuplicateColumn {
                file: origin.file.to_owned(),
                at: origin.header,
                name: channel.name.clone(),
                first: first + 1,
                second: index + 1,
            });
        }
    }
    Ok(())
}

fn check_marks(origin: &Origin<'_>, channel: &Channel) -> Result<(), RecordError> {
    match channel.values.iter().position(|value| is_mark(*value)) {
        None => Ok(()),
        Some(row) => Err(RecordError::Mending {
            file: origin.file.to_owned(),
            fault: MendFault::Overload {
                at: (origin.row)(row),
                column: channel.name.clone(),
                found: channel.values[row],
            },
        }),
    }
}

fn check_finite(origin: &Origin<'_>, column: &str, values: &[f64]) -> Result<(), RecordError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(row) => Err(RecordError::NotFinite {
            file: origin.file.to_owned(),
            at: (origin.row)(row),
            column: column.to_owned(),
            found: values[row].to_string(),
        }),
    }
}
