//! Progress on the terminal, with the time that is left; nothing anywhere else.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use simgap_diagnose::Stage;

/// The shares of a diagnosis that have passed where a stage begins and where it ends: medians over 42 diagnoses of generated and real machines that took
/// 2.5 s or more. Before pairs nothing is said: most diagnoses end with single effects, and what stands at the beginning of a
/// long one tells little of its length. From then on, in 103 other diagnoses, 87 of 100 guesses were between .6 and 1.6 of the time that was left, and a
/// second; of those among pairs 65.
const STAGES: [(Stage, [f64; 2]); 10] = [
    (Stage::Pairs, [0.17, 0.32]),
    (Stage::PairsFromManyValues, [0.32, 0.43]),
    (Stage::Threes, [0.43, 0.47]),
    (Stage::Stretches, [0.47, 0.61]),
    (Stage::AllSamples, [0.53, 0.61]),
    (Stage::Colour, [0.53, 0.73]),
    (Stage::Changes, [0.73, 0.88]),
    (Stage::Posterior, [0.88, 0.95]),
    (Stage::FinalFit, [0.95, 0.96]),
    (Stage::CheckRecords, [0.96, 1.0]),
];
/// Before so much has passed nothing is said either.
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
            to: 1.0,
        }));
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let shown = Arc::clone(&standing);
        let left = move |_: &ProgressState, out: &mut dyn std::fmt::Write| {
            let Ok(standing) = shown.lock().map(|standing| *standing) else {
                return;
            };
            if let Some(left) = left(standing, standing.started.elapsed()) {
                let _ = write!(out, ", about {} s left", left.as_secs().max(1));
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
        let Some((_, [from, to])) = STAGES.iter().find(|(stage, _)| stage.name() == step) else {
            return self;
        };
        Standing {
            passed,
            from: *from,
            to: *to,
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
        assert_eq!((next.from, next.to), (0.43, 0.47));
        // Nothing is known while most diagnoses still may end.
        let early = first.next(Stage::SinglesFromManyValues.name(), Duration::from_secs(3));
        assert_eq!(left(early, Duration::from_secs(5)), None);
    }

    #[test]
    fn verify_shares_rise_to_the_whole() {
        assert!(
            STAGES
                .iter()
                .all(|(_, [from, to])| 0.0 < *from && from < to)
        );
        assert!(STAGES.windows(2).all(|pair| pair[0].1[0] <= pair[1].1[0]));
        assert_eq!(STAGES.map(|(stage, _)| stage)[..], Stage::ALL[5..]);
        assert_eq!(STAGES[STAGES.len() - 1].1[1], 1.0);
    }
}
