//! `simgap init`: every template is a model file, filled in from a record it can be simulated with
//! it, and nothing is overwritten unasked.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{Bench, columns, record};

const LIKE: [&str; 4] = ["oscillator", "two-mass", "base", "axis"];

/// A record of the given columns, every one a wave of its own.
fn waves(header: &str) -> String {
    let columns = header.split(',').count();
    let mut text = format!("{header}\n");
    for k in 0..50 {
        let cell = |c: usize| match c {
            0 => format!("{:.2}", 0.01 * f64::from(k)),
            c => format!("{:.6}", (0.1 * f64::from(k) * c as f64).sin()),
        };
        let row: Vec<String> = (0..columns).map(cell).collect();
        text += &(row.join(",") + "\n");
    }
    text
}

#[test]
fn regress_templates() {
    let bench = Bench::new();
    let all = LIKE.map(|like| bench.done(&["init", "--like", like]));
    insta::assert_snapshot!(all.join("\n========\n\n"));
}

/// Columns are guessed from units and names, and the file goes with the record at once.
#[test]
fn regress_guesses() {
    let headers = [
        "t [s],u [N],y [m]",
        "t [s],T [degC],F_drive [kN],F_table [kN],q [mm],v [m/s]",
        "t [s],u_motor [V],angle [deg]",
        "t [s],x_floor [mm],x_machine [mm]",
        "t [s],p [bar],acc [g]",
    ];
    let mut told = String::new();
    for header in headers {
        let bench = Bench::new();
        bench.write("A.csv", waves(header));
        let arguments = ["init", "--record", "A.csv", "--out", "model.toml"];
        told += &format!("==== {header}\n{}\n", bench.done(&arguments));
        let model = bench.read("model.toml");
        let keys = model.lines().filter(|l| {
            ["channel", "kind", "at", "gain"]
                .iter()
                .any(|key| l.starts_with(key))
        });
        told += &(keys.collect::<Vec<_>>().join("\n") + "\n\n");
        bench.done(&[
            "simulate",
            "model.toml",
            "--record",
            "A.csv",
            "--out",
            "p.csv",
        ]);
        let (_, cells) = columns(&bench.read("p.csv"));
        assert_eq!(cells[0].len(), 50);
    }
    insta::assert_snapshot!(told);
}

/// Whatever the template, a record whose columns fit is simulated with it.
#[test]
fn verify_every_template_goes_with_a_record() {
    let bench = Bench::new();
    bench.write("A.csv", waves("t [s],u [N],base [m],y1 [m],y2 [m]"));
    for like in LIKE {
        let arguments = [
            "init", "--like", like, "--record", "A.csv", "--out", "m.toml", "--force",
        ];
        bench.done(&arguments);
        bench.done(&["simulate", "m.toml", "--record", "A.csv", "--out", "p.csv"]);
    }
}

#[test]
fn verify_names_of_any_kind_are_written_and_read() {
    let bench = Bench::new();
    bench.write(
        "A.csv",
        waves("t [s],\"a \"\"force\"\" \\ u [N]\",y = 'left' # [m]"),
    );
    bench.done(&["init", "--record", "A.csv", "--out", "m.toml"]);
    bench.done(&["simulate", "m.toml", "--record", "A.csv", "--out", "p.csv"]);
}

#[test]
fn regress_what_is_not_overwritten() {
    let bench = Bench::good();
    let line = bench.refused(&["init", "--out", "model.toml"]);
    bench.done(&["init", "--out", "model.toml", "--force"]);
    let over = ["init", "--record", "A.csv", "--out", "A.csv", "--force"];
    let lines = [
        line,
        bench.refused(&over),
        bench.refused(&["init", "--record", "B.csv"]),
    ];
    bench.write("A.csv", record(3));
    let short = bench.refused(&["init", "--record", "A.csv"]);
    insta::assert_snapshot!(format!("{}\n{short}", lines.join("\n")));
}
