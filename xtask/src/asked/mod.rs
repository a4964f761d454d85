//! The program is asked in a process of its own, with a limit of time.

mod error;
mod kinds;
mod record;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use simgap_rigs::{Answer, Diagnosis};

pub use error::AskedError;
pub(crate) use error::{at, json};
pub(crate) use kinds::Kinds;
pub(crate) use record::write_record;

/// Longest time of a processor for one case, s: other work on the machine does not count.
const LIMIT_S: f64 = 120.0;
/// Longest time by the clock.
const LIMIT: Duration = Duration::from_secs(1200);
/// Ticks of a processor per second, as Linux tells them.
const TICKS_PER_S: f64 = 100.0;
/// How often the process is looked at.
const LOOK: Duration = Duration::from_millis(50);

/// How the program is asked.
#[derive(clap::Args, Debug)]
pub struct AskingArgs {
    /// Cases at a time
    #[arg(long, default_value_t = 2)]
    pub(crate) jobs: usize,
    /// The program that diagnoses
    #[arg(long, value_name = "FILE", default_value = "target/debug/simgap")]
    pub(crate) program: PathBuf,
    /// Score the answers that exist, ask for none
    #[arg(long)]
    pub(crate) score_only: bool,
}

/// A case that is asked about.
pub(crate) struct Asked<'a> {
    /// The program that diagnoses.
    pub(crate) program: &'a Path,
    /// model.toml, train-1.csv ..., check.csv.
    pub(crate) folder: &'a Path,
    /// Where the answer goes.
    pub(crate) out: &'a Path,
    /// Whether uneven records are resampled.
    pub(crate) mend: bool,
}

impl Asked<'_> {
    /// The answer: an old one where there is one, else the program is asked, unless only old ones count.
    pub(crate) fn answer(&self, only_old: bool) -> Result<Option<Answer>, AskedError> {
        let told = self.out.join("asked.json");
        if !told.exists() {
            if only_old {
                return Ok(None);
            }
            self.ask(&told)?;
        }
        let text = fs::read_to_string(&told).map_err(at(&told))?;
        let (seconds, failure): (f64, String) = parse(&told, &text)?;
        let path = self.out.join("diagnosis.json");
        let diagnosis: Option<Diagnosis> = match fs::read_to_string(&path) {
            Ok(text) => Some(parse(&path, &text)?),
            Err(_) => None,
        };
        Ok(Some(Answer {
            diagnosis,
            failure,
            seconds,
        }))
    }

    /// The answer, asked for anew whatever an earlier run left, unless only old ones count.
    pub(crate) fn answer_anew(&self, only_old: bool) -> Result<Option<Answer>, AskedError> {
        if !only_old {
            self.forget()?;
        }
        self.answer(only_old)
    }

    /// Forgets an old answer.
    fn forget(&self) -> Result<(), AskedError> {
        match self.out.exists() {
            true => fs::remove_dir_all(self.out).map_err(at(self.out)),
            false => Ok(()),
        }
    }

    fn ask(&self, told: &Path) -> Result<(), AskedError> {
        let Asked { out, folder, .. } = self;
        self.forget()?;
        fs::create_dir_all(out).map_err(at(out))?;
        let program = fs::canonicalize(self.program).map_err(at(self.program))?;
        let mut command = Command::new(program);
        command
            .arg("diagnose")
            .arg(folder.join("model.toml"))
            .args(["--format", "json", "--jobs", "1", "--out"])
            .arg(out);
        for record in training_records(folder)? {
            command.arg("--train").arg(record);
        }
        command.arg("--check").arg(folder.join("check.csv"));
        if self.mend {
            command.arg("--mend");
        }
        let errors = out.join("stderr.txt");
        let file = fs::File::create(&errors).map_err(at(&errors))?;
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(file);
        let start = Instant::now();
        let child = command.spawn().map_err(at(self.program))?;
        let mut used = None;
        let failure = wait(child, start, &mut used).unwrap_or_else(|| {
            let told = fs::read_to_string(&errors).unwrap_or_default();
            told.lines().last().unwrap_or("").to_owned()
        });
        let seconds = used.unwrap_or(start.elapsed().as_secs_f64());
        let text = serde_json::to_string(&(seconds, failure)).map_err(json(told))?;
        fs::write(told, text).map_err(at(told))
    }
}

/// The files `train-….csv` of a folder, by name.
pub(crate) fn training_records(folder: &Path) -> Result<Vec<PathBuf>, AskedError> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let path = entry.map_err(at(folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("train-") && name.ends_with(".csv") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

pub(crate) fn parse<T: serde::de::DeserializeOwned>(
    path: &Path,
    text: &str,
) -> Result<T, AskedError> {
    serde_json::from_str(text).map_err(json(path))
}

/// Time of a processor that a process has used, s, where the system tells it.
fn processor_time(process: u32) -> Option<f64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name may hold spaces; after it, the 12th and 13th field are ticks in the program and for it.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |i: usize| fields.get(i)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / TICKS_PER_S)
}

/// Waits for the end; what went wrong where a limit was reached.
fn wait(mut child: Child, start: Instant, used: &mut Option<f64>) -> Option<String> {
    loop {
        let now = processor_time(child.id()).filter(|s| *s > 0.0);
        *used = now.or(*used);
        match child.try_wait() {
            Ok(Some(_)) => return None,
            Ok(None) if start.elapsed() > LIMIT || used.is_some_and(|s| s > LIMIT_S) => {
                let _ = child.kill();
                let _ = child.wait();
                return Some(format!("no answer after {LIMIT_S} s"));
            }
            Ok(None) => std::thread::sleep(LOOK),
            Err(error) => return Some(error.to_string()),
        }
    }
}
