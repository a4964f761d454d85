//! NI TDMS (National Instruments, "TDMS File Format Internal Structure"), without DAQmx raw data.
//!
//! A file is a row of segments. Each begins with 28 bytes (tag, contents, version, length, length of
//! the description), then comes the description of its channels, then their values, in turn or
//! interleaved, repeated as often as they fit. What a description leaves out is as in the segment
//! before.

mod channel;

use std::collections::HashMap;

use self::channel::{Channel, Kind, Share, stamp_of};
use crate::bytes::Bytes;
use crate::faults::FormatFault;
use crate::note::Note;
use crate::raw::{Raw, RawColumn, within_limit};

/// Channels that are read from one file.
const MOST_CHANNELS: usize = 10_000;
/// Bits of the contents of a segment.
const HAS_DESCRIPTION: u32 = 1 << 1;
const NEW_LIST: u32 = 1 << 2;
const HAS_VALUES: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
const DAQMX: u32 = 1 << 7;
/// Length of a segment that was never finished.
const UNFINISHED: u64 = u64::MAX;
/// Type code of text.
const TEXT: u32 = 0x20;

/// Reads all channels of numbers and stamps.
pub(crate) fn read(bytes: &[u8], notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    let mut file = File::default();
    let mut rest = Bytes::new(bytes, 0, false);
    while rest.left() > 0 {
        file.segment(&mut rest)?;
    }
    Ok(file.raw(notes))
}

#[derive(Default)]
struct File {
    channels: Vec<Channel>,
    by_path: HashMap<String, usize>,
    /// What a round of values consists of.
    round: Vec<Share>,
    /// Numbers so far.
    values: u64,
}

impl File {
    fn segment(&mut self, rest: &mut Bytes<'_>) -> Result<(), FormatFault> {
        const WHAT: &str = "the head of a segment";
        let at = rest.place();
        let tag = rest.take(4, WHAT)?;
        if tag != b"TDSm" {
            return Err(FormatFault::Malformed {
                at,
                found: format!("{tag:02x?}"),
                needed: "a segment, which begins with TDSm (TDSh begins an index file; read the .tdms beside it)",
            });
        }
        // The contents are little-endian whatever they say of the rest.
        let contents = rest.u32(WHAT)?;
        let big_endian = contents & BIG_ENDIAN != 0;
        let mut head = rest.part(20, WHAT)?.ordered(big_endian);
        head.take(4, WHAT)?;
        let (length, described) = (head.u64(WHAT)?, head.u64(WHAT)?);
        let length = if length == UNFINISHED {
            rest.left() as u64
        } else {
            length
        };
        let mut body = rest.part(length, "a segment")?.ordered(big_endian);
        let mut description = body.part(described, "the description of a segment")?;
        if contents & NEW_LIST != 0 {
            self.round.clear();
        }
        if contents & HAS_DESCRIPTION != 0 {
            self.describe(&mut description)?;
        }
        if contents & HAS_VALUES == 0 {
            return Ok(());
        }
        if contents & DAQMX != 0 {
            return Err(FormatFault::Unsupported {
                found: "raw data of DAQmx".to_owned(),
                instead: "export the record as CSV, or as TDMS with scaled values",
            });
        }
        self.values(&mut body, contents & INTERLEAVED != 0)
    }

    fn describe(&mut self, bytes: &mut Bytes<'_>) -> Result<(), FormatFault> {
        const WHAT: &str = "the description of a channel";
        let count = bytes.u32(WHAT)?;
        for _ in 0..count {
            let path = text(bytes)?;
            let channel = self.channel(&path)?;
            let at = bytes.place();
            match bytes.u32(WHAT)? {
                u32::MAX => self.round.retain(|share| share.channel != channel),
                0 => {
                    if let Some(share) = self.channels[channel].last {
                        self.set(share);
                    }
                }
                0x1269 | 0x1369 | 0x6912_0000 | 0x6913_0000 => {
                    return Err(FormatFault::Unsupported {
                        found: "raw data of DAQmx".to_owned(),
                        instead: "export the record as CSV, or as TDMS with scaled values",
                    });
                }
                _ => {
                    let code = bytes.u32(WHAT)?;
                    bytes.u32(WHAT)?;
                    let count = bytes.u64(WHAT)?;
                    let (kind, size) = if code == TEXT {
                        (Kind::Other(0), bytes.u64(WHAT)?)
                    } else {
                        let kind = Kind::of(code).ok_or_else(|| FormatFault::Malformed {
                            at,
                            found: format!("values of type {code:#x}"),
                            needed: "a type of the format",
                        })?;
                        (kind, count.saturating_mul(kind.size()))
                    };
                    self.set(Share {
                        channel,
                        kind,
                        count,
                        bytes: size,
                    });
                }
            }
            self.properties(bytes, channel)?;
        }
        // What takes no bytes takes no part, so that every round moves on.
        self.round.retain(|share| share.bytes > 0);
        Ok(())
    }

    fn channel(&mut self, path: &str) -> Result<usize, FormatFault> {
        if let Some(&channel) = self.by_path.get(path) {
            return Ok(channel);
        }
        if self.channels.len() == MOST_CHANNELS {
            return Err(FormatFault::TooMuch {
                most: MOST_CHANNELS as u64,
                what: "channels",
            });
        }
        self.channels.push(Channel {
            path: path.to_owned(),
            ..Channel::default()
        });
        self.by_path
            .insert(path.to_owned(), self.channels.len() - 1);
        Ok(self.channels.len() - 1)
    }

    fn set(&mut self, share: Share) {
        self.channels[share.channel].last = Some(share);
        match self
            .round
            .iter_mut()
            .find(|old| old.channel == share.channel)
        {
            Some(old) => *old = share,
            None => self.round.push(share),
        }
    }

    fn properties(&mut self, bytes: &mut Bytes<'_>, channel: usize) -> Result<(), FormatFault> {
        const WHAT: &str = "the properties of a channel";
        let count = bytes.u32(WHAT)?;
        for _ in 0..count {
            let name = text(bytes)?;
            let at = bytes.place();
            let code = bytes.u32(WHAT)?;
            let channel = &mut self.channels[channel];
            if code == TEXT {
                let value = text(bytes)?;
                match name.as_str() {
                    "unit_string" => channel.unit = value,
                    "wf_xunit_string" => channel.x_unit = value,
                    "wf_xname" => channel.x_name = value,
                    _ => {}
                }
                continue;
            }
            let kind = Kind::of(code).ok_or_else(|| FormatFault::Malformed {
                at,
                found: format!("a property of type {code:#x}"),
                needed: "a type of the format",
            })?;
            let raw = bytes.take(kind.size(), WHAT)?;
            if kind == Kind::Stamp && name == "wf_start_time" {
                channel.stamp = Some(stamp_of(raw, bytes.big_endian()));
            }
            let Kind::Number(stored) = kind else { continue };
            let value = stored.number(raw, bytes.big_endian());
            match name.as_str() {
                "wf_increment" if value > 0.0 => channel.step = Some(value),
                "wf_start_offset" if value.is_finite() => channel.offset = value,
                "NI_Number_Of_Scales" => channel.scaled = value > 0.0,
                _ => {}
            }
        }
        Ok(())
    }

    fn values(&mut self, body: &mut Bytes<'_>, interleaved: bool) -> Result<(), FormatFault> {
        let round = self
            .round
            .iter()
            .fold(0_u64, |sum, share| sum.saturating_add(share.bytes));
        if round == 0 {
            return Ok(());
        }
        if interleaved {
            return self.interleaved(body);
        }
        // A round that was cut off holds whole values of its first channels, which would make
        // channels of different lengths: it is not read.
        while body.left() as u64 >= round {
            for k in 0..self.round.len() {
                let share = self.round[k];
                let bytes = body.take(share.bytes, "the values of a channel")?;
                self.values = self.values.saturating_add(share.count);
                within_limit(self.values)?;
                self.channels[share.channel].push(share.kind, bytes, body.big_endian());
            }
        }
        Ok(())
    }

    fn interleaved(&mut self, body: &mut Bytes<'_>) -> Result<(), FormatFault> {
        let width = self
            .round
            .iter()
            .map(|share| share.kind.size())
            .sum::<u64>();
        if self.round.iter().any(|share| share.kind.size() == 0) {
            return Err(FormatFault::Unsupported {
                found: "interleaved text".to_owned(),
                instead: "export the record as CSV",
            });
        }
        let mut rows = self.round.first().map_or(0, |share| share.count);
        rows = rows.max(body.left() as u64 / width);
        while rows > 0 && body.left() as u64 >= width {
            for k in 0..self.round.len() {
                let share = self.round[k];
                let bytes = body.take(share.kind.size(), "the values of a channel")?;
                self.values += 1;
                within_limit(self.values)?;
                self.channels[share.channel].push(share.kind, bytes, body.big_endian());
            }
            rows -= 1;
        }
        Ok(())
    }

    fn raw(self, notes: &mut Vec<Note>) -> Raw {
        let mut raw = Raw::default();
        let mut names: HashMap<String, usize> = HashMap::new();
        for channel in &self.channels {
            *names.entry(last_name(&channel.path)).or_default() += 1;
        }
        // Starts count from the first stamp, which has more digits than a double.
        let first = self.channels.iter().find_map(|channel| channel.stamp);
        for channel in self.channels {
            let short = last_name(&channel.path);
            let name = match names.get(&short) {
                Some(1) => short,
                _ => channel
                    .path
                    .replace('\'', "")
                    .trim_start_matches('/')
                    .to_owned(),
            };
            if channel.values.is_empty() && !channel.unread {
                continue;
            }
            match channel.base(first) {
                Err(because) => notes.push(Note::LeftOut {
                    column: name,
                    because,
                }),
                Ok(base) => {
                    let base = base.map(|base| raw.base(base));
                    raw.columns.push(RawColumn {
                        name,
                        unit: channel.unit,
                        values: channel.values,
                        base,
                        ..RawColumn::default()
                    });
                }
            }
        }
        raw
    }
}

fn text(bytes: &mut Bytes<'_>) -> Result<String, FormatFault> {
    let length = bytes.u32("a name")?;
    let text = bytes.take(u64::from(length), "a name")?;
    Ok(String::from_utf8_lossy(text).into_owned())
}

/// `Kraft` of `/'Log'/'Kraft'`.
fn last_name(path: &str) -> String {
    let last = path.rsplit_once("/'").map_or(path, |(_, last)| last);
    last.trim_end_matches('\'').replace("''", "'")
}
