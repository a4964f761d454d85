//! `simgap compare`: a measured trace and one of an outside simulator, without a model file.

use simgap_app::comparison::{FILES, Question, pairs, write};
use simgap_app::folder::{Folder, not_an_input};
use simgap_app::{input, json};
use simgap_diagnose::Status;
use simgap_diagnose::compare::{Agreement, Compared, Comparison};
use simgap_report::lines::answer_lines;

use crate::args::{CompareArgs, Format};
use crate::error::CliError;
use crate::progress::Steps;
use crate::stdout::{say, say_plain};
use crate::text::{STRONG, figure, named, shown, styled};

/// Where the text of a named line begins.
const INDENT: usize = 14;
/// Entries of a list that is told in one line.
const FEW: usize = 3;

pub(crate) fn run(args: &CompareArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        let files = FILES.map(|name| out.join(name));
        for file in &files {
            not_an_input(file, &[&args.measured, &args.simulated])?;
        }
        Folder::attempt(out, &[], &files)?;
    }
    let pairs = pairs(&args.pair)?;
    let measured = input::table(&args.measured, &args.reading.options())?;
    let simulated = input::simulated(&args.simulated)?;
    let question = Question {
        measured: &measured,
        simulated: &simulated,
        pairs: &pairs,
        inputs: &args.input,
        align_start: args.align_start,
    };
    let compared = {
        let steps = Steps::new();
        question.answer(&|step| steps.show(step))?
    };
    let text = match &args.out {
        Some(out) => write(&compared, out)?,
        None => json(&compared.comparison)?,
    };
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
