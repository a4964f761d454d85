//! Mass and stiffness matrix of the mold on its flexible support, and its two modes.
//!
//! ```sh
//! cargo run -p simgap-mold --example matrices
//! ```
#![allow(clippy::print_stdout)]

use simgap_mold::TwoDof;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Table 5 as printed, row of the excitation at 1 Hz.
    let mold = TwoDof::published(1.0)?;
    let matrices = mold.model()?.matrices()?;
    println!("M [kg]  {:?}", matrices.mass_matrix);
    println!("K [N/m] {:?}", matrices.stiffness_matrix);
    let [lower, upper] = mold.modes_hz()?;
    println!("modes at {lower:.2} Hz and {upper:.2} Hz");
    Ok(())
}
