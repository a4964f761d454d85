//! Samples that were missing and filled are no defect of the measurement chain.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fmt::Write as _;

use crate::common::{self, named, placed, plant, record};
use simgap_diagnose::{Request, diagnose};
use simgap_record::{Mend, ReadOptions, Record, parse_file};

const ROWS: usize = 1200;

/// A record of a machine as a file that lacks some samples of its displacement, read as one mends it.
fn mended(number: u64) -> Record {
    let friction = [placed("coulomb_friction", common::ground(), &[2.0])];
    let whole = record(&plant(), &friction, number, ROWS, 4e-3, 0.0);
    let mut text = String::from("t [s],u [N],spare [N],x [m],a [m/s^2]\n");
    let values = |name: &str| &whole.require(name).unwrap().values;
    for k in 0..ROWS {
        let lost = (13 * number as usize + k) % 40 < 3 && k > 10;
        let x = if lost {
            "nan".into()
        } else {
            format!("{:e}", values("x")[k])
        };
        let (t, u, a) = (whole.time_s()[k], values("u")[k], values("a")[k]);
        writeln!(text, "{t:.4},{u:e},0,{x},{a:e}").unwrap();
    }
    let options = ReadOptions::all().with_mend(Mend::Always);
    let name = format!("{number}.csv");
    parse_file(&name, text.as_bytes(), &options).unwrap().record
}

#[test]
fn verify_filled_samples_are_not_taken_for_lost_ones() {
    let records = [1, 2, 3].map(mended);
    assert!(
        records[0]
            .filled("x")
            .unwrap()
            .iter()
            .filter(|f| **f)
            .count()
            > 60
    );
    let model = plant();
    let request = Request::new(&model, &records[..2], &records[2..]);
    let outcome = diagnose(&request, &|_| {}).unwrap();
    let kinds: Vec<String> = named(&outcome).into_iter().map(|(kind, _)| kind).collect();
    assert_eq!(
        kinds,
        ["coulomb_friction"],
        "{:?}",
        outcome.diagnosis.verdict
    );
}
