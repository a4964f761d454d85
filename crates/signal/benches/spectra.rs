//! Welch's method against the bare transform of the same data.

use divan::{Bencher, counter::ItemsCount};
use rustfft::{FftPlanner, num_complex::Complex64};
use simgap_signal::welch::{WelchOptions, welch};
use simgap_signal::{Trend, Window, spectrum::periodogram};

const LENGTHS: [usize; 3] = [100_000, 1_000_000, 10_000_000];

fn main() {
    divan::main();
}

fn record(len: usize) -> Vec<f64> {
    (0..len)
        .map(|n| (0.1 * n as f64).sin() + ((n * 7919) % 1009) as f64 * 1e-3)
        .collect()
}

/// Hann window, 4096 samples a segment, half overlap.
#[divan::bench(args = LENGTHS, sample_count = 5)]
fn welch_4096(bencher: Bencher, len: usize) {
    let values = record(len);
    bencher
        .counter(ItemsCount::new(len))
        .bench_local(|| welch(divan::black_box(&values), 1000.0, &WelchOptions::new(4096)));
}

/// The whole record at once, in place, complex.
#[divan::bench(args = LENGTHS, sample_count = 5)]
fn bare_fft(bencher: Bencher, len: usize) {
    let values = record(len);
    let fft = FftPlanner::new().plan_fft_forward(len);
    bencher
        .counter(ItemsCount::new(len))
        .with_inputs(|| {
            values
                .iter()
                .map(|&v| Complex64::new(v, 0.0))
                .collect::<Vec<_>>()
        })
        .bench_local_values(|mut z| {
            fft.process(&mut z);
            z
        });
}

/// The whole record through this crate: window, trend, real transform, density.
#[divan::bench(args = LENGTHS, sample_count = 5)]
fn whole_periodogram(bencher: Bencher, len: usize) {
    let values = record(len);
    bencher
        .counter(ItemsCount::new(len))
        .bench_local(|| periodogram(divan::black_box(&values), 1000.0, Window::Hann, Trend::Mean));
}
