//! Eq. (1) with k_leaf beside k_add and a moving end of the leaf spring, and Eq. (4) with its three dampers.
//!
//! ```sh
//! cargo run -p simgap-mold --example damping_and_split
//! ```
#![allow(clippy::print_stdout)]

use simgap_model::damped_modes;
use simgap_mold::{LeafEnd, OneDof, TwoDof};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mold = OneDof::published()?
        .with_damping(147_000.0)?
        .with_leaf(1.2e5, LeafEnd::Moving)?;
    println!("{}", mold.model()?.to_toml()?);
    let support = TwoDof::published(1.0)?.with_damping([2.0e4, 1.0e3, 5.0e3])?;
    for mode in damped_modes(&support.model()?.matrices()?)? {
        println!(
            "{:.2} Hz, damping ratio {:.5}",
            mode.natural_freq_hz, mode.damping_ratio
        );
    }
    Ok(())
}
