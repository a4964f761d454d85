//! Table 3 and Fig. 5: the Fourier part of the unknown force.

use simgap_alpha::{fit_fourier, leads};
use simgap_mold::STANDARD_GRAVITY;
use simgap_report::chart::{LineChart, Mark, Role, Series};

use super::context::{EXCITATIONS_HZ, PARK, mean};
use super::number::range;
use super::spectra::symmetric_range;
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, significant};

/// What the timing error takes off the peak to peak in second order, N: a sample taken late and early by τ
/// in turn makes the fundamental lower by the share (2πfτ)²/2, and with it the force 2 A |G| that balances it.
fn second_order(context: &Context, freq_hz: f64) -> Result<f64, ReproduceError> {
    let turned = std::f64::consts::TAU * freq_hz * context.timing.value;
    let balance = 2.0 * super::table5::one_dof_force(context, freq_hz)?;
    Ok(0.5 * turned * turned * balance)
}

/// Harmonics fitted. At 5 Hz the images 50 − 5n of the fourth and higher harmonics of the
/// displacement fall on harmonics again; with three they do not.
pub(crate) const HARMONICS: usize = 3;

/// Table 3 beside the Fourier part of the rebuilt records.
fn comparisons(context: &Context) -> Result<Vec<Comparison>, ReproduceError> {
    let mut rows = Vec::new();
    for row in &context.table3.rows {
        let freq = row.excitation.si();
        let rebuilt = context.record(freq, context.sample_rate_hz(), context.timing_reading())?;
        let force = context.unknown_force(&rebuilt)?;
        let fit = fit_fourier(
            &force.unknown_force,
            context.time_step_s(),
            context.first_second(),
            freq,
            HARMONICS,
        )?;
        let tolerance = second_order(context, freq)?;
        let compare = |item: &str, printed: &simgap_tables::PrintedValue, ours: f64| Comparison {
            item: format!("{item} at {} Hz", row.excitation.printed()),
            unit: "N",
            printed: printed.printed().to_owned(),
            published: printed.si(),
            ours,
            tolerance,
        };
        rows.push(compare("a0", &row.centre, fit.mean));
        rows.push(compare("max − min", &row.peak_to_peak, fit.peak_to_peak()));
    }
    Ok(rows)
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let rows = comparisons(context)?;
    let mut blocks = vec![
        Block::Text(format!(
            "The unknown force of each rebuilt record, through Park's formula twice and Eq. (3), fitted \
             with a mean and {HARMONICS} harmonics. The records were rebuilt from this table, so this row \
             by row agreement checks the chain (sampling, Park, Eq. (3), fit) and not the machine. \
             The first second is left out, so that a whole number of periods remains. Tolerance: what the timing error takes \
             off the fundamental in second order, (2πfτ)²/2 of the force 2 A |G(f)| that balances it."
        )),
        Block::Table(Table::comparisons("Table 3", &rows)),
        Block::Table(weight(context)),
        Block::Text(centre_text(context)),
        Block::Table(damping(context)?),
        Block::Text(stroke_text(context)?),
        Block::Figure(
            "table3-stroke",
            "Table 3: peak to peak of the Fourier part, and what Park's formula makes by itself"
                .to_owned(),
            stroke_chart(context)?,
        ),
    ];
    for (stem, freq) in [("fig05-1hz", 1.0), ("fig05-3hz", 3.0), ("fig05-6hz", 6.0)] {
        blocks.push(force_figure(context, stem, freq)?);
    }
    Ok(Page {
        stem: "table3",
        title: "Table 3: Fourier part of the unknown force".to_owned(),
        summary: "a0 and peak to peak; weight, damping, and the part Park's formula makes"
            .to_owned(),
        blocks,
    })
}

/// The six a0, N.
pub(crate) fn centres(context: &Context) -> Vec<f64> {
    let rows = context.table3.rows.iter();
    rows.map(|row| row.centre.si()).collect()
}

/// Largest relative distance of a value from the mean of all.
pub(crate) fn spread(values: &[f64]) -> f64 {
    let average = mean(values);
    let off = values.iter().map(|value| (value / average - 1.0).abs());
    off.fold(0.0, f64::max)
}

fn centre_text(context: &Context) -> String {
    let centres = centres(context);
    let stated = &context.stated.weight_equivalent;
    let ours = -mean(&centres) / STANDARD_GRAVITY;
    format!(
        "**a0** is the same for all excitations within {} % of its mean: a static error, of weight or of the pressure's zero. \
         {} t agrees with the mean of the table to {} %, not to its digits: the paper prints neither its g nor its rounding, nor \
         which of the six it means. Tolerance: the scatter of the six.",
        significant(1e2 * spread(&centres), 2),
        stated.printed(),
        significant(1e2 * (ours / stated.si() - 1.0).abs(), 1),
    )
}

fn stroke_text(context: &Context) -> Result<String, ReproduceError> {
    let rows = &context.table3.rows;
    let per_hz: Vec<String> = rows[..4]
        .iter()
        .map(|row| significant(1e-3 * row.peak_to_peak.si() / row.excitation.si(), 3))
        .collect();
    let share = |row: &simgap_tables::FourierRow| {
        let (stroke, freq) = (row.peak_to_peak.si(), row.excitation.si());
        leads::damping_share(stroke, context.mold.damping(), context.amplitude(), freq)
    };
    let ratios = rows[..4]
        .iter()
        .map(|row| Ok((1.0 - share(row)?) * context.mold.damping_ratio()))
        .collect::<Result<Vec<f64>, ReproduceError>>()?;
    let last = &rows[5];
    let step = context.time_step_s();
    let own = |row: &simgap_tables::FourierRow| {
        leads::formula_stroke(
            &context.plant,
            PARK,
            context.amplitude(),
            row.excitation.si(),
            step,
        )
    };
    Ok(format!(
        "**Peak to peak.** Grows about as f up to {} Hz (reproduced from the table: {} kN per Hz), jumps at {} Hz, falls at \
         {} Hz. If it is a damping error alone, c is lower than Table 1 by the share in the table, and ζ is {} for the first \
         four rows.\n\n\
         **Park's own part.** At {} s Park's formula is not exact, and by itself makes the apparent force of the third column \
         for a mold that obeys Eq. (1) perfectly: (ωh)²/6 too much per derivative. In the first three rows it does not matter \
         (it is {} % of the third). At {} Hz it is {} kN peak to peak, {} the {} kN that the paper reports: the fall \
         there may be no more than the formula's error cancelling part of the force, and no damping error alone gives it. \
         What a torsional mode, the paper's explanation of {} Hz, would take is computed in [the machine](machine.md).",
        rows[3].excitation.printed(),
        per_hz.join(", "),
        rows[4].excitation.printed(),
        last.excitation.printed(),
        range(&ratios, 2),
        context.stated.time_step.printed(),
        significant(1e2 * own(&rows[2])? / rows[2].peak_to_peak.si(), 1),
        last.excitation.printed(),
        significant(1e-3 * own(last)?, 2),
        if own(last)? > last.peak_to_peak.si() {
            "**more than**"
        } else {
            "less than"
        },
        significant(1e-3 * last.peak_to_peak.si(), 2),
        rows[4].excitation.printed(),
    ))
}

fn weight(context: &Context) -> Table {
    let centres = centres(context);
    let stated = &context.stated.weight_equivalent;
    let row = Comparison {
        item: format!(
            "mean a0 = {} N, over g = {STANDARD_GRAVITY}",
            significant(mean(&centres), 7)
        ),
        unit: "ton",
        printed: stated.printed().to_owned(),
        published: stated.value(),
        ours: -mean(&centres) / STANDARD_GRAVITY / stated.unit().si_factor(),
        // Which of the six a0 the text means it does not say.
        tolerance: spread(&centres) * stated.value(),
    };
    Table::comparisons(&format!("Section 2.1.4: {} tons", stated.printed()), &[row])
}

fn damping(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "If the Fourier part is a damping error",
        &[
            "f [Hz]",
            "max − min [N]",
            "Park's own part [N]",
            "c lower by",
            "ζ instead of Table 1",
            "c lower by, Park's part taken out",
        ],
    );
    let (damping, amplitude) = (context.mold.damping(), context.amplitude());
    for row in &context.table3.rows {
        let (freq, stroke) = (row.excitation.si(), row.peak_to_peak.si());
        let step = context.time_step_s();
        let share = leads::damping_share(stroke, damping, amplitude, freq)?;
        let own = leads::formula_stroke(&context.plant, PARK, amplitude, freq, step)?;
        let through =
            leads::damping_share_through(&context.plant, PARK, stroke, amplitude, freq, step)?;
        let ratio = (1.0 - share) * context.mold.damping_ratio();
        table.rows.push(vec![
            Cell::text(row.excitation.printed()),
            Cell::text(row.peak_to_peak.printed()),
            Cell::Number(own, 3),
            Cell::Number(share, 3),
            if ratio > 0.0 {
                Cell::Number(ratio, 3)
            } else {
                Cell::text("negative")
            },
            through.map_or_else(|| Cell::text("impossible"), |share| Cell::Number(share, 3)),
        ]);
    }
    Ok(table)
}

fn stroke_chart(context: &Context) -> Result<LineChart<'static>, ReproduceError> {
    let published: Vec<f64> = context
        .table3
        .rows
        .iter()
        .map(|row| 1e-3 * row.peak_to_peak.si())
        .collect();
    let (mut freqs, mut own) = (vec![], vec![]);
    for tenth in 5..=65 {
        let freq = 0.1 * f64::from(tenth);
        let (amplitude, step) = (context.amplitude(), context.time_step_s());
        freqs.push(freq);
        own.push(1e-3 * leads::formula_stroke(&context.plant, PARK, amplitude, freq, step)?);
    }
    Ok(LineChart::new(
        "Fourier part, peak to peak",
        "excitation [Hz]",
        "force [kN]",
    )
    .with(Series::new(
        "made by Park's formula alone",
        Role::Nominal,
        freqs,
        own,
    ))
    .with(
        Series::new(
            "Table 3",
            Role::Measured,
            EXCITATIONS_HZ.to_vec(),
            published,
        )
        .with_mark(Mark::Points),
    ))
}

fn force_figure(context: &Context, stem: &'static str, freq: f64) -> Result<Block, ReproduceError> {
    let rebuilt = context.record(freq, context.sample_rate_hz(), context.timing_reading())?;
    let force = context.unknown_force(&rebuilt)?;
    let range = 100..301;
    let time: Vec<f64> = rebuilt.record.time_s()[range.clone()].to_vec();
    let value: Vec<f64> = force.unknown_force[range]
        .iter()
        .map(|force| 1e-3 * force)
        .collect();
    let mut chart = LineChart::new(
        format!("Unknown force at {freq} Hz"),
        "time [s]",
        "force [kN]",
    );
    chart.y_range = Some(symmetric_range(&value));
    chart = chart.with(Series::new("rebuilt record", Role::Measured, time, value));
    let caption = format!("Fig. 5 in kind: unknown force of the rebuilt record at {freq} Hz");
    Ok(Block::Figure(stem, caption, chart))
}
