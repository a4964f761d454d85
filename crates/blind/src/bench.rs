//! The bench on which the truth is measured: finely stepped, then sampled.

use simgap_effects::{Action, Placed, Sampled};
use simgap_model::{Location, Model};
use simgap_simulate::{Run, Simulator};

use crate::BlindError;
use crate::excitation::Signal;
use crate::random::Random;

/// Steps of the truth per sample of the record. The diagnosis steps with the record, so that its
/// integration errors show; odd, so that every other sample stays every other one.
pub const OVERSAMPLING: usize = 9;

/// Maps with a memory of the signal: they see it finely sampled and from before the record starts.
/// Every other map acts on the samples that are recorded.
const WITH_MEMORY: &[&str] = &["sensor_delay", "sensor_lag", "alternating_timing"];
/// Maps of a clock that starts with the record: they see it finely sampled too, since what they read between or beside samples
/// is the signal, without the noise of its samples.
const WITH_CLOCK: &[&str] = &[RUNS_AHEAD, "synchronous_tone"];
/// The one that soon sees what comes after the record.
const RUNS_AHEAD: &str = "clock_skew";
/// Motion after the end of the record, share of its length: no clock runs ahead further.
const TAIL: f64 = 0.05;

/// One record to be taken.
#[derive(Debug, Clone)]
pub(crate) struct Bench {
    /// Number of the record in its case: clocks have another phase in each.
    pub(crate) index: usize,
    /// One for each input of the model.
    pub(crate) signals: Vec<Signal>,
    /// Displacement of each mass where the motion begins, m.
    pub(crate) displacement: Vec<f64>,
    /// Velocity of each mass where the motion begins, m/s.
    pub(crate) velocity: Vec<f64>,
    pub(crate) time_step_s: f64,
    /// Samples of motion before the record starts; even.
    pub(crate) lead: usize,
    /// Samples of the record.
    pub(crate) len: usize,
    /// Time stamp of the first sample of the record, s.
    pub(crate) start_s: f64,
    /// Of the events of an effect that strikes at random, the share that does happen.
    pub(crate) struck_share: f64,
}

impl Bench {
    /// The inputs finely sampled, the lead included, nothing measured.
    pub(crate) fn fine_run(&self, model: &Model) -> Run {
        self.fine_run_until(model, self.len)
    }

    /// As [`Bench::fine_run`], to the given sample of the record.
    fn fine_run_until(&self, model: &Model, end: usize) -> Run {
        let step = self.time_step_s / OVERSAMPLING as f64;
        let len = (self.lead + end - 1) * OVERSAMPLING + 1;
        let begins_s = -(self.lead as f64) * self.time_step_s;
        let sampled = |signal: &Signal| -> Vec<f64> {
            (0..len)
                .map(|i| signal.at(begins_s + i as f64 * step))
                .collect()
        };
        Run {
            first_index: 0,
            name: String::new(),
            start_s: self.start_s + begins_s,
            time_step_s: step,
            len,
            inputs: self.signals.iter().map(sampled).collect(),
            measured: vec![None; model.outputs.len()],
            mended: simgap_simulate::Mended::default(),
        }
    }

    /// The inputs as recorded.
    pub(crate) fn inputs(&self) -> Vec<Vec<f64>> {
        let sampled = |signal: &Signal| -> Vec<f64> {
            (0..self.len)
                .map(|i| signal.at(i as f64 * self.time_step_s))
                .collect()
        };
        self.signals.iter().map(sampled).collect()
    }

    /// The inputs as a run of the record's own rate, nothing measured.
    pub(crate) fn coarse_run(&self, model: &Model) -> Run {
        Run {
            first_index: 0,
            name: String::new(),
            start_s: self.start_s,
            time_step_s: self.time_step_s,
            len: self.len,
            inputs: self.inputs(),
            measured: vec![None; model.outputs.len()],
            mended: simgap_simulate::Mended::default(),
        }
    }

    /// Outputs, sampled. `refinement` divides the fine step further; `noise`, one signal for each
    /// output, is added where sensors have it: before values are rounded, cut off or lost.
    pub(crate) fn outputs(
        &self,
        model: &Model,
        effects: &[Placed],
        refinement: usize,
        noise: Option<&[Vec<f64>]>,
    ) -> Result<Vec<Vec<f64>>, BlindError> {
        let (chain, plant): (Vec<Placed>, Vec<Placed>) = effects
            .iter()
            .map(|placed| placed.in_record(self.index))
            .partition(|placed| matches!(placed.action(), Action::Output(_) | Action::Sampling(_)));
        let is_ahead = chain.iter().any(|p| p.effect.kind() == RUNS_AHEAD);
        let tail = if is_ahead {
            TAIL * self.len as f64
        } else {
            0.0
        };
        let run = self.fine_run_until(model, self.len + tail as usize);
        let simulator = Simulator::new(model, &plant, refinement)?;
        let fine = simulator.predict(&run, &self.state(&simulator))?;
        Ok(fine
            .into_iter()
            .zip(&model.outputs)
            .enumerate()
            .map(|(c, (signal, output))| {
                let noise = noise.and_then(|noise| noise.get(c));
                self.record(signal, &output.channel, &chain, noise)
            })
            .collect())
    }

    /// Initial state of a simulator that may have more degrees of freedom than the model.
    pub(crate) fn state(&self, simulator: &Simulator) -> Vec<f64> {
        let n = simulator.state_len() / 2;
        let mut state = vec![0.0; 2 * n];
        for (i, (x, v)) in self.displacement.iter().zip(&self.velocity).enumerate() {
            state[i] = *x;
            state[n + i] = *v;
        }
        state
    }

    /// What the chain makes of a fine signal.
    fn record(
        &self,
        mut fine: Vec<f64>,
        channel: &str,
        chain: &[Placed],
        noise: Option<&Vec<f64>>,
    ) -> Vec<f64> {
        let here = |placed: &&Placed| placed.at == Location::Channel(channel.to_string());
        let has_memory = |placed: &&&Placed| WITH_MEMORY.contains(&placed.effect.kind());
        let has_clock = |placed: &&&Placed| WITH_CLOCK.contains(&placed.effect.kind());
        let apply = |values: &[f64], placed: &Placed, time_step_s: f64| {
            let mut random = Random::of_case(self.len as u64, self.index, 0);
            let struck = placed
                .effect
                .strike(&placed.values, values, &mut || random.unit());
            match placed.action() {
                Action::Output(_) | Action::Sampling(_) if struck.is_some() => {
                    let struck = struck.unwrap_or_default();
                    thinned(values, struck, self.struck_share, &mut random)
                }
                Action::Output(map) | Action::Sampling(map) => map.apply(Sampled {
                    start_s: self.start_s,
                    ..Sampled::from_start(values, time_step_s)
                }),
                _ => values.to_vec(),
            }
        };
        // What happens while sampling comes after what happens before, however it is listed.
        let mut chain: Vec<&Placed> = chain.iter().filter(here).collect();
        chain.sort_by_key(|placed| matches!(placed.action(), Action::Sampling(_)));
        let step = self.time_step_s / OVERSAMPLING as f64;
        for placed in chain.iter().filter(|p| has_memory(p)) {
            fine = apply(&fine, placed, step);
        }
        let mut fine = fine.split_off(self.lead * OVERSAMPLING);
        for placed in chain.iter().filter(|p| has_clock(p)) {
            fine = apply(&fine, placed, step);
        }
        let sampled = fine.iter().step_by(OVERSAMPLING).take(self.len);
        let mut sampled: Vec<f64> = sampled.copied().collect();
        if let Some(noise) = noise {
            sampled.iter_mut().zip(noise).for_each(|(y, e)| *y += e);
        }
        for placed in chain.iter().filter(|p| !has_memory(p) && !has_clock(p)) {
            sampled = apply(&sampled, placed, self.time_step_s);
        }
        sampled
    }

    /// What an unknown initial state can add to the outputs: the free responses of the model to a
    /// unit of each state, one set of outputs for each. A lightly damped plant rings at its own
    /// frequency, so its small parameter errors count.
    pub(crate) fn free_responses(
        &self,
        model: &Model,
        deviations: &[Placed],
    ) -> Result<Vec<Vec<Vec<f64>>>, BlindError> {
        let simulator = Simulator::new(model, deviations, OVERSAMPLING)?;
        let mut run = self.coarse_run(model);
        run.inputs.iter_mut().for_each(|u| u.fill(0.0));
        (0..simulator.state_len())
            .map(|i| {
                let mut state = vec![0.0; simulator.state_len()];
                // Small enough for an arm to swing like a linear oscillator.
                state[i] = 1e-3;
                Ok(simulator.predict(&run, &state)?)
            })
            .collect()
    }
}

/// Leaves out events, stretches where `struck` is not the signal, until the given share is left;
/// a larger share has those of a smaller one, and one at least.
fn thinned(signal: &[f64], mut struck: Vec<f64>, share: f64, random: &mut Random) -> Vec<f64> {
    let (mut is_inside, mut is_kept, mut events) = (false, true, 0);
    for (value, plain) in struck.iter_mut().zip(signal) {
        let is_struck = value != plain;
        if is_struck && !is_inside {
            is_kept = random.chance(share) || events == 0;
            events += 1;
        }
        is_inside = is_struck;
        if !is_kept {
            *value = *plain;
        }
    }
    struck
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_fewer_events_are_some_of_the_many() {
        let signal = vec![0.0; 40];
        let struck: Vec<f64> = (0..40).map(|i| f64::from(i / 2 % 2)).collect();
        let some = |share| thinned(&signal, struck.clone(), share, &mut Random::new(3));
        assert_eq!(some(1.0), struck);
        let (half, none) = (some(0.5), some(0.0));
        assert_eq!(none.iter().sum::<f64>(), 2.0);
        assert!((4.0..18.0).contains(&half.iter().sum::<f64>()));
        assert!(half.iter().zip(&none).all(|(h, n)| h >= n));
        // Whole events of two samples each.
        assert!(half.chunks(2).all(|pair| pair[0] == pair[1]));
    }
}
