//! `simgap diagnose`.

use std::collections::BTreeSet;
use std::path::Path;

use simgap_diagnose::{CheckSeries, Outcome, Request, diagnose};
use simgap_record::{ensure_writable_dir, write_csv_atomic, write_text_atomic};

use crate::args::{DiagnoseArgs, Format};
use crate::error::CliError;
use crate::input;
use crate::progress::Steps;

pub(crate) fn run(args: &DiagnoseArgs) -> Result<(), CliError> {
    let model = input::model(&args.model)?;
    let read = |paths: &[std::path::PathBuf]| {
        paths
            .iter()
            .map(|path| input::record(path, &model))
            .collect::<Result<Vec<_>, _>>()
    };
    let (train, check) = (read(&args.train)?, read(&args.check)?);
    distinct_stems(if check.is_empty() {
        &args.train
    } else {
        &args.check
    })?;
    let request = Request {
        model: &model,
        train: &train,
        check: &check,
        withheld: &args.withhold,
    };
    let outcome = in_pool(args.jobs, || {
        let steps = Steps::new();
        diagnose(&request, &|step| steps.show(step))
    })??;
    let context = simgap_report::page::ReportContext {
        program_version: env!("CARGO_PKG_VERSION").to_string(),
        model_file: file_name(&args.model),
        train_records: args.train.iter().map(|p| file_name(p)).collect(),
        check_records: args.check.iter().map(|p| file_name(p)).collect(),
        command_line: String::new(),
    };
    let json = write(&outcome, &context, &args.out)?;
    match args.format {
        Format::Json => print!("{json}"),
        Format::Human => {
            print!("{}", summary(&outcome));
            println!("report: {}", args.out.join("report.html").display());
        }
    }
    Ok(())
}

fn summary(outcome: &Outcome) -> String {
    use std::io::IsTerminal;
    let styles = if std::io::stdout().is_terminal() {
        simgap_report::summary::Styles::ansi()
    } else {
        simgap_report::summary::Styles::plain()
    };
    simgap_report::summary::summary_text(&outcome.diagnosis, styles)
}

/// Runs on a pool of the wished size, or on the default one.
pub(crate) fn in_pool<T: Send>(
    jobs: Option<usize>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, CliError> {
    match jobs {
        None => Ok(work()),
        Some(0) => Err(CliError::Jobs { found: 0 }),
        Some(jobs) => rayon::ThreadPoolBuilder::new()
            .num_threads(jobs)
            .build()
            .map(|pool| pool.install(work))
            .map_err(|error| CliError::Threads {
                found: error.to_string(),
            }),
    }
}

fn distinct_stems(paths: &[std::path::PathBuf]) -> Result<(), CliError> {
    let mut seen = BTreeSet::new();
    for path in paths {
        if !seen.insert(stem(path)) {
            return Err(CliError::SameStem { stem: stem(path) });
        }
    }
    Ok(())
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

/// Writes everything, each file beside its place and then renamed; everything is made before the
/// first is written. Returns the text of diagnosis.json.
pub(crate) fn write(
    outcome: &Outcome,
    context: &simgap_report::page::ReportContext,
    out: &Path,
) -> Result<String, CliError> {
    let mut json =
        serde_json::to_string_pretty(&outcome.diagnosis).map_err(|error| CliError::Json {
            found: error.to_string(),
        })?;
    json.push('\n');
    let corrected = outcome
        .corrected
        .to_toml()
        .map_err(|error| CliError::Model {
            path: out.join("corrected.toml"),
            error,
        })?;
    let report = simgap_report::page::report_html(&outcome.diagnosis, &outcome.series, context)?;
    ensure_writable_dir(out)?;
    let predictions = out.join("predictions");
    ensure_writable_dir(&predictions)?;
    for series in &outcome.series {
        write_predictions(series, &predictions)?;
    }
    write_text_atomic(&out.join("corrected.toml"), &corrected)?;
    write_text_atomic(&out.join("report.html"), &report)?;
    write_text_atomic(&out.join("diagnosis.json"), &json)?;
    Ok(json)
}

fn write_predictions(series: &CheckSeries, folder: &Path) -> Result<(), CliError> {
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
    let path = folder.join(format!("{}.csv", stem(Path::new(&series.record))));
    Ok(write_csv_atomic(&path, &headers, &columns)?)
}
