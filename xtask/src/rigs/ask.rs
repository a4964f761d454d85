//! The program is asked in a process of its own, with a limit of time.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use simgap_rigs::{Answer, Diagnosis};

use super::error::at;
use super::{Args, RigsError};

/// Longest time of a processor for one case, s: other work on the machine does not count.
const LIMIT_S: f64 = 120.0;
/// Longest time by the clock.
const LIMIT: Duration = Duration::from_secs(1200);
/// Ticks of a processor per second, as Linux tells them.
const TICKS_PER_S: f64 = 100.0;
/// How often the process is looked at.
const LOOK: Duration = Duration::from_millis(50);

/// The answer of a case: an old one where there is one, else the program is asked.
pub(super) fn answer(args: &Args, folder: &Path, name: &str) -> Result<Option<Answer>, RigsError> {
    let out = args.out.join("answers").join(name);
    let told = out.join("asked.json");
    if !told.exists() {
        if args.score_only {
            return Ok(None);
        }
        ask(args, folder, name, &out)?;
    }
    let text = fs::read_to_string(&told).map_err(at(&told))?;
    let asked: (f64, String) = parse(&told, &text)?;
    let path = out.join("diagnosis.json");
    let diagnosis: Option<Diagnosis> = match fs::read_to_string(&path) {
        Ok(text) => Some(parse(&path, &text)?),
        Err(_) => None,
    };
    Ok(Some(Answer {
        diagnosis,
        failure: asked.1,
        seconds: asked.0,
    }))
}

fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, RigsError> {
    serde_json::from_str(text).map_err(|source| RigsError::Json {
        path: path.display().to_string(),
        source,
    })
}

fn ask(args: &Args, folder: &Path, name: &str, out: &Path) -> Result<(), RigsError> {
    if out.exists() {
        fs::remove_dir_all(out).map_err(at(out))?;
    }
    fs::create_dir_all(out).map_err(at(out))?;
    let program = fs::canonicalize(&args.program).map_err(at(&args.program))?;
    let mut command = Command::new(program);
    command.current_dir(folder).args(["diagnose", "model.toml"]);
    for number in 1..=3 {
        let file = format!("train-{number}.csv");
        if folder.join(&file).exists() {
            command.args(["--train", &file]);
        }
    }
    let errors = out.join("stderr.txt");
    let file = fs::File::create(&errors).map_err(at(&errors))?;
    command
        .args(["--check", "check.csv", "--out"])
        .arg(format!("../../answers/{name}"))
        .args(["--format", "json", "--jobs", "1"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(file);
    let start = Instant::now();
    let child = command.spawn().map_err(at(&args.program))?;
    let mut used = None;
    let failure = wait(child, start, &mut used).unwrap_or_else(|| {
        let told = fs::read_to_string(&errors).unwrap_or_default();
        told.lines().last().unwrap_or("").to_owned()
    });
    let seconds = used.unwrap_or(start.elapsed().as_secs_f64());
    let asked = (seconds, failure);
    let told = out.join("asked.json");
    let text = serde_json::to_string(&asked).map_err(|source| RigsError::Json {
        path: told.display().to_string(),
        source,
    })?;
    fs::write(&told, text).map_err(at(&told))
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
