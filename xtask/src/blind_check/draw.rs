//! Cases as a user would have them, and their truths under a seal.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use rayon::prelude::*;
use simgap_blind::{Case, SealedCase, generate, seal, sha256};

use super::BlindCheckError;
use super::files::{CHECK, MODEL, Places, TRAIN, at, read, write};
use super::plan::Planned;
use crate::asked::write_record;

/// The truths of a campaign as text, and its digest.
pub(super) struct Sealed {
    pub(super) text: String,
    pub(super) digest: String,
}

/// Draws every case and writes its folder. The truths are held in memory only: no process that is
/// started can read them.
pub(super) fn draw(
    seed: u64,
    planned: &[Planned],
    places: &Places,
) -> Result<Sealed, BlindCheckError> {
    let cases = planned
        .par_iter()
        .map(|plan| {
            let case = generate(seed, plan.number, &plan.recipe, plan.level)?;
            let folder = places.of_case(&case.name);
            let files = write_case(&folder, &case)?;
            let truth = case.truth;
            Ok(SealedCase {
                name: case.name,
                files,
                truth: match plan.withheld {
                    Some(_) => truth.with_kind_withheld(),
                    None => truth,
                },
            })
        })
        .collect::<Result<Vec<_>, BlindCheckError>>()?;
    let text = seal(&cases)?;
    let digest = sha256(text.as_bytes());
    Ok(Sealed { text, digest })
}

/// Writes model and records; returns the digest of each file.
fn write_case(folder: &Path, case: &Case) -> Result<BTreeMap<String, String>, BlindCheckError> {
    fs::create_dir_all(folder).map_err(at(folder))?;
    write(&folder.join(MODEL), &case.model.to_toml()?)?;
    let records = case.train.iter().zip(TRAIN);
    let records = records.chain(case.check.iter().zip([CHECK]));
    for (record, file) in records {
        write_record(&folder.join(file), &case.model, record)?;
    }
    digests(folder)
}

/// Digest of each file of a case.
pub(super) fn digests(folder: &Path) -> Result<BTreeMap<String, String>, BlindCheckError> {
    let files = [MODEL, TRAIN[0], TRAIN[1], CHECK];
    files
        .iter()
        .map(|file| Ok(((*file).to_string(), sha256(&read(&folder.join(file))?))))
        .collect()
}
