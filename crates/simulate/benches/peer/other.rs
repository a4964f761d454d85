//! The other side: a process that is asked line by line.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

pub(crate) struct Other {
    process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Other {
    /// Starts `peer.py` in an interpreter.
    pub(crate) fn new(python: OsString) -> Other {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peer/peer.py");
        let mut process = Command::new(python)
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let to = process.stdin.take().unwrap();
        let from = BufReader::new(process.stdout.take().unwrap());
        Other { process, to, from }
    }

    /// Nanoseconds per sample and set, and the last output of each set; `None` for what is not offered.
    pub(crate) fn ask(
        &mut self,
        method: &str,
        plant: &str,
        sets: usize,
    ) -> Option<(f64, Vec<f64>)> {
        writeln!(self.to, "{method} {plant} {sets}").unwrap();
        let mut line = String::new();
        self.from.read_line(&mut line).unwrap();
        let mut numbers = line.split_whitespace().map(|word| word.parse().unwrap());
        Some((numbers.next()?, numbers.collect()))
    }
}

impl Drop for Other {
    fn drop(&mut self) {
        // Its input ends: it leaves by itself, or is made to.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
