//! Which parameter of a model is wrong, from one record: `cargo run -p simgap-diagnose --example soft_spring`.
#![allow(clippy::print_stdout)]

use simgap_diagnose::{Request, diagnose};
use simgap_model::Model;
use simgap_record::parse_csv;

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
    // The table follows a slow force on a spring of 1000 N/m; the third digit is rounded.
    let mut csv = String::from("t [s],u [N],y [mm]\n");
    for k in 0..300 {
        let t = 0.01 * f64::from(k);
        let force = 5.0 * (1.7 * t).sin() + 3.0 * (0.9 * t).cos();
        csv += &format!("{t:.2},{force:.4},{force:.3}\n");
    }
    let records = [parse_csv("slow.csv", csv.as_bytes())?];
    let answer = diagnose(&Request::new(&model, &records, &[]), &|_| {})?.diagnosis;
    println!("{:?}", answer.verdict.status);
    for effect in &answer.verdict.effects {
        println!(
            "{} at {:?}, probability {:.2}",
            effect.kind, effect.at, effect.probability
        );
    }
    let gap = &answer.gap;
    println!("gap {:.4}, with it {:.4}", gap.nominal, gap.corrected);
    Ok(())
}
