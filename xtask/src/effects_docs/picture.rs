//! The picture of an effect's signature: which values are shown, and how it is drawn.

use simgap_effects::{Action, Effect};
use simgap_model::ModelError;
use simgap_report::chart::{
    ChartError, ChartSize, LineChart, Mark, NEUTRAL_COLOURS, ROLE_COLOURS, Role, Scale, Series,
};
use simgap_simulate::SimulateError;
use thiserror::Error;

use super::machine::{Stage, displacement, pulses};
use super::signature::{Over, Signature, signature};

/// A picture cannot be drawn.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The machine of the pictures has no place for an effect.
    #[error("{kind}: the machine of the pictures has no place for it: add one to the machines")]
    NoPlace {
        /// The effect.
        kind: &'static str,
    },
    /// An effect names no starting values at a usual place.
    #[error("{kind}: no starting values at a usual place")]
    NoStart {
        /// The effect.
        kind: &'static str,
    },
    /// The machine cannot be described.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// A picture and what it shows.
pub struct Picture {
    /// SVG, readable on a light and on a dark page.
    pub svg: String,
    /// What is drawn over what.
    pub shows: String,
    /// The values, as `name = value unit`.
    pub values: Vec<String>,
}

/// Factors that starting values are tried with.
const FACTORS: [f64; 11] = [0.125, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 5.0, 8.0, 16.0];

/// A shape must be so much nearer to what is easily seen to be shown before an earlier one.
const AS_GOOD: f64 = 0.15;

/// The picture of an effect.
///
/// # Errors
/// [`PictureError`] as its variants say.
pub fn picture(effect: &'static dyn Effect) -> Result<Picture, PictureError> {
    let kind = effect.kind();
    let stage = Stage::of(effect)?.ok_or(PictureError::NoPlace { kind })?;
    let (values, signature) = shown(&stage)?.ok_or(PictureError::NoStart { kind })?;
    let (x_label, over) = abscissa(signature.over);
    let (quantity, unit) = signature.quantity;
    let shows = format!("{quantity} over {over}");
    let mut chart = LineChart::new(
        format!("{kind}: {shows}"),
        x_label,
        format!("{quantity} [{unit}]"),
    );
    chart.size = ChartSize::new(520, 340);
    if signature.over == Over::Frequency {
        (chart.x_scale, chart.y_scale) = (Scale::Log, Scale::Log);
    }
    chart.x_range = signature.range;
    let curve = |name, role, points| Series::from_points(name, role, points);
    let mut chart = chart
        .with(curve("without it", Role::Nominal, &signature.without))
        .with(curve("with it", Role::Corrected, &signature.with));
    if signature.samples {
        chart = chart.with(curve("", Role::Corrected, &signature.with).with_mark(Mark::Points));
    }
    let parameters = effect.parameters().iter().zip(&values);
    let values = parameters
        .filter(|(parameter, _)| !parameter.per_record)
        .map(|(parameter, value)| {
            let unit = parameter.unit.replace("unit of the output", "m");
            let unit = unit.replace("unit of the input", "N");
            let unit = if unit == "1" { "" } else { unit.as_str() };
            format!("`{}` = {value} {unit}", parameter.name)
                .trim_end()
                .to_owned()
        })
        .collect();
    Ok(Picture {
        svg: themed(&chart.to_svg()?),
        shows,
        values,
    })
}

fn abscissa(over: Over) -> (&'static str, &'static str) {
    match over {
        Over::Displacement => ("displacement [mm]", "displacement"),
        Over::Velocity => ("velocity [m/s]", "velocity"),
        Over::Frequency => ("frequency [Hz]", "frequency"),
        Over::Time => ("time [s]", "time"),
    }
}

/// How large a change is easily seen: of a force law, of a response, of a signal, of samples.
fn easily_seen(signature: &Signature) -> f64 {
    match (signature.over, signature.quantity.0) {
        (Over::Frequency, _) => 0.5,
        (_, "force") => 0.5,
        _ if signature.samples => 0.15,
        _ => 0.3,
    }
}

/// The instance of the effect whose change is seen best, of its starts grown and shrunk.
fn shown(stage: &Stage) -> Result<Option<(Vec<f64>, Signature)>, PictureError> {
    let effect = stage.effect;
    let mut starts = effect.usual(&stage.scale(usual_signal(stage)?));
    // Shapes are listed from one extreme to the other: those in the middle first.
    let mut order: Vec<usize> = (0..starts.len()).collect();
    order.sort_by_key(|i| i.abs_diff(starts.len() / 2));
    let mut best: Option<(f64, Vec<f64>, Signature)> = None;
    for start in order.into_iter().map(|i| std::mem::take(&mut starts[i])) {
        for factor in FACTORS {
            if factor != 1.0 && !effect.grows_in_proportion() {
                continue;
            }
            let values = grown(effect, &start, factor);
            let signature = signature(stage, &values)?;
            let off = (signature.change / easily_seen(&signature)).ln().abs();
            if off.is_finite()
                && best
                    .as_ref()
                    .is_none_or(|(least, ..)| off < *least - AS_GOOD)
            {
                best = Some((off, values, signature));
            }
        }
    }
    Ok(best.map(|(_, values, signature)| (values, signature)))
}

/// rms of the signal that a map at the place acts on.
fn usual_signal(stage: &Stage) -> Result<f64, PictureError> {
    let start = stage.effect.starts(&stage.scale(1.0)).into_iter().next();
    let values = match start.map(|start| stage.effect.action(&start)) {
        Some(Action::Input(_)) => pulses(),
        Some(Action::Output(_) | Action::Sampling(_)) => displacement()?,
        _ => return Ok(1.0),
    };
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    Ok((square / values.len() as f64).sqrt())
}

/// Values with their sizes grown by a factor from where the effect vanishes, to two digits.
fn grown(effect: &dyn Effect, start: &[f64], factor: f64) -> Vec<f64> {
    let parameters = effect.parameters().iter().zip(start);
    let mut values: Vec<f64> = parameters
        .map(|(parameter, &value)| match parameter.neutral {
            Some(neutral) if neutral.is_finite() && !parameter.per_record => {
                two_digits(neutral + factor * (value - neutral))
            }
            _ => two_digits(value),
        })
        .collect();
    effect.make_physical(&mut values);
    values
}

fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// The picture with a ground of its own and the colours of a dark page where the reader has one.
fn themed(svg: &str) -> String {
    let mut rules = String::new();
    for colour in ROLE_COLOURS.iter().chain(&NEUTRAL_COLOURS) {
        for property in ["stroke", "fill"] {
            let found = format!("{property}=\"{}\"", colour.light);
            if svg.contains(&found) {
                rules += &format!("[{found}]{{{property}:{}}}", colour.dark);
            }
        }
    }
    let ground = "<style>.ground{fill:#FFFFFF}@media(prefers-color-scheme:dark)\
                  {.ground{fill:#0D1117}";
    let rect = "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>";
    svg.replacen(
        "</title>\n",
        &format!("</title>\n{ground}{rules}}}</style>\n{rect}\n"),
        1,
    )
}
