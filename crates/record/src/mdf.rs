//! ASAM MDF, versions 2 to 4, by the crate `falcon_mdf` without threads and mapped files.
//!
//! A file is a list of groups; each has a master channel, which is time in most, and channels on
//! it. Groups were often sampled at different rates: each is a time base of its own.

use std::collections::HashMap;
use std::sync::Arc;

use falcon_mdf::io::memory::MemorySource;
use falcon_mdf::mdf3::Mdf3File;
use falcon_mdf::{Channel, Mf4File, OpenOptions, SignalValues};

use crate::base::Base;
use crate::faults::FormatFault;
use crate::foreign::{guarded, one_line};
use crate::note::Note;
use crate::raw::{Raw, RawColumn, within_limit};
use crate::{MAX_FILE_BYTES, Unit, UnitKind};

/// Where the version stands, and what it begins with in the old form of the format.
const VERSION_AT: usize = 8;

/// All channels of real numbers over time.
pub(crate) fn read(bytes: Vec<u8>, notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    let old = matches!(bytes.get(VERSION_AT), Some(b'2' | b'3'));
    let groups = guarded("the file", || {
        if old {
            version_3(bytes)
        } else {
            version_4(bytes)
        }
    })?;
    Ok(to_raw(groups, notes))
}

/// Channels on one master.
#[derive(Default)]
struct Group {
    name: String,
    /// Stamps of the master, s; why there are none as the error.
    time: Option<Result<Vec<f64>, &'static str>>,
    channels: Vec<RawColumn>,
    /// Names of channels that are left out, and why.
    left_out: Vec<(String, String)>,
}

fn version_4(bytes: Vec<u8>) -> Result<Vec<Group>, FormatFault> {
    let options = OpenOptions {
        build_channels_db: false,
        parallel_parsing: false,
        max_decompressed: MAX_FILE_BYTES,
        ..OpenOptions::default()
    };
    let file = Mf4File::from_bytes_with_options(bytes, options).map_err(damaged("the file"))?;
    let mut numbers = 0_u64;
    let mut groups = Vec::new();
    for group in file
        .data_groups()
        .iter()
        .flat_map(|data| &data.channel_groups)
    {
        if group.is_vlsd() || group.sample_count == 0 {
            continue;
        }
        let columns = group.channels.len() as u64;
        numbers = numbers.saturating_add(group.sample_count.saturating_mul(columns));
        within_limit(numbers)?;
        let mut read = Group {
            name: group.acquisition_name.clone(),
            ..Group::default()
        };
        let master = group.master_channel();
        read.time = master.map(|master| {
            if !master.is_time_channel() {
                return Err("the master of its group is not time");
            }
            let stamps = file.signal(master).and_then(|signal| signal.values_f64());
            let stamps = stamps.map_err(|_| "the time of its group cannot be read")?;
            Ok(in_seconds(stamps, &master.unit))
        });
        for channel in &group.channels {
            if !channel.is_master() {
                read.channel(channel, channel_values(&file, channel));
            }
        }
        groups.push(read);
    }
    Ok(groups)
}

/// The values of a channel, NaN where the file calls them invalid; or why it is left out.
fn channel_values(file: &Mf4File, channel: &Channel) -> Result<Vec<f64>, String> {
    if channel.is_array() {
        return Err("its samples are arrays".to_owned());
    }
    let signal = file
        .signal(channel)
        .map_err(|error| one_line(&error.to_string()))?;
    let values = signal
        .values()
        .map_err(|error| one_line(&error.to_string()))?;
    let mut values = numbers(values)?;
    if let Some(valid) = signal.validity() {
        for (value, _) in values.iter_mut().zip(valid).filter(|(_, valid)| !valid) {
            *value = f64::NAN;
        }
    }
    Ok(values)
}

fn numbers(values: SignalValues) -> Result<Vec<f64>, String> {
    match values {
        // Not copied: a long record takes its room once.
        SignalValues::F64(values) => Ok(values),
        SignalValues::Str(_) => Err("it holds text".to_owned()),
        SignalValues::Complex { .. } => Err("its values are complex".to_owned()),
        values if values.kind().is_numeric() => Ok(values.to_f64()),
        _ => Err("it holds no numbers".to_owned()),
    }
}

fn version_3(bytes: Vec<u8>) -> Result<Vec<Group>, FormatFault> {
    let file = Mdf3File::from_source(Arc::new(MemorySource::new(bytes)));
    let file = file.map_err(damaged("the file"))?;
    let mut numbers_so_far = 0_u64;
    let mut groups = Vec::new();
    for (g, data) in file.data_groups().iter().enumerate() {
        for (c, group) in data.channel_groups.iter().enumerate() {
            let count = u64::from(group.cycle_count) * group.channels.len() as u64;
            numbers_so_far = numbers_so_far.saturating_add(count);
            within_limit(numbers_so_far)?;
            if group.cycle_count == 0 {
                continue;
            }
            let mut read = Group {
                name: group.comment.clone(),
                ..Group::default()
            };
            for (k, channel) in group.channels.iter().enumerate() {
                let values = file
                    .channel_physical(g, c, k)
                    .map_err(|error| one_line(&error.to_string()))
                    .and_then(numbers);
                if channel.is_time() {
                    let stamps = values.map_err(|_| "the time of its group cannot be read");
                    read.time = Some(stamps.map(|stamps| in_seconds(stamps, &channel.unit)));
                } else {
                    read.take(&channel.name, &channel.unit, values);
                }
            }
            groups.push(read);
        }
    }
    Ok(groups)
}

impl Group {
    fn channel(&mut self, channel: &Channel, values: Result<Vec<f64>, String>) {
        self.take(&channel.name, &channel.unit, values);
    }

    fn take(&mut self, name: &str, unit: &str, values: Result<Vec<f64>, String>) {
        match values {
            Ok(values) => self.channels.push(RawColumn {
                name: name.to_owned(),
                unit: unit.to_owned(),
                values,
                ..RawColumn::default()
            }),
            Err(because) => self.left_out.push((name.to_owned(), because)),
        }
    }
}

/// Masters are in seconds by the standard; some writers keep another unit and say so.
fn in_seconds(mut stamps: Vec<f64>, unit: &str) -> Vec<f64> {
    let unit = Unit::parse(unit);
    if unit.kind() == UnitKind::Time && unit.si_factor() != 1.0 {
        stamps.iter_mut().for_each(|t| *t = unit.to_si(*t));
    }
    stamps
}

fn to_raw(groups: Vec<Group>, notes: &mut Vec<Note>) -> Raw {
    let mut seen: HashMap<String, usize> = HashMap::new();
    for channel in groups.iter().flat_map(|group| &group.channels) {
        *seen.entry(channel.name.clone()).or_default() += 1;
    }
    let mut raw = Raw::default();
    for (index, group) in groups.into_iter().enumerate() {
        let told = |column: String, because: String| Note::LeftOut { column, because };
        for (column, because) in group.left_out {
            notes.push(told(column, because));
        }
        let stamps = match group.time {
            Some(Ok(stamps)) => stamps,
            other => {
                let because = match other {
                    Some(Err(because)) => because,
                    _ => "its group has no time",
                };
                let names = group.channels.into_iter().map(|channel| channel.name);
                notes.extend(names.map(|name| told(name, because.to_owned())));
                continue;
            }
        };
        let base = raw.base(Base::Stamps(stamps));
        for mut channel in group.channels {
            if seen.get(&channel.name).is_some_and(|&count| count > 1) {
                let of = match group.name.trim() {
                    "" => format!("group {}", index + 1),
                    name => name.to_owned(),
                };
                channel.name = format!("{} ({of})", channel.name);
            }
            channel.base = Some(base);
            raw.columns.push(channel);
        }
    }
    raw
}

fn damaged(what: &str) -> impl Fn(falcon_mdf::Mf4Error) -> FormatFault {
    move |error| FormatFault::Damaged {
        what: what.to_owned(),
        reason: one_line(&error.to_string()),
    }
}
