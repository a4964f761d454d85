//! Leads on what the paper's own gap might be.

use simgap_alpha::{ConverterFault, Explanation, RateFormula, leads};

use super::super::context::{FAST_RATE_HZ, PARK};
use super::super::machine;
use super::super::page::print_resolution;
use super::super::servo::Servo;
use super::super::two_rates::part_at_the_fast_rate_only;
use super::super::{Context, ReproduceError, Verdict, significant};
use super::Claim;
use super::tables::spread_of_centre;

/// A figure as the lead gives it: what is claimed, and what is checked.
struct Given {
    printed: &'static str,
}

impl Given {
    const fn new(printed: &'static str) -> Self {
        Self { printed }
    }

    /// Whether a number rounds to it.
    fn is(&self, value: f64) -> bool {
        let given: f64 = self.printed.parse().unwrap_or(f64::NAN);
        (value - given).abs() <= print_resolution(self.printed)
    }
}

impl std::fmt::Display for Given {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.printed)
    }
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
    let [late_ms, fits, worst] = ["0.617", "0.994", "6.3"].map(Given::new);
    let [exact_fits, exact_worst] = ["0.988", "14"].map(Given::new);
    let [park_rate, exact_rate] = ["533", "314"].map(Given::new);
    let one_number = late_ms.is(1e3 * timing.value)
        && fits.is(timing.r_squared)
        && worst.is(1e2 * timing.worst_relative_error);
    let less_well =
        exact_fits.is(exact.r_squared) && exact_worst.is(1e2 * exact.worst_relative_error);
    let rates = park_rate.is(park) && exact_rate.is(true_rate);
    Ok(vec![
        Claim::judged(
            format!(
                "one alternating timing error gives all six F0: {late_ms} ms, R² {fits}, {worst} %"
            ),
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
            format!("the exact derivative does it less well: R² {exact_fits}, {exact_worst} %"),
            "Table 4",
            (less_well, Verdict::Reproduced),
            explained(&exact),
        ),
        Claim::judged(
            format!(
                "at the Nyquist frequency Park's gain is {park_rate} 1/s, the true factor {exact_rate} 1/s"
            ),
            "2.1.3",
            (rates, Verdict::Reproduced),
            format!(
                "{} and {} 1/s",
                significant(park, 4),
                significant(true_rate, 4)
            ),
        ),
        Claim::judged(
            "the published data cannot decide between timing, support and a modulated carrier at half the sample rate; sampling \
             much faster would",
            "Tables 2, 4",
            (part_at_the_fast_rate_only(context)?, Verdict::Reproduced),
            format!(
                "rebuilt records of both readings have a line at 50 − f at {} Hz and different lines at {FAST_RATE_HZ} Hz ([readings](readings.md))",
                context.sample_rate_hz()
            ),
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
    let given = ["0.53", "0.46", "0.44", "0.38"].map(Given::new);
    let agree = shares
        .iter()
        .zip(&given)
        .all(|(share, given)| given.is(*share));
    let stated_shares = given.map(|given| given.printed).join(", ");
    let [given_ratio, given_mass] = ["0.135", "33.615"].map(Given::new);
    let shown: Vec<String> = shares.iter().map(|share| significant(*share, 2)).collect();
    let left = |share: f64| significant((1.0 - share) * mold.damping_ratio(), 2);
    let stated = context.stated.first_natural_freq.si();
    let ratio = leads::damping_ratio_of_damped_freq(mold.natural_freq_hz(), stated)?;
    let mass = leads::mass_of_natural_freq(mold.stiffness(), stated)?;
    Ok(vec![
        Claim::judged(
            format!("as a damping error, Table 3 lowers c by {stated_shares} at 1 to 4 Hz"),
            "Table 3",
            (agree, Verdict::Reproduced),
            format!(
                "{}; ζ {} to {} instead of {}. Not beyond: 5 Hz would need negative damping, 6 Hz does not fit",
                shown.join(", "),
                left(shares[0]),
                left(shares[3]),
                context.table1.damping_ratio.printed()
            ),
        ),
        Claim::judged(
            format!(
                "{} Hz is the damped frequency at ζ = {given_ratio}, or the natural one of {given_mass} t",
                context.stated.first_natural_freq.printed()
            ),
            "3.1",
            (
                given_ratio.is(ratio) && given_mass.is(1e-3 * mass),
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

/// What two cylinders and their servo say of k₁ and K.
pub(super) fn on_the_machine(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let needed = machine::bulk_modulus_of_k1(context)?;
    let [least, most] = machine::BULK_MODULUS_OF_OIL_PA;
    let servo = Servo::new(context)?;
    let rows = &context.table3.rows;
    let tenth = 0.1 * rows[4].peak_to_peak.si();
    let between = (rows[5].peak_to_peak.si()..rows[3].peak_to_peak.si()).contains(&tenth);
    Ok(vec![
        Claim::judged(
            "k₁ is the size of shut oil in two cylinders",
            "Table 5",
            ((least..=most).contains(&needed), Verdict::Reproduced),
            format!(
                "two of {} m² over {} mm of oil, assumed, take {} GPa for it; mineral oil has {} to {} GPa ([the machine](machine.md))",
                machine::CYLINDER[0],
                significant(1e3 * machine::CYLINDER[1], 2),
                significant(1e-9 * needed, 3),
                significant(1e-9 * least, 2),
                significant(1e-9 * most, 2)
            ),
        ),
        Claim::judged(
            "K of Table 1 is the stiffness of the servo",
            "Table 1",
            (servo.leaks_little(), Verdict::Reproduced),
            format!(
                "with c of Table 1 it takes a leak of {} l/min at the supply pressure, {} times what the valves assumed pass at their rated \
                 drop; the servo assumed is {} times as stiff ([the machine](machine.md))",
                significant(servo.leak_l_per_min, 3),
                significant(servo.leak_share, 2),
                significant(servo.times_as_stiff, 3)
            ),
        ),
        Claim::judged(
            format!(
                "{} N is a misplaced decimal",
                rows[4].peak_to_peak.printed()
            ),
            "Table 3",
            (between, Verdict::Reproduced),
            format!(
                "a tenth of it, {} N, would lie between its neighbours; nothing printed says that it is so",
                significant(tenth, 6)
            ),
        ),
    ])
}
