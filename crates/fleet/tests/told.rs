//! What a report tells of a table, without diagnoses: rows are written as answers would be.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use std::collections::BTreeMap;
use std::path::Path;

use simgap_fleet::findings::Finding;
use simgap_fleet::scope::Scope;
use simgap_fleet::{Fleet, Plan, Role, Row, Table, Unit, encode, report};
use simgap_model::Model;

use crate::common::{MODEL, Random};

const PLACE: &str = "between table and ground";

/// A row of a parameter with its standard error.
fn row(
    role: Role,
    status: &str,
    kind: &str,
    place: &str,
    parameter: &str,
    [value, std]: [f64; 2],
) -> Row {
    Row {
        role,
        status: status.into(),
        complete: Some(true),
        kind: Some(kind.into()),
        place: Some(place.into()),
        probability: (role == Role::Named).then_some(0.98),
        parameter: Some(parameter.into()),
        value: Some(value),
        low: Some(value - 1.96 * std),
        high: Some(value + 1.96 * std),
        prior_std: (role == Role::Nominal).then_some(0.02),
        gap_nominal: Some(0.2),
        gap_corrected: Some(0.01),
        reason: None,
        ..Row::failed(String::new())
    }
}

fn friction(value: f64) -> Row {
    row(
        Role::Named,
        "effect",
        "coulomb_friction",
        PLACE,
        "friction_force_n",
        [value, 0.05],
    )
}

/// A stiffness as the prior of 2 % and data of 0.4 % have it.
fn stiffness(factor: f64) -> Row {
    let (data, prior) = (0.004f64.powi(-2), 0.02f64.powi(-2));
    let value = (factor * data + prior) / (data + prior);
    let std = (data + prior).powf(-0.5);
    row(
        Role::Nominal,
        "none",
        "stiffness_error",
        PLACE,
        "stiffness_ratio",
        [value, std],
    )
}

struct Made {
    folder: tempfile::TempDir,
    units: Vec<Unit>,
}

impl Made {
    fn new() -> Made {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("table.toml"), MODEL).unwrap();
        Made {
            folder,
            units: vec![],
        }
    }

    fn add(&mut self, machine: usize, date: &str, rig: &str, rows: &[Row]) {
        let machine = format!("m{machine:02}");
        let unit = Unit {
            file: format!("machine={machine}/date={date}/diagnosis.parquet"),
            machine,
            date: date.into(),
            conditions: BTreeMap::from([("rig".to_owned(), rig.to_owned())]),
            model: self
                .folder
                .path()
                .join("table.toml")
                .to_string_lossy()
                .into(),
            train: vec!["run.csv".into()],
            check: vec![],
            withhold: vec![],
            map: vec![],
            columns: None,
            mend: false,
            known: None,
        };
        let bytes = encode(&unit, rows, "0").unwrap();
        Table::of(self.folder.path()).put(&unit, &bytes).unwrap();
        self.units.push(unit);
    }

    fn told(&self) -> Fleet {
        self.told_with("")
    }

    fn told_with(&self, machines: &str) -> Fleet {
        let text = "schema = \"simgap-plan/1\"\nname = \"made\"\nrecords = [\"{machine}/{date}/{rig}.csv\"]\nmodel = \"table.toml\"\n";
        let text = format!("{text}{machines}");
        let plan = Plan::parse(&text, &self.folder.path().join("plan.toml")).unwrap();
        report(&plan, &self.units, self.folder.path()).unwrap()
    }

    fn text(&self, file: &str) -> String {
        std::fs::read_to_string(self.folder.path().join(file)).unwrap()
    }
}

fn date(day: usize) -> String {
    format!("2026-03-{:02}", day + 1)
}

fn of<'a>(fleet: &'a Fleet, scope: Scope, kind: &str) -> Vec<&'a Finding> {
    let all = fleet.findings.iter();
    all.filter(|f| f.scope == scope && f.kind == kind).collect()
}

fn machines(finding: &Finding) -> Vec<&str> {
    finding
        .levels
        .get("machine")
        .into_iter()
        .flatten()
        .map(String::as_str)
        .collect()
}

/// Twenty machines over 25 days: friction grows in three from the day on which it is seen, one spring loosens in one step,
/// and day 12 has a wrong sensor.
#[test]
fn verify_growth_a_step_and_a_day_are_told_apart() {
    let mut made = Made::new();
    let mut chance = Random(1);
    for machine in 0..20 {
        for day in 0..25 {
            let mut rows = vec![];
            if [3, 7, 15].contains(&machine) && day >= 6 {
                rows.push(friction(0.1 * day as f64 + 0.05 * chance.normal()));
            }
            if day == 12 {
                rows.push(row(
                    Role::Named,
                    "effect",
                    "sensor_gain",
                    "channel y",
                    "gain",
                    [1.2 + 0.003 * chance.normal(), 0.003],
                ));
            }
            let loose = if machine == 11 && day >= 10 {
                0.95
            } else {
                1.0
            };
            rows.push(stiffness(loose + 0.004 * chance.normal()));
            made.add(machine, &date(day), "a", &rows);
        }
    }
    let fleet = made.told();
    let own = of(&fleet, Scope::Machine, "coulomb_friction");
    assert_eq!(
        machines(own[0]),
        ["m03", "m07", "m15"],
        "{:#?}",
        fleet.findings
    );
    let growing: Vec<&&Finding> = own.iter().filter(|f| f.course.is_some()).collect();
    assert_eq!(growing.len(), 3);
    assert!(
        growing
            .iter()
            .all(|f| f.course.is_some_and(|[from, to]| from < 0.8 && to > 2.2))
    );
    let loose = of(&fleet, Scope::Machine, "stiffness_error");
    assert_eq!(
        (loose.len(), machines(loose[0]), &loose[0].steps[..]),
        (1, vec!["m11"], &[date(10)][..])
    );
    let day = of(&fleet, Scope::Condition, "sensor_gain");
    assert_eq!((day.len(), &day[0].levels["date"]), (1, &vec![date(12)]));
    assert!(day[0].text.contains("no machine is to blame"));
    assert_eq!(fleet.findings.len(), 6, "{:#?}", fleet.findings);
    let page = made.text("fleet.html");
    assert!(
        page.contains("One machine&#39;s own")
            && page.contains("machine m11, where it falls in one step at 2026-03-11")
    );
    // The next machine is like those that are sound: 1 ± what 19 of them say, which scatter by no more than their errors.
    let next = &fleet.models[0].values[0];
    assert_eq!(
        (&next.kind[..], next.machines, &next.left_out[..]),
        ("stiffness_error", 19, &["m11".to_owned()][..])
    );
    assert!((next.mean - 1.0).abs() < 3.0 * 0.004 / (19.0f64 * 25.0).sqrt());
    let model = Model::from_toml(&made.text("models/table.toml")).unwrap();
    assert_eq!(model.springs[0].uncertainty, Some(next.uncertainty));
    assert!((model.springs[0].stiffness / 800.0 - next.mean).abs() < 1e-12);
}

/// Six machines, of which two were measured in another week: what they differ by may be the machine or the week.
#[test]
fn verify_machines_on_days_of_their_own_are_not_blamed() {
    let mut made = Made::new();
    let mut chance = Random(2);
    for machine in 0..6 {
        for run in 0..3 {
            let other = machine > 3;
            let value = if other { 3.0 } else { 1.0 };
            let mut rows = vec![friction(value + 0.05 * chance.normal())];
            if other {
                rows.push(row(
                    Role::Named,
                    "effect",
                    "sensor_bias",
                    "channel y",
                    "bias",
                    [0.01, 0.001],
                ));
            }
            let day = if other { 20 + run } else { run };
            made.add(machine, &date(day), if other { "b" } else { "a" }, &rows);
        }
    }
    let fleet = made.told();
    assert!(
        of(&fleet, Scope::Machine, "coulomb_friction").is_empty(),
        "{:#?}",
        fleet.findings
    );
    assert!(of(&fleet, Scope::Machine, "sensor_bias").is_empty());
    let common = of(&fleet, Scope::Common, "coulomb_friction");
    assert_eq!(common.len(), 1);
    let apart = of(&fleet, Scope::Undecided, "coulomb_friction");
    let told: Vec<_> = apart.iter().map(|f| machines(f)).collect();
    assert_eq!(told, [["m04"], ["m05"]]);
    assert!(
        apart
            .iter()
            .all(|f| f.levels.contains_key("date") && f.levels["rig"] == ["b"])
    );
    assert!(apart[0].text.contains("nobody is to blame"));
    let bias = of(&fleet, Scope::Undecided, "sensor_bias");
    assert_eq!(bias.len(), 1);
    assert_eq!(machines(bias[0]), ["m04", "m05"]);
    assert_eq!(bias[0].levels["rig"], ["b"]);
}

/// The same, and machine 0 was there in that week as well, without what the others have: it is the machines.
#[test]
fn verify_a_machine_that_was_there_too_decides() {
    let mut made = Made::new();
    let mut chance = Random(3);
    for machine in 0..6 {
        for run in 0..6 {
            let other = machine > 3;
            let value = if other { 3.0 } else { 1.0 };
            let rows = [friction(value + 0.05 * chance.normal())];
            let day = if other || (machine == 0 && run > 2) {
                20 + run % 3
            } else {
                run
            };
            made.add(machine, &date(day), "a", &rows);
        }
    }
    let fleet = made.told();
    let apart = of(&fleet, Scope::Machine, "coulomb_friction");
    let told: Vec<_> = apart.iter().map(|f| machines(f)).collect();
    assert_eq!(told, [["m04"], ["m05"]], "{:#?}", fleet.findings);
    assert!(of(&fleet, Scope::Undecided, "coulomb_friction").is_empty());
}

/// A fleet in which nothing is wrong says nothing, in twenty tries of chance.
#[test]
fn verify_a_sound_fleet_says_nothing() {
    let mut findings = 0;
    for seed in 0..20 {
        let mut made = Made::new();
        let mut chance = Random(100 + seed);
        for machine in 0..6 {
            for day in 0..8 {
                let mut rows = vec![stiffness(1.0 + 0.004 * chance.normal())];
                // One diagnosis in twenty names something by mistake.
                if chance.even() < 0.05 {
                    rows.push(friction(0.3));
                }
                made.add(machine, &date(day), "a", &rows);
            }
        }
        findings += made.told().findings.len();
    }
    // A false alarm in twenty fleets of six series each; none is what these seeds give.
    assert!(findings <= 1, "{findings}");
}

/// A spring that is 5 % softer than the model says in all machines, which differ by 1 %: the model is wrong, and no machine.
#[test]
fn verify_a_wrong_model_is_told() {
    let mut made = Made::new();
    let mut chance = Random(4);
    for machine in 0..8 {
        let own = 0.95 + 0.01 * chance.normal();
        for day in 0..6 {
            let factor = own + 0.004 * chance.normal();
            let named = row(
                Role::Named,
                "parameters",
                "stiffness_error",
                PLACE,
                "stiffness_factor",
                [factor, 0.004],
            );
            made.add(machine, &date(day), "a", &[named]);
        }
    }
    let fleet = made.told();
    assert_eq!(fleet.findings.len(), 1, "{:#?}", fleet.findings);
    let common = of(&fleet, Scope::Common, "stiffness_error");
    assert!(common[0].text.contains("in the mean of 8 machines"));
    // The next machine is as soft, give or take a percent.
    let next = &fleet.models[0].values[0];
    assert!((next.mean - 0.95).abs() < 3.0 * 0.01 / 8f64.sqrt());
    assert!(
        (0.004..0.02).contains(&next.uncertainty),
        "{}",
        next.uncertainty
    );
}

#[test]
fn verify_a_damaged_file_of_the_table_is_told() {
    let mut made = Made::new();
    made.add(1, "2026-03-01", "a", &[stiffness(1.0)]);
    let path = Table::of(made.folder.path()).path(&made.units[0]);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert_eq!(Table::of(made.folder.path()).known(&made.units[0]), None);
    let error = Table::of(made.folder.path())
        .rows(&made.units[0])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("diagnosis.parquet: cannot be read as part of the table"),
        "{error}"
    );
}

#[test]
fn verify_rows_come_back_as_they_were_written() {
    let mut made = Made::new();
    let mut open = friction(1.0);
    open.high = Some(f64::INFINITY);
    let rows = [open, stiffness(1.01), Row::failed("no".into())];
    made.add(1, "2026-03-01", "a", &rows);
    let table = Table::of(made.folder.path());
    assert_eq!(table.rows(&made.units[0]).unwrap(), rows);
    assert_eq!(table.known(&made.units[0]).as_deref(), Some("0"));
    let bytes = std::fs::read(table.path(&made.units[0])).unwrap();
    assert_eq!(bytes, encode(&made.units[0], &rows, "0").unwrap());
    let nowhere = Unit {
        file: "none.parquet".into(),
        ..made.units[0].clone()
    };
    assert!(
        table.rows(&nowhere).unwrap().is_empty()
            && Path::new(&table.path(&nowhere)).ends_with("none.parquet")
    );
}

#[test]
fn verify_a_machine_of_the_plan_without_records_is_told() {
    let mut made = Made::new();
    made.add(1, "2026-03-01", "a", &[stiffness(1.0)]);
    let known = "[[machine]]\nname = \"m01\"\nbearing = \"old\"\n";
    assert!(made.told_with(known).notes.is_empty());
    let slip = "[[machine]]\nname = \"m1\"\nbearing = \"old\"\n";
    let note = "there is no record of [[machine]] \"m1\" of the plan";
    assert_eq!(made.told_with(slip).notes, [note]);
    let page = made.text("fleet.html");
    assert!(
        page.contains("Note: there is no record of [[machine]]"),
        "{page}"
    );
}
