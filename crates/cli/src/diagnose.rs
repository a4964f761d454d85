//! `simgap diagnose`.

use std::path::PathBuf;
use std::time::Instant;

use simgap_app::diagnosis::{Answer, Question, distinct_stems, known_kinds};
use simgap_app::input;
use simgap_diagnose::{Cancel, Limit};

use crate::args::{DiagnoseArgs, Format};
use crate::error::CliError;
use crate::progress::Steps;
use crate::stdout::say;

/// More threads than any machine has cores for; starting a hundred thousand takes minutes.
const MOST_JOBS: usize = 1024;

pub(crate) fn run(args: &DiagnoseArgs) -> Result<(), CliError> {
    checked_jobs(args.jobs)?;
    let judged = if args.check.is_empty() {
        &args.train
    } else {
        &args.check
    };
    distinct_stems(judged)?;
    let model = input::model(&args.model)?;
    known_kinds(&args.withhold, Some(&model))?;
    let options = args.records.options();
    let read = |paths: &[PathBuf]| {
        let inputs = paths
            .iter()
            .map(|path| input::record(path, &model, &options));
        inputs.collect::<Result<Vec<_>, _>>()
    };
    let (train, check) = (read(&args.train)?, read(&args.check)?);
    let begun = Instant::now();
    let is_over = args
        .budget
        .map(|budget| move || begun.elapsed().as_secs_f64() > budget);
    let question = Question {
        model: &model,
        model_file: Some(&args.model),
        train: &train,
        check: &check,
        records: &options,
        withheld: &args.withhold,
        seed: args.seed,
        limit: is_over
            .as_ref()
            .map_or_else(Limit::default, |is_over| Limit::Asked(is_over)),
        plant: None,
        cancel: Cancel::default(),
    };
    question.refuse_repeats()?;
    // A folder that cannot be written to is told before the work, not after it.
    question.attempt(&args.out)?;
    let answer = in_pool(args.jobs, || {
        let steps = Steps::new();
        question.answer(&|step| steps.show(step))
    })??;
    let json = answer.write(&args.out, args.sets)?;
    match args.format {
        Format::Json => crate::stdout::say_plain(&json)?,
        Format::Human => {
            let report = args.out.join("report.html");
            say(&format!(
                "{}{}report: {}\n",
                crate::audit::told(&answer.findings),
                summary(&answer),
                report.display()
            ))?;
        }
    }
    Ok(())
}

/// Refuses a number of threads that no machine can do anything with.
pub(crate) fn checked_jobs(jobs: Option<usize>) -> Result<Option<usize>, CliError> {
    match jobs.filter(|jobs| !(1..=MOST_JOBS).contains(jobs)) {
        Some(found) => Err(CliError::Jobs {
            found,
            most: MOST_JOBS,
        }),
        None => Ok(jobs),
    }
}

fn summary(answer: &Answer) -> String {
    // Colours that no terminal would show are taken out where it is printed.
    let styles = simgap_report::summary::Styles::ansi();
    simgap_report::summary::summary_text(&answer.outcome.diagnosis, styles)
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
