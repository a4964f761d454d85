//! What is read of a file: options, and the columns they pick.

use crate::error::RecordError;
use crate::faults::{MapFault, SelectionFault};
use crate::heading::{Heading, heading};
use crate::map::{ChannelMap, near_names};
use crate::note::Note;
use crate::time_names::{is_time_name, is_unit_name};
use crate::words::{name_list, shortened};
use crate::{Record, Unit};

/// When faults of a record are made good instead of refused.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Mend {
    /// In files of loggers and other programs, not in a CSV of the contract's own form, whose
    /// maker can do better.
    #[default]
    Foreign,
    /// In every file.
    Always,
    /// In none.
    Never,
}

/// What [`crate::read_file`] reads, and how.
///
/// ```
/// use simgap_record::{ChannelMap, Mend, ReadOptions};
///
/// let options = ReadOptions::channels(["u"], ["y"])
///     .with_map(ChannelMap::parse(["y=Pos_Mold [mm]"])?)
///     .with_mend(Mend::Always);
/// # let _ = options;
/// # Ok::<(), simgap_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Channels to be read; all there are if `None`.
    pub(crate) wanted: Option<WantedNames>,
    pub(crate) map: ChannelMap,
    pub(crate) mend: Mend,
    /// Names and units of the columns of a table without a header.
    pub(crate) columns: Vec<Heading>,
}

/// Channels of the model to be read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct WantedNames {
    pub(crate) needed: Vec<String>,
    pub(crate) welcome: Vec<String>,
}

impl ReadOptions {
    /// Reads every column that holds numbers.
    #[must_use]
    pub fn all() -> ReadOptions {
        ReadOptions::default()
    }

    /// Reads channels that must be there and others that are read if they are there.
    #[must_use]
    pub fn channels<T: Into<String>, U: Into<String>>(
        needed: impl IntoIterator<Item = T>,
        welcome: impl IntoIterator<Item = U>,
    ) -> ReadOptions {
        let wanted = WantedNames {
            needed: needed.into_iter().map(Into::into).collect(),
            welcome: welcome.into_iter().map(Into::into).collect(),
        };
        ReadOptions {
            wanted: Some(wanted),
            ..ReadOptions::default()
        }
    }

    /// Names and units of columns.
    #[must_use]
    pub fn with_map(self, map: ChannelMap) -> ReadOptions {
        ReadOptions { map, ..self }
    }

    /// Names and units of the columns of tables of text that have no header, in their order:
    /// `t [s],u [N],y [mm]`. A header that is there is replaced.
    ///
    /// # Errors
    ///
    /// [`MapFault::Columns`] when a name is empty or stands twice.
    pub fn with_columns(self, columns: &str) -> Result<ReadOptions, MapFault> {
        let columns: Vec<Heading> = columns.split(',').map(heading).collect();
        let empty = columns.iter().any(|column| column.name.is_empty());
        let twice = (1..columns.len()).find(|&k| {
            columns[..k]
                .iter()
                .any(|column| column.name == columns[k].name)
        });
        if empty || twice.is_some() {
            return Err(MapFault::Columns {
                found: twice.map_or_else(
                    || "an empty name".to_owned(),
                    |k| format!("'{}' twice", shortened(&columns[k].name)),
                ),
            });
        }
        Ok(ReadOptions { columns, ..self })
    }

    /// When faults are made good.
    #[must_use]
    pub fn with_mend(self, mend: Mend) -> ReadOptions {
        ReadOptions { mend, ..self }
    }
}

/// A record and what was guessed or changed to get it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The record.
    pub record: Record,
    /// What its reader should be told, in the order of the work.
    pub notes: Vec<Note>,
}

impl Reading {
    /// Whether lines stand before the header of a table of text.
    pub(crate) fn has_later_header(&self) -> bool {
        let later = |note: &Note| matches!(note, Note::Dialect { header, .. } if *header > 1);
        self.notes.iter().any(later)
    }
}

/// A column that is read, and as what.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pick {
    /// Index of the column.
    pub(crate) column: usize,
    pub(crate) channel: String,
    pub(crate) unit: Unit,
}

/// The columns that are read beside the time base.
pub(crate) fn select(
    file: &str,
    headings: &[Heading],
    time: Option<usize>,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Result<Vec<Pick>, RecordError> {
    let picker = Picker {
        file,
        headings,
        time,
        options,
    };
    match &options.wanted {
        Some(wanted) => picker.named(wanted, notes),
        None => picker.all(notes),
    }
}

struct Picker<'a> {
    file: &'a str,
    headings: &'a [Heading],
    time: Option<usize>,
    options: &'a ReadOptions,
}

impl Picker<'_> {
    fn named(&self, wanted: &WantedNames, notes: &mut Vec<Note>) -> Result<Vec<Pick>, RecordError> {
        let mut picks: Vec<Pick> = Vec::new();
        let needed = wanted.needed.iter().map(|name| (name, true));
        let welcome = wanted.welcome.iter().map(|name| (name, false));
        for (channel, must) in needed.chain(welcome) {
            if picks.iter().any(|pick| pick.channel == *channel) {
                continue;
            }
            let must = must || self.options.map.entry(channel).is_some();
            match self.find(self.options.map.column_of(channel), must, notes)? {
                Some(column) => picks.push(self.pick(column, channel, notes)),
                None => continue,
            }
        }
        Ok(picks)
    }

    fn all(&self, notes: &mut Vec<Note>) -> Result<Vec<Pick>, RecordError> {
        for entry in self.options.map.channels() {
            self.find(&entry.column, true, notes)?;
        }
        let mut picks: Vec<Pick> = Vec::new();
        for (column, heading) in self.headings.iter().enumerate() {
            if Some(column) == self.time {
                continue;
            }
            let mapped = self.options.map.channels();
            let mut mapped = mapped
                .filter(|entry| entry.column == heading.name)
                .peekable();
            if mapped.peek().is_some() {
                for entry in mapped {
                    picks.push(self.pick(column, &entry.channel, notes));
                }
                continue;
            }
            let because = if self.options.map.entry(&heading.name).is_some() {
                "the map reads the channel of that name from another column"
            } else if picks.iter().any(|pick| pick.channel == heading.name) {
                "an earlier column has the same name"
            } else {
                picks.push(self.pick(column, &heading.name, notes));
                continue;
            };
            notes.push(Note::LeftOut {
                column: heading.name.clone(),
                because: because.to_owned(),
            });
        }
        Ok(picks)
    }

    /// The only column of that name.
    fn find(&self, name: &str, must: bool, notes: &[Note]) -> Result<Option<usize>, RecordError> {
        let mut found = (0..self.headings.len()).filter(|&k| self.headings[k].name == name);
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => Err(RecordError::Selection {
                file: self.file.to_owned(),
                fault: SelectionFault::Ambiguous {
                    name: name.to_owned(),
                    first: first + 1,
                    second: second + 1,
                },
            }),
            (Some(column), None) => Ok(Some(column)),
            (None, _) if must => Err(unknown(self.file, name, self.headings, notes)),
            (None, _) => Ok(None),
        }
    }

    fn pick(&self, column: usize, channel: &str, notes: &mut Vec<Note>) -> Pick {
        let heading = &self.headings[column];
        let entry = self.options.map.entry(channel);
        let given = entry.and_then(|entry| entry.unit.clone());
        if entry.is_some() {
            notes.push(Note::Mapped {
                channel: channel.to_owned(),
                column: heading.name.clone(),
                unit: heading.unit.clone(),
                given: given.clone(),
            });
        }
        Pick {
            column,
            channel: channel.to_owned(),
            unit: Unit::parse(given.as_deref().unwrap_or(&heading.unit)),
        }
    }
}

fn unknown(file: &str, wanted: &str, headings: &[Heading], notes: &[Note]) -> RecordError {
    let names = || headings.iter().map(|heading| heading.name.as_str());
    let near = left_out(wanted, notes).unwrap_or_else(|| near_names(wanted, names()));
    RecordError::Selection {
        file: file.to_owned(),
        fault: SelectionFault::Unknown {
            wanted: wanted.to_owned(),
            near,
            has: name_list(names()),
        },
    }
}

/// Why a column that the file has was not read.
fn left_out(wanted: &str, notes: &[Note]) -> Option<String> {
    let is_it = |column: &str| {
        let own = column.rsplit_once('.').map_or(column, |(_, own)| own);
        column == wanted || own == wanted
    };
    notes.iter().find_map(|note| match note {
        Note::LeftOut { column, because } if is_it(column) => {
            Some(format!("; '{}' is left out: {because}", shortened(column)))
        }
        _ => None,
    })
}

/// The column of time: the mapped one, one named like time, or a first one in a unit of time.
pub(crate) fn time_column(
    file: &str,
    headings: &[Heading],
    map: &ChannelMap,
) -> Result<Option<usize>, RecordError> {
    if let Some(entry) = map.time() {
        let found = headings
            .iter()
            .position(|heading| heading.name == entry.column);
        let column = found.ok_or_else(|| unknown(file, &entry.column, headings, &[]))?;
        return Ok(Some(column));
    }
    let named = |is: &dyn Fn(&str) -> bool| headings.iter().position(|h| is(&h.name));
    let plain = |name: &str| ["t", "time"].iter().any(|t| name.eq_ignore_ascii_case(t));
    let by_unit = || {
        let first = headings.first()?;
        (Unit::parse(&first.unit).kind() == crate::UnitKind::Time).then_some(0)
    };
    Ok(named(&plain)
        .or_else(by_unit)
        .or_else(|| named(&is_time_name))
        .or_else(|| named(&is_unit_name)))
}
