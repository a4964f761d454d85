//! Poles of a model, and what a percent of each parameter does to them.
//!
//! ```sh
//! cargo run -p simgap-model --example poles
//! ```
#![allow(clippy::print_stdout)]

use simgap_model::Model;

const MODEL: &str = r#"
schema = "simgap-model/1"
name = "axis"
[[mass]]
name = "motor"
value = 3.0
[[mass]]
name = "table"
value = 30.0
[[spring]]
name = "mount"
between = ["motor", "ground"]
stiffness = 4.0e4
[[spring]]
name = "belt"
between = ["table", "motor"]
stiffness = 9.0e4
[[damper]]
name = "belt"
between = ["table", "motor"]
damping = 120.0
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::from_toml(MODEL)?;
    let parameters = model.parameters();
    for pole in model.pole_sensitivities(&model.equilibrium()?)? {
        println!(
            "{:.3} Hz, damping ratio {:.4}",
            pole.natural_freq_hz(),
            pole.damping_ratio()
        );
        for (place, parameter) in parameters.iter().enumerate() {
            let value = model.parameter_value(*parameter).unwrap_or(0.0);
            if let Some([freq, _]) = pole.freq_and_damping_derivative(place) {
                let share = value * freq / pole.natural_freq_hz();
                println!("  {}: {share:.3} % per %", model.parameter_name(*parameter));
            }
        }
    }
    Ok(())
}
