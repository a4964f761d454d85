//! Poles, modes and frequency responses of a model.

use std::path::Path;

use serde::Serialize;
use simgap_model::{
    DampedMode, InputKind, Model, ModelError, PoleKind, damped_modes_of, pole_kinds,
};
use simgap_report::chart::{LineChart, Role, Scale, Series};

use crate::AppError;
use crate::text::shown;

/// The schema of `--format json`.
const SCHEMA: &str = "simgap-modes/1";
/// Points of a frequency response, and how far it reaches beyond the poles, a factor.
const POINTS: usize = 600;
const REACH: f64 = 5.0;
/// Frequencies of a response of a model without a pole away from zero, Hz.
const WITHOUT_POLES_HZ: [f64; 2] = [0.1, 100.0];
/// A pole below this share of the largest is rounding.
const ROUNDING: f64 = 1e-13;
/// Curves a picture has room for.
const CURVES: usize = 6;

/// Poles, modes and responses, as `--format json` tells them.
#[derive(Debug, Serialize)]
pub struct Modes {
    /// `simgap-modes/1`.
    pub schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Displacements about which the model is linearised.
    pub operating_point: Vec<At>,
    /// Modes, slowest first.
    pub modes: Vec<Mode>,
    /// Every output over a force on every driven mass.
    pub responses: Vec<Response>,
    /// What a reader must know, one sentence each.
    pub notes: Vec<String>,
}

/// Displacement of a mass at the operating point.
#[derive(Debug, Serialize)]
pub struct At {
    /// Name of the mass.
    pub mass: String,
    /// m or rad.
    pub displacement: f64,
}

/// A mode.
#[derive(Debug, Serialize)]
pub struct Mode {
    /// Undamped natural frequency, Hz.
    pub natural_freq_hz: f64,
    /// Hz.
    pub damped_freq_hz: f64,
    /// 1.
    pub damping_ratio: f64,
    /// The pole with the positive imaginary part, rad/s.
    pub pole: Complex,
    /// Whether it vibrates, dies away, or is a level that nothing fixes.
    pub kind: PoleKind,
    /// One for each mass.
    pub shape: Vec<Share>,
}

/// A pole, rad/s.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

/// Part of a coordinate in a mode, over that of the mass which moves most.
#[derive(Debug, Serialize)]
pub struct Share {
    /// Name of the mass.
    pub mass: String,
    /// 1 for the mass that moves most.
    pub amplitude: f64,
    /// Degrees.
    pub phase_deg: f64,
}

/// Output over a force on a mass.
#[derive(Debug, Serialize)]
pub struct Response {
    /// Output channel.
    pub output: String,
    /// Name of the mass.
    pub force_on: String,
    /// Hz.
    pub freq_hz: Vec<f64>,
    /// Output per force, model units, one for each frequency.
    pub gain: Vec<f64>,
    /// Degrees, one for each frequency.
    pub phase_deg: Vec<f64>,
}

/// Poles, modes and frequency responses of a model, linearised at rest under its loads; `path` names it in messages.
///
/// # Errors
/// [`AppError::Model`] when the model has no matrices or its modes cannot be found.
pub fn modes(model: &Model, path: &Path) -> Result<Modes, AppError> {
    let failed = |error| AppError::Model {
        path: path.into(),
        error,
    };
    if model.is_external() {
        return Err(failed(ModelError::Shape {
            place: format!("model \"{}\"", model.name),
            found: "a simulator".into(),
            needed: "a model of masses: a simulator has no matrices".into(),
        }));
    }
    let (at, mut notes) = operating_point(model);
    let structure = model.linearise(&at).map_err(failed)?;
    let mut found = damped_modes_of(&structure, &model.first_order()).map_err(failed)?;
    snap_to_zero(&mut found);
    let poles: Vec<_> = found.iter().map(|mode| mode.eigenvalue).collect();
    let kinds = pole_kinds(&poles);
    notes.extend(neutral_note(&kinds));
    let away: Vec<f64> = found
        .iter()
        .zip(&kinds)
        .filter(|(_, kind)| **kind != PoleKind::Neutral)
        .map(|(mode, _)| mode.natural_freq_hz)
        .collect();
    let responses = responses(model, &away, &at, &mut notes).map_err(failed)?;
    Ok(Modes {
        schema: SCHEMA,
        model: model.name.clone(),
        operating_point: points(model, &at),
        modes: found
            .iter()
            .zip(kinds)
            .map(|(mode, kind)| told_mode(model, mode, kind))
            .collect(),
        responses,
        notes,
    })
}

/// What is to be said of poles next to zero, if there are any.
#[must_use]
pub fn neutral_note(kinds: &[PoleKind]) -> Option<String> {
    let count = kinds.iter().filter(|kind| **kind == PoleKind::Neutral);
    let told = match count.count() {
        0 => return None,
        1 => "one pole is".to_owned(),
        count => format!("{count} poles are"),
    };
    Some(format!(
        "{told} neutral, next to zero beside the vibrations: a level that nothing fixes, such as a position that no spring \
         holds or the pressures of a cylinder whose valve is in its middle"
    ))
}

/// Rest under the loads, or zero where there is none, and what is to be said of the linearisation.
#[must_use]
pub fn operating_point(model: &Model) -> (Vec<f64>, Vec<String>) {
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
        if model.elements.cylinders.is_empty() {
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

/// The displacements with the names of their masses.
#[must_use]
pub fn points(model: &Model, at: &[f64]) -> Vec<At> {
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

fn told_mode(model: &Model, mode: &DampedMode, kind: PoleKind) -> Mode {
    let masses = model.masses.iter().zip(&mode.mode_shape);
    Mode {
        natural_freq_hz: mode.natural_freq_hz,
        damped_freq_hz: mode.damped_freq_hz,
        damping_ratio: mode.damping_ratio,
        pole: Complex {
            re: mode.eigenvalue.re,
            im: mode.eigenvalue.im,
        },
        kind,
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
    poles_hz: &[f64],
    at: &[f64],
    notes: &mut Vec<String>,
) -> Result<Vec<Response>, simgap_model::ModelError> {
    let forced = driven(model)?;
    let freqs = frequencies(poles_hz);
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
fn frequencies(away: &[f64]) -> Vec<f64> {
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

/// The frequency responses as a picture.
#[must_use]
pub fn chart(result: &Modes) -> LineChart<'_> {
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
