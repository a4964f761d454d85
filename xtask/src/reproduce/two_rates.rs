//! The lines of the displacement under two readings, at the paper's rate and at a fast one.

use simgap_mold::{DISPLACEMENT_CHANNEL, Reading};
use simgap_signal::lines::fit_lines;

use super::context::{EXCITATIONS_HZ, FAST_RATE_HZ, samples};
use super::{Cell, Context, ReproduceError, Table};

/// Lines weaker than this are printed as none, m: rounding and the second order of the timing
/// error stay below.
const NO_LINE_M: f64 = 2e-8;

/// Amplitudes (m) of the displacement at 50 − f, 50 + f and f_s/2 − f, fitted together with the
/// harmonics of Table 2.
fn measured_lines(
    context: &Context,
    freq: f64,
    rate: f64,
    reading: Reading,
) -> Result<[Option<f64>; 3], ReproduceError> {
    let rebuilt = context.record(freq, rate, reading)?;
    let base = context.stated.image_base.si();
    let nyquist = 0.5 * rate;
    let mut freqs = vec![base - freq, base + freq, nyquist - freq];
    freqs.retain(|line| *line < nyquist);
    freqs.sort_by(f64::total_cmp);
    freqs.dedup();
    let asked = freqs.clone();
    let plan_lines = rebuilt.plan.lines_hz.iter().copied();
    freqs.extend(plan_lines.filter(|line| !asked.contains(line)));
    freqs.extend(
        [freq]
            .into_iter()
            .filter(|f| !rebuilt.plan.lines_hz.contains(f)),
    );
    let values = samples(&rebuilt, DISPLACEMENT_CHANNEL)?;
    let fit = fit_lines(rebuilt.record.time_s(), &values, &freqs)?;
    let at = |wanted: f64| {
        let at = freqs.iter().position(|line| *line == wanted)?;
        fit.lines.get(at).map(|line| line.amplitude)
    };
    Ok([at(base - freq), at(base + freq), at(nyquist - freq)])
}

/// Whether the two readings look alike at the paper's rate and part at the fast one: line at 50 − f
/// under both; then at 50 − f under one only, and at f_s/2 − f under the other only.
pub(crate) fn part_at_the_fast_rate_only(context: &Context) -> Result<bool, ReproduceError> {
    let there = |line: Option<f64>| line.is_some_and(|line| line > NO_LINE_M);
    for freq in EXCITATIONS_HZ {
        let (timing, support) = (context.timing_reading(), context.support_reading(freq)?);
        let slow = context.sample_rate_hz();
        let alike = there(measured_lines(context, freq, slow, timing)?[0])
            && there(measured_lines(context, freq, slow, support)?[0]);
        let [low, high, image] = measured_lines(context, freq, FAST_RATE_HZ, timing)?.map(there);
        let by_timing = !low && !high && image;
        let [low, high, image] = measured_lines(context, freq, FAST_RATE_HZ, support)?.map(there);
        if !(alike && by_timing && low && high && !image) {
            return Ok(false);
        }
    }
    Ok(true)
}

pub(crate) fn table(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Lines of the rebuilt displacement [µm], by reading and sample rate",
        &[
            "f [Hz]",
            "reading",
            "rate [Hz]",
            "at 50 − f",
            "at 50 + f",
            "at f_s/2 − f",
        ],
    );
    for freq in EXCITATIONS_HZ {
        for (name, reading) in [
            ("timing", context.timing_reading()),
            ("support", context.support_reading(freq)?),
        ] {
            for rate in [context.sample_rate_hz(), FAST_RATE_HZ] {
                let lines = measured_lines(context, freq, rate, reading)?;
                let mut row = vec![
                    Cell::Number(freq, 1),
                    Cell::text(name),
                    Cell::Number(rate, 3),
                ];
                row.extend(lines.into_iter().map(|line| match line {
                    None => Cell::text("above Nyquist"),
                    Some(line) if line < NO_LINE_M => Cell::text("none"),
                    Some(line) => Cell::Number(1e6 * line, 3),
                }));
                table.rows.push(row);
            }
        }
    }
    Ok(table)
}
