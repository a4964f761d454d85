//! Files of measurement programs, written by the formats' own tools (`fixtures/records`), against
//! the closed form that they hold.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::PI;
use std::path::PathBuf;

use simgap_record::{ChannelMap, Format, ReadOptions, Reading, parse_file, read_file};

const ROWS: usize = 200;
const STEP_S: f64 = 0.005;
/// A double that went through a file of doubles.
const EXACT: f64 = 1e-15;
/// Eleven decimals of a mantissa are printed, or values are of single precision.
const PRINTED: f64 = 1e-11;
const SINGLE: f64 = 2e-7;
/// Five decimals of a mantissa are printed.
const SHORT: f64 = 1e-5;

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/records")
        .join(name)
}

fn read(name: &str, map: &[&str]) -> Reading {
    let map = ChannelMap::parse(map).unwrap();
    let options = ReadOptions::channels(["u", "y"], [""; 0]).with_map(map);
    read_file(&path(name), &options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn force(t: f64) -> f64 {
    1.5 * (2.0 * PI * 3.0 * t).sin()
}

fn travel(t: f64) -> f64 {
    2.0 * (-t).exp() * (2.0 * PI * 5.0 * t).cos()
}

/// Values against the closed form, relative to their largest.
fn assert_holds_the_motion(reading: &Reading, name: &str, tolerance: f64) {
    assert_holds_the_motion_but(reading, name, tolerance, None);
}

/// The same with a lost sample of the travel, in whose place a cubic stands: at one of five even points its error is
/// h⁴ y⁗ / 6, and y⁗ about 2 ω⁴ at most.
fn assert_holds_the_motion_but(reading: &Reading, name: &str, tolerance: f64, lost: Option<usize>) {
    let record = &reading.record;
    assert_eq!(record.len(), ROWS, "{name}");
    let (u, y) = (record.require("u").unwrap(), record.require("y").unwrap());
    for k in 0..ROWS {
        let t = k as f64 * STEP_S;
        assert!(
            (record.time_s()[k] - t).abs() < SHORT * STEP_S,
            "{name}: t {k}"
        );
        assert!(
            (u.values[k] - force(t)).abs() < 1.5 * tolerance,
            "{name}: u {k}"
        );
        let filled = f64::from(lost == Some(k));
        let of_cubic = 2.0 * (2.0 * PI * 5.0 * STEP_S).powi(4) / 6.0;
        assert!(
            (y.values[k] - travel(t)).abs() < 2.0 * tolerance + filled * of_cubic,
            "{name}: y {k}"
        );
    }
    assert_eq!((u.unit.symbol(), y.unit.symbol()), ("kN", "mm"), "{name}");
}

fn notes(reading: &Reading) -> String {
    let notes: Vec<String> = reading.notes.iter().map(ToString::to_string).collect();
    notes.join("\n")
}

#[test]
fn val_scipy_workspaces_hold_the_motion() {
    for name in ["vectors.mat", "vectors-compressed.mat"] {
        let reading = read(name, &["u=u [kN]", "y=y [mm]"]);
        assert_holds_the_motion(&reading, name, EXACT);
    }
    let reading = read("struct.mat", &["u=Kraft [kN]", "y=Weg [mm]"]);
    assert_holds_the_motion(&reading, "struct.mat", SINGLE);
    insta::assert_snapshot!(notes(&reading), @r"
    time column 'time' has no unit; seconds assumed
    'u' read from column 'Kraft' in [kN], which the map gives
    'y' read from column 'Weg' in [mm], which the map gives
    ");
    let reading = read("matrix.mat", &["u=data(:,2) [kN]", "y=data(:,3) [mm]"]);
    assert_holds_the_motion(&reading, "matrix.mat", EXACT);
    insta::assert_snapshot!(notes(&reading), @r"
    column 'data(:,1)' taken as time: no name tells the time base, and it rises evenly
    time column 'data(:,1)' has no unit; seconds assumed
    'u' read from column 'data(:,2)' in [kN], which the map gives
    'y' read from column 'data(:,3)' in [mm], which the map gives
    ");
    let map = ["t=data(:,1) [s]", "u=data(:,2) [kN]", "y=data(:,3) [mm]"];
    assert_holds_the_motion(&read("matrix.mat", &map), "matrix.mat, mapped", EXACT);
}

#[test]
fn val_pyuff_functions_hold_the_motion() {
    let cases = [
        ("ascii.uff", PRINTED),
        ("binary.uff", EXACT),
        ("single.uff", SHORT),
        ("pairs.uff", PRINTED),
    ];
    for (name, tolerance) in cases {
        let reading = read(name, &["u=Kraft", "y=Weg"]);
        assert_holds_the_motion(&reading, name, tolerance);
    }
}

#[test]
fn val_nptdms_waveforms_hold_the_motion() {
    let reading = read("waveform.tdms", &["u=Kraft", "y=Weg"]);
    assert_holds_the_motion(&reading, "waveform.tdms", SINGLE);
}

#[cfg(feature = "parquet")]
#[test]
fn val_pyarrow_tables_hold_the_motion() {
    let map = ["u=u", "y=y"];
    let reading = read("snappy.parquet", &map);
    assert_holds_the_motion_but(&reading, "snappy.parquet", SINGLE, Some(50));
    insta::assert_snapshot!(notes(&reading), @r"
    column 'state' left out: it holds text
    'u' read from column 'u'
    'y' read from column 'y'
    1 of 200 samples of 'y' are missing, at most 1 in a row; a curve through those beside them stands in their place
    ");
    // Pages of the second version, several groups of rows, other encodings.
    let reading = read("gzip.parquet", &map);
    assert_holds_the_motion(&reading, "gzip.parquet", EXACT);
    let all = read_file(&path("gzip.parquet"), &ReadOptions::all()).unwrap();
    let count = &all.record.require("count").unwrap().values;
    assert!((0..ROWS).all(|k| count[k] == k as f64));
}

#[cfg(feature = "parquet")]
#[test]
fn val_pandas_stamps_become_time() {
    let reading = read("stamps.parquet", &["u=u [kN]", "y=y [mm]"]);
    assert_holds_the_motion(&reading, "stamps.parquet", EXACT);
    insta::assert_snapshot!(notes(&reading), @r"
    time read from 'logged at' as timestamps, counted from 2024-02-29 23:59:59.500000000
    column 'logged at' taken as time: it is the only one in a unit of time
    'u' read from column 'u' in [kN], which the map gives
    'y' read from column 'y' in [mm], which the map gives
    ");
}

#[cfg(feature = "matlab73")]
#[test]
fn val_h5py_and_hdf5storage_workspaces_hold_the_motion() {
    let reading = read("matlab73.mat", &["u=u [kN]", "y=y [mm]"]);
    assert_holds_the_motion(&reading, "matlab73.mat", EXACT);
    let reading = read("struct73.mat", &["u=Kraft [kN]", "y=Weg [mm]"]);
    assert_holds_the_motion(&reading, "struct73.mat", SINGLE);
    insta::assert_snapshot!(notes(&reading), @r"
    column 'fs' taken as time: it is the only word on time in the file, and names the sampling
    'u' read from column 'Kraft' in [kN], which the map gives
    'y' read from column 'Weg' in [mm], which the map gives
    ");
    let reading = read("struct73.mat", &["u=data(:,1) [kN]", "y=data(:,2) [mm]"]);
    assert_holds_the_motion(&reading, "struct73.mat, matrix", EXACT);
    let reading = read("plain.h5", &["u=Kraft", "y=Weg"]);
    assert_holds_the_motion(&reading, "plain.h5", EXACT);
    let map = ["t=table(:,1) [s]", "u=table(:,2) [kN]", "y=table(:,3) [mm]"];
    assert_holds_the_motion(&read("plain.h5", &map), "plain.h5, table", EXACT);
}

#[test]
fn verify_the_bytes_tell_the_format_and_not_the_name() {
    let dir = tempfile::tempdir().unwrap();
    for (name, map) in [
        ("vectors.mat", ["u=u [kN]", "y=y [mm]"]),
        ("binary.uff", ["u=Kraft", "y=Weg"]),
        ("waveform.tdms", ["u=Kraft", "y=Weg"]),
    ] {
        let disguised = dir.path().join("run.csv");
        std::fs::copy(path(name), &disguised).unwrap();
        let options = ReadOptions::all().with_map(ChannelMap::parse(map).unwrap());
        let reading = read_file(&disguised, &options).unwrap();
        assert_holds_the_motion(&reading, name, SINGLE);
    }
    let head = |name: &str| std::fs::read(path(name)).unwrap();
    for (name, format) in [
        ("snappy.parquet", Format::Parquet),
        ("matlab73.mat", Format::Hdf5),
        ("plain.mf4", Format::Mdf),
        ("level4.mat", Format::Mat5),
    ] {
        assert_eq!(Format::of(&head(name), &path(name)), format, "{name}");
    }
}

#[test]
fn regress_messages_about_files_of_programs() {
    let bytes = |name: &str| std::fs::read(path(name)).unwrap();
    let cut = |name: &str, length: usize| bytes(name)[..length].to_vec();
    let claimed = |name: &str, at: usize, claim: &[u8]| {
        let mut bytes = bytes(name);
        bytes[at..at + claim.len()].copy_from_slice(claim);
        bytes
    };
    let cases = [
        ("level4.mat", bytes("level4.mat")),
        ("header.mat", cut("vectors.mat", 100)),
        ("cut.mat", cut("vectors.mat", 1000)),
        ("packed.mat", cut("vectors-compressed.mat", 1000)),
        ("claim.mat", claimed("vectors.mat", 132, &[0xff; 4])),
        ("nothing.mat", cut("vectors.mat", 128)),
        ("cut.uff", cut("ascii.uff", 3000)),
        ("short.uff", cut("ascii.uff", 300)),
        ("binary.uff", cut("binary.uff", 1500)),
        ("claim.uff", claimed("binary.uff", 38, b"999999999999")),
        ("empty.uff", b"    -1\n   151\n    -1\n".to_vec()),
        ("cut.tdms", cut("waveform.tdms", 1000)),
        ("head.tdms", cut("waveform.tdms", 20)),
        ("claim.tdms", claimed("waveform.tdms", 12, &[0xee; 8])),
        ("index.tdms", [b"TDSh", &[0; 40][..]].concat()),
        ("run.gz", b"\x1f\x8b\x08".to_vec()),
    ];
    let mut table = String::new();
    for (name, bytes) in cases {
        let error = parse_file(name, &bytes, &ReadOptions::all()).unwrap_err();
        table += &format!("{error}\n");
    }
    insta::assert_snapshot!(table);
}

/// Readers of other crates, switched off and on.
#[test]
fn regress_messages_about_files_for_other_crates() {
    let bytes = |name: &str| std::fs::read(path(name)).unwrap();
    let cut = |name: &str, length: usize| bytes(name)[..length].to_vec();
    let said = |name: &str, bytes: &[u8]| {
        let error = parse_file(name, bytes, &ReadOptions::all()).unwrap_err();
        error.to_string()
    };
    let mdf = [
        said("run.mf4", &cut("plain.mf4", 60)),
        said("cut.mf4", &cut("plain.mf4", 2000)),
    ];
    if !cfg!(feature = "mdf") {
        assert_eq!(
            mdf[0],
            "run.mf4: a MDF file found, which is not read; save it as CSV, Parquet, MAT, UFF or TDMS (MDF file)"
        );
    }
    let parquet = [
        said("run.parquet", &cut("snappy.parquet", 4)),
        said("cut.parquet", &cut("snappy.parquet", 3000)),
        said("brotli.parquet", &bytes("brotli.parquet")),
        said("claim.parquet", &bytes("claim.parquet")),
    ];
    let hdf5 = [
        said("run.mat", &cut("matlab73.mat", 520)),
        said("cut.mat", &cut("matlab73.mat", 5000)),
        said("half.h5", &cut("plain.h5", 9000)),
        said("claim.h5", &bytes("claim.h5")),
    ];
    if cfg!(feature = "parquet") {
        insta::assert_snapshot!(parquet.join("\n"), @r"
        run.parquet: the directory of the file cannot be read (EOF: Parquet file too small. Size is 4 but need 8); the file is cut off, damaged or of a form that is not known (Parquet file)
        cut.parquet: the directory of the file cannot be read (Invalid Parquet file. Corrupt footer); the file is cut off, damaged or of a form that is not known (Parquet file)
        brotli.parquet: BROTLI compression found, which is not read; write it with Snappy, gzip, Zstandard or no compression (Parquet file)
        claim.parquet: more than 223600 rows in a file of this length found, which is the limit (Parquet file)
        ");
    } else {
        assert_eq!(
            parquet[0],
            "run.parquet: a Parquet file found, which is not read; save it as CSV, Parquet, MAT, UFF or TDMS (Parquet file)"
        );
    }
    if cfg!(feature = "matlab73") {
        insta::assert_snapshot!(hdf5.join("\n"), @r"
        run.mat: the head of the file cannot be read (unexpected EOF: need 9 bytes, have 8); the file is cut off, damaged or of a form that is not known (HDF5 or MATLAB 7.3 file)
        cut.mat: the list of variables cannot be read (unexpected EOF: need 14404 bytes, have 5000); the file is cut off, damaged or of a form that is not known (HDF5 or MATLAB 7.3 file)
        half.h5: dataset 'log.Kraft' cannot be read (unexpected EOF: need 14311 bytes, have 9000); the file is cut off, damaged or of a form that is not known (HDF5 or MATLAB 7.3 file)
        claim.h5: more than 134217728 numbers found, which is the limit (HDF5 or MATLAB 7.3 file)
        ");
    } else {
        assert_eq!(
            hdf5[0],
            "run.mat: a HDF5 or MATLAB 7.3 file found, which is not read; save it with -v7 in MATLAB, or as CSV (HDF5 or MATLAB 7.3 file)"
        );
    }
}
