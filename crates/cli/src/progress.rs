//! Progress on the terminal, with the time that is left; nothing anywhere else.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use simgap_diagnose::Stage;

/// The stages of a diagnosis and how much of its time has passed at their end, where it goes through all of them: the mean of six with
/// short records, on three real and three generated machines, and of seven with long ones, weighed alike. One that ends before is done sooner
/// than is said.
const STAGES: [(Stage, f64); 15] = [
    (Stage::NominalModel, 0.01),
    (Stage::NominalParameters, 0.015),
    (Stage::Singles, 0.03),
    (Stage::SinglesFromManyValues, 0.06),
    (Stage::BesideParameters, 0.15),
    (Stage::Pairs, 0.26),
    (Stage::PairsFromManyValues, 0.31),
    (Stage::Threes, 0.35),
    (Stage::Stretches, 0.62),
    (Stage::AllSamples, 0.68),
    (Stage::Colour, 0.70),
    (Stage::Changes, 0.95),
    (Stage::Posterior, 0.98),
    (Stage::FinalFit, 0.985),
    (Stage::CheckRecords, 1.0),
];
/// Before that, a guess of what is left would be none.
const SURE_AFTER: Duration = Duration::from_secs(2);

/// Where the work stands.
#[derive(Clone, Copy)]
struct Standing {
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
    standing: Arc<Mutex<Standing>>,
}

impl Steps {
    pub(crate) fn new() -> Steps {
        let standing = Arc::new(Mutex::new(Standing {
            started: Instant::now(),
            passed: Duration::ZERO,
            from: 0.0,
            to: STAGES[0].1,
        }));
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let shown = Arc::clone(&standing);
        let left = move |_: &ProgressState, out: &mut dyn std::fmt::Write| {
            let Ok(standing) = shown.lock().map(|standing| *standing) else {
                return;
            };
            if let Some(left) = left(standing, standing.started.elapsed()) {
                let _ = write!(out, ", up to {} s left", left.as_secs().max(1));
            }
        };
        if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {msg}{left}") {
            bar.set_style(style.with_key("left", left));
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Steps { bar, standing }
    }

    pub(crate) fn show(&self, step: &str) {
        if let Ok(mut standing) = self.standing.lock() {
            *standing = standing.next(step, standing.started.elapsed());
        }
        self.bar.set_message(step.to_string());
    }
}

impl Standing {
    /// Where it stands when a step begins; a step that is not known goes on with the one before.
    fn next(self, step: &str, passed: Duration) -> Standing {
        let Some(index) = STAGES.iter().position(|(stage, _)| stage.name() == step) else {
            return self;
        };
        let from = index.checked_sub(1).map_or(0.0, |before| STAGES[before].1);
        Standing {
            passed,
            from,
            to: STAGES[index].1,
            ..self
        }
    }
}

/// Time that is left: what has passed tells how long all of it takes. Counts down while a step
/// lasts; a step that takes longer than its share tells that what comes after it will, too.
fn left(standing: Standing, now: Duration) -> Option<Duration> {
    if standing.from <= 0.0 || now < SURE_AFTER {
        return None;
    }
    let now = now.as_secs_f64();
    let all = (standing.passed.as_secs_f64() / standing.from).max(now / standing.to);
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
        let first = Standing {
            started: Instant::now(),
            passed: Duration::ZERO,
            from: 0.0,
            to: 0.1,
        };
        assert_eq!(left(first, Duration::from_secs(9)), None);
        // Half of the work has taken ten seconds, and the step goes to three quarters.
        let standing = Standing {
            passed: Duration::from_secs(10),
            from: 0.5,
            to: 0.75,
            ..first
        };
        let at = |s: u64| {
            left(standing, Duration::from_secs(s))
                .unwrap_or_default()
                .as_secs()
        };
        assert_eq!([at(10), at(13), at(15), at(30)], [10, 7, 5, 10]);
        // An unknown step goes on with the one before, a known one has its own share.
        let next = standing.next("something else", Duration::from_secs(11));
        assert_eq!((next.from, next.passed), (0.5, Duration::from_secs(10)));
        let next = standing.next(Stage::Threes.name(), Duration::from_secs(20));
        assert_eq!((next.from, next.to), (0.31, 0.35));
    }

    #[test]
    fn verify_shares_rise_to_the_whole() {
        assert!(STAGES.windows(2).all(|pair| pair[0].1 < pair[1].1));
        assert_eq!(STAGES.map(|(stage, _)| stage), Stage::ALL);
        assert_eq!(STAGES[STAGES.len() - 1].1, 1.0);
    }
}
