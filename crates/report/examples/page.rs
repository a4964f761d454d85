//! Writes the page of a diagnosis built by hand, one for each kind of verdict, into the folder
//! named on the command line.

#[path = "../tests/common/mod.rs"]
mod common;

use std::path::PathBuf;

use simgap_report::page::report_html;
use simgap_report::summary::{Styles, summary_text};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder to write to")?);
    std::fs::create_dir_all(&folder)?;
    let all = [
        ("effect", common::effect()),
        ("two_effects", common::two_effects()),
        ("parameters", common::parameters()),
        ("unknown", common::unknown()),
        ("none", common::none()),
    ];
    for (name, diagnosis) in all {
        let page = report_html(
            &diagnosis,
            &common::series_of(diagnosis.verdict.status),
            &common::context(),
        )?;
        std::fs::write(folder.join(format!("{name}.html")), page)?;
        std::fs::write(
            folder.join(format!("{name}.txt")),
            summary_text(&diagnosis, Styles::ansi()),
        )?;
    }
    Ok(())
}
