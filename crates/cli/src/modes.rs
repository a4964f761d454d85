//! `simgap modes`: poles, modes and frequency responses of a model file.

use std::path::Path;

use serde::Serialize;
use simgap_model::{DampedMode, InputKind, Model, damped_modes_of};
use simgap_record::write_text_atomic;
use simgap_report::chart::{LineChart, Role, Scale, Series};

use crate::args::{Format, ModesArgs};
use crate::error::CliError;
use crate::folder::{Folder, not_an_input};
use crate::text::{STRONG, figure, shown, styled, table};
use crate::{input, json, say, say_plain};

/// The schema of `--format json`.
const SCHEMA: &str = "simgap-modes/1";
/// Files of `--out`.
const FILES: [&str; 2] = ["modes.json", "modes.svg"];
/// Points of a frequency response, and how far it reaches beyond the poles, a factor.
const POINTS: usize = 600;
const REACH: f64 = 5.0;
/// Frequencies of a response of a model without a pole away from zero, Hz.
const WITHOUT_POLES_HZ: [f64; 2] = [0.1, 100.0];
/// A pole below this share of the largest is rounding.
const ROUNDING: f64 = 1e-13;
/// Curves a picture has room for.
const CURVES: usize = 6;

#[derive(Serialize)]
struct Modes {
    schema: &'static str,
    model: String,
    operating_point: Vec<At>,
    modes: Vec<Mode>,
    responses: Vec<Response>,
    notes: Vec<String>,
}

/// Displacement of a mass at the operating point.
#[derive(Serialize)]
pub(crate) struct At {
    mass: String,
    displacement: f64,
}

#[derive(Serialize)]
struct Mode {
    natural_freq_hz: f64,
    damped_freq_hz: f64,
    damping_ratio: f64,
    pole: Complex,
    shape: Vec<Share>,
}

/// A pole, rad/s.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

/// Part of a coordinate in a mode, over that of the mass which moves most.
#[derive(Serialize)]
struct Share {
    mass: String,
    amplitude: f64,
    phase_deg: f64,
}

/// Output over a force on a mass.
#[derive(Serialize)]
struct Response {
    output: String,
    force_on: String,
    freq_hz: Vec<f64>,
    gain: Vec<f64>,
    phase_deg: Vec<f64>,
}

pub(crate) fn run(args: &ModesArgs) -> Result<(), CliError> {
    if let Some(out) = &args.out {
        prepare(out, &FILES, &args.model)?;
    }
    let model = input::model(&args.model)?;
    let failed = |error| CliError::Model {
        path: args.model.clone(),
        error,
    };
    let (at, mut notes) = operating_point(&model);
    let structure = model.linearise(&at).map_err(failed)?;
    let mut found = damped_modes_of(&structure, &model.first_order()).map_err(failed)?;
    snap_to_zero(&mut found);
    let responses = responses(&model, &found, &at, &mut notes).map_err(failed)?;
    let result = Modes {
        schema: SCHEMA,
        model: model.name.clone(),
        operating_point: points(&model, &at),
        modes: found.iter().map(|mode| told_mode(&model, mode)).collect(),
        responses,
        notes,
    };
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
    Folder::attempt(out, &[], &files)
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

/// Rest under the loads, or zero where there is none, and what is to be said of the linearisation.
pub(crate) fn operating_point(model: &Model) -> (Vec<f64>, Vec<String>) {
    let mut notes = vec![];
    if !model.effects.is_empty() {
        let kinds: Vec<&str> = model
            .effects
            .iter()
            .map(|effect| effect.kind.as_str())
            .collect();
        notes.push(format!(
            "effects are left out: {}; the poles are those of masses, springs, dampers and pendulums",
            kinds.join(", ")
        ));
    }
    let at = model.equilibrium().unwrap_or_else(|error| {
        if model.cylinders.is_empty() {
            notes.push(format!("linearised about zero displacement: {error}"));
        } else {
            notes.push("linearised about the start: zero displacement, valves in their middle, the pressures of the cylinders".to_owned());
        }
        vec![0.0; model.dof_count()]
    });
    if model.dof_count() == 0 {
        notes.push("the model has no mass, and so no pole".to_owned());
    }
    (at, notes)
}

pub(crate) fn points(model: &Model, at: &[f64]) -> Vec<At> {
    let masses = model.masses.iter().zip(at);
    masses
        .map(|(mass, displacement)| At {
            mass: mass.name.clone(),
            displacement: *displacement,
        })
        .collect()
}

/// Poles that are zero but for rounding are zero.
fn snap_to_zero(modes: &mut [DampedMode]) {
    let largest = modes
        .iter()
        .map(|mode| mode.natural_freq_hz)
        .fold(0.0, f64::max);
    for mode in modes
        .iter_mut()
        .filter(|mode| mode.natural_freq_hz < ROUNDING * largest)
    {
        mode.eigenvalue *= 0.0;
        (
            mode.natural_freq_hz,
            mode.damped_freq_hz,
            mode.damping_ratio,
        ) = (0.0, 0.0, 0.0);
    }
}

fn told_mode(model: &Model, mode: &DampedMode) -> Mode {
    let masses = model.masses.iter().zip(&mode.mode_shape);
    Mode {
        natural_freq_hz: mode.natural_freq_hz,
        damped_freq_hz: mode.damped_freq_hz,
        damping_ratio: mode.damping_ratio,
        pole: Complex {
            re: mode.eigenvalue.re,
            im: mode.eigenvalue.im,
        },
        shape: masses
            .map(|(mass, part)| Share {
                mass: mass.name.clone(),
                amplitude: part.norm(),
                phase_deg: part.arg().to_degrees(),
            })
            .collect(),
    }
}

/// Every output over a force on every mass that an input drives, or on every mass if none is driven.
fn responses(
    model: &Model,
    modes: &[DampedMode],
    at: &[f64],
    notes: &mut Vec<String>,
) -> Result<Vec<Response>, simgap_model::ModelError> {
    let forced = driven(model)?;
    let freqs = frequencies(modes);
    // Response of the linearised plant: pendulums stand at the operating point.
    let mut tangent = model.clone();
    for pendulum in &mut tangent.pendulums {
        if let Some(node) = model.node(&pendulum.at) {
            pendulum.value *= node.of(at, &[]).cos();
        }
    }
    let mut values = vec![];
    let mut shown = vec![];
    for freq in &freqs {
        match tangent.output_response(*freq) {
            Ok(matrix) => {
                values.push(matrix);
                shown.push(*freq);
            }
            Err(simgap_model::ModelError::Singular { .. }) => (),
            Err(error) => return Err(error),
        }
    }
    if shown.len() < freqs.len() {
        notes.push(
            "frequencies at which the undamped model resonates are left out of the responses"
                .to_owned(),
        );
    }
    let mut found = vec![];
    for (row, output) in model.outputs.iter().enumerate() {
        for (name, terms) in &forced {
            let curve = || {
                values.iter().map(|matrix| {
                    let parts = terms.iter().map(|(i, weight)| matrix[(row, *i)] * *weight);
                    parts.reduce(|sum, part| sum + part).unwrap_or_default()
                })
            };
            found.push(Response {
                output: output.channel.clone(),
                force_on: name.clone(),
                freq_hz: shown.clone(),
                gain: curve().map(|z| z.norm()).collect(),
                phase_deg: curve().map(|z| z.arg().to_degrees()).collect(),
            });
        }
    }
    Ok(found)
}

/// What a response is to: a name, and coordinates with weights.
type Driven = (String, Vec<(usize, f64)>);

/// What the inputs drive but moving bases, or every mass with a force if they drive nothing.
fn driven(model: &Model) -> Result<Vec<Driven>, simgap_model::ModelError> {
    let mut driven: Vec<Driven> = vec![];
    for (i, input) in model.inputs.iter().enumerate() {
        if input.kind != InputKind::Displacement {
            driven.push((input.at.clone(), model.input_terms(i)?));
        }
    }
    driven.dedup();
    if driven.is_empty() {
        let each = model.masses.iter().enumerate();
        let places = each.filter(|(_, mass)| !model.is_internal(&mass.name));
        driven = places
            .map(|(i, mass)| (mass.name.clone(), vec![(i, 1.0)]))
            .collect();
    }
    Ok(driven)
}

/// Equal ratios from well below the lowest to well above the highest pole away from zero.
fn frequencies(modes: &[DampedMode]) -> Vec<f64> {
    let away: Vec<f64> = modes
        .iter()
        .map(|mode| mode.natural_freq_hz)
        .filter(|f| *f > 0.0)
        .collect();
    let [from, to] = if away.is_empty() {
        WITHOUT_POLES_HZ
    } else {
        let least = away.iter().copied().fold(f64::INFINITY, f64::min);
        let most = away.iter().copied().fold(0.0, f64::max);
        [least / REACH, most * REACH]
    };
    let step = (to / from).ln() / (POINTS - 1) as f64;
    (0..POINTS)
        .map(|n| from * (step * n as f64).exp())
        .collect()
}

fn chart(result: &Modes) -> LineChart<'_> {
    let mut chart = LineChart::new(
        format!("Frequency response of {}", shown(&result.model)),
        "frequency [Hz]",
        "output per force",
    );
    (chart.x_scale, chart.y_scale) = (Scale::Log, Scale::Log);
    let roles = [
        Role::Measured,
        Role::Nominal,
        Role::Corrected,
        Role::Recalibrated,
    ];
    for (i, response) in result.responses.iter().take(CURVES).enumerate() {
        let role = roles
            .get(i)
            .copied()
            .unwrap_or_else(|| Role::Other((i - roles.len()) as u8));
        let name = format!("{} per force on {}", response.output, response.force_on);
        chart = chart.with(Series::new(
            shown(&name),
            role,
            &response.freq_hz[..],
            &response.gain[..],
        ));
    }
    chart
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
