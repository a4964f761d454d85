//! A record made in memory, its channels and its rate.
//!
//! ```sh
//! cargo run -p simgap-record --example channels
//! ```
#![allow(clippy::print_stdout)]

use simgap_record::{Channel, Quantity, Record};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let time = (0..200).map(|n| 0.01 * f64::from(n));
    let y = time.map(|t| 2.0 * (6.0 * t).sin()).collect();
    let record = Record::from_uniform("run", 0.0, 0.01, vec![Channel::new("y", "mm", y)])?;
    for channel in record.channels() {
        println!(
            "{} at {} Hz, {} samples",
            channel.name,
            record.sample_rate_hz(),
            record.len()
        );
    }
    let metres = record.si_values("y", Quantity::Displacement)?;
    println!(
        "largest: {:.4} m",
        metres.iter().copied().fold(0.0, f64::max)
    );
    Ok(())
}
