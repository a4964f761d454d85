//! Records that are given twice, under one name or two.

use std::path::{Path, PathBuf};

use simgap_model::Model;
use simgap_record::{Record, found_within};

use crate::AppError;
use crate::input::Input;

/// Refuses a training record that repeats another one, and a check record that holds the samples of
/// a training record or is a part of it: figures on data that was fitted to say nothing.
pub(crate) fn refuse(model: &Model, train: &[Input], check: &[Input]) -> Result<(), AppError> {
    let named = |input| {
        let Input { path, record, .. }: &Input = input;
        (path, &**record)
    };
    let inputs = model.inputs.iter().map(|input| input.channel.as_str());
    let outputs = model.outputs.iter().map(|output| output.channel.as_str());
    // The outputs first: they tell most records apart at the first sample.
    let channels: Vec<&str> = outputs.chain(inputs).collect();
    let learnt: Vec<(&PathBuf, &Record)> = train.iter().map(named).collect();
    for (k, (path, record)) in learnt.iter().enumerate() {
        let same = |other: &Record| {
            other.len() == record.len() && found_within(record, other, &channels).is_some()
        };
        if let Some((first, _)) = learnt[..k].iter().find(|(_, other)| same(other)) {
            return Err(AppError::TrainTwice {
                first: first.to_path_buf(),
                second: path.to_path_buf(),
            });
        }
    }
    for (path, record) in check.iter().map(named) {
        for (first, other) in &learnt {
            if let Some(found) = overlap((path, record), (first, other), &channels) {
                return Err(AppError::CheckRepeats {
                    check: path.clone(),
                    train: first.to_path_buf(),
                    found,
                });
            }
        }
    }
    Ok(())
}

/// How two records hold the same samples, in words.
fn overlap(
    (path, check): (&Path, &Record),
    (train_path, train): (&Path, &Record),
    channels: &[&str],
) -> Option<String> {
    let (check_len, train_len) = (check.len(), train.len());
    let name = |path: &Path| path.display().to_string();
    let rows = |first: usize, len: usize| format!("rows {} to {}", first + 1, first + len);
    if check_len <= train_len {
        let first = found_within(check, train, channels)?;
        Some(match check_len == train_len {
            true => "it holds the same samples".to_string(),
            false => format!("it is {} of it", rows(first, check_len)),
        })
    } else {
        let first = found_within(train, check, channels)?;
        let rows = rows(first, train_len);
        Some(format!("{} is {rows} of {}", name(train_path), name(path)))
    }
}
