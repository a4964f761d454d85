//! The text of a model file to be filled in.

use std::fmt::Write as _;

use simgap_record::{Quantity, Record};

use super::guess::{Role, Roles, words};
use crate::args::Like;
use crate::text::{figure, shown};

/// Where the comments of lines begin.
const COMMENT: usize = 34;

/// The whole file.
pub(super) fn model_file(roles: &Roles, record: Option<&Record>) -> String {
    let mut text = String::from(
        "# A model file of simgap. Numbers are placeholders, in SI units: put in yours.\n\
         # A machine that turns uses the same keys: inertia for mass, angle for displacement, torque\n\
         # for force.\n",
    );
    if let Some(record) = record {
        columns(&mut text, roles, record);
    }
    let name = match roles.like {
        Like::Oscillator => "oscillator",
        Like::TwoMass => "two-mass",
        Like::Base => "base-driven",
        Like::Axis => "axis",
    };
    let _ = write!(text, "\nschema = \"simgap-model/1\"\nname = \"{name}\"\n");
    text.push_str(machine(roles.like));
    inputs(&mut text, roles);
    outputs(&mut text, roles);
    text.push_str(
        "\n# A known constant force, such as weight:\n\
         # [[load]]\n# at = \"the name of a mass\"\n# value = -9.81                   # N\n\
         \n# What is known to act beyond masses, springs and dampers; simgap effects lists the kinds:\n\
         # [[effect]]\n# kind = \"coulomb_friction\"\n# between = [\"a mass\", \"ground\"]\n\
         # friction_force_n = 1.0          # N\n",
    );
    text
}

/// What the columns of the record are taken for.
fn columns(text: &mut String, roles: &Roles, record: &Record) {
    let _ = write!(
        text,
        "#\n# Columns of {} ({} rows at {} Hz); what they are taken for is a guess:\n",
        shown(record.name()),
        record.len(),
        figure(record.sample_rate_hz())
    );
    for channel in record.channels() {
        let _ = writeln!(
            text,
            "#   {} [{}]: {}",
            shown(&channel.name),
            shown(channel.unit.symbol()),
            shown(&roles.of(&channel.name))
        );
    }
}

/// The masses and members of a template.
fn machine(like: Like) -> &'static str {
    match like {
        Like::Oscillator => ONE_MASS,
        Like::TwoMass => TWO_MASSES,
        Like::Base => ON_A_BASE,
        Like::Axis => FREE,
    }
}

const ONE_MASS: &str = r#"
[[mass]]                          # one for each degree of freedom
name = "block"
value = 1.0                       # kg

[[spring]]
name = "spring"
between = ["block", "ground"]     # "ground" never moves
stiffness = 100.0                 # N/m

[[damper]]
name = "damper"
between = ["block", "ground"]
damping = 1.0                     # N s/m
"#;

const TWO_MASSES: &str = r#"
[[mass]]                          # one for each degree of freedom
name = "first"
value = 1.0                       # kg

[[mass]]
name = "second"
value = 0.5                       # kg

[[spring]]
name = "foundation"
between = ["first", "ground"]     # "ground" never moves
stiffness = 200.0                 # N/m

[[spring]]
name = "coupling"
between = ["first", "second"]
stiffness = 100.0                 # N/m

[[damper]]
name = "foundation"
between = ["first", "ground"]
damping = 1.0                     # N s/m

[[damper]]
name = "coupling"
between = ["first", "second"]
damping = 0.5                     # N s/m
"#;

const ON_A_BASE: &str = r#"
[[mass]]                          # one for each degree of freedom
name = "block"
value = 1.0                       # kg

[[spring]]
name = "mount"
between = ["block", "base"]       # "base" moves as the input below says
stiffness = 100.0                 # N/m

[[damper]]
name = "mount"
between = ["block", "base"]
damping = 1.0                     # N s/m
"#;

const FREE: &str = r#"
[[mass]]                          # all that moves with the carriage, the motor's inertia included
name = "carriage"
value = 10.0                      # kg

# A free axis has no spring. With one, such as a bellows or an energy chain:
# [[spring]]
# name = "bellows"
# between = ["carriage", "ground"]
# stiffness = 100.0               # N/m

[[damper]]                        # friction that grows with the speed
name = "guide"
between = ["carriage", "ground"]  # "ground" never moves
damping = 10.0                    # N s/m
"#;

/// The masses that are driven and measured.
fn masses(like: Like) -> &'static [&'static str] {
    match like {
        Like::Oscillator | Like::Base => &["block"],
        Like::TwoMass => &["first", "second"],
        Like::Axis => &["carriage"],
    }
}

fn inputs(text: &mut String, roles: &Roles) {
    let input = &roles.input;
    let at = match roles.like {
        Like::Base => "base",
        like => masses(like)[0],
    };
    text.push_str("\n[[input]]                         # what drives the machine, as measured\n");
    channel(text, input);
    let kind = match input.quantity {
        Quantity::Displacement => "displacement",
        _ => "force",
    };
    let _ = writeln!(text, "kind = \"{kind}\"\nat = \"{at}\"");
    gain(text, input);
}

fn outputs(text: &mut String, roles: &Roles) {
    for (output, at) in roles.outputs.iter().zip(masses(roles.like)) {
        text.push_str("\n[[output]]                        # what is measured, and compared\n");
        channel(text, output);
        let _ = writeln!(text, "kind = \"{}\"\nat = \"{at}\"", words(output.quantity));
        gain(text, output);
    }
}

fn channel(text: &mut String, role: &Role) {
    let line = format!("channel = {}", quoted(&role.channel));
    let comment = match role.unit.as_str() {
        "" => "column of the record, a placeholder".to_string(),
        unit => format!("column in [{}]; a guess: {}", shown(unit), shown(&role.why)),
    };
    let _ = writeln!(text, "{line:COMMENT$}# {comment}");
}

fn gain(text: &mut String, role: &Role) {
    let unit = match role.quantity {
        Quantity::Displacement => "m",
        Quantity::Velocity => "m/s",
        Quantity::Acceleration => "m/s^2",
        Quantity::Force => "N",
        Quantity::Pressure => "Pa",
        Quantity::Flow => "m^3/s",
        Quantity::Angle => "rad",
        Quantity::Share | Quantity::Number => "1",
    };
    if role.needs_gain {
        let line = format!("{:COMMENT$}", "gain = 1.0");
        let _ = writeln!(
            text,
            "{line}# {unit} per {}: put in yours",
            shown(&role.unit)
        );
    }
}

/// A string as TOML writes it.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out + "\""
}
