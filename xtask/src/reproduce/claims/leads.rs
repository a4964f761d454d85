//! Leads on what the paper's own gap might be.

use simgap_alpha::{ConverterFault, Explanation, RateFormula, leads};

use super::super::context::PARK;
use super::super::readings::part_at_the_fast_rate_only;
use super::super::{Context, ReproduceError, Verdict, significant};
use super::Claim;
use super::tables::spread_of_centre;

/// Whether a number rounds to one given with three decimals.
fn to_three_decimals(value: f64, given: f64) -> bool {
    (value - given).abs() < 5e-4
}

fn explained(found: &Explanation) -> String {
    format!(
        "τ = {} ms, R² = {}, worst row {} %",
        significant(1e3 * found.value, 3),
        significant(found.r_squared, 3),
        significant(1e2 * found.worst_relative_error, 2)
    )
}

pub(super) fn on_timing(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let timing = &context.timing;
    let exact = context.explain(RateFormula::Exact, ConverterFault::AlternatingTiming)?;
    let gain = context.explain(PARK, ConverterFault::AlternatingGain)?;
    let step = context.time_step_s();
    let park = PARK.rate(0.5 / step, step)?.norm();
    let true_rate = RateFormula::Exact.rate(0.5 / step, step)?.norm();
    let one_number = to_three_decimals(1e3 * timing.value, 0.617)
        && to_three_decimals(timing.r_squared, 0.994)
        && to_three_decimals(timing.worst_relative_error, 0.063);
    let less_well = to_three_decimals(exact.r_squared, 0.988)
        && (exact.worst_relative_error - 0.14).abs() < 5e-3;
    let rates = (park - 533.0).abs() < 0.5 && (true_rate - 314.0).abs() < 0.5;
    Ok(vec![
        Claim::judged(
            "one alternating timing error gives all six F0: 0.617 ms, R² 0.994, 6.3 %",
            "Table 4, Park's formula",
            (one_number, Verdict::Reproduced),
            explained(timing),
        ),
        Claim::judged(
            "an alternating gain does not: R² below zero",
            "Table 4",
            (gain.r_squared < 0.0, Verdict::Reproduced),
            format!("R² = {}", significant(gain.r_squared, 2)),
        ),
        Claim::judged(
            "the exact derivative does it less well: R² 0.988, 14 %",
            "Table 4",
            (less_well, Verdict::Reproduced),
            explained(&exact),
        ),
        Claim::judged(
            "at the Nyquist frequency Park's gain is 533 1/s, the true factor 314 1/s",
            "2.1.3",
            (rates, Verdict::Reproduced),
            format!(
                "{} and {} 1/s",
                significant(park, 4),
                significant(true_rate, 4)
            ),
        ),
        Claim::judged(
            "the published data cannot decide between timing, support and a modulated 50 Hz carrier; sampling at 250 Hz \
             or more would",
            "Tables 2, 4",
            (part_at_the_fast_rate_only(context)?, Verdict::Reproduced),
            "rebuilt records of both readings have a line at 50 − f at 100 Hz and different lines at 500 Hz ([readings](readings.md))",
        ),
    ])
}

pub(super) fn on_damping(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let (mold, amplitude) = (&context.mold, context.amplitude());
    let share = |row: &simgap_tables::FourierRow| {
        leads::damping_share(
            row.peak_to_peak.si(),
            mold.damping(),
            amplitude,
            row.excitation.si(),
        )
    };
    let shares = context.table3.rows[..4]
        .iter()
        .map(share)
        .collect::<Result<Vec<f64>, _>>()?;
    let given = [0.53, 0.46, 0.44, 0.38];
    let agree = shares
        .iter()
        .zip(given)
        .all(|(share, given)| (share - given).abs() < 5e-3);
    let shown: Vec<String> = shares.iter().map(|share| significant(*share, 2)).collect();
    let left = |share: f64| significant((1.0 - share) * mold.damping_ratio(), 2);
    let stated = context.stated.first_natural_freq.si();
    let ratio = leads::damping_ratio_of_damped_freq(mold.natural_freq_hz(), stated)?;
    let mass = leads::mass_of_natural_freq(mold.stiffness(), stated)?;
    Ok(vec![
        Claim::judged(
            "as a damping error, Table 3 lowers c by 0.53, 0.46, 0.44, 0.38 at 1 to 4 Hz",
            "Table 3",
            (agree, Verdict::Reproduced),
            format!(
                "{}; ζ {} to {} instead of 0.3. Not beyond: 5 Hz would need negative damping, 6 Hz does not fit",
                shown.join(", "),
                left(shares[0]),
                left(shares[3])
            ),
        ),
        Claim::judged(
            "2.499 Hz is the damped frequency at ζ = 0.135, or the natural one of 33.615 t",
            "3.1",
            (
                to_three_decimals(ratio, 0.135) && to_three_decimals(1e-3 * mass, 33.615),
                Verdict::Reproduced,
            ),
            format!(
                "ζ = {}, m = {} kg",
                significant(ratio, 3),
                significant(mass, 5)
            ),
        ),
    ])
}

pub(super) fn on_the_rest(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let (last, step) = (&context.table3.rows[5], context.time_step_s());
    let own = leads::formula_stroke(
        &context.plant,
        PARK,
        context.amplitude(),
        last.excitation.si(),
        step,
    )?;
    Ok(vec![
        Claim::judged(
            "a0 is a static error, of weight or of the pressure's zero",
            "Table 3",
            (spread_of_centre(context) < 0.01, Verdict::Reproduced),
            "it does not depend on f; which of the two it is, nothing printed says",
        ),
        Claim::judged(
            "new: Park's formula by itself makes more than the 6 Hz value of Table 3",
            "Table 3",
            (own > last.peak_to_peak.si(), Verdict::Reproduced),
            format!(
                "{} N peak to peak against {} N printed ([Table 3](table3.md))",
                significant(own, 4),
                last.peak_to_peak.printed()
            ),
        ),
    ])
}
