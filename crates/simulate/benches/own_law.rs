//! Laws of the user's beside the laws of the catalogue that say the same, 60 s of one mass at 1 kHz.
//!
//! `cargo bench -p simgap-simulate --bench own_law`; the items counted are samples times sets. What a law as text costs beside
//! the compiled one is printed first ([`turns`]).
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod turns;

use divan::counter::ItemsCount;
use simgap_effects::{Placed, find_of};
use simgap_model::{Law, LawParameter, Location, Model};
use simgap_simulate::{Simulator, predict_all};
use turns::nanoseconds;
use turns::sets::{SAMPLES, jobs, run};

const MASS: &str = r#"schema = "simgap-model/1"
name = "mass"
[[mass]]
name = "table"
value = 1.0
[[spring]]
name = "a"
between = ["table", "ground"]
stiffness = 900.0
[[damper]]
name = "a"
between = ["table", "ground"]
damping = 1.4
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"#;

/// A law of the catalogue, and the same as text.
#[derive(Debug, Clone, Copy)]
struct Pair {
    kind: &'static str,
    force: &'static str,
    names: &'static [&'static str],
    values: &'static [f64],
}

const PAIRS: [Pair; 3] = [
    Pair {
        kind: "quadratic_damping",
        force: "c * v * abs(v)",
        names: &["c"],
        values: &[3.0],
    },
    Pair {
        kind: "cubic_stiffness",
        force: "k * d^3",
        names: &["k"],
        values: &[2e6],
    },
    Pair {
        kind: "position_periodic_force",
        force: "a * sin(2 * pi * d / p) + b * cos(2 * pi * d / p)",
        names: &["a", "b", "p"],
        values: &[1.0, 0.5, 0.01],
    },
];

/// N.
const AMPLITUDE: f64 = 12.0;

/// Sets whose values are off by some per cent.
fn sets(pair: Pair, is_text: bool, count: usize) -> Vec<Simulator> {
    let mut model = Model::from_toml(MASS).unwrap();
    let parameters = pair
        .names
        .iter()
        .map(|name| LawParameter::of_size(name, "1", 1.0));
    model.laws.push(Law {
        name: "own".into(),
        summary: None,
        between: vec![],
        force: pair.force.into(),
        parameters: parameters.collect(),
    });
    let effect = find_of(&model, if is_text { "own" } else { pair.kind }).unwrap();
    let set = |k: usize| {
        let size = 1.0 + 0.05 * k as f64 / count as f64;
        let at = Location::Between(["table".into(), "ground".into()]);
        let values = pair.values.iter().map(|value| value * size).collect();
        Simulator::new(&model, &[Placed::new(effect, at, values)], 1).unwrap()
    };
    (0..count).map(set).collect()
}

fn compared() {
    let run = run(AMPLITUDE);
    for pair in PAIRS {
        for count in [1, 8] {
            let both = [false, true].map(|is_text| sets(pair, is_text, count));
            let ns = nanoseconds([0, 1].map(|k| (&both[k][..], &run)));
            println!(
                "{count} set(s), {}: {:.1} ns per sample and set, as text {:.1} ns, {:.2} times",
                pair.kind,
                ns[0],
                ns[1],
                ns[1] / ns[0]
            );
        }
    }
}

#[divan::bench(args = [false, true], consts = [1, 8], sample_count = 10)]
fn quadratic<const SETS: usize>(bencher: divan::Bencher<'_, '_>, is_text: bool) {
    let (run, sets) = (run(AMPLITUDE), sets(PAIRS[0], is_text, SETS));
    let jobs = jobs(&sets, &run);
    bencher
        .counter(ItemsCount::new(SAMPLES * SETS))
        .bench_local(|| predict_all(&jobs));
}

fn main() {
    compared();
    divan::main();
}
