//! The row over the state that an output reads.

use super::{Form, Output, OutputKind, Reading};
use crate::refuse::item;
use crate::{GROUND, Model, ModelError, Node, PRESSURE_UNIT_PA};

impl Model {
    /// How an output is read off the state.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`]; [`ModelError::Shape`] where `at` names nothing that has what is measured.
    pub fn reading(&self, output: &Output) -> Result<Reading, ModelError> {
        let at = output.at.as_deref();
        let ground = || GROUND.to_string();
        let (pair, form) = match output.kind {
            OutputKind::Displacement => (motion(output), Form::Displacement),
            OutputKind::Velocity => (motion(output), Form::Velocity),
            OutputKind::Acceleration => (motion(output), Form::Acceleration),
            OutputKind::Force => {
                let pair = output.between.as_ref();
                let [stiffness, damping] =
                    pair.map_or([0.0; 2], |pair| self.stiffness_and_damping(pair));
                (motion(output), Form::Members { stiffness, damping })
            }
            OutputKind::Signal => ([ground(), ground()], Form::Signal),
            OutputKind::Roll => {
                let body = at.and_then(|at| self.body_of(at));
                let body =
                    body.ok_or_else(|| unfit(output, "the roll of", "a body or a point of one"))?;
                ([body.roll(), ground()], Form::Displacement)
            }
            OutputKind::Spool => {
                let valve =
                    at.and_then(|at| self.elements.valves.iter().find(|valve| valve.name == at));
                let needed = "the name of a [[valve]]";
                let valve = valve.ok_or_else(|| unfit(output, "the spool of", needed))?;
                ([valve.spool(), ground()], Form::Displacement)
            }
            OutputKind::Pressure => {
                let (cylinder, chamber) = self.chamber_of(output)?;
                let (scale, offset) = (PRESSURE_UNIT_PA, cylinder.pressures[chamber]);
                (motion(output), Form::Rate { scale, offset })
            }
            OutputKind::Flow => {
                let (cylinder, chamber) = self.chamber_of(output)?;
                let of_chamber = at.and_then(|at| self.node(at)).unwrap_or(Node::Ground);
                let mut valves = self.elements.valves.iter();
                let valve = valves.find(|valve| valve.cylinder == cylinder.name);
                let gain = valve.map_or(0.0, |valve| {
                    valve.opening_gain(chamber, cylinder.pressures[chamber])
                });
                let spool = valve.map_or_else(ground, crate::Valve::spool);
                let chamber = of_chamber;
                ([spool, ground()], Form::Orifice { gain, chamber })
            }
        };
        let nodes = self.resolve_pair(&pair, || item("output", &output.channel))?;
        Ok(Reading { nodes, form })
    }

    fn chamber_of(&self, output: &Output) -> Result<(&crate::Cylinder, usize), ModelError> {
        let chamber = output.at.as_deref().and_then(|at| self.chamber(at));
        let needed = "a chamber of a [[cylinder]], such as \"name.p1\"";
        chamber.ok_or_else(|| unfit(output, "a pressure or a flow of", needed))
    }
}

/// The node of an output and the ground, or the two nodes of its members.
fn motion(output: &Output) -> [String; 2] {
    let ground = || GROUND.to_string();
    match (&output.at, &output.between) {
        (Some(at), _) => [at.clone(), ground()],
        (None, Some(pair)) => pair.clone(),
        (None, None) => [ground(), ground()],
    }
}

fn unfit(output: &Output, what: &str, needed: &str) -> ModelError {
    ModelError::Shape {
        place: item("output", &output.channel),
        found: format!("{what} \"{}\"", output.at.as_deref().unwrap_or_default()),
        needed: needed.into(),
    }
}
