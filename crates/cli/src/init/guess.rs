//! Which column of a record is taken for what: by its unit, and by its name where units leave a
//! choice. A guess is never more than a comment and a start.

use simgap_record::{Channel, Quantity, Record, UnitKind};

use crate::args::Like;
use crate::check::quantity;

/// What columns that drive a machine are called.
const DRIVES: [&str; 12] = [
    "u", "f", "force", "drive", "input", "current", "volt", "pressure", "torque", "tau", "cmd",
    "motor",
];
/// What columns of a moving base are called.
const BASES: [&str; 8] = [
    "base", "support", "ground", "floor", "table", "foot", "x0", "input",
];

/// A column in its place in the model.
pub(super) struct Role {
    pub(super) channel: String,
    /// As in the header; empty for a placeholder.
    pub(super) unit: String,
    pub(super) quantity: Quantity,
    /// Whether the unit does not measure the quantity, so that a gain is needed.
    pub(super) needs_gain: bool,
    /// Why this column, in words.
    pub(super) why: String,
}

/// Every column in its place.
pub(super) struct Roles {
    pub(super) like: Like,
    pub(super) input: Role,
    pub(super) outputs: Vec<Role>,
    /// What could not be filled in.
    pub(super) warnings: Vec<String>,
}

impl Roles {
    /// What a column is taken for.
    pub(super) fn of(&self, channel: &str) -> String {
        let outputs = self.outputs.iter().map(|role| ("output", role));
        let mut all = std::iter::once(("input", &self.input)).chain(outputs);
        match all.find(|(_, role)| role.channel == channel && !role.unit.is_empty()) {
            Some((place, role)) => format!("{place}, {}: {}", words(role.quantity), role.why),
            None => "nothing".to_string(),
        }
    }
}

pub(super) fn words(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Displacement => "displacement",
        Quantity::Velocity => "velocity",
        Quantity::Acceleration => "acceleration",
        Quantity::Force => "force",
        Quantity::Pressure => "pressure",
        Quantity::Flow => "flow",
        Quantity::Angle => "angle",
        Quantity::Share | Quantity::Number => "number",
    }
}

/// Guesses; without a record, placeholders.
pub(super) fn roles(like: Option<Like>, record: Option<&Record>) -> Roles {
    let channels = record.map_or(&[][..], Record::channels);
    let like = like.unwrap_or_else(|| likely(channels));
    let mut warnings = Vec::new();
    let driven_by = match like {
        Like::Base => Quantity::Displacement,
        Like::Oscillator | Like::TwoMass | Like::Axis => Quantity::Force,
    };
    let input = input(channels, driven_by).unwrap_or_else(|| {
        let name = if like == Like::Base { "x_base" } else { "u" };
        if record.is_some() {
            warnings.push(format!(
                "no column looks like the input: '{name}' is a placeholder"
            ));
        }
        placeholder(name, driven_by)
    });
    let wanted = if like == Like::TwoMass { 2 } else { 1 };
    let mut outputs = outputs(channels, &input, wanted);
    while outputs.len() < wanted {
        let name = match (like, outputs.len()) {
            (Like::TwoMass, k) => ["y1", "y2"][k],
            _ => "y",
        };
        if record.is_some() {
            warnings.push(format!(
                "no column is left for an output: '{name}' is a placeholder"
            ));
        }
        outputs.push(placeholder(name, Quantity::Displacement));
    }
    for role in std::iter::once(&input)
        .chain(&outputs)
        .filter(|r| r.needs_gain)
    {
        warnings.push(format!(
            "'{}' is in [{}], which is no {}: the gain of 1 is a placeholder",
            role.channel,
            role.unit,
            words(role.quantity)
        ));
    }
    Roles {
        like,
        input,
        outputs,
        warnings,
    }
}

/// The template that fits the columns.
fn likely(channels: &[Channel]) -> Like {
    let count = |wanted: Quantity| {
        let kinds = channels.iter().map(|channel| quantity(channel.unit.kind()));
        kinds.filter(|kind| *kind == Some(wanted)).count()
    };
    let drives = channels
        .iter()
        .any(|channel| quantity(channel.unit.kind()).is_none());
    if count(Quantity::Force) == 0 && !drives && count(Quantity::Displacement) > 1 {
        Like::Base
    } else {
        Like::Oscillator
    }
}

fn placeholder(name: &str, quantity: Quantity) -> Role {
    Role {
        channel: name.to_string(),
        unit: String::new(),
        quantity,
        needs_gain: false,
        why: "a placeholder".to_string(),
    }
}

fn role(channel: &Channel, wanted: Quantity, why: &str) -> Role {
    Role {
        channel: channel.name.clone(),
        unit: channel.unit.symbol().to_string(),
        quantity: wanted,
        needs_gain: !wanted.accepts(channel.unit.kind()),
        why: why.to_string(),
    }
}

/// Whether a name is one of the words, or begins with one of the longer ones.
fn is_called(name: &str, words: &[&str]) -> bool {
    let name = name.to_lowercase();
    let parts = || name.split(|c: char| !c.is_alphanumeric());
    words
        .iter()
        .any(|word| parts().any(|part| part == *word || (word.len() > 2 && part.starts_with(word))))
}

/// The column that drives the machine: of the right unit, and of a fitting name among several; else
/// of a unit that is no motion (volts, bar), through a gain.
fn input(channels: &[Channel], wanted: Quantity) -> Option<Role> {
    let fitting: Vec<&Channel> = channels
        .iter()
        .filter(|c| wanted.accepts(c.unit.kind()))
        .collect();
    let names: &[&str] = if wanted == Quantity::Displacement {
        &BASES
    } else {
        &DRIVES
    };
    match (fitting.as_slice(), wanted) {
        ([], Quantity::Displacement) => return None,
        ([], _) => {}
        ([only], Quantity::Force) => {
            return Some(role(only, wanted, "the only column that is a force"));
        }
        // The only displacement is what is measured of the machine.
        ([_], _) => return None,
        (several, _) => {
            let called = several.iter().find(|c| is_called(&c.name, names));
            let by_name = called.map(|c| role(c, wanted, "by its unit and its name"));
            return by_name.or_else(|| Some(role(several[0], wanted, "the first of its unit")));
        }
    }
    let other = || {
        let kinds = [UnitKind::Other, UnitKind::Pressure];
        channels
            .iter()
            .filter(move |c| kinds.contains(&c.unit.kind()))
    };
    let called = other().find(|c| is_called(&c.name, names));
    let found = called.or_else(|| other().next())?;
    let why = if called.is_some() {
        "by its name, through a gain"
    } else {
        "the first that is no motion, through a gain"
    };
    Some(role(found, wanted, why))
}

/// Columns that show the motion: displacements first, then velocities, then accelerations.
fn outputs(channels: &[Channel], input: &Role, wanted: usize) -> Vec<Role> {
    let free = || {
        channels
            .iter()
            .filter(|channel| channel.name != input.channel)
    };
    let mut found = Vec::new();
    for kind in [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::Acceleration,
    ] {
        let fitting = free().filter(|channel| kind.accepts(channel.unit.kind()));
        found.extend(fitting.map(|channel| role(channel, kind, "by its unit")));
    }
    if found.is_empty() {
        let other = free().find(|channel| channel.unit.kind() == UnitKind::Other);
        let why = "the first that is left, through a gain";
        found.extend(other.map(|channel| role(channel, Quantity::Displacement, why)));
    }
    found.truncate(wanted);
    found
}
