//! The remaining figures, and what can be computed of each.

use simgap_mold::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};
use simgap_report::chart::{LineChart, Role, Series};

use super::context::samples;
use super::simulated::driven_response;
use super::{Block, Cell, Context, Page, ReproduceError, Table};

/// Differences below this share of the standard deviation are rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let mut blocks = vec![Block::Table(list())];
    for (stem, freq) in [("fig03-1hz", 1.0), ("fig03-5hz", 5.0)] {
        blocks.push(without_unknown_force(context, stem, freq)?);
    }
    blocks.extend(motion(context)?);
    let (block, error) = with_unknown_force(context)?;
    blocks.push(block);
    blocks.push(Block::Text(format!(
        "Fig. 11: integrated forwards by Park's method on the same samples, the unknown force gives the rebuilt displacement \
         back to {}. The agreement the paper reports is a property of the \
         method: the same formula, forwards and backwards, cancels its own errors and every fault of the record with them. It \
         does not show that the force acts on the mold.",
        if error < ROUNDING { "rounding".to_owned() } else { format!("{error:.1e} of its standard deviation") }
    )));
    Ok(Page {
        stem: "figures",
        title: "Figures 1 to 16".to_owned(),
        summary: "what can be computed of each figure, and Fig. 3, 4 and 11".to_owned(),
        blocks,
    })
}

/// Figure, what it shows, and what is here of it.
const FIGURES: [[&str; 3]; 16] = [
    ["1", "mold oscillator", "a drawing: not computable"],
    [
        "2",
        "step, model and experiment",
        "model in [Table 1](table1.md); the experiment is lost",
    ],
    [
        "3",
        "sweep, model and experiment differ",
        "[the sweep](sweep.md), in kind; below, by excitation",
    ],
    [
        "4",
        "displacement, velocity, acceleration at 1 Hz",
        "below, in kind",
    ],
    [
        "5",
        "unknown force by excitation",
        "[Table 3](table3.md), in kind",
    ],
    [
        "6",
        "spectrum of unknown force and beat function",
        "[Table 4](table4.md), in kind",
    ],
    [
        "7",
        "unknown force and its expression",
        "[Table 4](table4.md), in kind",
    ],
    [
        "8",
        "design with leaf springs",
        "a drawing; leaf springs as beams in [the machine](machine.md)",
    ],
    [
        "9",
        "natural frequencies of the finite element model",
        "[the machine](machine.md), in kind, for stated dimensions",
    ],
    ["10", "diagram of the two-mass model", "a drawing: Eq. (4)"],
    [
        "11",
        "1-DOF model with the unknown force",
        "[the sweep](sweep.md), in kind; below, at 1 Hz",
    ],
    [
        "12",
        "spectra of displacement and force",
        "[Table 2](table2.md), in kind",
    ],
    [
        "13",
        "two-mass model at 1 Hz",
        "[Table 5](table5.md), in kind",
    ],
    [
        "14",
        "two-mass model at 6 Hz (caption: 2 Hz)",
        "[Table 5](table5.md), in kind",
    ],
    [
        "15",
        "spectrum of the two-mass model at 1 Hz",
        "[Table 5](table5.md), in kind, all six rows; [every line](peaks.md)",
    ],
    [
        "16",
        "global and local vibration",
        "[Table 5](table5.md), in kind",
    ],
];

fn list() -> Table {
    let mut table = Table::new("Figures of the paper", &["figure", "shows", "here"]);
    table.rows.extend(
        FIGURES
            .iter()
            .map(|row| row.iter().map(|cell| Cell::text(*cell)).collect()),
    );
    table
}

fn millimetres(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| 1e3 * value).collect()
}

/// Error of the 1-DOF model under the rebuilt pressure force alone, after 10 s, over the standard
/// deviation of the displacement.
pub(crate) fn nominal_error(context: &Context, freq: f64) -> Result<f64, ReproduceError> {
    let rebuilt = context.record(freq, context.sample_rate_hz(), context.timing_reading())?;
    let force = samples(&rebuilt, FORCE_CHANNEL)?;
    let measured = samples(&rebuilt, DISPLACEMENT_CHANNEL)?;
    let predicted = driven_response(&context.mold, &force, &measured, context.time_step_s())?;
    Ok(simgap_signal::metrics::nrmse(
        &measured[1000..],
        &predicted[1000..],
    )?)
}

/// Fig. 3: the measured force alone does not give the measured displacement.
fn without_unknown_force(
    context: &Context,
    stem: &'static str,
    freq: f64,
) -> Result<Block, ReproduceError> {
    let rebuilt = context.record(freq, context.sample_rate_hz(), context.timing_reading())?;
    let force = samples(&rebuilt, FORCE_CHANNEL)?;
    let measured = samples(&rebuilt, DISPLACEMENT_CHANNEL)?;
    let predicted = driven_response(&context.mold, &force, &measured, context.time_step_s())?;
    let shown = 1000..1000 + (2.0 * context.sample_rate_hz() / freq) as usize + 1;
    let time = rebuilt.record.time_s()[shown.clone()].to_vec();
    let chart = LineChart::new(
        format!("1-DOF model at {freq} Hz"),
        "time [s]",
        "displacement [mm]",
    )
    .with(Series::new(
        "rebuilt record",
        Role::Measured,
        time.clone(),
        millimetres(&measured[shown.clone()]),
    ))
    .with(Series::new(
        "1-DOF model",
        Role::Nominal,
        time,
        millimetres(&predicted[shown]),
    ));
    let caption = format!(
        "Fig. 3 in kind, at {freq} Hz: the 1-DOF model under the rebuilt pressure force, without the unknown force"
    );
    Ok(Block::Figure(stem, caption, chart))
}

/// Fig. 4: motion by Park's formula.
fn motion(context: &Context) -> Result<Vec<Block>, ReproduceError> {
    let rebuilt = context.record(1.0, context.sample_rate_hz(), context.timing_reading())?;
    let force = context.unknown_force(&rebuilt)?;
    let displacement = samples(&rebuilt, DISPLACEMENT_CHANNEL)?;
    let shown = 100..301;
    let time = rebuilt.record.time_s()[shown.clone()].to_vec();
    let panel = |stem: &'static str, what: &str, unit: &str, values: Vec<f64>| {
        let chart = LineChart::new(
            format!("Rebuilt {what} at 1 Hz"),
            "time [s]",
            format!("{what} [{unit}]"),
        )
        .with(Series::new("", Role::Measured, time.clone(), values));
        let caption =
            format!("Fig. 4 in kind: {what} at 1 Hz, by Park's formula from the rebuilt record");
        Block::Figure(stem, caption, chart)
    };
    Ok(vec![
        panel(
            "fig04-displacement",
            "displacement",
            "mm",
            millimetres(&displacement[shown.clone()]),
        ),
        panel(
            "fig04-velocity",
            "velocity",
            "mm/s",
            millimetres(&force.velocity[shown.clone()]),
        ),
        panel(
            "fig04-acceleration",
            "acceleration",
            "m/s²",
            force.acceleration[shown].to_vec(),
        ),
    ])
}

/// Fig. 11: the same with the unknown force put in; the chart and what is left of the difference
/// after 10 s, over the standard deviation.
pub(crate) fn with_unknown_force(context: &Context) -> Result<(Block, f64), ReproduceError> {
    let rebuilt = context.record(1.0, context.sample_rate_hz(), context.timing_reading())?;
    let unknown = context.unknown_force(&rebuilt)?;
    let measured = samples(&rebuilt, DISPLACEMENT_CHANNEL)?;
    let pressure = samples(&rebuilt, FORCE_CHANNEL)?;
    let total: Vec<f64> = pressure
        .iter()
        .zip(&unknown.unknown_force)
        .map(|(force, alpha)| force + alpha)
        .collect();
    let predicted = driven_response(&context.mold, &total, &measured, context.time_step_s())?;
    let settled = 1000..measured.len();
    let error = simgap_signal::metrics::nrmse(&measured[settled.clone()], &predicted[settled])?;
    let shown = 1000..1201;
    let time = rebuilt.record.time_s()[shown.clone()].to_vec();
    let chart = LineChart::new(
        "1-DOF model with the unknown force at 1 Hz",
        "time [s]",
        "displacement [mm]",
    )
    .with(Series::new(
        "rebuilt record",
        Role::Measured,
        time.clone(),
        millimetres(&measured[shown.clone()]),
    ))
    .with(
        Series::new(
            "1-DOF model + unknown force",
            Role::Corrected,
            time,
            millimetres(&predicted[shown]),
        )
        .dashed(),
    );
    let caption =
        "Fig. 11 in kind: the 1-DOF model under pressure force and unknown force".to_owned();
    Ok((Block::Figure("fig11", caption, chart), error))
}
