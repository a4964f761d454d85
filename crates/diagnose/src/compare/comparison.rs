//! The answer of a comparison, as it is written to `comparison.json`.

use serde::Serialize;

use crate::diagnosis::{CandidateResult, Verdict, Where};

/// Two traces compared: how far apart, where, what it looks like, and what of it the measurement
/// chain explains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// `simgap-comparison/1`.
    pub schema: &'static str,
    /// File name of the measured record.
    pub measured: String,
    /// File name of the simulated record.
    pub simulated: String,
    /// The stretch both cover.
    pub time: CommonTime,
    /// How well each channel agrees, over that stretch.
    pub channels: Vec<Agreement>,
    /// Columns that drive both.
    pub inputs: Vec<SharedInput>,
    /// How much of the gap faults of the measurement chain explain, on the held-back last third.
    pub gap: ChainGap,
    /// Where the discrepancy lies, over the whole stretch.
    pub r#where: Where,
    /// Which faults of the measurement chain explain it. `effect`: these do; `none`: the gap is
    /// noise; `unknown`: there is structure that no fault of the chain explains, so look for it in
    /// the model.
    pub chain: Verdict,
    /// What the discrepancy of each channel looks like.
    pub look: Vec<Look>,
    /// Single faults of the chain that were tried.
    pub candidates: Vec<CandidateResult>,
    /// What a reader must know.
    pub notes: Vec<String>,
}

/// The stretch that both records cover, on the stamps of the measured one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CommonTime {
    /// First stamp, s.
    pub from_s: f64,
    /// Last stamp, s.
    pub to_s: f64,
    /// s.
    pub time_step_s: f64,
    /// Samples.
    pub rows: usize,
    /// Whether the simulated trace was interpolated to these stamps.
    pub resampled: bool,
}

/// Agreement of one channel. Metrics of magnitude are positive where the simulation is too large.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Agreement {
    /// Column of the measured record.
    pub channel: String,
    /// Column of the simulated record.
    pub simulated: String,
    /// SI unit, or the unit of the columns where it is none of motion or force.
    pub unit: String,
    /// rms(measured − simulated) / std(measured).
    pub nrmse: f64,
    /// 1 − nrmse².
    pub r_squared: f64,
    /// Correlation coefficient.
    pub correlation: f64,
    /// rms of the discrepancy, in the unit.
    pub rms: f64,
    /// Largest discrepancy, in the unit.
    pub largest: f64,
    /// Sprague and Geers: magnitude, phase and both together.
    pub sprague_geers: Option<MagnitudePhase>,
    /// Russell: magnitude, phase and both together.
    pub russell: Option<MagnitudePhase>,
    /// ISO/TS 18571.
    pub iso18571: Option<Rating>,
}

/// A metric of two parts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MagnitudePhase {
    /// Signed.
    pub magnitude: f64,
    /// 0 in phase, 1 opposite.
    pub phase: f64,
    /// Both together.
    pub comprehensive: f64,
}

/// Scores of ISO/TS 18571, 0 to 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rating {
    /// Corridor.
    pub corridor: f64,
    /// Phase.
    pub phase: f64,
    /// Magnitude.
    pub magnitude: f64,
    /// Slope.
    pub slope: f64,
    /// Weighted total.
    pub total: f64,
    /// `excellent`, `good`, `fair` or `poor`.
    pub grade: &'static str,
    /// Only every so manieth sample was rated; the specification has no bound, its cost has.
    pub every: usize,
}

/// A column that drives both, or should.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SharedInput {
    /// Column.
    pub channel: String,
    /// rms(measured − simulated) / std(measured); zero for the same input.
    pub nrmse: f64,
}

/// nrmse over the held-back last third, as in a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChainGap {
    /// `nrmse`.
    pub metric: &'static str,
    /// As simulated.
    pub simulated: f64,
    /// With the named faults of the chain put on the simulated trace.
    pub corrected: f64,
    /// What noise alone leaves.
    pub noise_floor: f64,
    /// How much of what stands out of the noise is closed, 0 to 1.
    pub closed: f64,
}

/// What the discrepancy of one channel looks like. Shares are of its mean square.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Look {
    /// Channel.
    pub channel: String,
    /// The line that carries more than half of the motion, if there is one, Hz.
    pub main_line_hz: Option<f64>,
    /// Its mean.
    pub constant_share: f64,
    /// What some linear filter of the simulated trace explains of the rest: gain, delay, another
    /// frequency response.
    pub linear_share: f64,
    /// Lines at multiples of the main line, from two on.
    pub harmonic_share: Option<f64>,
    /// White noise.
    pub noise_share: f64,
    /// Correlation of neighbouring samples: near one slow, zero white, minus one alternating.
    pub neighbour_correlation: f64,
    /// Power of the simulated amplitude with which it grows: one for linear, three for a cubic law, zero for
    /// noise, a tone or dry friction. Told where the amplitude varies enough.
    pub amplitude_power: Option<f64>,
    /// The same in words.
    pub sentences: Vec<String>,
}
