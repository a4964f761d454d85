//! The work list: one unit for each diagnosis.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::FleetError;
use crate::pattern::{Fields, Pattern, is_named, is_remote};
use crate::plan::{DATE, MACHINE, Plan, RECORD};

/// Folders inside each other that are looked into.
const MOST_DEPTH: usize = 32;

/// One diagnosis: everything that a worker needs to know, on this machine or another.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unit {
    /// The machine.
    pub machine: String,
    /// The day, or whatever the plan calls a date.
    pub date: String,
    /// Further conditions by name; empty where the plan says nothing of this unit.
    pub conditions: Fields,
    /// File of the table, relative to its folder, with slashes.
    pub file: String,
    /// Model file.
    pub model: String,
    /// Records to learn from.
    pub train: Vec<String>,
    /// Records to judge by; empty to hold back the last part of each training record.
    pub check: Vec<String>,
    /// Kinds taken out of the catalogue.
    pub withhold: Vec<String>,
    /// Columns of other names, as `--map`.
    pub map: Vec<String>,
    /// Columns of a table without a header, as `--columns`.
    pub columns: Option<String>,
    /// Missing samples are filled, as `--mend`.
    pub mend: bool,
    /// Digest of the inputs that the table has an answer for already.
    pub known: Option<String>,
}

impl Unit {
    /// A unit from its JSON.
    ///
    /// # Errors
    /// [`FleetError::Unit`].
    pub fn from_json(text: &str) -> Result<Unit, FleetError> {
        serde_json::from_str(text).map_err(|error| FleetError::Unit {
            found: error.to_string(),
        })
    }

    /// The unit as JSON, on one line.
    ///
    /// # Errors
    /// [`FleetError::Unit`].
    pub fn to_json(&self) -> Result<String, FleetError> {
        serde_json::to_string(self).map_err(|error| FleetError::Unit {
            found: error.to_string(),
        })
    }
}

/// What a plan says of machines that no unit is of: a name that no record has, perhaps by a slip.
pub(crate) fn without_records(plan: &Plan, units: &[Unit]) -> Vec<String> {
    let is_idle = |name: &&String| units.iter().all(|unit| unit.machine != **name);
    let idle = plan.machines.keys().filter(is_idle);
    let told = idle.map(|name| format!("there is no record of [[machine]] \"{name}\" of the plan"));
    told.collect()
}

/// The units of a plan, sorted by their files in the table: records of the same machine, date and conditions are one unit.
///
/// `listed` are the paths of records in places that only other programs reach (a bucket, say), for the patterns of such
/// places; for the others, folders are looked into.
///
/// # Errors
/// [`FleetError`] when a folder cannot be listed, no record is found, or a machine has no model.
pub fn units(plan: &Plan, listed: Option<&[String]>) -> Result<Vec<Unit>, FleetError> {
    let mut groups: BTreeMap<String, (Fields, Vec<(String, String)>)> = BTreeMap::new();
    for pattern in &plan.records {
        let paths = match listed {
            Some(paths) if is_remote(&pattern.text) => paths.to_vec(),
            _ => files(plan, pattern)?,
        };
        for path in paths {
            let Some(mut fields) = pattern.fields_of(&path) else {
                continue;
            };
            let name = fields.remove(RECORD).unwrap_or_else(|| stem(&path));
            if let Some(entry) = fields.get(MACHINE).and_then(|m| plan.machines.get(m)) {
                for (key, value) in &entry.fields {
                    fields.entry(key.clone()).or_insert_with(|| value.clone());
                }
            }
            if !fields.contains_key(DATE) {
                return Err(FleetError::Plan {
                    path: plan.path.clone(),
                    found: format!("no date for {path}"),
                    needed: "{date} in the path, or date = \"..\" in its [[machine]]".to_owned(),
                });
            }
            let group = groups.entry(file_of(&fields)).or_insert((fields, vec![]));
            if !group.1.iter().any(|(_, known)| *known == path) {
                group.1.push((name, path));
            }
        }
    }
    if groups.is_empty() {
        let patterns: Vec<&str> = plan.records.iter().map(|p| p.text.as_str()).collect();
        return Err(FleetError::NoRecords {
            path: plan.path.clone(),
            patterns: patterns.join(", "),
        });
    }
    let units = groups.into_iter();
    units
        .map(|(file, (fields, records))| unit(plan, file, fields, records))
        .collect()
}

fn unit(
    plan: &Plan,
    file: String,
    mut fields: Fields,
    mut records: Vec<(String, String)>,
) -> Result<Unit, FleetError> {
    records.sort();
    let machine = fields.remove(MACHINE).unwrap_or_default();
    let date = fields.remove(DATE).unwrap_or_default();
    let model = plan.model_of(&machine)?;
    let judges = |name: &str| plan.check.iter().any(|glob| is_named(glob, name));
    let (check, train): (Vec<_>, Vec<_>) = records.into_iter().partition(|(name, _)| judges(name));
    let paths = |records: Vec<(String, String)>| -> Vec<String> {
        let located = records.into_iter().map(|(_, path)| match is_remote(&path) {
            true => path,
            false => plan.folder.join(path).to_string_lossy().into_owned(),
        });
        located.collect()
    };
    Ok(Unit {
        machine,
        date,
        conditions: fields,
        file,
        model: model.to_string_lossy().into_owned(),
        train: paths(train),
        check: paths(check),
        withhold: plan.withhold.clone(),
        map: plan.reading.map.clone(),
        columns: plan.reading.columns.clone(),
        mend: plan.reading.mend,
        known: None,
    })
}

/// The file of a unit in the table: partitions by machine and date as Hive writes them, then the conditions.
fn file_of(fields: &Fields) -> String {
    let get = |key: &str| fields.get(key).map(String::as_str).unwrap_or_default();
    let others = fields
        .iter()
        .filter(|(k, _)| ![MACHINE, DATE].contains(&k.as_str()));
    let others: Vec<String> = others
        .map(|(key, value)| format!("{key}={}", escaped(value)))
        .collect();
    let name = match others.is_empty() {
        true => "diagnosis".to_owned(),
        false => others.join(","),
    };
    let (machine, date) = (escaped(get(MACHINE)), escaped(get(DATE)));
    format!("machine={machine}/date={date}/{name}.parquet")
}

/// A value as a name of a folder: what could be taken for something else as `%` and two digits.
fn escaped(value: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-_. +".contains(&b);
    let bytes = value.bytes().enumerate();
    bytes
        .map(
            |(index, byte)| match plain(byte) && !(index == 0 && byte == b'.') {
                true => char::from(byte).to_string(),
                false => format!("%{byte:02X}"),
            },
        )
        .collect()
}

fn stem(path: &str) -> String {
    simgap_app::text::stem(Path::new(path))
}

/// The files below the folder of a pattern, sorted, relative to the folder of the plan.
fn files(plan: &Plan, pattern: &Pattern) -> Result<Vec<String>, FleetError> {
    if is_remote(&pattern.text) {
        return Err(FleetError::Pattern {
            path: plan.path.clone(),
            pattern: pattern.text.clone(),
            found: "a place that this program does not reach".to_owned(),
            needed: "a folder, or simgap.fleet.run in Python with fsspec",
        });
    }
    let mut found = Vec::new();
    let root = match pattern.root.is_empty() {
        true => plan.folder.clone(),
        false => plan.folder.join(&pattern.root),
    };
    let root = match root.as_os_str().is_empty() {
        true => PathBuf::from("."),
        false => root,
    };
    list(&root, &pattern.root, MOST_DEPTH, &mut found)?;
    found.sort();
    Ok(found)
}

fn list(
    folder: &Path,
    prefix: &str,
    depth: usize,
    found: &mut Vec<String>,
) -> Result<(), FleetError> {
    let refused = |error: std::io::Error| FleetError::Listing {
        path: folder.into(),
        found: error.kind().to_string(),
    };
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        // A name that is no text can be in no plan.
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let path = match prefix.is_empty() || prefix.ends_with('/') {
            true => format!("{prefix}{name}"),
            false => format!("{prefix}/{name}"),
        };
        let kind = entry.path().metadata();
        match kind.map(|kind| kind.is_dir()) {
            Ok(true) if depth > 0 => list(&entry.path(), &path, depth - 1, found)?,
            Ok(false) => found.push(path),
            _ => {}
        }
    }
    Ok(())
}
