//! Whether K of Table 1 is the stiffness of a servo that holds the mold.

use simgap_mold::{LeafSpring, ServoDrive, ServoMold};

use super::frame::{LEAF_COUNT, LEAVES_M, span_ratio};
use super::{Cell, Context, ReproduceError, Table, significant};

/// One litre a minute, m³/s.
const LITRE_PER_MINUTE: f64 = 1e-3 / 60.0;

/// What the servo assumed does, and what a servo with K and c of Table 1 would have to be,
///
/// ```text
/// −F/y = 2 A (A s + K_q G)/(V s/(2β) + C_l)  →  K + c s,   c = 2 A²/C_l,   K = c K_v,   K_v = K_q G/A
/// ```
///
/// where the corner of the oil, 2β C_l/V, lies above what is asked.
pub(crate) struct Servo {
    drive: ServoDrive,
    mold: ServoMold,
    velocity_gain: f64,
    /// Whether all poles of the closed loops decay.
    is_stable: bool,
    /// Its stiffness at the natural frequency of Table 1, over K.
    pub(crate) times_as_stiff: f64,
    /// K/c, the velocity gain that K and c take, 1/s.
    needed_gain: f64,
    /// C_l p_s of both cylinders, with the leak 2 A²/c that K and c take.
    pub(crate) leak_l_per_min: f64,
    /// The same over the rated flow of both valves.
    pub(crate) leak_share: f64,
}

impl Servo {
    pub(crate) fn new(context: &Context) -> Result<Self, ReproduceError> {
        let table = &context.mold;
        // With a radius of gyration of 1 m; the heave, which is asked for, does not depend on it.
        let half_span = span_ratio(context);
        let drives = [-half_span, half_span].map(ServoDrive::assumed);
        let [length, width, thickness] = LEAVES_M[0];
        let leaves =
            LEAF_COUNT as f64 * LeafSpring::steel(length, width, thickness)?.guided_stiffness();
        let mass = table.mass_kg();
        let mold = ServoMold::new([mass, mass], [leaves, table.damping()], drives)?;
        let (drive, load) = (drives[0], mold.loads()[0]);
        let leak = 2.0 * drive.area_m2 * drive.area_m2 / table.damping() * drive.supply_pa;
        Ok(Self {
            drive,
            mold,
            velocity_gain: drive.velocity_gain(load)?,
            is_stable: mold.modes()?.iter().all(|mode| mode.eigenvalue.re < 0.0),
            times_as_stiff: mold.drive_stiffness(table.natural_freq_hz())?.norm()
                / table.stiffness(),
            needed_gain: table.stiffness() / table.damping(),
            leak_l_per_min: 2.0 * leak / LITRE_PER_MINUTE,
            leak_share: leak / drive.rated_flow,
        })
    }

    /// Whether a servo with K and c of Table 1 leaks less than its valves pass: the least that it takes to move.
    pub(crate) fn leaks_little(&self) -> bool {
        self.leak_share < 1.0
    }

    pub(crate) fn text(&self) -> String {
        let drive = &self.drive;
        format!(
            "**K of Table 1 as the stiffness of the servo** is the other lead. Two cylinders as above, with valves of {} l/min and spools at {} Hz, a leak of \
             {} l/min at {} MPa and proportional controllers that close their loops at {} 1/s ([`ServoMold`](../../crates/mold/README.md), values of ordinary size, \
             assumed; its poles {}) give way as in the table: at the natural frequency of Table 1 they are {} times as stiff as K. A servo that \
             gives way as K and c of Table 1 say has a velocity gain of K/c = {} 1/s, which is ordinary, and a leak of 2A²/c, which is {}: {} l/min at the supply \
             pressure, {} times what both valves pass at their rated drop. {} Where F_pressure is measured, as in Eq. (1), the oil and its \
             servo are in it already, and what is left between mold and ground is what guides it: the leaf springs, far softer than K above.",
            significant(drive.rated_flow / LITRE_PER_MINUTE, 3),
            significant(drive.spool_freq_hz, 3),
            significant(drive.leakage * drive.supply_pa / LITRE_PER_MINUTE, 2),
            significant(1e-6 * drive.supply_pa, 2),
            significant(self.velocity_gain, 2),
            if self.is_stable {
                "all decay"
            } else {
                "do not all decay"
            },
            significant(self.times_as_stiff, 3),
            significant(self.needed_gain, 2),
            if self.leaks_little() { "small" } else { "not" },
            significant(self.leak_l_per_min, 3),
            significant(self.leak_share, 2),
            if self.leaks_little() {
                "So K and c can be those of a servo."
            } else {
                "So K and c together are not those of a servo with cylinders of this size."
            },
        )
    }

    pub(crate) fn table(&self, context: &Context) -> Result<Table, ReproduceError> {
        let mut table = Table::new(
            "Stiffness of both drives, loops closed",
            &[
                "frequency [Hz]",
                "stiffness [MN/m]",
                "over K",
                "over k₁",
                "follows of the set point",
            ],
        );
        let first = context.table2.rows.first();
        let freqs = [
            first.map_or(f64::NAN, |row| row.excitation.si()),
            context.mold.natural_freq_hz(),
            context.stated.torsional_mode.si(),
            context.stated.leaf_modes.si(),
        ];
        for freq in freqs {
            let stiffness = self.mold.drive_stiffness(freq)?.norm();
            table.rows.push(vec![
                Cell::Number(freq, 3),
                Cell::Number(1e-6 * stiffness, 4),
                Cell::Number(stiffness / context.mold.stiffness(), 3),
                Cell::Number(stiffness / context.table5.mold_stiffness.si(), 3),
                Cell::Number(self.mold.response_to_set_point(freq)?[0].norm(), 3),
            ]);
        }
        Ok(table)
    }
}
