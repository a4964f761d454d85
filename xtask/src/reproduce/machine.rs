//! What the printed numbers say about the machine: shut oil, leaf springs as beams, heave and roll.

use simgap_mold::{BeamEnds, HeaveRoll, LeafSpring, LockedCylinder, MoldOnLeaves};
use simgap_report::chart::{LineChart, Mark, Role, Series};

use super::frame::{LEAF_COUNT, LEAVES_M, span_ratio};
use super::number::range;
use super::servo::Servo;
use super::{Block, Cell, Context, Page, ReproduceError, Table, significant};

/// **Assumed**: piston area of a cylinder, m², and its length of oil, both sides together, m.
pub(crate) const CYLINDER: [f64; 2] = [0.02, 0.08];

/// Bulk moduli of oil, Pa: with air in it, and without (`merritt1967`).
const BULK_MODULI_PA: [f64; 4] = [0.7e9, 1.0e9, 1.4e9, 1.7e9];

/// Bulk modulus of mineral oil without air, Pa (`merritt1967`).
pub(crate) const BULK_MODULUS_OF_OIL_PA: [f64; 2] = [1.4e9, 1.7e9];

/// Damping ratios of the heave for the roll, 1: that of Table 1, and less.
pub(crate) const DAMPING_SHARES: [f64; 3] = [1.0, 0.2, 0.05];

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let servo = Servo::new(context)?;
    Ok(Page {
        stem: "machine",
        title: "The machine behind the numbers".to_owned(),
        summary: "k₁ as shut oil, K as servo; Fig. 8 and 9 with leaf springs as beams; 5 Hz as heave and roll".to_owned(),
        blocks: vec![
            Block::Text(
                "The paper describes two cylinders, four leaf springs and a torsional mode, and prints no dimension of them. \
                 Here each is computed for dimensions that are **stated and assumed**, with the models of \
                 [`simgap-mold`](../../crates/mold/README.md): what the printed numbers would take."
                    .to_owned(),
            ),
            Block::Text(oil_text(context)?),
            Block::Table(oil_table(context)?),
            Block::Text(servo.text()),
            Block::Table(servo.table(context)?),
            Block::Text(leaf_text(context)?),
            Block::Table(leaf_table(context)?),
            leaf_figure(context)?,
            Block::Text(roll_text(context)?),
            Block::Table(roll_table(context)?),
        ],
    })
}

/// Stiffness of the oil of both cylinders, ports shut, N/m.
fn oil_stiffness(bulk_modulus_pa: f64) -> Result<f64, ReproduceError> {
    let cylinder = LockedCylinder::centred(CYLINDER[0], CYLINDER[1])?;
    Ok(2.0 * cylinder.stiffness(bulk_modulus_pa)?)
}

/// Frequency of the moving mass on a stiffness, Hz.
fn freq_on(context: &Context, stiffness: f64) -> f64 {
    (stiffness / context.mold.mass_kg()).sqrt() / std::f64::consts::TAU
}

fn oil_text(context: &Context) -> Result<String, ReproduceError> {
    let printed = context.table5.mold_stiffness.si();
    let pure = oil_stiffness(BULK_MODULI_PA[2])?;
    Ok(format!(
        "**k₁ = {} N/m is the size of shut oil.** With the valve shut, two cylinders of {} m² with {} mm of oil at {} GPa have \
         {} GN/m, {} Hz on {} t; k₁ would take {} GPa. K of Table 1 is {} times as soft: Eq. (1) and \
         Eq. (4) give one machine two stiffnesses.",
        context.table5.mold_stiffness.printed(),
        CYLINDER[0],
        significant(1e3 * CYLINDER[1], 2),
        significant(1e-9 * BULK_MODULI_PA[2], 2),
        significant(1e-9 * pure, 2),
        significant(freq_on(context, pure), 3),
        context.table1.mass.printed(),
        significant(1e-9 * bulk_modulus_of_k1(context)?, 3),
        significant(printed / context.mold.stiffness(), 3),
    ))
}

/// The bulk modulus that makes k₁ of Table 5 of the cylinders assumed, Pa.
pub(crate) fn bulk_modulus_of_k1(context: &Context) -> Result<f64, ReproduceError> {
    Ok(context.table5.mold_stiffness.si() / oil_stiffness(1.0)?)
}

fn oil_table(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Shut oil of two cylinders",
        &[
            "bulk modulus [GPa]",
            "stiffness [GN/m]",
            "over k₁",
            "frequency of the moving mass [Hz]",
        ],
    );
    for modulus in BULK_MODULI_PA {
        let stiffness = oil_stiffness(modulus)?;
        table.rows.push(vec![
            Cell::Number(1e-9 * modulus, 2),
            Cell::Number(1e-9 * stiffness, 3),
            Cell::Number(stiffness / context.table5.mold_stiffness.si(), 3),
            Cell::Number(freq_on(context, stiffness), 4),
        ]);
    }
    Ok(table)
}

fn leaf([length, width, thickness]: [f64; 3]) -> Result<LeafSpring, ReproduceError> {
    Ok(LeafSpring::steel(length, width, thickness)?)
}

/// Natural frequencies of the mold on four equal leaf springs beside a stiffness, Hz.
fn machine_freqs(
    context: &Context,
    dimensions: [f64; 3],
    stiffness: f64,
) -> Result<Vec<f64>, ReproduceError> {
    let leaves = vec![leaf(dimensions)?; LEAF_COUNT];
    Ok(MoldOnLeaves::new(context.mold.mass_kg(), stiffness, leaves)?.natural_freqs_hz()?)
}

/// Least and largest of the cluster's frequencies: the first mode of each leaf spring.
pub(crate) fn cluster(context: &Context) -> Result<[f64; 2], ReproduceError> {
    let mut ends = [f64::INFINITY, 0.0_f64];
    for dimensions in LEAVES_M {
        let freqs = machine_freqs(context, dimensions, context.mold.stiffness())?;
        for freq in &freqs[1..=LEAF_COUNT] {
            ends = [ends[0].min(*freq), ends[1].max(*freq)];
        }
    }
    Ok(ends)
}

/// The thickness tolerance, relative, either way, that spreads the first modes over the high lines of Table 2.
fn tolerance(context: &Context) -> ([f64; 2], f64) {
    let rows = context.table2.rows.iter();
    let lines: Vec<f64> = rows
        .filter_map(|row| Some(row.displacement_high.as_ref()?.si()))
        .collect();
    let low = lines.iter().copied().fold(f64::INFINITY, f64::min);
    let high = lines.iter().copied().fold(0.0, f64::max);
    // The frequency is proportional to the thickness.
    ([low, high], (high - low) / (high + low))
}

fn leaf_text(context: &Context) -> Result<String, ReproduceError> {
    let first = |dimensions| -> Result<String, ReproduceError> {
        Ok(significant(
            leaf(dimensions)?.natural_freq_hz(BeamEnds::Clamped, 1)?,
            3,
        ))
    };
    let [low, high] = cluster(context)?;
    let ([from, to], share) = tolerance(context);
    let soft = LEAF_COUNT as f64 * leaf(LEAVES_M[0])?.guided_stiffness();
    Ok(format!(
        "**Fig. 8 and 9: leaf springs are beams, and beams of one make cluster.** A clamped leaf spring of steel has its first mode at {} Hz \
         when it is {} mm thick and {} m long, or at {} Hz with {} mm and {} m. Four of them (Euler-Bernoulli elements, condensed) on the \
         moving mass give one mode each: {} Hz, where the paper has many near {} Hz, and the next group {} times as high. The \
         moving mass hardly changes them, and they hardly change its stiffness ({} kN/m of {} kN/m). A tolerance of \
         thickness of ± {} % spreads such a cluster over {} to {} Hz, where Table 2 has its high lines. But these are frequencies of \
         the machine, which stay when f changes: that seven excitations should each find the leaf spring that lies at 50 − f \
         is not in this model.",
        first(LEAVES_M[0])?,
        significant(1e3 * LEAVES_M[0][2], 2),
        LEAVES_M[0][0],
        first(LEAVES_M[1])?,
        significant(1e3 * LEAVES_M[1][2], 2),
        LEAVES_M[1][0],
        range(&[low, high], 4),
        context.stated.leaf_modes.printed(),
        significant(
            leaf(LEAVES_M[0])?.natural_freq_hz(BeamEnds::Clamped, 2)?
                / leaf(LEAVES_M[0])?.natural_freq_hz(BeamEnds::Clamped, 1)?,
            2
        ),
        significant(1e-3 * soft, 3),
        significant(1e-3 * context.mold.stiffness(), 4),
        significant(1e2 * share, 2),
        from,
        to,
    ))
}

fn leaf_table(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Fig. 9 in kind: natural frequencies of the moving mass on four leaf springs",
        &[
            "leaf spring",
            "beside",
            "heave [Hz]",
            "first group [Hz]",
            "second group [Hz]",
        ],
    );
    for dimensions in LEAVES_M {
        for (name, stiffness) in [
            ("servo, K of Table 1", context.mold.stiffness()),
            (
                "shut oil, k₁ of Table 5",
                context.table5.mold_stiffness.si(),
            ),
        ] {
            let freqs = machine_freqs(context, dimensions, stiffness)?;
            // The heave is the one farthest from the clamped modes.
            let clamped = leaf(dimensions)?.natural_freq_hz(BeamEnds::Clamped, 1)?;
            let first_group = &freqs[..=LEAF_COUNT];
            let heave = first_group
                .iter()
                .copied()
                .max_by(|a, b| (a - clamped).abs().total_cmp(&(b - clamped).abs()))
                .unwrap_or(f64::NAN);
            let rest: Vec<f64> = first_group
                .iter()
                .copied()
                .filter(|f| *f != heave)
                .collect();
            table.rows.push(vec![
                Cell::text(format!(
                    "{} mm × {} mm × {} m",
                    significant(1e3 * dimensions[2], 2),
                    significant(1e3 * dimensions[1], 3),
                    dimensions[0]
                )),
                Cell::text(name),
                Cell::Number(heave, 4),
                Cell::text(range(&rest, 4)),
                Cell::text(range(&freqs[LEAF_COUNT + 1..=2 * LEAF_COUNT], 4)),
            ]);
        }
    }
    Ok(table)
}

fn leaf_figure(context: &Context) -> Result<Block, ReproduceError> {
    let mut chart = LineChart::new("Natural frequencies", "mode", "frequency [Hz]");
    let (_, share) = tolerance(context);
    let spread: Vec<LeafSpring> = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0]
        .into_iter()
        .map(|part| {
            let [length, width, thickness] = LEAVES_M[0];
            leaf([length, width, thickness * (1.0 + part * share)])
        })
        .collect::<Result<_, _>>()?;
    let equal = machine_freqs(context, LEAVES_M[0], context.mold.stiffness())?;
    let uneven = MoldOnLeaves::new(context.mold.mass_kg(), context.mold.stiffness(), spread)?;
    for (name, role, freqs) in [
        ("four equal leaf springs", Role::Nominal, equal),
        (
            "thickness within the tolerance",
            Role::Corrected,
            uneven.natural_freqs_hz()?,
        ),
    ] {
        let shown = freqs[..9].to_vec();
        let number = (1..=shown.len()).map(|n| n as f64).collect::<Vec<_>>();
        chart = chart.with(Series::new(name, role, number, shown).with_mark(Mark::Points));
    }
    (chart.x_range, chart.y_range) = (Some([0.0, 10.0]), Some([0.0, 150.0]));
    Ok(Block::Figure(
        "fig09",
        format!(
            "Fig. 9 in kind: natural frequencies of the moving mass on four leaf springs of steel, {} mm thick and {} m long (assumed)",
            significant(1e3 * LEAVES_M[0][2], 2),
            LEAVES_M[0][0]
        ),
        chart,
    ))
}

/// What mismatch of the cylinders makes the jump of Table 3, and the peak to peak (N) that it makes at the excitations
/// before, at and after.
pub(crate) struct Jump {
    pub(crate) roll_damping_ratio: f64,
    pub(crate) mismatch: f64,
    pub(crate) strokes: [f64; 3],
}

impl Jump {
    /// Whether it is a mismatch that two cylinders can have, and the rows beside keep what is printed of them.
    pub(crate) fn fits(&self, printed: [f64; 3]) -> bool {
        self.mismatch <= 1.0 && self.strokes[0] <= printed[0] && self.strokes[2] <= printed[2]
    }
}

/// Printed peak to peak at 4, 5 and 6 Hz, N.
pub(crate) fn printed_strokes(context: &Context) -> [f64; 3] {
    let rows = &context.table3.rows;
    [3, 4, 5].map(|at| rows[at].peak_to_peak.si())
}

/// The jump for each damping.
pub(crate) fn jumps(context: &Context) -> Result<Vec<Jump>, ReproduceError> {
    let mold = &context.mold;
    let mut found = vec![];
    for share in DAMPING_SHARES {
        let total = [mold.stiffness(), share * mold.damping()];
        let even = HeaveRoll::symmetric(mold.mass_kg(), 1.0, total, span_ratio(context))?;
        // The unknown force grows with the square of the mismatch.
        let whole = even.with_mismatch(1.0)?;
        let rows = &context.table3.rows;
        let stroke = |at: usize| -> Result<f64, ReproduceError> {
            let per_heave = whole
                .unknown_force_per_heave(rows[at].excitation.si())?
                .norm();
            Ok(2.0 * context.amplitude() * per_heave)
        };
        let [before, at, after] = [stroke(3)?, stroke(4)?, stroke(5)?];
        let squared = rows[4].peak_to_peak.si() / at;
        found.push(Jump {
            roll_damping_ratio: even.roll_damping_ratio(),
            mismatch: squared.sqrt(),
            strokes: [squared * before, squared * at, squared * after],
        });
    }
    Ok(found)
}

fn roll_text(context: &Context) -> Result<String, ReproduceError> {
    let rows = &context.table3.rows;
    let found = jumps(context)?;
    let printed = printed_strokes(context);
    let tenth = 0.1 * printed[1];
    let fits = found.iter().any(|jump| jump.fits(printed));
    Ok(format!(
        "**{} Hz as a roll on two cylinders.** With equal cylinders at ± b and the radius of gyration r_g the roll lies at f_heave b/r_g: \
         {} Hz takes b/r_g = {}. Equal cylinders leave the heave alone; a mismatch of the two (left stiffer by a share, \
         right softer) couples them, and the unknown force that the 1-DOF model then lacks grows with the square of the \
         mismatch. The jump of Table 3 takes a mismatch of {} % with the damping of Table 1, {} % where the roll is hardly \
         damped. {}. The other lead is a misplaced decimal: {} N for {} N would lie between its neighbours {} and {} N{}.",
        context.stated.torsional_mode.printed(),
        context.stated.torsional_mode.printed(),
        significant(span_ratio(context), 3),
        significant(1e2 * found[0].mismatch, 2),
        significant(1e2 * found[found.len() - 1].mismatch, 2),
        if fits {
            "With one of them the rows beside keep what is printed: a torsional mode can do it"
        } else {
            "None of them leaves the rows beside as small as printed: a roll is too broad to raise one row alone, and would need \
             less damping still"
        },
        significant(tenth, 6),
        rows[4].peak_to_peak.printed(),
        rows[3].peak_to_peak.printed(),
        rows[5].peak_to_peak.printed(),
        if tenth < printed[0] && tenth > printed[2] {
            ""
        } else {
            ", which it does not"
        },
    ))
}

fn roll_table(context: &Context) -> Result<Table, ReproduceError> {
    let mut table = Table::new(
        "Mismatch of left and right cylinder that makes the jump of Table 3",
        &[
            "damping ratio of the roll",
            "mismatch [%]",
            "at 4 Hz [N]",
            "at 5 Hz [N]",
            "at 6 Hz [N]",
            "rows beside as printed",
        ],
    );
    let printed = printed_strokes(context);
    for jump in jumps(context)? {
        let mut row = vec![
            Cell::Number(jump.roll_damping_ratio, 3),
            Cell::Number(1e2 * jump.mismatch, 3),
        ];
        row.extend(jump.strokes.map(|stroke| Cell::Number(stroke, 4)));
        row.push(Cell::text(if jump.fits(printed) { "yes" } else { "no" }));
        table.rows.push(row);
    }
    let mut row = vec![Cell::text("printed"), Cell::text("")];
    row.extend(printed.map(|stroke| Cell::Number(stroke, 7)));
    row.push(Cell::text(""));
    table.rows.push(row);
    Ok(table)
}
