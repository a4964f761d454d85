//! What mending leaves known: filled samples, resampled clocks, marks of instruments.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use simgap_record::{Defect, Mend, ReadOptions, Reading, RecordError, parse_file, quality};

fn read(text: &str) -> Result<Reading, RecordError> {
    let options = ReadOptions::all().with_mend(Mend::Always);
    parse_file("A.csv", text.as_bytes(), &options)
}

/// A sine of 25 samples a period, with cells and stamps as told.
fn table(rows: usize, stamp: impl Fn(usize) -> Option<f64>, y: impl Fn(usize) -> String) -> String {
    let mut text = String::from("t [s],u [N],y [m]\n");
    for k in 0..rows {
        if let Some(t) = stamp(k) {
            let u = (0.25 * k as f64).cos();
            writeln!(text, "{t:.5},{u:.9},{}", y(k)).unwrap();
        }
    }
    text
}

fn sine(k: usize) -> String {
    format!("{:.9}", (0.25 * k as f64).sin())
}

fn even(k: usize) -> Option<f64> {
    Some(0.01 * k as f64)
}

fn filled_rows(reading: &Reading, channel: &str) -> Vec<usize> {
    let filled = reading.record.filled(channel).unwrap_or_default();
    (0..filled.len()).filter(|&row| filled[row]).collect()
}

#[test]
fn filled_samples_are_marked_in_their_channel_alone() {
    let lost = |k: usize| (20..22).contains(&k) || k == 70;
    let text = table(100, even, |k| match lost(k) {
        true => "nan".into(),
        false => sine(k),
    });
    let reading = read(&text).unwrap();
    assert_eq!(filled_rows(&reading, "y"), [20, 21, 70]);
    assert_eq!(reading.record.filled("u"), None);
    assert_eq!(reading.record.filled("z"), None);
    assert!(!reading.record.is_resampled());
    // A part of the record knows its own.
    let part = reading.record.slice(60..100).unwrap();
    let filled = part.filled("y").unwrap();
    assert_eq!(filled.len(), 40);
    assert!(filled[10] && filled.iter().filter(|f| **f).count() == 1);
    let none = reading.record.slice(30..60).unwrap();
    assert_eq!(none.filled("y"), None);
}

#[test]
fn a_lost_row_is_filled_and_the_others_are_as_they_were_taken() {
    let text = table(100, |k| even(k).filter(|_| k != 40), sine);
    let reading = read(&text).unwrap();
    assert_eq!(reading.record.len(), 100);
    assert_eq!(filled_rows(&reading, "y"), [40]);
    assert_eq!(filled_rows(&reading, "u"), [40]);
    assert!(!reading.record.is_resampled());
    let y = &reading.record.require("y").unwrap().values;
    for k in (0..100).filter(|&k| k != 40) {
        assert_eq!(y[k], sine(k).parse::<f64>().unwrap(), "row {k}");
    }
}

#[test]
fn samples_moved_to_an_even_clock_are_told() {
    let jitter = |k: usize| Some(0.01 * (k as f64 + 0.36 * (1.7 * k as f64).sin()));
    let text = table(200, jitter, sine);
    let reading = read(&text).unwrap();
    assert!(reading.record.is_resampled());
    assert_eq!(filled_rows(&reading, "y"), [0; 0]);
    assert!(reading.record.slice(10..60).unwrap().is_resampled());
    // What is made of a filled sample is filled: here it lies between two stamps.
    let text = table(200, jitter, |k| match k {
        50 => "nan".into(),
        _ => sine(k),
    });
    let reading = read(&text).unwrap();
    let rows = filled_rows(&reading, "y");
    assert_eq!(rows.len(), 2, "{rows:?}");
    let [from, to] = [49, 51].map(|k| jitter(k).unwrap());
    let times = rows.iter().map(|&row| reading.record.time_s()[row]);
    assert!(times.clone().all(|t| from < t && t < to), "{times:?}");
}

/// Thirty samples that were lost and filled are no defect of the chain; the same values in the file are.
#[test]
fn filled_samples_are_no_repeats() {
    let lost = |k: usize| k % 30 == 7;
    let text = table(900, even, |k| match lost(k) {
        true => String::from("nan"),
        false => sine(k),
    });
    let reading = read(&text).unwrap();
    assert_eq!(filled_rows(&reading, "y").len(), 30);
    assert_eq!(quality(&reading.record), []);
    let held = table(900, even, |k| sine(k - usize::from(lost(k))));
    let found = quality(&read(&held).unwrap().record);
    assert!(
        matches!(found[..], [ref one] if matches!(one.defect, Defect::Repeated { runs: 30, .. })),
        "{found:?}"
    );
}

/// The marks of the standard of instruments are missing samples, in either precision; without
/// mending they are refused by name.
#[test]
fn marks_of_instruments_are_missing_samples() {
    let cell = |k: usize| match k {
        10 => "9.9E37".into(),
        11 => "-9.9e+37".into(),
        60 => "9.91E37".into(),
        61 => "9.9100001e37".into(),
        _ => sine(k),
    };
    let text = table(100, even, cell);
    let reading = read(&text).unwrap();
    assert_eq!(filled_rows(&reading, "y"), [10, 11, 60, 61]);
    // The cubic through two samples on either side is off by the fourth derivative times 6 / 24 at most.
    let filled = reading.record.require("y").unwrap().values[11];
    assert!(
        (filled - (0.25_f64 * 11.0).sin()).abs() < 0.25_f64.powi(4) / 4.0,
        "{filled}"
    );
    let notes: Vec<String> = reading.notes.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(notes.join("\n"), @r"
    4 samples of 'y' hold the mark of an instrument for an overload or no reading (9.9e37 or 9.91e37); taken as missing
    4 of 100 samples of 'y' are missing, at most 2 in a row; a curve through those beside them stands in their place
    ");
    let refused = parse_file("A.csv", text.as_bytes(), &ReadOptions::all()).unwrap_err();
    insta::assert_snapshot!(refused.to_string(), @"A.csv: line 12: column 'y' holds 9.9e37, the mark of an instrument for an overload or no reading, but a measured value is needed; --mend takes it as missing");
    let refused = simgap_record::parse_csv("A.csv", text.as_bytes()).unwrap_err();
    insta::assert_snapshot!(refused.to_string(), @"A.csv: line 12: column 'y' holds 9.9e37, the mark of an instrument for an overload or no reading, but a measured value is needed; --mend takes it as missing");
}
