//! Heave and roll of the mold on a left and a right cylinder, and what a mismatch of the two does at 5 Hz.
//!
//! ```sh
//! cargo run -p simgap-mold --example heave_roll
//! ```
#![allow(clippy::print_stdout)]

use simgap_mold::{HeaveRoll, OneDof};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mold = OneDof::published()?;
    let total = [mold.stiffness(), mold.damping()];
    // Cylinders at 1.98 times the radius of gyration put the roll at 5 Hz.
    let machine = HeaveRoll::symmetric(mold.mass_kg(), 1.0, total, 1.98)?;
    println!(
        "heave {:.2} Hz, roll {:.2} Hz",
        machine.heave_freq_hz(),
        machine.roll_freq_hz()
    );
    for share in [0.1, 0.3, 0.9] {
        let force = machine.with_mismatch(share)?.unknown_force_per_heave(5.0)?;
        println!(
            "left cylinder {:.0} % stiffer: {:.2} kN peak to peak at 2 mm",
            100.0 * share,
            2e-3 * 2e-3 * force.norm()
        );
    }
    Ok(())
}
