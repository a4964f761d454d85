//! Table 4, Fig. 6 and Fig. 7: the beat part of the unknown force.

use simgap_alpha::{
    BeatFit, BeatParameters, ConverterFault, RateFormula, fit_folded_beat, fit_fourier,
};
use simgap_report::chart::{LineChart, Mark, Role, Series};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};

use super::context::{EXCITATIONS_HZ, PARK};
use super::number::range;
use super::page::print_resolution;
use super::spectra::stems;
use super::table3::HARMONICS;
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, significant};

/// Length of the records that the paper took its spectra from, s: 2.499 Hz is a bin of 2001 samples
/// ([Table 1](table1.md)).
const RECORD_S: f64 = 20.0;

/// Of the usual windows of a spectrum the one that makes least of where a line lies between two bins.
const WINDOW: Window = Window::BlackmanHarris;

/// What the height of a line may be low by when it is read off the nearest bin, relative: a tone half a bin off.
pub(crate) fn height_off_a_bin() -> Result<f64, ReproduceError> {
    let (count, bin) = (1000_usize, 100_usize);
    let turn = std::f64::consts::TAU * (bin as f64 + 0.5) / count as f64;
    let tone: Vec<f64> = (0..count).map(|n| (turn * n as f64).sin()).collect();
    let found = spectrum(&tone, count as f64, WINDOW, Trend::Mean)?;
    Ok(1.0 - found.amplitude[bin])
}

/// What ω, twice the frequency of a line, may be off, Hz: each line by the resolution 1/T of the
/// record, and half a unit of the last digit printed.
fn base_tolerance(printed: &simgap_tables::PrintedValue) -> f64 {
    2.0 / RECORD_S + print_resolution(printed.printed())
}

/// The beat part of a rebuilt record at the paper's rate, its Fourier part taken out first.
pub(crate) fn beat_of(
    context: &Context,
    freq_hz: f64,
    reading: simgap_mold::Reading,
) -> Result<BeatFit, ReproduceError> {
    let rebuilt = context.record(freq_hz, context.sample_rate_hz(), reading)?;
    let force = context.unknown_force(&rebuilt)?;
    let (step, skip) = (context.time_step_s(), context.first_second());
    let smooth = fit_fourier(&force.unknown_force, step, skip, freq_hz, HARMONICS)?;
    let rest: Vec<f64> = force
        .unknown_force
        .iter()
        .enumerate()
        .map(|(n, force)| force - smooth.value(n as f64 * step))
        .collect();
    Ok(fit_folded_beat(
        &rest,
        step,
        skip,
        context.stated.image_base.si() - freq_hz,
    )?)
}

/// Table 4 beside the beat part of the records rebuilt with the one timing error.
fn comparisons(context: &Context) -> Result<Vec<Comparison>, ReproduceError> {
    let mut rows = Vec::new();
    let low = height_off_a_bin()?;
    for row in &context.table4.rows {
        let freq = row.excitation.si();
        let beat = beat_of(context, freq, context.timing_reading())?.parameters;
        let compare = |item: &str,
                       unit: &'static str,
                       printed: &simgap_tables::PrintedValue,
                       ours: f64,
                       tolerance: f64| Comparison {
            item: format!("{item} at {} Hz", row.excitation.printed()),
            unit,
            printed: printed.printed().to_owned(),
            published: printed.si(),
            ours,
            tolerance,
        };
        let tolerance = low * row.amplitude.si();
        rows.push(compare(
            "F0",
            "N",
            &row.amplitude,
            beat.amplitude,
            tolerance,
        ));
        rows.push(compare(
            "ω",
            "Hz",
            &row.base,
            super::round_to(beat.base_hz, 7),
            base_tolerance(&row.base),
        ));
        rows.push(compare(
            "δ",
            "Hz",
            &row.split,
            super::round_to(beat.split_hz, 7),
            base_tolerance(&row.split),
        ));
    }
    Ok(rows)
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let rows = comparisons(context)?;
    let blocks = vec![
        Block::Text(format!(
            "Six records are rebuilt with **one** unknown for all rows: every other sample of the \
             displacement τ = {} ± {} ms late, the others as early. Each goes through Park's formula twice and \
             Eq. (3), the Fourier part is taken out, and F0 cos(δt/2) cos((ω+δ)t/2), read with cycles, is fitted to what is \
             left. At the paper's rate the two lines of a beat about 50 Hz fold onto one another: that its carrier is \
             50 Hz, and that there is a line above it, is the form of the fit and not a finding, for \
             the paper as for us.\n\nTolerances: for F0 {} %, by which the height of a line is low when it is read off the nearest bin of a \
             spectrum, as Fig. 6 shows them, with the window that makes least of it (Blackman-Harris); for ω and δ, twice the resolution 1/T of a record of T = {RECORD_S} s (a record of that \
             length has a bin at {} Hz, [Table 1](table1.md)) and half a unit of the last digit printed.",
            significant(1e3 * context.timing.value, 3),
            significant(1e3 * context.timing.standard_error, 1),
            significant(1e2 * height_off_a_bin()?, 2),
            context.stated.first_natural_freq.printed(),
        )),
        Block::Table(Table::comparisons("Table 4", &rows)),
        Block::Table(lines(context)),
        Block::Text(frequencies_text(context)),
        Block::Table(explanations(context)?),
        Block::Text(one_number_text(context)?),
        Block::Figure(
            "table4-amplitude",
            "Table 4: F0 as published, and from one number".to_owned(),
            amplitude_chart(context)?,
        ),
        spectrum_figure(context)?,
        time_figure(context)?,
    ];
    Ok(Page {
        stem: "table4",
        title: "Table 4: beat part of the unknown force".to_owned(),
        summary: "F0, ω, δ for 1 to 6 Hz from one timing error; alternatives".to_owned(),
        blocks,
    })
}

/// Largest distance of a printed line from 50 ∓ f, and the carriers, Hz.
pub(crate) fn printed_lines(context: &Context) -> (f64, Vec<f64>) {
    let base = context.stated.image_base.si();
    let mut off = 0.0_f64;
    let mut carriers = vec![];
    for row in &context.table4.rows {
        let (freq, beat) = (row.excitation.si(), published_beat(row));
        let lines = beat.lines();
        off = off
            .max((lines.lower_hz - base + freq).abs())
            .max((lines.upper_hz - base - freq).abs());
        carriers.push(beat.carrier_hz());
    }
    (off, carriers)
}

fn frequencies_text(context: &Context) -> String {
    let (off, carriers) = printed_lines(context);
    format!(
        "**Frequencies.** Read with cycles (times 2π), all printed lines lie within {} Hz of 50 ∓ f and all carriers \
         (ω+δ)/2 within {} Hz. A row outside its tolerance is not explained by the resolution of the record.",
        significant(off, 1),
        range(&carriers, 4),
    )
}

fn one_number_text(context: &Context) -> Result<String, ReproduceError> {
    let exact = context.explain(RateFormula::Exact, ConverterFault::AlternatingTiming)?;
    let (nyquist, step) = (0.5 * context.sample_rate_hz(), context.time_step_s());
    Ok(format!(
        "**One number.** With A = {} mm and Park's formula, alternating timing explains the six F0 \
         with R² = {} (R² about the mean of the six, least squares over the six F0). An alternating gain, flat in f, is \
         worse than the mean of the six values. With the exact derivative timing still explains them, less well (R² = {}): the \
         formula matters, since at the Nyquist frequency Park's gain is {} 1/s where the true \
         factor is {} 1/s. A straight line through zero, as the text says (\"proportional to the excitation \
         frequency\"), is also one number, and nearly as good: six points with this scatter favour timing through Park's \
         formula, they do not prove it ([all readings](readings.md)).",
        context.stated.amplitude.printed(),
        significant(context.timing.r_squared, 3),
        significant(exact.r_squared, 3),
        significant(PARK.rate(nyquist, step)?.norm(), 3),
        significant(RateFormula::Exact.rate(nyquist, step)?.norm(), 3),
    ))
}

fn published_beat(row: &simgap_tables::BeatRow) -> BeatParameters {
    BeatParameters {
        amplitude: row.amplitude.si(),
        base_hz: row.base.si(),
        split_hz: row.split.si(),
    }
}

fn lines(context: &Context) -> Table {
    let mut table = Table::new(
        "Lines of the printed beat functions",
        &[
            "f [Hz]",
            "ω/2 [Hz]",
            "less 50 − f",
            "ω/2 + δ [Hz]",
            "less 50 + f",
            "(ω+δ)/2 [Hz]",
        ],
    );
    for row in &context.table4.rows {
        let (freq, beat) = (row.excitation.si(), published_beat(row));
        let (lines, base) = (beat.lines(), context.stated.image_base.si());
        table.rows.push(vec![
            Cell::text(row.excitation.printed()),
            Cell::Number(lines.lower_hz, 5),
            Cell::Number(super::round_to(lines.lower_hz - (base - freq), 2), 2),
            Cell::Number(lines.upper_hz, 5),
            Cell::Number(super::round_to(lines.upper_hz - (base + freq), 2), 2),
            Cell::Number(beat.carrier_hz(), 5),
        ]);
    }
    table
}

/// R² and worst row of F0 = a f through the six rows.
pub(crate) fn proportional(context: &Context) -> (f64, f64, f64) {
    let rows = &context.table4.rows;
    let pairs = || {
        rows.iter()
            .map(|row| (row.excitation.si(), row.amplitude.si()))
    };
    let slope =
        pairs().map(|(f, force)| f * force).sum::<f64>() / pairs().map(|(f, _)| f * f).sum::<f64>();
    let average = pairs().map(|(_, force)| force).sum::<f64>() / rows.len() as f64;
    let left: f64 = pairs().map(|(f, force)| (force - slope * f).powi(2)).sum();
    let total: f64 = pairs().map(|(_, force)| (force - average).powi(2)).sum();
    let worst = pairs()
        .map(|(f, force)| (slope * f / force - 1.0).abs())
        .fold(0.0, f64::max);
    (slope, 1.0 - left / total, worst)
}

fn explanations(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "One number for the six F0",
        &["explanation", "derivative", "number", "R²", "worst row"],
    );
    for (fault, name) in [
        (ConverterFault::AlternatingTiming, "alternating timing"),
        (ConverterFault::AlternatingGain, "alternating gain"),
    ] {
        for (formula, derivative) in [(PARK, "Park"), (RateFormula::Exact, "exact")] {
            let found = context.explain(formula, fault)?;
            let number = match fault {
                ConverterFault::AlternatingTiming => {
                    format!("τ = {} ms", significant(1e3 * found.value, 3))
                }
                ConverterFault::AlternatingGain => {
                    format!("ε = {} %", significant(1e2 * found.value, 3))
                }
            };
            table.rows.push(vec![
                Cell::text(name),
                Cell::text(derivative),
                Cell::text(number),
                Cell::Number(found.r_squared, 3),
                Cell::text(format!(
                    "{} %",
                    significant(1e2 * found.worst_relative_error, 2)
                )),
            ]);
        }
    }
    let (slope, r_squared, worst) = proportional(context);
    table.rows.push(vec![
        Cell::text("F0 proportional to f"),
        Cell::text("none"),
        Cell::text(format!("{} N per Hz", significant(slope, 4))),
        Cell::Number(r_squared, 3),
        Cell::text(format!("{} %", significant(1e2 * worst, 2))),
    ]);
    Ok(table)
}

fn amplitude_chart(context: &Context) -> Result<LineChart<'static>, ReproduceError> {
    let freqs = EXCITATIONS_HZ.to_vec();
    let kilo = |values: Vec<f64>| -> Vec<f64> { values.iter().map(|v| 1e-3 * v).collect() };
    let predicted = |formula, fault| -> Result<Vec<f64>, ReproduceError> {
        let rows = context.explain(formula, fault)?.rows;
        Ok(kilo(rows.iter().map(|row| row.predicted).collect()))
    };
    let published = kilo(
        context
            .table4
            .rows
            .iter()
            .map(|row| row.amplitude.si())
            .collect(),
    );
    let timing = ConverterFault::AlternatingTiming;
    let gain = predicted(PARK, ConverterFault::AlternatingGain)?;
    let mut chart = LineChart::new("F0 of the beat part", "excitation [Hz]", "force [kN]")
        .with(Series::new(
            "timing, Park",
            Role::Corrected,
            freqs.clone(),
            predicted(PARK, timing)?,
        ))
        .with(
            Series::new(
                "timing, exact derivative",
                Role::Recalibrated,
                freqs.clone(),
                predicted(RateFormula::Exact, timing)?,
            )
            .dashed(),
        )
        .with(Series::new("gain, Park", Role::Nominal, freqs.clone(), gain).dashed())
        .with(Series::new("Table 4", Role::Measured, freqs, published).with_mark(Mark::Points));
    // Room for the first and last point.
    (chart.x_range, chart.y_range) = (Some([0.5, 6.5]), Some([0.0, 450.0]));
    Ok(chart)
}

fn spectrum_figure(context: &Context) -> Result<Block, ReproduceError> {
    let (row, rate) = (&context.table4.rows[0], context.sample_rate_hz());
    let rebuilt = context.record(1.0, rate, context.timing_reading())?;
    let force = context.unknown_force(&rebuilt)?;
    let beat = published_beat(row);
    let step = context.time_step_s();
    let printed: Vec<f64> = (0..force.unknown_force.len())
        .map(|n| beat.value(n as f64 * step))
        .collect();
    let high = |values: &[f64]| -> Result<(Vec<f64>, Vec<f64>), ReproduceError> {
        let found = spectrum(values, rate, Window::Hann, Trend::Mean)?;
        let from = found.nearest_bin(47.0);
        let amplitude = found.amplitude[from..].iter().map(|a| 1e-3 * a).collect();
        Ok((found.freq_hz[from..].to_vec(), amplitude))
    };
    let (freq, ours) = high(&force.unknown_force[context.first_second()..])?;
    let (freq_printed, theirs) = high(&printed)?;
    let chart = LineChart::new(
        "Spectrum of the unknown force at 1 Hz",
        "frequency [Hz]",
        "amplitude [kN]",
    )
    .with(Series::new(
        "beat function of Table 4, sampled as the record",
        Role::Nominal,
        freq_printed,
        theirs,
    ))
    .with(stems("rebuilt record", Role::Measured, freq, ours));
    let lines = beat.lines();
    let caption = format!(
        "Fig. 6 in kind: spectrum near 50 Hz. The printed beat has lines at {} and {} Hz; the second folds to {} Hz",
        significant(lines.lower_hz, 4),
        significant(lines.upper_hz, 4),
        significant(rate - lines.upper_hz, 4),
    );
    Ok(Block::Figure("fig06-spectrum", caption, chart))
}

fn time_figure(context: &Context) -> Result<Block, ReproduceError> {
    let step = context.time_step_s();
    let rebuilt = context.record(1.0, context.sample_rate_hz(), context.timing_reading())?;
    let force = context.unknown_force(&rebuilt)?;
    let smooth = fit_fourier(
        &force.unknown_force,
        step,
        context.first_second(),
        1.0,
        HARMONICS,
    )?;
    let beat = beat_of(context, 1.0, context.timing_reading())?;
    let range = 100..201;
    let time: Vec<f64> = range.clone().map(|n| n as f64 * step).collect();
    let record = force.unknown_force[range]
        .iter()
        .map(|force| 1e-3 * force)
        .collect::<Vec<f64>>();
    let expression: Vec<f64> = time
        .iter()
        .map(|t| 1e-3 * (smooth.value(*t) + beat.value(*t)))
        .collect();
    let chart = LineChart::new(
        "Unknown force and its expression at 1 Hz",
        "time [s]",
        "force [kN]",
    )
    .with(Series::new(
        "rebuilt record",
        Role::Measured,
        time.clone(),
        record,
    ))
    .with(Series::new("Fourier part + beat", Role::Corrected, time, expression).dashed());
    Ok(Block::Figure(
        "fig07-expression",
        "Fig. 7 in kind: unknown force of the rebuilt record and the fitted expression, phases fitted too"
            .to_owned(),
        chart,
    ))
}
