//! `simgap diagnose`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use simgap_diagnose::audit::audit;
use simgap_diagnose::{CheckSeries, Outcome, Request, diagnose};
use simgap_model::Model;
use simgap_record::Record;
use simgap_report::page::{PictureFile, ReportInput, report};

use crate::args::{DiagnoseArgs, Format};
use crate::error::CliError;
use crate::folder::Folder;
use crate::manifest::Results;
use crate::progress::Steps;
use crate::text::command;
use crate::{effects, input, repeated, say};

/// Folder of the predictions, inside the folder of the results.
const PREDICTIONS: &str = "predictions";
/// Folder of the pictures of the page and their data, inside it too.
const PICTURES: &str = "pictures";

/// More threads than any machine has cores for; starting a hundred thousand takes minutes.
const MOST_JOBS: usize = 1024;

pub(crate) fn run(args: &DiagnoseArgs) -> Result<(), CliError> {
    if let Some(found) = args.jobs.filter(|jobs| !(1..=MOST_JOBS).contains(jobs)) {
        let most = MOST_JOBS;
        return Err(CliError::Jobs { found, most });
    }
    let judged = if args.check.is_empty() {
        &args.train
    } else {
        &args.check
    };
    distinct_stems(judged)?;
    for kind in &args.withhold {
        effects::known("--withhold: ", kind)?;
    }
    let model = input::model(&args.model)?;
    let read = |paths: &[PathBuf]| {
        paths
            .iter()
            .map(|path| input::record(path, &model, &args.records))
            .collect::<Result<Vec<_>, _>>()
    };
    let (train, read_notes) = apart(read(&args.train)?);
    let (check, check_notes) = apart(read(&args.check)?);
    repeated::refuse(&model, (&args.train, &train), (&args.check, &check))?;
    // A folder that cannot be written to is told before the work, not after it.
    let stems: Vec<String> = judged.iter().map(|path| stem(path)).collect();
    let folders = [PREDICTIONS, PICTURES];
    Folder::attempt(&args.out, &folders, &files(&args.out, &stems, &[]))?;
    let begun = Instant::now();
    let is_spent = || {
        args.budget
            .is_some_and(|budget| begun.elapsed().as_secs_f64() > budget)
    };
    let request = Request {
        withheld: &args.withhold,
        is_spent: &is_spent,
        ..Request::new(&model, &train, &check)
    };
    let all: Vec<&Record> = train.iter().chain(&check).collect();
    // What keeps the audit from its work is told by the diagnosis, in the same words as ever.
    let findings = audit(&model, &all).unwrap_or_default();
    let mut outcome = in_pool(args.jobs, || {
        let steps = Steps::new();
        diagnose(&request, &|step| steps.show(step))
    })??;
    let all = train.iter().chain(&check);
    let conversions = all.flat_map(|record| input::conversions(record, &model));
    outcome.diagnosis.notes.extend(conversions);
    let notes = &mut outcome.diagnosis.notes;
    notes.extend(input::idle_masses(&model));
    notes.extend(read_notes.into_iter().chain(check_notes));
    let beyond_quality = findings
        .iter()
        .filter(|finding| crate::audit::is_beyond_quality(finding));
    notes.extend(beyond_quality.map(ToString::to_string));
    let context = simgap_report::page::ReportContext {
        program_version: env!("CARGO_PKG_VERSION").to_string(),
        model_file: file_name(&args.model),
        train_records: args.train.iter().map(|p| file_name(p)).collect(),
        check_records: args.check.iter().map(|p| file_name(p)).collect(),
        command_line: command_line(args),
        seed: args.seed,
    };
    let json = write(&outcome, &model, &context, (&args.out, args.sets))?;
    match args.format {
        Format::Json => crate::say_plain(&json)?,
        Format::Human => {
            let report = args.out.join("report.html");
            say(&format!(
                "{}{}report: {}\n",
                crate::audit::told(&findings),
                summary(&outcome),
                report.display()
            ))?;
        }
    }
    Ok(())
}

/// Records, and the notes on all of them.
fn apart(inputs: Vec<input::Input>) -> (Vec<Record>, Vec<String>) {
    let (records, notes): (Vec<_>, Vec<_>) = inputs
        .into_iter()
        .map(|input| (input.record, input.notes))
        .unzip();
    (records, notes.concat())
}

fn summary(outcome: &Outcome) -> String {
    // Colours that no terminal would show are taken out where it is printed.
    let styles = simgap_report::summary::Styles::ansi();
    simgap_report::summary::summary_text(&outcome.diagnosis, styles)
}

/// Runs on a pool of the wished size, or on the default one.
pub(crate) fn in_pool<T: Send>(
    jobs: Option<usize>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, CliError> {
    match jobs {
        None => Ok(work()),
        Some(jobs) => rayon::ThreadPoolBuilder::new()
            .num_threads(jobs)
            .build()
            .map(|pool| pool.install(work))
            .map_err(|error| CliError::Threads {
                found: error.to_string(),
            }),
    }
}

fn distinct_stems(paths: &[PathBuf]) -> Result<(), CliError> {
    let mut seen: BTreeMap<String, &PathBuf> = BTreeMap::new();
    for path in paths {
        if let Some(first) = seen.insert(stem(path), path) {
            return Err(CliError::SameStem {
                first: first.clone(),
                second: path.clone(),
                stem: stem(path),
            });
        }
    }
    Ok(())
}

/// The command that makes the result again, with the names of the files but not their folders, so
/// that the same input gives the same page wherever it lies.
fn command_line(args: &DiagnoseArgs) -> String {
    let mut words = vec![
        "simgap".to_string(),
        "diagnose".to_string(),
        file_name(&args.model),
    ];
    let mut option = |name: &str, value: String| words.extend([name.to_string(), value]);
    for (name, paths) in [("--train", &args.train), ("--check", &args.check)] {
        for path in paths {
            option(name, file_name(path));
        }
    }
    for (name, value) in args.records.words() {
        words.push(name.to_string());
        words.extend(value);
    }
    let mut option = |name: &str, value: String| words.extend([name.to_string(), value]);
    for kind in &args.withhold {
        option("--withhold", kind.clone());
    }
    if args.seed != 0 {
        option("--seed", args.seed.to_string());
    }
    option("--out", "DIR".to_string());
    command(&words)
}

/// The files of a result.
fn files(out: &Path, stems: &[String], pictures: &[PictureFile]) -> Vec<PathBuf> {
    let named = ["diagnosis.json", "corrected.toml", "report.html"].map(|name| out.join(name));
    let predictions = stems.iter().map(|stem| prediction_file(out, stem));
    let pictures = pictures.iter().flat_map(|one| picture_files(out, one));
    named
        .into_iter()
        .chain(predictions)
        .chain(pictures)
        .collect()
}

fn prediction_file(out: &Path, stem: &str) -> PathBuf {
    out.join(PREDICTIONS).join(format!("{stem}.csv"))
}

fn picture_files(out: &Path, picture: &PictureFile) -> [PathBuf; 2] {
    let at = |extension| {
        out.join(PICTURES)
            .join(format!("{}.{extension}", picture.name))
    };
    [at("svg"), at("csv")]
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default()
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Writes everything, all files together; everything is made before the first is written. Returns the text of diagnosis.json.
pub(crate) fn write(
    outcome: &Outcome,
    model: &Model,
    context: &simgap_report::page::ReportContext,
    (out, with_sets): (&Path, bool),
) -> Result<String, CliError> {
    let json = crate::json(&outcome.diagnosis)?;
    let corrected = outcome
        .corrected
        .to_toml()
        .map_err(|error| CliError::Model {
            path: out.join("corrected.toml"),
            error,
        })?;
    let report = report(&ReportInput {
        diagnosis: &outcome.diagnosis,
        series: &outcome.series,
        motions: &outcome.motions,
        nominal: Some(model),
        corrected: Some(&outcome.corrected),
        context,
    })?;
    let stems: Vec<String> = outcome.series.iter().map(stem_of).collect();
    bounded(&outcome.series)?;
    let all = files(out, &stems, &report.pictures);
    let folder = Folder::make(out, &[PREDICTIONS, PICTURES], &all)?;
    let mut results = Results::new(out, "diagnose");
    for series in &outcome.series {
        add_predictions(series, &mut results)?;
    }
    results.add(Path::new("corrected.toml"), &corrected)?;
    for picture in &report.pictures {
        let [svg, csv] = picture_files(Path::new(""), picture);
        results.add(&svg, &picture.svg)?;
        results.add(&csv, &picture.csv)?;
    }
    results.add(Path::new("report.html"), &report.html)?;
    results.add(Path::new("diagnosis.json"), &json)?;
    if with_sets {
        results.add(Path::new("sets.json"), &crate::json(&outcome.sets)?)?;
    }
    results.finish(folder)?;
    Ok(json)
}

fn stem_of(series: &CheckSeries) -> String {
    stem(Path::new(&series.record))
}

/// Refuses predictions that no file can hold.
fn bounded(series: &[CheckSeries]) -> Result<(), CliError> {
    for one in series {
        for channel in &one.channels {
            let mut values = channel.nominal.iter().chain(&channel.corrected);
            if values.any(|value| !value.is_finite()) {
                return Err(CliError::RunsAway {
                    record: one.record.clone(),
                    channel: channel.channel.clone(),
                });
            }
        }
    }
    Ok(())
}

fn add_predictions(series: &CheckSeries, results: &mut Results<'_>) -> Result<(), CliError> {
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![&series.time_s];
    for channel in &series.channels {
        for (name, values) in [
            ("measured", &channel.measured),
            ("nominal", &channel.nominal),
            ("corrected", &channel.corrected),
        ] {
            headers.push(format!("{} {name} [{}]", channel.channel, channel.unit));
            columns.push(values);
        }
    }
    let file = prediction_file(Path::new(""), &stem_of(series));
    results.add_csv(&file, &headers, &columns)
}
