//! `cargo xtask reproduce-paper [--check]`: every published number beside ours, with a verdict.
//!
//! The measured data of the paper is lost. What is computed here follows from the printed tables,
//! through records rebuilt from them, and every page says so. All pages are built in memory
//! ([`generate`]); they are then written, or compared byte for byte with what is committed. The
//! published numbers themselves (`crates/tables/fixtures`) are read and never written.

mod claims;
mod context;
mod diagnosed;
mod differentiators;
mod error;
mod figures;
mod files;
mod frame;
mod machine;
mod number;
mod page;
mod peaks;
mod readings;
mod servo;
mod simulated;
mod spectra;
mod sweep;
mod table1;
mod table3;
mod table4;
mod table5;
mod three_unknowns;
mod trial;
mod two_masses;
mod two_rates;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::generated;

pub use context::{Context, PARK};
pub use error::ReproduceError;
pub use files::Outcome;
pub use number::{range, round_to, significant};
pub use page::{Block, Cell, Comparison, Page, Table, Verdict};

/// Arguments of `reproduce-paper`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Write nothing; fail, naming the files, where what is committed differs
    #[arg(long)]
    check: bool,
    /// Root of the workspace
    #[arg(long)]
    root: Option<PathBuf>,
}

/// Regenerates the reproduction, or compares it with what is committed.
///
/// # Errors
/// [`ReproduceError`] when a computation fails or a file cannot be read or written. Differences
/// found by `--check` are an [`Outcome`], not an error.
pub fn run(args: &Args) -> Result<Outcome, ReproduceError> {
    let root = args.root.clone().unwrap_or_else(generated::workspace_root);
    if args.check {
        check(&root)
    } else {
        write(&root)
    }
}

/// Writes every generated file under a root, and removes those no longer generated.
///
/// # Errors
/// As [`run`].
pub fn write(root: &Path) -> Result<Outcome, ReproduceError> {
    files::write(root, &generate()?)
}

/// Compares what is under a root with what is generated, byte for byte.
///
/// # Errors
/// As [`run`].
pub fn check(root: &Path) -> Result<Outcome, ReproduceError> {
    files::compare(root, &generate()?)
}

/// As [`write()`], of files generated before.
///
/// # Errors
/// As [`run`].
pub fn write_files(
    root: &Path,
    generated: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    files::write(root, generated)
}

/// As [`check`], of files generated before.
///
/// # Errors
/// As [`run`].
pub fn check_files(
    root: &Path,
    generated: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    files::compare(root, generated)
}

/// All pages, in the order of the index.
///
/// # Errors
/// [`ReproduceError`] when a computation fails.
pub fn pages() -> Result<Vec<Page>, ReproduceError> {
    let context = Context::new()?;
    let mut pages = vec![
        table1::page(&context)?,
        spectra::page(&context)?,
        table3::page(&context)?,
        table4::page(&context)?,
        table5::page(&context)?,
        peaks::page(&context)?,
        readings::page(&context)?,
        diagnosed::page(&context)?,
        differentiators::page(&context)?,
        figures::page(&context)?,
        machine::page(&context)?,
        sweep::page(&context)?,
    ];
    pages.push(claims::page(&context)?);
    Ok(pages)
}

/// Every generated file: path from the root of the workspace, and text.
///
/// # Errors
/// [`ReproduceError`] when a computation fails.
pub fn generate() -> Result<BTreeMap<String, String>, ReproduceError> {
    simgap_tables::verify_checksums()?;
    let pages = pages()?;
    let mut files = BTreeMap::new();
    for page in &pages {
        for (path, text) in page.files()? {
            files.insert(path, text);
        }
    }
    files.insert(
        "docs/reproduction/README.md".to_owned(),
        page::index(&pages),
    );
    Ok(files)
}
