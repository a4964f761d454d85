//! The orifices of valves as ports of the plant.

use simgap_integrate::exact::{Element, ForceLaw, MemberMotion, Port};
use simgap_model::{Cylinder, Model, Node, PRESSURE_UNIT_PA, Valve};

/// Flow of a valve into a chamber beyond what is proportional to the spool, which the matrices hold,
///
/// ```text
/// F = −P (Q(x, p₀ + P q̇) − g x)
/// ```
///
/// x is the position of the spool, q̇ the rate of the coordinate of the pressure, g the slope about p₀ ([`Valve::opening_gain`]),
/// P the unit of pressure.
struct Orifice {
    valve: Valve,
    chamber: usize,
    pressure: f64,
    gain: f64,
}

impl ForceLaw for Orifice {
    fn force(&self, motion: MemberMotion) -> f64 {
        let pressure = self.pressure + PRESSURE_UNIT_PA * motion.velocity;
        let flow = self.valve.flow(self.chamber, motion.displacement, pressure);
        -PRESSURE_UNIT_PA * (flow - self.gain * motion.displacement)
    }
}

/// Two for each valve.
pub(crate) fn orifices(model: &Model) -> Vec<Element> {
    let each = model.valves.iter().flat_map(|valve| {
        let cylinder = model.cylinders.iter().find(|c| c.name == valve.cylinder);
        let pair =
            cylinder.map(|cylinder| [0, 1].map(|chamber| orifice(model, valve, cylinder, chamber)));
        pair.into_iter().flatten().flatten()
    });
    each.collect()
}

fn orifice(model: &Model, valve: &Valve, cylinder: &Cylinder, chamber: usize) -> Option<Element> {
    let spool = model.node(&valve.spool())?;
    let node = model.node(&cylinder.chambers()[chamber])?;
    let pressure = cylinder.pressures[chamber];
    Some(Element {
        port: Port {
            displacement: [spool, Node::Ground],
            velocity: [node, Node::Ground],
            force: [node, Node::Ground],
        },
        law: Box::new(Orifice {
            valve: valve.clone(),
            chamber,
            pressure,
            gain: valve.opening_gain(chamber, pressure),
        }),
    })
}
