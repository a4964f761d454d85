//! Table 5 and Fig. 13 to 16: the two-mass model.

use simgap_mold::DISPLACEMENT_CHANNEL;
use simgap_report::chart::{LineChart, Mark, Role, Scale, Series};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};
use simgap_tables::PrintedValue;

use super::context::{EXCITATIONS_HZ, FAST_RATE_HZ, samples};
use super::number::range;
use super::peaks::{MotionLines, two_mass_lines};
use super::simulated::TwoMassMotion;
use super::spectra::symmetric_range;
use super::two_masses::{RATE_HZ, models, motion_of};
use super::{Block, Cell, Comparison, Context, Page, ReproduceError, Table, significant};

/// Tolerance of a mode and of the split, Hz: half a unit of the last digit printed.
pub(crate) const MODE_TOLERANCE_HZ: f64 = 0.5;

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let mut blocks = vec![
        Block::Text(format!(
            "Eq. (4) with m₁ = {} t, m₂ = {} t, k₁ of Table 5 for all rows, and k_leaf and k₂ per row. k₃ of \
             Eq. (4) and k₂ of Table 5 are the same spring; y and x name the same coordinates. **No damping \
             is printed for this model, none is assumed** ([the library](../../crates/mold/README.md) takes any). The modes \
             should be 50 − f and 50 + f. Tolerance: {MODE_TOLERANCE_HZ} Hz, half a unit of the last digit printed.",
            context.stated.mold_mass.printed(),
            context.stated.support_mass.printed(),
        )),
        Block::Table(Table::comparisons("Section 3.2: modes of the printed model", &modes(context)?)),
        Block::Text(modes_text(context)?),
        Block::Table(held(context)?),
        Block::Table(restored(context)?),
        Block::Text(
            "**Restored** is a second set, ours: the same masses and k₁, with k_leaf and k₂ solved so \
             that the modes are 50 ∓ f exactly. There is one such pair with positive springs in each \
             row. It has the trend the text describes, k_leaf rising and k₂ falling with f, as the printed \
             set has."
                .to_owned(),
        ),
        Block::Table(force(context)?),
        Block::Text(force_text(context)),
    ];
    for (stem, number, freq) in [("fig13", "13", 1.0), ("fig14", "14", 6.0)] {
        blocks.push(motion_figure(context, stem, number, freq)?);
    }
    blocks.push(Block::Text(
        "The caption of Fig. 14 says 2 Hz, the text 6 Hz; 6 Hz is used here.".to_owned(),
    ));
    blocks.push(spectrum_figure(context)?);
    blocks.push(lines_figure(context)?);
    blocks.push(sum_figure(context)?);
    Ok(Page {
        stem: "table5",
        title: "Table 5: the two-mass model".to_owned(),
        summary: "modes of the printed and of a restored set, and the force the model needs"
            .to_owned(),
        blocks,
    })
}

fn modes(context: &Context) -> Result<Vec<Comparison>, ReproduceError> {
    let mut rows = Vec::new();
    for (stated, beat) in context.stated.lines.iter().zip(&context.table4.rows) {
        let freq = stated.excitation_hz;
        let [lower, upper] = models(context, freq)?[0].modes_hz()?;
        let mut row = |item: &str, printed: &PrintedValue, ours: f64| {
            rows.push(Comparison {
                item: format!("{item} at {freq} Hz"),
                unit: "Hz",
                printed: printed.printed().to_owned(),
                published: printed.si(),
                // Three decimals: enough to tell the modes apart.
                ours: (1e3 * ours).round() * 1e-3,
                tolerance: MODE_TOLERANCE_HZ,
            });
        };
        row("lower mode", &stated.lower, lower);
        row("upper mode", &stated.upper, upper);
        row("split (δ of Table 4)", &beat.split, upper - lower);
    }
    Ok(rows)
}

/// How the modes as printed lie.
fn modes_text(context: &Context) -> Result<String, ReproduceError> {
    let (mut means, mut low, mut high, mut splits) = (vec![], vec![], vec![], vec![]);
    for stated in &context.stated.lines {
        let [lower, upper] = models(context, stated.excitation_hz)?[0].modes_hz()?;
        means.push(0.5 * (lower + upper));
        low.push(lower - stated.lower.si());
        high.push(upper - stated.upper.si());
        splits.push(upper - lower - stated.upper.si() + stated.lower.si());
    }
    let [mold, support] = models(context, EXCITATIONS_HZ[0])?[0].held_freqs_hz();
    let later = splits[1..]
        .iter()
        .fold(0.0_f64, |most, s| most.max(s.abs()));
    Ok(format!(
        "The split of the modes is 2f within {} Hz from {} Hz on, and {} Hz too wide at {} Hz. Their mean is {} Hz and not \
         {}: lower modes are {} Hz too high, upper ones {} Hz. Nor has either mass the frequency that section 2.2.3 gives it \
         with the other one held: at {} Hz m₁ has {} Hz and m₂ {} Hz, against {} and {} Hz.",
        significant(later, 1),
        EXCITATIONS_HZ[1],
        significant(splits[0], 2),
        EXCITATIONS_HZ[0],
        range(&means, 3),
        context.stated.image_base.printed(),
        range(&low, 2),
        range(&high, 2),
        EXCITATIONS_HZ[0],
        significant(mold, 4),
        significant(support, 4),
        context.stated.lines[0].upper.printed(),
        context.stated.lines[0].lower.printed(),
    ))
}

fn force_text(context: &Context) -> String {
    let stiff = context.table5.mold_stiffness.si();
    let soft = context.mold.stiffness();
    let amplitude = context.amplitude();
    format!(
        "**Force.** The paper says that the 2-DOF model needs far more force than was measured. \
         It follows from k₁ alone: k₁ · {} mm = {} MN, against K · {} mm = {} kN in the 1-DOF model, \
         {} times as much. The dynamic force at the excitation is as far off. k₁ = {} N/m is what puts \
         a mass of {} t near 50 Hz; it also makes the mold {} times as stiff as Table 1 says it is. What k₁ may be: \
         [the machine](machine.md).",
        context.stated.amplitude.printed(),
        significant(1e-6 * stiff * amplitude, 2),
        context.stated.amplitude.printed(),
        significant(1e-3 * soft * amplitude, 3),
        significant(stiff / soft, 3),
        context.table5.mold_stiffness.printed(),
        context.stated.mold_mass.printed(),
        significant(stiff / soft, 3),
    )
}

fn held(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Mean of the modes, and each mass with the other held",
        &[
            "f [Hz]",
            "mean of the modes [Hz]",
            "m₁ alone [Hz]",
            "m₂ alone [Hz]",
        ],
    );
    for freq in EXCITATIONS_HZ {
        let model = models(context, freq)?[0];
        let [lower, upper] = model.modes_hz()?;
        let [mold, support] = model.held_freqs_hz();
        table.rows.push(vec![
            Cell::Number(freq, 1),
            Cell::Number(0.5 * (lower + upper), 4),
            Cell::Number(mold, 4),
            Cell::Number(support, 4),
        ]);
    }
    Ok(table)
}

fn restored(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Restored stiffnesses (modes exactly 50 ∓ f), beside the printed ones",
        &[
            "f [Hz]",
            "k_leaf printed [N/m]",
            "k_leaf restored [N/m]",
            "k₂ printed [N/m]",
            "k₂ restored [N/m]",
            "lower mode [Hz]",
            "upper mode [Hz]",
        ],
    );
    for (freq, row) in EXCITATIONS_HZ.into_iter().zip(&context.table5.rows) {
        let model = models(context, freq)?[1];
        let [lower, upper] = model.modes_hz()?;
        table.rows.push(vec![
            Cell::Number(freq, 1),
            Cell::text(row.leaf_stiffness.printed()),
            Cell::Number(model.leaf_stiffness(), 6),
            Cell::text(row.support_stiffness.printed()),
            Cell::Number(model.support_stiffness(), 6),
            Cell::Number(lower, 5),
            Cell::Number(upper, 5),
        ]);
    }
    Ok(table)
}

/// Amplitude of the force for 2 mm in the 1-DOF model: |k − mω² + iωc| A.
pub(crate) fn one_dof_force(context: &Context, freq_hz: f64) -> Result<f64, ReproduceError> {
    let exact = simgap_alpha::RateFormula::Exact;
    let gain = simgap_alpha::force_gain(&context.plant, exact, freq_hz, context.time_step_s())?;
    Ok(gain.norm() * context.amplitude())
}

fn force(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Force for the amplitude of the sweep",
        &[
            "case",
            "1-DOF [kN]",
            "2-DOF printed [kN]",
            "2-DOF restored [kN]",
            "printed / 1-DOF",
        ],
    );
    let amplitude = context.amplitude();
    let mut row = |case: String, one: f64, two: [f64; 2]| {
        table.rows.push(vec![
            Cell::text(case),
            Cell::Number(1e-3 * one, 4),
            Cell::Number(1e-3 * two[0], 5),
            Cell::Number(1e-3 * two[1], 5),
            Cell::Number(two[0] / one, 3),
        ]);
    };
    let k1 = context.table5.mold_stiffness.si() * amplitude;
    row(
        "k₁ against K, static".to_owned(),
        context.mold.static_force(amplitude),
        [k1, k1],
    );
    for freq in EXCITATIONS_HZ {
        let [printed, restored] = models(context, freq)?;
        let two = [
            printed.force_amplitude(amplitude, freq)?,
            restored.force_amplitude(amplitude, freq)?,
        ];
        row(
            format!("moving at {freq} Hz"),
            one_dof_force(context, freq)?,
            two,
        );
    }
    Ok(table)
}

fn motion(context: &Context, freq: f64, set: usize) -> Result<TwoMassMotion, ReproduceError> {
    motion_of(context, &models(context, freq)?[set], freq)
}

fn millimetres(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| 1e3 * value).collect()
}

fn motion_figure(
    context: &Context,
    stem: &'static str,
    number: &str,
    freq: f64,
) -> Result<Block, ReproduceError> {
    let motion = motion(context, freq, 1)?;
    let rebuilt = context.record(freq, FAST_RATE_HZ, context.support_reading(freq)?)?;
    let shown = 0..(FAST_RATE_HZ / freq) as usize + 1;
    let time = motion.time_s[shown.clone()].to_vec();
    let record = millimetres(&samples(&rebuilt, DISPLACEMENT_CHANNEL)?[shown.clone()]);
    let chart = LineChart::new(
        format!("Two-mass model at {freq} Hz"),
        "time [s]",
        "displacement [mm]",
    )
    .with(Series::new(
        "rebuilt record, flexible support",
        Role::Measured,
        time.clone(),
        record,
    ))
    .with(
        Series::new(
            "m₁",
            Role::Corrected,
            time.clone(),
            millimetres(&motion.mold[shown.clone()]),
        )
        .dashed(),
    )
    .with(Series::new(
        "m₂",
        Role::Nominal,
        time,
        millimetres(&motion.support[shown]),
    ));
    Ok(Block::Figure(
        stem,
        format!(
            "Fig. {number} in kind: restored two-mass model from rest under a sine force of {:.1} MN, and the \
             rebuilt record at {freq} Hz",
            1e-6 * motion.force_amplitude
        ),
        chart,
    ))
}

fn spectrum_figure(context: &Context) -> Result<Block, ReproduceError> {
    let line = |set: usize| -> Result<(Vec<f64>, Vec<f64>), ReproduceError> {
        let motion = motion(context, EXCITATIONS_HZ[0], set)?;
        let found = spectrum(&motion.mold, RATE_HZ, Window::BlackmanHarris, Trend::Mean)?;
        let to = found.nearest_bin(60.0);
        // A floor well above rounding and below every line.
        let amplitude = found.amplitude[..to]
            .iter()
            .map(|a| 1e3 * a.max(1e-9))
            .collect();
        Ok((found.freq_hz[..to].to_vec(), amplitude))
    };
    let (freq, printed) = line(0)?;
    let (freq_restored, restored) = line(1)?;
    let mut chart = LineChart::new(
        "Spectrum of m₁ from rest at 1 Hz",
        "frequency [Hz]",
        "amplitude [mm]",
    )
    .with(Series::new(
        "printed stiffnesses",
        Role::Nominal,
        freq,
        printed,
    ))
    .with(Series::new(
        "restored stiffnesses",
        Role::Corrected,
        freq_restored,
        restored,
    ));
    chart.y_scale = Scale::Log;
    let mut modes = vec![];
    for model in models(context, EXCITATIONS_HZ[0])? {
        modes.push(model.modes_hz()?.map(|mode| significant(mode, 4)));
    }
    let caption = format!(
        "Fig. 15 in kind: the undamped model rings at its two modes, {} and {} Hz as printed, {} and {} Hz as restored",
        modes[0][0], modes[0][1], modes[1][0], modes[1][1]
    );
    Ok(Block::Figure("fig15", caption, chart))
}

/// Fig. 15 for all six rows: the lines stated, those of the model as printed, those of the restored one.
fn lines_figure(context: &Context) -> Result<Block, ReproduceError> {
    let sets = [two_mass_lines(context, 0)?, two_mass_lines(context, 1)?];
    let mut chart = LineChart::new("Lines of m₁ from rest", "excitation [Hz]", "line [Hz]");
    let points = |set: &[MotionLines]| -> (Vec<f64>, Vec<f64>) {
        let mut points = vec![];
        for found in set {
            points.extend(found.pair().map(|line| (found.excitation_hz, line)));
        }
        points.into_iter().unzip()
    };
    let stated = &context.stated.lines;
    for (name, line) in [("50 − f and 50 + f, as stated", 0), ("", 1)] {
        let (x, y): (Vec<f64>, Vec<f64>) = stated
            .iter()
            .map(|row| (row.excitation_hz, [row.lower.si(), row.upper.si()][line]))
            .unzip();
        chart = chart.with(Series::new(name, Role::Measured, x, y));
    }
    for (name, role, set) in [
        ("printed stiffnesses", Role::Nominal, &sets[0]),
        ("restored stiffnesses", Role::Corrected, &sets[1]),
    ] {
        let (x, y) = points(set);
        chart = chart.with(Series::new(name, role, x, y).with_mark(Mark::Points));
    }
    (chart.x_range, chart.y_range) = (Some([0.5, 6.5]), Some([43.0, 58.0]));
    let caption = "Fig. 15 in kind, all six rows: lines of the simulated motion of m₁, beside those that section 3.2 \
                   states";
    Ok(Block::Figure("fig15-rows", caption.to_owned(), chart))
}

fn sum_figure(context: &Context) -> Result<Block, ReproduceError> {
    let motion = motion(context, 1.0, 1)?;
    let shown = 0..501;
    let time = motion.time_s[shown.clone()].to_vec();
    let omega = std::f64::consts::TAU;
    let global: Vec<f64> = time
        .iter()
        .map(|t| 1e3 * context.amplitude() * (omega * t).sin())
        .collect();
    let local: Vec<f64> = motion.mold[shown]
        .iter()
        .zip(&global)
        .map(|(y, x)| 1e3 * (1e3 * y - x))
        .collect();
    let mut chart = LineChart::new("Local vibration at 1 Hz", "time [s]", "displacement [µm]");
    chart.y_range = Some(symmetric_range(&local));
    chart = chart.with(Series::new(
        "m₁ less the sine of the sweep",
        Role::Corrected,
        time,
        local,
    ));
    Ok(Block::Figure(
        "fig16",
        format!(
            "Fig. 16 in kind: the local vibration of m₁, what is left when the global one ({} mm at {} Hz) is taken \
             out. The restored model from rest",
            context.stated.amplitude.printed(),
            EXCITATIONS_HZ[0]
        ),
        chart,
    ))
}
