//! The motion that files of `fixtures/records` hold, and how a record is held against it.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use std::f64::consts::PI;
use std::path::PathBuf;

use simgap_record::{ChannelMap, ReadOptions, Reading, RecordError, read_file};

/// Samples of every channel, and the step between them.
pub(crate) const ROWS: usize = 200;
pub(crate) const STEP_S: f64 = 0.005;
/// Doubles that went through a file of doubles.
pub(crate) const EXACT: f64 = 1e-14;
/// Numbers of single precision, or nine decimals.
pub(crate) const SINGLE: f64 = 2e-7;
/// Numbers of half precision.
pub(crate) const HALF: f64 = 6e-4;

pub(crate) fn path(folder: &str, name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/records")
        .join(folder)
        .join(name)
}

pub(crate) fn options(map: &[&str]) -> ReadOptions {
    let map = ChannelMap::parse(map).unwrap();
    ReadOptions::channels(["u", "y"], [""; 0]).with_map(map)
}

pub(crate) fn read(folder: &str, name: &str, map: &[&str]) -> Reading {
    read_file(&path(folder, name), &options(map)).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn refused(folder: &str, name: &str, options: &ReadOptions) -> RecordError {
    match read_file(&path(folder, name), options) {
        Ok(_) => panic!("{name}: read"),
        Err(error) => error,
    }
}

pub(crate) fn force(t: f64) -> f64 {
    1.5 * (2.0 * PI * 3.0 * t).sin()
}

pub(crate) fn travel(t: f64) -> f64 {
    2.0 * (-t).exp() * (2.0 * PI * 5.0 * t).cos()
}

/// What a record should be.
#[derive(Clone, Copy)]
pub(crate) struct Expected {
    pub(crate) rows: usize,
    pub(crate) step_s: f64,
    /// Time of the motion at the first row, and what the record says of it.
    pub(crate) from_s: f64,
    pub(crate) stamped_s: f64,
    /// Relative to the largest value.
    pub(crate) tolerance: f64,
    /// A row of the travel in whose place the one before is held.
    pub(crate) lost: Option<usize>,
    /// A stamp may be off by this share of a step.
    pub(crate) stamp_steps: f64,
}

pub(crate) const WHOLE: Expected = Expected {
    rows: ROWS,
    step_s: STEP_S,
    from_s: 0.0,
    stamped_s: 0.0,
    tolerance: EXACT,
    lost: None,
    // Microseconds of spreadsheets, of the first stamp and of this one.
    stamp_steps: 3e-4,
};

/// Every sample of a reading against the motion.
pub(crate) fn assert_holds(reading: &Reading, name: &str, expected: Expected) {
    let record = &reading.record;
    assert_eq!(record.len(), expected.rows, "{name}: rows");
    let step = record.time_step_s();
    assert!(
        (step / expected.step_s - 1.0).abs() < 1e-5,
        "{name}: step {step}"
    );
    let (u, y) = (record.channel("u"), record.require("y").unwrap());
    for k in 0..expected.rows {
        let since = k as f64 * expected.step_s;
        let stamp = record.time_s()[k] - expected.stamped_s - since;
        assert!(
            stamp.abs() < expected.stamp_steps * expected.step_s,
            "{name}: row {k} is stamped {stamp} s off"
        );
        let t = expected.from_s + since;
        if let Some(u) = u {
            let off = (u.values[k] - force(t)).abs();
            assert!(
                off <= 1.5 * expected.tolerance,
                "{name}: u {k} is {off} off"
            );
        }
        // A lost sample is filled by the cubic through its neighbours, off by (ωh)⁴/6 of the motion: 5 Hz, 10 ms.
        let filled = if expected.lost == Some(k) { 2e-3 } else { 0.0 };
        let off = (y.values[k] - travel(t)).abs();
        assert!(
            off <= 2.0 * (expected.tolerance + filled),
            "{name}: y {k} is {off} off"
        );
    }
}

pub(crate) fn notes(reading: &Reading) -> String {
    let notes: Vec<String> = reading.notes.iter().map(ToString::to_string).collect();
    notes.join("\n")
}
