//! A hydraulic axis of ten states against plants of two masses, 60 s at 1 kHz.
//!
//! `cargo bench -p simgap-simulate --bench servo`; the items counted are samples times sets. The two masses are linear, or have
//! dry friction and a cubic spring.
//!
//! What the axis costs beside the others is printed first ([`turns`]).
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod axis;
mod turns;

use divan::counter::ItemsCount;
use simgap_effects::{Placed, find};
use simgap_model::{Location, Model};
use simgap_simulate::{Simulator, predict_all};
use turns::nanoseconds;
use turns::sets::{SAMPLES, jobs, run};

const TWO_MASSES: &str = r#"schema = "simgap-model/1"
name = "two masses"
[[mass]]
name = "table"
value = 1.0
[[mass]]
name = "arm"
value = 0.5
[[spring]]
name = "a"
between = ["table", "ground"]
stiffness = 900.0
[[damper]]
name = "a"
between = ["table", "ground"]
damping = 1.4
[[spring]]
name = "b"
between = ["arm", "table"]
stiffness = 900.0
[[damper]]
name = "b"
between = ["arm", "table"]
damping = 0.6
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "arm"
"#;

/// What is simulated.
#[derive(Debug, Clone, Copy)]
enum Plant {
    TwoMasses,
    TwoMassesFrictionAndCubic,
    ServoAxis,
}

use Plant::{ServoAxis, TwoMasses, TwoMassesFrictionAndCubic};

/// A set whose values are off by some per cent.
fn set(plant: Plant, share: f64) -> Simulator {
    let size = 1.0 + 0.05 * share;
    let between = |a: &str| Location::Between([a.into(), "ground".into()]);
    let place = |kind: &str, at: Location, value: f64| {
        Placed::new(find(kind).unwrap(), at, vec![value * size])
    };
    let (text, effects) = match plant {
        TwoMasses => (
            TWO_MASSES,
            vec![place("stiffness_error", between("table"), 1.0)],
        ),
        TwoMassesFrictionAndCubic => (
            TWO_MASSES,
            vec![
                place("coulomb_friction", between("table"), 1.5),
                place("cubic_stiffness", between("table"), 2e6),
            ],
        ),
        ServoAxis => return axis::set(share),
    };
    Simulator::new(&Model::from_toml(text).unwrap(), &effects, 1).unwrap()
}

fn amplitude(plant: Plant) -> f64 {
    match plant {
        ServoAxis => axis::AMPLITUDE,
        TwoMasses | TwoMassesFrictionAndCubic => 12.0,
    }
}

/// Prints what each plant costs per sample and set, and the axis over the others, for one set and for eight in lanes.
fn compared() {
    let plants = [TwoMasses, TwoMassesFrictionAndCubic, ServoAxis];
    for count in [1, 8] {
        let runs = plants.map(|plant| run(amplitude(plant)));
        let sets = plants.map(|plant| -> Vec<Simulator> {
            (0..count)
                .map(|k| set(plant, k as f64 / count as f64))
                .collect()
        });
        let ns = nanoseconds([0, 1, 2].map(|k| (&sets[k][..], &runs[k])));
        for (plant, ns) in plants.iter().zip(ns) {
            println!("{count} set(s), {plant:?}: {ns:.1} ns per sample and set");
        }
        println!(
            "{count} set(s): the axis costs {:.2} times the two masses, {:.2} times those with friction and a cubic spring",
            ns[2] / ns[0],
            ns[2] / ns[1]
        );
    }
}

#[divan::bench(args = [TwoMasses, TwoMassesFrictionAndCubic, ServoAxis], consts = [1, 8], sample_count = 10)]
fn sets<const SETS: usize>(bencher: divan::Bencher<'_, '_>, plant: Plant) {
    let run = run(amplitude(plant));
    let sets: Vec<Simulator> = (0..SETS)
        .map(|k| set(plant, k as f64 / SETS as f64))
        .collect();
    let jobs = jobs(&sets, &run);
    bencher
        .counter(ItemsCount::new(SAMPLES * SETS))
        .bench_local(|| predict_all(&jobs));
}

fn main() {
    compared();
    divan::main();
}
