//! The readings of the lines at 50 − f, side by side.

use simgap_mold::{DISPLACEMENT_CHANNEL, Reading, published_line_amplitude};
use simgap_report::chart::{LineChart, Mark, Role, Scale, Series};

use super::context::{EXCITATIONS_HZ, FAST_RATE_HZ};
use super::number::range;
use super::spectra::channel_spectrum;
use super::table4::height_off_a_bin;
use super::trial::{FROM_REST, GAIN, INTERPOLATION, LINE, TILT, TIMING, Trial, named, trials};
use super::{Block, Cell, Context, Page, ReproduceError, Table, significant, two_rates};

/// Excitation of the pictures, Hz.
const PICTURED_HZ: f64 = 3.0;

/// Mains where the author works (Asan, Republic of Korea), Hz; the paper does not print it.
const MAINS_HZ: f64 = 60.0;

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let tried = trials(context)?;
    let mut blocks = vec![
        Block::Text(format!(
            "The displacement, sampled at {} Hz, has a line at 50 − f. Seven readings of it, and two that their shape excludes, each with \
             **one number** for the six F0 of [Table 4](table4.md), through the same Park's formula and the same Eq. (3):",
            context.sample_rate_hz()
        )),
        Block::Table(fits(&tried)),
        amplitude_figure(context, &tried)?,
        Block::Text(amplitude_text(&tried)?),
        Block::Table(predictions_by_reading()),
        Block::Text(evidence_text(context)?),
        Block::Table(forces(context)?),
        Block::Table(two_rates::table(context)?),
        Block::Text(experiment_text(context)),
    ];
    blocks.extend(pictures(context)?);
    Ok(Page {
        stem: "readings",
        title: "Readings of the lines at 50 − f".to_owned(),
        summary: "nine readings, one number each: fit, further predictions, what is printed for and against, experiment".to_owned(),
        blocks,
    })
}

fn fits(tried: &[Trial]) -> Table {
    let best = tried.iter().fold(f64::NEG_INFINITY, |best, trial| {
        best.max(trial.log_likelihood)
    });
    let mut table = Table::new(
        "One number for the six F0",
        &[
            "reading",
            "number",
            "value",
            "R²",
            "worst row [%]",
            "log-likelihood, less the best",
        ],
    );
    for trial in tried {
        table.rows.push(vec![
            Cell::text(trial.name),
            Cell::text(trial.number),
            Cell::Number(trial.value, 3),
            Cell::Number(trial.r_squared, 3),
            Cell::Number(1e2 * trial.worst_relative_error, 2),
            Cell::Number(super::round_to(trial.log_likelihood - best, 2), 2),
        ]);
    }
    table
}

/// The readings that leave less of any row than heights read off a bin may be off by.
fn left_over(tried: &[Trial]) -> Result<Vec<&Trial>, ReproduceError> {
    let low = height_off_a_bin()?;
    Ok(tried
        .iter()
        .filter(|trial| trial.worst_relative_error < low)
        .collect())
}

fn amplitude_text(tried: &[Trial]) -> Result<String, ReproduceError> {
    let (timing, line, rest) = (
        named(tried, TIMING)?,
        named(tried, LINE)?,
        named(tried, FROM_REST)?,
    );
    let open = left_over(tried)?;
    let all: Vec<f64> = open.iter().map(|trial| trial.r_squared).collect();
    let likelihoods: Vec<f64> = open.iter().map(|trial| trial.log_likelihood).collect();
    let spread = likelihoods
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max)
        - likelihoods.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(format!(
        "**The heights do not decide.** {} of the {} laws fit with R² = {}, and their log-likelihoods lie within {} of one another: sampling \
         (R² = {}), a straight line (R² = {}) and even the two-mass model from rest (R² = {}, with one scale of {} for all \
         rows: the support needs one number too, not an amplitude for each row). What is flat in f is excluded (R² = {}), and so are \
         interpolation (R² = {}) and a tilt (R² = {}), which grow as f².",
        open.len(),
        tried.len(),
        range(&all, 3),
        significant(spread, 2),
        significant(timing.r_squared, 3),
        significant(line.r_squared, 3),
        significant(rest.r_squared, 3),
        significant(rest.value, 3),
        significant(named(tried, GAIN)?.r_squared, 2),
        significant(named(tried, INTERPOLATION)?.r_squared, 2),
        significant(named(tried, TILT)?.r_squared, 2),
    ))
}

/// What each reading says beyond the heights: the line at a faster rate, the images of harmonics, the pressure, and
/// what speaks against it in print.
const BEYOND: [[&str; 5]; 9] = [
    [
        TIMING,
        "moves to f_s/2 − f",
        "50 − n f of every harmonic",
        "no line",
        "Table 2 prints one high line only (unless the harmonics are low)",
    ],
    [
        "a tone at 50 Hz times the velocity, in the cable",
        "stays, as a pair at 50 ∓ f",
        "50 ∓ n f of every harmonic",
        "no line",
        "as above; and mains is not 50 Hz there (below)",
    ],
    [
        "a set point held for 20 ms, through the servo",
        "stays, as a pair at 50 ∓ f",
        "50 ∓ n f of harmonics of the set point",
        "the force that moves the mass",
        "no line in the pressure (below)",
    ],
    [
        "a real vibration at 50 ∓ f, forces as f",
        "stays, as a pair at 50 ∓ f",
        "none needed",
        "the force that moves the mass",
        "no line in the pressure (below); a linear support makes none in steady state",
    ],
    [
        LINE,
        "says nothing",
        "says nothing",
        "says nothing",
        "a description, not a cause",
    ],
    [
        FROM_REST,
        "stays, at the modes of each row",
        "none",
        "no line",
        "modes off as printed ([Table 5](table5.md)); dies away with any damping; the stiffnesses must follow f",
    ],
    [
        GAIN,
        "f_s/2 − f, or 50 ∓ f",
        "50 − n f of every harmonic",
        "no line",
        "the heights",
    ],
    [
        TILT,
        "f_s/2 − f, or 50 ∓ f",
        "50 − n f, growing with n²",
        "no line",
        "the heights",
    ],
    [
        INTERPOLATION,
        "moves to f_s/2 − f",
        "50 − n f, growing with n²",
        "no line",
        "the heights; and its size is no free number",
    ],
];

fn predictions_by_reading() -> Table {
    let mut table = Table::new(
        "What else each reading says",
        &[
            "reading",
            "line at a faster rate",
            "images of harmonics",
            "pressure",
            "against it in print",
        ],
    );
    for row in BEYOND {
        table.rows.push(row.map(Cell::text).to_vec());
    }
    table
}

/// Force at 50 − f that moves the mass by the line of Table 4, N.
fn line_force(context: &Context, freq: f64) -> Result<[f64; 2], ReproduceError> {
    let line = published_line_amplitude(freq)?;
    let omega = std::f64::consts::TAU * (context.stated.image_base.si() - freq);
    Ok([line, context.mold.mass_kg() * omega * omega * line])
}

fn evidence_text(context: &Context) -> Result<String, ReproduceError> {
    let (mut lines, mut forces, mut larger) = (vec![], vec![], 0);
    for freq in EXCITATIONS_HZ {
        let [line, force] = line_force(context, freq)?;
        lines.push(1e6 * line);
        forces.push(1e-3 * force);
        larger += usize::from(force > super::table5::one_dof_force(context, freq)?);
    }
    let folded = context.sample_rate_hz() - MAINS_HZ;
    // The highest harmonic printed at the excitation of the pictures.
    let row = context
        .table2
        .rows
        .iter()
        .find(|row| row.excitation.si() == PICTURED_HZ);
    let high = row
        .and_then(|row| row.displacement.lines_hz().last().copied())
        .unwrap_or(f64::NAN);
    Ok(format!(
        "**What else is printed does decide some.**\n\n\
         - *The pressure has no line.* A line of {} µm at 50 − f on {} t takes {} kN if the mold really moves (table below). \
         Table 2 prints no high line in the pressure in any row, though the force would be larger than the fundamental of the pressure force itself in {} of {} rows. That speaks against every \
         reading in which the cylinders shake the mold: the held set point and the real vibration.\n\
         - *Mains.* Where the author works mains has {} Hz, not 50: its carrier would fold to {} ∓ f at {} Hz. Pick-up of \
         the mains is a poor candidate; a carrier at exactly half the sample rate points at the instrument.\n\
         - *A linear Eq. (4) in steady state* moves at f and at nothing else; its two modes ring from the start only and die away. \
         A force at f leaves no line at 50 ∓ f ([claims](claims.md)).\n\
         - *One high line.* Sampling images every harmonic of Table 2, to 50 − n f; Table 2 prints one. An image is 2πnfτ of its harmonic, {} % at \
         {} Hz and {} % at {} Hz. No heights are printed, so low harmonics are not excluded.\n\n\
         Alternating sampling contradicts none of these, needs no second number, and has its line at exactly half the sample \
         rate less f, as all {} rows of Table 2. That is the likeliest reading; it is not proved.",
        range(&lines, 2),
        context.stated.mold_mass.printed(),
        range(&forces, 2),
        larger,
        EXCITATIONS_HZ.len(),
        MAINS_HZ,
        folded,
        context.sample_rate_hz(),
        significant(
            1e2 * std::f64::consts::TAU * EXCITATIONS_HZ[0] * context.timing.value,
            1
        ),
        EXCITATIONS_HZ[0],
        significant(1e2 * std::f64::consts::TAU * high * context.timing.value, 1),
        high,
        context.table2.rows.len(),
    ))
}

fn experiment_text(context: &Context) -> String {
    format!(
        "**Which experiment decides.** At {} Hz sampling and vibration give the same line at 50 − f: *the published data cannot decide* between \
         them by the displacement alone. Sampled at {FAST_RATE_HZ} Hz (half of it would do), the line moves to half the sample rate less f if the sampling makes \
         it, and stays, as a pair at 50 ∓ f, if the mold or a carrier does. A second sensor on its own converter, or another \
         sample rate, decides as well; a line in the pressure tells a real vibration from a carrier.",
        context.sample_rate_hz()
    )
}

fn forces(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "If the mold really moved at 50 − f",
        &[
            "f [Hz]",
            "line [Hz]",
            "motion that F0 of Table 4 asks for [µm]",
            "force on the moving mass [kN]",
            "fundamental of the pressure force [kN]",
        ],
    );
    for freq in EXCITATIONS_HZ {
        let [line, force] = line_force(context, freq)?;
        table.rows.push(vec![
            Cell::Number(freq, 1),
            Cell::Number(context.stated.image_base.si() - freq, 2),
            Cell::Number(1e6 * line, 3),
            Cell::Number(1e-3 * force, 3),
            Cell::Number(1e-3 * super::table5::one_dof_force(context, freq)?, 3),
        ]);
    }
    Ok(table)
}

fn amplitude_figure(context: &Context, tried: &[Trial]) -> Result<Block, ReproduceError> {
    let freqs = EXCITATIONS_HZ.to_vec();
    let kilo = |values: &[f64]| values.iter().map(|v| 1e-3 * v).collect::<Vec<_>>();
    let mut chart = LineChart::new("F0 of the beat part", "excitation [Hz]", "force [kN]");
    for (name, label, role) in [
        (TIMING, "sampling", Role::Corrected),
        (LINE, "proportional to f", Role::Recalibrated),
        (FROM_REST, "Eq. (4) from rest", Role::Other(0)),
        (GAIN, "gain", Role::Nominal),
    ] {
        let predicted = kilo(&named(tried, name)?.predicted);
        chart = chart.with(Series::new(label, role, freqs.clone(), predicted));
    }
    let published: Vec<f64> = context
        .table4
        .rows
        .iter()
        .map(|row| row.amplitude.si())
        .collect();
    chart = chart.with(
        Series::new("Table 4", Role::Measured, freqs, kilo(&published)).with_mark(Mark::Points),
    );
    (chart.x_range, chart.y_range) = (Some([0.5, 6.5]), Some([0.0, 450.0]));
    Ok(Block::Figure(
        "readings-heights",
        "The six F0, and what one number makes of them under four readings".to_owned(),
        chart,
    ))
}

fn pictures(context: &Context) -> Result<Vec<Block>, ReproduceError> {
    let freq = PICTURED_HZ;
    let mut blocks = Vec::new();
    for (stem, rate) in [
        ("readings-100hz", context.sample_rate_hz()),
        ("readings-500hz", FAST_RATE_HZ),
    ] {
        let series = |reading: Reading| -> Result<(Vec<f64>, Vec<f64>), ReproduceError> {
            let rebuilt = context.record(freq, rate, reading)?;
            let found = channel_spectrum(&rebuilt, DISPLACEMENT_CHANNEL)?;
            // A floor well above rounding and below every line.
            let amplitude = found.amplitude.iter().map(|a| 1e6 * a.max(1e-9)).collect();
            Ok((found.freq_hz, amplitude))
        };
        let (freqs, support) = series(context.support_reading(freq)?)?;
        let (freqs_timing, timing) = series(context.timing_reading())?;
        let mut chart = LineChart::new(
            format!("Displacement at {freq} Hz, sampled at {rate} Hz"),
            "frequency [Hz]",
            "amplitude [µm]",
        )
        .with(Series::new(
            "flexible support",
            Role::Nominal,
            freqs,
            support,
        ))
        .with(Series::new("alternating timing", Role::Corrected, freqs_timing, timing).dashed());
        chart.y_scale = Scale::Log;
        let base = context.stated.image_base.si();
        let caption = if rate == FAST_RATE_HZ {
            format!(
                "At {rate} Hz: {} Hz if the sampling makes the line, {} and {} Hz if the mold does",
                0.5 * rate - freq,
                base - freq,
                base + freq
            )
        } else {
            format!(
                "At {rate} Hz: one line at {} Hz under both readings",
                base - freq
            )
        };
        blocks.push(Block::Figure(stem, caption, chart));
    }
    Ok(blocks)
}
