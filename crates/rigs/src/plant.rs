//! A machine as its model file describes it.

use serde::Serialize;
use serde_json::{Value, json};

/// What a member, a sensor or an input is attached to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Node {
    /// Never moves.
    Ground,
    /// A degree of freedom.
    Mass(usize),
    /// A node whose displacement the input of this number prescribes.
    Base(usize),
}

/// A spring or a damper between two nodes.
#[derive(Debug, Clone)]
pub struct Member {
    /// Unique name.
    pub name: String,
    /// First node.
    pub a: Node,
    /// Second node.
    pub b: Node,
    /// Stiffness or damping, SI.
    pub value: f64,
}

/// A unit of a column: its symbol and how many SI units it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit(pub &'static str, pub f64);

/// A driven input.
#[derive(Debug, Clone)]
pub struct Input {
    /// Column of the record.
    pub channel: String,
    /// Unit of the column.
    pub unit: Unit,
    /// A mass for a force, a base for a displacement.
    pub at: Node,
}

/// What a sensor measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// m or rad.
    Displacement,
    /// Per second.
    Velocity,
    /// Per second squared.
    Acceleration,
    /// Carried between two nodes, N or N m.
    Force,
}

/// A sensor.
#[derive(Debug, Clone)]
pub struct Output {
    /// Column of the record.
    pub channel: String,
    /// Unit of the column.
    pub unit: Unit,
    /// What is measured.
    pub quantity: Quantity,
    /// Where; the first node of a force.
    pub a: Node,
    /// The second node of a force.
    pub b: Node,
}

/// A PD controller of a mass: u = kp (r − x) + kd (r' − x').
#[derive(Debug, Clone, Copy)]
pub struct Control {
    /// Mass whose motion is controlled, by the first input.
    pub mass: usize,
    /// N/m.
    pub kp: f64,
    /// N s/m.
    pub kd: f64,
}

/// Where an effect sits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Between two nodes.
    Between(Node, Node),
    /// On a mass.
    Mass(usize),
    /// In the path of an input.
    Input(usize),
    /// In the path of an output.
    Channel(usize),
}

/// A machine.
#[derive(Debug, Clone)]
pub struct Plant {
    /// Kind of machine.
    pub family: &'static str,
    /// Names of the masses.
    pub mass_names: Vec<String>,
    /// kg or kg m².
    pub masses: Vec<f64>,
    /// Springs.
    pub springs: Vec<Member>,
    /// Dampers.
    pub dampers: Vec<Member>,
    /// Inputs.
    pub inputs: Vec<Input>,
    /// Sensors.
    pub outputs: Vec<Output>,
    /// Gravity on an arm: mass and m g l.
    pub pendulum: Vec<(usize, f64)>,
    /// The controller, where the loop is closed.
    pub control: Option<Control>,
    /// Samples per second.
    pub rate_hz: f64,
    /// Band in which the machine answers, Hz.
    pub band_hz: (f64, f64),
    /// Size of the drive: rms force, rms base motion, or first displacement of a free decay.
    pub drive: f64,
}

impl Plant {
    /// Name of a node in the model file.
    #[must_use]
    pub fn node_name(&self, node: Node) -> String {
        match node {
            Node::Ground => "ground".into(),
            Node::Mass(i) => self.mass_names[i].clone(),
            Node::Base(_) if self.base_count() == 1 => "base".into(),
            Node::Base(i) => format!("base{}", i + 1),
        }
    }

    fn base_count(&self) -> usize {
        let bases = self.inputs.iter();
        bases.filter(|i| matches!(i.at, Node::Base(_))).count()
    }

    /// A place in the form of the contract.
    #[must_use]
    pub fn place_json(&self, place: Place) -> Value {
        match place {
            Place::Between(a, b) => json!({"between": [self.node_name(a), self.node_name(b)]}),
            Place::Mass(i) => json!({"mass": self.mass_names[i]}),
            Place::Input(i) => json!({"input": self.inputs[i].channel}),
            Place::Channel(i) => json!({"channel": self.outputs[i].channel}),
        }
    }

    /// Whether a spring joins two nodes.
    #[must_use]
    pub fn has_spring(&self, a: Node, b: Node) -> bool {
        self.springs.iter().any(|m| joins(m, a, b))
    }

    /// Whether a damper joins two nodes.
    #[must_use]
    pub fn has_damper(&self, a: Node, b: Node) -> bool {
        self.dampers.iter().any(|m| joins(m, a, b))
    }

    /// Stiffness of the springs between two nodes.
    #[must_use]
    pub fn stiffness(&self, a: Node, b: Node) -> f64 {
        let members = self.springs.iter().filter(|m| joins(m, a, b));
        members.map(|m| m.value).sum()
    }

    /// Pairs of nodes that a member joins, each once.
    #[must_use]
    pub fn member_pairs(&self) -> Vec<(Node, Node)> {
        let mut pairs: Vec<(Node, Node)> = Vec::new();
        for m in self.springs.iter().chain(&self.dampers) {
            if !pairs.iter().any(|&(a, b)| joins(m, a, b)) {
                pairs.push((m.a, m.b));
            }
        }
        pairs
    }

    /// The model file.
    #[must_use]
    pub fn to_toml(&self, name: &str) -> String {
        let mut text = format!("schema = \"simgap-model/1\"\nname = \"{name}\"\n");
        for (name, value) in self.mass_names.iter().zip(&self.masses) {
            text += &format!("\n[[mass]]\nname = \"{name}\"\nvalue = {value:?}\n");
        }
        for (list, table, key) in [
            (&self.springs, "spring", "stiffness"),
            (&self.dampers, "damper", "damping"),
        ] {
            for m in list {
                let between = self.pair_text(m.a, m.b);
                text += &format!(
                    "\n[[{table}]]\nname = \"{}\"\nbetween = {between}\n{key} = {:?}\n",
                    m.name, m.value
                );
            }
        }
        for (mass, value) in &self.pendulum {
            let at = &self.mass_names[*mass];
            text += &format!("\n[[pendulum]]\nat = \"{at}\"\nvalue = {value:?}\n");
        }
        for input in &self.inputs {
            let kind = match input.at {
                Node::Base(_) => "displacement",
                _ => "force",
            };
            text += &format!(
                "\n[[input]]\nchannel = \"{}\"\nkind = \"{kind}\"\nat = \"{}\"\n",
                input.channel,
                self.node_name(input.at)
            );
        }
        for output in &self.outputs {
            text += &self.output_text(output);
        }
        text
    }

    fn pair_text(&self, a: Node, b: Node) -> String {
        format!("[\"{}\", \"{}\"]", self.node_name(a), self.node_name(b))
    }

    fn output_text(&self, output: &Output) -> String {
        let (kind, place) = match output.quantity {
            Quantity::Displacement => ("displacement", None),
            Quantity::Velocity => ("velocity", None),
            Quantity::Acceleration => ("acceleration", None),
            Quantity::Force => ("force", Some(self.pair_text(output.a, output.b))),
        };
        let place = match place {
            Some(pair) => format!("between = {pair}"),
            None => format!("at = \"{}\"", self.node_name(output.a)),
        };
        format!(
            "\n[[output]]\nchannel = \"{}\"\nkind = \"{kind}\"\n{place}\n",
            output.channel
        )
    }
}

/// Whether a member joins two nodes, in either order.
#[must_use]
pub fn joins(member: &Member, a: Node, b: Node) -> bool {
    same_pair((member.a, member.b), (a, b))
}

/// Whether two pairs are the same two nodes.
#[must_use]
pub fn same_pair(p: (Node, Node), q: (Node, Node)) -> bool {
    p == q || p == (q.1, q.0)
}
