//! `cargo xtask machines`: has the program diagnose real machines whose cause is known, and scores the answers.

mod args;
mod draw;
mod error;
mod page;
mod truth;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use rayon::prelude::*;

use crate::asked::{Asked, Kinds, at, json, parse};
pub use args::Args;
pub use error::MachinesError;
use page::Case;
use truth::Truth;

/// The page that `--write` writes.
const PAGE: &str = "docs/real-machines.md";

/// Draws where asked, asks and scores; the lines to print.
///
/// # Errors
/// [`MachinesError`] for folders that are no machines, files, and answers that differ from those written down.
pub fn run(args: &Args) -> Result<String, MachinesError> {
    let mut names = vec![];
    for entry in fs::read_dir(&args.root).map_err(at(&args.root))? {
        let path = entry.map_err(at(&args.root))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_asked = args.only.as_ref().is_none_or(|only| name.contains(only));
        if path.join("truth.json").exists() && is_asked {
            names.push(name.into_owned());
        }
    }
    names.sort();
    let draws: Vec<(&String, Option<usize>)> = names
        .iter()
        .flat_map(|name| match args.draws {
            0 => vec![(name, None)],
            draws => (1..=draws).map(|draw| (name, Some(draw))).collect(),
        })
        .collect();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.asking.jobs.max(1))
        .build()?;
    let cases: Result<Vec<Option<Case>>, MachinesError> = pool.install(|| {
        let each = draws.par_iter().with_max_len(1);
        each.map(|(name, draw)| case(args, name, *draw)).collect()
    });
    let cases: Vec<Case> = cases?.into_iter().flatten().collect();
    let golden = args.root.join("answers.json");
    if args.write {
        let kinds = kinds(&cases);
        let text = serde_json::to_string_pretty(&kinds).map_err(json(&golden))?;
        fs::write(&golden, text + "\n").map_err(at(&golden))?;
        let path = Path::new(PAGE);
        fs::write(path, page::page(&cases)).map_err(at(path))?;
    }
    if args.check {
        let text = fs::read_to_string(&golden).map_err(at(&golden))?;
        let known: BTreeMap<String, Kinds> = parse(&golden, &text)?;
        let differ: Vec<String> = kinds(&cases)
            .iter()
            .filter(|(name, kinds)| known.get(*name) != Some(kinds))
            .map(|(name, kinds)| match known.get(name) {
                Some(before) => format!("{name}: {kinds}, was {before}"),
                None => format!("{name}: {kinds}, not in {}", golden.display()),
            })
            .collect();
        if !differ.is_empty() {
            return Err(MachinesError::Differ(differ.join("\n")));
        }
    }
    Ok(format!(
        "{}\n{}\n",
        page::lines(&cases),
        page::totals(&cases)
    ))
}

fn kinds(cases: &[Case]) -> BTreeMap<String, Kinds> {
    let said = |case: &Case| Kinds::of(case.answer.diagnosis.as_ref());
    cases
        .iter()
        .map(|case| (case.name.clone(), said(case)))
        .collect()
}

/// A machine, or a draw of it, with its answer; nothing where none is there and none is asked for.
fn case(args: &Args, machine: &str, draw: Option<usize>) -> Result<Option<Case>, MachinesError> {
    let folder = args.root.join(machine);
    let path = folder.join("truth.json");
    let text = fs::read_to_string(&path).map_err(at(&path))?;
    let truth: Truth = parse(&path, &text)?;
    let name = draw.map_or(machine.to_owned(), |draw| format!("{machine}~{draw}"));
    let folder = match draw {
        None => folder,
        Some(_) => {
            let drawn = args.out.join("cases").join(&name);
            draw::draw(&folder, &drawn, &name, args.noise)?;
            drawn
        }
    };
    let asked = Asked {
        program: &args.asking.program,
        folder: &folder,
        out: &args.out.join("answers").join(&name),
        mend: truth.mend,
    };
    let answer = asked.answer_anew(args.asking.score_only)?;
    Ok(answer.map(|answer| Case {
        name,
        truth,
        answer,
    }))
}
