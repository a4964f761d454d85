//! `cargo xtask stability`: whether a machine gets the same answer whatever its noise and the order of its records.
//!
//! Each generated case is drawn several times: the same machine, motion and cause with other noise, and every other time with the
//! training records in the other order. The program is asked about each in a process of its own; the answers of a case are
//! compared with each other, not with the truth.

mod args;
mod error;
mod verdicts;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use rayon::prelude::*;
use simgap_blind::{Level, Recipe, redraw, schedule};

use crate::asked::{Asked, at, write_record};
pub use args::Args;
pub use error::StabilityError;
use verdicts::{Said, Verdicts};

/// Draws, asks and compares; the lines to print.
///
/// # Errors
/// [`StabilityError`] for kinds that are not drawn, cases that cannot be, and files.
pub fn run(args: &Args) -> Result<String, StabilityError> {
    let recipes = schedule(args.seed, args.cases, &args.kinds)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.asking.jobs.max(1))
        .build()?;
    let draws: Vec<(usize, u64)> = (0..recipes.len())
        .flat_map(|number| (1..=args.redraws as u64).map(move |noise| (number, noise)))
        .collect();
    let each = draws.par_iter().with_max_len(1);
    let answers: Vec<Option<Said>> = pool.install(|| {
        each.map(|(number, noise)| answer(args, &recipes[*number], *number, *noise))
            .collect::<Result<_, StabilityError>>()
    })?;
    let of_cases = answers.chunks(args.redraws.max(1));
    let verdicts: Vec<Verdicts> = of_cases
        .map(|answers| Verdicts::new(answers.iter().flatten().cloned().collect()))
        .collect();
    Ok(page(&recipes, &verdicts))
}

/// What is said of a draw of a case; nothing where only old answers count and there is none.
fn answer(
    args: &Args,
    recipe: &Recipe,
    number: usize,
    noise: u64,
) -> Result<Option<Said>, StabilityError> {
    let name = format!("case-{number:04}~{noise}");
    let folder = args.out.join("cases").join(&name);
    if !args.asking.score_only {
        draw(args.seed, recipe, number, noise, &folder)?;
    }
    let asked = Asked {
        program: &args.asking.program,
        folder: &folder,
        out: &args.out.join("answers").join(&name),
        mend: false,
    };
    let answer = asked.answer_anew(args.asking.score_only)?;
    Ok(answer.map(|answer| Said::of(answer.diagnosis.as_ref())))
}

fn draw(
    seed: u64,
    recipe: &Recipe,
    number: usize,
    noise: u64,
    folder: &Path,
) -> Result<(), StabilityError> {
    let case = redraw(seed, number, recipe, Level::Standard, noise)?;
    fs::create_dir_all(folder).map_err(at(folder))?;
    let path = folder.join("model.toml");
    fs::write(&path, case.model.to_toml()?).map_err(at(&path))?;
    let mut train = case.train;
    if !noise.is_multiple_of(2) {
        train.reverse();
    }
    for (place, record) in train.iter().enumerate() {
        let path = folder.join(format!("train-{}.csv", place + 1));
        write_record(&path, &case.model, record)?;
    }
    if let Some(check) = case.check.first() {
        write_record(&folder.join("check.csv"), &case.model, check)?;
    }
    Ok(())
}

fn page(recipes: &[Recipe], verdicts: &[Verdicts]) -> String {
    let mut text = String::from(
        "| Case | Drawn | Said most often | Agree | Same kinds | Others |\n|---|---|---|---|---|---|\n",
    );
    for (number, (recipe, verdicts)) in recipes.iter().zip(verdicts).enumerate() {
        let _ = writeln!(
            text,
            "| case-{number:04} | {recipe} | {} | {} of {} | {} | {} |",
            verdicts.usual(),
            verdicts.agree(),
            verdicts.count(),
            verdicts.same(),
            verdicts.others(),
        );
    }
    let sum = |of: fn(&Verdicts) -> usize| verdicts.iter().map(of).sum::<usize>();
    let all = sum(Verdicts::count);
    let share = |count: usize| 100.0 * count as f64 / all.max(1) as f64;
    let (first, same) = (sum(Verdicts::agree), sum(Verdicts::same));
    let _ = writeln!(
        text,
        "\nOf {all} answers {first} ({:.1} %) have the status of the usual answer of their case and name the same kind first, or one that \
         they say cannot be told from it; {same} ({:.1} %) name the same kinds.",
        share(first),
        share(same)
    );
    text
}
