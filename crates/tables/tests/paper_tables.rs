//! The published numbers, and the seal on them.
#![allow(clippy::unwrap_used)]

use simgap_tables::{
    CHECKSUMS, HarmonicList, PrintedValue, Source, Table1, Table3, Table5, TableError, Unit,
    fixture_checksum, stated_values, table1, table2, table3, table4, table5, verify_checksums,
};

#[test]
fn verify_checksum_seal() {
    assert_eq!(verify_checksums(), Ok(()));
}

#[test]
fn verify_checksum_sees_every_digit() {
    let text = include_str!("../fixtures/table4.toml");
    let sealed = CHECKSUMS[3].1;
    assert_eq!(fixture_checksum(text), sealed);
    let digits = text
        .bytes()
        .enumerate()
        .filter(|(_, byte)| byte.is_ascii_digit());
    for (at, byte) in digits {
        let mut changed = text.as_bytes().to_vec();
        changed[at] = b'0' + (byte - b'0' + 1) % 10;
        let changed = String::from_utf8(changed).unwrap();
        assert_ne!(fixture_checksum(&changed), sealed, "digit at byte {at}");
    }
}

#[test]
fn val_park_table1() {
    let table = table1().unwrap();
    assert_eq!(table.mass.si(), 33_000.0);
    assert_eq!(table.mass.unit(), Unit::Ton);
    assert_eq!(table.damping_ratio.value(), 0.3);
    assert_eq!(table.stiffness.printed(), "8,287,639");
    assert_eq!(table.stiffness.si(), 8_287_639.0);
}

#[test]
fn val_park_table2() {
    let table = table2().unwrap();
    assert_eq!(table.rows.len(), 7);
    for (row, f) in table.rows.iter().zip(1..) {
        let f = f64::from(f);
        assert_eq!(row.excitation.si(), f);
        assert!(row.pressure_high.is_none());
        assert_eq!(row.displacement_high.as_ref().unwrap().si(), 50.0 - f);
        let step = if f == 1.0 { 2.0 } else { f };
        let expected: Vec<f64> = (0..6).map(|n| f + step * f64::from(n)).collect();
        assert_eq!(row.pressure.lines_hz(), expected);
        assert_eq!(row.displacement.lines_hz(), expected);
        assert!(row.pressure.goes_on());
    }
    assert_eq!(table.rows[0].pressure.printed(), "1/3/5/7/9/11...");
}

#[test]
fn val_park_table3() {
    let table = table3().unwrap();
    let centre: Vec<&str> = table.rows.iter().map(|row| row.centre.printed()).collect();
    assert_eq!(
        centre,
        [
            "-10135.53",
            "-10199.31",
            "-10159.95",
            "-10198.77",
            "-10255.62",
            "-10252.26"
        ]
    );
    let stroke: Vec<f64> = table.rows.iter().map(|row| row.peak_to_peak.si()).collect();
    assert_eq!(
        stroke,
        [4191.30, 7190.19, 10345.57, 11968.35, 59333.70, 5301.57]
    );
    assert!(
        table
            .rows
            .iter()
            .all(|row| row.base.si() == row.excitation.si())
    );
}

#[test]
fn val_park_table4() {
    let table = table4().unwrap();
    let amplitude: Vec<f64> = table.rows.iter().map(|row| row.amplitude.si()).collect();
    assert_eq!(
        amplitude,
        [
            75236.49, 138166.37, 207682.21, 302004.08, 352677.60, 400450.39
        ]
    );
    let base: Vec<f64> = table.rows.iter().map(|row| row.base.si()).collect();
    assert_eq!(base, [97.94, 95.92, 94.0, 91.9, 89.9, 88.12]);
    assert!(
        table
            .rows
            .iter()
            .all(|row| row.split.si() == 2.0 * row.excitation.si())
    );
}

#[test]
fn val_park_table5() {
    let table = table5().unwrap();
    assert_eq!(table.mold_stiffness.printed(), "3,300,000,000");
    let leaf: Vec<&str> = table
        .rows
        .iter()
        .map(|row| row.leaf_stiffness.printed())
        .collect();
    assert_eq!(
        leaf,
        [
            "70,815,413.66",
            "120,815,413.7",
            "175,815,413.7",
            "230,815,413.7",
            "290,815,413.7",
            "350,815,413.7"
        ]
    );
    let support: Vec<f64> = table
        .rows
        .iter()
        .map(|row| row.support_stiffness.si())
        .collect();
    assert_eq!(support, [680e6, 600e6, 540e6, 470e6, 410e6, 340e6]);
}

#[test]
fn val_park_stated_values() {
    let stated = stated_values().unwrap();
    assert_eq!(stated.first_natural_freq.printed(), "2.499");
    assert_eq!(stated.weight_equivalent.si(), 1035.5);
    assert_eq!(stated.amplitude.si(), 0.002);
    assert_eq!(stated.time_step.si(), 0.01);
    assert_eq!(
        (stated.mold_mass.si(), stated.support_mass.si()),
        (33_000.0, 7_000.0)
    );
    assert_eq!(stated.image_base.si(), 50.0);
    assert_eq!(stated.all().len(), 27);
    let lines: Vec<[f64; 3]> = stated
        .lines
        .iter()
        .map(|row| [row.excitation_hz, row.lower.si(), row.upper.si()])
        .collect();
    let expected = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|f| [f, 50.0 - f, 50.0 + f]);
    assert_eq!(lines, expected);
    assert_eq!(
        stated.first_natural_freq.source().to_string(),
        "section 3.1: First natural frequency in the pressure spectrum"
    );
}

#[test]
fn verify_errors_say_what_is_needed_and_where() {
    let message = |error: TableError| error.to_string();
    let text = include_str!("../fixtures/table1.toml");

    let not_a_number = text.replace("8,287,639", "8.287.639");
    assert_eq!(
        message(Table1::parse("t.toml", &not_a_number).unwrap_err()),
        "Table 1, row K: Total stiffness, column Value (section 2.1.1): found \"8.287.639\", need a number"
    );
    let other_unit = text.replace("unit = \"ton\"", "unit = \"lb\"");
    assert_eq!(
        message(Table1::parse("t.toml", &other_unit).unwrap_err()),
        "Table 1, row M: Mass, column Value (section 2.1.1): unknown unit \"lb\""
    );
    let missing = text.replace("row = \"M: Mass\"", "row = \"m\"");
    assert_eq!(
        message(Table1::parse("t.toml", &missing).unwrap_err()),
        "t.toml: no value for row M: Mass, column Value"
    );
    let twice = text.replace("row = \"zeta: Damping ratio\"", "row = \"M: Mass\"");
    assert_eq!(
        message(Table1::parse("t.toml", &twice).unwrap_err()),
        "t.toml: row M: Mass, column Value is given more than once"
    );
    assert_eq!(
        message(Table3::parse("t.toml", text).unwrap_err()),
        "t.toml: the file says table 1, need 3"
    );
    let schema = text.replace("table/1", "table/2");
    assert_eq!(
        message(Table1::parse("t.toml", &schema).unwrap_err()),
        "t.toml: found schema \"simgap-paper-table/2\", need \"simgap-paper-table/1\""
    );
    assert!(matches!(
        Table5::parse("t.toml", "x").unwrap_err(),
        TableError::Layout { .. }
    ));
}

#[test]
fn verify_printed_numbers_reject_what_is_not_finite() {
    let source = || Source::Text {
        section: "1".into(),
        meaning: "test".into(),
    };
    for bad in ["", "NaN", "inf", "1e999", "one"] {
        assert!(
            PrintedValue::new(bad, Unit::Newton, source()).is_err(),
            "{bad}"
        );
    }
    assert!(HarmonicList::new("1/2/x...", source()).is_err());
    let closed = HarmonicList::new("1/2", source()).unwrap();
    assert!(!closed.goes_on());
}
