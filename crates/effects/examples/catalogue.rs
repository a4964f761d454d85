//! Every kind of the catalogue with its parameters, and the places it can have in a model:
//! `cargo run -p simgap-effects --example catalogue`.
#![allow(clippy::print_stdout)]

use simgap_effects::{catalogue, sites};
use simgap_model::Model;

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
    let model = Model::from_toml(AXIS)?;
    for effect in catalogue() {
        let parameters = effect.parameters().iter();
        let parameters = parameters.map(|p| format!("{} [{}]", p.name, p.unit));
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        println!("{}: {parameters}", effect.kind());
        for at in sites(&model, effect.site()) {
            println!("    {at}");
        }
    }
    Ok(())
}
