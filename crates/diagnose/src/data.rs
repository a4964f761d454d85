//! Which samples are learnt from, which are held back.

use std::borrow::Borrow;

use simgap_model::Model;
use simgap_record::Record;
use simgap_simulate::Run;

use crate::DiagnoseError;
use crate::units::{Units, refuse_other_units};

/// Share of each record that is held back when no check record is given.
const HELD_BACK: f64 = 1.0 / 3.0;

/// Fewest samples of a record to learn from: below that every small set of effects fits.
const FEWEST: usize = 20;
/// Fewest samples of a record to judge by.
const FEWEST_HELD_BACK: usize = 10;

/// Records in the units of the model, divided.
pub(crate) struct Data {
    /// Learnt from.
    pub(crate) train: Vec<Run>,
    /// Held back; its time stamps beside it.
    pub(crate) check: Vec<Run>,
    pub(crate) check_times: Vec<Vec<f64>>,
    /// Units of what the first record tells.
    pub(crate) units: Units,
    /// What a reader must know about the division.
    pub(crate) notes: Vec<String>,
}

pub(crate) fn divide<R: Borrow<Record>>(
    model: &Model,
    train: &[R],
    check: &[R],
) -> Result<Data, DiagnoseError> {
    let Some(first) = train.first() else {
        return Err(DiagnoseError::NoRecord);
    };
    if check.is_empty() && model.is_external() {
        return Err(DiagnoseError::NoCheckRecord);
    }
    let all: Vec<&Record> = train.iter().chain(check).map(Borrow::borrow).collect();
    refuse_other_units(model, &all)?;
    let run = |record: &Record, part: &'static str| -> Result<Run, DiagnoseError> {
        let run = Run::with_outputs(model, record)?;
        for (output, measured) in model.outputs.iter().zip(&run.measured) {
            let values = measured.as_deref().unwrap_or_default();
            if values.iter().all(|value| *value == values[0]) {
                return Err(DiagnoseError::FlatOutput {
                    record: record.name().to_string(),
                    channel: output.channel.clone(),
                    part,
                });
            }
        }
        Ok(run)
    };
    let mut data = Data {
        train: vec![],
        check: vec![],
        check_times: vec![],
        units: Units::new(model, first.borrow()),
        notes: vec![],
    };
    for record in train.iter().map(Borrow::borrow) {
        let left = if check.is_empty() {
            record.len() - held_back(record)
        } else {
            record.len()
        };
        enough(record, left, FEWEST, "learn from")?;
        if check.is_empty() {
            run(record, "")?;
            let cut = record.len() - held_back(record);
            data.train
                .push(run(&record.slice(0..cut)?, " in the first two thirds")?);
            let held = record.slice(cut..record.len())?;
            let mut held_run = run(&held, " in the held-back last third")?;
            held_run.first_index = cut;
            data.check.push(held_run);
            data.notes.push(format!(
                "no check record was given: the last third of {} ({} s to {} s) was held back",
                record.name(),
                to_microseconds(held.time_s().first()),
                to_microseconds(held.time_s().last()),
            ));
            data.check_times.push(held.time_s().to_vec());
        } else {
            data.train.push(run(record, "")?);
        }
    }
    for record in check.iter().map(Borrow::borrow) {
        enough(record, record.len(), FEWEST_HELD_BACK, "judge by")?;
        data.check.push(run(record, "")?);
        data.check_times.push(record.time_s().to_vec());
    }
    crate::parity::align(&mut data.train, &mut data.check);
    Ok(data)
}

fn enough(
    record: &Record,
    found: usize,
    needed: usize,
    purpose: &'static str,
) -> Result<(), DiagnoseError> {
    if found >= needed {
        return Ok(());
    }
    Err(DiagnoseError::TooShort {
        record: record.name().to_string(),
        found,
        needed,
        purpose,
    })
}

/// A stamp without digits that no clock has.
fn to_microseconds(stamp_s: Option<&f64>) -> f64 {
    (stamp_s.copied().unwrap_or(0.0) * 1e6).round() / 1e6
}

fn held_back(record: &Record) -> usize {
    (record.len() as f64 * HELD_BACK) as usize
}
