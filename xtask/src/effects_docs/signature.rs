//! What an effect does, as two curves: without it and with it.
//!
//! | Action | Curves | Over |
//! |---|---|---|
//! | a force law | force of the members along a prescribed motion | displacement, velocity, or time where it has a clock |
//! | a change of the model, a mode | receptance of the table | frequency |
//! | a change of a hydraulic drive | displacement of the table that follows a set point | time |
//! | a change of a load | force along the travel | displacement |
//! | a map of an input | what is commanded, what reaches the table | time |
//! | a map of an output | true displacement, what is stored | time |

use std::f64::consts::TAU;

use simgap_effects::{Action, Effect, Placed, Sampled, SignalMap};
use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_model::{FrfKind, Model, ModelError, frequency_response};
use simgap_simulate::SimulateError;

use super::drive::follows;
use super::machine::{AMPLITUDE_M, COARSENING, Stage, displacement, pulses, times};

/// A curve, point by point.
pub(super) type Curve = Vec<(f64, f64)>;

/// What a signature is drawn over.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Over {
    Displacement,
    Velocity,
    Frequency,
    /// Force or signal over time.
    Time,
}

/// A signature.
pub(super) struct Signature {
    pub(super) over: Over,
    /// Ends of the axis; from the curves if `None`.
    pub(super) range: Option<[f64; 2]>,
    pub(super) without: Curve,
    pub(super) with: Curve,
    /// Whether the second curve is a list of samples.
    pub(super) samples: bool,
    /// Size of the change, relative to what is there without the effect.
    pub(super) change: f64,
    /// What the curves show, and its unit.
    pub(super) quantity: (&'static str, &'static str),
}

/// Points of a cycle of the motion: for a law with a memory or a clock, and for one that is drawn
/// over half a cycle.
const PER_CYCLE: usize = 150;
const PER_FINE_CYCLE: usize = 600;
/// Amplitudes of the cycles that a law with a memory is taken through.
const CYCLES: [f64; 3] = [1.0, 0.65, 0.3];
/// A force of which one variable explains this share is a function of it.
const FUNCTION: f64 = 0.98;
/// Frequencies of the response, Hz.
const FREQS_HZ: [f64; 2] = [0.5, 30.0];
const FREQ_COUNT: usize = 220;
/// The share of the variance by which velocity must explain a force better than displacement.
const CLEARLY: f64 = 0.05;

/// What the curves of a signal are called, and their unit.
const INPUT: (&str, &str) = ("input", "N");
const OUTPUT: (&str, &str) = ("output", "mm");

/// The signature of an effect with these values.
pub(super) fn signature(stage: &Stage, values: &[f64]) -> Result<Signature, SimulateError> {
    if stage.effect.site().is_hydraulic() {
        return of_drive(stage, values);
    }
    match stage.effect.action(values) {
        Action::Force(law) => Ok(of_law(stage, law.as_ref())),
        Action::Member(build) => Ok(of_law(stage, build(&stage.model, &stage.at).as_ref())),
        Action::Model(change) | Action::Mode { change, .. } => {
            let mut changed = stage.model.clone();
            change(&mut changed, &stage.at);
            if changed.loads != stage.model.loads {
                return Ok(of_load(stage, &changed));
            }
            Ok(of_response(&stage.model, &changed)?)
        }
        Action::Input(map) => Ok(of_signal(map.as_ref(), &pulses(), 1.0, INPUT)),
        Action::Output(map) => Ok(of_signal(map.as_ref(), &displacement()?, 1e3, OUTPUT)),
        Action::Sampling(map) => Ok(of_samples(
            stage.effect,
            values,
            map.as_ref(),
            &displacement()?,
        )),
    }
}

/// A back and forth motion across the members: cycles of several amplitudes, from `first` to `last`
/// in cycles; no point lies at a reversal.
fn motion(cycles: &[f64], per_cycle: usize, first: f64, last: f64) -> Vec<MemberMotion> {
    let freq = Stage::natural_hz();
    let count = ((last - first) * per_cycle as f64) as usize;
    let at = |n: usize| {
        let turns = first + (n as f64 + 0.5) / per_cycle as f64;
        let cycle = (turns.max(0.0) as usize).min(cycles.len() - 1);
        let amplitude = cycles[cycle] * AMPLITUDE_M;
        MemberMotion {
            displacement: amplitude * (TAU * turns).sin(),
            velocity: amplitude * TAU * freq * (TAU * turns).cos(),
            time_s: turns / freq,
            step_s: 0.0,
        }
    };
    (0..count).map(at).collect()
}

/// The force of a law along a motion; its memory is carried through the motion once before.
fn along(law: &dyn ForceLaw, motion: &[MemberMotion]) -> Vec<f64> {
    let mut memory = law.first_memory();
    let mut before = motion.first().copied().unwrap_or_default();
    let mut forces = Vec::new();
    for pass in 0..2 {
        for &here in motion {
            let smooth = if law.remembers() {
                let moved = law.follow(memory, before, here);
                memory = moved.memory;
                moved.force
            } else {
                law.force(here)
            };
            let dry = law.dry_level(here.velocity.abs()).unwrap_or(0.0);
            if pass == 1 {
                forces.push(smooth + dry * here.velocity.signum());
            }
            before = here;
        }
    }
    forces
}

/// The share of the variance of `force` that its mean in forty bins of `of` explains.
fn explained(force: &[f64], of: impl Fn(usize) -> f64) -> f64 {
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    let reach = (0..force.len()).map(|i| of(i).abs()).fold(0.0, f64::max);
    let mut bins = [(0.0, 0.0); 40];
    for (i, f) in force.iter().enumerate() {
        let bin = ((of(i) / reach + 1.0) * 20.0) as usize;
        let bin = &mut bins[bin.min(39)];
        *bin = (bin.0 + f - mean, bin.1 + 1.0);
    }
    let between: f64 = bins
        .iter()
        .map(|(sum, n)| sum * sum / f64::max(*n, 1.0))
        .sum();
    let all: f64 = force.iter().map(|f| (f - mean).powi(2)).sum();
    between / all.max(f64::MIN_POSITIVE)
}

/// The motion that a law is drawn along, and over what.
fn drawn_along(stage: &Stage, law: &dyn ForceLaw) -> (Over, Vec<MemberMotion>) {
    let several = motion(&CYCLES, PER_CYCLE, 0.0, CYCLES.len() as f64);
    if stage.effect.clock().is_some() {
        return (Over::Time, motion(&[1.0], PER_CYCLE, 0.0, 3.0));
    }
    if law.remembers() {
        return (Over::Displacement, several);
    }
    let forces = along(law, &several);
    let by_displacement = explained(&forces, |i| several[i].displacement);
    let by_velocity = explained(&forces, |i| several[i].velocity);
    // Half a cycle shows a function whole; anything else needs all of it.
    if by_velocity > by_displacement + CLEARLY {
        let from = if by_velocity > FUNCTION { 0.5 } else { 0.0 };
        return (Over::Velocity, motion(&[1.0], PER_FINE_CYCLE, from, 1.0));
    }
    let to = if by_displacement > FUNCTION || forces.iter().all(|f| *f == forces[0]) {
        0.25
    } else {
        0.75
    };
    (
        Over::Displacement,
        motion(&[1.0], PER_FINE_CYCLE, -0.25, to),
    )
}

/// A point of the curve without the effect: of the other members those that act over the same
/// variable.
fn members(stage: &Stage, over: Over, motion: &MemberMotion) -> (f64, f64) {
    let springs = stage.members_force(motion.displacement, 0.0);
    match over {
        Over::Velocity => (motion.velocity, stage.members_force(0.0, motion.velocity)),
        Over::Time => (motion.time_s, springs),
        Over::Displacement | Over::Frequency => (1e3 * motion.displacement, springs),
    }
}

fn of_law(stage: &Stage, law: &dyn ForceLaw) -> Signature {
    let (over, motions) = drawn_along(stage, law);
    let forces = along(law, &motions);
    let timed = over == Over::Time;
    let without: Curve = motions.iter().map(|m| members(stage, over, m)).collect();
    let with: Curve = without
        .iter()
        .zip(&forces)
        .map(|((x, y), f)| (*x, y + f))
        .collect();
    let change = relative(&without, &with, AMPLITUDE_M * 1e3);
    let without = if timed {
        without
    } else {
        ends(&without).to_vec()
    };
    let top_speed = AMPLITUDE_M * TAU * Stage::natural_hz();
    let range = match over {
        Over::Displacement => [-1e3 * AMPLITUDE_M, 1e3 * AMPLITUDE_M],
        Over::Velocity => [-top_speed, top_speed],
        _ => [0.0, motions.last().map_or(1.0, |m| m.time_s)],
    };
    Signature {
        over,
        range: Some(range),
        without,
        with,
        samples: false,
        change,
        quantity: ("force", "N"),
    }
}

/// The leftmost and the rightmost point: what a straight line needs.
fn ends(curve: &[(f64, f64)]) -> [(f64, f64); 2] {
    let first = curve.first().copied().unwrap_or_default();
    curve.iter().fold([first; 2], |[left, right], &p| {
        [
            if p.0 < left.0 { p } else { left },
            if p.0 > right.0 { p } else { right },
        ]
    })
}

/// rms of the difference of two curves over that of the first; where the first is nothing, over a
/// size that is usual.
fn relative(without: &[(f64, f64)], with: &[(f64, f64)], usual: f64) -> f64 {
    let rms = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0.0_f64), |(s, n), v| (s + v * v, n + 1.0));
        (sum / count.max(1.0)).sqrt()
    };
    let there = rms(&mut without.iter().map(|p| p.1));
    let moved = rms(&mut without.iter().zip(with).map(|(a, b)| b.1 - a.1));
    moved / if there > 0.0 { there } else { usual }
}

/// Force on the table along its travel: that of the members less the load.
fn of_load(stage: &Stage, changed: &Model) -> Signature {
    let at = |model: &Model, displacement: f64| {
        let load: f64 = model.load_vector().iter().sum();
        let force = stage.members_force(displacement, 0.0) - load;
        (1e3 * displacement, force)
    };
    let line = |model: &Model| [-AMPLITUDE_M, AMPLITUDE_M].map(|d| at(model, d)).to_vec();
    let (without, with) = (line(&stage.model), line(changed));
    Signature {
        over: Over::Displacement,
        range: Some([-1e3 * AMPLITUDE_M, 1e3 * AMPLITUDE_M]),
        change: relative(&without, &with, AMPLITUDE_M * 1e3),
        without,
        with,
        samples: false,
        quantity: ("force", "N"),
    }
}

fn of_response(before: &Model, after: &Model) -> Result<Signature, ModelError> {
    let receptance = |model: &Model| -> Result<Curve, ModelError> {
        let structure = model.tangent_matrices()?;
        let ratio = (FREQS_HZ[1] / FREQS_HZ[0]).ln();
        (0..FREQ_COUNT)
            .map(|n| {
                let freq = FREQS_HZ[0] * (ratio * n as f64 / (FREQ_COUNT - 1) as f64).exp();
                let response = frequency_response(&structure, freq, FrfKind::Receptance)?;
                Ok((freq, 1e3 * response[(0, 0)].norm()))
            })
            .collect()
    };
    let (without, with) = (receptance(before)?, receptance(after)?);
    let ratios = without.iter().zip(&with).map(|(a, b)| (b.1 / a.1).ln());
    let change = (ratios.map(|r| r * r).sum::<f64>() / FREQ_COUNT as f64).sqrt();
    Ok(Signature {
        over: Over::Frequency,
        range: None,
        without,
        with,
        samples: false,
        change,
        quantity: ("displacement per force", "mm/N"),
    })
}

/// The motion of a hydraulic drive under position control.
fn of_drive(stage: &Stage, values: &[f64]) -> Result<Signature, SimulateError> {
    let effect = Placed::new(stage.effect, stage.at.clone(), values.to_vec());
    let line = |effects: &[Placed]| -> Result<Curve, SimulateError> {
        Ok(curve(times().into_iter(), &follows(stage, effects)?, 1e3))
    };
    let (without, with) = (line(&[])?, line(&[effect])?);
    Ok(Signature {
        over: Over::Time,
        range: None,
        change: relative(&without, &with, 1.0),
        without,
        with,
        samples: false,
        quantity: OUTPUT,
    })
}

fn curve(times: impl Iterator<Item = f64>, values: &[f64], factor: f64) -> Curve {
    times.zip(values.iter().map(|v| factor * v)).collect()
}

/// A signal sample by sample, as it is and as a map hands it on.
fn of_signal(
    map: &dyn SignalMap,
    signal: &[f64],
    factor: f64,
    quantity: (&'static str, &'static str),
) -> Signature {
    let time = times();
    let handed_on = map.apply(Sampled::from_start(signal, time[1] - time[0]));
    let without = curve(time.iter().copied(), signal, factor);
    let with = curve(time.iter().copied(), &handed_on, factor);
    Signature {
        over: Over::Time,
        range: None,
        change: relative(&without, &with, 1.0),
        without,
        with,
        samples: false,
        quantity,
    }
}

fn of_samples(
    effect: &dyn Effect,
    values: &[f64],
    map: &dyn SignalMap,
    displacement: &[f64],
) -> Signature {
    let fine = times();
    let time = || fine.iter().copied().step_by(COARSENING);
    let sampled: Vec<f64> = displacement.iter().copied().step_by(COARSENING).collect();
    let stored = effect
        .strike(values, &sampled, &mut draws())
        .unwrap_or_else(|| {
            let step = fine[COARSENING] - fine[0];
            map.apply(Sampled::from_start(&sampled, step))
        });
    let truth = curve(time(), &sampled, 1e3);
    let with = curve(time(), &stored, 1e3);
    Signature {
        over: Over::Time,
        range: None,
        change: relative(&truth, &with, 1.0),
        without: curve(fine.iter().copied(), displacement, 1e3),
        with,
        samples: true,
        quantity: OUTPUT,
    }
}

/// Numbers evenly drawn in 0 to 1, the same every time: x' = 16807 x mod (2³¹ − 1).
fn draws() -> impl FnMut() -> f64 {
    let mut state: u64 = 20_260_101;
    move || {
        state = state * 16_807 % 2_147_483_647;
        state as f64 / 2_147_483_647.0
    }
}
