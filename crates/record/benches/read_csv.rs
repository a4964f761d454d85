//! Reading speed; see the crate's tests for correctness.

fn main() {
    divan::main();
}
