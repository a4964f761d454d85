//! Writes a generated fleet of 20 machines over 25 days: `cargo run -p simgap-fleet --example generated_fleet -- DIR`.
//! Three machines with friction that grows, one with a spring that loosens, one day with a wrong sensor on all of them.
#![allow(missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os()
        .nth(1)
        .ok_or("needed is a folder to write to")?;
    common::Fleet::whole().write(std::path::Path::new(&folder))
}
