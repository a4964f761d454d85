//! The shape of `diagnosis.json` as `docs/contract.md` writes it down.

use serde_json::Value;

use super::Bench;

pub fn diagnosis(bench: &Bench, out: &str) -> Value {
    serde_json::from_str(&bench.read(&format!("{out}/diagnosis.json"))).unwrap()
}

pub fn names(bench: &Bench, folder: &str) -> Vec<String> {
    let files = bench.files(folder);
    files.keys().map(|p| p.display().to_string()).collect()
}

pub fn keys(value: &Value) -> Vec<&str> {
    value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect()
}

/// The object has these keys; more may be added.
pub fn has(value: &Value, wanted: &[&str]) {
    for key in wanted {
        assert!(keys(value).contains(key), "no \"{key}\" in {value}");
    }
}

pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("not a number: {value}"))
}

pub fn share(value: &Value) {
    assert!((0.0..=1.0).contains(&number(value)), "not a share: {value}");
}

pub fn string(value: &Value) -> &str {
    value
        .as_str()
        .unwrap_or_else(|| panic!("not a text: {value}"))
}

pub fn list(value: &Value) -> &Vec<Value> {
    value
        .as_array()
        .unwrap_or_else(|| panic!("not a list: {value}"))
}

/// One of the four forms of a place.
pub fn place(at: &Value) {
    let [key] = keys(at)[..] else {
        panic!("not one key: {at}")
    };
    match key {
        "between" => {
            let ends = list(&at[key]);
            assert_eq!(ends.len(), 2, "{at}");
            ends.iter().for_each(|end| assert!(!string(end).is_empty()));
        }
        "mass" | "input" | "channel" => assert!(!string(&at[key]).is_empty()),
        _ => panic!("not a place: {at}"),
    }
}

pub fn gap_figures(gap: &Value) {
    for key in ["nominal", "recalibrated", "corrected", "noise_floor"] {
        assert!(number(&gap[key]) >= 0.0, "{key}: {gap}");
    }
    assert!(
        number(&gap["noise_floor"]) <= number(&gap["corrected"]),
        "{gap}"
    );
}

/// Every key the contract writes down, with its type.
pub fn check_schema(diagnosis: &Value) {
    has(
        diagnosis,
        &[
            "schema",
            "gap",
            "where",
            "verdict",
            "candidates",
            "next_experiment",
        ],
    );
    assert_eq!(diagnosis["schema"], "simgap-diagnosis/1");
    let gap = &diagnosis["gap"];
    assert_eq!(gap["metric"], "nrmse");
    gap_figures(gap);
    assert!(number(&gap["closed"]) <= 1.0);
    for channel in list(&gap["channels"]) {
        string(&channel["channel"]);
        gap_figures(channel);
    }
    check_where(&diagnosis["where"]);
    check_verdict(&diagnosis["verdict"]);
    for candidate in list(&diagnosis["candidates"]) {
        string(&candidate["kind"]);
        place(&candidate["at"]);
        assert!(number(&candidate["held_back_gap"]) >= 0.0);
        share(&candidate["probability"]);
    }
    let next = &diagnosis["next_experiment"];
    assert!(next.is_null() || !string(next).is_empty());
}

pub fn check_where(found: &Value) {
    has(
        found,
        &[
            "channels",
            "locations",
            "bands",
            "times",
            "states",
            "records",
        ],
    );
    let each = |key: &str, texts: &[&str], numbers: &[&str]| {
        for item in list(&found[key]) {
            share(&item["share"]);
            texts
                .iter()
                .for_each(|t| assert!(!string(&item[t]).is_empty()));
            numbers
                .iter()
                .for_each(|n| assert!(number(&item[n]).is_finite()));
            if let [from, to] = numbers {
                assert!(number(&item[from]) < number(&item[to]), "{item}");
            }
        }
    };
    each("channels", &["channel"], &[]);
    each("locations", &[], &[]);
    list(&found["locations"])
        .iter()
        .for_each(|item| place(&item["at"]));
    each("bands", &["label"], &["from_hz", "to_hz"]);
    each("times", &["record"], &["from_s", "to_s"]);
    each("states", &["label", "variable", "at"], &["from", "to"]);
    each("records", &["record"], &[]);
    for whole in ["channels", "records"] {
        let sum: f64 = list(&found[whole])
            .iter()
            .map(|i| number(&i["share"]))
            .sum();
        assert!(
            (sum - 1.0).abs() < 1e-9,
            "the shares of the {whole} add up to {sum}"
        );
    }
}

pub fn check_verdict(verdict: &Value) {
    let status = string(&verdict["status"]);
    let effects = list(&verdict["effects"]);
    match status {
        "none" | "unknown" => assert!(effects.is_empty(), "{status} blames nothing"),
        "parameters" | "effect" => assert!(!effects.is_empty(), "{status} names something"),
        _ => panic!("no such status: {status}"),
    }
    for effect in effects {
        string(&effect["kind"]);
        place(&effect["at"]);
        share(&effect["probability"]);
        for parameter in list(&effect["parameters"]) {
            string(&parameter["name"]);
            let value = number(&parameter["value"]);
            let ends = list(&parameter["ci95"]);
            assert_eq!(ends.len(), 2);
            // null: the data do not see this end.
            assert!(
                ends[0].is_null() || number(&ends[0]) <= value,
                "{parameter}"
            );
            assert!(
                ends[1].is_null() || number(&ends[1]) >= value,
                "{parameter}"
            );
        }
        for rival in list(&effect["indistinguishable"]) {
            string(&rival["kind"]);
            place(&rival["at"]);
            assert!(!string(&rival["because"]).is_empty());
        }
        list(&effect["evidence"])
            .iter()
            .for_each(|e| assert!(!string(e).is_empty()));
    }
}
