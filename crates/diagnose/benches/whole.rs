//! One whole diagnosis: full catalogue, two masses, two outputs, two records to learn from and one to judge
//! by, 15 s and 60 s each at 1 kHz.
//!
//! `cargo bench -p simgap-diagnose`; from the two lengths is seen how the time grows. The goal is 5 s for
//! the longer on two cores. Screening and the refinement of one candidate are benchmarks of `simgap-estimate`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "../tests/common/mod.rs"]
#[allow(dead_code)]
mod common;

use common::{ground, placed, plant, record};
use simgap_diagnose::{Request, diagnose};
use simgap_record::Record;

#[divan::bench(args = [15_000, 60_000], sample_count = 3, sample_size = 1)]
fn whole_diagnosis(bencher: divan::Bencher<'_, '_>, rows: usize) {
    let truth = [placed("coulomb_friction", ground(), &[1.5])];
    let model = plant();
    let of_number = |k| record(&model, &truth, k, rows, 1e-3, 0.0);
    let records: Vec<Record> = (1..4).map(of_number).collect();
    let request = Request::new(&model, &records[..2], &records[2..]);
    bencher.bench_local(|| diagnose(&request, &|_| {}).unwrap());
}

fn main() {
    divan::main();
}
