//! The page opened in a headless Chromium: nothing on the console, every picture drawn, nothing over
//! anything else, on a phone and on a wide screen.
//!
//! The browser is the one that `CHROMIUM` names, else the first of its usual names in `PATH`; where
//! there is none the tests say so and pass.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use crate::common;

use std::path::{Path, PathBuf};
use std::process::Command;

use simgap_diagnose::{Diagnosis, PlaceMotion, Status};
use simgap_model::Model;
use simgap_report::page::{ReportInput, report};

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];
const CHECK: &str = include_str!("browser.js");
/// Before anything of the page runs: what goes wrong from now on.
const WATCH: &str = "window.pageFaults = [];
addEventListener('error', (e) => pageFaults.push('error: ' + (e.message || e.target)), true);
addEventListener('unhandledrejection', (e) => pageFaults.push('rejected: ' + e.reason));
for (const kind of ['error', 'warn']) {
  const own = console[kind];
  console[kind] = (...words) => { pageFaults.push('console: ' + words.join(' ')); own(...words); };
}";

fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        return Some(named.into());
    }
    let folders = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&folders)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|path| path.is_file());
    if found.is_none() {
        eprintln!("SKIPPED: no Chromium in PATH and none named by CHROMIUM, so no page was opened");
    }
    found
}

/// A page, and the width of the screen it is looked at.
struct Look {
    page: String,
    width_px: u32,
}

/// Each page in a frame of its width: a window cannot be made as narrow as a phone. All in one
/// document, since starting the browser takes longer than drawing a page.
fn framed(looks: &[Look]) -> String {
    let frame = |look: &Look| {
        let page = look
            .page
            .replacen("<head>", &format!("<head><script>{WATCH}</script>"), 1)
            .replacen("</body>", &format!("<script>{CHECK}</script></body>"), 1);
        let inside = page.replace('&', "&amp;").replace('"', "&quot;");
        format!(
            "<iframe style=\"border:0;width:{}px;height:900px\" srcdoc=\"{inside}\"></iframe><pre></pre>\n",
            look.width_px
        )
    };
    let frames: String = looks.iter().map(frame).collect();
    // Without its encoding told, a browser under load guesses from the part of a file that it has.
    format!(
        "<!DOCTYPE html><meta charset=\"utf-8\"><body style=\"margin:0\">{frames}<script>\
         setInterval(() => {{ for (const frame of document.querySelectorAll('iframe')) {{\
         const made = frame.contentDocument?.getElementById('page-check');\
         if (made) frame.nextElementSibling.textContent = made.textContent; }} }}, 50);</script></body>"
    )
}

/// What the check finds on each page: the number of pictures, and the faults; and what the browser
/// itself had to say.
fn look(browser: &Path, looks: &[Look]) -> (Vec<(usize, Vec<String>)>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.html");
    std::fs::write(&file, framed(looks)).unwrap();
    let profile = folder.path().join("profile");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .args(["--hide-scrollbars", "--enable-logging=stderr", "--v=0"])
        .args(["--window-size=1500,1000", "--virtual-time-budget=20000"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr);
    // Results follow their frames; the pages themselves are escaped in an attribute.
    let mut results = dom.split("</iframe><pre>").skip(1);
    let found = looks.iter().map(|look| {
        let result = results.next().unwrap_or_default();
        read(result.split("</pre>").next().unwrap_or(result), look).unwrap_or_else(|| {
            let why = format!("no answer at {} px: {result} {said}", look.width_px);
            (0, vec![why])
        })
    });
    let found = found.collect();
    let console = said.lines().filter(|line| line.contains("CONSOLE"));
    (found, console.map(str::to_owned).collect())
}

/// The words of the check taken apart.
fn read(result: &str, look: &Look) -> Option<(usize, Vec<String>)> {
    let mut lines = result.lines();
    let figures = lines.next()?.strip_prefix("figures ")?.parse().ok()?;
    let mut faults = vec![];
    if lines.next() != Some(&format!("width {}", look.width_px)) {
        faults.push(format!("the frame is not {} px wide", look.width_px));
    }
    faults.extend(lines.map(str::to_owned));
    Some((figures, faults))
}

const MODEL: &str = r#"schema = "simgap-model/1"
name = "mold-2dof"
[[mass]]
name = "mold"
value = 33000.0
[[spring]]
name = "cylinder"
between = ["mold", "ground"]
stiffness = 8287639.0
[[damper]]
name = "cylinder"
between = ["mold", "ground"]
damping = 313778.8
[[output]]
channel = "y1"
kind = "displacement"
at = "mold"
[[output]]
channel = "F_cylinder"
kind = "force"
between = ["mold", "ground"]
"#;

fn page(diagnosis: &Diagnosis) -> String {
    let model = Model::from_toml(MODEL).unwrap();
    let mut corrected = model.clone();
    corrected.masses[0].value *= 1.1;
    let series = common::series_of(diagnosis.verdict.status);
    let time_s = &series[0].time_s;
    let motions = [PlaceMotion {
        record: series[0].record.clone(),
        at: common::between("mold", "ground"),
        displacement: time_s.iter().map(|t| 1e-3 * (6.3 * t).sin()).collect(),
        velocity: time_s.iter().map(|t| 6e-3 * (6.3 * t).cos()).collect(),
    }];
    let input = ReportInput {
        diagnosis,
        series: &series,
        motions: &motions,
        nominal: Some(&model),
        corrected: Some(&corrected),
        context: &common::context(),
    };
    report(&input).unwrap().html
}

#[test]
fn verify_pages_on_a_phone_and_on_a_wide_screen() {
    let Some(browser) = browser() else { return };
    let mut long = common::two_effects();
    let name =
        "a_very_long_channel_name_of_a_data_logger_that_nobody_shortened_before_export_".repeat(2);
    long.gap.channels[0].channel.clone_from(&name);
    long.r#where.channels[0].channel.clone_from(&name);
    long.r#where.states[0].label = format!("large positive displacement of {name}");
    long.verdict.effects[1].at = simgap_model::Location::Channel(name);
    let all = [
        common::two_effects(),
        common::unknown(),
        common::none(),
        common::bare(Status::Effect),
        long,
    ];
    let pages = all.iter().map(page);
    let looks: Vec<Look> = pages
        .flat_map(|page| {
            [400, 1400].map(|width_px| Look {
                page: page.clone(),
                width_px,
            })
        })
        .collect();
    let (found, console) = look(&browser, &looks);
    assert!(console.is_empty(), "{console:#?}");
    assert_eq!(found.len(), 2 * all.len());
    for (i, (figures, faults)) in found.iter().enumerate() {
        let what = format!("page {} at {} px", i / 2, looks[i].width_px);
        assert!(faults.is_empty(), "{what}: {faults:#?}");
        assert!(*figures >= 6, "{what}: {figures} pictures");
    }
}

/// Each thing the check looks for, broken on purpose.
#[test]
fn verify_the_check_of_the_page_sees_faults() {
    let Some(browser) = browser() else { return };
    let good = page(&common::effect());
    let broken = [
        ("error", "</main>", "</main><script>nowhere()</script>"),
        (
            "console",
            "</main>",
            "</main><script>console.error('odd')</script>",
        ),
        (
            "scrolls sideways",
            "</main>",
            "<p style=\"min-width:1800px\">wide</p></main>",
        ),
        (
            "overlap",
            "</main>",
            "<p style=\"margin-top:-60px\">over the last</p></main>",
        ),
        (
            "not drawn",
            "<figcaption>",
            "<figcaption style=\"height:0\"></figcaption></figure><figure><figcaption>",
        ),
        (
            "empty canvas",
            "</head>",
            "<script>CanvasRenderingContext2D.prototype.stroke = CanvasRenderingContext2D.prototype.fill = CanvasRenderingContext2D.prototype.fillRect = CanvasRenderingContext2D.prototype.fillText = () => {}</script></head>",
        ),
        (
            "overlap in",
            "</text>",
            "</text><text x=\"50\" y=\"500\" font-size=\"900\">over all of it</text>",
        ),
        (
            "cut off",
            "</text>",
            "</text><text x=\"4500\" y=\"500\" font-size=\"300\">beyond the edge</text>",
        ),
    ];
    let looks = broken.map(|(_, place, with)| {
        assert!(good.contains(place), "{place}");
        Look {
            page: good.replacen(place, with, 1),
            width_px: 1400,
        }
    });
    let (found, console) = look(&browser, &looks);
    assert!(!console.is_empty(), "the console stays silent");
    for ((fault, ..), (_, faults)) in broken.iter().zip(&found) {
        assert!(
            faults.iter().any(|f| f.contains(fault)),
            "{fault}: {faults:#?}"
        );
    }
}
