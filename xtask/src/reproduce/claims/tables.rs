//! Claims on Tables 1 to 4.

use simgap_mold::STANDARD_GRAVITY;

use super::super::context::mean;
use super::super::number::range;
use super::super::table3::{centres, spread};
use super::super::table4::{height_off_a_bin, printed_lines, proportional};
use super::super::{Context, ReproduceError, Verdict, machine, significant, spectra, table1};
use super::Claim;

pub(super) fn on_table_1(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let mold = &context.mold;
    let stated = &context.stated.first_natural_freq;
    let freqs = [
        Some(mold.natural_freq_hz()),
        mold.damped_freq_hz(),
        mold.resonance_freq_hz(),
    ];
    let near = (mold.natural_freq_hz() - stated.si()).abs() <= table1::half_bin_hz(context);
    let step = table1::comparisons(context)?;
    let [pressure, _] = table1::pressure_comparisons(context)?;
    let agrees = step.len() == 3
        && pressure.len() == 3
        && step
            .iter()
            .chain(&pressure)
            .all(|row| row.verdict() != Verdict::NotReproducible);
    let shown = |freq: Option<f64>| significant(freq.unwrap_or(f64::NAN), 5);
    Ok(vec![
        Claim::judged(
            "mass, damping ratio and stiffness follow from a step",
            "2.1.1, Table 1",
            (agrees, Verdict::WithinTolerance),
            "a simulated step returns the printed values, and so does the pressure force of a step; the measured step is lost \
             ([Table 1](table1.md))",
        ),
        Claim::judged(
            format!("the first natural frequency is {} Hz", stated.printed()),
            "3.1",
            (near, Verdict::WithinTolerance),
            format!(
                "Table 1 gives {} Hz natural, {} Hz damped, {} Hz at resonance; the printed one is the bin nearest to the natural one in a \
                 spectrum of {} samples",
                shown(freqs[0]),
                shown(freqs[1]),
                shown(freqs[2]),
                table1::bins(context).first().copied().unwrap_or(0)
            ),
        ),
    ])
}

pub(super) fn on_table_2(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let nyquist = 0.5 / context.time_step_s();
    let base = context.stated.image_base.si();
    Ok(vec![
        Claim::judged(
            "displacement has a line at 50 − f, pressure has none",
            "2.1.2, Table 2",
            (
                spectra::high_lines_as_printed(context)?,
                Verdict::Reproduced,
            ),
            format!(
                "follows from one timing error on the displacement ([Table 2](table2.md)); all {} printed lines are half the \
                 sample rate less f",
                context.table2.rows.len()
            ),
        ),
        Claim::judged(
            "the line at 50 − f shows that the support changes with the excitation",
            "2.1.2, 2.2.1",
            (base != nyquist, Verdict::WithinTolerance),
            format!(
                "{} Hz is half the sample rate: the image of f by the sampling lies there too, and what is printed \
                 cannot tell them apart ([readings](readings.md))",
                significant(nyquist, 2)
            ),
        ),
    ])
}

/// Largest relative distance of an a0 from their mean.
pub(super) fn spread_of_centre(context: &Context) -> f64 {
    spread(&centres(context))
}

pub(super) fn on_table_3(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let average = mean(&centres(context));
    let spread = spread_of_centre(context);
    let weight = &context.stated.weight_equivalent;
    let mass = -average / STANDARD_GRAVITY;
    let stroke: Vec<f64> = context
        .table3
        .rows
        .iter()
        .map(|row| row.peak_to_peak.si())
        .collect();
    let grows = stroke[..4].windows(2).all(|pair| pair[1] > pair[0]);
    let jumps = stroke[4] > 4.0 * stroke[3] && stroke[5] < stroke[3];
    let jumped = machine::jumps(context)?;
    let torsional = jumped
        .iter()
        .any(|jump| jump.fits(machine::printed_strokes(context)));
    Ok(vec![
        Claim::judged(
            "a0 is steady over the excitations",
            "2.1.4, Table 3",
            (spread < 0.01, Verdict::Reproduced),
            format!(
                "{} N on average, none further off than {} %",
                significant(average, 5),
                significant(1e2 * spread, 2)
            ),
        ),
        Claim::judged(
            format!("a0 corresponds to {} tons", weight.printed()),
            "2.1.4",
            (
                (mass / weight.si() - 1.0).abs() < spread,
                Verdict::WithinTolerance,
            ),
            format!(
                "{} t at standard gravity; tolerance: the scatter of the six a0",
                significant(1e-3 * mass, 5)
            ),
        ),
        Claim::judged(
            "the stroke of the Fourier part grows up to 4 Hz, jumps at 5 Hz, falls at 6 Hz",
            "2.1.4, Table 3",
            (grows && jumps, Verdict::Reproduced),
            "read off the table; the records are rebuilt from it ([Table 3](table3.md))",
        ),
        Claim::judged(
            "a torsional mode causes the jump at 5 Hz",
            "2.1.4",
            (torsional, Verdict::WithinTolerance),
            format!(
                "a roll at {} Hz on two unequal cylinders takes a mismatch of {} % with the damping of Table 1, {} % with {} of it; \
                 {} ([the machine](machine.md))",
                context.stated.torsional_mode.printed(),
                significant(1e2 * jumped[0].mismatch, 2),
                significant(1e2 * jumped[jumped.len() - 1].mismatch, 2),
                significant(machine::DAMPING_SHARES[jumped.len() - 1], 2),
                if torsional {
                    "the rows beside allow it"
                } else {
                    "then the rows beside would be larger than printed"
                }
            ),
        ),
    ])
}

pub(super) fn on_table_4(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let (off, carriers) = printed_lines(context);
    let holds = off < super::super::table5::MODE_TOLERANCE_HZ;
    let (_, r_squared, worst) = proportional(context);
    let period = 1.0 / context.table4.rows[0].split.si();
    let low = height_off_a_bin()?;
    Ok(vec![
        Claim::judged(
            "the beat has lines at 50 ∓ f",
            "2.1.4, Table 4",
            (holds, Verdict::WithinTolerance),
            format!(
                "read with cycles: lines within {} Hz of it, carriers {} Hz; tolerance {} Hz, half a unit of the last digit printed",
                significant(off, 1),
                range(&carriers, 4),
                super::super::table5::MODE_TOLERANCE_HZ
            ),
        ),
        Claim::judged(
            format!(
                "the beat period at 1 Hz is {} s",
                context.stated.beat_period.printed()
            ),
            "2.2.3",
            (
                period == context.stated.beat_period.si(),
                Verdict::Reproduced,
            ),
            "1/δ of Table 4",
        ),
        Claim::judged(
            "the beat's amplitude is proportional to the excitation frequency",
            "2.1.4, Table 4",
            (worst < low, Verdict::WithinTolerance),
            format!(
                "a line through zero has R² = {} and misses a row by {} %; tolerance {} %, for heights read off a bin ([Table 4](table4.md))",
                significant(r_squared, 3),
                significant(1e2 * worst, 2),
                significant(1e2 * low, 2)
            ),
        ),
    ])
}
