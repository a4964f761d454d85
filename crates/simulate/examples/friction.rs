//! A step of force on a table with and without dry friction: `cargo run -p simgap-simulate --example friction`.
#![allow(clippy::print_stdout)]

use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_record::parse_csv;
use simgap_simulate::{Run, Simulator, substeps_for};

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
    // 8 N for 10 s: a spring of 800 N/m gives way by 10 mm.
    let mut record = String::from("t [s],u [N]\n");
    for k in 0..1000 {
        record += &format!("{},8\n", 0.01 * f64::from(k));
    }
    let run = Run::new(&model, &parse_csv("step.csv", record.as_bytes())?)?;
    let steps = substeps_for(&model, std::slice::from_ref(&run))?;
    let friction = find("coulomb_friction").ok_or("not in the catalogue")?;
    let at = Location::Between(["table".into(), "ground".into()]);
    let rubs = [Placed::new(friction, at, vec![2.0])];
    let plain = Simulator::new(&model, &[], steps)?.predict(&run, &[])?;
    let rubbing = Simulator::new(&model, &rubs, steps)?.predict(&run, &[])?;
    println!("t [s], y [mm], y with 2 N of friction [mm]");
    for k in (0..1000).step_by(50) {
        let (plain, rubbing) = (1e3 * plain[0][k], 1e3 * rubbing[0][k]);
        println!("{:.1}, {plain:.3}, {rubbing:.3}", 0.01 * k as f64);
    }
    Ok(())
}
