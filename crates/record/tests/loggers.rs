//! Tables of text as loggers write them: every dialect gives the numbers it was made from, and
//! says what was guessed.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use proptest::prelude::*;
use simgap_record::{ChannelMap, Mend, ReadOptions, Reading, RecordError, parse_file, read_file};

const ROWS: usize = 40;

/// What every table here holds, in seconds, kN and mm.
fn row(k: usize) -> [f64; 3] {
    let k = k as f64;
    [0.01 * k, 0.5 * k - 3.0, 1.25 + 0.125 * k * k]
}

/// Rows of cells by a separator, with a point or a comma.
fn rows(separator: &str, comma: bool) -> String {
    let mut text = String::new();
    for k in 0..ROWS {
        let cells = row(k).map(|value| format!("{value:.4}"));
        let line = cells.join(separator);
        let line = if comma { line.replace('.', ",") } else { line };
        writeln!(text, "{line}").unwrap();
    }
    text
}

fn wanted() -> ReadOptions {
    ReadOptions::channels(["u"], ["y"])
}

fn read(text: impl AsRef<[u8]>) -> Reading {
    parse_file("A.txt", text.as_ref(), &wanted()).unwrap()
}

fn refusal(text: impl AsRef<[u8]>, options: &ReadOptions) -> String {
    let error = parse_file("A.txt", text.as_ref(), options).unwrap_err();
    error.to_string()
}

fn notes(reading: &Reading) -> String {
    let notes: Vec<String> = reading.notes.iter().map(ToString::to_string).collect();
    notes.join("\n")
}

/// Values to the printed digits; `start` is subtracted where time counts from the first stamp.
fn assert_holds_the_rows(reading: &Reading, case: &str) {
    let record = &reading.record;
    assert_eq!(record.len(), ROWS, "{case}");
    for k in 0..ROWS {
        let [t, u, y] = row(k);
        // Half of the fourth decimal, which is the last one printed.
        const PRINTED: f64 = 0.6e-4;
        assert!((record.time_s()[k] - t).abs() < PRINTED, "{case}: t {k}");
        let of = |name| record.require(name).unwrap().values[k];
        assert!((of("u") - u).abs() < PRINTED, "{case}: u {k}");
        assert!((of("y") - y).abs() < PRINTED, "{case}: y {k}");
    }
    assert_eq!(record.require("u").unwrap().unit.symbol(), "kN", "{case}");
    assert_eq!(record.require("y").unwrap().unit.symbol(), "mm", "{case}");
}

#[test]
fn verify_dialects_of_loggers_read_the_same() {
    let units = "t [s];u [kN];y [mm]\n";
    let plain = format!("{units}{}", rows(";", true));
    let quoted: String = rows(",", false)
        .lines()
        .map(|l| format!("\"{}\"\n", l.replace(',', "\",\"").replace('.', ",")))
        .collect();
    let cases = [
        ("semicolon", plain.clone()),
        ("semicolon, point", format!("{units}{}", rows(";", false))),
        (
            "tab",
            format!("{}{}", units.replace(';', "\t"), rows("\t", false)),
        ),
        (
            "tab, comma",
            format!("{}{}", units.replace(';', "\t"), rows("\t", true)),
        ),
        ("comma in quotes", format!("t [s],u [kN],y [mm]\n{quoted}")),
        ("units row", format!("t;u;y\ns;kN;mm\n{}", rows(";", true))),
        (
            "units row in brackets",
            format!("t;u;y\n[s];[kN];[mm]\n{}", rows(";", true)),
        ),
        (
            "round brackets",
            format!("t (s);u (kN);y (mm)\n{}", rows(";", true)),
        ),
        ("slash", format!("t / s;u / kN;y / mm\n{}", rows(";", true))),
        ("comment sign", format!("# {units}{}", rows(";", true))),
        (
            "preamble",
            format!("Logger 7\nSerial;12\n\nRate;100;Hz\n{plain}"),
        ),
        (
            "preamble with brackets",
            format!("Runs [all], by [hand], x\n{plain}"),
        ),
        (
            "rule under the header",
            format!("t;u;y\ns;kN;mm\n-----;----;----\n{}", rows(";", true)),
        ),
        ("trailing separators", plain.replace('\n', ";\n")),
        (
            "trailing in rows only",
            format!("{units}{}", rows(";", true).replace('\n', ";\n")),
        ),
        ("CRLF and blank lines", plain.replace('\n', "\r\n\r\n")),
        ("old Macintosh", plain.replace('\n', "\r")),
        ("byte order mark", format!("\u{feff}{plain}")),
        ("end of file of old programs", format!("{plain}\u{1a}")),
        (
            "text beside",
            plain.lines().map(|l| format!("{l};ok\n")).collect(),
        ),
        (
            "commas and points, units row",
            format!("t,u,y\ns,kN,mm\n{}", rows(",", false)),
        ),
    ];
    for (case, text) in cases {
        let reading = parse_file("A.txt", text.as_bytes(), &wanted());
        let reading = reading.unwrap_or_else(|error| panic!("{case}: {error}"));
        assert_holds_the_rows(&reading, case);
        assert!(!reading.notes.is_empty(), "{case}: nothing said");
    }
}

#[test]
fn verify_other_encodings_are_read_and_told() {
    let text = format!(
        "Zeit;u;y;Öl\ns;kN;mm;°C\n{}",
        rows(";", true).replace('\n', ";1\n")
    );
    let le = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>()
    };
    let be = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_be_bytes)
            .collect::<Vec<u8>>()
    };
    let latin: Vec<u8> = text.chars().map(|c| u8::try_from(c).unwrap()).collect();
    let cases = [
        ("UTF-16", [vec![0xff, 0xfe], le(&text)].concat()),
        ("UTF-16", [vec![0xfe, 0xff], be(&text)].concat()),
        ("UTF-16", le(&text)),
        ("UTF-16", be(&text)),
        ("Latin-1", latin),
    ];
    for (encoding, bytes) in cases {
        let reading = read(bytes);
        assert_holds_the_rows(&reading, encoding);
        let told = reading.notes[0].to_string();
        assert_eq!(told, format!("text read as {encoding}, not UTF-8"));
    }
}

#[test]
fn verify_stamps_become_seconds() {
    let stamped = |stamp: &dyn Fn(usize) -> String, head: &str| {
        let mut text = format!("{head};u [kN];y [mm]\n");
        for (k, line) in rows(";", true).lines().enumerate() {
            let (_, rest) = line.split_once(';').unwrap();
            writeln!(text, "{};{rest}", stamp(k)).unwrap();
        }
        text
    };
    let from = |seconds: usize, k: usize| {
        let ms = seconds * 1000 + 10 * k;
        let (m, s, ms) = (ms / 60_000, ms / 1000 % 60, ms % 1000);
        format!("{m:02}:{s:02}.{ms:03}")
    };
    type Stamp<'a> = &'a dyn Fn(usize) -> String;
    let cases: [(&str, Stamp<'_>, &str); 6] = [
        (
            "ISO",
            &|k| format!("2024-02-29T23:{}Z", from(59 * 60 + 59, k % 1000)),
            "Zeit",
        ),
        (
            "german",
            &|k| format!("01.03.2024 12:{}", from(0, k).replace('.', ",")),
            "Datum",
        ),
        (
            "american",
            &|k| format!("3/25/2024 1:{} PM", from(7, k)),
            "When",
        ),
        ("time of day", &|k| format!("12:{}", from(3, k)), "time"),
        (
            "two columns",
            &|k| format!("2024-03-01;12:{}", from(3, k)),
            "Date;Time",
        ),
        (
            "two, time first named",
            &|k| format!("01.03.2024;12:{}", from(3, k)),
            "Tag;t",
        ),
    ];
    let mut told = String::new();
    for (case, stamp, head) in cases {
        let reading = read(stamped(stamp, head));
        assert_holds_the_rows(&reading, case);
        writeln!(told, "{case}: {}", notes(&reading).replace('\n', " | ")).unwrap();
    }
    insta::assert_snapshot!(told);
}

#[test]
fn verify_an_open_order_of_day_and_month_is_told() {
    let mut text = String::from("stamp;u [kN];y [mm]\n");
    for k in 0..ROWS {
        // Every day at noon: both orders rise for the first twelve days of a year only.
        writeln!(text, "1/{}/2024 0:00:00;1,0;2,0", 1 + k % 12).unwrap();
        if k == 11 {
            break;
        }
    }
    let reading = read(&text);
    insta::assert_snapshot!(notes(&reading));
    assert_eq!(reading.record.time_step_s(), 86_400.0);
}

#[test]
fn verify_missing_words_are_filled_and_told() {
    for word in ["NaN", "nan", "-", "", "NULL", "#N/A", "n/a", "---"] {
        let mut text = String::from("t [s];u [kN];y [mm]\n");
        for k in 0..ROWS {
            let [t, u, y] = row(k);
            let gone = k == 0 || (10..13).contains(&k);
            let y = if gone { word.to_owned() } else { y.to_string() };
            writeln!(text, "{t:.4};{u};{y}").unwrap();
        }
        let reading = read(&text);
        let y = &reading.record.require("y").unwrap().values;
        assert_eq!(
            y[0],
            row(1)[2],
            "{word}: the first one is the next there is"
        );
        // A cubic holds a parabola.
        for k in 1..ROWS {
            assert!((y[k] - row(k)[2]).abs() < 1e-11, "{word}: row {k}");
        }
        let told = reading.notes.last().unwrap().to_string();
        assert_eq!(
            told,
            "4 of 40 samples of 'y' are missing, at most 3 in a row; a curve through those \
             beside them stands in their place",
            "{word}"
        );
        let never = wanted().with_mend(Mend::Never);
        let refused = parse_file("A.txt", text.as_bytes(), &never).unwrap_err();
        assert!(
            matches!(refused, RecordError::NotFinite { .. }),
            "{word}: {refused}"
        );
    }
}

#[test]
fn verify_an_uneven_time_base_is_resampled_and_told() {
    // Stamps off the grid by up to 0.45 of a step, and two samples lost.
    let time: Vec<f64> = (0..400)
        .filter(|k| ![100, 101].contains(k))
        .map(|k| 1e-3 * (f64::from(k) + 0.45 * (1.3 * f64::from(k)).sin()))
        .collect();
    let omega = 2.0 * std::f64::consts::PI * 20.0;
    let mut text = String::from("t;y\ns;mm\n");
    for t in &time {
        writeln!(text, "{t};{}", (omega * t).sin()).unwrap();
    }
    let options = ReadOptions::all();
    let reading = parse_file("A.txt", text.as_bytes(), &options).unwrap();
    let record = &reading.record;
    assert!((record.time_step_s() / 1e-3 - 1.0).abs() < 0.02);
    let y = &record.require("y").unwrap().values;
    for (t, y) in record.time_s().iter().zip(y) {
        // 20 Hz is far below the trusted 34 Hz, where 1 % is lost in the longest gap of 3.8 ms.
        assert!((y - (omega * t).sin()).abs() < 0.01, "at {t}: {y}");
    }
    insta::assert_snapshot!(reading.notes.last().unwrap().to_string());
    let never = options.clone().with_mend(Mend::Never);
    let refused = parse_file("A.txt", text.as_bytes(), &never).unwrap_err();
    assert!(
        matches!(refused, RecordError::UnevenTime { .. }),
        "{refused}"
    );
}

#[test]
fn verify_a_map_renames_and_gives_units() {
    let text = format!("Zeit;Kraft;Pos_Mold\n{}", rows(";", true));
    let map = ChannelMap::parse(["u=Kraft [kN]", "y=Pos_Mold [mm]"]).unwrap();
    let reading = parse_file("A.txt", text.as_bytes(), &wanted().with_map(map.clone())).unwrap();
    assert_holds_the_rows(&reading, "wanted");
    let all = parse_file("A.txt", text.as_bytes(), &ReadOptions::all().with_map(map)).unwrap();
    assert_holds_the_rows(&all, "all");
    insta::assert_snapshot!(notes(&reading));
}

#[test]
fn verify_the_contract_stays_strict_unless_asked() {
    let good = format!("t [s],u [kN],y [mm]\n{}", rows(",", false));
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.csv");
    std::fs::write(&path, &good).unwrap();
    let reading = read_file(&path, &wanted()).unwrap();
    assert_holds_the_rows(&reading, "good");
    assert_eq!(reading.notes, []);
    let spoilt = good.replacen("0.0500,-0.5000", "0.0500,NaN", 1);
    assert_ne!(spoilt, good);
    std::fs::write(&path, &spoilt).unwrap();
    let map = || ChannelMap::parse(["y=y"]).unwrap();
    for options in [
        wanted(),
        wanted().with_map(map()),
        wanted().with_mend(Mend::Never),
    ] {
        let refused = read_file(&path, &options).unwrap_err().to_string();
        assert!(
            refused.contains("line 7: column 'u' holds 'NaN'"),
            "{refused}"
        );
    }
    let mended = read_file(&path, &wanted().with_mend(Mend::Always)).unwrap();
    // On the line of its neighbours, where the row that was spoilt lay.
    let filled = mended.record.require("u").unwrap().values[5];
    assert!((filled - row(5)[1]).abs() < 1e-12, "{filled}");
    // A map alone is not a guess to be told about the layout.
    std::fs::write(&path, &good).unwrap();
    let reading = read_file(&path, &wanted().with_map(map())).unwrap();
    assert_eq!(notes(&reading), "'y' read from column 'y'");
}

#[test]
fn verify_what_is_read_whole_leaves_words_out() {
    let text: String = format!("t [s],u [kN],y [mm],state\n{}", rows(",", false))
        .lines()
        .enumerate()
        .map(|(k, l)| {
            if k == 0 {
                format!("{l}\n")
            } else {
                format!("{l},on\n")
            }
        })
        .collect();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.csv");
    std::fs::write(&path, &text).unwrap();
    let reading = read_file(&path, &ReadOptions::all()).unwrap();
    assert_holds_the_rows(&reading, "all");
    assert_eq!(
        notes(&reading),
        "column 'state' left out: its first row holds no number"
    );
}

#[test]
fn regress_messages_about_tables_of_text() {
    let good = format!("t [s];u [kN];y [mm]\n{}", rows(";", true));
    let with = |from: &str, to: &str| {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        text
    };
    let map = |entry| wanted().with_map(ChannelMap::parse([entry]).unwrap());
    let stamped = "t;u;y\n2024-03-01;1;2\n2024-03-02;1;2\n2024-03-03;1;2\n";
    let mut half = String::from("t [s];u;y\n");
    for k in 0..ROWS {
        let cell = if k % 3 == 0 { "" } else { "1,5" };
        writeln!(half, "{k};{cell};0").unwrap();
    }
    let gap = good
        .lines()
        .enumerate()
        .filter(|(k, _)| !(10..30).contains(k));
    let gap: String = gap.map(|(_, l)| format!("{l}\n")).collect();
    let cases = [
        ("nothing", wanted(), String::new()),
        (
            "prose",
            wanted(),
            "Dear all,\nplease find attached\n".to_owned(),
        ),
        ("no header", wanted(), rows(";", true)),
        (
            "commas twice",
            wanted(),
            format!("t,u,y\n{}", rows(",", true)),
        ),
        ("binary", wanted(), "t\u{1}\u{0}\u{2}".to_owned()),
        ("text in a cell", wanted(), with("-0,5000", "off")),
        ("thousands", wanted(), with("-0,5000", "1.234,5")),
        ("short row", wanted(), with("0,0500;", "")),
        ("open quote", wanted(), with("0,0500;", "\"0,0500;")),
        ("no stamp", wanted(), stamped.replace("2024-03-03", "later")),
        (
            "no such day",
            wanted(),
            stamped.replace("2024-03-03", "2024-02-30"),
        ),
        ("no time", wanted(), with("t [s]", "x [m]")),
        ("time in metres", wanted(), with("t [s]", "t [m]")),
        ("column missing", wanted(), with("u [kN]", "uu [kN]")),
        ("column twice", wanted(), with("y [mm]", "u [kN]")),
        (
            "map to nothing",
            map("y=Pos_Mould"),
            with("y [mm]", "Pos_Mold [mm]"),
        ),
        ("map of time to nothing", map("t=Zeit"), good.clone()),
        ("map of time to metres", map("t=y"), good.clone()),
        (
            "a count without a unit",
            wanted(),
            half.replace("t [s]", "t"),
        ),
        ("half of it missing", wanted(), half),
        ("a long gap", wanted(), gap),
        (
            "two rows",
            wanted(),
            good.lines().take(3).collect::<Vec<_>>().join("\n"),
        ),
        ("workbook", wanted(), "PK\u{3}\u{4}xl".to_owned()),
    ];
    let mut table = String::new();
    for (case, options, text) in cases {
        let line = refusal(&text, &options);
        assert!(!line.contains('\n'), "{case}: {line}");
        writeln!(table, "{case}: {line}").unwrap();
    }
    for entry in ["y", "=x", "y=", "y=x []"] {
        writeln!(
            table,
            "map {entry}: {}",
            ChannelMap::parse([entry]).unwrap_err()
        )
        .unwrap();
    }
    let twice = ChannelMap::parse(["y=a", "y=b"]).unwrap_err();
    writeln!(table, "map twice: {twice}").unwrap();
    let stranger = ChannelMap::parse(["force=a"]).unwrap();
    let stranger = stranger.check_channels(&["force_n", "y"]).unwrap_err();
    writeln!(table, "map of a stranger: {stranger}").unwrap();
    insta::assert_snapshot!(table);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the bytes, reading ends with a record or an error of one line.
    #[test]
    fn prop_any_text_is_read_or_refused_in_one_line(
        bytes in prop::collection::vec(any::<u8>(), 0..400),
        tail in "[-0-9.,;:T/\"\\[\\] \\t\\r\\nNaets]{0,300}",
    ) {
        let table = format!("t;y\n0,1;2\n{tail}");
        for text in [&bytes[..], tail.as_bytes(), table.as_bytes()] {
            for options in [ReadOptions::all(), wanted()] {
                if let Err(error) = parse_file("A.txt", text, &options) {
                    prop_assert!(!error.to_string().contains(['\n', '\r']), "{}", error);
                }
            }
        }
    }

    /// A dialect with any decimals in any cell reads back to what was written.
    #[test]
    fn prop_values_survive_every_dialect(
        values in prop::collection::vec(-1e6..1e6f64, 8..40),
        separator in prop::sample::select(vec![';', '\t']),
        comma in any::<bool>(),
    ) {
        let mut text = format!("t [s]{separator}y [mm]\n");
        for (k, value) in values.iter().enumerate() {
            let line = format!("{k}.5{separator}{value}\n");
            text += &if comma { line.replace('.', ",") } else { line };
        }
        let reading = parse_file("A.txt", text.as_bytes(), &ReadOptions::all()).unwrap();
        prop_assert_eq!(&reading.record.require("y").unwrap().values, &values);
    }
}
