//! Travel that no spring resists and no output shows.

use crate::{Location, Model, Node, OutputKind};

impl Model {
    /// The displacement of each mass by which a place stretches by one metre, when nothing of the model depends on it: no
    /// spring or pendulum resists it and no output shows it. Where on its way a slide begins whose speed alone is measured,
    /// no record of a linear model says.
    ///
    /// `None` where the displacement across the place is held or seen, and for places that have none (inputs, outputs).
    #[must_use]
    pub fn unseen_travel(&self, at: &Location) -> Option<Vec<f64>> {
        let groups = self.groups();
        let [a, b] = self.groups_at(at, &groups)?;
        let moved = |group: usize, by: f64| -> Option<Vec<f64>> {
            let is_free = !self.is_held(&groups, group) && !self.is_seen(&groups, group);
            let each = groups
                .iter()
                .map(|own| if *own == group { by } else { 0.0 });
            is_free.then(|| each.collect())
        };
        match (a, b) {
            (Some(a), Some(b)) if a == b => None,
            (a, b) => a
                .and_then(|a| moved(a, 1.0))
                .or_else(|| b.and_then(|b| moved(b, -1.0))),
        }
    }

    /// Whether the displacement across a place may have any level: no spring or pendulum of the model resists it. An axis moves on from
    /// where it was left, and its encoder counts on.
    #[must_use]
    pub fn is_level_free(&self, at: &Location) -> bool {
        let groups = self.groups();
        let Some([a, b]) = self.groups_at(at, &groups) else {
            return false;
        };
        let is_free = |group: Option<usize>| group.is_some_and(|own| !self.is_held(&groups, own));
        a != b && (is_free(a) || is_free(b))
    }

    /// The groups of the two ends of a place, none of an end that is no mass; `None` for places that stretch by no displacement, and where
    /// bodies roll: how these are held, springs between nodes do not say.
    fn groups_at(&self, at: &Location, groups: &[usize]) -> Option<[Option<usize>; 2]> {
        let nodes = match at {
            Location::Between([a, b]) => [self.node(a)?, self.node(b)?],
            Location::Mass(mass) => [self.node(mass)?, Node::Ground],
            Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => return None,
        };
        let any_rolls = self.masses.iter().any(|mass| self.is_roll(&mass.name));
        (!any_rolls).then(|| {
            nodes.map(|node| match node {
                Node::Dof(mass) => Some(groups[mass]),
                Node::Ground | Node::Base(_) | Node::Point(_) | Node::Port(_) => None,
            })
        })
    }

    /// For each mass, the first of those that springs join it to.
    fn groups(&self) -> Vec<usize> {
        let mut groups: Vec<usize> = (0..self.dof_count()).collect();
        for spring in &self.springs {
            let [a, b] = [0, 1].map(|end| self.node(&spring.between[end]));
            if let (Some(Node::Dof(a)), Some(Node::Dof(b))) = (a, b) {
                let (keep, merge) = (groups[a].min(groups[b]), groups[a].max(groups[b]));
                groups
                    .iter_mut()
                    .filter(|g| **g == merge)
                    .for_each(|g| *g = keep);
            }
        }
        groups
    }

    /// Whether a mass of a name is one of a group.
    fn is_within(&self, name: &str, groups: &[usize], group: usize) -> bool {
        match self.node(name) {
            Some(Node::Dof(mass)) => groups[mass] == group,
            _ => false,
        }
    }

    /// Whether a spring or a pendulum holds the place of a group of masses.
    fn is_held(&self, groups: &[usize], group: usize) -> bool {
        let within = |name: &str| self.is_within(name, groups, group);
        let mut springs = self.springs.iter();
        let mut pendulums = self.pendulums.iter();
        springs.any(|spring| within(&spring.between[0]) != within(&spring.between[1]))
            || pendulums.any(|pendulum| within(&pendulum.at))
    }

    /// Whether an output shows the place of a group of masses.
    fn is_seen(&self, groups: &[usize], group: usize) -> bool {
        let within = |name: &str| self.is_within(name, groups, group);
        self.outputs.iter().any(|output| {
            output.kind == OutputKind::Displacement && output.at.as_deref().is_some_and(within)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXIS: &str = "schema = \"simgap-model/1\"\nname = \"axis\"\n\
        [[mass]]\nname = \"motor\"\nvalue = 2.0\n[[mass]]\nname = \"load\"\nvalue = 3.0\n\
        [[spring]]\nname = \"belt\"\nbetween = [\"motor\", \"load\"]\nstiffness = 1e4\n\
        [[damper]]\nname = \"guide\"\nbetween = [\"load\", \"ground\"]\ndamping = 10.0\n\
        [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"motor\"\n\
        [[output]]\nchannel = \"v\"\nkind = \"velocity\"\nat = \"load\"\n";

    fn travel(more: &str, place: [&str; 2]) -> Option<Vec<f64>> {
        let model = Model::from_toml(&format!("{AXIS}{more}")).unwrap();
        model.unseen_travel(&Location::Between(place.map(String::from)))
    }

    #[test]
    fn verify_a_slide_of_which_only_the_speed_is_seen_may_begin_anywhere() {
        assert_eq!(travel("", ["load", "ground"]), Some(vec![1.0, 1.0]));
        assert_eq!(travel("", ["ground", "motor"]), Some(vec![-1.0, -1.0]));
        // The belt would feel it.
        assert_eq!(travel("", ["motor", "load"]), None);
    }

    #[test]
    fn verify_what_is_held_or_seen_is_placed() {
        for more in [
            "[[spring]]\nname = \"k\"\nbetween = [\"motor\", \"ground\"]\nstiffness = 1.0\n",
            "[[output]]\nchannel = \"x\"\nkind = \"displacement\"\nat = \"motor\"\n",
            "[[pendulum]]\nat = \"load\"\nvalue = 2.0\n",
        ] {
            assert_eq!(travel(more, ["load", "ground"]), None, "{more}");
        }
    }

    #[test]
    fn verify_slides_are_placed_each_for_itself() {
        let other = "[[mass]]\nname = \"tool\"\nvalue = 1.0\n\
            [[damper]]\nname = \"grip\"\nbetween = [\"load\", \"tool\"]\ndamping = 5.0\n\
            [[output]]\nchannel = \"x\"\nkind = \"displacement\"\nat = \"tool\"\n";
        assert_eq!(travel(other, ["load", "tool"]), Some(vec![1.0, 1.0, 0.0]));
        assert_eq!(travel(other, ["tool", "load"]), Some(vec![-1.0, -1.0, 0.0]));
        assert_eq!(travel(other, ["tool", "ground"]), None);
    }

    #[test]
    fn verify_what_nothing_holds_has_no_level() {
        let is_free = |more: &str, place: [&str; 2]| {
            let model = Model::from_toml(&format!("{AXIS}{more}")).unwrap();
            model.is_level_free(&Location::Between(place.map(String::from)))
        };
        let seen = "[[output]]\nchannel = \"x\"\nkind = \"displacement\"\nat = \"load\"\n";
        assert!(is_free("", ["load", "ground"]) && is_free(seen, ["motor", "ground"]));
        assert!(!is_free(seen, ["motor", "load"]));
        let stop =
            "[[spring]]\nname = \"stop\"\nbetween = [\"ground\", \"motor\"]\nstiffness = 9.0\n";
        assert!(!is_free(stop, ["load", "ground"]));
        let model = Model::from_toml(AXIS).unwrap();
        assert!(model.is_level_free(&Location::Mass("load".into())));
        assert!(!model.is_level_free(&Location::Channel("v".into())));
    }
}
