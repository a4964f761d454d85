//! From columns as a file holds them to a record: missing samples, uneven stamps, the checks.

use crate::error::RecordError;
use crate::faults::MendFault;
use crate::fill::fill;
use crate::mended::Mended;
use crate::note::Note;
use crate::overload::taken_as_missing;
use crate::record::{Origin, Record};
use crate::resample::{on_grid, trusted_hz, usual_step};
use crate::time_base::{TimeFault, check_even};
use crate::{Channel, MAX_ROWS, Unit};

/// More missing samples than this share, and a channel is no measurement.
const MOST_MISSING: f64 = 0.2;
/// No gap is bridged that is longer than so many usual steps.
const LONGEST_GAP: f64 = 10.0;

/// The columns of a file that are wanted, under the names wanted. A missing value is NaN.
pub(crate) struct Columns {
    /// Stamps in `time_unit`.
    pub(crate) time: Vec<f64>,
    pub(crate) time_unit: Unit,
    pub(crate) channels: Vec<Channel>,
    pub(crate) time_name: String,
}

/// Makes a record. With `mend`, missing samples and an uneven time base are made good and told;
/// without, they are errors as everywhere.
pub(crate) fn finish(
    name: String,
    origin: &Origin<'_>,
    columns: Columns,
    mend: bool,
    notes: &mut Vec<Note>,
) -> Result<Record, RecordError> {
    let Columns {
        mut time,
        time_unit,
        mut channels,
        ..
    } = columns;
    if mend {
        let mut mended = Mended::default();
        for channel in &mut channels {
            let marks = taken_as_missing(channel);
            notes.extend((marks > 0).then(|| Note::Overloaded {
                channel: channel.name.clone(),
                marks,
            }));
            mended.push(&channel.values);
            notes.extend(filled(origin, channel)?);
        }
        let sound = time.iter().all(|t| t.is_finite())
            && channels
                .iter()
                .all(|channel| channel.values.len() == time.len());
        let rows = crate::MIN_ROWS..=MAX_ROWS;
        if sound && rows.contains(&time.len()) {
            let in_seconds: Vec<f64> = time.iter().map(|&t| time_unit.to_si(t)).collect();
            if let Err(TimeFault::Uneven { row, found, .. }) = check_even(&in_seconds) {
                let worst = (row, found);
                let (step, rows) = grid(origin, &in_seconds, worst)?;
                notes.push(resample(&in_seconds, &mut channels, step, rows));
                let start = in_seconds[0];
                time = (0..rows).map(|k| start + k as f64 * step).collect();
                let record = Record::from_file(name, origin, &Unit::parse("s"), time, channels)?;
                return Ok(record.with_mended(mended.resampled(&in_seconds, step, rows)));
            }
        }
        let record = Record::from_file(name, origin, &time_unit, time, channels)?;
        return Ok(record.with_mended(mended));
    }
    Record::from_file(name, origin, &time_unit, time, channels)
}

/// Fills what is missing, see [`fill`].
fn filled(origin: &Origin<'_>, channel: &mut Channel) -> Result<Option<Note>, RecordError> {
    let of = channel.values.len();
    let missing = channel.values.iter().filter(|value| value.is_nan()).count();
    if missing == 0 {
        return Ok(None);
    }
    if missing == of || missing as f64 > MOST_MISSING * of as f64 {
        return Err(RecordError::Mending {
            file: origin.file.to_owned(),
            fault: MendFault::TooManyMissing {
                column: channel.name.clone(),
                missing,
                of,
                most_percent: (100.0 * MOST_MISSING).round() as u32,
            },
        });
    }
    let longest_run = fill(&mut channel.values);
    Ok(Some(Note::Filled {
        channel: channel.name.clone(),
        missing,
        of,
        longest_run,
    }))
}

/// Step and rows of the even time base for these stamps.
fn grid(
    origin: &Origin<'_>,
    time_s: &[f64],
    (worst_row, worst_s): (usize, f64),
) -> Result<(f64, usize), RecordError> {
    let step = usual_step(time_s);
    let longest = time_s.windows(2).map(|pair| pair[1] - pair[0]);
    let longest = longest.fold(worst_s, f64::max);
    if longest > LONGEST_GAP * step {
        let ends = |pair: &[f64]| pair[1] - pair[0] == longest;
        let row = time_s
            .windows(2)
            .position(ends)
            .map_or(worst_row, |k| k + 1);
        return Err(RecordError::Mending {
            file: origin.file.to_owned(),
            fault: MendFault::Gap {
                at: (origin.row)(row),
                found: longest,
                usual: step,
                most: LONGEST_GAP,
            },
        });
    }
    // At most ten rows for each there was, by the limit above.
    let span = time_s[time_s.len() - 1] - time_s[0];
    let rows = (span / step * (1.0 + 1e-12)).floor() as usize + 1;
    if rows > MAX_ROWS {
        return Err(RecordError::TooManyRows {
            file: origin.file.to_owned(),
        });
    }
    Ok((step, rows))
}

fn resample(time_s: &[f64], channels: &mut [Channel], step_s: f64, rows: usize) -> Note {
    for channel in channels {
        channel.values = on_grid(time_s, &channel.values, step_s, rows);
    }
    let steps = || time_s.windows(2).map(|pair| pair[1] - pair[0]);
    let longest_s = steps().fold(0.0, f64::max);
    Note::Resampled {
        shortest_s: steps().fold(f64::INFINITY, f64::min),
        longest_s,
        step_s,
        rows_before: time_s.len(),
        rows,
        trusted_hz: trusted_hz(longest_s.max(step_s)),
    }
}
