//! The simgap command line.

fn main() {}
