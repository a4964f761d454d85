//! Shared by the integration tests: a bench of files, the program run on it, records made here.
#![allow(dead_code, unreachable_pub)]

pub mod schema;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// One mass on a spring and a damper, driven by a force.
pub const MODEL: &str = r#"schema = "simgap-model/1"
name = "oscillator"

[[mass]]
name = "block"
value = 2.0

[[spring]]
name = "rod"
between = ["block", "ground"]
stiffness = 800.0

[[damper]]
name = "rod"
between = ["block", "ground"]
damping = 4.0

[[input]]
channel = "u"
kind = "force"
at = "block"

[[output]]
channel = "y"
kind = "displacement"
at = "block"
"#;

/// A folder that vanishes with the test.
pub struct Bench {
    dir: TempDir,
}

impl Bench {
    pub fn new() -> Bench {
        Bench {
            dir: TempDir::new().unwrap(),
        }
    }

    /// A bench with a good `model.toml` and a good `A.csv`.
    pub fn good() -> Bench {
        let bench = Bench::new();
        bench.write("model.toml", MODEL);
        bench.write("A.csv", record(60));
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// The program in this folder.
    pub fn simgap(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_simgap"));
        command
            .args(args)
            .current_dir(self.dir.path())
            .stdin(Stdio::null());
        command
    }

    pub fn run(&self, args: &[&str]) -> Output {
        self.simgap(args).output().unwrap()
    }

    /// Runs what must succeed, and gives its stdout.
    pub fn done(&self, args: &[&str]) -> String {
        let output = self.run(args);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(
            output.status.code(),
            Some(0),
            "{args:?}\nstdout: {out}\nstderr: {err}"
        );
        assert_eq!(
            err, "",
            "{args:?}: nothing belongs on stderr off a terminal"
        );
        out
    }

    /// Runs what must be refused, checks all the contract promises of a refusal, and gives the
    /// line.
    pub fn refused(&self, args: &[&str]) -> String {
        self.refused_command(self.simgap(args))
    }

    pub fn refused_command(&self, mut command: Command) -> String {
        let before = self.everything();
        let output = command.output().unwrap();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        let told = format!("{command:?}\nstdout: {out}\nstderr: {err}");
        assert_eq!(output.status.code(), Some(2), "exit status of {told}");
        assert_eq!(out, "", "stdout of {told}");
        let line = err.strip_suffix('\n').expect("a line ends");
        assert!(!line.contains(['\n', '\r']), "one line: {told}");
        let line = line.strip_prefix("simgap: ").expect("the program's name");
        assert_eq!(self.everything(), before, "something was written: {told}");
        line.replace(&self.dir.path().display().to_string(), "[dir]")
    }

    /// Every file of the folder with its bytes, every folder.
    pub fn everything(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        collect(self.dir.path(), self.dir.path(), &mut found);
        found
    }

    /// The files in a folder of the bench with their bytes.
    pub fn files(&self, name: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        let root = self.path(name);
        collect(&root, &root, &mut found);
        found
    }
}

fn collect(root: &Path, folder: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.strip_prefix(root).unwrap().to_path_buf();
        if path.is_dir() {
            found.insert(name, vec![]);
            collect(root, &path, found);
        } else {
            found.insert(name, std::fs::read(&path).unwrap());
        }
    }
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A record of the oscillator at 100 Hz: any motion will do where only reading is tested.
pub fn record(rows: usize) -> String {
    let mut text = String::from("t [s],u [N],y [m]\n");
    for k in 0..rows {
        let t = k as f64 * 0.01;
        let (u, y) = (8.0 * (9.0 * t).sin(), 0.01 * (9.0 * t).sin());
        writeln!(text, "{t:.2},{u:.6},{y:.8}").unwrap();
    }
    text
}

/// A CSV file as header names and columns.
pub fn columns(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header: Vec<String> = lines
        .next()
        .unwrap()
        .split(',')
        .map(str::to_string)
        .collect();
    let mut columns = vec![Vec::new(); header.len()];
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), header.len(), "{line}");
        for (column, cell) in columns.iter_mut().zip(cells) {
            column.push(cell.parse().unwrap());
        }
    }
    (header, columns)
}

/// Root mean square.
pub fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    f64::sqrt(sum / count)
}

/// Standard deviation about the mean, as the contract's nrmse divides by.
pub fn std_dev(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    rms(values.iter().map(|v| v - mean))
}
