//! `cargo xtask rigs`: draws machines with a withheld cause, has a program diagnose each, scores the answers.

mod args;
mod error;

use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;

use rayon::prelude::*;
use simgap_rigs::{Answer, Filter, Role, Truth, draw_case, page, score};

use crate::asked::{Asked, at, json};

pub use args::Args;
pub use error::RigsError;

fn filter(args: &Args) -> Result<Filter, RigsError> {
    let role = match &args.role {
        Some(name) => Some(Role::from_name(name).ok_or_else(|| RigsError::Role(name.clone()))?),
        None => None,
    };
    let known = simgap_rigs::kinds::EFFECTS
        .iter()
        .chain(&simgap_rigs::kinds::FOREIGN);
    let kind = match &args.kind {
        Some(name) => {
            let found = known.copied().find(|kind| kind == name);
            Some(found.ok_or_else(|| RigsError::Kind(name.clone()))?)
        }
        None => None,
    };
    Ok(Filter { role, kind })
}

/// Draws, asks and scores; the lines to print.
///
/// # Errors
/// [`RigsError`] for arguments that mean nothing, cases that cannot be drawn, and files.
pub fn run(args: &Args) -> Result<String, RigsError> {
    let filter = filter(args)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.asking.jobs.max(1))
        .build()?;
    fs::create_dir_all(&args.out).map_err(at(&args.out))?;
    let truths = Mutex::new(Vec::new());
    let numbers: Vec<usize> = (1..=args.cases).collect();
    let answered = pool.install(|| {
        let one = |number: &usize| -> Result<(Truth, Option<Answer>), RigsError> {
            let (truth, folder) = drawn(args, *number, &filter)?;
            if let Ok(mut list) = truths.lock() {
                list.push(truth.clone());
            }
            let answer = match args.draw_only {
                true => None,
                false => Asked {
                    program: &args.asking.program,
                    folder: &folder,
                    out: &args.out.join("answers").join(&truth.name),
                    mend: false,
                }
                .answer(args.asking.score_only)?,
            };
            Ok((truth, answer))
        };
        let each = numbers.par_iter().with_max_len(1).map(one);
        each.collect::<Result<Vec<_>, _>>()
    })?;
    let lines: Result<Vec<String>, _> = answered
        .iter()
        .map(|(truth, _)| serde_json::to_string(truth))
        .collect();
    let path = args.out.join("truths.jsonl");
    let text = lines.map_err(json(&path))?;
    fs::write(&path, text.join("\n") + "\n").map_err(at(&path))?;
    let pairs: Vec<(Truth, Answer)> = answered
        .into_iter()
        .filter_map(|(truth, answer)| Some((truth, answer?)))
        .collect();
    let text = page::page(&score(&pairs));
    let path = args.out.join("score.md");
    fs::write(&path, &text).map_err(at(&path))?;
    Ok(text)
}

/// The truth of a case, its files written where they are not there.
fn drawn(args: &Args, number: usize, filter: &Filter) -> Result<(Truth, PathBuf), RigsError> {
    let case = draw_case(args.seed, number, filter)?;
    let folder = args.out.join("cases").join(&case.name);
    fs::create_dir_all(&folder).map_err(at(&folder))?;
    for (name, text) in &case.files {
        let path = folder.join(name);
        if !fs::read_to_string(&path).is_ok_and(|old| old == *text) {
            fs::write(&path, text).map_err(at(&path))?;
        }
    }
    Ok((case.truth, folder))
}
