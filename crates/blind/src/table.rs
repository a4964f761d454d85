//! A campaign as tables in Markdown.

use std::fmt::Write;

use crate::score::LARGEST_SET;
use crate::totals::{CLOSE, Share, Spread, Totals};

/// What is required of a campaign and what it measures.
///
/// The rows of the required figures, in the words of the task: `standard` gives all but the last,
/// `hard` the last.
#[must_use]
pub fn requirements(standard: &Totals, hard: &Totals) -> Vec<Requirement> {
    let s = standard;
    let least = |what: &str, share: Share, needed: f64| Requirement {
        what: what.to_string(),
        needed: format!("{} %", percent(needed)),
        measured: written(share),
        is_met: (share.of > 0).then(|| share.value() >= needed),
    };
    let mut declared = least(
        "true kind named first, or declared indistinguishable from the one named first (at most 3 kinds, 1.4 on average)",
        s.declared,
        0.98,
    );
    declared.needed.push_str(", 1.4 kinds");
    declared.is_met = declared.is_met.map(|met| met && s.set_mean <= 1.4);
    if s.declared.of > 0 {
        let sets = format!(", {} kinds, {} at most", decimals(s.set_mean, 2), s.set_max);
        declared.measured.push_str(&sets);
    }
    vec![
        least("true kind named first", s.first, 0.93),
        declared,
        least("location right where the kind is right", s.placed, 0.97),
        least(
            "clean data, exact and 2 %-wrong nominal parameters: nothing blamed but parameters",
            s.clean(),
            0.995,
        ),
        least(
            "foreign effect or true kind withheld: `unknown`, or an incomplete answer that names one of the same family first",
            s.unknowable(),
            0.93,
        ),
        least("two effects: both named, none invented", s.pairs, 0.85),
        Requirement {
            what: "gap closed on check records against noise-free truth".to_string(),
            needed: "median 0.98, 10th percentile 0.92".to_string(),
            measured: spread(&s.closing),
            is_met: (s.closing.count > 0)
                .then_some(s.closing.median >= 0.98 && s.closing.tenth >= 0.92),
        },
        least("stated against true closing within 0.05", s.stated, 0.90),
        least(
            "noise 26-34 dB, parameters 5 % off, gaps of 6-20 %: true kind named or declared",
            hard.declared,
            0.85,
        ),
    ]
}

/// One required figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Requirement {
    /// Of what.
    pub what: String,
    /// At least.
    pub needed: String,
    /// In this campaign; a dash where it has no such case.
    pub measured: String,
    /// Whether that is enough; `None` where it has no such case.
    pub is_met: Option<bool>,
}

/// The required figures beside the measured ones.
///
/// ```
/// use simgap_blind::{Totals, render_requirements};
/// let nothing = Totals::of(&[]);
/// let text = render_requirements(&nothing, &nothing);
/// assert!(text.contains("| two effects: both named, none invented | 85 % | - |  |"));
/// ```
#[must_use]
pub fn render_requirements(standard: &Totals, hard: &Totals) -> String {
    let mut rows = vec![row(&["", "at least", "measured", ""])];
    rows.extend(requirements(standard, hard).into_iter().map(|r| {
        let met = match r.is_met {
            Some(true) => "met",
            Some(false) => "not met",
            None => "",
        };
        vec![r.what, r.needed, r.measured, met.to_string()]
    }));
    write_table(&rows)
}

/// What the required figures are made of.
#[must_use]
pub fn render_figures(t: &Totals) -> String {
    let [unknown, nearest, same] = t.foreign_how;
    let lines: [(&str, String); 15] = [
        ("cases", t.cases.to_string()),
        ("whole answer right", written(t.right)),
        (
            "one effect: its kind first, or one that no data tell from it on that plant",
            written(t.first_or_same),
        ),
        (
            "noise alone, exact parameters: nothing blamed",
            written(t.exact),
        ),
        (
            "noise alone, wrong parameters: nothing else blamed",
            written(t.small_errors),
        ),
        ("foreign effects: as required", written(t.foreign)),
        ("withheld kinds: as required", written(t.withheld)),
        (
            "of both: `unknown`, nearest name of an incomplete answer, same law by another name",
            format!("{unknown}, {nearest}, {same}"),
        ),
        ("effects of pairs named at their place", written(t.of_pairs)),
        (
            "gap closed by the true effects and parameters",
            spread(&t.best),
        ),
        ("gap closed, share of that", spread(&t.of_best)),
        ("Brier score of stated probabilities", decimals(t.brier, 3)),
        ("largest set counted as declared", LARGEST_SET.to_string()),
        ("stated closing is right within", CLOSE.to_string()),
        ("statements", {
            let counts = t.calibration.iter().map(|bin| bin.count);
            counts.sum::<usize>().to_string()
        }),
    ];
    let mut rows = vec![row(&["figure", "value"])];
    rows.extend(lines.map(|(name, value)| vec![name.to_string(), value]));
    write_table(&rows)
}

/// Stated probabilities against how often they were right.
#[must_use]
pub fn render_calibration(t: &Totals) -> String {
    let mut rows = vec![row(&["stated probability", "statements", "mean", "right"])];
    rows.extend(t.calibration.iter().map(|bin| {
        let right = bin.right;
        vec![
            format!("{} to {}", bin.from, bin.to),
            bin.count.to_string(),
            decimals(bin.stated, 3),
            if right.is_nan() {
                "-".to_string()
            } else {
                format!("{} %", percent(right))
            },
        ]
    }));
    write_table(&rows)
}

/// Truth by what was said; what is not there is zero.
#[must_use]
pub fn render_confusion(t: &Totals) -> String {
    let mut rows = vec![row(&["truth", "cases", "said"])];
    for (truth, said) in &t.confusion {
        let mut said: Vec<(&String, &usize)> = said.iter().collect();
        said.sort_by_key(|(kind, count)| (*kind != truth, std::cmp::Reverse(**count)));
        let count: usize = said.iter().map(|(_, count)| **count).sum();
        let said: Vec<String> = said.iter().map(|(kind, n)| format!("{kind} {n}")).collect();
        rows.push(vec![truth.clone(), count.to_string(), said.join(", ")]);
    }
    write_table(&rows)
}

/// Rows of cells; the first is the header.
fn write_table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let mut text = String::new();
    for (r, row) in rows.iter().enumerate() {
        // Writing to a string does not fail.
        let _ = writeln!(text, "| {} |", row.join(" | "));
        if r == 0 {
            let _ = writeln!(text, "|{}", "---|".repeat(columns));
        }
    }
    text
}

fn row(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).to_string()).collect()
}

/// Down to a tenth: 99.7 % of 300 is not 100 %.
fn percent(share: f64) -> f64 {
    (1000.0 * share).floor() / 10.0
}

fn written(share: Share) -> String {
    match share {
        Share { of: 0, .. } => "-".to_string(),
        Share { hits, of } => format!("{} % ({hits} of {of})", percent(share.value())),
    }
}

fn spread(spread: &Spread) -> String {
    match spread.count {
        0 => "-".to_string(),
        _ => format!(
            "median {}, 10th percentile {}",
            decimals(spread.median, 3),
            decimals(spread.tenth, 3)
        ),
    }
}

fn decimals(value: f64, places: usize) -> String {
    if value.is_nan() {
        "-".to_string()
    } else {
        format!("{value:.places$}")
    }
}
