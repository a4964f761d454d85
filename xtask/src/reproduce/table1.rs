//! Table 1 and Fig. 2: the mold's configuration from a step response.

use std::f64::consts::{PI, TAU};

use simgap_alpha::{leads, unknown_force};
use simgap_integrate::inverse::Differentiator;
use simgap_report::chart::{LineChart, Role, Series};

use super::simulated::response;
use super::three_unknowns::least_squares;
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, significant};

/// Force step, N. The paper does not print its own; the response is proportional to it.
const STEP_N: f64 = 10_000.0;

/// Sampling of the step response, s: the peak is read between samples by a parabola.
const STEP_SAMPLING_S: f64 = 1e-3;

/// Relative tolerance of the values read off the step response. At the peak the velocity has the third derivative
/// −2 ζω_n of the second, so that the vertex of a parabola through three samples h apart is off by at most
/// (1/3 + 1/4) ζω_n h², the mass, which goes with the square of the time of the peak, by twice its share.
fn step_tolerance(context: &Context) -> f64 {
    let mold = &context.mold;
    let decay = mold.damping_ratio() * TAU * mold.natural_freq_hz();
    let peak_s = 0.5 / mold.damped_freq_hz().unwrap_or(f64::NAN);
    2.0 * (7.0 / 12.0) * decay * STEP_SAMPLING_S * STEP_SAMPLING_S / peak_s
}

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

/// A quantity of Table 1 beside ours, in the unit printed.
fn row(item: &str, value: &simgap_tables::PrintedValue, ours_si: f64, share: f64) -> Comparison {
    Comparison {
        item: item.to_owned(),
        unit: value.unit().symbol(),
        printed: value.printed().to_owned(),
        published: value.value(),
        ours: ours_si / value.unit().si_factor(),
        tolerance: share * value.value(),
    }
}

/// Table 1 beside a mass, damping ratio and stiffness.
fn beside(context: &Context, read: &StepReading, share: f64) -> Vec<Comparison> {
    let table1 = &context.table1;
    vec![
        row("m, mass", &table1.mass, read.mass_kg, share),
        row(
            "ζ, damping ratio",
            &table1.damping_ratio,
            read.damping_ratio,
            share,
        ),
        row(
            "K, total stiffness",
            &table1.stiffness,
            read.stiffness,
            share,
        ),
    ]
}

/// Table 1 beside what a simulated step returns.
pub(crate) fn comparisons(context: &Context) -> Result<Vec<Comparison>, ReproduceError> {
    let response = response(&context.mold, &|_| STEP_N, STEP_SAMPLING_S, 3001)?;
    let read = read_step(&response, STEP_SAMPLING_S, STEP_N);
    Ok(read.map_or_else(Vec::new, |read| {
        beside(context, &read, step_tolerance(context))
    }))
}

/// Time in which the pressure of the step rises, s. **Assumed**, as the step itself.
const RISE_S: f64 = 0.05;

/// Length of a weight of the weak form, s, and how far one lies from the next.
const WEIGHT_S: [f64; 2] = [0.8, 0.05];

/// Relative tolerance of Table 1 from the pressure: the trapezoidal sums of the weak form leave out what the
/// force has above half the sample rate, 1/(2πf RISE_S)² of it.
fn pressure_tolerance(context: &Context) -> f64 {
    (TAU * 0.5 * context.sample_rate_hz() * RISE_S).powi(-2)
}

/// Displacement and pressure force of a step at the paper's sampling: 4 s.
fn pressure_step(context: &Context) -> Result<[Vec<f64>; 2], ReproduceError> {
    let force = |time: f64| STEP_N * (1.0 - (-time / RISE_S).exp() * (1.0 + time / RISE_S));
    let (step, fine) = (context.time_step_s(), 10);
    let count = 400;
    let all = response(
        &context.mold,
        &force,
        step / f64::from(fine),
        fine as usize * count,
    )?;
    let displacement = all.into_iter().step_by(fine as usize).collect();
    Ok([
        displacement,
        (0..count).map(|n| force(n as f64 * step)).collect(),
    ])
}

/// Mass, damping and stiffness from the pressure force and the displacement of a step, by the weak form
///
/// ```text
/// ∫ w F dt = m ∫ ẅ y dt − c ∫ ẇ y dt + k ∫ w y dt,    w = sin⁴ over a stretch,
/// ```
///
/// which takes no derivative of what was measured.
fn weak_form(context: &Context, [displacement, force]: &[Vec<f64>; 2]) -> Option<StepReading> {
    let step = context.time_step_s();
    let [length, hop] = WEIGHT_S.map(|seconds| (seconds / step).round() as usize);
    let rate = PI / (length as f64 * step);
    let (mut rows, mut right) = (vec![], vec![]);
    for start in (0..displacement.len() - length).step_by(hop) {
        let mut sums = [0.0; 4];
        for n in 0..=length {
            let (sin, cos) = (rate * n as f64 * step).sin_cos();
            let weight = sin.powi(4);
            let slope = 4.0 * rate * sin.powi(3) * cos;
            let bend = 4.0 * rate * rate * sin * sin * (3.0 * cos * cos - sin * sin);
            let y = displacement[start + n];
            for (sum, term) in
                sums.iter_mut()
                    .zip([bend * y, -slope * y, weight * y, weight * force[start + n]])
            {
                *sum += step * term;
            }
        }
        rows.push([sums[0], sums[1], sums[2]]);
        right.push(sums[3]);
    }
    reading(least_squares(&rows, &right)?)
}

/// The same by Park's formula twice, as the paper differentiates: F = m a + c v + k y.
fn by_park(
    context: &Context,
    [displacement, force]: &[Vec<f64>; 2],
) -> Result<Option<StepReading>, ReproduceError> {
    let step = context.time_step_s();
    let found = unknown_force(
        &context.plant,
        displacement,
        force,
        step,
        Differentiator::Park,
    )?;
    let settled = found.settling_samples..displacement.len();
    let rows: Vec<[f64; 3]> = settled
        .clone()
        .map(|n| [found.acceleration[n], found.velocity[n], displacement[n]])
        .collect();
    Ok(least_squares(&rows, &force[settled]).and_then(reading))
}

fn reading([mass_kg, damping, stiffness]: [f64; 3]) -> Option<StepReading> {
    (mass_kg > 0.0 && stiffness > 0.0).then(|| StepReading {
        mass_kg,
        damping_ratio: 0.5 * damping / (mass_kg * stiffness).sqrt(),
        stiffness,
    })
}

/// Table 1 from the pressure force of a step: without derivatives, and through Park's formula.
pub(crate) fn pressure_comparisons(
    context: &Context,
) -> Result<[Vec<Comparison>; 2], ReproduceError> {
    let step = pressure_step(context)?;
    let tolerance = pressure_tolerance(context);
    let list = |read: Option<StepReading>| {
        read.map_or_else(Vec::new, |read| beside(context, &read, tolerance))
    };
    Ok([
        list(weak_form(context, &step)),
        list(by_park(context, &step)?),
    ])
}

/// Lengths of the records that are asked for the bin, s: with shorter ones no bin is as fine as the printed digits are apart
/// from the natural frequency, longer ones are no records of one excitation.
const LONGEST_S: f64 = 100.0;
const SHORTEST_S: f64 = 1.0;

/// Numbers of samples for which the printed frequency is a bin, and the one nearest to the natural
/// frequency of Table 1.
pub(crate) fn bins(context: &Context) -> Vec<usize> {
    let printed = context.stated.first_natural_freq.printed();
    let decimals = printed
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    let step = context.time_step_s();
    let [shortest, longest] =
        [SHORTEST_S, LONGEST_S].map(|length| (length / step).round() as usize);
    (shortest..=longest)
        .filter(|count| {
            let length = *count as f64 * step;
            let bin = (context.mold.natural_freq_hz() * length).round() / length;
            format!("{bin:.decimals$}") == printed
        })
        .collect()
}

/// Half a bin of the shortest record that has the printed frequency as a bin, Hz.
pub(crate) fn half_bin_hz(context: &Context) -> f64 {
    let count = bins(context).first().copied().unwrap_or(usize::MAX);
    0.5 / (count as f64 * context.time_step_s())
}

fn bin_text(context: &Context) -> String {
    let found = bins(context);
    let stated = context.stated.first_natural_freq.printed();
    let natural = context.mold.natural_freq_hz();
    let Some(count) = found.first() else {
        return format!(
            "No record up to {LONGEST_S} s has {stated} Hz as the bin nearest to {} Hz.",
            significant(natural, 5)
        );
    };
    let length = *count as f64 * context.time_step_s();
    format!(
        "**{stated} Hz is a bin.** The spectrum of {count} samples at {} s, {} s and one sample more, has bins {} Hz apart, and the one nearest to the natural \
         frequency {} Hz of Table 1 is {} Hz, which prints as {stated}. It is the shortest record of which that is true; of those up to \
         {LONGEST_S} s {} are like it: {} samples. How long the paper's was is not printed. So the paper's first natural frequency is that of its Table 1, read off the nearest bin, if its record had one of these lengths: within the resolution \
         (tolerance: half a bin, {} Hz), and no sign of another mass or damping.",
        context.stated.time_step.printed(),
        (length - context.time_step_s()).round(),
        significant(1.0 / length, 4),
        significant(natural, 5),
        significant((natural * length).round() / length, 6),
        found.len(),
        found
            .iter()
            .map(usize::to_string)
            .collect::<Vec<_>>()
            .join(", "),
        significant(half_bin_hz(context), 2),
    )
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let response = response(&context.mold, &|_| STEP_N, STEP_SAMPLING_S, 1501)?;
    let [weak, park] = pressure_comparisons(context)?;
    let mut blocks = vec![
        Block::Text(format!(
            "The paper reads mass, damping ratio and stiffness off the response to a step. The step is \
             not printed; here the printed values drive a 1-DOF simulation of a {} kN step, and the same \
             reading is taken from it. That it returns the printed values shows the chain to be \
             consistent, not that the machine has them. Tolerance: {} of the value, by which a parabola through samples {} ms \
             apart misses the time of the peak.",
            STEP_N / 1e3,
            significant(step_tolerance(context), 2),
            1e3 * STEP_SAMPLING_S
        )),
        Block::Table(Table::comparisons("Table 1", &comparisons(context)?)),
        Block::Figure(
            "fig02-step",
            "Fig. 2 in kind: step response of the 1-DOF model. The measured curve is lost."
                .to_owned(),
            step_chart(&response),
        ),
        Block::Text(format!(
            "**From the pressure difference.** The paper says that the values come from the pressure difference in the cylinder when a step \
             is applied. Here the pressure force of a step (rising within {} ms, assumed) and the displacement, both sampled at {} s, are put \
             into Eq. (1) in its weak form, with weights of {} s, which takes no derivative of what was measured. Tolerance: {} %, for what \
             the sums leave out above half the sample rate. Through Park's formula, as the paper differentiates, the same record gives the \
             second table.",
            1e3 * RISE_S,
            context.stated.time_step.printed(),
            WEIGHT_S[0],
            significant(1e2 * pressure_tolerance(context), 2),
        )),
        Block::Table(Table::comparisons(
            "Table 1 from the pressure force of a step, weak form",
            &weak,
        )),
        Block::Table(Table::comparisons(
            "Table 1 from the pressure force of a step, Park's formula",
            &park,
        )),
        Block::Table(implied(context)),
    ];
    blocks.extend(natural_freq(context)?);
    Ok(Page {
        stem: "table1",
        title: format!("Table 1: configuration, and {} Hz", context.stated.first_natural_freq.printed()),
        summary: "mass, damping and stiffness from a step and from its pressure; the natural frequency the text states, as a bin".to_owned(),
        blocks,
    })
}

fn step_chart(response: &[f64]) -> LineChart<'static> {
    let time: Vec<f64> = (0..response.len())
        .map(|n| n as f64 * STEP_SAMPLING_S)
        .collect();
    let value: Vec<f64> = response.iter().map(|y| 1e3 * y).collect();
    LineChart::new(
        format!("Step of {} kN on the 1-DOF model", 1e-3 * STEP_N),
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
            tolerance: half_bin_hz(context),
        })
        .collect();
    let ratio = leads::damping_ratio_of_damped_freq(mold.natural_freq_hz(), stated.si())?;
    let mass = leads::mass_of_natural_freq(mold.stiffness(), stated.si())?;
    let stiffness = mold.mass_kg() * (TAU * stated.si()).powi(2);
    let mut table = Table::new(
        "What the printed frequency would need to all its digits",
        &["change", "to", "from"],
    );
    let mut row = |change: &str, to: String, from: String| {
        table
            .rows
            .push(vec![Cell::text(change), Cell::text(to), Cell::text(from)]);
    };
    let short = significant;
    let first = &context.table3.rows[0];
    let first_share = leads::damping_share(
        first.peak_to_peak.si(),
        mold.damping(),
        context.amplitude(),
        first.excitation.si(),
    )?;
    row(
        "damping ratio, if it is the damped frequency",
        short(ratio, 3),
        context.table1.damping_ratio.printed().to_owned(),
    );
    row(
        "mass, if it is the natural frequency",
        format!("{} kg", short(mass, 5)),
        format!("{} t", context.table1.mass.printed()),
    );
    row(
        "stiffness, if it is the natural frequency",
        format!("{} N/m", short(stiffness, 5)),
        format!("{} N/m", context.table1.stiffness.printed()),
    );
    Ok(vec![
        Block::Table(Table::comparisons(
            "Section 3.1: the first natural frequency",
            &rows,
        )),
        Block::Text(bin_text(context)),
        Block::Text(format!(
            "Read to all its digits, {} Hz would be the damped frequency at a damping ratio of {}, near the {} that Table 3 suggests \
             at the lowest excitation ([Table 3](table3.md)), or the natural frequency of a mass {} % larger. The rebuilt pressure has no line \
             there: nothing but harmonics of the excitation is in it.",
            stated.printed(),
            short(ratio, 3),
            short((1.0 - first_share) * mold.damping_ratio(), 2),
            short(1e2 * (mass / mold.mass_kg() - 1.0), 2),
        )),
        Block::Table(table),
    ])
}
