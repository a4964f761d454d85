//! Claims on the simulated models, with one mass and with two.

use super::super::context::EXCITATIONS_HZ;
use super::super::number::range;
use super::super::page::print_resolution;
use super::super::sweep::Sweep;
use super::super::table5::MODE_TOLERANCE_HZ;
use super::super::two_masses::models;
use super::super::{Context, ReproduceError, Verdict, figures, machine, significant};
use super::Claim;

pub(super) fn on_one_mass(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let mut least = f64::INFINITY;
    for freq in EXCITATIONS_HZ {
        least = least.min(figures::nominal_error(context, freq)?);
    }
    let (_, with_force) = figures::with_unknown_force(context)?;
    let [sweep_without, sweep_with] = Sweep::new(context)?.errors(context)?;
    let ([low, high], stated) = (machine::cluster(context)?, &context.stated.leaf_modes);
    // "Near" is what prints so.
    let (near, tolerance) = (stated.si(), print_resolution(stated.printed()));
    Ok(vec![
        Claim::judged(
            "without the unknown force the 1-DOF model does not follow the sweep",
            "2.1.1, Fig. 3",
            (least.min(sweep_without) > 0.1, Verdict::WithinTolerance),
            format!(
                "in kind: the error is {} of the standard deviation on the rebuilt sweep, {} or more on the records of one \
                 excitation; the measured sweep is lost ([the sweep](sweep.md))",
                significant(sweep_without, 2),
                significant(least, 2)
            ),
        ),
        Claim::judged(
            "with it, it does",
            "3.1, Fig. 11",
            (
                with_force.max(sweep_with) < figures::ROUNDING,
                Verdict::WithinTolerance,
            ),
            "in kind, to rounding; true by construction for any record and any model, since the force was \
             computed from the same record",
        ),
        Claim::judged(
            format!(
                "the finite element model has many modes near {} Hz",
                stated.printed()
            ),
            "2.2.1, Fig. 9",
            (
                (low - near).abs() < tolerance && (high - near).abs() < tolerance,
                Verdict::WithinTolerance,
            ),
            format!(
                "in kind: the model is not printed; four leaf springs of steel of stated dimensions on the moving mass have theirs at \
                 {} Hz ([the machine](machine.md)); tolerance {tolerance} Hz, half a unit of the last digit printed",
                range(&[low, high], 4)
            ),
        ),
    ])
}

/// How the modes of Table 5 as printed lie, Hz.
struct Modes {
    /// Largest distance of a mode from 50 ∓ f.
    off: f64,
    /// Largest distance of a split from 2f.
    split_off: f64,
    /// Least and largest mean of a pair.
    means: [f64; 2],
    /// Distance of m₁ from 51 Hz or m₂ from 49 Hz at 1 Hz, the other held; the larger.
    held_off: f64,
}

fn printed_modes(context: &Context) -> Result<Modes, ReproduceError> {
    let base = context.stated.image_base.si();
    let mut found = Modes {
        off: 0.0,
        split_off: 0.0,
        means: [f64::INFINITY, 0.0],
        held_off: 0.0,
    };
    for freq in EXCITATIONS_HZ {
        let printed = models(context, freq)?[0];
        let [lower, upper] = printed.modes_hz()?;
        let mean = 0.5 * (lower + upper);
        found.off = found
            .off
            .max((lower - base + freq).abs())
            .max((upper - base - freq).abs());
        found.split_off = found.split_off.max((upper - lower - 2.0 * freq).abs());
        found.means = [found.means[0].min(mean), found.means[1].max(mean)];
        if freq == 1.0 {
            let [mold, support] = printed.held_freqs_hz();
            found.held_off = (mold - base - freq)
                .abs()
                .max((support - base + freq).abs());
        }
    }
    Ok(found)
}

pub(super) fn on_two_masses(context: &Context) -> Result<Vec<Claim>, ReproduceError> {
    let modes = printed_modes(context)?;
    let rows = &context.table5.rows;
    let trend = rows.windows(2).all(|pair| {
        pair[1].leaf_stiffness.si() > pair[0].leaf_stiffness.si()
            && pair[1].support_stiffness.si() < pair[0].support_stiffness.si()
    });
    let stiff = context.table5.mold_stiffness.si() * context.amplitude();
    let soft = context.mold.static_force(context.amplitude());
    Ok(vec![
        Claim::judged(
            "the 2-DOF model has modes at 50 ∓ f",
            "3.2, Table 5",
            (modes.off < MODE_TOLERANCE_HZ, Verdict::WithinTolerance),
            format!(
                "as printed up to {} Hz off; the mean of the modes is {} to {} Hz. Restored stiffnesses do it \
                 ([Table 5](table5.md))",
                significant(modes.off, 3),
                significant(modes.means[0], 3),
                significant(modes.means[1], 3)
            ),
        ),
        Claim::judged(
            "the modes are 2f apart",
            "3.2, Table 5",
            (
                modes.split_off < MODE_TOLERANCE_HZ,
                Verdict::WithinTolerance,
            ),
            format!(
                "up to {} Hz off. Tolerance {MODE_TOLERANCE_HZ} Hz, half a unit of the last digit printed",
                significant(modes.split_off, 2)
            ),
        ),
        Claim::judged(
            "m₁ is given 51 Hz and m₂ 49 Hz at 1 Hz",
            "2.2.3",
            (modes.held_off < MODE_TOLERANCE_HZ, Verdict::WithinTolerance),
            format!(
                "one is {} Hz off, the other mass held",
                significant(modes.held_off, 2)
            ),
        ),
        Claim::judged(
            "k_leaf rises and k₂ falls with the excitation",
            "2.2.3, Table 5",
            (trend, Verdict::Reproduced),
            "in the printed set, and in the restored one",
        ),
        Claim::judged(
            "the 2-DOF model needs much more force than was measured",
            "3.2",
            (stiff > 100.0 * soft, Verdict::Reproduced),
            format!(
                "for {} mm k₁ takes {} MN, K {} kN",
                context.stated.amplitude.printed(),
                significant(1e-6 * stiff, 2),
                significant(1e-3 * soft, 3)
            ),
        ),
    ])
}
