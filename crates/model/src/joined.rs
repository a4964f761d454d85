//! What is joined to what.

use crate::Model;

impl Model {
    /// Pairs of names that move or drive each other: the ends of members and cylinders, a body and its points, a
    /// cylinder and its pressures, a valve and what it feeds, a block and its signals.
    #[must_use]
    pub fn joined(&self) -> Vec<[String; 2]> {
        let mut pairs = self.members();
        for body in &self.bodies {
            let points = body.points.iter().map(|point| body.node_name(point));
            pairs.extend(
                points
                    .chain([body.roll()])
                    .map(|node| [body.name.clone(), node]),
            );
        }
        for beam in &self.beams {
            let modes = self.masses.iter().filter(|mass| beam.is_mode(&mass.name));
            let ends = &beam.between;
            pairs.extend(modes.flat_map(|q| ends.iter().map(|e| [e.clone(), q.name.clone()])));
        }
        for cylinder in &self.cylinders {
            pairs.push(cylinder.between.clone());
            for end in &cylinder.between {
                pairs.extend(cylinder.chambers().map(|chamber| [end.clone(), chamber]));
            }
        }
        for valve in &self.valves {
            pairs.push([valve.name.clone(), valve.spool()]);
            let mut cylinders = self.cylinders.iter();
            if let Some(fed) = cylinders.find(|cylinder| cylinder.name == valve.cylinder) {
                pairs.extend(fed.chambers().map(|chamber| [valve.name.clone(), chamber]));
            }
            pairs.extend(valve.from.clone().map(|from| [from, valve.name.clone()]));
        }
        for block in &self.blocks {
            let signals = block.plus.iter().chain(&block.minus).chain(&block.force);
            pairs.extend(signals.map(|signal| [block.name.clone(), signal.clone()]));
        }
        pairs
    }
}
