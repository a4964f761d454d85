//! A channel of a TDMS file: its values and its time base.

use crate::base::{Base, Uniform};
use crate::bytes::Stored;
use crate::words::shortened;
use crate::{Unit, UnitKind};

/// Type code of a stamp.
const STAMP: u32 = 0x44;
/// 2^64: stamps count seconds in as many parts.
const PARTS: f64 = 18_446_744_073_709_551_616.0;

/// What the values of a channel are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Number(Stored),
    Stamp,
    /// Of this size each, and not read.
    Other(u64),
}

impl Kind {
    pub(super) fn of(code: u32) -> Option<Kind> {
        Some(match code {
            1 => Kind::Number(Stored::I8),
            2 => Kind::Number(Stored::I16),
            3 => Kind::Number(Stored::I32),
            4 => Kind::Number(Stored::I64),
            5 => Kind::Number(Stored::U8),
            6 => Kind::Number(Stored::U16),
            7 => Kind::Number(Stored::U32),
            8 => Kind::Number(Stored::U64),
            9 | 0x19 => Kind::Number(Stored::F32),
            10 | 0x1a => Kind::Number(Stored::F64),
            0x21 => Kind::Number(Stored::U8),
            STAMP => Kind::Stamp,
            0x08_000c => Kind::Other(8),
            0x10_000d => Kind::Other(16),
            _ => return None,
        })
    }

    pub(super) fn size(self) -> u64 {
        match self {
            Kind::Number(stored) => stored.size() as u64,
            Kind::Stamp => 16,
            Kind::Other(size) => size,
        }
    }
}

/// Values of one channel in each round of a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub(super) channel: usize,
    pub(super) kind: Kind,
    /// Values.
    pub(super) count: u64,
    /// All of them, bytes.
    pub(super) bytes: u64,
}

#[derive(Debug, Default)]
pub(super) struct Channel {
    pub(super) path: String,
    pub(super) unit: String,
    /// Step of a waveform, in its unit.
    pub(super) step: Option<f64>,
    /// Start of a waveform after its stamp, in its unit.
    pub(super) offset: f64,
    /// Unit of the step; seconds where it is empty.
    pub(super) x_unit: String,
    /// What the step counts, where it is told.
    pub(super) x_name: String,
    /// Parts of a second and seconds since 1904.
    pub(super) stamp: Option<(u64, i64)>,
    pub(super) scaled: bool,
    pub(super) unread: bool,
    pub(super) values: Vec<f64>,
    /// Seconds of the first value that is a stamp.
    pub(super) epoch: Option<i64>,
    pub(super) last: Option<Share>,
}

impl Channel {
    /// The time base of a waveform; `None` for values without one, and why a channel is left out.
    pub(super) fn base(&self, first: Option<(u64, i64)>) -> Result<Option<Base>, String> {
        if self.scaled {
            return Err("its values are to be scaled by the program that wrote them".to_owned());
        }
        if self.unread {
            return Err("its values are no real numbers".to_owned());
        }
        let Some(step) = self.step else {
            return Ok(None);
        };
        let in_s = if self.x_unit.trim().is_empty() {
            1.0
        } else {
            let unit = Unit::parse(&self.x_unit);
            if unit.kind() != UnitKind::Time {
                let unit = shortened(&self.x_unit);
                return Err(format!(
                    "its values stand over an axis in [{unit}], not over time"
                ));
            }
            unit.si_factor()
        };
        if self.x_name.to_lowercase().contains("freq") {
            return Err("its values stand over frequency, not over time".to_owned());
        }
        let late = |((parts, seconds), (first_parts, first_seconds)): ((u64, i64), (u64, i64))| {
            let whole = seconds.wrapping_sub(first_seconds) as f64;
            whole + (parts as f64 - first_parts as f64) / PARTS
        };
        let late_s = self.stamp.zip(first).map_or(0.0, late);
        Ok(Some(Base::Even(Uniform {
            start_s: late_s + self.offset * in_s,
            step_s: step * in_s,
            rows: self.values.len(),
        })))
    }

    pub(super) fn push(&mut self, kind: Kind, bytes: &[u8], big_endian: bool) {
        match kind {
            Kind::Number(stored) => self.values.extend(stored.numbers(bytes, big_endian)),
            Kind::Other(_) => self.unread = true,
            Kind::Stamp => {
                self.unit = "s".to_owned();
                for stamp in bytes.chunks_exact(16) {
                    let (parts, seconds) = stamp_of(stamp, big_endian);
                    let epoch = *self.epoch.get_or_insert(seconds);
                    let whole = seconds.wrapping_sub(epoch) as f64;
                    self.values.push(whole + parts as f64 / PARTS);
                }
            }
        }
    }
}

/// Parts of a second and seconds since 1904; the other way round in big-endian files.
pub(super) fn stamp_of(stamp: &[u8], big_endian: bool) -> (u64, i64) {
    let mut halves = [[0; 8]; 2];
    halves[0].copy_from_slice(&stamp[..8]);
    halves[1].copy_from_slice(&stamp[8..16]);
    if big_endian {
        (u64::from_be_bytes(halves[1]), i64::from_be_bytes(halves[0]))
    } else {
        (u64::from_le_bytes(halves[0]), i64::from_le_bytes(halves[1]))
    }
}
