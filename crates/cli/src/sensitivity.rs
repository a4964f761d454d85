//! `simgap sensitivity`: what each parameter of a model file does to its poles.

use std::path::Path;

use serde::Serialize;
use simgap_app::modes::{At, Complex, neutral_note, operating_point, points};
use simgap_app::{input, json};
use simgap_model::{Model, Parameter, PoleKind, PoleSensitivity, pole_kinds};
use simgap_report::chart::{Bar, BarChart, Role};

use crate::args::{Format, SensitivityArgs};
use crate::error::CliError;
use crate::modes::{ended, prepare, write};
use crate::stdout::{say, say_plain};
use crate::text::{STRONG, figure, shown, styled, table};

/// The schema of `--format json`.
const SCHEMA: &str = "simgap-sensitivity/1";
/// Files of `--out`.
const FILES: [&str; 2] = ["sensitivity.json", "sensitivity.svg"];
/// Changes below this share of the whole are rounding.
const ROUNDING: f64 = 1e-12;
/// Of a pole next to zero, parameters that move it by less than this share of the largest are left out of the table.
const NEUTRAL_SHARE: f64 = 1e-3;
/// Bars a picture has room for.
const BARS: usize = 24;

#[derive(Serialize)]
struct Sensitivity {
    schema: &'static str,
    model: String,
    tolerance_percent: f64,
    operating_point: Vec<At>,
    poles: Vec<Pole>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct Pole {
    natural_freq_hz: f64,
    damping_ratio: f64,
    pole: Complex,
    kind: PoleKind,
    /// Largest first; `None` where the pole has no derivative.
    parameters: Option<Vec<Row>>,
    /// Every parameter off by the tolerance, each as if by chance: root of the sum of squares.
    freq_spread_hz: Option<f64>,
}

#[derive(Serialize)]
struct Row {
    parameter: String,
    value: f64,
    /// Derivative of the pole, rad/s per unit of the parameter.
    pole_derivative: Complex,
    /// Change of the natural frequency, percent, for one percent of the parameter; `None` at zero frequency.
    freq_percent_per_percent: Option<f64>,
    /// Change of the damping ratio for one percent of the parameter.
    damping_ratio_per_percent: Option<f64>,
    /// How far the tolerance moves the natural frequency, Hz.
    freq_change_hz: Option<f64>,
}

/// Sizes that differ by less than one part in this many come in the order of the model file, whatever the processor rounds.
const TOLD_APART: f64 = 1e8;

impl Row {
    /// Logarithm of the change of the pole for one percent, in steps of what is told apart, for the order of the rows.
    fn size(&self) -> f64 {
        let size = self.value.abs() * self.pole_derivative.re.hypot(self.pole_derivative.im);
        (TOLD_APART * size.ln()).round()
    }
}

pub(crate) fn run(args: &SensitivityArgs) -> Result<(), CliError> {
    if !(args.tolerance > 0.0 && args.tolerance <= 100.0) {
        return Err(CliError::Tolerance {
            found: args.tolerance,
        });
    }
    if let Some(out) = &args.out {
        prepare(out, &FILES, &args.model)?;
    }
    let model = input::model(&args.model)?;
    let (at, mut notes) = operating_point(&model);
    let found = model
        .pole_sensitivities(&at)
        .map_err(|error| CliError::Model {
            path: args.model.clone(),
            error,
        })?;
    if found.iter().any(|pole| pole.derivative.is_none()) {
        notes.push("a pole that is there more than once has no derivative".to_owned());
    }
    let poles: Vec<_> = found.iter().map(|found| found.pole).collect();
    let kinds = pole_kinds(&poles);
    notes.extend(neutral_note(&kinds));
    // A level that nothing fixes comes after what dies away or vibrates.
    let (neutral, rest): (Vec<_>, Vec<_>) = found
        .iter()
        .zip(kinds)
        .partition(|(_, kind)| *kind == PoleKind::Neutral);
    let ordered = rest.into_iter().chain(neutral);
    let result = Sensitivity {
        schema: SCHEMA,
        model: model.name.clone(),
        tolerance_percent: args.tolerance,
        operating_point: points(&model, &at),
        poles: ordered
            .map(|(pole, kind)| ranked(&model, pole, kind, args.tolerance))
            .collect(),
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

/// The parameters of a pole, the one that moves it most first.
fn ranked(model: &Model, pole: &PoleSensitivity, kind: PoleKind, tolerance: f64) -> Pole {
    let parameters: Vec<Parameter> = model.parameters();
    let rows = pole.derivative.as_ref().map(|derivatives| {
        let mut rows: Vec<Row> = parameters
            .iter()
            .zip(derivatives)
            .enumerate()
            .map(|(place, (parameter, derivative))| {
                let value = model.parameter_value(*parameter).unwrap_or(0.0);
                let slopes = pole.freq_and_damping_derivative(place);
                let of_freq = slopes.map(|[freq, _]| value * freq);
                Row {
                    parameter: model.parameter_name(*parameter),
                    value,
                    pole_derivative: Complex {
                        re: derivative.re,
                        im: derivative.im,
                    },
                    freq_percent_per_percent: of_freq.map(|change| change / pole.natural_freq_hz()),
                    damping_ratio_per_percent: slopes.map(|[_, ratio]| 0.01 * value * ratio),
                    freq_change_hz: of_freq.map(|change| 0.01 * tolerance * change),
                }
            })
            .collect();
        rows.sort_by(|a, b| b.size().total_cmp(&a.size()));
        rows
    });
    let changes = rows.as_ref().and_then(|rows| {
        let changes = rows.iter().map(|row| row.freq_change_hz);
        changes.collect::<Option<Vec<f64>>>()
    });
    Pole {
        natural_freq_hz: pole.natural_freq_hz(),
        damping_ratio: pole.damping_ratio(),
        pole: Complex {
            re: pole.pole.re,
            im: pole.pole.im,
        },
        kind,
        parameters: rows,
        freq_spread_hz: changes.map(|all| all.iter().map(|c| c * c).sum::<f64>().sqrt()),
    }
}

fn told(result: &Sensitivity, out: Option<&Path>) -> String {
    let mut text = format!("{}\n", styled(STRONG, &shown(&result.model)));
    let change = format!("{} % moves it [Hz]", figure(result.tolerance_percent));
    let head = [
        "parameter",
        "value",
        "% of f per %",
        "damping ratio per %",
        &change,
    ];
    // What is rounding beside the whole is told as zero.
    let known = |value: Option<f64>, whole: f64| match value {
        Some(value) if value.abs() < ROUNDING * whole => figure(0.0),
        Some(value) => figure(value),
        None => "none".to_owned(),
    };
    for pole in &result.poles {
        if pole.kind == PoleKind::Neutral {
            text.push_str(&told_neutral(pole));
            continue;
        }
        let title = format!(
            "{} Hz, damping ratio {}",
            figure(pole.natural_freq_hz),
            figure(pole.damping_ratio)
        );
        text.push_str(&format!("{}\n", styled(STRONG, &title)));
        let Some(parameters) = &pole.parameters else {
            text.push_str("  this pole is there more than once: no derivative\n");
            continue;
        };
        let rows: Vec<Vec<String>> = parameters
            .iter()
            .map(|row| {
                vec![
                    shown(&row.parameter),
                    figure(row.value),
                    known(row.freq_percent_per_percent, 1.0),
                    known(row.damping_ratio_per_percent, 1.0),
                    known(row.freq_change_hz, pole.natural_freq_hz),
                ]
            })
            .collect();
        table(&mut text, &head, &rows, &[1, 2, 3, 4]);
        if let Some(spread) = pole.freq_spread_hz {
            text.push_str(&format!(
                "  all together, as if by chance: {} Hz\n",
                figure(spread)
            ));
        }
    }
    ended(&mut text, &result.notes, out, FILES[1]);
    text
}

/// A level that nothing fixes: it has a rate and no frequency.
fn told_neutral(pole: &Pole) -> String {
    let rate = pole.pole.re;
    let time = match rate.abs() {
        0.0 => String::new(),
        size => format!(" ({} s)", figure(1.0 / size)),
    };
    let title = format!("neutral: {} rad/s{time}", figure(rate));
    let mut text = format!("{}\n", styled(STRONG, &title));
    let Some(parameters) = &pole.parameters else {
        text.push_str("  this pole is there more than once: no derivative\n");
        return text;
    };
    let change = |row: &Row| 0.01 * row.value * row.pole_derivative.re;
    let largest = parameters.iter().map(change).map(f64::abs);
    let largest = largest.fold(0.0, f64::max);
    let moves = |row: &&Row| change(row).abs() > NEUTRAL_SHARE * largest;
    let rows: Vec<Vec<String>> = parameters
        .iter()
        .filter(moves)
        .map(|row| {
            let change = figure(change(row));
            vec![shown(&row.parameter), figure(row.value), change]
        })
        .collect();
    if rows.is_empty() {
        text.push_str("  no parameter moves it\n");
    } else {
        table(
            &mut text,
            &["parameter", "value", "rad/s per %"],
            &rows,
            &[1, 2],
        );
    }
    text
}

/// Change of each frequency for one percent of each parameter, the largest of every pole first.
fn chart(result: &Sensitivity) -> BarChart {
    let mut bars = vec![];
    let poles = result.poles.iter();
    for pole in poles.filter(|pole| pole.kind != PoleKind::Neutral) {
        for row in pole.parameters.iter().flatten() {
            let Some(change) = row.freq_percent_per_percent else {
                continue;
            };
            let label = format!(
                "{} Hz: {}",
                figure(pole.natural_freq_hz),
                shown(&row.parameter)
            );
            let role = if change < 0.0 {
                Role::Nominal
            } else {
                Role::Corrected
            };
            // The length is the size; the sign stands beside it and in the colour.
            let mut bar = Bar::share(label, change.abs(), role);
            bar.text = figure(change);
            bars.push(bar);
        }
    }
    bars.truncate(BARS);
    let mut chart = BarChart::shares(
        "Change of a natural frequency per change of a parameter",
        bars,
    );
    (chart.percent, chart.full, chart.width_px) = (false, None, 720);
    chart.axis_label = "% of the frequency per % of the parameter".into();
    chart
}
