//! A diagnosis in ten to twenty lines for a terminal.

use simgap_diagnose::{Diagnosis, Status};

use crate::lines::wrap;
use crate::number::{percent, ratio};
use crate::wording::{effect_at, headline, particulars, plain, sentence};

/// Columns of text.
const WIDTH: usize = 96;
/// Columns of the names on the left.
const INDENT: usize = 14;
/// Entries of a list that is told in one line.
const FEW: usize = 3;

/// How words are set off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Styles {
    faint: &'static str,
    good: &'static str,
    doubtful: &'static str,
    reset: &'static str,
}

impl Styles {
    /// Plain text, for files and pipes.
    #[must_use]
    pub const fn plain() -> Self {
        Self {
            faint: "",
            good: "",
            doubtful: "",
            reset: "",
        }
    }

    /// ANSI escapes, for terminals.
    #[must_use]
    pub const fn ansi() -> Self {
        Self {
            faint: "\u{1b}[2m",
            good: "\u{1b}[1;32m",
            doubtful: "\u{1b}[1;33m",
            reset: "\u{1b}[0m",
        }
    }
}

/// The summary, each line ended.
///
/// Control characters in names are dropped, so that no file can command the terminal.
///
/// # Examples
///
/// ```
/// # use simgap_diagnose::{Diagnosis, Gap, Verdict, Where};
/// use simgap_report::summary::{Styles, summary_text};
/// # let diagnosis = Diagnosis {
/// #     schema: "simgap-diagnosis/1",
/// #     model: "table".into(),
/// #     gap: Gap { metric: "nrmse", nominal: 0.021, recalibrated: 0.021, corrected: 0.021,
/// #         noise_floor: 0.020, input_noise: 0.0, closed: 0.0, channels: vec![] },
/// #     r#where: Where { channels: vec![], locations: vec![], bands: vec![], times: vec![], states: vec![], records: vec![] },
/// #     verdict: Verdict::default(),
/// #     stopped_early: false, turning: vec![], candidates: vec![], next_experiment: None, notes: vec![],
/// # };
/// let text = summary_text(&diagnosis, Styles::plain());
/// assert!(text.starts_with("The gap of 0.0210 is measurement noise; nothing to add to the model.\n"));
/// ```
#[must_use]
pub fn summary_text(diagnosis: &Diagnosis, styles: Styles) -> String {
    let mut out = Lines {
        out: String::new(),
        styles,
    };
    let tone = match diagnosis.verdict.status {
        Status::Unknown => styles.doubtful,
        _ => styles.good,
    };
    for line in wrap(&clean(&headline(diagnosis)), WIDTH) {
        out.push(&format!("{tone}{line}{}", styles.reset));
    }
    for text in particulars(diagnosis) {
        for line in wrap(&clean(&text), WIDTH - 2) {
            out.push(&format!("  {line}"));
        }
    }
    out.push("");
    gap(&mut out, diagnosis);
    whereabouts(&mut out, diagnosis);
    rivals(&mut out, diagnosis);
    out.named("next", &next(diagnosis));
    for (i, note) in diagnosis.notes.iter().take(FEW).enumerate() {
        out.named(if i == 0 { "notes" } else { "" }, &sentence(&plain(note)));
    }
    if diagnosis.notes.len() > FEW {
        out.named(
            "",
            &format!("{} more in the report.", diagnosis.notes.len() - FEW),
        );
    }
    out.out
}

fn gap(out: &mut Lines, diagnosis: &Diagnosis) {
    let gap = &diagnosis.gap;
    let figures = format!(
        "{} as given → {} re-estimated → {} corrected",
        ratio(gap.nominal),
        ratio(gap.recalibrated),
        ratio(gap.corrected)
    );
    out.named("gap (nrmse)", &figures);
    let floor = match diagnosis.verdict.status {
        Status::None => ratio(gap.noise_floor),
        _ => format!(
            "{}; {} of the gap above it is closed",
            ratio(gap.noise_floor),
            percent(gap.closed)
        ),
    };
    out.named("noise floor", &floor);
}

/// What to do now.
fn next(diagnosis: &Diagnosis) -> String {
    match (&diagnosis.next_experiment, diagnosis.verdict.status) {
        (Some(experiment), _) => sentence(&plain(experiment)),
        (None, Status::None) => "Nothing: these records ask no more of the model.".to_owned(),
        (None, Status::Unknown) => "See in the report where the gap lies.".to_owned(),
        (None, Status::Parameters | Status::Effect) => {
            "Try the corrected model on a record of another kind of motion.".to_owned()
        }
    }
}

/// The largest share of each kind, a line each; what cannot be otherwise is not said.
fn whereabouts(out: &mut Lines, diagnosis: &Diagnosis) {
    let at = &diagnosis.r#where;
    let mut parts: Vec<String> = Vec::new();
    let mut add = |found: Option<(String, f64)>| {
        parts.extend(found.map(|(name, share)| format!("{} {name}", percent(share))));
    };
    add(top(at
        .locations
        .iter()
        .map(|l| (l.at.to_string(), l.share))));
    if at.channels.len() > 1 {
        let channels = at.channels.iter();
        add(top(
            channels.map(|c| (format!("in channel {}", c.channel), c.share))
        ));
    }
    let bands = crate::bands::told(&at.bands);
    add(top(bands.iter().map(|b| (b.name(), b.share))));
    add(top(at
        .states
        .iter()
        .map(|s| (format!("at {}", s.label), s.share))));
    for (i, part) in parts.iter().enumerate() {
        out.named(if i == 0 { "where" } else { "" }, part);
    }
}

fn top(entries: impl Iterator<Item = (String, f64)>) -> Option<(String, f64)> {
    // The first of equals.
    entries.fold(None, |best, entry| match best {
        Some(b) if b.1 >= entry.1 => Some(b),
        _ => Some(entry),
    })
}

fn rivals(out: &mut Lines, diagnosis: &Diagnosis) {
    for effect in &diagnosis.verdict.effects {
        let mut names: Vec<String> = effect
            .indistinguishable
            .iter()
            .take(FEW)
            .map(|r| effect_at(&r.kind, &r.at))
            .collect();
        let more = effect.indistinguishable.len().saturating_sub(FEW);
        if more > 0 {
            names.push(format!("{more} more"));
        }
        if !names.is_empty() {
            let mut text = names.join("; ");
            if diagnosis.verdict.effects.len() > 1 {
                text.push_str(&format!(
                    ", in place of {}",
                    effect_at(&effect.kind, &effect.at)
                ));
            }
            out.named("could also be", &text);
        }
    }
    // Beside a named effect, what did worse is for the report.
    let tried: Vec<String> = diagnosis
        .candidates
        .iter()
        .filter(|_| diagnosis.verdict.status == Status::Unknown)
        .take(FEW)
        .map(|c| {
            format!(
                "{} (gap {})",
                effect_at(&c.kind, &c.at),
                ratio(c.held_back_gap)
            )
        })
        .collect();
    if !tried.is_empty() {
        out.named("also tried", &tried.join("; "));
    }
}

struct Lines {
    out: String,
    styles: Styles,
}

impl Lines {
    fn push(&mut self, line: &str) {
        // Spaces that must not break have done their work.
        self.out.push_str(&line.replace('\u{a0}', " "));
        self.out.push('\n');
    }

    /// A name on the left, the text wrapped on its right.
    fn named(&mut self, name: &str, text: &str) {
        let text = clean(text);
        for (i, line) in wrap(&text, WIDTH - INDENT).into_iter().enumerate() {
            let name = if i == 0 { name } else { "" };
            let Styles { faint, reset, .. } = self.styles;
            let pad = " ".repeat(INDENT.saturating_sub(name.chars().count()));
            let name = if name.is_empty() {
                String::new()
            } else {
                format!("{faint}{name}{reset}")
            };
            self.push(&format!("{name}{pad}{line}"));
        }
    }
}

fn clean(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\u{a0}' => c,
            c if c.is_whitespace() => ' ',
            c => c,
        })
        .filter(|c| !c.is_control())
        .collect()
}
