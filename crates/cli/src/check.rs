//! `simgap check`: what records hold, before a model has to make sense of them.

use serde::Serialize;
use simgap_app::diagnosis::is_beyond_quality;
use simgap_app::input::{self, Input};
use simgap_record::{Channel, Defect, QualityFinding, Quantity, Record, UnitKind, quality};

use crate::args::{CheckArgs, Format};
use crate::audit;
use crate::error::CliError;
use crate::stdout::{say, say_plain};
use crate::text::{STRONG, figure, named, shown, styled, table};

/// The schema of `--format json`.
const SCHEMA: &str = "simgap-check/1";
/// Where the text of a named line begins.
const INDENT: usize = 14;
/// Sample rates closer than this are one rate, relative: a crystal is better than that.
const SAME_RATE: f64 = 1e-3;

pub(crate) fn run(args: &CheckArgs) -> Result<(), CliError> {
    let model = args.model.as_deref().map(input::model).transpose()?;
    let mut records = Vec::new();
    let mut read = Vec::new();
    for path in &args.records {
        let Input { record, notes, .. } = input::table(path, &args.reading.options())?;
        records.push(Checked::new(path.display().to_string(), &record, notes));
        read.push(record);
    }
    let read: Vec<&Record> = read.iter().map(|record| &**record).collect();
    let mut findings = match &model {
        Some(model) => simgap_diagnose::audit::audit(model, &read)?,
        None => simgap_record::audit(&read),
    };
    // What a single column shows stands beside it.
    findings.retain(is_beyond_quality);
    let differences = differences(&records);
    match args.format {
        Format::Human => {
            let mut text = String::new();
            records.iter().for_each(|record| told(&mut text, record));
            for difference in &differences {
                named(&mut text, "but", difference, INDENT);
            }
            if !findings.is_empty() && !differences.is_empty() {
                text.push('\n');
            }
            text.push_str(&audit::told(&findings));
            say(&text)?;
        }
        Format::Json => say_plain(&simgap_app::json(&Answer {
            schema: SCHEMA,
            records,
            differences,
            audit: findings.iter().map(audit::Entry::new).collect(),
        })?)?,
    }
    Ok(())
}

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    records: Vec<Checked>,
    /// What several records do not have in common.
    differences: Vec<String>,
    /// What is odd about them together, and against the model if there is one.
    audit: Vec<audit::Entry>,
}

#[derive(Serialize)]
struct Checked {
    file: String,
    rows: usize,
    time: TimeBase,
    columns: Vec<Column>,
    /// What was guessed or changed to read it: the layout, missing samples, uneven stamps.
    notes: Vec<String>,
}

#[derive(Serialize)]
struct TimeBase {
    from_s: f64,
    to_s: f64,
    time_step_s: f64,
    sample_rate_hz: f64,
    /// How the stamps were converted, if they were not in seconds.
    conversion: Option<String>,
    findings: Vec<Finding>,
}

#[derive(Serialize)]
struct Column {
    name: String,
    unit: String,
    /// What the unit measures, in words.
    measures: String,
    /// SI unit of what is measured, and how many there are in one of the header; `null` for what is
    /// no quantity of a model.
    si_unit: Option<&'static str>,
    si_factor: Option<f64>,
    /// In the unit of the header, as are the next two.
    smallest: f64,
    largest: f64,
    mean: f64,
    findings: Vec<Finding>,
}

#[derive(Serialize)]
struct Finding {
    kind: &'static str,
    text: String,
}

impl Checked {
    fn new(file: String, record: &Record, notes: Vec<String>) -> Checked {
        let findings = quality(record);
        let of = |name: &str| {
            let mine = findings.iter().filter(|finding| finding.channel == name);
            mine.map(finding).collect::<Vec<Finding>>()
        };
        let time_s = record.time_s();
        let conversion = record.conversions_to(&[]).first().map(ToString::to_string);
        // The time base is the only thing that jitters, whatever a column is called.
        let (jitter, _): (Vec<&QualityFinding>, Vec<_>) = findings
            .iter()
            .partition(|f| matches!(f.defect, Defect::TimeJitter { .. }));
        Checked {
            file,
            rows: record.len(),
            time: TimeBase {
                from_s: time_s.first().copied().unwrap_or(0.0),
                to_s: time_s.last().copied().unwrap_or(0.0),
                time_step_s: record.time_step_s(),
                sample_rate_hz: record.sample_rate_hz(),
                conversion,
                findings: jitter.into_iter().map(finding).collect(),
            },
            columns: record
                .channels()
                .iter()
                .map(|channel| Column::new(channel, of(&channel.name)))
                .collect(),
            notes,
        }
    }
}

impl Column {
    fn new(channel: &Channel, findings: Vec<Finding>) -> Column {
        let (values, unit) = (&channel.values, &channel.unit);
        let known = unit.kind() != UnitKind::Other;
        let extreme = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick);
        Column {
            name: channel.name.clone(),
            unit: unit.symbol().to_string(),
            measures: unit.kind().to_string(),
            si_unit: known.then(|| unit.kind().si_symbol()),
            si_factor: known.then(|| unit.si_factor()),
            smallest: extreme(f64::min).unwrap_or(0.0),
            largest: extreme(f64::max).unwrap_or(0.0),
            mean: values.iter().sum::<f64>() / values.len().max(1) as f64,
            findings,
        }
    }
}

fn finding(finding: &QualityFinding) -> Finding {
    let kind = match finding.defect {
        Defect::Flat { .. } => "flat",
        Defect::Clipped { .. } => "clipped",
        Defect::Quantised { .. } => "quantised",
        Defect::Repeated { .. } => "repeated",
        Defect::Spikes { .. } => "spikes",
        Defect::Alternation { .. } => "alternation",
        Defect::TimeJitter { .. } => "time_jitter",
        _ => "other",
    };
    Finding {
        kind,
        text: finding.to_string(),
    }
}

/// What a person is told of one record.
fn told(text: &mut String, record: &Checked) {
    let time = &record.time;
    text.push_str(&format!("{}\n", styled(STRONG, &shown(&record.file))));
    let base = format!(
        "{} samples from {} s to {} s, every {} s ({} Hz)",
        record.rows,
        figure(time.from_s),
        figure(time.to_s),
        figure(time.time_step_s),
        figure(time.sample_rate_hz)
    );
    named(text, "time", &base, INDENT);
    if let Some(conversion) = &time.conversion {
        named(text, "", conversion, INDENT);
    }
    text.push('\n');
    let head = [
        "column", "unit", "in SI", "smallest", "largest", "mean", "can be",
    ];
    let rows: Vec<Vec<String>> = record.columns.iter().map(row).collect();
    table(text, &head, &rows, &[3, 4, 5]);
    text.push('\n');
    let of_columns = record.columns.iter().flat_map(|column| &column.findings);
    let findings: Vec<&Finding> = time.findings.iter().chain(of_columns).collect();
    for (i, finding) in findings.iter().enumerate() {
        let name = if i == 0 { "quality" } else { "" };
        named(text, name, &finding.text, INDENT);
    }
    if findings.is_empty() {
        named(text, "quality", "nothing odd", INDENT);
    }
    for (i, note) in record.notes.iter().enumerate() {
        named(text, if i == 0 { "notes" } else { "" }, note, INDENT);
    }
    text.push('\n');
}

fn row(column: &Column) -> Vec<String> {
    let si = match (column.si_unit, column.si_factor) {
        (Some(unit), Some(1.0)) => unit.to_string(),
        (Some(unit), Some(factor)) => format!("{unit} (times {})", figure(factor)),
        _ => "none".to_string(),
    };
    vec![
        shown(&column.name),
        shown(&column.unit),
        si,
        figure(column.smallest),
        figure(column.largest),
        figure(column.mean),
        role(&column.unit).to_string(),
    ]
}

/// What a model file can take a column of this unit for.
pub(crate) fn role(unit: &str) -> &'static str {
    let kind = simgap_record::Unit::parse(unit).kind();
    match quantity(kind) {
        Some(Quantity::Force) => "input or output: force",
        Some(Quantity::Displacement) => "output, or base input: displacement",
        Some(Quantity::Velocity) => "output: velocity",
        Some(Quantity::Acceleration) => "output: acceleration",
        _ => "either, with a gain",
    }
}

/// What a model takes a unit for; `None` for what needs a gain.
pub(crate) fn quantity(kind: UnitKind) -> Option<Quantity> {
    [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::Acceleration,
        Quantity::Force,
    ]
    .into_iter()
    .find(|quantity| quantity.accepts(kind))
}

/// What records have that the first has not, and the other way round.
fn differences(records: &[Checked]) -> Vec<String> {
    let Some((first, rest)) = records.split_first() else {
        return vec![];
    };
    let mut found = Vec::new();
    for other in rest {
        let (a, b) = (first.time.sample_rate_hz, other.time.sample_rate_hz);
        if (a / b - 1.0).abs() > SAME_RATE {
            found.push(format!(
                "{} is sampled at {} Hz, {} at {} Hz",
                other.file,
                figure(b),
                first.file,
                figure(a)
            ));
        }
        for (one, two) in [(first, other), (other, first)] {
            let missing = one
                .columns
                .iter()
                .filter(|column| two.columns.iter().all(|known| known.name != column.name));
            found.extend(missing.map(|column| {
                format!(
                    "{} has column '{}', {} has not",
                    one.file, column.name, two.file
                )
            }));
        }
        for column in &first.columns {
            let same = other.columns.iter().find(|known| known.name == column.name);
            if let Some(same) = same.filter(|same| same.unit != column.unit) {
                found.push(format!(
                    "column '{}' is in [{}] in {} and in [{}] in {}",
                    column.name, column.unit, first.file, same.unit, other.file
                ));
            }
        }
    }
    found
}
