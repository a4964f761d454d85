//! `docs/tutorial.md`, `docs/hydraulics.md` and `docs/own-laws.md`, followed word by word: every command is run in a shell in a fresh folder, and
//! what the page shows is what is printed.
//!
//! `UPDATE_TUTORIAL=1 cargo test -p simgap-cli --test tutorial` writes into the pages what is printed;
//! read the sentences around it before you commit.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A line that stands for all further lines of an output.
const REST: &str = "...";
/// Numbers of more characters are not rounded for people: their last digits depend on the mathematics
/// library of the machine.
const ROUNDED_CHARS: usize = 8;
/// Such numbers are the same when they differ by less, relative.
const SAME: f64 = 1e-6;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A clone to follow the page in: the committed files, nothing of the working folder.
struct Reader {
    /// Vanishes with the reader.
    _dir: tempfile::TempDir,
    cwd: PathBuf,
}

impl Reader {
    fn new() -> Reader {
        let dir = tempfile::tempdir().unwrap();
        symlink(
            root().join("fixtures").canonicalize().unwrap(),
            dir.path().join("fixtures"),
        )
        .unwrap();
        let cwd = dir.path().to_owned();
        Reader { _dir: dir, cwd }
    }

    /// Runs a line as a shell would, with the program on the path; both streams as a terminal
    /// shows them.
    fn run(&mut self, line: &str) -> String {
        if let Some(folder) = line.strip_prefix("cd ") {
            self.cwd = self.cwd.join(folder);
            assert!(self.cwd.is_dir(), "{line}");
            return String::new();
        }
        let program = Path::new(env!("CARGO_BIN_EXE_simgap"));
        let path = format!(
            "{}:{}",
            program.parent().unwrap().display(),
            std::env::var("PATH").unwrap()
        );
        let output = Command::new("sh")
            .args(["-c", &format!("{line} 2>&1")])
            .current_dir(&self.cwd)
            .env("PATH", path)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{line}\n{text}");
        text
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.cwd.join(name), text).unwrap();
    }
}

/// The name of the file that a paragraph asks to save the next block as.
fn named_file(prose: &str) -> Option<&str> {
    let (_, rest) = prose.rsplit_once("ave this as `")?;
    Some(rest.split_once('`')?.0)
}

/// The lines of an output that a block shows: all, or as many as stand before `...`.
fn shown(printed: &str, was: &[&str]) -> Vec<String> {
    let lines = printed.lines().map(str::trim_end).map(str::to_owned);
    if was.last() == Some(&REST) {
        let mut few: Vec<String> = lines.take(was.len() - 1).collect();
        few.push(REST.to_owned());
        return few;
    }
    lines.collect()
}

/// A console block as it should be: each command with what it prints.
fn follow(block: &str, reader: &mut Reader) -> (String, usize) {
    let (mut text, mut commands) = (String::new(), 0);
    let lines: Vec<&str> = block.lines().collect();
    let mut at = 0;
    while at < lines.len() {
        let command = lines[at].strip_prefix("$ ").unwrap_or_else(|| {
            panic!("an output without a command: {}", lines[at]);
        });
        let next = lines[at + 1..].iter().position(|l| l.starts_with("$ "));
        let end = next.map_or(lines.len(), |n| at + 1 + n);
        text += &format!("$ {command}\n");
        for line in shown(&reader.run(command), &lines[at + 1..end]) {
            text += &line;
            text.push('\n');
        }
        (at, commands) = (end, commands + 1);
    }
    (text, commands)
}

/// The page as it should be, and how many commands it has.
fn followed(page: &str, reader: &mut Reader) -> (String, usize) {
    let (mut text, mut commands) = (String::new(), 0);
    let parts: Vec<&str> = page.split("```").collect();
    for (i, part) in parts.iter().enumerate() {
        if i > 0 {
            text += "```";
        }
        let block = (i % 2 == 1).then(|| part.split_once('\n').unwrap());
        match block {
            Some(("console", body)) => {
                let (body, count) = follow(body, reader);
                commands += count;
                text += &format!("console\n{body}");
            }
            Some(("toml", body)) => {
                let name = named_file(parts[i - 1]).unwrap_or_else(|| {
                    panic!("no file is named before this block:\n{body}");
                });
                keeps_what_is_there(&reader.cwd.join(name), body);
                reader.write(name, body);
                text += part;
            }
            // A formula.
            Some(("text", _)) => text += part,
            Some(("sh", body)) => {
                install(body);
                text += part;
            }
            Some((other, _)) => panic!("a block of {other:?} is not run"),
            None => text += part,
        }
    }
    (text, commands)
}

/// A file that a command of the page has written is edited, not replaced: what it says of channels
/// stays.
fn keeps_what_is_there(path: &Path, body: &str) {
    let Ok(there) = fs::read_to_string(path) else {
        return;
    };
    let keys = there
        .lines()
        .filter(|line| line.starts_with("channel") || line.starts_with("kind"));
    for line in keys {
        let key = line.split('#').next().unwrap().trim();
        assert!(body.contains(key), "{key} is not in\n{body}");
    }
}

/// Whether two lines say the same, all numbers in them to as many digits as are sure.
fn alike(one: &str, other: &str) -> bool {
    let parts = |line: &str| -> Vec<String> {
        let number = |c: char| c.is_ascii_digit() || c == '.';
        let mut parts: Vec<String> = vec![];
        let mut was = None;
        for c in line.chars() {
            if was.replace(number(c)) == Some(number(c)) {
                parts.last_mut().unwrap().push(c);
            } else {
                parts.push(c.into());
            }
        }
        parts
    };
    let (one, other) = (parts(one), parts(other));
    let same = |(a, b): (&String, &String)| {
        a == b
            || match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(x), Ok(y)) => {
                    a.len().min(b.len()) > ROUNDED_CHARS && (x - y).abs() < SAME * x.abs()
                }
                _ => false,
            }
    };
    one.len() == other.len() && one.iter().zip(&other).all(same)
}

#[test]
fn verify_only_digits_that_are_not_sure_may_differ() {
    assert!(alike(
        "value = 6.968777081666257",
        "value = 6.968777081666301"
    ));
    assert!(!alike(
        "value = 6.968777081666257",
        "value = 6.968797081666257"
    ));
    assert!(!alike("gap 0.450 of y", "gap 0.451 of y"));
    assert!(!alike("gap 0.450 of y", "gap 0.450 of z"));
    assert!(!alike("gap 0.450", "gap 0.450 of y"));
}

/// The one thing that a test cannot do: what is installed must be this program.
fn install(body: &str) {
    for line in body.lines() {
        let folder = line.strip_prefix("cargo install --path ").unwrap();
        let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml")).unwrap();
        assert!(manifest.contains("name = \"simgap\""), "{line}");
        assert!(root().join(folder).join("src/main.rs").exists(), "{line}");
    }
}

/// Follows a page of `docs` and compares it with what is printed, or writes it; the reader after its last command.
fn check_page(name: &str, least: usize, words: &[&str]) -> Reader {
    let path = root().join("docs").join(name);
    let page = fs::read_to_string(&path).unwrap();
    let mut reader = Reader::new();
    let (needed, commands) = followed(&page, &mut reader);
    assert!(commands >= least, "{commands} commands");
    for word in words {
        assert!(page.contains(&format!("\n$ simgap {word} ")), "{word}");
    }
    if std::env::var_os("UPDATE_TUTORIAL").is_some() {
        fs::write(&path, &needed).unwrap();
        return reader;
    }
    let (was, is): (Vec<&str>, Vec<&str>) = (page.lines().collect(), needed.lines().collect());
    let differs = was.iter().zip(&is).find(|(was, is)| !alike(was, is));
    assert!(
        differs.is_none() && was.len() == is.len(),
        "docs/{name} shows and the program prints: {differs:#?}\n\
         run UPDATE_TUTORIAL=1 cargo test -p simgap-cli --test tutorial, then read the page"
    );
    reader
}

#[test]
fn verify_the_tutorial_prints_what_it_shows() {
    let words = [
        "check", "init", "simulate", "compare", "diagnose", "effects",
    ];
    the_sentences_hold(&mut check_page("tutorial.md", 13, &words));
}

/// The machine has air in the oil of the left cylinder: 0.7 times the bulk modulus of the model.
#[test]
fn verify_the_page_on_hydraulics_prints_what_it_shows() {
    let words = [
        "modes",
        "sensitivity",
        "simulate",
        "compare",
        "diagnose",
        "effects",
    ];
    let reader = check_page("hydraulics.md", 10, &words);
    let answer = fs::read_to_string(reader.cwd.join("result/diagnosis.json")).unwrap();
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    let effect = &answer["verdict"]["effects"][0];
    assert_eq!(effect["kind"], "bulk_modulus");
    assert_eq!(effect["at"]["between"][0], "left.p1");
    let interval = &effect["parameters"][0]["ci95"];
    let [low, high] = [0, 1].map(|k| interval[k].as_f64().unwrap());
    assert!(low < 0.7 && 0.7 < high && high - low < 0.05, "{interval}");
}

/// The guide drags by 30 N tanh(v / 0.05 m/s) (1 + 6000 d²).
#[test]
fn verify_the_page_on_own_laws_prints_what_it_shows() {
    let reader = check_page("own-laws.md", 5, &["effects", "diagnose", "simulate"]);
    let answer = fs::read_to_string(reader.cwd.join("result/diagnosis.json")).unwrap();
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    let effect = &answer["verdict"]["effects"][0];
    assert_eq!(effect["kind"], "grease");
    for (place, truth) in [30.0, 0.05, 6000.0].into_iter().enumerate() {
        let parameter = &effect["parameters"][place];
        let off = parameter["value"].as_f64().unwrap() / truth - 1.0;
        assert!(off.abs() < 0.02, "{parameter}");
    }
    // The corrected model says what the diagnosis has said.
    let stored = |name: &str| fs::read_to_string(reader.cwd.join(name)).unwrap();
    let corrected = |text: &str, column: usize| -> Vec<f64> {
        let rows = text.lines().skip(1);
        let value = |row: &str| row.split(',').nth(column).unwrap().parse().unwrap();
        rows.map(value).collect()
    };
    let told = corrected(&stored("result/predictions/check.csv"), 3);
    let again = corrected(&stored("again.csv"), 1);
    assert_eq!(told.len(), again.len());
    // The bits of `simulate` are those of a file that was written and read.
    for (a, b) in told.iter().zip(&again) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

/// The README shows lines of what the demo prints; `...` stands for those between.
#[test]
fn verify_the_readme_shows_what_the_demo_prints() {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let (_, after) = page.split_once("--bin simgap -- demo\n```").unwrap();
    let block = after.split("```").nth(1).unwrap();
    let shown = block.lines().skip(1).filter(|line| *line != REST);
    let printed = Reader::new().run("simgap demo");
    let mut printed = printed.lines().map(str::trim_end);
    let mut count = 0;
    for line in shown {
        assert!(
            printed.any(|is| alike(line, is)),
            "README.md shows {line:?}"
        );
        count += 1;
    }
    assert!(count >= 4, "{count} lines");
}

/// What the sentences of the page lean on.
fn the_sentences_hold(reader: &mut Reader) {
    let mut compared = |simulated: &str| -> serde_json::Value {
        let line = format!(
            "simgap compare --measured run2.csv --simulated {simulated} --map position=Pos_Table --format json"
        );
        serde_json::from_str(&reader.run(&line)).unwrap()
    };
    let (nominal, corrected) = (compared("simulated.csv"), compared("corrected.csv"));
    // A fault of the chain may lead, but does not explain it all.
    let chain = &nominal["chain"];
    assert!(
        chain["status"] == "unknown" || chain["complete"] == false,
        "{chain}"
    );
    let gap = |json: &serde_json::Value, key: &str| json["gap"][key].as_f64().unwrap();
    assert!(gap(&nominal, "simulated") > 100.0 * gap(&nominal, "noise_floor"));
    assert!(gap(&corrected, "simulated") < 0.01 * gap(&nominal, "simulated"));
    let read = |name: &str| -> serde_json::Value {
        let path = reader.cwd.join(name).join("diagnosis.json");
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
    };
    let (answer, doubt) = (read("result"), read("doubt"));
    let named = |d: &serde_json::Value| d["verdict"]["effects"][0]["kind"].clone();
    assert_eq!(named(&answer), "coulomb_friction");
    assert_eq!(named(&doubt), "stribeck_friction");
    let interval = |d: &serde_json::Value, parameter: usize| -> [f64; 2] {
        let parameter = &d["verdict"]["effects"][0]["parameters"][parameter];
        [0, 1].map(|end| parameter["ci95"][end].as_f64().unwrap_or(f64::INFINITY))
    };
    // 7 N are in the file (`xtask/src/tutorial_records.rs`).
    let [low, high] = interval(&answer, 0);
    assert!(
        low < 7.0 && 7.0 < high && high - low < 1.0,
        "{low} to {high}"
    );
    // The data do not tell the two levels of the richer law apart: that at rest is what is in the file, and that at speeds far above the
    // motion may be the same. It predicts hardly better.
    let [[_, sliding], [low, high]] = [interval(&doubt, 0), interval(&doubt, 1)];
    assert!(
        low < 7.0 && 7.0 < high && high < 7.5,
        "at rest {low} to {high}"
    );
    assert!(low < sliding, "up to {sliding}, at rest from {low}");
    let of = |d: &serde_json::Value, key: &str| d["gap"][key].as_f64().unwrap();
    assert!(of(&doubt, "corrected") > 0.95 * of(&answer, "corrected"));
    let gap = |key: &str| of(&answer, key);
    assert!(gap("corrected") < 0.1 * gap("recalibrated"));
    assert!(gap("recalibrated") < 0.5 * gap("nominal"));
}
