//! The plan: where records lie, which model belongs to which machine, what is trained on and what judges.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use simgap_app::diagnosis::known_kinds;
use simgap_app::input::RecordOptions;

use crate::FleetError;
use crate::pattern::{Fields, Pattern, is_remote};
use crate::row::FIXED_COLUMNS;

/// Schema of a plan.
pub const SCHEMA: &str = "simgap-plan/1";
/// No plan is longer, bytes.
const MOST_BYTES: u64 = 16 << 20;
/// Fields with a meaning of their own.
pub(crate) const MACHINE: &str = "machine";
pub(crate) const DATE: &str = "date";
pub(crate) const RECORD: &str = "record";

/// The plan as the file holds it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: String,
    name: String,
    records: Vec<String>,
    #[serde(default)]
    check: Vec<String>,
    model: Option<PathBuf>,
    #[serde(default)]
    withhold: Vec<String>,
    #[serde(default)]
    map: Vec<String>,
    columns: Option<String>,
    #[serde(default)]
    mend: bool,
    #[serde(default)]
    machine: Vec<BTreeMap<String, toml::Value>>,
}

/// A checked plan.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The file, as messages call it.
    pub path: PathBuf,
    /// The folder that paths in it are relative to.
    pub folder: PathBuf,
    /// Name of the fleet.
    pub name: String,
    /// Where records lie.
    pub records: Vec<Pattern>,
    /// Names of the records that judge (`*` stands for anything); the others are trained on.
    pub check: Vec<String>,
    /// The model of machines that name none.
    pub model: Option<PathBuf>,
    /// Kinds taken out of the catalogue.
    pub withhold: Vec<String>,
    /// How records are read.
    pub reading: RecordOptions,
    /// What is said of single machines, by name.
    pub machines: BTreeMap<String, MachineEntry>,
    /// Names of the conditions, sorted: fields of the paths and of the machines beyond machine, date and record.
    pub conditions: Vec<String>,
}

/// What a plan says of one machine.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MachineEntry {
    /// Its own model.
    pub model: Option<PathBuf>,
    /// Its conditions: rig, load, a date where paths hold none.
    pub fields: Fields,
}

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// [`FleetError`] when it cannot be read or is not valid.
    pub fn read(path: &Path) -> Result<Plan, FleetError> {
        let unreadable = |found: String| FleetError::PlanFile {
            path: path.into(),
            found,
        };
        let file = std::fs::File::open(path)
            .map_err(|error| unreadable(format!("cannot be read ({})", error.kind())))?;
        let mut text = String::new();
        file.take(MOST_BYTES + 1)
            .read_to_string(&mut text)
            .map_err(|error| unreadable(format!("cannot be read ({})", error.kind())))?;
        if text.len() as u64 > MOST_BYTES {
            return Err(unreadable(format!("longer than {MOST_BYTES} bytes")));
        }
        Plan::parse(&text, path)
    }

    /// A plan from its text; paths in it are relative to the folder of `path`.
    ///
    /// # Errors
    /// [`FleetError`] when it is not valid.
    pub fn parse(text: &str, path: &Path) -> Result<Plan, FleetError> {
        let refused = |found: String, needed: &str| FleetError::Plan {
            path: path.into(),
            found,
            needed: needed.to_owned(),
        };
        let file: File = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(0, |span| {
                1 + text[..span.start.min(text.len())].matches('\n').count()
            });
            let found = error.message().lines().collect::<Vec<_>>().join(", ");
            refused(format!("line {line}: {found}"), "a valid plan")
        })?;
        if file.schema != SCHEMA {
            let found = format!("schema = \"{}\"", file.schema);
            return Err(refused(found, "schema = \"simgap-plan/1\""));
        }
        if file.records.is_empty() {
            return Err(refused(
                "no pattern in records".to_owned(),
                "at least one, such as records = [\"{machine}/{date}/{record}.csv\"]",
            ));
        }
        known_kinds(&file.withhold, None)?;
        let mut machines = BTreeMap::new();
        for entry in file.machine {
            let (name, entry) = machine_entry(entry).map_err(|(f, n)| refused(f, n))?;
            if machines.insert(name.clone(), entry).is_some() {
                let found = format!("[[machine]] name = \"{name}\" twice");
                return Err(refused(found, "each machine once"));
            }
        }
        let records = patterns(&file.records, path)?;
        let plan = Plan {
            path: path.into(),
            folder: path.parent().map(Path::to_path_buf).unwrap_or_default(),
            name: file.name,
            conditions: conditions(&records, &machines),
            records,
            check: file.check,
            model: file.model,
            withhold: file.withhold,
            reading: RecordOptions {
                map: file.map,
                columns: file.columns,
                mend: file.mend,
            },
            machines,
        };
        plan.checked()
    }

    fn checked(self) -> Result<Plan, FleetError> {
        let refused = |found: String, needed: &str| FleetError::Plan {
            path: self.path.clone(),
            found,
            needed: needed.to_owned(),
        };
        if let Some(taken) = (self.conditions.iter()).find(|c| FIXED_COLUMNS.contains(&c.as_str()))
        {
            let found = format!("a condition called \"{taken}\"");
            return Err(refused(
                found,
                "another name: the table has a column of that name",
            ));
        }
        for pattern in &self.records {
            let has = |field: &str| pattern.fields().any(|name| name == field);
            let dated = self.machines.values().any(|m| m.fields.contains_key(DATE));
            let missing = match (has(MACHINE), has(DATE) || dated) {
                (false, _) => "no field {machine}",
                (_, false) => "no field {date}",
                _ => continue,
            };
            return Err(FleetError::Pattern {
                path: self.path.clone(),
                pattern: pattern.text.clone(),
                found: missing.to_owned(),
                needed: "{machine} and {date} in the path, or date = \"..\" in every [[machine]]",
            });
        }
        Ok(self)
    }

    /// The model file of a machine.
    ///
    /// # Errors
    /// [`FleetError::Plan`] when the plan names none.
    pub fn model_of(&self, machine: &str) -> Result<PathBuf, FleetError> {
        let own = self.machines.get(machine).and_then(|m| m.model.as_ref());
        own.or(self.model.as_ref())
            .map(|model| match is_remote(&model.to_string_lossy()) {
                true => model.clone(),
                false => self.folder.join(model),
            })
            .ok_or_else(|| FleetError::Plan {
                path: self.path.clone(),
                found: format!("no model for machine \"{machine}\""),
                needed: "model = \"..\" in its [[machine]] or for all".to_owned(),
            })
    }
}

fn patterns(texts: &[String], path: &Path) -> Result<Vec<Pattern>, FleetError> {
    let parsed = texts.iter().map(|text| {
        Pattern::parse(text).map_err(|(found, needed)| FleetError::Pattern {
            path: path.into(),
            pattern: text.clone(),
            found,
            needed,
        })
    });
    parsed.collect()
}

type Refused = (String, &'static str);

fn machine_entry(entry: BTreeMap<String, toml::Value>) -> Result<(String, MachineEntry), Refused> {
    let mut name = None;
    let mut found = MachineEntry::default();
    for (key, value) in entry {
        let text = match value {
            toml::Value::String(text) => text,
            toml::Value::Integer(number) => number.to_string(),
            toml::Value::Float(number) => number.to_string(),
            toml::Value::Boolean(flag) => flag.to_string(),
            toml::Value::Datetime(date) => date.to_string(),
            toml::Value::Array(_) | toml::Value::Table(_) => {
                let found = format!("a list or a table in {key} of a [[machine]]");
                return Err((found, "text or a number"));
            }
        };
        if text.is_empty() {
            return Err((
                format!("an empty {key} in a [[machine]]"),
                "text or a number",
            ));
        }
        match key.as_str() {
            "name" => name = Some(text),
            "model" => found.model = Some(text.into()),
            MACHINE | RECORD => {
                let found = format!("{key} in a [[machine]]");
                return Err((found, "name, model, and conditions such as rig or load"));
            }
            _ => drop(found.fields.insert(key, text)),
        }
    }
    let name = name.ok_or_else(|| ("a [[machine]] without a name".to_owned(), "name = \"..\""))?;
    Ok((name, found))
}

fn conditions(records: &[Pattern], machines: &BTreeMap<String, MachineEntry>) -> Vec<String> {
    let of_paths = records.iter().flat_map(Pattern::fields).map(str::to_owned);
    let of_machines = machines.values().flat_map(|m| m.fields.keys().cloned());
    let mut all: Vec<String> = of_paths.chain(of_machines).collect();
    all.retain(|field| ![MACHINE, DATE, RECORD].contains(&field.as_str()));
    all.sort();
    all.dedup();
    all
}
