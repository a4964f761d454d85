//! The same equations here, in numba and in SciPy, 60 s at 1 kHz, by turns in one run.
//!
//! ```sh
//! python3 -m venv venv && venv/bin/pip install numba scipy
//! SIMGAP_PEER=$PWD/venv/bin/python cargo bench -p simgap-simulate --bench peer
//! ```
//!
//! The other side is `peer.py` beside this file, asked line by line. Without `SIMGAP_PEER` only ours is measured. Both sides
//! write down one output at every sample. What is printed are shortest times; the README holds a run.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../axis/mod.rs"]
mod axis;
mod lumped;
mod other;
#[path = "../turns/sets.rs"]
mod sets;

use std::time::Instant;

use other::Other;
use sets::SAMPLES;

/// Rounds in which every row is measured once.
const ROUNDS: usize = 15;

/// SciPy's calls take seconds.
const ROUNDS_OF_SCIPY: usize = 3;

/// How the other side computes.
const METHODS: [&str; 3] = ["numba", "numba_sets", "scipy"];

/// A plant, how many sets of it, and what calls it: the last output of each set.
struct Row {
    plant: &'static str,
    sets: usize,
    ours: Box<dyn Fn() -> Vec<f64>>,
}

fn rows() -> Vec<Row> {
    let row = |plant, sets, ours| Row { plant, sets, ours };
    let each = |sets| {
        [
            row("linear", sets, lumped::linear(sets)),
            row("friction", sets, lumped::friction(sets)),
            row("axis", sets, ours_of_axis(sets)),
        ]
    };
    [1, 8].into_iter().flat_map(each).collect()
}

fn ours_of_axis(sets: usize) -> Box<dyn Fn() -> Vec<f64>> {
    let run = sets::run(axis::AMPLITUDE);
    let plants: Vec<_> = (0..sets)
        .map(|k| axis::set(k as f64 / sets as f64))
        .collect();
    Box::new(move || {
        let found = simgap_simulate::predict_all(&sets::jobs(&plants, &run));
        let last = |outputs: &Vec<Vec<f64>>| outputs[0].last().copied();
        found.iter().flatten().filter_map(last).collect()
    })
}

/// The shortest: others on the machine only add to it.
fn shortest(values: Vec<f64>) -> Option<f64> {
    values.into_iter().min_by(f64::total_cmp)
}

fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let names = told.lines().filter(|line| line.starts_with("model name"));
    let name = names.filter_map(|line| line.split(": ").nth(1)).next();
    name.unwrap_or("not told").to_owned()
}

fn main() {
    let mut other = std::env::var_os("SIMGAP_PEER").map(Other::new);
    println!("processor: {}", processor());
    println!("| plant | sets | ours, ns | numba, ns | ratio | SciPy, ns | off |");
    println!("|---|---|---|---|---|---|---|");
    for row in rows() {
        let mut ours = vec![];
        let mut theirs = METHODS.map(|_| vec![]);
        let mut off: f64 = 0.0;
        let mut last = (row.ours)();
        for round in 0..ROUNDS {
            let begun = Instant::now();
            last = divan::black_box((row.ours)());
            let ns = begun.elapsed().as_secs_f64() * 1e9;
            ours.push(ns / (SAMPLES * row.sets) as f64);
            for (k, method) in METHODS.iter().enumerate() {
                let skipped = *method == "scipy" && round >= ROUNDS_OF_SCIPY;
                let asked = other.as_mut().filter(|_| !skipped);
                let Some((ns, found)) = asked.and_then(|o| o.ask(method, row.plant, row.sets))
                else {
                    continue;
                };
                theirs[k].push(ns);
                if *method != "scipy" {
                    let each = last.iter().zip(&found);
                    let size = last
                        .iter()
                        .fold(0.0_f64, |size, value| size.max(value.abs()));
                    off = each.fold(off, |off, (a, b)| off.max((a - b).abs() / size));
                }
            }
        }
        drop(last);
        let [one_by_one, side_by_side, scipy] = theirs.map(shortest);
        // Whichever of the two is faster is what numba needs.
        let numba = match (one_by_one, side_by_side) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        let ours = shortest(ours).unwrap_or(f64::NAN);
        let told = |value: Option<f64>| value.map_or("-".into(), |v| format!("{v:.3}"));
        println!(
            "| {} | {} | {ours:.3} | {} | {} | {} | {off:.0e} |",
            row.plant,
            row.sets,
            told(numba),
            told(numba.map(|n| n / ours)),
            told(scipy)
        );
    }
}
