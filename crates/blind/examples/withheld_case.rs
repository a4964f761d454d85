//! One generated case, and what is withheld of it: `cargo run -p simgap-blind --example withheld_case`.
#![allow(clippy::print_stdout)]

use simgap_blind::{Level, Recipe, generate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = generate(
        1,
        3,
        &Recipe::Kind("coulomb_friction".into()),
        Level::Standard,
    )?;
    println!("model: {}", case.model.name);
    for record in case.train.iter().chain(&case.check) {
        println!("record {}: {} samples", record.name(), record.len());
    }
    for effect in &case.truth.effects {
        println!("withheld: {} at {:?}", effect.kind, effect.at);
    }
    Ok(())
}
