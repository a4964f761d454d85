//! Plans and their work lists.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use std::path::Path;

use simgap_fleet::{Plan, Unit, units};

fn plan(text: &str) -> Result<Plan, String> {
    let text = format!("schema = \"simgap-plan/1\"\nname = \"f\"\n{text}");
    Plan::parse(&text, Path::new("at/plan.toml")).map_err(|error| error.to_string())
}

fn refused(text: &str) -> String {
    plan(text).err().unwrap_or_else(|| "accepted".into())
}

#[test]
fn verify_plans_that_are_refused_say_why() {
    let records = "records = [\"{machine}/{date}.csv\"]\n";
    let with = |more: &str| refused(&format!("{records}{more}"));
    assert_eq!(
        refused("records = []"),
        "at/plan.toml: no pattern in records, needed is at least one, such as records = [\"{machine}/{date}/{record}.csv\"]"
    );
    assert_eq!(
        refused("records = [\"{machine}.csv\"]"),
        "at/plan.toml: records = \"{machine}.csv\": no field {date}, needed is {machine} and {date} in the path, or date = \"..\" in every [[machine]]"
    );
    assert_eq!(
        refused("records = [\"{machine}/{date.csv\"]"),
        "at/plan.toml: records = \"{machine}/{date.csv\": a field \"{date.csv\", needed is a name of letters, digits and _ between { and }"
    );
    assert_eq!(
        with("[[machine]]\nrig = \"a\""),
        "at/plan.toml: a [[machine]] without a name, needed is name = \"..\""
    );
    assert_eq!(
        with("[[machine]]\nname = \"a\"\n[[machine]]\nname = \"a\""),
        "at/plan.toml: [[machine]] name = \"a\" twice, needed is each machine once"
    );
    assert_eq!(
        with("[[machine]]\nname = \"a\"\nvalue = 3"),
        "at/plan.toml: a condition called \"value\", needed is another name: the table has a column of that name"
    );
    assert!(with("withhold = [\"friction\"]").contains("unknown kind \"friction\""));
    assert!(with("modell = \"x\"").starts_with("at/plan.toml: line 4: unknown field `modell`"));
    let other = Plan::parse("schema = \"x\"\nname = \"f\"\nrecords = []", Path::new("p"));
    assert_eq!(
        other.unwrap_err().to_string(),
        "p: schema = \"x\", needed is schema = \"simgap-plan/1\""
    );
}

#[test]
fn verify_units_are_machine_date_and_conditions() {
    let folder = tempfile::tempdir().unwrap();
    for file in [
        "m1/d1/5/train-1.csv",
        "m1/d1/5/check-1.csv",
        "m1/d1/9/train-1.csv",
        "m2/d1/5/train-2.csv",
        "notes.txt",
    ] {
        let path = folder.path().join("data").join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "").unwrap();
    }
    let text = r#"
schema = "simgap-plan/1"
name = "f"
records = ["data/{machine}/{date}/{load}/{record}.csv"]
check = ["check*"]
model = "all.toml"
[[machine]]
name = "m2"
model = "own.toml"
rig = "b/c"
"#;
    let plan = Plan::parse(text, &folder.path().join("plan.toml")).unwrap();
    assert_eq!(plan.conditions, ["load", "rig"]);
    let found = units(&plan, None).unwrap();
    let files: Vec<&str> = found.iter().map(|unit| unit.file.as_str()).collect();
    assert_eq!(
        files,
        [
            "machine=m1/date=d1/load=5.parquet",
            "machine=m1/date=d1/load=9.parquet",
            "machine=m2/date=d1/load=5,rig=b%2Fc.parquet",
        ]
    );
    let at = |path: &str| folder.path().join(path).to_string_lossy().into_owned();
    assert_eq!(found[0].train, [at("data/m1/d1/5/train-1.csv")]);
    assert_eq!(found[0].check, [at("data/m1/d1/5/check-1.csv")]);
    assert_eq!(
        (&found[0].model, &found[2].model),
        (&at("all.toml"), &at("own.toml"))
    );
    // A unit goes to a worker as text and comes back as it was.
    assert_eq!(
        Unit::from_json(&found[2].to_json().unwrap()).unwrap(),
        found[2]
    );
    assert!(Unit::from_json("{}").is_err());
}

#[test]
fn verify_a_bucket_is_listed_by_others() {
    let text = "records = [\"s3://b/{machine}/{date}.csv\"]\nmodel = \"m.toml\"";
    let plan = plan(text).unwrap();
    assert!(
        units(&plan, None)
            .unwrap_err()
            .to_string()
            .contains("simgap.fleet.run in Python")
    );
    let listed = ["s3://b/m1/d1.csv", "s3://b/m1/d2.csv", "s3://b/other.csv"].map(str::to_owned);
    let found = units(&plan, Some(&listed)).unwrap();
    assert_eq!(found.len(), 2);
    assert_eq!(
        (&found[1].train[..], &found[1].model[..]),
        (&listed[1..2], "at/m.toml")
    );
    let none = units(&plan, Some(&[])).unwrap_err().to_string();
    assert_eq!(
        none,
        "at/plan.toml: no record matches s3://b/{machine}/{date}.csv, needed are records there"
    );
}
