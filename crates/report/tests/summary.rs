//! The lines for a terminal.
#![allow(clippy::unwrap_used)]

use crate::common;

use simgap_diagnose::Status;
use simgap_report::summary::{Styles, summary_text};

#[test]
fn regress_summary_of_each_status() {
    let all = [
        common::effect(),
        common::two_effects(),
        common::parameters(),
        common::unknown(),
        common::none(),
    ];
    let text: Vec<String> = all
        .iter()
        .map(|d| summary_text(d, Styles::plain()))
        .collect();
    insta::assert_snapshot!(text.join("----\n"));
}

#[test]
fn verify_summaries_are_short_and_narrow() {
    for d in [
        common::effect(),
        common::two_effects(),
        common::unknown(),
        common::none(),
    ] {
        let text = summary_text(&d, Styles::plain());
        assert!((5..=24).contains(&text.lines().count()), "{text}");
        assert!(
            text.lines()
                .all(|l| l.chars().count() <= 96 && l == l.trim_end()),
            "{text}"
        );
        assert!(text.ends_with('\n') && !text.contains('\u{1b}'));
    }
}

/// On data that it was not fitted to an answer may be worse than the model as given: it explains nothing there.
#[test]
fn verify_a_gap_that_grows_is_not_explained() {
    let mut d = common::effect();
    d.gap.closed = -0.375;
    let text = summary_text(&d, Styles::plain());
    let words: Vec<&str> = text.split_whitespace().collect();
    let words = words.join(" ");
    assert!(
        words.contains(
            "explains the training records best, and not the gap on data it was not fitted to"
        ),
        "{text}"
    );
    assert!(!words.contains("of the gap on data"), "{text}");
}

#[test]
fn verify_colours_are_all_that_ansi_adds() {
    let d = common::effect();
    let coloured = summary_text(&d, Styles::ansi());
    assert!(coloured.contains("\u{1b}[1;32mCoulomb friction of"));
    let mut plain = coloured;
    for escape in ["\u{1b}[0m", "\u{1b}[2m", "\u{1b}[1;32m", "\u{1b}[1;33m"] {
        plain = plain.replace(escape, "");
    }
    assert_eq!(plain, summary_text(&d, Styles::plain()));
}

#[test]
fn verify_names_from_files_cannot_command_the_terminal() {
    let mut d = common::effect();
    d.notes = vec!["a\u{1b}[31mred\nline\u{7}".into()];
    let text = summary_text(&d, Styles::plain());
    assert!(text.contains("a[31mred line.") && !text.contains('\u{1b}') && !text.contains('\u{7}'));
}

#[test]
fn verify_bare_diagnoses_have_a_summary() {
    for status in [
        Status::None,
        Status::Parameters,
        Status::Effect,
        Status::Unknown,
    ] {
        let text = summary_text(&common::bare(status), Styles::plain());
        assert!(text.lines().count() >= 4, "{text}");
    }
}
