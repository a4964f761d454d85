//! Which samples a hypothesis says anything about.
//!
//! A channel that comes late or early shows, at an end of the record, motion from outside of it, which no
//! simulation of the record holds. There a hypothesis neither gains nor loses: its discrepancy counts as
//! none, and its mean square is over the other samples. Sets that are compared with each other leave out the same
//! samples ([`Problem::leaves_out_ends`]): a set that may leave out a few does not gain by what the others have to explain there.

use std::ops::Range;

use simgap_effects::{Action, Placed, Sampled, most_beyond};
use simgap_model::Location;

use crate::Problem;
use crate::signals::Signals;

/// The samples within reach, by run and channel.
pub(crate) struct Reach {
    ranges: Vec<Vec<Range<usize>>>,
    /// For each channel, the samples in these that were filled: they count for nothing.
    filled: Vec<f64>,
}

impl Reach {
    /// With effects on top of those of the nominal model.
    pub(crate) fn of(problem: &Problem, effects: &[Placed]) -> Reach {
        let runs = 0..problem.runs.len();
        let ranges: Vec<Vec<Range<usize>>> =
            runs.map(|run| of_run(problem, effects, run)).collect();
        let filled = (0..problem.model.outputs.len()).map(|channel| {
            let runs = problem.runs.iter().zip(&ranges);
            let within = runs.map(|(run, ranges)| {
                let filled = run.filled(channel);
                filled
                    .filter(|sample| ranges[channel].contains(sample))
                    .count()
            });
            within.sum::<usize>() as f64
        });
        let filled = filled.collect();
        Reach { ranges, filled }
    }

    /// Sets what is out of reach to zero.
    pub(crate) fn keep(&self, run: usize, signals: &mut Signals) {
        for (signal, range) in signals.iter_mut().zip(&self.ranges[run]) {
            let end = range.end.min(signal.len());
            signal[end..].fill(0.0);
            signal[..range.start.min(end)].fill(0.0);
        }
    }

    /// Measured samples of a channel within reach.
    pub(crate) fn count(&self, channel: usize) -> f64 {
        let lengths = self.ranges.iter().map(|run| run[channel].len());
        lengths.sum::<usize>() as f64 - self.filled[channel]
    }
}

fn of_run(problem: &Problem, effects: &[Placed], number: usize) -> Vec<Range<usize>> {
    let run = &problem.runs[number];
    let outputs = problem.model.outputs.iter().zip(&run.measured);
    type Channel<'a> = (usize, (&'a simgap_model::Output, &'a Option<Vec<f64>>));
    let of_channel = |(channel, (output, measured)): Channel<'_>| {
        // What a filter has seen all samples before of.
        let whole = problem.whitening.order(channel).min(run.len)..run.len;
        let Some(measured) = measured else {
            return whole;
        };
        let is_here =
            |at: &Location| matches!(at, Location::Channel(name) if *name == output.channel);
        let signal = Sampled {
            values: measured,
            time_step_s: run.time_step_s,
            first_index: run.first_index,
            start_s: run.start_s,
            measured: Some(measured),
        };
        let placed = problem.given.iter().chain(effects);
        placed
            .filter(|placed| is_here(&placed.at))
            .map(|placed| match placed.in_record(number).action() {
                Action::Output(map) | Action::Sampling(map)
                    if !(run.mended.is_resampled && map.lives_in_single_samples()) =>
                {
                    map.reach(signal)
                }
                _ => 0..run.len,
            })
            // Shifts one after the other add up.
            .fold(whole, |all, one| {
                let late = all.start + one.start;
                let early = all.end.saturating_sub(run.len - one.end.min(run.len));
                late..early.max(late)
            })
    };
    let ends = match problem.leaves_out_ends {
        true => most_beyond(run.len),
        false => 0,
    };
    let of_channel = |channel: Channel<'_>| {
        let reached = of_channel(channel);
        let start = reached.start.max(ends);
        start..reached.end.min(run.len - ends).max(start)
    };
    outputs.enumerate().map(of_channel).collect()
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;
    use simgap_model::Model;
    use simgap_simulate::Run;

    use super::*;

    fn problem() -> Problem {
        let model = Model::from_toml(
            "schema = \"simgap-model/1\"\nname = \"m\"\n[[mass]]\nname = \"m\"\nvalue = 1.0\n\
             [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"m\"\n",
        )
        .unwrap();
        let run = Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: 0.01,
            len: 800,
            first_index: 0,
            inputs: vec![],
            measured: vec![Some(vec![1.0; 800])],
            mended: simgap_simulate::Mended::default(),
        };
        Problem::new(&model, vec![run]).unwrap()
    }

    fn shift(kind: &str, value: f64) -> Placed {
        let (effect, channel) = (find(kind).unwrap(), Location::Channel("y".into()));
        // Of an alternation, as much on the even samples as on the odd ones.
        let mut values = vec![0.5; effect.parameters().len()];
        values[0] = value;
        Placed::new(effect, channel, values)
    }

    #[test]
    fn late_channels_lose_the_beginning_and_early_ones_the_end() {
        let problem = problem();
        let reach = |effects: &[Placed]| Reach::of(&problem, effects).ranges[0][0].clone();
        assert_eq!(reach(&[]), 0..800);
        assert_eq!(reach(&[shift("sensor_delay", 0.025)]), 3..800);
        assert_eq!(reach(&[shift("clock_skew", -0.01)]), 0..800);
        // Sample 795 lies at 798.98, the next one beyond the record.
        assert_eq!(reach(&[shift("clock_skew", 0.005)]), 0..796);
        assert_eq!(reach(&[shift("alternating_timing", 0.004)]), 0..800);
        // By two and a half samples: 1 lies before the record, 798 after it.
        assert_eq!(reach(&[shift("alternating_timing", 0.025)]), 2..798);
        let both = [shift("sensor_delay", 0.025), shift("clock_skew", 0.005)];
        assert_eq!(reach(&both), 3..796);
        // No more than a hundredth of a record is left out.
        assert_eq!(reach(&[shift("sensor_delay", 1.5)]), 8..800);
    }

    #[test]
    fn sets_that_are_compared_leave_out_the_same_samples() {
        let problem = Problem {
            leaves_out_ends: true,
            ..problem()
        };
        for effects in [vec![], vec![shift("sensor_delay", 0.025)]] {
            assert_eq!(Reach::of(&problem, &effects).ranges[0][0], 8..792);
        }
    }

    #[test]
    fn what_is_out_of_reach_does_not_count() {
        let problem = problem();
        let reach = Reach::of(&problem, &[shift("sensor_delay", 0.025)]);
        let mut signals = vec![vec![2.0; 800]];
        reach.keep(0, &mut signals);
        assert_eq!(signals[0][..4], [0.0, 0.0, 0.0, 2.0]);
        assert_eq!(reach.count(0), 797.0);
    }
}
