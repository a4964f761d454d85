//! Which column of a file is which channel of the model.

use crate::faults::MapFault;
use crate::words::{name_list, shortened};

/// Name of the time base in a map: `t=Zeit`.
const TIME: &str = "t";
/// Column names closer than this to the one asked for are offered instead.
const NEAR: f64 = 0.55;
/// As many are offered.
const MOST_NEAR: usize = 3;

/// One line of a [`ChannelMap`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapEntry {
    /// Name of the channel in the model, or `t` for the time base.
    pub channel: String,
    /// Name of the column in the file, without its unit.
    pub column: String,
    /// Unit of the column, where the file has none or a wrong one.
    pub unit: Option<String>,
}

/// Names and units of columns as a model knows them: `y=Pos_Mold [mm]`.
///
/// ```
/// use simgap_record::ChannelMap;
///
/// let map = ChannelMap::parse(["y=Pos_Mold [mm]", "u=Kraft", "t=Zeit [ms]"])?;
/// assert_eq!(map.column_of("y"), "Pos_Mold");
/// assert_eq!(map.column_of("v"), "v");
/// assert_eq!(map.entries()[0].unit.as_deref(), Some("mm"));
/// # Ok::<(), simgap_record::MapFault>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ChannelMap {
    entries: Vec<MapEntry>,
}

impl ChannelMap {
    /// Reads entries such as `y=Pos_Mold` or `y=Pos_Mold [mm]`; the channel stands before the
    /// first `=`, and `t` means the time base.
    ///
    /// # Errors
    ///
    /// [`MapFault::Entry`] for an entry of another form, [`MapFault::Twice`] when
    /// two entries are about one channel.
    pub fn parse<T: AsRef<str>>(
        entries: impl IntoIterator<Item = T>,
    ) -> Result<ChannelMap, MapFault> {
        let mut map = ChannelMap::default();
        for text in entries {
            let entry = entry(text.as_ref())?;
            if map.entry(&entry.channel).is_some() {
                let channel = entry.channel;
                return Err(MapFault::Twice { channel });
            }
            map.entries.push(entry);
        }
        Ok(map)
    }

    /// The entries, in the order given.
    #[must_use]
    pub fn entries(&self) -> &[MapEntry] {
        &self.entries
    }

    /// Refuses entries about channels that are not among these, and not `t`.
    ///
    /// # Errors
    ///
    /// [`MapFault::Channel`], which lists the channels, those of a like name first.
    pub fn check_channels(&self, channels: &[&str]) -> Result<(), MapFault> {
        let unknown = |entry: &&MapEntry| !channels.contains(&entry.channel.as_str());
        match self.channels().find(unknown) {
            None => Ok(()),
            Some(entry) => Err(MapFault::Channel {
                channel: entry.channel.clone(),
                has: name_list(channels.iter().copied()),
                near: near_names(&entry.channel, channels.iter().copied()),
            }),
        }
    }

    /// Whether nothing is mapped.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The column a channel of the model is read from: the mapped one, or the one of its name.
    #[must_use]
    pub fn column_of<'a>(&'a self, channel: &'a str) -> &'a str {
        self.entry(channel)
            .map_or(channel, |entry| entry.column.as_str())
    }

    /// The entry of a channel.
    pub(crate) fn entry(&self, channel: &str) -> Option<&MapEntry> {
        self.entries.iter().find(|entry| entry.channel == channel)
    }

    /// The entry of the time base.
    pub(crate) fn time(&self) -> Option<&MapEntry> {
        self.entry(TIME)
    }

    /// The entries of everything but the time base.
    pub(crate) fn channels(&self) -> impl Iterator<Item = &MapEntry> {
        self.entries.iter().filter(|entry| entry.channel != TIME)
    }
}

fn entry(text: &str) -> Result<MapEntry, MapFault> {
    let fault = || MapFault::Entry {
        found: shortened(text),
    };
    let (channel, rest) = text.split_once('=').ok_or_else(fault)?;
    let (channel, rest) = (channel.trim(), rest.trim());
    let bracketed = rest
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once('['));
    let (column, unit) = match bracketed {
        Some((column, unit)) => (column.trim(), Some(unit.trim())),
        None => (rest, None),
    };
    if channel.is_empty() || column.is_empty() || unit == Some("") {
        return Err(fault());
    }
    Ok(MapEntry {
        channel: channel.to_owned(),
        column: column.to_owned(),
        unit: unit.map(str::to_owned),
    })
}

/// The names most like the one asked for, best first, as the tail of a message.
pub(crate) fn near_names<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> String {
    let wanted = wanted.to_lowercase();
    let mut scored: Vec<(f64, &str)> = names
        .map(|name| (likeness(&wanted, &name.to_lowercase()), name))
        .filter(|(score, _)| *score >= NEAR)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    let near: Vec<String> = scored
        .iter()
        .take(MOST_NEAR)
        .map(|(_, name)| format!("'{}'", shortened(name)))
        .collect();
    if near.is_empty() {
        return String::new();
    }
    format!(" (near: {})", near.join(", "))
}

fn likeness(a: &str, b: &str) -> f64 {
    const INSIDE: f64 = 0.75;
    let part = a.len().min(b.len()) >= 3 && (a.contains(b) || b.contains(a));
    let score = strsim::normalized_damerau_levenshtein(a, b);
    if part { score.max(INSIDE) } else { score }
}
