//! Room that `simgap check` takes for a long record.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![cfg(target_os = "linux")]

mod common;

use std::fmt::Write as _;
use std::process::{Command, Stdio};

use common::Bench;

/// 5e6 rows of three columns are to fit into 400 MB; a fifth of both is tried here, in memory that is
/// reserved and not only used: 40 MB are for the program itself and its stacks.
const ROWS: usize = 1_000_000;
const MOST_KB: usize = 400_000 / 5 + 40_000;

#[test]
fn verify_a_long_record_is_checked_in_little_memory() {
    let bench = Bench::good();
    let mut text = String::from("t [s],u [N],y [mm]\n");
    for k in 0..ROWS {
        let t = k as f64 * 1e-3;
        writeln!(text, "{t:.3},{:.6},{:.6}", (7.0 * t).sin(), (3.0 * t).cos()).unwrap();
    }
    bench.write("long.csv", text);
    let program = env!("CARGO_BIN_EXE_simgap");
    let check = |most_kb: usize| {
        let mut shell = Command::new("sh");
        let line = format!("ulimit -c 0; ulimit -v {most_kb}; exec {program} check long.csv");
        shell.args(["-c", &line]).current_dir(bench.path(""));
        shell.stdin(Stdio::null()).output().unwrap()
    };
    let output = check(MOST_KB);
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        told.contains("1000000 samples from 0 s to 1000 s"),
        "{told}"
    );
    // The limit is one.
    assert!(!check(MOST_KB / 4).status.success());
}
