//! A hydraulic axis: a table on a cylinder whose servo valve a controller of the position commands.

use std::f64::consts::TAU;

use simgap_model::{Block, Cylinder, GROUND, InputKind, Model, OutputKind, Valve};

use super::parts::{dashpot, input, mass, output, pair};
use super::sizes::Sizes;
use crate::BlindError;
use crate::random::Random;

/// Supply, and the drop over an edge at which valves are rated, Pa.
const SUPPLY_PA: f64 = 21e6;
const RATED_DROP_PA: f64 = 3.5e6;
/// Pipes hold this share of the oil of a chamber at the middle of the stroke.
const PIPES: f64 = 0.1;
/// Spools are faster than the oil by this factor.
const SPOOL: [f64; 2] = [1.5, 3.0];

/// Equal areas, half of the supply in both chambers: at rest no oil flows. The loop is closed at a twentieth to an eighth
/// of the frequency of the oil, which keeps it stable down to half of the drawn damping.
pub(super) fn axis(random: &mut Random) -> Result<(Model, Sizes), BlindError> {
    let mass_kg = random.log_uniform(50.0, 5000.0);
    let oil_hz = random.log_uniform(12.0, 60.0);
    let omega = TAU * oil_hz;
    let stroke = random.log_uniform(0.05, 0.3);
    let bulk_modulus = random.uniform(1.2e9, 1.6e9);
    // k = 2 β A² / V with V = (1 + PIPES) A S / 2.
    let stiffness = mass_kg * omega * omega;
    let area = stiffness * (1.0 + PIPES) * stroke / (4.0 * bulk_modulus);
    let freq_hz = 0.4 * oil_hz;
    let displacement_m = random.log_uniform(1e-4, 1e-3) * (40.0 / oil_hz);
    let velocity_gain = omega * random.uniform(0.05, 0.125);
    // Half of the opening moves it at the speed of the drawn motion.
    let full_speed = 2.0 * TAU * freq_hz * displacement_m;
    let rated_flow = full_speed * area / (0.5 * SUPPLY_PA / RATED_DROP_PA).sqrt();
    let chamber = 0.5 * area * stroke;
    let mut model = Model {
        name: "servo axis".to_string(),
        masses: vec![mass("table", mass_kg)],
        dampers: vec![dashpot(
            "table",
            GROUND,
            2.0 * random.uniform(0.15, 0.3) * mass_kg * omega,
        )],
        inputs: vec![input(InputKind::SetPoint, "controller")],
        outputs: vec![output(1, OutputKind::Displacement, "table")],
        ..Model::default()
    };
    model.add_cylinder(Cylinder {
        name: "drive".to_string(),
        between: pair("table", GROUND),
        areas: [area; 2],
        dead_volumes: [PIPES * chamber; 2],
        stroke,
        position: None,
        bulk_modulus,
        leakage: 0.02 * chamber * omega / bulk_modulus,
        external_leakage: 0.0,
        pressures: [0.5 * SUPPLY_PA; 2],
    })?;
    model.add_valve(Valve {
        name: "servo".to_string(),
        cylinder: "drive".to_string(),
        from: Some("controller".to_string()),
        rated_flow,
        rated_drop: RATED_DROP_PA,
        natural_freq: oil_hz * random.uniform(SPOOL[0], SPOOL[1]),
        damping_ratio: random.uniform(0.6, 0.9),
        supply: SUPPLY_PA,
        tank: 0.0,
        overlap: 0.0,
        asymmetry: 0.0,
        supply_droop: 0.0,
    })?;
    model.add_block(Block {
        name: "controller".to_string(),
        numerator: vec![velocity_gain / full_speed],
        denominator: vec![1.0],
        plus: vec![],
        minus: vec!["table".to_string()],
        force: None,
    })?;
    if random.chance(0.75) {
        for (k, chamber) in ["drive.p1", "drive.p2"].into_iter().enumerate() {
            model
                .outputs
                .push(output(k + 2, OutputKind::Pressure, chamber));
        }
    }
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: 2.0 * displacement_m,
    };
    Ok((model, sizes))
}
