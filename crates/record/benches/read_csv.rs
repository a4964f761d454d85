//! Speed of reading, checking and writing, in rows and bytes per second.
#![allow(clippy::unwrap_used)]

use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use simgap_record::{parse_csv, quality, write_csv_atomic};

const ROWS: usize = 100_000;

fn main() {
    divan::main();
}

/// Columns with the digits of a measured record: a rounded one, a full double, a small one.
fn columns(rows: usize) -> Vec<Vec<f64>> {
    let time = (0..rows).map(|k| k as f64 * 1e-3);
    let rounded = (0..rows).map(|k| ((0.37 * k as f64).sin() * 1e6).round() / 1e4);
    let full = (0..rows).map(|k| (0.011 * k as f64).sin());
    let small = (0..rows).map(|k| 1e-5 * (0.029 * k as f64).cos());
    vec![
        time.collect(),
        rounded.collect(),
        full.collect(),
        small.collect(),
    ]
}

fn headers() -> Vec<String> {
    ["t [s]", "u [N]", "y1 [m]", "y2 [m]"]
        .map(String::from)
        .to_vec()
}

fn text(rows: usize) -> Vec<u8> {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.csv");
    let columns = columns(rows);
    let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    write_csv_atomic(&path, &headers(), &views).unwrap();
    std::fs::read(path).unwrap()
}

#[divan::bench(sample_count = 20)]
fn read_bytes(bencher: Bencher) {
    let text = text(ROWS);
    bencher
        .counter(BytesCount::new(text.len()))
        .bench(|| parse_csv("A.csv", divan::black_box(&text[..])).unwrap());
}

#[divan::bench(sample_count = 20)]
fn read_rows(bencher: Bencher) {
    let text = text(ROWS);
    bencher
        .counter(ItemsCount::new(ROWS))
        .bench(|| parse_csv("A.csv", divan::black_box(&text[..])).unwrap());
}

#[divan::bench(sample_count = 10)]
fn write_rows(bencher: Bencher) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.csv");
    let columns = columns(ROWS);
    let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    bencher
        .counter(ItemsCount::new(ROWS))
        .bench(|| write_csv_atomic(&path, &headers(), &views).unwrap());
}

#[divan::bench(sample_count = 10)]
fn check_quality(bencher: Bencher) {
    let record = parse_csv("A.csv", &text(ROWS)[..]).unwrap();
    bencher
        .counter(ItemsCount::new(ROWS))
        .bench(|| quality(divan::black_box(&record)));
}
