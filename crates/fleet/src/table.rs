//! The table: one Parquet file for each unit, in folders by machine and date.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bytes::Bytes;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;
use simgap_record::Batch;

use crate::FleetError;
use crate::row::{Role, Row};
use crate::unit::Unit;

/// Key of the digest in the metadata of a file.
const DIGEST: &str = "simgap.inputs";
/// No file of the table is longer, bytes.
const MOST_BYTES: u64 = 64 << 20;

/// A column: of each row the value, or none.
enum Column {
    Text(Vec<Option<String>>),
    Number(Vec<Option<f64>>),
    Flag(Vec<Option<bool>>),
}

/// The columns of a unit, in order.
fn columns(unit: &Unit, rows: &[Row], digest: &str) -> Vec<(String, Column)> {
    let text = |of: &dyn Fn(&Row) -> Option<String>| Column::Text(rows.iter().map(of).collect());
    let number = |of: &dyn Fn(&Row) -> Option<f64>| Column::Number(rows.iter().map(of).collect());
    let flag = |of: &dyn Fn(&Row) -> Option<bool>| Column::Flag(rows.iter().map(of).collect());
    let same = |value: &str| {
        let value = (!value.is_empty()).then(|| value.to_owned());
        Column::Text(rows.iter().map(|_| value.clone()).collect())
    };
    let names = |paths: &[String]| {
        let paths = paths
            .iter()
            .map(|path| simgap_app::text::file_name(Path::new(path)));
        paths.collect::<Vec<_>>().join(" ")
    };
    let mut columns = vec![
        ("role", text(&|r| Some(r.role.name().to_owned()))),
        ("status", text(&|r| Some(r.status.clone()))),
        ("complete", flag(&|r| r.complete)),
        ("refuted", flag(&|r| r.refuted)),
        ("kind", text(&|r| r.kind.clone())),
        ("place", text(&|r| r.place.clone())),
        ("probability", number(&|r| r.probability)),
        ("parameter", text(&|r| r.parameter.clone())),
        ("value", number(&|r| r.value)),
        ("low", number(&|r| r.low)),
        ("high", number(&|r| r.high)),
        ("prior_std", number(&|r| r.prior_std)),
        ("gap_nominal", number(&|r| r.gap_nominal)),
        ("gap_corrected", number(&|r| r.gap_corrected)),
        ("noise_floor", number(&|r| r.noise_floor)),
        ("closed", number(&|r| r.closed)),
        ("reason", text(&|r| r.reason.clone())),
        ("train", same(&names(&unit.train))),
        ("check", same(&names(&unit.check))),
        ("inputs", same(digest)),
        ("version", same(env!("CARGO_PKG_VERSION"))),
    ];
    let conditions = unit.conditions.iter();
    columns.extend(conditions.map(|(name, value)| (name.as_str(), same(value))));
    let named = columns.into_iter();
    named
        .map(|(name, column)| (name.to_owned(), column))
        .collect()
}

/// The file of a unit, as Parquet without compression: the same rows give the same bytes.
///
/// # Errors
/// [`FleetError::Encode`].
pub fn encode(unit: &Unit, rows: &[Row], digest: &str) -> Result<Vec<u8>, FleetError> {
    encoded(&columns(unit, rows, digest), digest).map_err(|error| FleetError::Encode {
        found: error.to_string(),
    })
}

fn encoded(columns: &[(String, Column)], digest: &str) -> Result<Vec<u8>, ParquetError> {
    let fields = columns.iter().map(|(name, column)| match column {
        Column::Text(_) => format!("optional binary {name} (UTF8);"),
        Column::Number(_) => format!("optional double {name};"),
        Column::Flag(_) => format!("optional boolean {name};"),
    });
    let fields: Vec<String> = fields.collect();
    let schema = parse_message_type(&format!("message diagnoses {{ {} }}", fields.join(" ")))?;
    let properties = WriterProperties::builder()
        .set_created_by(format!("simgap {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(vec![KeyValue::new(
            DIGEST.to_owned(),
            digest.to_owned(),
        )]))
        .build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (_, column) in columns {
        let Some(mut out) = group.next_column()? else {
            break;
        };
        match column {
            Column::Text(values) => {
                let (levels, there) = parted(values);
                let there: Vec<ByteArray> = there.iter().map(|t| t.as_str().into()).collect();
                out.typed::<ByteArrayType>()
                    .write_batch(&there, Some(&levels), None)?;
            }
            Column::Number(values) => {
                let (levels, there) = parted(values);
                out.typed::<DoubleType>()
                    .write_batch(&there, Some(&levels), None)?;
            }
            Column::Flag(values) => {
                let (levels, there) = parted(values);
                out.typed::<BoolType>()
                    .write_batch(&there, Some(&levels), None)?;
            }
        }
        out.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

/// Levels of definition, and the values that are there.
fn parted<T: Clone>(values: &[Option<T>]) -> (Vec<i16>, Vec<T>) {
    let levels = values.iter().map(|value| i16::from(value.is_some()));
    (levels.collect(), values.iter().flatten().cloned().collect())
}

/// A table in a folder.
#[derive(Debug, Clone)]
pub struct Table {
    folder: PathBuf,
}

impl Table {
    /// The table of a folder of results.
    #[must_use]
    pub fn of(out: &Path) -> Table {
        Table {
            folder: out.join("table"),
        }
    }

    /// The file of a unit.
    #[must_use]
    pub fn path(&self, unit: &Unit) -> PathBuf {
        self.folder.join(&unit.file)
    }

    /// Digest of the inputs that the file of a unit answers; `None` where there is no file, or none that can be read.
    #[must_use]
    pub fn known(&self, unit: &Unit) -> Option<String> {
        let file = read(&self.path(unit)).ok()?;
        let metadata = file.metadata().file_metadata().key_value_metadata()?;
        let digest = metadata.iter().find(|entry| entry.key == DIGEST)?;
        digest.value.clone()
    }

    /// Puts the file of a unit in its place, in one step: a reader sees all of it or nothing.
    ///
    /// # Errors
    /// [`FleetError::Record`] when the system refuses.
    pub fn put(&self, unit: &Unit, bytes: &[u8]) -> Result<(), FleetError> {
        let path = self.path(unit);
        let folder = path.parent().unwrap_or(&self.folder);
        simgap_record::ensure_writable_dir(folder)?;
        let mut batch = Batch::default();
        batch.add(&path, bytes)?;
        Ok(batch.commit()?)
    }

    /// Removes what killed runs left beside the file of a unit.
    pub fn clear(&self, unit: &Unit) {
        let path = self.path(unit);
        let entries = path
            .parent()
            .and_then(|folder| std::fs::read_dir(folder).ok());
        for entry in entries.into_iter().flatten().flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if name.starts_with(".simgap-") && name.ends_with(".part") {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }

    /// The rows of a unit; none where there is no file.
    ///
    /// # Errors
    /// [`FleetError::Table`] when the file is damaged.
    pub fn rows(&self, unit: &Unit) -> Result<Vec<Row>, FleetError> {
        let path = self.path(unit);
        if !path.exists() {
            return Ok(vec![]);
        }
        let damaged = |found: String| FleetError::Table {
            path: path.clone(),
            found,
        };
        let file = read(&path).map_err(damaged)?;
        guarded(|| decoded(&file)).map_err(damaged)
    }
}

fn read(path: &Path) -> Result<SerializedFileReader<Bytes>, String> {
    let long = std::fs::metadata(path).map_err(|error| error.kind().to_string())?;
    if long.len() > MOST_BYTES {
        return Err(format!("longer than {MOST_BYTES} bytes"));
    }
    let bytes = Bytes::from(std::fs::read(path).map_err(|error| error.kind().to_string())?);
    guarded(|| SerializedFileReader::new(bytes))
}

/// What another crate's reader finds, or why it does not; a panic of its is no end of ours.
fn guarded<T>(read: impl FnOnce() -> Result<T, ParquetError>) -> Result<T, String> {
    match simgap_record::without_panic(read) {
        Some(found) => found.map_err(|error| error.to_string()),
        None => Err("its bytes contradict each other".to_owned()),
    }
}

fn decoded(file: &SerializedFileReader<Bytes>) -> Result<Vec<Row>, ParquetError> {
    let mut rows = Vec::new();
    for row in file.get_row_iter(None)? {
        let row = row?;
        let field = |name: &str| {
            row.get_column_iter()
                .find(|(n, _)| *n == name)
                .map(|(_, f)| f)
        };
        let text = |name: &str| match field(name) {
            Some(Field::Str(text)) => Some(text.clone()),
            _ => None,
        };
        let number = |name: &str| match field(name) {
            Some(Field::Double(value)) => Some(*value),
            _ => None,
        };
        let flag = |name: &str| match field(name) {
            Some(Field::Bool(value)) => Some(*value),
            _ => None,
        };
        let role = text("role").unwrap_or_default();
        let role = Role::ALL.into_iter().find(|known| known.name() == role);
        rows.push(Row {
            role: role.ok_or_else(|| ParquetError::General("a row without a role".to_owned()))?,
            status: text("status").unwrap_or_default(),
            complete: flag("complete"),
            refuted: flag("refuted"),
            kind: text("kind"),
            place: text("place"),
            probability: number("probability"),
            parameter: text("parameter"),
            value: number("value"),
            low: number("low"),
            high: number("high"),
            prior_std: number("prior_std"),
            gap_nominal: number("gap_nominal"),
            gap_corrected: number("gap_corrected"),
            noise_floor: number("noise_floor"),
            closed: number("closed"),
            reason: text("reason"),
        });
    }
    Ok(rows)
}
