//! Reading well-formed files in all their variants, and writing them back.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use simgap_record::{
    Channel, MIN_ROWS, Place, Quantity, Record, RecordError, parse_csv, read_csv,
    read_csv_channels, read_csv_some, write_csv_atomic, write_text_atomic,
};

/// A double has 52 bits of mantissa; a mean of steps is wrong by a few roundings of the stamps.
const STEP_REL_TOLERANCE: f64 = 1e-12;

fn plain() -> String {
    let mut text = String::from("t [s],u [N],y1 [m]\n");
    for k in 0..12 {
        text += &format!("{},{},{}\n", f64::from(k) * 0.25, k * k, -k);
    }
    text
}

#[test]
fn verify_values_names_and_units_arrive() {
    let record = parse_csv("A.csv", plain().as_bytes()).unwrap();
    assert_eq!((record.name(), record.len()), ("A.csv", 12));
    assert_eq!(record.time_s()[3], 0.75);
    assert_eq!(record.require("u").unwrap().values[3], 9.0);
    assert_eq!(record.require("y1").unwrap().values[11], -11.0);
    assert_eq!(record.channels()[1].unit.symbol(), "m");
    assert!((record.time_step_s() / 0.25 - 1.0).abs() < STEP_REL_TOLERANCE);
}

#[test]
fn verify_dialects_of_csv_read_the_same() {
    let plain = plain();
    let expected = parse_csv("A.csv", plain.as_bytes()).unwrap();
    let spaced: String = plain
        .lines()
        .map(|l| format!("  {} \n", l.replace(',', " , ")))
        .collect();
    let quoted: String = plain
        .lines()
        .map(|l| format!("\"{}\"\n", l.replace(',', "\", \"")))
        .collect();
    let dialects = [
        ("byte order mark", format!("\u{feff}{plain}")),
        ("CRLF", plain.replace('\n', "\r\n")),
        ("no line end at the end", plain.trim_end().to_owned()),
        ("spaces", spaced),
        ("quotes", quoted),
        ("quotes and CRLF", quoted_crlf(&plain)),
        (
            "blank lines",
            format!("\n{}\r\n \n\n", plain.replace("\n0.5,", "\n\n0.5,")),
        ),
        ("time by name", plain.replace("t [s]", "Time[s]")),
        ("time by unit", plain.replace("t [s]", "Zeit [s]")),
    ];
    for (dialect, text) in dialects {
        let record = parse_csv("A.csv", text.as_bytes());
        assert_eq!(record.unwrap(), expected, "{dialect}");
    }
}

fn quoted_crlf(plain: &str) -> String {
    plain
        .lines()
        .map(|l| format!("\"{}\"\r\n", l.replace(',', "\",\"")))
        .collect()
}

#[test]
fn verify_units_are_converted_and_conversions_told() {
    let text = plain()
        .replace("[s]", "[ms]")
        .replace("u [N]", "u [kN]")
        .replace("[m]", "[V]");
    let record = parse_csv("A.csv", text.as_bytes()).unwrap();
    assert_eq!(record.time_s()[3], 0.75e-3);
    let force = record.si_values("u", Quantity::Force).unwrap();
    assert_eq!(force[3], 9000.0);
    let told: Vec<String> = record
        .conversions_to(&[("u", Quantity::Force), ("y1", Quantity::Displacement)])
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        told,
        [
            "column 't' converted from ms to s, factor 0.001",
            "column 'u' converted from kN to N, factor 1000"
        ]
    );
}

#[test]
fn verify_ignored_columns_may_hold_anything() {
    let text: String = plain()
        .lines()
        .enumerate()
        .map(|(k, line)| {
            let extra = if k == 0 { "remark,remark" } else { ",n/a" };
            format!("{line},{extra}\n")
        })
        .collect();
    assert!(matches!(
        parse_csv("A.csv", text.as_bytes()),
        Err(RecordError::MissingUnit { column: 4, .. })
    ));
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.csv");
    write_text_atomic(&path, &text).unwrap();
    let record = read_csv_channels(&path, &["y1"]).unwrap();
    assert_eq!(record.channels().len(), 1);
    assert_eq!(record.require("y1").unwrap().values[4], -4.0);
    let missing = read_csv_channels(&path, &["y1", "y2"]).unwrap_err();
    assert!(matches!(missing, RecordError::MissingColumn { wanted, .. } if wanted == "y2"));
    // A column that is only welcome may be missing; one that is there is read.
    let some = read_csv_some(&path, &["y1"], &["y2", "u"]).unwrap();
    assert_eq!(some.channel("y2"), None);
    assert_eq!(some.channels().len(), 2);
}

#[test]
fn verify_rounded_stamps_pass_and_give_the_true_rate() {
    let rate_hz = 1e7 / f64::from(1 << 14); // Silverbox: 610.35 Hz
    let time: Vec<f64> = (0..20_000)
        .map(|k| (f64::from(k) / rate_hz * 1e3).round() / 1e3)
        .collect();
    let y = Channel::new("y", "V", vec![0.0; time.len()]);
    let record = Record::new("rounded", time, vec![y]).unwrap();
    // A rounding of at most 0.5 ms, averaged over 33 s: (1) of the step gives about
    // 0.5e-3 / 33 / sqrt(n / 12) = 4e-7 at one standard deviation.
    const RATE_REL_TOLERANCE: f64 = 2e-6;
    assert!((record.sample_rate_hz() / rate_hz - 1.0).abs() < RATE_REL_TOLERANCE);
}

#[test]
fn verify_slice_keeps_name_step_and_stamps() {
    let y = Channel::new("y", "m", (0..50).map(f64::from).collect());
    let record = Record::from_uniform("C.csv", 2.0, 0.1, vec![y]).unwrap();
    let part = record.slice(10..30).unwrap();
    assert_eq!(
        (part.name(), part.len(), part.time_step_s()),
        ("C.csv", 20, 0.1)
    );
    assert_eq!(part.time_s(), &record.time_s()[10..30]);
    assert_eq!(part.require("y").unwrap().values[0], 10.0);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Stamps with 3 decimals at 610 Hz, from any start, are an even time base.
    #[test]
    fn prop_rounded_stamps_pass(len in 50usize..2000, start in 0.0..1e4f64) {
        let time: Vec<f64> =
            (0..len).map(|k| ((start + k as f64 * 1.6384e-3) * 1e3).round() / 1e3).collect();
        let y = Channel::new("y", "V", vec![0.0; len]);
        prop_assert!(Record::new("rounded", time, vec![y]).is_ok());
    }

    /// What is written reads back to the last bit, whatever the doubles.
    #[test]
    fn prop_written_values_read_back_exactly(
        values in prop::collection::vec(
            any::<f64>().prop_filter("finite", |x| x.is_finite()), 8..40),
        start in -1e6..1e6f64,
        step in 1e-3..10.0f64,
    ) {
        let time: Vec<f64> = (0..values.len()).map(|k| start + k as f64 * step).collect();
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("A.csv");
        let headers = ["t [s]".to_owned(), "a, \"b\" [m]".to_owned()];
        write_csv_atomic(&path, &headers, &[&time, &values]).unwrap();
        let record = read_csv(&path).unwrap();
        prop_assert_eq!(record.time_s(), &time[..]);
        prop_assert_eq!(&record.require("a, \"b\"").unwrap().values, &values);
        prop_assert!((record.time_step_s() / step - 1.0).abs() < 1e-6);
    }

    /// Whatever the bytes, reading ends with a record or an error of one line.
    #[test]
    fn prop_any_bytes_are_read_or_refused_in_one_line(
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        tail in "[-0-9.,;\"\\[\\] \\r\\nets]{0,200}",
    ) {
        for head in ["", "t [s],y [m]\n"] {
            for text in [[head.as_bytes(), &bytes].concat(), format!("{head}{tail}").into_bytes()] {
                if let Err(error) = parse_csv("A.csv", &text[..]) {
                    prop_assert!(!error.to_string().contains(['\n', '\r']), "{}", error);
                }
            }
        }
    }
}

/// Whatever the length, whichever the sample; the middle of the shortest record is the worst.
#[test]
fn verify_one_missing_sample_is_refused() {
    for len in MIN_ROWS..120 {
        for gone in 1..len {
            let time = (0..=len)
                .filter(|&k| k != gone)
                .map(|k| k as f64 * 0.01)
                .collect();
            match Record::new("gap", time, vec![]) {
                Err(RecordError::UnevenTime {
                    at, found, usual, ..
                }) => {
                    assert_eq!(at, Place::Row(gone));
                    assert!((found - 0.02).abs() < 1e-9 && (usual - 0.01).abs() < 1e-9);
                }
                other => panic!("{len} stamps without number {gone}: {other:?}"),
            }
        }
    }
}
