//! The files of one generated machine, and what is withheld of it: `cargo run -p simgap-rigs --example generated_machine`.
#![allow(clippy::print_stdout)]

use simgap_rigs::{Filter, draw_case};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = draw_case(1, 0, &Filter::default())?;
    for (name, text) in &case.files {
        println!("{}/{name}: {} lines", case.name, text.lines().count());
    }
    println!("withheld: {}", serde_json::to_string(&case.truth)?);
    Ok(())
}
