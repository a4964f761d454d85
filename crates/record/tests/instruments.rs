//! Small exports in the layout of each instrument (`fixtures/records/instruments`): read without a
//! flag, or with the one that the refusal names.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::motion::{
    self, Expected, SINGLE, WHOLE, assert_holds, notes, options, path, read, refused,
};
use simgap_record::{ChannelMap, ReadOptions, read_file};

const FOLDER: &str = "instruments";
const PRINTED: Expected = Expected {
    tolerance: SINGLE,
    ..WHOLE
};

#[test]
fn val_labview_measurement_files() {
    let map = ["u=Kraft", "y=Weg"];
    for name in ["lvm-one-x.lvm", "lvm-no-x.lvm", "lvm-comma.lvm"] {
        let reading = read(FOLDER, name, &map);
        assert_holds(&reading, name, PRINTED);
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
    }
    let late = Expected {
        rows: 190,
        from_s: 0.05,
        stamped_s: 0.05,
        ..PRINTED
    };
    assert_holds(
        &read(FOLDER, "lvm-each-x.lvm", &map),
        "lvm-each-x.lvm",
        late,
    );
    let refusal = refused(FOLDER, "lvm-no-header.lvm", &options(&[])).to_string();
    assert!(
        refusal.contains("--columns \"t [s],u [N],y [mm]\""),
        "{refusal}"
    );
    let columns = options(&[]).with_columns("t [s],u [kN],y [mm]").unwrap();
    let reading = read_file(&path(FOLDER, "lvm-no-header.lvm"), &columns).unwrap();
    assert_holds(&reading, "lvm-no-header.lvm", PRINTED);
}

/// One channel a file.
fn single(name: &str, map: &[&str]) -> simgap_record::Reading {
    let options = ReadOptions::channels(["y"], [""; 0]).with_map(ChannelMap::parse(map).unwrap());
    read_file(&path(FOLDER, name), &options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn val_oscilloscopes() {
    for (name, u, y) in [
        ("tektronix-mso.csv", "CH1", "CH2"),
        ("rigol-ds1000z.csv", "CH1", "CH2"),
        ("rigol-mso5000.csv", "CH1", "CH2"),
        ("rohde-rtb.csv", "C1", "C2"),
        ("keysight-infiniivision.csv", "1", "2"),
        ("siglent-sds.csv", "CH1", "CH2"),
        ("picoscope.csv", "Channel A", "Channel B"),
    ] {
        let reading = read(FOLDER, name, &[&format!("u={u}"), &format!("y={y}")]);
        assert_holds(&reading, name, PRINTED);
        if matches!(name, "rigol-mso5000.csv" | "rohde-rtb.csv") {
            assert_eq!(reading.record.require("y").unwrap().unit.symbol(), "V");
        }
    }
    let reading = single("F0000CH1.CSV", &["y=CH1"]);
    assert_holds(&reading, "F0000CH1.CSV", PRINTED);
    assert_eq!(reading.record.require("y").unwrap().unit.symbol(), "V");
    assert_holds(
        &single("gw-instek-detail.csv", &["y=CH1"]),
        "gw-instek-detail.csv",
        PRINTED,
    );
    assert_holds(&single("lecroy.csv", &["y=Ampl"]), "lecroy.csv", PRINTED);
    let counts = single("gw-instek-fast.csv", &["y=CH1"]);
    assert!((counts.record.time_step_s() / motion::STEP_S - 1.0).abs() < 1e-12);
    let y = counts.record.require("y").unwrap();
    assert_eq!(y.unit.symbol(), "counts");
    for k in 0..motion::ROWS {
        let t = k as f64 * motion::STEP_S;
        assert_eq!(y.values[k], (50.0 * motion::travel(t)).round(), "{k}");
    }
    assert!(notes(&counts).contains("counts of its converter"));
}

#[test]
fn val_loggers_and_controllers() {
    for (name, u, y) in [
        ("campbell-toa5.dat", "Kraft", "Weg"),
        ("keysight-daq.csv", "101", "102"),
        ("twincat-scope.csv", "Rig.fForce", "Rig.fPos"),
        ("iba-analyzer.txt", "[0:0] Kraft", "[0:1] Weg"),
        ("iba-clock.txt", "[0:0] Kraft", "[0:1] Weg"),
        ("rate-above.csv", "Kraft", "Weg"),
        ("ros-topic.csv", "field.force", "field.position"),
        ("unix-seconds.csv", "force", "position"),
    ] {
        let reading = read(FOLDER, name, &[&format!("u={u}"), &format!("y={y}")]);
        assert_holds(&reading, name, PRINTED);
    }
    let map = ["u=force", "y=position"];
    let refusal = refused(FOLDER, "px4-ulog.csv", &options(&map)).to_string();
    assert!(
        refusal.contains("--map \"t=timestamp [us]\" (200 Hz)"),
        "{refusal}"
    );
    let started = Expected {
        stamped_s: 23.154,
        ..PRINTED
    };
    let reading = read(
        FOLDER,
        "px4-ulog.csv",
        &["t=timestamp [us]", map[0], map[1]],
    );
    assert_holds(&reading, "px4-ulog.csv", started);
}

#[test]
fn verify_names_and_units_of_campbell_loggers_stand_in_their_lines() {
    let reading = read_file(&path(FOLDER, "campbell-toa5.dat"), &ReadOptions::all()).unwrap();
    let names: Vec<&str> = reading
        .record
        .channels()
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(names, ["RECORD", "Kraft", "Weg"]);
    assert_eq!(reading.record.require("Kraft").unwrap().unit.symbol(), "kN");
}
