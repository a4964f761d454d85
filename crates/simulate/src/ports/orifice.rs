//! The orifices of valves as ports of the plant.

use std::any::Any;

use simgap_integrate::exact::{Element, ForceLaw, LaneLaw, MemberMotion, Port, Tangent, gather};
use simgap_model::{Cylinder, Edges, Model, Node, PRESSURE_UNIT_PA, Valve};

/// Flow of a valve into a chamber beyond what is proportional to the spool, which the matrices hold,
///
/// ```text
/// F = −P (Q(x, p₀ + P q̇) − g x),   ∂F/∂q̇ = −P² ∂Q/∂p
/// ```
///
/// x is the position of the spool, q̇ the rate of the coordinate of the pressure, g the slope about p₀ ([`Valve::opening_gain`]),
/// P the unit of pressure.
struct Orifice {
    edges: Edges,
    pressure: f64,
    gain: f64,
}

impl Orifice {
    /// All numbers of it.
    fn split(&self) -> [f64; 9] {
        let e = &self.edges;
        [
            e.flow_gain,
            e.overlap,
            e.asymmetry,
            e.supply,
            e.tank,
            e.supply_droop,
            e.fills,
            self.pressure,
            self.gain,
        ]
    }

    /// An orifice of the numbers of [`Orifice::split`].
    #[inline(always)]
    fn join(numbers: [f64; 9]) -> Self {
        let [
            flow_gain,
            overlap,
            asymmetry,
            supply,
            tank,
            supply_droop,
            fills,
            pressure,
            gain,
        ] = numbers;
        Self {
            edges: Edges {
                flow_gain,
                overlap,
                asymmetry,
                supply,
                tank,
                supply_droop,
                fills,
            },
            pressure,
            gain,
        }
    }
}

impl Orifice {
    #[inline(always)]
    fn tangent_from<const DROOPS: bool>(&self, motion: MemberMotion) -> Tangent {
        let pressure = self.pressure + PRESSURE_UNIT_PA * motion.velocity;
        let [flow, slope] = self
            .edges
            .flow_from::<DROOPS>(motion.displacement, pressure);
        Tangent {
            force: -PRESSURE_UNIT_PA * (flow - self.gain * motion.displacement),
            damping: -PRESSURE_UNIT_PA * PRESSURE_UNIT_PA * slope,
        }
    }
}

impl ForceLaw for Orifice {
    fn force(&self, motion: MemberMotion) -> f64 {
        self.tangent(motion).force
    }

    fn has_tangent(&self) -> bool {
        true
    }

    fn tangent(&self, motion: MemberMotion) -> Tangent {
        if self.edges.supply_droop == 0.0 {
            self.tangent_from::<false>(motion)
        } else {
            self.tangent_from::<true>(motion)
        }
    }

    fn lanes(&self, peers: &[&dyn ForceLaw]) -> Option<Box<dyn LaneLaw>> {
        let droops = |law: &&dyn ForceLaw| {
            let law: &dyn Any = *law;
            let own = law.downcast_ref::<Orifice>();
            own.is_none_or(|own| own.edges.supply_droop != 0.0)
        };
        if peers.iter().any(droops) {
            gather(peers, Orifice::split, |n| Lane::<true>(Orifice::join(n)))
        } else {
            gather(peers, Orifice::split, |n| Lane::<false>(Orifice::join(n)))
        }
    }
}

/// An orifice among eight: without a branch, and without the root of a supply that droops where none does.
struct Lane<const DROOPS: bool>(Orifice);

impl<const DROOPS: bool> ForceLaw for Lane<DROOPS> {
    #[inline(always)]
    fn force(&self, motion: MemberMotion) -> f64 {
        self.tangent(motion).force
    }

    #[inline(always)]
    fn tangent(&self, motion: MemberMotion) -> Tangent {
        self.0.tangent_from::<DROOPS>(motion)
    }
}

/// Two for each valve.
pub(super) fn of(model: &Model) -> Vec<Element> {
    let each = model.elements.valves.iter().flat_map(|valve| {
        let cylinder = model
            .elements
            .cylinders
            .iter()
            .find(|c| c.name == valve.cylinder);
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
            edges: valve.edges(chamber),
            pressure,
            gain: valve.opening_gain(chamber, pressure),
        }),
    })
}
