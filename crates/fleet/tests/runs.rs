//! A plan, run: what is found, what survives a killed run, what a failed diagnosis leaves.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use simgap_diagnose::Cancel;
use simgap_fleet::scope::Scope;
use simgap_fleet::{Counts, FleetError, Plan, Role, Table, Unit, report, run, units};

use crate::common::Fleet;

fn planned(folder: &Path) -> (Plan, Vec<Unit>) {
    let plan = Plan::read(&folder.join("plan.toml")).unwrap();
    let units = units(&plan, None).unwrap();
    (plan, units)
}

fn ran(units: &[Unit], out: &Path, jobs: usize) -> Counts {
    run(units, out, jobs, &Cancel::default(), &|_, _| {}).unwrap()
}

/// Every file of a table with its bytes.
fn table(out: &Path, units: &[Unit]) -> BTreeMap<String, Vec<u8>> {
    let path = |unit: &Unit| Table::of(out).path(unit);
    let read = units
        .iter()
        .map(|unit| (unit.file.clone(), std::fs::read(path(unit)).unwrap()));
    read.collect()
}

/// What the diagnoses of this file look for. The rest of the catalogue would take time and has tests of its own.
const KINDS: [&str; 9] = [
    "coulomb_friction",
    "viscous_damping",
    "constant_force",
    "sensor_bias",
    "sensor_gain",
    "input_gain",
    "stiffness_error",
    "mass_error",
    "damping_error",
];

fn short_catalogue(folder: &Path) {
    let all = simgap_effects::catalogue()
        .iter()
        .map(|effect| effect.kind());
    let others: Vec<&str> = all.filter(|kind| !KINDS.contains(kind)).collect();
    let path = folder.join("plan.toml");
    let plan = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{plan}withhold = {others:?}\n")).unwrap();
}

/// A small fleet with all that the large one has, ended in the middle and taken up again.
#[test]
fn verify_a_fleet_is_told_and_a_killed_run_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let fleet = Fleet {
        machines: 5,
        days: 8,
        growing: vec![1],
        friction_a_day: 0.35,
        loosening: 3,
        loosening_a_day: 0.03,
        wrong_day: 3,
        samples: 240,
    };
    fleet.write(folder.path()).unwrap();
    short_catalogue(folder.path());
    let (plan, units) = planned(folder.path());
    assert_eq!(units.len(), 40);
    let out = folder.path().join("result");
    // Ended after ten diagnoses.
    let (cancel, done) = (Cancel::default(), AtomicUsize::new(0));
    let ended = run(&units, &out, 2, &cancel, &|_, _| {
        if done.fetch_add(1, Ordering::Relaxed) == 9 {
            cancel.cancel();
        }
    });
    assert!(matches!(ended, Err(FleetError::Cancelled)), "{ended:?}");
    // What a kill in the middle of a write leaves.
    let beside = Table::of(&out)
        .path(&units[0])
        .with_file_name(".simgap-abc.part");
    std::fs::create_dir_all(beside.parent().unwrap()).unwrap();
    std::fs::write(&beside, "half").unwrap();
    let counts = ran(&units, &out, 2);
    assert!(counts.known >= 10 && counts.known < 14, "{counts:?}");
    assert_eq!(counts.diagnosed + counts.known, 40);
    assert!(!beside.exists());
    let whole = table(&out, &units);
    // Undisturbed, on one thread, elsewhere: some of them, one of each kind.
    let some: Vec<Unit> = [0, 11, 15, 31, 35].map(|k| units[k].clone()).to_vec();
    let other = folder.path().join("other");
    ran(&some, &other, 1);
    for (file, bytes) in table(&other, &some) {
        assert!(whole[&file] == bytes, "{file}");
    }
    // Nothing is left to do, and nothing changes.
    assert_eq!(ran(&units, &out, 2).known, 40);
    assert!(table(&out, &units) == whole);

    let told = report(&plan, &units, &out).unwrap();
    let named = |scope: Scope, factor: &str, level: &str| {
        let mut all = told.findings.iter();
        all.any(|f| f.scope == scope && f.levels.get(factor).is_some_and(|l| l == &[level]))
    };
    assert!(
        named(Scope::Machine, "machine", "m01"),
        "{:#?}",
        told.findings
    );
    assert!(
        named(Scope::Machine, "machine", "m03"),
        "{:#?}",
        told.findings
    );
    assert!(
        named(Scope::Condition, "date", "2026-03-04"),
        "{:#?}",
        told.findings
    );
    let grows = told.findings.iter().filter(|f| f.course.is_some());
    let grows: Vec<_> = grows
        .map(|f| (&f.levels["machine"][0][..], f.course.unwrap()))
        .collect();
    assert!(
        grows.iter().any(|(m, [from, to])| *m == "m01" && to > from),
        "{grows:?}"
    );
    assert!(
        grows.iter().any(|(m, [from, to])| *m == "m03" && to < from),
        "{grows:?}"
    );
    // No machine is blamed but these two.
    let blamed = told.findings.iter().filter(|f| f.scope == Scope::Machine);
    assert!(
        blamed
            .flat_map(|f| &f.levels["machine"])
            .all(|m| m == "m01" || m == "m03"),
        "{:#?}",
        told.findings
    );
}

/// Of two workers one would wait at the end for a long record that begins last.
#[test]
fn verify_the_longest_records_begin_first() {
    let folder = tempfile::tempdir().unwrap();
    let fleet = Fleet {
        machines: 1,
        days: 4,
        growing: vec![],
        loosening: 9,
        wrong_day: 9,
        ..Fleet::whole()
    };
    fleet.write(folder.path()).unwrap();
    let (_, units) = planned(folder.path());
    // What cannot be read is a failure at once; only its length counts.
    for (unit, len) in units.iter().zip([100, 300, 100, 400]) {
        std::fs::write(&unit.train[0], "x".repeat(len)).unwrap();
    }
    let order = Mutex::new(vec![]);
    let tell = |unit: &Unit, _| order.lock().unwrap().push(unit.date.clone());
    let out = folder.path().join("result");
    run(&units, &out, 1, &Cancel::default(), &tell).unwrap();
    let wanted = [3, 1, 0, 2].map(|k: usize| units[k].date.clone());
    assert_eq!(order.into_inner().unwrap(), wanted);
}

/// A unit that fails is a row with its reason, without folders; a record that is mended is diagnosed again.
#[test]
fn verify_what_fails_is_a_row_and_is_done_again_when_its_record_changes() {
    let folder = tempfile::tempdir().unwrap();
    let fleet = Fleet {
        machines: 1,
        days: 2,
        growing: vec![],
        loosening: 9,
        wrong_day: 9,
        ..Fleet::whole()
    };
    fleet.write(folder.path()).unwrap();
    short_catalogue(folder.path());
    let (plan, units) = planned(folder.path());
    let record = Path::new(&units[1].train[0]);
    let sound = std::fs::read(record).unwrap();
    std::fs::write(record, "t [s],u [N]\n0,1\n").unwrap();
    let out = folder.path().join("result");
    let counts = ran(&units, &out, 2);
    assert_eq!((counts.diagnosed, counts.failed), (1, 1));
    let rows = Table::of(&out).rows(&units[1]).unwrap();
    assert_eq!(
        (rows.len(), rows[0].role, &rows[0].status[..]),
        (1, Role::Failed, "failed")
    );
    let reason = rows[0].reason.clone().unwrap();
    assert!(
        reason.starts_with("run.csv") && reason.contains('y'),
        "{reason}"
    );
    let told = report(&plan, &units, &out).unwrap();
    assert_eq!((told.answered, told.failed), (2, 1));
    let page = std::fs::read_to_string(out.join("fleet.html")).unwrap();
    assert!(page.contains("Diagnoses that failed"));

    std::fs::write(record, sound).unwrap();
    let counts = ran(&units, &out, 2);
    assert_eq!((counts.diagnosed, counts.known), (1, 1));
    assert_eq!(report(&plan, &units, &out).unwrap().failed, 0);
    // A missing model fails all of them, with its name alone.
    std::fs::remove_file(folder.path().join("table.toml")).unwrap();
    assert_eq!(ran(&units, &out, 2).failed, 2);
    let reason = Table::of(&out).rows(&units[0]).unwrap()[0].reason.clone();
    assert_eq!(
        reason.as_deref(),
        Some("table.toml: no such file, needed is a model file")
    );
}
