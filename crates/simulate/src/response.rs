//! What a force at a port does to a simulator, about a run without forces.
//!
//! ```text
//! h_q,s[n] = (y_s[n] under a force δ at port q over sample 0  −  y_s[n] without it) / δ            (1)
//! y_s = y_s⁰ + Σ_q Σ_(j ≤ n) h_q,s[n − j] (f_q[j] − f_q⁰[j])                                       (2)
//! ```
//!
//! (2) is exact where the simulator is linear; elsewhere it is the slope along which forces and motion are brought together.

use std::sync::Arc;

use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use crate::plant::{PlantError, PlantRun};

/// One signal for each output.
pub(crate) type Answer = Arc<Vec<Vec<f64>>>;
/// Asks a simulator.
pub(crate) type Ask<'a> = &'a dyn Fn(&PlantRun<'_>) -> Result<Answer, PlantError>;

/// The pulse moves the velocity of its port by this share of what it is without forces.
const PULSE_SHARE: f64 = 1e-2;
/// A pulse within this factor of the wanted one is one.
const NEAR: f64 = 10.0;
/// Pulses tried at the most; the first is 1 N or 1 N m.
const MOST_PULSES: usize = 12;
/// Factor to the next pulse where one moved nothing, or more than the simulator could bear.
const STRIDE: f64 = 1e3;
/// A response below this share of its largest value is none.
const NOTHING: f64 = 1e-7;
/// Samples that are summed one by one; longer stretches are convolved.
pub(crate) const BLOCK: usize = 64;

/// The responses of a simulator to a unit force over one sample, (1).
pub(crate) struct Response {
    /// By port q and output s, one value for each sample.
    pub(crate) unit: Vec<Vec<Vec<f64>>>,
    /// Samples after which a force moves its port: 0 where a sample is taken after the step, 1 where it is before.
    pub(crate) lag: usize,
    /// Displacement and velocity of each port among the outputs.
    pub(crate) ports: Vec<[usize; 2]>,
    /// The run that it was measured about, without forces.
    pub(crate) at_rest: Answer,
    /// Transforms of the response of the motion of each port from its lag on, by octave, then by port that pushes, then port
    /// and displacement or velocity.
    octaves: Vec<Octave>,
    whole: Whole,
}

struct Octave {
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    spectra: Vec<Vec<[Vec<Complex64>; 2]>>,
}

impl Response {
    /// Measures (1) of every port about a run without forces.
    pub(crate) fn measure(
        ask: Ask<'_>,
        still: &PlantRun<'_>,
        ports: &[[usize; 2]],
    ) -> Result<Response, PlantError> {
        let at_rest = ask(still)?;
        let mut unit = Vec::with_capacity(ports.len());
        for (q, &[_, velocity]) in ports.iter().enumerate() {
            let wanted = PULSE_SHARE * range(&at_rest[velocity]);
            unit.push(pulse(ask, still, (q, velocity), &at_rest, wanted)?);
        }
        let sets_in = |(q, &[_, velocity]): (usize, &[usize; 2])| {
            let own: &Vec<f64> = &unit[q][velocity];
            let least = NOTHING * largest(own);
            own.iter().position(|value| value.abs() > least)
        };
        let lag = ports
            .iter()
            .enumerate()
            .filter_map(sets_in)
            .min()
            .unwrap_or(0);
        for (q, &[_, velocity]) in ports.iter().enumerate() {
            let own = unit[q][velocity].get(lag).copied().unwrap_or(0.0);
            // A pulse moves its own port forwards.
            if own <= 0.0 {
                let port = still.forces[q].0.clone();
                return Err(PlantError::StillPort { port });
            }
        }
        let mut response = Response {
            unit,
            lag,
            ports: ports.to_vec(),
            at_rest,
            octaves: vec![],
            whole: Whole::new(still.len),
        };
        let of_port = |unit: &Vec<Vec<f64>>| {
            let outputs = unit.iter();
            outputs.map(|of| response.whole.transformed(of)).collect()
        };
        let spectra: Vec<Vec<Vec<Complex64>>> = response.unit.iter().map(of_port).collect();
        response.whole.spectra = spectra;
        response.transform(still.len);
        Ok(response)
    }

    /// Transforms for stretches of `BLOCK`, 2 `BLOCK`, ... samples.
    fn transform(&mut self, len: usize) {
        let mut planner = FftPlanner::new();
        let mut stretch = BLOCK;
        while stretch < len {
            let size = 2 * stretch;
            let forward = planner.plan_fft_forward(size);
            let of_signal = |signal: &Vec<f64>| {
                let late = signal.iter().skip(self.lag).take(size);
                let mut values: Vec<Complex64> =
                    late.map(|value| Complex64::new(*value, 0.0)).collect();
                values.resize(size, Complex64::default());
                forward.process(&mut values);
                values
            };
            let of_port = |unit: &Vec<Vec<f64>>| {
                let ports = self.ports.iter();
                ports
                    .map(|motion| motion.map(|s| of_signal(&unit[s])))
                    .collect()
            };
            self.octaves.push(Octave {
                spectra: self.unit.iter().map(of_port).collect(),
                inverse: planner.plan_fft_inverse(size),
                forward,
            });
            stretch = size;
        }
    }

    /// Octave of the shortest stretch that so many steps fit into.
    pub(crate) fn octave_of(&self, steps: usize) -> usize {
        steps.div_ceil(BLOCK).next_power_of_two().trailing_zeros() as usize
    }

    /// Adds to the motion of the ports what forces over `from..from + stretch` do in the stretch after them; forces by port,
    /// motion by port and displacement or velocity, from the lag on.
    pub(crate) fn carry(
        &self,
        octave: usize,
        from: usize,
        forces: &[Vec<f64>],
        motion: &mut [[Vec<f64>; 2]],
    ) {
        let Some(own) = self.octaves.get(octave) else {
            return;
        };
        let stretch = BLOCK << octave;
        let size = 2 * stretch;
        let mut sums = vec![
            [
                vec![Complex64::default(); size],
                vec![Complex64::default(); size]
            ];
            motion.len()
        ];
        for (force, spectra) in forces.iter().zip(&own.spectra) {
            let end = (from + stretch).min(force.len());
            let part = force.get(from..end).unwrap_or_default();
            if part.iter().all(|value| *value == 0.0) {
                continue;
            }
            let mut values: Vec<Complex64> = part
                .iter()
                .map(|value| Complex64::new(*value, 0.0))
                .collect();
            values.resize(size, Complex64::default());
            own.forward.process(&mut values);
            for (sums, spectra) in sums.iter_mut().zip(spectra) {
                for (sum, spectrum) in sums.iter_mut().zip(spectra) {
                    for ((sum, a), b) in sum.iter_mut().zip(&values).zip(spectrum) {
                        *sum += a * b;
                    }
                }
            }
        }
        for (motion, sums) in motion.iter_mut().zip(&mut sums) {
            for (motion, sum) in motion.iter_mut().zip(sums) {
                own.inverse.process(sum);
                let after = motion.iter_mut().skip(from + stretch).take(stretch);
                for (value, carried) in after.zip(&sum[stretch..]) {
                    *value += carried.re / size as f64;
                }
            }
        }
    }

    /// Adds to every output what forces beyond those of a simulation do, (2).
    pub(crate) fn add_beyond(&self, forces: &[Vec<f64>], outputs: &mut [Vec<f64>]) {
        let size = self.whole.size;
        let transformed: Vec<Vec<Complex64>> = forces
            .iter()
            .map(|force| self.whole.transformed(force))
            .collect();
        for (s, output) in outputs.iter_mut().enumerate() {
            let mut sum = vec![Complex64::default(); size];
            for (force, spectra) in transformed.iter().zip(&self.whole.spectra) {
                for ((sum, a), b) in sum.iter_mut().zip(force).zip(&spectra[s]) {
                    *sum += a * b;
                }
            }
            self.whole.inverse.process(&mut sum);
            let values = output.iter_mut().zip(&sum);
            values.for_each(|(value, more)| *value += more.re / size as f64);
        }
    }
}

/// Convolutions over a whole run.
struct Whole {
    size: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// Transforms of the responses, by port and output.
    spectra: Vec<Vec<Vec<Complex64>>>,
}

impl Whole {
    fn new(len: usize) -> Whole {
        let size = (2 * len).next_power_of_two();
        let mut planner = FftPlanner::new();
        Whole {
            size,
            forward: planner.plan_fft_forward(size),
            inverse: planner.plan_fft_inverse(size),
            spectra: vec![],
        }
    }

    fn transformed(&self, signal: &[f64]) -> Vec<Complex64> {
        let values = signal.iter().map(|value| Complex64::new(*value, 0.0));
        let mut values: Vec<Complex64> = values.collect();
        values.resize(self.size, Complex64::default());
        self.forward.process(&mut values);
        values
    }
}

/// (1) of one port for every output, with a pulse that moves its velocity by about as much as is wanted. `still` has no
/// force at any port, and `at_rest` is what it gives.
fn pulse(
    ask: Ask<'_>,
    still: &PlantRun<'_>,
    (q, velocity): (usize, usize),
    at_rest: &[Vec<f64>],
    wanted: f64,
) -> Result<Vec<Vec<f64>>, PlantError> {
    let mut size = 1.0;
    for _ in 0..MOST_PULSES {
        let mut forces = still.forces.to_vec();
        if let Some(first) = forces[q].1.first_mut() {
            *first = size;
        }
        let pushed = match ask(&PlantRun {
            forces: &forces,
            ..*still
        }) {
            Ok(pushed) => pushed,
            // More than the simulator can bear.
            Err(PlantError::NotFinite { .. }) => {
                size /= STRIDE;
                continue;
            }
            Err(error) => return Err(error),
        };
        let apart = |s: usize| {
            pushed[s]
                .iter()
                .zip(&at_rest[s])
                .map(|(a, b)| (a - b) / size)
        };
        let moved = size * largest(&apart(velocity).collect::<Vec<f64>>());
        let ratio = wanted / moved;
        if moved == 0.0 {
            size *= STRIDE;
        } else if wanted == 0.0 || (1.0 / NEAR..=NEAR).contains(&ratio) {
            return Ok((0..at_rest.len()).map(|s| apart(s).collect()).collect());
        } else {
            size *= ratio;
        }
    }
    Err(PlantError::StillPort {
        port: still.forces[q].0.clone(),
    })
}

/// Largest absolute value.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |most, value| f64::max(most, value.abs()))
}

/// Largest less smallest value.
pub(crate) fn range(values: &[f64]) -> f64 {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = values.iter().fold(start, |[low, high], v| {
        [f64::min(low, *v), f64::max(high, *v)]
    });
    if low < high { high - low } else { 0.0 }
}
