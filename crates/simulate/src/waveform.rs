//! Forces at the ports of a simulator and the motion they make, brought together over a whole run.
//!
//! The force of a law depends on the motion, the motion on the force, and a simulator is only told whole signals. So the laws are
//! marched along what the simulator last said, moved by its response to what the forces have changed since
//! ([`crate::response`], (2)); the simulator is asked with the forces that come out; and so on until its answer is what the march
//! took it to be. Where the simulator is linear that is one question; elsewhere each answer puts right what the response had wrong,
//! from the first sample on.

use simgap_integrate::exact::MemberMotion;

use crate::plant::PlantError;
use crate::port_law::{Course, PortLaw, Step};
use crate::response::{Answer, BLOCK, Response, range};

/// Questions at the most.
const MOST_CALLS: usize = 60;
/// The march and the simulator agree where no motion of a port differs by more than this share of its range.
const AGREED: f64 = 1e-5;
/// The same where nothing is left to be put right.
const SAME: f64 = 1e-9;
/// The same after some questions: far below what a diagnosis takes for the accuracy of a simulation.
const NEARLY_AGREED: f64 = 1e-4;
const SOME_CALLS: usize = 12;
/// Motion of a port beyond this many times its range without forces is none that a simulator should be asked for.
const RUNS_AWAY: f64 = 1e3;
/// Sweeps over several laws within a step, and the change that ends them.
const SWEEPS: usize = 60;
const SETTLED: f64 = 1e-12;

/// When things happen.
#[derive(Clone, Copy)]
pub(crate) struct Times {
    pub(crate) start_s: f64,
    pub(crate) step_s: f64,
    pub(crate) len: usize,
}

/// Forces that agree with the motion they make, and what the simulator says with them in it.
pub(crate) struct Settled {
    /// One signal for each output.
    pub(crate) outputs: Vec<Vec<f64>>,
    /// What the simulator was last asked with, by port.
    pub(crate) forces: Vec<Vec<f64>>,
}

/// What the simulator says with the forces of the laws in it. Where it begins (`forces`) decides how often it is asked, and
/// nothing beyond the accuracy of the answer.
///
/// # Errors
/// [`PlantError::Unsettled`], and those of the simulator.
pub(crate) fn settle(
    laws: &[PortLaw],
    response: &Response,
    times: Times,
    mut forces: Vec<Vec<f64>>,
    ask: impl Fn(&[Vec<f64>]) -> Result<Answer, PlantError>,
    name: impl Fn(usize) -> String,
) -> Result<Settled, PlantError> {
    let mut answer = ask(&forces)?;
    let mut apart = (0, f64::INFINITY);
    for call in 0..MOST_CALLS {
        let mut march = March::new(laws, response, times, &answer, &forces);
        let stretch = BLOCK << response.octave_of(march.steps);
        march.solve(0, stretch);
        if let Some(port) = march.runs_away(&response.at_rest) {
            return Err(PlantError::RunsAway { port: name(port) });
        }
        apart = far(&march.motion, response, &answer);
        let enough = match call {
            0..SOME_CALLS => AGREED,
            _ => NEARLY_AGREED,
        };
        if apart.1 <= enough {
            let mut outputs = answer.to_vec();
            response.add_beyond(&march.change, &mut outputs);
            return Ok(Settled { outputs, forces });
        }
        let (change, motion) = (march.change, march.motion);
        for (force, change) in forces.iter_mut().zip(&change) {
            force
                .iter_mut()
                .zip(change)
                .for_each(|(force, change)| *force += change);
        }
        answer = ask(&forces)?;
        // Where the simulator is linear the march has said it all.
        if far(&motion, response, &answer).1 <= SAME {
            let outputs = answer.to_vec();
            return Ok(Settled { outputs, forces });
        }
    }
    Err(PlantError::Unsettled {
        port: name(apart.0),
        calls: MOST_CALLS,
        moved: apart.1,
    })
}

/// The laws marched along an answer.
struct March<'a> {
    laws: &'a [PortLaw],
    response: &'a Response,
    times: Times,
    /// Forces of the answer, by port.
    forces: &'a [Vec<f64>],
    /// Steps that have an end within the run.
    steps: usize,
    /// Motion of the ports at the end of each step: that of the answer, moved by the changes of forces in earlier blocks.
    motion: Vec<[Vec<f64>; 2]>,
    /// How the forces differ from those of the answer.
    change: Vec<Vec<f64>>,
    courses: Vec<Course>,
    /// What a force of each law moves each law by, laws × laws: displacement and velocity.
    compliance: Vec<[f64; 2]>,
}

impl<'a> March<'a> {
    fn new(
        laws: &'a [PortLaw],
        response: &'a Response,
        times: Times,
        answer: &Answer,
        forces: &'a [Vec<f64>],
    ) -> March<'a> {
        let lag = response.lag;
        let ports = &response.ports;
        let late = |s: usize| answer[s].get(lag..).unwrap_or_default().to_vec();
        let at_lag = |q: usize, s: usize| response.unit[q][s].get(lag).copied().unwrap_or(0.0);
        let compliance = laws.iter().flat_map(|moved| {
            laws.iter().map(move |pushing| {
                [0, 1].map(|k| {
                    let of_port = |p: usize| {
                        let each =
                            (0..ports.len()).map(|q| pushing.push(q) * at_lag(q, ports[p][k]));
                        each.sum::<f64>()
                    };
                    // A force of the law moves it back.
                    -moved.across(of_port)
                })
            })
        });
        let first = |law: &PortLaw| {
            let [displacement, velocity] =
                [0, 1].map(|k| law.across(|p| answer[ports[p][k]].first().copied().unwrap_or(0.0)));
            let from = MemberMotion {
                displacement,
                velocity,
                time_s: times.start_s,
                step_s: times.step_s,
            };
            Course::new(law.law.as_ref(), from)
        };
        March {
            laws,
            response,
            times,
            forces,
            steps: times.len.saturating_sub(lag),
            motion: ports.iter().map(|motion| motion.map(late)).collect(),
            change: vec![vec![0.0; times.len]; ports.len()],
            courses: laws.iter().map(first).collect(),
            compliance: compliance.collect(),
        }
    }

    /// Solves `stretch` steps from one on; the stretch is a block doubled some times.
    fn solve(&mut self, from: usize, stretch: usize) {
        if from >= self.steps {
            return;
        }
        if stretch > BLOCK {
            let half = stretch / 2;
            self.solve(from, half);
            let octave = (half / BLOCK).trailing_zeros() as usize;
            self.response
                .carry(octave, from, &self.change, &mut self.motion);
            self.solve(from + half, half);
            return;
        }
        for step in from..(from + stretch).min(self.steps) {
            self.step(from, step);
        }
        // After the last step nothing moves any more.
    }

    /// One step of a block that begins at `from`: afterwards its motion is what it is under all forces.
    fn step(&mut self, from: usize, step: usize) {
        let response = self.response;
        let lag = response.lag;
        for (p, motion) in self.motion.iter_mut().enumerate() {
            for (k, motion) in motion.iter_mut().enumerate() {
                let s = response.ports[p][k];
                for (q, change) in self.change.iter().enumerate() {
                    let unit = &response.unit[q][s];
                    let before = (from..step).map(|j| unit[step - j + lag] * change[j]);
                    motion[step] += before.sum::<f64>() - unit[lag] * self.forces[q][step];
                }
            }
        }
        let free: Vec<Step> = self.laws.iter().map(|law| self.free(law, step)).collect();
        self.solve_laws(&free);
        for q in 0..self.change.len() {
            let laws = self.laws.iter().zip(&self.courses);
            let force: f64 = laws.map(|(law, course)| law.push(q) * course.force).sum();
            self.change[q][step] = force - self.forces[q][step];
            for (p, motion) in self.motion.iter_mut().enumerate() {
                for (k, motion) in motion.iter_mut().enumerate() {
                    motion[step] += response.unit[q][response.ports[p][k]][lag] * force;
                }
            }
        }
    }

    /// The end of a step across a law without the forces of the laws.
    fn free(&self, law: &PortLaw, step: usize) -> Step {
        Step {
            free: [0, 1].map(|k| law.across(|p| self.motion[p][k][step])),
            compliance: [0.0; 2],
            time_s: self.times.start_s + (step + self.response.lag) as f64 * self.times.step_s,
            step_s: self.times.step_s,
        }
    }

    /// The laws of a step, one after the other until they settle.
    fn solve_laws(&mut self, free: &[Step]) {
        let count = self.laws.len();
        let mut ends = free.to_vec();
        for _ in 0..SWEEPS {
            let mut is_settled = true;
            for i in 0..count {
                let row = &self.compliance[i * count..(i + 1) * count];
                let moved = |k: usize| {
                    let others = self.courses.iter().zip(row).enumerate();
                    let others = others.filter(|(j, _)| *j != i);
                    others
                        .map(|(_, (course, row))| row[k] * course.force)
                        .sum::<f64>()
                };
                ends[i] = Step {
                    free: [0, 1].map(|k| free[i].free[k] - moved(k)),
                    compliance: row[i],
                    ..free[i]
                };
                let before = self.courses[i].force;
                let force = self.courses[i].solve(self.laws[i].law.as_ref(), &ends[i]);
                is_settled &= (force - before).abs() <= SETTLED * force.abs();
            }
            if is_settled || count == 1 {
                break;
            }
        }
        for ((course, law), end) in self.courses.iter_mut().zip(self.laws).zip(&ends) {
            course.advance(law.law.as_ref(), end);
        }
    }

    /// A port whose motion grows beyond all bounds.
    fn runs_away(&self, nominal: &Answer) -> Option<usize> {
        let ports = self.motion.iter().zip(&self.response.ports);
        let mut beyond = ports.map(|(motion, signals)| {
            motion.iter().zip(signals).any(|(motion, signal)| {
                let most = match RUNS_AWAY * range(&nominal[*signal]) {
                    most if most > 0.0 => most,
                    _ => f64::MAX,
                };
                motion.iter().any(|value| !value.is_finite()) || range(motion) > most
            })
        });
        beyond.position(|beyond| beyond)
    }
}

/// The port whose motion (from the lag on) is farthest from that of an answer, and how far, over its range.
fn far(motion: &[[Vec<f64>; 2]], response: &Response, answer: &Answer) -> (usize, f64) {
    let ports = motion.iter().zip(&response.ports).enumerate();
    let far = ports.map(|(p, (motion, signals))| {
        let of_signal = [0, 1].map(|k| {
            let signal = &answer[signals[k]];
            let late = signal.get(response.lag..).unwrap_or_default();
            let apart = motion[k].iter().zip(late).map(|(a, b)| (a - b).abs());
            let size = f64::max(range(signal), range(&motion[k]));
            apart.fold(0.0, f64::max) / size.max(f64::MIN_POSITIVE)
        });
        (p, of_signal[0].max(of_signal[1]))
    });
    far.fold(
        (0, 0.0),
        |most, one| if one.1 > most.1 { one } else { most },
    )
}
