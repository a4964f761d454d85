//! Every message, word by word: one clear line with what was found, where, and what is needed.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use simgap_record::{
    Channel, MAX_LINE_BYTES, MAX_ROWS, Quantity, Record, RecordError, ensure_writable_dir,
    parse_csv, read_csv, write_csv_atomic, write_text_atomic,
};

/// Ten good rows under a header of two columns: lines 2 to 11.
fn good() -> Vec<String> {
    let rows = (0..10).map(|k| format!("0.{k},{k}.5"));
    std::iter::once("t [s],y [m]".to_owned())
        .chain(rows)
        .collect()
}

/// The file above with one line (counted from 1) replaced.
fn with_line(line: usize, text: &str) -> Vec<u8> {
    let mut lines = good();
    lines[line - 1] = text.to_owned();
    lines.join("\n").into_bytes()
}

fn message_of(text: &[u8]) -> String {
    parse_csv("A.csv", text).unwrap_err().to_string()
}

fn table(cases: &[(&str, Vec<u8>)]) -> String {
    cases.iter().fold(String::new(), |mut table, (case, text)| {
        writeln!(table, "{case}: {}", message_of(text)).unwrap();
        table
    })
}

#[test]
fn regress_messages_about_the_whole_file() {
    let cases = [
        ("empty", vec![]),
        ("blank", b"\n \n\r\n".to_vec()),
        ("header only", b"t [s],y [m]\n".to_vec()),
        ("two rows", good()[..3].join("\n").into_bytes()),
        ("UTF-16", b"\xff\xfet\0 \0[\0s\0]\0".to_vec()),
        (
            "Latin-1",
            with_line(4, "0.2,2.5 \u{e9}")
                .iter()
                .map(|&b| if b > 127 { 0xe9 } else { b })
                .collect(),
        ),
        (
            "semicolons",
            good().join("\n").replace(',', ";").into_bytes(),
        ),
        ("tabs", good().join("\n").replace(',', "\t").into_bytes()),
        ("old Macintosh", good().join("\r").into_bytes()),
    ];
    insta::assert_snapshot!(table(&cases), @r"
    empty: A.csv: the file is empty, but a header such as 't [s],u [N],y [m]' and at least 8 rows are needed
    blank: A.csv: the file is empty, but a header such as 't [s],u [N],y [m]' and at least 8 rows are needed
    header only: A.csv: 0 row(s) of data found, but at least 8 are needed
    two rows: A.csv: 2 row(s) of data found, but at least 8 are needed
    UTF-16: A.csv: line 1: not UTF-8 text; save the file as CSV in UTF-8
    Latin-1: A.csv: line 4: not UTF-8 text; save the file as CSV in UTF-8
    semicolons: A.csv: line 1: semicolons found, but commas are needed (and a point as decimal sign)
    tabs: A.csv: line 1: tabs found, but commas are needed (and a point as decimal sign)
    old Macintosh: A.csv: line 1: carriage returns alone at the ends of lines found, but line feeds are needed (and a point as decimal sign)
    ");
}

#[test]
fn regress_messages_about_the_header() {
    let cases = [
        ("no unit", with_line(1, "t [s],y")),
        ("empty unit", with_line(1, "t [s],y []")),
        ("no name", with_line(1, "t [s],[m]")),
        ("no header at all", with_line(1, "0.0,1.0")),
        ("time without unit", with_line(1, "t,y [m]")),
        ("time in metres", with_line(1, "t [m],y [m]")),
        ("no time", with_line(1, "x [m],y [m]")),
        ("twice", with_line(1, "t [s],y [m],u [N],y [mm]")),
        ("open quote", with_line(1, "t [s],\"y [m]")),
    ];
    insta::assert_snapshot!(table(&cases), @r#"
    no unit: A.csv: line 1: column 2 is headed 'y', but a name and a unit in brackets are needed, such as 'y [mm]' ('y [-]' if it has none)
    empty unit: A.csv: line 1: column 2 is headed 'y []', but a name and a unit in brackets are needed, such as 'y [mm]' ('y [-]' if it has none)
    no name: A.csv: line 1: column 2 is headed '[m]', but a name and a unit in brackets are needed, such as 'y [mm]' ('y [-]' if it has none)
    no header at all: A.csv: line 1: no time column found among '0.0', '1.0'; a column 't [s]' or 'time [s]' is needed, or the name of another one, with --map "t=COLUMN [s]"
    time without unit: A.csv: line 1: column 1 is headed 't', but a name and a unit in brackets are needed, such as 'y [mm]' ('y [-]' if it has none)
    time in metres: A.csv: line 1: time column 't' is in [m], but s, ms, us or min is needed
    no time: A.csv: line 1: no time column found among 'x [m]', 'y [m]'; a column 't [s]' or 'time [s]' is needed, or the name of another one, with --map "t=COLUMN [s]"
    twice: A.csv: line 1: columns 2 and 4 are both named 'y'; names must differ
    open quote: A.csv: line 1: a quotation mark is not closed on this line
    "#);
}

#[test]
fn regress_messages_about_cells() {
    let long = format!("0.4,{}", "x".repeat(100));
    let cases = [
        ("text", with_line(6, "0.4,sensor off")),
        ("long text", with_line(6, &long)),
        ("quoted decimal comma", with_line(6, "0.4,\"4,5\"")),
        ("bare decimal comma", with_line(6, "0.4,4,5")),
        ("missing", with_line(6, "0.4, ")),
        ("too few", with_line(6, "0.4")),
        ("too many", with_line(6, "0.4,4.5,")),
        ("shifted by a remark", with_line(6, "remark,0.4,4.5")),
        ("NaN", with_line(6, "0.4,NaN")),
        ("infinite", with_line(6, "0.4,-inf")),
        ("too large", with_line(6, "0.4,1e999")),
        ("time is text", with_line(6, "now,4.5")),
        ("open quote", with_line(6, "0.4,\"4.5")),
        (
            "after CRLF",
            String::from_utf8(with_line(6, "0.4,?"))
                .unwrap()
                .replace('\n', "\r\n")
                .into_bytes(),
        ),
        (
            "after blank lines",
            String::from_utf8(with_line(6, "0.4,?"))
                .unwrap()
                .replace("\n0.1,", "\n\n\n0.1,")
                .into_bytes(),
        ),
    ];
    insta::assert_snapshot!(table(&cases), @r"
    text: A.csv: line 6: column 'y' holds 'sensor off', but a number is needed
    long text: A.csv: line 6: column 'y' holds 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx…', but a number is needed
    quoted decimal comma: A.csv: line 6: column 'y' holds '4,5', but a number is needed
    bare decimal comma: A.csv: line 6: 3 cells found, but the header has 2
    missing: A.csv: line 6: column 'y' is empty, but a number is needed; --mend takes it as missing
    too few: A.csv: line 6: 1 cells found, but the header has 2
    too many: A.csv: line 6: 3 cells found, but the header has 2
    shifted by a remark: A.csv: line 6: 3 cells found, but the header has 2
    NaN: A.csv: line 6: column 'y' holds 'NaN', but a finite number is needed; --mend takes it as missing
    infinite: A.csv: line 6: column 'y' holds '-inf', but a finite number is needed
    too large: A.csv: line 6: column 'y' holds '1e999', but a finite number is needed
    time is text: A.csv: line 6: column 't' holds 'now', but a number is needed
    open quote: A.csv: line 6: a quotation mark is not closed on this line
    after CRLF: A.csv: line 6: column 'y' holds '?', but a number is needed
    after blank lines: A.csv: line 8: column 'y' holds '?', but a number is needed
    ");
}

#[test]
fn regress_messages_about_time() {
    let text = |line, row| String::from_utf8(with_line(line, row)).unwrap();
    let cases = [
        ("repeated", with_line(6, "0.3,4.5")),
        ("reversed", with_line(6, "0.25,4.5")),
        (
            "gap",
            good().join("\n").replace("\n0.4,4.5", "").into_bytes(),
        ),
        ("jitter", with_line(6, "0.45,4.5")),
        (
            "gap after blank lines",
            text(6, "").replace("\n0.1,", "\n\n\n0.1,").into_bytes(),
        ),
        (
            "milliseconds",
            good()
                .join("\n")
                .replace("[s]", "[ms]")
                .replace("\n0.4,4.5", "")
                .into_bytes(),
        ),
    ];
    insta::assert_snapshot!(table(&cases), @r"
    repeated: A.csv: line 6: time goes from 0.3 s to 0.3 s, but every stamp must be later than the one before (repeated stamps often have too few decimals)
    reversed: A.csv: line 6: time goes from 0.3 s to 0.25 s, but every stamp must be later than the one before (repeated stamps often have too few decimals)
    gap: A.csv: line 6: the time step is 0.2 s here and 0.1 s elsewhere, but even spacing is needed (stamps off a uniform grid by no more than their rounding, and 0.33 of a step); --mend resamples to an even step, or split the record
    jitter: A.csv: line 6: the time step is 0.15 s here and 0.1 s elsewhere, but even spacing is needed (stamps off a uniform grid by no more than their rounding, and 0.33 of a step); --mend resamples to an even step, or split the record
    gap after blank lines: A.csv: line 9: the time step is 0.2 s here and 0.1 s elsewhere, but even spacing is needed (stamps off a uniform grid by no more than their rounding, and 0.33 of a step); --mend resamples to an even step, or split the record
    milliseconds: A.csv: line 6: the time step is 0.0002 s here and 0.0001 s elsewhere, but even spacing is needed (stamps off a uniform grid by no more than their rounding, and 0.33 of a step); --mend resamples to an even step, or split the record
    ");
}

#[test]
fn verify_limits_stop_the_reading() {
    let long = "1".repeat(MAX_LINE_BYTES);
    let message = message_of(format!("t [s],y [m]\n0,{long}\n").as_bytes());
    insta::assert_snapshot!(message, @r"A.csv: line 2: longer than 1048576 bytes, which is the limit; one row of numbers per line is needed");
    // An endless file: the reader must stop by itself.
    let mut endless = EndlessRows {
        header: b"t [s]\n",
        row: 0,
    };
    let message = parse_csv("A.csv", &mut endless).unwrap_err().to_string();
    insta::assert_snapshot!(message, @r"A.csv: more than 5000000 rows found, which is the limit; split the record or lower its sample rate");
    assert_eq!(endless.row, MAX_ROWS as u64 + 1);
    let too_long = vec![0.0; MAX_ROWS + 1];
    assert!(matches!(
        Record::new("A", too_long, vec![]),
        Err(RecordError::TooManyRows { .. })
    ));
}

/// Rows without end, a line per call.
struct EndlessRows {
    header: &'static [u8],
    row: u64,
}

impl std::io::Read for EndlessRows {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let line = if self.header.is_empty() {
            self.row += 1;
            format!("{}\n", self.row).into_bytes()
        } else {
            std::mem::take(&mut self.header).to_vec()
        };
        buffer[..line.len()].copy_from_slice(&line);
        Ok(line.len())
    }
}

#[test]
fn regress_messages_about_records_made_in_memory() {
    let time = |len: usize| (0..len).map(|k| k as f64).collect::<Vec<f64>>();
    let channel = |name: &str, unit: &str, values| Channel::new(name, unit, values);
    let mut spoilt = time(10);
    spoilt[4] = f64::NAN;
    let made = |time, channels| {
        Record::new("generated", time, channels)
            .unwrap_err()
            .to_string()
    };
    let record = Record::new(
        "C.csv",
        time(10),
        vec![channel("y", "bar", time(10)), channel("u", "N", time(10))],
    )
    .unwrap();
    let lines = [
        made(time(3), vec![]),
        made(time(10), vec![channel("y", "m", time(9))]),
        made(time(10), vec![channel("y", "m", spoilt.clone())]),
        made(spoilt, vec![]),
        made(
            time(10),
            vec![channel("y", "m", time(10)), channel("y", "m", time(10))],
        ),
        made(time(10).into_iter().rev().collect(), vec![]),
        Record::from_uniform("generated", 0.0, -1.0, vec![])
            .unwrap_err()
            .to_string(),
        Record::from_uniform("generated", 0.0, 1.0, vec![])
            .unwrap_err()
            .to_string(),
        record.slice(5..12).unwrap_err().to_string(),
        record.slice(1..4).unwrap_err().to_string(),
        record.require("x").unwrap_err().to_string(),
        record
            .require("y")
            .unwrap()
            .si_values(Quantity::Force)
            .unwrap_err()
            .to_string(),
        record
            .si_values("u", Quantity::Displacement)
            .unwrap_err()
            .to_string(),
        record
            .si_values("u", Quantity::Velocity)
            .unwrap_err()
            .to_string(),
        record
            .si_values("u", Quantity::Acceleration)
            .unwrap_err()
            .to_string(),
    ];
    insta::assert_snapshot!(lines.join("\n"), @r"
    generated: 3 row(s) of data found, but at least 8 are needed
    generated: column 'y' has 9 values, but there are 10 time stamps
    generated: row 4: column 'y' holds 'NaN', but a finite number is needed
    generated: row 4: column 't' holds 'NaN', but a finite number is needed
    generated: names: columns 1 and 2 are both named 'y'; names must differ
    generated: row 1: time goes from 9 s to 8 s, but every stamp must be later than the one before (repeated stamps often have too few decimals)
    generated: a start of 0 s and a step of -1 s found, but a finite start and a finite positive step are needed
    generated: 0 row(s) of data found, but at least 8 are needed
    C.csv: rows 5 to 12 asked for, but the record has 10
    C.csv: 3 row(s) of data found, but at least 8 are needed
    C.csv: column 'x' is needed, but the file has 'y', 'u'
    column 'y' is in [bar], which is a pressure, but a force is needed (N, kN, lbf or N m), or a gain in the model
    C.csv: column 'u' is in [N], which is a force, but a displacement is needed (m, mm, um, rad or deg), or a gain in the model
    C.csv: column 'u' is in [N], which is a force, but a velocity is needed (m/s, mm/s, rad/s, deg/s or rpm), or a gain in the model
    C.csv: column 'u' is in [N], which is a force, but an acceleration is needed (m/s^2, mm/s^2, g, rad/s^2 or deg/s^2), or a gain in the model
    ");
}

#[test]
fn regress_messages_about_files_and_directories() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    write_text_atomic(&at("A.csv"), &good()[..3].join("\n")).unwrap();
    let y: &[f64] = &[1.0, f64::INFINITY];
    let headers = ["t [s]".to_owned(), "y [m]".to_owned()];
    let lines = [
        read_csv(&at("missing.csv")).unwrap_err(),
        read_csv(dir.path()).unwrap_err(),
        read_csv(&at("A.csv")).unwrap_err(),
        read_csv(&at("A.csv").join("B.csv")).unwrap_err(),
        ensure_writable_dir(&at("A.csv")).unwrap_err(),
        ensure_writable_dir(&at("A.csv").join("out")).unwrap_err(),
        write_text_atomic(&at("none").join("a.txt"), "a").unwrap_err(),
        write_csv_atomic(&at("B.csv"), &headers, &[y]).unwrap_err(),
        write_csv_atomic(&at("B.csv"), &headers, &[y, &y[..1]]).unwrap_err(),
        write_csv_atomic(&at("B.csv"), &headers[..1], &[y]).unwrap_err(),
    ]
    .map(|error| {
        error
            .to_string()
            .replace(&dir.path().display().to_string(), "DIR")
    });
    insta::assert_snapshot!(lines.join("\n"), @r"
    DIR/missing.csv: no such file
    DIR: is a directory, but a file is needed
    DIR/A.csv: 2 row(s) of data found, but at least 8 are needed
    DIR/A.csv/B.csv: cannot be read: Not a directory (os error 20)
    DIR/A.csv: is a file, but a directory is needed
    DIR/A.csv/out: cannot be written: Not a directory (os error 20)
    DIR/none/a.txt: cannot be written: entity not found
    DIR/B.csv: 2 headers given for 1 columns to be written
    DIR/B.csv: column 'y [m]' has 1 values, but there are 2 time stamps
    DIR/B.csv: row 1: column 't [s]' holds 'inf', but a finite number is needed
    ");
    assert!(!at("B.csv").exists(), "nothing is written after an error");
}

#[test]
fn verify_a_write_replaces_whole_files_and_leaves_nothing_beside() {
    let dir = tempfile::tempdir().unwrap();
    let inner = dir.path().join("a").join("b");
    ensure_writable_dir(&inner).unwrap();
    ensure_writable_dir(&inner).unwrap();
    let path = inner.join("x.txt");
    write_text_atomic(&path, "a long first text").unwrap();
    write_text_atomic(&path, "second").unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "second");
    // A directory in the way of the file: the error leaves no part file behind.
    std::fs::create_dir(inner.join("taken")).unwrap();
    write_text_atomic(&inner.join("taken"), "third").unwrap_err();
    let mut left: Vec<String> = std::fs::read_dir(&inner)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    left.sort();
    assert_eq!(left, ["taken", "x.txt"]);
}

#[cfg(unix)]
#[test]
fn verify_results_are_readable_by_others_as_the_umask_allows() {
    use std::os::unix::fs::PermissionsExt as _;
    let dir = tempfile::tempdir().unwrap();
    let (ours, plain) = (dir.path().join("ours"), dir.path().join("plain"));
    write_text_atomic(&ours, "a").unwrap();
    std::fs::write(&plain, "a").unwrap();
    let mode = |path| std::fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(ours), mode(plain));
}
