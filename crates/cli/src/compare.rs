//! `simgap compare`: a measured trace and one of an outside simulator, without a model file.

use std::path::Path;

use simgap_diagnose::Status;
use simgap_diagnose::compare::{Agreement, CompareRequest, Compared, Comparison, compare};
use simgap_report::lines::answer_lines;
use simgap_report::page::{ReportContext, report_html};

use crate::args::{CompareArgs, Format};
use crate::error::CliError;
use crate::folder::{Folder, not_an_input};
use crate::manifest::Results;
use crate::progress::Steps;
use crate::text::{STRONG, figure, named, shown, styled};
use crate::{input, json, say, say_plain};

/// Where the text of a named line begins.
const INDENT: usize = 14;
/// Entries of a list that is told in one line.
const FEW: usize = 3;
/// Files of a result.
const FILES: [&str; 3] = ["comparison.json", "comparison.html", "compared.csv"];

pub(crate) fn run(args: &CompareArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        let files = FILES.map(|name| out.join(name));
        for file in &files {
            not_an_input(file, &[&args.measured, &args.simulated])?;
        }
        Folder::attempt(out, &[], &files)?;
    }
    let pairs = pairs(&args.pair)?;
    let measured = input::table(&args.measured, &args.reading)?;
    let simulated = input::simulated(&args.simulated)?;
    let request = CompareRequest {
        measured: &measured.record,
        simulated: &simulated.record,
        pairs: &pairs,
        inputs: &args.input,
        align_start: args.align_start,
    };
    let mut compared = {
        let steps = Steps::new();
        compare(&request, &|step| steps.show(step))?
    };
    for note in measured.notes.into_iter().chain(simulated.notes) {
        compared.diagnosis.notes.push(note.clone());
        compared.comparison.notes.push(note);
    }
    let text = json(&compared.comparison)?;
    if let Some(out) = &args.out {
        write(&compared, &text, out)?;
    }
    match args.format {
        Format::Json => say_plain(&text)?,
        Format::Human => {
            let mut told = told(&compared);
            if let Some(out) = &args.out {
                let page = out.join(FILES[1]);
                told.push_str(&format!("report: {}\n", page.display()));
            }
            say(&told)?;
        }
    }
    Ok(())
}

/// `measured=simulated`, as given.
fn pairs(given: &[String]) -> Result<Vec<(String, String)>, CliError> {
    given
        .iter()
        .map(|pair| match pair.split_once('=') {
            Some((measured, simulated)) if !measured.is_empty() && !simulated.is_empty() => {
                Ok((measured.to_string(), simulated.to_string()))
            }
            _ => Err(CliError::Pair {
                found: pair.clone(),
            }),
        })
        .collect()
}

/// Everything is made before the first file is written.
fn write(compared: &Compared, json: &str, out: &Path) -> Result<(), CliError> {
    let comparison = &compared.comparison;
    let context = ReportContext {
        program_version: env!("CARGO_PKG_VERSION").to_string(),
        model_file: comparison.simulated.clone(),
        train_records: vec![comparison.measured.clone()],
        check_records: vec![],
        seed: 0,
        command_line: String::new(),
    };
    let series = std::slice::from_ref(&compared.series);
    let page = report_html(&compared.diagnosis, series, &context)?;
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![&compared.series.time_s];
    for (channel, unit) in compared.series.channels.iter().zip(&compared.units) {
        for (name, values) in [
            ("measured", &channel.measured),
            ("simulated", &channel.nominal),
            ("corrected", &channel.corrected),
        ] {
            headers.push(format!("{} {name} [{unit}]", channel.channel));
            columns.push(values);
        }
    }
    let folder = Folder::make(out, &[], &FILES.map(|name| out.join(name)))?;
    let [data, html, csv] = FILES.map(Path::new);
    let mut results = Results::new(out, "compare");
    results.add_csv(csv, &headers, &columns)?;
    results.add(html, &page)?;
    results.add(data, json)?;
    results.finish(folder)
}

/// What a person is told.
fn told(compared: &Compared) -> String {
    let comparison = &compared.comparison;
    let mut text = String::new();
    let title = format!("{} against {}", comparison.simulated, comparison.measured);
    text.push_str(&format!("{}\n", styled(STRONG, &shown(&title))));
    named(&mut text, "answer", answer(comparison.chain.status), INDENT);
    for line in answer_lines(&compared.diagnosis) {
        named(&mut text, "", &line, INDENT);
    }
    let gap = &comparison.gap;
    let figures = format!(
        "{} as simulated, {} with what is named, {} of noise, on the last third, which was held back",
        figure(gap.simulated),
        figure(gap.corrected),
        figure(gap.noise_floor)
    );
    named(&mut text, "gap (nrmse)", &figures, INDENT);
    for (i, channel) in comparison.channels.iter().enumerate() {
        let name = if i == 0 { "agreement" } else { "" };
        named(&mut text, name, &agreement(channel), INDENT);
    }
    places(&mut text, comparison);
    let looks = comparison.look.iter().flat_map(|look| &look.sentences);
    for (i, sentence) in looks.take(2 * FEW).enumerate() {
        named(
            &mut text,
            if i == 0 { "look" } else { "" },
            sentence,
            INDENT,
        );
    }
    for (i, note) in comparison.notes.iter().enumerate() {
        named(&mut text, if i == 0 { "notes" } else { "" }, note, INDENT);
    }
    text
}

fn answer(status: Status) -> &'static str {
    match status {
        Status::None => "measurement and simulation agree to within the noise",
        Status::Effect | Status::Parameters => "the measurement chain explains the gap",
        Status::Unknown => {
            "the measurement chain does not explain the gap: look for it in the model, and give the \
             model to simgap diagnose"
        }
    }
}

fn agreement(channel: &Agreement) -> String {
    let mut text = format!(
        "{}: nrmse {}, R2 {}, largest {} {}",
        channel.channel,
        figure(channel.nrmse),
        figure(channel.r_squared),
        figure(channel.largest),
        channel.unit
    );
    for (name, metric) in [
        ("Sprague-Geers", &channel.sprague_geers),
        ("Russell", &channel.russell),
    ] {
        if let Some(m) = metric {
            text.push_str(&format!(
                ", {name} {:+.3} in magnitude and {:.3} in phase",
                m.magnitude, m.phase
            ));
        }
    }
    if let Some(rating) = &channel.iso18571 {
        text.push_str(&format!(
            ", ISO/TS 18571 {:.2} ({})",
            rating.total, rating.grade
        ));
    }
    text
}

/// The largest shares of each kind.
fn places(text: &mut String, comparison: &Comparison) {
    let found = &comparison.r#where;
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut parts: Vec<String> = Vec::new();
    if found.channels.len() > 1 {
        let channels = found.channels.iter().take(FEW);
        parts.extend(channels.map(|c| format!("{} in {}", percent(c.share), c.channel)));
    }
    let bands = found.bands.iter().take(FEW).map(|band| {
        let (from, to) = (figure(band.from_hz), figure(band.to_hz));
        format!("{} {} ({from} to {to} Hz)", percent(band.share), band.label)
    });
    parts.extend(bands);
    parts.extend(found.times.first().map(|time| {
        let (from, to) = (figure(time.from_s), figure(time.to_s));
        format!("{} from {from} s to {to} s", percent(time.share))
    }));
    // A region in which the motion mostly is says nothing.
    let marked = found
        .states
        .iter()
        .filter(|state| state.share > 2.0 * state.occupancy);
    parts.extend(marked.take(1).map(|state| {
        let (share, time) = (percent(state.share), percent(state.occupancy));
        format!("{share} at {}, in {time} of the time", state.label)
    }));
    for (i, part) in parts.iter().enumerate() {
        named(text, if i == 0 { "where" } else { "" }, part, INDENT);
    }
}
