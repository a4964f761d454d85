//! Each way in which the formats' own writers say time, names and numbers (`fixtures/records/variants`),
//! sample by sample against what was written.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::motion::{Expected, WHOLE, assert_holds, notes, options, path, read, refused};
use simgap_record::{ReadOptions, read_file};

const FOLDER: &str = "variants";
/// Where a cubic between samples stands in for the motion: 10 and 20 ms apart, 5 Hz.
const CUBIC: f64 = 4e-4;
const CUBIC_SLOW: f64 = 6e-3;

fn holds(name: &str, map: &[&str], expected: Expected) -> String {
    let reading = read(FOLDER, name, map);
    assert_holds(&reading, name, expected);
    notes(&reading)
}

#[test]
fn val_nptdms_time_bases() {
    let map = ["u=Kraft", "y=Weg"];
    let late = Expected {
        rows: 190,
        from_s: 0.05,
        stamped_s: 0.05,
        ..WHOLE
    };
    for name in ["offset.tdms", "start.tdms"] {
        let told = holds(name, &map, late);
        assert!(
            told.contains("'y' has a time base of its own, which begins 0.05 s later"),
            "{told}"
        );
        assert!(!told.contains("interpolation"), "{told}");
    }
    let between = Expected {
        rows: 189,
        from_s: 0.055,
        stamped_s: 0.055,
        tolerance: CUBIC,
        ..WHOLE
    };
    let told = holds("offset-fraction.tdms", &map, between);
    assert!(told.ends_with("by cubic interpolation"), "{told}");
    for name in ["milliseconds.tdms", "big-endian.tdms"] {
        holds(name, &map, WHOLE);
    }
    let half = Expected {
        rows: 199,
        tolerance: CUBIC_SLOW,
        ..WHOLE
    };
    holds("half-rate.tdms", &map, half);
    let all = read_file(&path(FOLDER, "spectrum.tdms"), &ReadOptions::all()).unwrap();
    assert_eq!(all.record.channels().len(), 1);
    assert_eq!(
        notes(&all),
        "column 'Weg' left out: its values stand over an axis in [Hz], not over time"
    );
}

#[cfg(feature = "parquet")]
#[test]
fn val_parquet_times() {
    for name in [
        "duration-ms.parquet",
        "duration-us.parquet",
        "duration-ns.parquet",
        "pandas-timedelta.parquet",
        "polars-duration.parquet",
        "pandas-stamps-ms.parquet",
        "pandas-stamps-us.parquet",
        "pandas-stamps-ns.parquet",
        "polars-stamps.parquet",
    ] {
        let told = holds(name, &["u=u", "y=y"], WHOLE);
        assert!(!told.contains("assumed"), "{name}: {told}");
    }
    for unit in ["ms", "us", "ns"] {
        let told = holds(&format!("epoch-{unit}.parquet"), &["u=u", "y=y"], WHOLE);
        assert!(
            told.contains(&format!("read in {unit}, in which")),
            "{told}"
        );
    }
    let half = Expected {
        tolerance: crate::motion::HALF,
        ..WHOLE
    };
    holds("half-decimal.parquet", &["u=u", "y=y"], half);
    let refusal = refused(FOLDER, "since-boot.parquet", &options(&["u=u", "y=y"])).to_string();
    assert!(
        refusal.contains("--map \"t=timestamp [us]\" (200 Hz)"),
        "{refusal}"
    );
    let started = Expected {
        stamped_s: 23.154,
        ..WHOLE
    };
    holds(
        "since-boot.parquet",
        &["t=timestamp [us]", "u=u", "y=y"],
        started,
    );
}

#[cfg(feature = "arrow")]
#[test]
fn val_arrow_files() {
    let lost = Expected {
        lost: Some(50),
        ..WHOLE
    };
    for name in [
        "lz4.feather",
        "zstd.feather",
        "plain.feather",
        "stream.arrows",
    ] {
        let told = holds(name, &["u=u", "y=y"], lost);
        for because in [
            "'state' left out: it holds text",
            "'mode' left out: it holds categories",
            "'pair' left out: it holds lists",
        ] {
            assert!(told.contains(because), "{name}: {told}");
        }
        let all = read_file(&path(FOLDER, name), &ReadOptions::all()).unwrap();
        let count = &all.record.require("count").unwrap().values;
        assert!(
            (0..crate::motion::ROWS).all(|k| count[k] == k as f64),
            "{name}"
        );
    }
    for name in ["pandas.feather", "polars.arrow"] {
        holds(name, &["u=u", "y=y"], WHOLE);
    }
    let half = Expected {
        tolerance: crate::motion::HALF,
        ..WHOLE
    };
    holds("duration-half.feather", &["u=u", "y=y"], half);
}

#[test]
fn val_scipy_workspaces() {
    let units = ["u=u [kN]", "y=y [mm]"];
    let named = ["u=Kraft [kN]", "y=Weg [mm]"];
    let started = Expected {
        stamped_s: 12.5,
        ..WHOLE
    };
    holds("t0.mat", &units, started);
    let model = ["u=Model Root/Kraft", "y=Model Root/Weg"];
    let reading = read(FOLDER, "dspace.mat", &model);
    assert_holds(&reading, "dspace.mat", WHOLE);
    let unit = |name: &str| {
        reading
            .record
            .require(name)
            .unwrap()
            .unit
            .symbol()
            .to_owned()
    };
    assert_eq!((unit("u").as_str(), unit("y").as_str()), ("kN", "mm"));
    holds("simulink.mat", &named, WHOLE);
    holds(
        "cells.mat",
        &["t=log{1} [s]", "u=log{2} [kN]", "y=log{3} [mm]"],
        WHOLE,
    );
    let told = holds("others.mat", &units, WHOLE);
    for because in [
        "'z' left out: its values are complex",
        "'s' left out: it is a sparse matrix",
        "'cube' left out: it has more than two",
    ] {
        assert!(told.contains(because), "{told}");
    }
    let told = holds("epoch-ns.mat", &units, WHOLE);
    assert!(told.contains("read in ns"), "{told}");
    // Days since the year 0 have a digit for 10 us.
    let days = Expected {
        stamp_steps: 4e-3,
        ..WHOLE
    };
    let told = holds("datenum.mat", &units, days);
    assert!(told.contains("read in d, which its name says"), "{told}");
    for name in ["days.mat", "near-days.mat"] {
        let told = holds(name, &units, days);
        assert!(told.contains("read in d, in which"), "{told}");
    }
    // A structure for each sample.
    holds("each.mat", &units, WHOLE);
    let told = holds("named.mat", &units, WHOLE);
    assert!(told.contains("'time_ms' read in ms"), "{told}");
}

/// Tables, timetables with durations and with dates, of a file with sections and of an HDF5 file.
fn assert_tables(ending: &str) {
    let units = ["u=u [kN]", "y=y [mm]"];
    let told = holds(&format!("table-{ending}.mat"), &units, WHOLE);
    assert!(
        told.contains("'run.state' left out: it holds no real numbers"),
        "{told}"
    );
    let told = holds(&format!("timetable-{ending}.mat"), &units, WHOLE);
    assert!(!told.contains("assumed"), "{told}");
    let by_rate = Expected {
        stamped_s: 2.0,
        ..WHOLE
    };
    holds(&format!("rate-{ending}.mat"), &units, by_rate);
    // Milliseconds since 1970 have a digit for 0.2 us.
    let dated = Expected {
        stamp_steps: 1e-4,
        ..WHOLE
    };
    holds(&format!("dated-{ending}.mat"), &units, dated);
}

#[test]
fn val_mat_io_tables() {
    assert_tables("v7");
    holds("timetable-v6.mat", &["u=u [kN]", "y=y [mm]"], WHOLE);
}

/// What is left out is told where it is asked for.
#[test]
fn verify_a_channel_that_is_left_out_is_told_with_its_reason() {
    let reason = |name: &str, map: &[&str]| refused(FOLDER, name, &options(map)).to_string();
    assert!(
        reason("others.mat", &["u=z"]).ends_with(
            "column 'z' is needed, but the file has 't', 'u', 'y'; 'z' is left out: its values are \
             complex; save real(x) and imag(x)"
        ),
        "{}",
        reason("others.mat", &["u=z"])
    );
    let line = reason("spectrum.tdms", &["u=Weg", "y=Weg"]);
    assert!(
        line.contains("'Weg' is left out: its values stand over an axis in [Hz]"),
        "{line}"
    );
}

#[cfg(feature = "matlab73")]
#[test]
fn val_mat_io_and_hdf5storage_files() {
    assert_tables("v73");
    let reading = read(FOLDER, "signals-v73.mat", &["u=Kraft", "y=Weg"]);
    assert_holds(&reading, "signals-v73.mat", WHOLE);
    let unit = |name: &str| {
        reading
            .record
            .require(name)
            .unwrap()
            .unit
            .symbol()
            .to_owned()
    };
    assert_eq!((unit("u").as_str(), unit("y").as_str()), ("kN", "mm"));
    holds("cells-v73.mat", &["u=log{1} [kN]", "y=log{2} [mm]"], WHOLE);
}

#[cfg(feature = "matlab73")]
#[test]
fn val_h5py_files() {
    let named = ["u=Kraft", "y=Weg"];
    for name in ["latest.h5", "extents.h5", "v114.h5"] {
        holds(name, &named, WHOLE);
    }
    let told = holds("latest-plain.h5", &named, WHOLE);
    assert!(
        told.contains(
            "'log.both' left out: it is dataset 'log.both' with more than one unlimited size; write it with one"
        ),
        "{told}"
    );
    let told = holds(
        "half.h5",
        &["u=u [kN]", "y=y [mm]"],
        Expected {
            tolerance: crate::motion::HALF,
            ..WHOLE
        },
    );
    for because in [
        "'z' left out: its values are complex",
        "'state' left out: it holds text",
    ] {
        assert!(told.contains(because), "{told}");
    }
    let single = Expected {
        tolerance: crate::motion::SINGLE,
        ..WHOLE
    };
    holds("records.h5", &["u=u [kN]", "y=y [mm]"], single);
    holds("epoch-ns.h5", &["u=u [kN]", "y=y [mm]"], WHOLE);
}

#[cfg(feature = "xlsx")]
#[test]
fn val_workbooks() {
    let lost = Expected {
        lost: Some(50),
        ..WHOLE
    };
    let told = holds("openpyxl.xlsx", &["u=u", "y=y"], lost);
    assert!(told.contains("sheet 'Run 7' is read"), "{told}");
    let told = holds("dated.xlsx", &["u=u", "y=y"], WHOLE);
    assert!(told.contains("not read: 'Setup'"), "{told}");
    holds("pandas.xlsx", &["u=u", "y=y"], WHOLE);
    let told = holds("days.xlsx", &["u=u", "y=y"], WHOLE);
    assert!(told.contains("read in d"), "{told}");
}

#[cfg(feature = "mdf")]
#[test]
fn val_asammdf_files() {
    let map = ["u=Kraft", "y=Weg"];
    for name in ["deflate.mf4", "transposed.mf4", "version-3.mdf"] {
        holds(name, &map, WHOLE);
    }
    holds(
        "../plain.mf4",
        &map,
        Expected {
            tolerance: crate::motion::SINGLE,
            ..WHOLE
        },
    );
    let half = Expected {
        rows: 199,
        tolerance: CUBIC_SLOW,
        ..WHOLE
    };
    holds("rasters.mf4", &map, half);
    let late = Expected {
        rows: 190,
        from_s: 0.05,
        stamped_s: 0.05,
        tolerance: 1e-9,
        ..WHOLE
    };
    holds("late.mf4", &map, late);
    // A lattice of 1e-4 mm.
    let counted = Expected {
        tolerance: 2.6e-5,
        ..WHOLE
    };
    let told = holds("converted.mf4", &map, counted);
    assert!(told.contains("'State' left out"), "{told}");
}

#[test]
fn val_pyuff_functions_that_begin_apart() {
    let late = Expected {
        rows: 190,
        from_s: 0.05,
        stamped_s: 0.05,
        tolerance: 1e-11,
        ..WHOLE
    };
    holds("late.uff", &["u=Kraft", "y=Weg"], late);
}

#[test]
fn val_numpy_text() {
    let printed = Expected {
        tolerance: 1e-14,
        ..WHOLE
    };
    for name in ["savetxt-header.txt", "savetxt-commas.txt"] {
        holds(name, &["u=u", "y=y"], printed);
    }
    holds("pandas-timedelta.csv", &["u=u", "y=y"], printed);
    // Seconds under the name of milliseconds, 200 Hz.
    let map = ["u=u", "y=y"];
    let refusal = refused(FOLDER, "doubted.txt", &options(&map)).to_string();
    assert!(
        refusal.contains("'t_ms' is named for ms, but its step is 0.005; say which it is with --map \"t=t_ms [s]\" (200 Hz) or"),
        "{refusal}"
    );
    let refusal = refused(FOLDER, "savetxt.txt", &options(&[])).to_string();
    assert!(
        refusal.ends_with("name them with --columns \"t [s],u [N],y [mm]\""),
        "{refusal}"
    );
    let columns = options(&[]).with_columns("t [s],u [kN],y [mm]").unwrap();
    let reading = read_file(&path(FOLDER, "savetxt.txt"), &columns).unwrap();
    assert_holds(&reading, "savetxt.txt", printed);
    let two = options(&[]).with_columns("t [s],y [mm]").unwrap();
    let refusal = refused(FOLDER, "savetxt.txt", &two).to_string();
    assert!(
        refusal.ends_with(
            "3 columns of numbers begin here, but --columns names 2; a name for each is needed"
        ),
        "{refusal}"
    );
}
