//! Every claim of the paper, and every lead on its gap, with a verdict.

mod claim;
mod leads;
mod models;
mod motion;
mod tables;

use claim::Claim;

use super::{Block, Cell, Context, Page, ReproduceError, Table, Verdict};

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let mut paper = tables::on_table_1(context)?;
    paper.extend(tables::on_table_2(context)?);
    paper.extend(tables::on_table_3(context)?);
    paper.extend(tables::on_table_4(context)?);
    paper.extend(models::on_one_mass(context)?);
    paper.extend(motion::on_beats(context)?);
    paper.extend(motion::on_harmonics(context));
    paper.extend(motion::on_phases(context)?);
    paper.extend(models::on_two_masses(context)?);
    paper.extend(motion::on_local_vibration(context)?);
    let mut found = leads::on_timing(context)?;
    found.extend(leads::on_damping(context)?);
    found.extend(leads::on_the_rest(context)?);
    found.extend(leads::on_the_machine(context)?);
    found.extend(motion::on_steady_state(context)?);
    let count = |verdict: Verdict| {
        paper
            .iter()
            .filter(|claim| claim.verdict == verdict)
            .count()
    };
    let summary = format!(
        "of {} claims of the paper {} reproduced, {} within tolerance, {} not reproducible from what is printed",
        paper.len(),
        count(Verdict::Reproduced),
        count(Verdict::WithinTolerance),
        count(Verdict::NotReproducible)
    );
    Ok(Page {
        stem: "claims",
        title: "Every claim, with a verdict".to_owned(),
        summary: summary.clone(),
        blocks: vec![
            Block::Text(format!(
                "In short: {summary}. Each verdict is computed, and changes when the condition behind it fails; but for \
                 that on the measured step, which is lost."
            )),
            Block::Table(table("Claims of the paper", &paper)),
            Block::Table(table("Leads: what the printed numbers imply", &found)),
            Block::Text(
                "A lead is a calculation on printed numbers. That it is *reproduced* means that the calculation \
                 comes out as stated, not that the machine was so: the measured data is lost."
                    .to_owned(),
            ),
        ],
    })
}

fn table(title: &str, claims: &[Claim]) -> Table {
    let mut table = Table::new(title, &["claim", "where", "verdict", "because"]);
    for claim in claims {
        table.rows.push(vec![
            Cell::text(&claim.claim),
            Cell::text(claim.place),
            Cell::text(claim.verdict.text()),
            Cell::text(&claim.because),
        ]);
    }
    table
}
