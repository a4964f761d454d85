//! The printed values of Table 5, with their places in the paper.
//!
//! ```sh
//! cargo run -p simgap-tables --example printed
//! ```
#![allow(clippy::print_stdout)]

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for row in &simgap_tables::table5()?.rows {
        println!(
            "{} Hz: k_leaf {} N/m ({})",
            row.excitation.printed(),
            row.leaf_stiffness.printed(),
            row.leaf_stiffness.source()
        );
    }
    Ok(())
}
