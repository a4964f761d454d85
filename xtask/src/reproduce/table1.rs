//! Table 1 and Fig. 2: the mold's configuration from a step response.

use std::f64::consts::{PI, TAU};

use simgap_alpha::leads;
use simgap_report::chart::{LineChart, Role, Series};

use super::simulated::step_response;
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table};

/// Force step, N. The paper does not print its own; the response is proportional to it.
const STEP_N: f64 = 10_000.0;

/// Sampling of the step response, s: the peak is read between samples by a parabola.
const STEP_SAMPLING_S: f64 = 1e-3;

/// Relative tolerance of the values read off the step response: a parabola through three samples
/// 1 ms apart misses the peak by less than 1e-6 of it, the last sample is e^-14 away from rest.
const STEP_TOLERANCE: f64 = 1e-4;

/// Mass, damping ratio and stiffness read off a step response.
pub(crate) struct StepReading {
    pub(crate) mass_kg: f64,
    pub(crate) damping_ratio: f64,
    pub(crate) stiffness: f64,
}

/// ```text
/// k = F/y(∞),  s = y_peak/y(∞) − 1,  ζ = −ln s/√(π² + ln² s),  ω_d = π/t_peak,  m = k (1 − ζ²)/ω_d²
/// ```
pub(crate) fn read_step(response: &[f64], time_step_s: f64, force_n: f64) -> Option<StepReading> {
    let rest = *response.last()?;
    let at = (1..response.len() - 1).find(|n| response[n + 1] < response[*n])?;
    let (before, here, after) = (response[at - 1], response[at], response[at + 1]);
    let bend = before - 2.0 * here + after;
    let offset = 0.5 * (before - after) / bend;
    let peak = here - 0.25 * (before - after) * offset;
    let log = (peak / rest - 1.0).ln();
    let damping_ratio = -log / PI.hypot(log);
    let damped_rad = PI / ((at as f64 + offset) * time_step_s);
    let stiffness = force_n / rest;
    let mass_kg = stiffness * (1.0 - damping_ratio * damping_ratio) / (damped_rad * damped_rad);
    Some(StepReading {
        mass_kg,
        damping_ratio,
        stiffness,
    })
}

/// Table 1 beside what a simulated step returns.
pub(crate) fn comparisons(context: &Context) -> Result<Vec<Comparison>, ReproduceError> {
    let response = step_response(&context.mold, STEP_N, STEP_SAMPLING_S, 3001)?;
    let Some(read) = read_step(&response, STEP_SAMPLING_S, STEP_N) else {
        return Ok(vec![]);
    };
    let row = |item: &str, value: &simgap_tables::PrintedValue, ours: f64| Comparison {
        item: item.to_owned(),
        unit: value.unit().symbol(),
        printed: value.printed().to_owned(),
        published: value.value(),
        ours,
        tolerance: STEP_TOLERANCE * value.value(),
    };
    let table1 = &context.table1;
    Ok(vec![
        row(
            "m, mass",
            &table1.mass,
            read.mass_kg / table1.mass.unit().si_factor(),
        ),
        row(
            "ζ, damping ratio",
            &table1.damping_ratio,
            read.damping_ratio,
        ),
        row("K, total stiffness", &table1.stiffness, read.stiffness),
    ])
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let response = step_response(&context.mold, STEP_N, STEP_SAMPLING_S, 1501)?;
    let mut blocks = vec![
        Block::Text(format!(
            "The paper reads mass, damping ratio and stiffness off the response to a step. The step is \
             not printed; here the printed values drive a 1-DOF simulation of a {} kN step, and the same \
             reading is taken from it. That it returns the printed values shows the chain to be \
             consistent, not that the machine has them. Tolerance: the reading from samples 1 ms apart, \
             1e-4 of the value.",
            STEP_N / 1e3
        )),
        Block::Table(Table::comparisons("Table 1", &comparisons(context)?)),
        Block::Figure(
            "fig02-step",
            "Fig. 2 in kind: step response of the 1-DOF model. The measured curve is lost."
                .to_owned(),
            step_chart(&response),
        ),
        Block::Table(implied(context)),
    ];
    blocks.extend(natural_freq(context)?);
    Ok(Page {
        stem: "table1",
        title: "Table 1: configuration, and 2.499 Hz".to_owned(),
        summary: "mass, damping, stiffness, and the natural frequency the text states".to_owned(),
        blocks,
    })
}

fn step_chart(response: &[f64]) -> LineChart<'static> {
    let time: Vec<f64> = (0..response.len())
        .map(|n| n as f64 * STEP_SAMPLING_S)
        .collect();
    let value: Vec<f64> = response.iter().map(|y| 1e3 * y).collect();
    LineChart::new(
        "Step of 10 kN on the 1-DOF model",
        "time [s]",
        "displacement [mm]",
    )
    .with(Series::new("1-DOF model", Role::Nominal, time, value))
}

fn implied(context: &Context) -> Table {
    let mold = &context.mold;
    let mut table = Table::new(
        "What Table 1 implies",
        &["quantity", "formula", "unit", "value"],
    );
    let mut row = |quantity: &str, formula: &str, unit: &str, value: f64, digits: usize| {
        table.rows.push(vec![
            Cell::text(quantity),
            Cell::text(formula),
            Cell::text(unit),
            Cell::Number(value, digits),
        ]);
    };
    row("damping", "c = 2ζ√(km)", "N s/m", mold.damping(), 7);
    row(
        "natural frequency",
        "√(k/m)/2π",
        "Hz",
        mold.natural_freq_hz(),
        5,
    );
    if let Some(freq) = mold.damped_freq_hz() {
        row("damped frequency", "f_n √(1−ζ²)", "Hz", freq, 5);
    }
    if let Some(freq) = mold.resonance_freq_hz() {
        row("resonance of the receptance", "f_n √(1−2ζ²)", "Hz", freq, 5);
    }
    table
}

fn natural_freq(context: &Context) -> Result<Vec<Block>, ReproduceError> {
    let mold = &context.mold;
    let stated = &context.stated.first_natural_freq;
    let freqs = [
        ("natural frequency", Some(mold.natural_freq_hz())),
        ("damped frequency", mold.damped_freq_hz()),
        ("resonance of the receptance", mold.resonance_freq_hz()),
    ];
    let rows: Vec<Comparison> = freqs
        .into_iter()
        .filter_map(|(item, freq)| Some((item, freq?)))
        .map(|(item, ours)| Comparison {
            item: format!("first natural frequency, as {item}"),
            unit: "Hz",
            printed: stated.printed().to_owned(),
            published: stated.si(),
            ours,
            // One bin of the 20 s records used here.
            tolerance: 0.05 * 0.1,
        })
        .collect();
    let ratio = leads::damping_ratio_of_damped_freq(mold.natural_freq_hz(), stated.si())?;
    let mass = leads::mass_of_natural_freq(mold.stiffness(), stated.si())?;
    let stiffness = mold.mass_kg() * (TAU * stated.si()).powi(2);
    let mut table = Table::new("What 2.499 Hz would need", &["change", "to", "from"]);
    let mut row = |change: &str, to: String, from: String| {
        table
            .rows
            .push(vec![Cell::text(change), Cell::text(to), Cell::text(from)]);
    };
    let short = super::significant;
    row(
        "damping ratio, if it is the damped frequency",
        short(ratio, 3),
        short(0.3, 1),
    );
    row(
        "mass, if it is the natural frequency",
        format!("{} kg", short(mass, 5)),
        "33000 kg".into(),
    );
    row(
        "stiffness, if it is the natural frequency",
        format!("{} N/m", short(stiffness, 5)),
        "8287639 N/m".into(),
    );
    Ok(vec![
        Block::Table(Table::comparisons("Section 3.1: 2.499 Hz", &rows)),
        Block::Text(
            "2.499 Hz is none of the three frequencies of Table 1 (tolerance: a tenth of a bin of a \
             20 s record, 0.005 Hz). It is the damped frequency at a damping ratio near 0.135, which \
             is near the 0.14 that Table 3 suggests at 1 Hz ([Table 3](table3.md)), or the natural \
             frequency of a mass 1.9 % larger. The rebuilt pressure has no line there: nothing but \
             harmonics of the excitation is in it."
                .to_owned(),
        ),
        Block::Table(table),
    ])
}
