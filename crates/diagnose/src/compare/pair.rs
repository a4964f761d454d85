//! Two records brought onto the same stamps: which columns belong together, over which time.

use std::collections::BTreeSet;

use simgap_effects::Sampled;
use simgap_record::{Channel, Record, RecordError, UnitKind};

use super::comparison::{CommonTime, SharedInput};
use super::error::CompareError;
use super::request::CompareRequest;

/// Fewest samples that can be judged: two thirds to learn from, one third held back.
pub(super) const FEWEST: usize = 30;
/// Stamps this close to each other, in steps, are the same: files print six digits and more.
const SAME_STAMP: f64 = 1e-3;
/// Two columns closer than this are the same signal, read from the same file: an input.
const SAME_SIGNAL: f64 = 1e-6;
/// An input that differs by more is worth a note.
const OTHER_INPUT: f64 = 1e-2;

/// One channel of both records, in SI units, on the stamps of the measured one.
pub(super) struct Trace {
    pub(super) channel: String,
    pub(super) simulated_channel: String,
    pub(super) unit: String,
    pub(super) kind: UnitKind,
    pub(super) measured: Vec<f64>,
    pub(super) simulated: Vec<f64>,
}

/// Two records on the same stamps.
pub(super) struct Pairing {
    pub(super) time_s: Vec<f64>,
    pub(super) time: CommonTime,
    pub(super) traces: Vec<Trace>,
    pub(super) inputs: Vec<SharedInput>,
    /// The inputs as measured.
    pub(super) drives: Vec<Vec<f64>>,
    pub(super) notes: Vec<String>,
}

/// Where a sample of the measured record lies in the simulated one.
struct Grid {
    /// First and last measured row that are used.
    rows: std::ops::Range<usize>,
    /// Position of the first of them, and samples of the simulated record in a measured step.
    start: f64,
    stride: f64,
}

impl Grid {
    fn new(request: &CompareRequest<'_>) -> Result<Grid, CompareError> {
        let (measured, simulated) = (request.measured, request.simulated);
        let [(from_s, to_s), (other_from_s, other_to_s)] = [measured, simulated].map(ends);
        let step = simulated.time_step_s();
        let zero = if request.align_start {
            from_s
        } else {
            other_from_s
        };
        let stride = measured.time_step_s() / step;
        let position = |row: usize| (from_s - zero) / step + row as f64 * stride;
        let last = (simulated.len() - 1) as f64;
        let inside = |row: &usize| (-SAME_STAMP..=last + SAME_STAMP).contains(&position(*row));
        let first = (0..measured.len()).find(inside).unwrap_or(0);
        let count = (first..measured.len())
            .take_while(|row| inside(row))
            .count();
        if count < FEWEST {
            return Err(CompareError::NoCommonTime {
                measured: measured.name().to_string(),
                from_s,
                to_s,
                simulated: simulated.name().to_string(),
                other_from_s,
                other_to_s,
                needed: FEWEST,
            });
        }
        Ok(Grid {
            rows: first..first + count,
            start: position(first),
            stride,
        })
    }

    /// Whether the stamps of both are the same, so that nothing has to be interpolated.
    fn is_shared(&self) -> bool {
        let whole = |x: f64| (x - x.round()).abs() < SAME_STAMP;
        // A stride that is off adds up over the record.
        let last = self.start + (self.rows.len() - 1) as f64 * self.stride;
        whole(self.start) && whole(last) && (self.stride - 1.0).abs() < 0.5 / self.rows.len() as f64
    }

    fn position(&self, row: usize) -> f64 {
        let position = self.start + row as f64 * self.stride;
        if self.is_shared() {
            position.round()
        } else {
            position
        }
    }

    /// A simulated signal on the measured stamps.
    fn take(&self, values: &[f64], time_step_s: f64) -> Vec<f64> {
        let signal = Sampled::from_start(values, time_step_s);
        let rows = 0..self.rows.len();
        if self.is_shared() {
            let row = |i| (self.position(i) as usize).min(values.len() - 1);
            return rows.map(|i| values[row(i)]).collect();
        }
        rows.map(|i| signal.at(self.position(i))).collect()
    }
}

fn ends(record: &Record) -> (f64, f64) {
    let time_s = record.time_s();
    let end = |stamp: Option<&f64>| stamp.copied().unwrap_or(0.0);
    (end(time_s.first()), end(time_s.last()))
}

/// Brings both records together.
pub(super) fn pair(request: &CompareRequest<'_>) -> Result<Pairing, CompareError> {
    let (measured, simulated) = (request.measured, request.simulated);
    let names = names(request)?;
    let grid = Grid::new(request)?;
    let mut pairing = Pairing {
        time_s: measured.time_s()[grid.rows.clone()].to_vec(),
        time: CommonTime {
            from_s: measured.time_s()[grid.rows.start],
            to_s: measured.time_s()[grid.rows.end - 1],
            time_step_s: measured.time_step_s(),
            rows: grid.rows.len(),
            resampled: !grid.is_shared(),
        },
        traces: vec![],
        inputs: vec![],
        drives: vec![],
        notes: time_notes(request, &grid),
    };
    let mut traces = Vec::new();
    for (name, other) in names {
        let trace = trace(request, &grid, &name, &other)?;
        let gap = relative(&trace.measured, &trace.simulated);
        traces.push((trace, gap));
    }
    // What is the same in both has driven both; where all is the same, it simply agrees.
    let wished = |trace: &Trace| request.inputs.contains(&trace.channel);
    let any_off = traces
        .iter()
        .any(|(trace, gap)| !wished(trace) && *gap >= SAME_SIGNAL);
    for (trace, gap) in traces {
        if wished(&trace) || (any_off && gap < SAME_SIGNAL) {
            pairing.drive(trace, gap);
        } else if is_flat(&trace.measured) {
            pairing.notes.push(format!(
                "column \"{}\" of {} never changes and was left out",
                trace.channel,
                measured.name()
            ));
        } else {
            pairing.traces.push(trace);
        }
    }
    if pairing.traces.is_empty() {
        let measured = measured.name().to_string();
        return Err(CompareError::AllFlat { measured });
    }
    for (record, other) in [(measured, simulated), (simulated, measured)] {
        let more = record.channels().iter();
        let more = more.filter(|c| request.pairs.is_empty() && other.channel(&c.name).is_none());
        let more: Vec<&str> = more.map(|channel| channel.name.as_str()).collect();
        if !more.is_empty() && other.channels().len() + record.channels().len() > 2 {
            let (only, more) = (record.name(), more.join(", "));
            pairing.notes.push(format!("only {only} has {more}"));
        }
    }
    Ok(pairing)
}

fn time_notes(request: &CompareRequest<'_>, grid: &Grid) -> Vec<String> {
    let (measured, simulated) = (request.measured, request.simulated);
    let mut notes = Vec::new();
    if !grid.is_shared() {
        notes.push(format!(
            "{} ({} Hz) was interpolated to the stamps of {} ({} Hz), by polynomials of degree five",
            simulated.name(),
            digits(simulated.sample_rate_hz()),
            measured.name(),
            digits(measured.sample_rate_hz())
        ));
    }
    let outside = measured.len() - grid.rows.len();
    if outside > 0 {
        notes.push(format!(
            "{outside} of {} samples of {} lie outside the time of {} and were left out",
            measured.len(),
            measured.name(),
            simulated.name()
        ));
    }
    if request.align_start {
        notes.push("both records were taken to begin at the same moment".to_string());
    }
    notes
}

/// A number with the digits that matter in a sentence.
fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Columns that belong together: as asked for, else those of the same name, else the only ones.
fn names(request: &CompareRequest<'_>) -> Result<Vec<(String, String)>, CompareError> {
    let (measured, simulated) = (request.measured, request.simulated);
    let common = measured
        .channels()
        .iter()
        .map(|channel| channel.name.clone());
    let common: Vec<String> = common
        .filter(|name| simulated.channel(name).is_some())
        .collect();
    for input in request.inputs {
        measured.require(input)?;
        simulated.require(input)?;
    }
    let mut pairs: Vec<(String, String)> = request.pairs.to_vec();
    if pairs.is_empty() {
        pairs = common
            .iter()
            .map(|name| (name.clone(), name.clone()))
            .collect();
    } else {
        let more = request
            .inputs
            .iter()
            .filter(|i| pairs.iter().all(|(name, _)| name != *i));
        let more: Vec<_> = more.map(|name| (name.clone(), name.clone())).collect();
        pairs.extend(more);
    }
    if let (true, [one], [other]) = (pairs.is_empty(), measured.channels(), simulated.channels()) {
        pairs.push((one.name.clone(), other.name.clone()));
    }
    if pairs.is_empty() {
        return Err(CompareError::NothingInCommon {
            measured: measured.name().to_string(),
            simulated: simulated.name().to_string(),
            has: listed(measured),
            other: listed(simulated),
        });
    }
    let mut seen = BTreeSet::new();
    for (name, other) in &pairs {
        for (record, name) in [(measured, name), (simulated, other)] {
            record.require(name)?;
            if !seen.insert((std::ptr::from_ref(record), name.clone())) {
                return Err(CompareError::UsedTwice {
                    channel: name.clone(),
                    record: record.name().to_string(),
                });
            }
        }
    }
    Ok(pairs)
}

fn listed(record: &Record) -> String {
    let names = record
        .channels()
        .iter()
        .map(|channel| channel.name.as_str());
    names.collect::<Vec<_>>().join(", ")
}

fn trace(
    request: &CompareRequest<'_>,
    grid: &Grid,
    name: &str,
    other: &str,
) -> Result<Trace, CompareError> {
    let (measured, simulated) = (request.measured, request.simulated);
    let (one, two) = (measured.require(name)?, simulated.require(other)?);
    let (kind, unit) = (one.unit.kind(), one.unit.symbol());
    if !one.unit.measures_as(&two.unit) {
        return Err(CompareError::Units {
            channel: name.to_string(),
            measured: measured.name().to_string(),
            unit: unit.to_string(),
            simulated: simulated.name().to_string(),
            other: two.unit.symbol().to_string(),
        });
    }
    let si = |channel: &Channel| -> Vec<f64> {
        let values = channel.values.iter();
        values.map(|value| channel.unit.to_si(*value)).collect()
    };
    Ok(Trace {
        channel: name.to_string(),
        simulated_channel: other.to_string(),
        unit: match kind {
            UnitKind::Other => unit.to_string(),
            kind => kind.si_symbol().to_string(),
        },
        kind,
        measured: si(one)[grid.rows.clone()].to_vec(),
        simulated: grid.take(&si(two), simulated.time_step_s()),
    })
}

fn is_flat(values: &[f64]) -> bool {
    values.iter().all(|value| *value == values[0])
}

/// rms of the difference over the standard deviation of the first; infinite for a flat first.
fn relative(measured: &[f64], simulated: &[f64]) -> f64 {
    let count = measured.len() as f64;
    let mean = measured.iter().sum::<f64>() / count;
    let spread: f64 = measured.iter().map(|v| (v - mean).powi(2)).sum();
    let off = measured.iter().zip(simulated);
    let off: f64 = off.map(|(m, s)| (m - s).powi(2)).sum();
    match (off == 0.0, spread > 0.0) {
        (true, _) => 0.0,
        (false, true) => (off / spread).sqrt(),
        (false, false) => f64::INFINITY,
    }
}

impl Pairing {
    fn drive(&mut self, trace: Trace, gap: f64) {
        if gap > OTHER_INPUT {
            self.notes.push(format!(
                "input \"{}\" differs by {:.1} % of its own size between the records: part of the \
                 gap is in what drives the simulation",
                trace.channel,
                100.0 * gap
            ));
        }
        self.inputs.push(SharedInput {
            channel: trace.channel,
            nrmse: if gap.is_finite() { gap } else { 0.0 },
        });
        self.drives.push(trace.measured);
    }

    /// The record that is judged: each measured column, and beside it the simulated one.
    pub(super) fn record(&self, name: &str) -> Result<Record, RecordError> {
        let columns = self.traces.iter().flat_map(|trace| {
            let beside = predicted_name(&trace.channel);
            [
                Channel::new(trace.channel.clone(), &trace.unit, trace.measured.clone()),
                Channel::new(beside, &trace.unit, trace.simulated.clone()),
            ]
        });
        Record::new(name, self.time_s.clone(), columns.collect())
    }
}

/// What the simulated column beside a measured one is called.
pub(super) fn predicted_name(channel: &str) -> String {
    format!("{channel} as simulated")
}
