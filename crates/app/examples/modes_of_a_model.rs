//! The question `simgap modes` asks, from a program: `cargo run -p simgap-app --example modes_of_a_model`.
#![allow(clippy::print_stdout)]

use std::path::Path;

use simgap_app::{input, json, modes};

const AXIS: &str = r#"
schema = "simgap-model/1"
name = "axis"
[[mass]]
name = "table"
value = 2.0
[[spring]]
name = "leaf"
between = ["table", "ground"]
stiffness = 800.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 4.0
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = Path::new("axis.toml");
    let model = input::model_of(AXIS, path)?;
    print!("{}", json(&modes::modes(&model, path)?.modes)?);
    Ok(())
}
