//! A plant that is simulated from outside: what a simulator of the user's is asked and answers.

use thiserror::Error;

/// What a simulator is asked: the parameters, what drives it, and the forces at its ports, sample by sample.
#[derive(Debug, Clone, Copy)]
pub struct PlantRun<'a> {
    /// Name and value of every parameter, in the order of the model.
    pub parameters: &'a [(String, f64)],
    /// Sampling interval, s.
    pub time_step_s: f64,
    /// Number of samples; every signal has as many.
    pub len: usize,
    /// Name and signal of every input, in the order of the model. What it is between the samples is up to the simulator.
    pub inputs: &'a [(String, Vec<f64>)],
    /// Name and signal of the force at every port, N or N m, in the order of the model, each value held until the next sample.
    pub forces: &'a [(String, Vec<f64>)],
    /// Names of the outputs that are wanted.
    pub outputs: &'a [String],
}

/// A simulator of the user's.
///
/// Every run begins in the state that the simulator begins in. The same arguments give the same answer.
pub trait Plant: Send + Sync {
    /// The wanted outputs in their order, each as long as the run.
    ///
    /// # Errors
    /// [`PlantError`] when it cannot be simulated.
    fn simulate(&self, run: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError>;
}

/// Why a simulator of the user's gives no prediction.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlantError {
    /// The model is one of a simulator, and none was handed over.
    #[error(
        "model \"{model}\" stands for a simulator, needed is the simulator itself: it is asked from Python or Rust, not from a \
         model file"
    )]
    NoPlant {
        /// Name of the model.
        model: String,
    },
    /// It ended with an error of its own.
    #[error("the simulator failed: {reason}")]
    Failed {
        /// What it said.
        reason: String,
    },
    /// An output is not among its answers.
    #[error("the simulator gave no output \"{output}\", found is: {found}")]
    Missing {
        /// The wanted output.
        output: String,
        /// What it gave, separated by commas.
        found: String,
    },
    /// An output is too short or too long.
    #[error(
        "output \"{output}\" of the simulator has {found} values, needed is one for each of the {needed} samples of the inputs"
    )]
    Length {
        /// The output.
        output: String,
        /// Its length.
        found: usize,
        /// That of the run.
        needed: usize,
    },
    /// An output is not finite.
    #[error(
        "output \"{output}\" of the simulator is {found} at {time_s} s, needed is a finite number"
    )]
    NotFinite {
        /// The output.
        output: String,
        /// The value.
        found: f64,
        /// Time after the first sample, s.
        time_s: f64,
    },
    /// A force at a port does not move it.
    #[error(
        "a force at port \"{port}\" does not move its velocity in its own direction, needed is a simulator that applies the forces it \
         is given"
    )]
    StillPort {
        /// The port.
        port: String,
    },
    /// A force at a port makes the motion there grow beyond all bounds.
    #[error(
        "the motion of port \"{port}\" grows beyond all bounds under the force there, needed is one that the simulator can bear"
    )]
    RunsAway {
        /// The port.
        port: String,
    },
    /// The force at a port and the motion there do not settle.
    #[error(
        "the forces at the ports did not settle in {calls} simulations: the motion of port \"{port}\" still moves by {moved:.1e} of \
         its range"
    )]
    Unsettled {
        /// The port that moves most.
        port: String,
        /// Simulations tried.
        calls: usize,
        /// By how much of its range the motion moved last.
        moved: f64,
    },
}

/// The arguments of a simulation, hashed.
pub(crate) type Key = u128;

impl PlantRun<'_> {
    /// FNV-1a over the words of the arguments, in 128 bits.
    pub(crate) fn key(&self) -> Key {
        const START: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
        const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
        let signals = self.inputs.iter().chain(self.forces);
        let values = signals.flat_map(|(_, signal)| signal);
        let values = self.parameters.iter().map(|(_, value)| value).chain(values);
        // No force is none, whatever its sign.
        let words = values.map(|value| (value + 0.0).to_bits());
        let sizes = [self.time_step_s.to_bits(), self.len as u64];
        let all = sizes.into_iter().chain(words);
        all.fold(START, |hash, word| {
            (hash ^ u128::from(word)).wrapping_mul(PRIME)
        })
    }

    pub(crate) fn check(&self, signals: &[Vec<f64>]) -> Result<(), PlantError> {
        for (k, output) in self.outputs.iter().enumerate() {
            let signal = signals.get(k).map_or(&[][..], Vec::as_slice);
            if signal.len() != self.len {
                return Err(PlantError::Length {
                    output: output.clone(),
                    found: signal.len(),
                    needed: self.len,
                });
            }
            if let Some(sample) = signal.iter().position(|value| !value.is_finite()) {
                return Err(PlantError::NotFinite {
                    output: output.clone(),
                    found: signal[sample],
                    // To the microsecond: a stamp without digits that no clock has.
                    time_s: (sample as f64 * self.time_step_s * 1e6).round() / 1e6,
                });
            }
        }
        Ok(())
    }
}
