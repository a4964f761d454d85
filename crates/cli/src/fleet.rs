//! `simgap fleet`.

use std::num::NonZeroUsize;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use simgap_app::folder::Folder;
use simgap_diagnose::Cancel;
use simgap_fleet::{Counts, Plan, run, units};

use crate::args::{FleetArgs, Format};
use crate::diagnose::checked_jobs;
use crate::error::CliError;
use crate::stdout::{say, say_plain};

pub(crate) fn run_fleet(args: &FleetArgs) -> Result<(), CliError> {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = checked_jobs(args.jobs)?.unwrap_or_else(cores);
    let plan = Plan::read(&args.plan)?;
    let units = units(&plan, None)?;
    // A folder that cannot be written to is told before the work, not after it.
    Folder::attempt(&args.out, &[], &[])?;
    let bar = ProgressBar::with_draw_target(Some(units.len() as u64), ProgressDrawTarget::stderr());
    if let Ok(style) =
        ProgressStyle::with_template("{elapsed} {pos} of {len} diagnoses, {eta} left")
    {
        bar.set_style(style);
    }
    let counts = run(&units, &args.out, jobs, &Cancel::default(), &|_, _| {
        bar.inc(1);
    });
    bar.finish_and_clear();
    let counts = counts?;
    let fleet = simgap_fleet::report(&plan, &units, &args.out)?;
    match args.format {
        Format::Json => say_plain(&fleet.json()?),
        Format::Human => {
            let report = args.out.join("fleet.html");
            let told = fleet
                .findings
                .iter()
                .map(|finding| format!("- {}\n", finding.text));
            let told: String = told.collect();
            let notes = fleet.notes.iter().map(|note| format!("note: {note}\n"));
            let notes: String = notes.collect();
            say(&format!(
                "{}{notes}{told}report: {}\n",
                done(counts),
                report.display()
            ))
        }
    }
}

fn done(counts: Counts) -> String {
    let Counts {
        diagnosed,
        failed,
        known,
    } = counts;
    let all = diagnosed + failed + known;
    format!("{all} diagnoses: {diagnosed} made now, {known} known before, {failed} failed now\n")
}
