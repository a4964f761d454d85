//! Forward simulation, ns per sample.
fn main() {
    divan::main();
}
