//! A chart of a long record against one look at each of its samples.

use divan::{Bencher, counter::ItemsCount};
use simgap_report::chart::{LineChart, Role, Series};

const LENGTHS: [usize; 2] = [100_000, 1_000_000];

fn main() {
    divan::main();
}

fn record(len: usize) -> (Vec<f64>, Vec<f64>) {
    let time_s = (0..len).map(|k| k as f64 * 1e-3);
    let wave = |t: f64| (9.0 * t).sin() + 0.3 * (50.0 * t).cos();
    time_s.map(|t| (t, wave(t))).unzip()
}

#[divan::bench(args = LENGTHS, sample_count = 5)]
fn line_chart(bencher: Bencher, len: usize) {
    let (time_s, values) = record(len);
    bencher.counter(ItemsCount::new(len)).bench_local(|| {
        LineChart::new("record", "time [s]", "y [m]")
            .with(Series::new("measured", Role::Measured, &time_s, &values))
            .to_svg()
    });
}

/// The least that any chart must do.
#[divan::bench(args = LENGTHS, sample_count = 5)]
fn range_of_the_samples(bencher: Bencher, len: usize) {
    let (_, values) = record(len);
    bencher.counter(ItemsCount::new(len)).bench_local(|| {
        let values = divan::black_box(&values).iter();
        values.fold([f64::MAX, f64::MIN], |[low, high], v| {
            [low.min(*v), high.max(*v)]
        })
    });
}
