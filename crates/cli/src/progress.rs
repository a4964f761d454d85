//! Progress on the terminal, with the time that is left; nothing anywhere else.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// The steps of a diagnosis and how much of its time has passed at their end: the mean of the demo,
/// of its first record alone and of the tutorial. Steps that are left out are jumped; the shares of the
/// three that are seldom (`from afar`, `in stretches`, `exact parameters`) are guessed.
const STEPS: [(&str, f64); 11] = [
    ("nominal model", 0.02),
    ("single effects", 0.20),
    ("single effects from afar", 0.24),
    ("pairs of effects", 0.62),
    ("sets of three", 0.70),
    ("single effects in stretches", 0.72),
    ("finalists", 0.80),
    ("verdict", 0.94),
    ("exact parameters", 0.95),
    ("final fit", 0.96),
    ("check records", 1.0),
];
/// Before that, a guess of what is left would be none.
const SURE_AFTER: Duration = Duration::from_secs(2);

/// Where the work stands.
#[derive(Clone, Copy)]
struct Stage {
    started: Instant,
    /// Time that had passed when the step under way began.
    passed: Duration,
    /// Shares of the work at the beginning and the end of that step.
    from: f64,
    to: f64,
}

/// Shows the step that is under way, on stderr and only on a terminal.
pub(crate) struct Steps {
    bar: ProgressBar,
    stage: Arc<Mutex<Stage>>,
}

impl Steps {
    pub(crate) fn new() -> Steps {
        let stage = Arc::new(Mutex::new(Stage {
            started: Instant::now(),
            passed: Duration::ZERO,
            from: 0.0,
            to: STEPS[0].1,
        }));
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let shown = Arc::clone(&stage);
        let left = move |_: &ProgressState, out: &mut dyn std::fmt::Write| {
            let Ok(stage) = shown.lock().map(|stage| *stage) else {
                return;
            };
            if let Some(left) = left(stage, stage.started.elapsed()) {
                let _ = write!(out, ", about {} s left", left.as_secs().max(1));
            }
        };
        if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {msg}{left}") {
            bar.set_style(style.with_key("left", left));
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Steps { bar, stage }
    }

    pub(crate) fn show(&self, step: &str) {
        if let Ok(mut stage) = self.stage.lock() {
            *stage = stage.next(step, stage.started.elapsed());
        }
        self.bar.set_message(step.to_string());
    }
}

impl Stage {
    /// The stage a step begins; a step that is not known goes on with the one before.
    fn next(self, step: &str, passed: Duration) -> Stage {
        let Some(index) = STEPS.iter().position(|(name, _)| *name == step) else {
            return self;
        };
        let from = index.checked_sub(1).map_or(0.0, |before| STEPS[before].1);
        Stage {
            passed,
            from,
            to: STEPS[index].1,
            ..self
        }
    }
}

/// Time that is left: what has passed tells how long all of it takes. Counts down while a step
/// lasts; a step that takes longer than its share tells that what comes after it will, too.
fn left(stage: Stage, now: Duration) -> Option<Duration> {
    if stage.from <= 0.0 || now < SURE_AFTER {
        return None;
    }
    let now = now.as_secs_f64();
    let all = (stage.passed.as_secs_f64() / stage.from).max(now / stage.to);
    Some(Duration::from_secs_f64((all - now).max(0.0)))
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_time_left_counts_down_and_grows_with_a_long_step() {
        let first = Stage {
            started: Instant::now(),
            passed: Duration::ZERO,
            from: 0.0,
            to: 0.1,
        };
        assert_eq!(left(first, Duration::from_secs(9)), None);
        // Half of the work has taken ten seconds, and the step goes to three quarters.
        let stage = Stage {
            passed: Duration::from_secs(10),
            from: 0.5,
            to: 0.75,
            ..first
        };
        let at = |s: u64| {
            left(stage, Duration::from_secs(s))
                .unwrap_or_default()
                .as_secs()
        };
        assert_eq!([at(10), at(13), at(15), at(30)], [10, 7, 5, 10]);
        // An unknown step goes on with the one before, a known one has its own share.
        let next = stage.next("something else", Duration::from_secs(11));
        assert_eq!((next.from, next.passed), (0.5, Duration::from_secs(10)));
        let next = stage.next("verdict", Duration::from_secs(20));
        assert_eq!((next.from, next.to), (0.80, 0.94));
    }

    #[test]
    fn verify_shares_rise_to_the_whole() {
        assert!(STEPS.windows(2).all(|pair| pair[0].1 < pair[1].1));
        assert_eq!(STEPS[STEPS.len() - 1].1, 1.0);
    }
}
