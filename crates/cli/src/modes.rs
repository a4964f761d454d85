//! `simgap modes`: poles, modes and frequency responses of a model file.

use std::path::Path;

use simgap_app::folder::{Folder, not_an_input};
use simgap_app::modes::{Modes, chart, modes};
use simgap_app::{input, json};
use simgap_record::write_text_atomic;

use crate::args::{Format, ModesArgs};
use crate::error::CliError;
use crate::stdout::{say, say_plain};
use crate::text::{STRONG, figure, shown, styled, table};

/// Files of `--out`.
const FILES: [&str; 2] = ["modes.json", "modes.svg"];

pub(crate) fn run(args: &ModesArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        prepare(out, &FILES, &args.model)?;
    }
    let model = input::model(&args.model)?;
    let result = modes(&model, &args.model)?;
    let text = json(&result)?;
    if let Some(out) = &args.out {
        write(out, &FILES, &text, &chart(&result).to_svg()?)?;
    }
    match args.format {
        Format::Json => say_plain(&text),
        Format::Human => say(&told(&result, args.out.as_deref())),
    }
}

/// Whether the files can be written, and none is the model.
pub(crate) fn prepare(out: &Path, names: &[&str; 2], model: &Path) -> Result<(), CliError> {
    let files = names.map(|name| out.join(name));
    for file in &files {
        not_an_input(file, &[model])?;
    }
    Ok(Folder::attempt(out, &[], &files)?)
}

/// Writes the data and the picture.
pub(crate) fn write(out: &Path, names: &[&str; 2], json: &str, svg: &str) -> Result<(), CliError> {
    let [data, picture] = names.map(|name| out.join(name));
    let folder = Folder::make(out, &[], &[data.clone(), picture.clone()])?;
    write_text_atomic(&picture, svg)?;
    write_text_atomic(&data, json)?;
    folder.keep();
    Ok(())
}

fn told(result: &Modes, out: Option<&Path>) -> String {
    let mut text = format!("{}\n", styled(STRONG, &shown(&result.model)));
    let mut rows = vec![];
    for (i, mode) in result.modes.iter().enumerate() {
        let shape: Vec<String> = mode
            .shape
            .iter()
            .map(|part| {
                let name = shown(&part.mass);
                let phase = part.phase_deg.round();
                if phase == 0.0 || part.amplitude < 1e-9 {
                    format!("{name} {}", figure(part.amplitude))
                } else {
                    format!("{name} {} at {phase}°", figure(part.amplitude))
                }
            })
            .collect();
        rows.push(vec![
            (i + 1).to_string(),
            figure(mode.natural_freq_hz),
            figure(mode.damped_freq_hz),
            figure(mode.damping_ratio),
            format!(
                "{} {} {}i",
                figure(mode.pole.re),
                if mode.pole.im < 0.0 { "-" } else { "+" },
                figure(mode.pole.im.abs())
            ),
            shape.join(", "),
        ]);
    }
    let head = [
        "mode",
        "natural [Hz]",
        "damped [Hz]",
        "damping ratio",
        "pole [rad/s]",
        "shape",
    ];
    table(&mut text, &head, &rows, &[0, 1, 2, 3, 4]);
    ended(&mut text, &result.notes, out, FILES[1]);
    text
}

/// Notes, and the path of the picture.
pub(crate) fn ended(text: &mut String, notes: &[String], out: Option<&Path>, picture: &str) {
    for note in notes {
        text.push_str(&format!("note: {}\n", shown(note)));
    }
    if let Some(out) = out {
        text.push_str(&format!("picture: {}\n", out.join(picture).display()));
    }
}
