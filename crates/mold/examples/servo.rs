//! The mold on two servo cylinders: its poles with the loops closed, how it follows a set point, and how stiff the drives are.
//!
//! ```sh
//! cargo run -p simgap-mold --example servo
//! ```
#![allow(clippy::print_stdout)]

use simgap_mold::{OneDof, ServoDrive, ServoMold};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mass = OneDof::published()?.mass_kg();
    let drives = [ServoDrive::assumed(-1.5), ServoDrive::assumed(1.5)];
    let mold = ServoMold::new([mass, 19_000.0], [0.0, 3.0e5], drives)?;
    for mode in mold.modes()? {
        println!(
            "pole {:9.2} {:+9.2}i 1/s",
            mode.eigenvalue.re, mode.eigenvalue.im
        );
    }
    println!(
        "oil with the valves shut: {:.2} GN/m",
        1e-9 * mold.oil_stiffness()
    );
    for freq in [0.1, 1.0, 2.5, 7.0, 47.0] {
        let (follows, stiff) = (
            mold.response_to_set_point(freq)?[0],
            mold.drive_stiffness(freq)?,
        );
        println!(
            "{freq:4} Hz: follows {:.3} of the set point, drives {:.0} MN/m",
            follows.norm(),
            1e-6 * stiff.norm()
        );
    }
    // The same machine as a model file for `simgap simulate` and `simgap diagnose`.
    let file = mold.model()?.to_toml()?;
    println!("a model file of {} lines", file.lines().count());
    Ok(())
}
