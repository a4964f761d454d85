//! Natural frequencies of the mold on four leaf springs, each a beam of its own thickness.
//!
//! ```sh
//! cargo run -p simgap-mold --example leaf_springs
//! ```
#![allow(clippy::print_stdout)]

use simgap_mold::{BeamEnds, LeafSpring, MoldOnLeaves};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let leaves = [9.8e-3, 9.95e-3, 10.0e-3, 10.1e-3]
        .map(|thickness| LeafSpring::steel(1.06, 0.2, thickness));
    let leaves = leaves.into_iter().collect::<Result<Vec<_>, _>>()?;
    for leaf in &leaves {
        println!(
            "{:.2} mm thick, clamped: {:.2} Hz",
            1e3 * leaf.thickness_m(),
            leaf.natural_freq_hz(BeamEnds::Clamped, 1)?
        );
    }
    let mold = MoldOnLeaves::new(33_000.0, 8_287_639.0, leaves)?;
    for freq in mold.natural_freqs_hz()?.iter().take(9) {
        println!("mode at {freq:.2} Hz");
    }
    Ok(())
}
