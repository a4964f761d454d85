//! The two readings of the lines at 50 − f, side by side.

use simgap_mold::{DISPLACEMENT_CHANNEL, Reading, published_line_amplitude};
use simgap_report::chart::{LineChart, Role, Scale, Series};
use simgap_signal::lines::fit_lines;

use super::context::{EXCITATIONS_HZ, FAST_RATE_HZ, samples};
use super::spectra::channel_spectrum;
use super::table4::beat_of;
use super::table5::{models, one_dof_force};
use super::{Block, Cell, Context, Page, ReproduceError, Table, significant};

/// Lines weaker than this are printed as none, m: rounding and the second order of the timing
/// error stay below.
const NO_LINE_M: f64 = 2e-8;

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let mut blocks = vec![
        Block::Text(format!(
            "The displacement, sampled at 100 Hz, has a line at 50 − f. Two readings:\n\n\
             1. **Alternating timing.** Every other sample of the displacement is taken τ = {} ms late, the others as \
             early: y_n = y(nh + (−1)ⁿτ). The record gains (−1)ⁿ τ ẏ, a line at exactly f_s/2 − f of amplitude 2πf A τ. Nothing in \
             the machine vibrates at 50 Hz.\n\
             2. **Flexible support.** The mold itself vibrates at 50 − f and 50 + f; Eq. (4) is to have these modes, \
             for each f anew.",
            significant(1e3 * context.timing.value, 3)
        )),
        Block::Table(amplitudes(context)?),
        Block::Text(
            "**What it costs.** One number gives all six F0 within 6.3 %. The flexible support needs one amplitude \
             for each F0 (it fits by construction: no row is left to test it), and the twelve stiffnesses of Table 5 for \
             twelve modes. As printed they miss the modes by up to 1.8 Hz; restored they hit them, again by \
             construction. A machine whose two modes follow the excitation so that they stay symmetric about half the \
             sample rate of the instrument would be a remarkable machine."
                .to_owned(),
        ),
        Block::Table(cost(context)?),
        Block::Table(predictions(context)?),
        Block::Text(
            "**Which experiment decides.** At 100 Hz both readings give the same line at 50 − f, and so does a \
             50 Hz carrier modulated by the mold's velocity (pick-up of the mains in the sensor; the same formula as the support's \
             two lines): *the published \
             data cannot decide*. Sampled at 500 Hz (250 Hz would do), the line moves to 250 − f if the sampling makes it, and stays, \
             as a pair at 50 ∓ f, if the mold or a carrier does. A second sensor on its own converter, or a shift of the \
             sample rate by 1 Hz, decides as well.\n\n\
             **What the lost records might have said at 100 Hz.** Alternating timing, or a carrier modulated by the velocity, images \
             *every* harmonic, to 50 − n f; two modes at 50 ∓ f do not (picture below, harmonics at their assumed height). Table 2 prints \
             harmonics of the displacement and one high line only. That speaks against the timing unless the harmonics were low: \
             an image is 2πnfτ of its harmonic, 0.4 % at n f = 1 Hz and 7 % at 18 Hz. No heights are printed, so it does not decide."
                .to_owned(),
        ),
    ];
    blocks.extend(pictures(context)?);
    Ok(Page {
        stem: "readings",
        title: "Two readings of the lines at 50 − f".to_owned(),
        summary:
            "alternating sample timing against a flexible support: cost, predictions, experiment"
                .to_owned(),
        blocks,
    })
}

fn amplitudes(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "F0 of Table 4 under both readings, from rebuilt records at 100 Hz",
        &[
            "f [Hz]",
            "F0 published [N]",
            "timing, one τ [N]",
            "off",
            "line of y, timing [µm]",
            "support, F0 per row [N]",
            "line of y, support [µm]",
        ],
    );
    for row in &context.table4.rows {
        let (freq, published) = (row.excitation.si(), row.amplitude.si());
        let timing = beat_of(context, freq, context.timing_reading())?
            .parameters
            .amplitude;
        let support = beat_of(context, freq, context.support_reading(freq)?)?
            .parameters
            .amplitude;
        let omega = std::f64::consts::TAU * freq;
        let line = omega * context.amplitude() * context.timing.value;
        table.rows.push(vec![
            Cell::text(row.excitation.printed()),
            Cell::text(row.amplitude.printed()),
            Cell::Number(timing, 5),
            Cell::text(format!("{:+.1} %", 1e2 * (timing / published - 1.0))),
            Cell::Number(1e6 * line, 3),
            Cell::Number(support, 5),
            Cell::Number(1e6 * published_line_amplitude(freq)?, 3),
        ]);
    }
    Ok(table)
}

fn cost(context: &Context) -> Result<Table, ReproduceError> {
    let mut worst_mode = 0.0_f64;
    let mut ratio = [f64::INFINITY, 0.0];
    for freq in EXCITATIONS_HZ {
        let printed = models(context, freq)?[0];
        let base = context.stated.image_base.si();
        let [lower, upper] = printed.modes_hz()?;
        worst_mode = worst_mode
            .max((lower - base + freq).abs())
            .max((upper - base - freq).abs());
        let force = printed.force_amplitude(context.amplitude(), freq)?;
        let times = force / one_dof_force(context, freq)?;
        ratio = [ratio[0].min(times), ratio[1].max(times)];
    }
    let mut table = Table::new(
        "Cost of the two readings",
        &["", "alternating timing", "flexible support"],
    );
    let mut row = |what: &str, timing: String, support: String| {
        table.rows.push(vec![
            Cell::text(what),
            Cell::text(timing),
            Cell::text(support),
        ]);
    };
    row(
        "numbers for the six F0",
        "1 (τ)".into(),
        "6 (one each)".into(),
    );
    row(
        "numbers for the frequencies",
        "0 (f_s/2 − f)".into(),
        "12 (Table 5)".into(),
    );
    row(
        "worst F0",
        format!(
            "{} % off",
            significant(1e2 * context.timing.worst_relative_error, 2)
        ),
        "fitted".into(),
    );
    row(
        "worst frequency",
        "exact".into(),
        format!("{} Hz off as printed", significant(worst_mode, 3)),
    );
    row(
        "force for 2 mm, over that of the 1-DOF model",
        "1".into(),
        format!(
            "{} to {}",
            significant(ratio[0], 3),
            significant(ratio[1], 3)
        ),
    );
    row("line in the pressure", "none".into(), "none".into());
    Ok(table)
}

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

fn predictions(context: &Context) -> Result<Table, ReproduceError> {
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

fn pictures(context: &Context) -> Result<Vec<Block>, ReproduceError> {
    let freq = 3.0;
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
        let caption = if rate == FAST_RATE_HZ {
            "At 500 Hz: 247 Hz if the sampling makes the line, 47 and 53 Hz if the mold does"
        } else {
            "At 100 Hz: one line at 47 Hz under both readings"
        };
        blocks.push(Block::Figure(stem, caption.to_owned(), chart));
    }
    Ok(blocks)
}
