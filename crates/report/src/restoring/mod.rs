//! The force that the model as given lacks at a place, from what it fails to predict.
//!
//! The difference e between the motion of the machine and that of the model follows the model's own
//! equation, driven by the force f that the model lacks across the place, b its two ends:
//!
//! ```text
//! M ë + C ė + K e = −b f                                            (1)
//! ḟ = white noise of intensity q                                    (2)
//! ```
//!
//! Each output sees e, and where it is an acceleration or the force of the place also f. A smoother
//! over (1) and (2) gives e and f together; q is the one under which the records are most likely,
//! the noise of the outputs is the noise floor. The motion across the place is that of the model
//! plus bᵀe.

mod smoother;

use faer::Mat;
use simgap_diagnose::{CheckSeries, Diagnosis, PlaceMotion};
use simgap_integrate::exact::matrix_exponential;
use simgap_model::{
    Form, Location, Model, Node, Output, StructuralMatrices, same_pair, state_matrix,
};

use simgap_signal::noise::noise_std_by_differences;

use smoother::System;

/// Samples used at the most.
const MOST_SAMPLES: usize = 8000;
/// Fewest samples that give a picture.
const FEWEST_SAMPLES: usize = 100;
/// More masses are left out: the work grows with their third power.
const MOST_MASSES: usize = 6;
/// Intensities tried: powers of ten of the first guess.
const POWERS: std::ops::RangeInclusive<i32> = -3..=7;
/// Samples over which the first guess lets the force build up.
const BUILD_UP: usize = 1000;
/// Part left out at both ends, where the smoother leans on its start.
const ENDS: f64 = 0.02;
/// Steps of the time base may differ by this part.
const EVEN: f64 = 1e-3;
/// Order of the differences that see jumps from sample to sample and little of the motion.
const JUMPS: usize = 6;
/// Least noise of an output, relative to its discrepancy.
const LEAST_NOISE: f64 = 1e-3;

/// The missing force along the motion across a place, SI units.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MissingForce {
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    /// As a member between the two nodes would carry it: positive when it pulls back a positive
    /// displacement or velocity.
    pub(crate) force: Vec<f64>,
}

/// The missing force; `None` where it cannot be told: an arm under gravity, a place or a state that
/// the outputs do not see, an uneven time base, a short record.
pub(crate) fn missing_force(
    model: &Model,
    diagnosis: &Diagnosis,
    series: &CheckSeries,
    motion: &PlaceMotion,
) -> Option<MissingForce> {
    if model.dof_count() > MOST_MASSES || !model.pendulums.is_empty() {
        return None;
    }
    let off: Vec<Vec<f64>> = series
        .channels
        .iter()
        .map(|c| {
            c.measured
                .iter()
                .zip(&c.nominal)
                .map(|(m, p)| m - p)
                .collect()
        })
        .collect();
    let range = stretch(series, &off)?;
    let off: Vec<&[f64]> = off.iter().map(|d| &d[range.clone()]).collect();
    let step_s = even_step(&series.time_s[range.clone()])?;
    let mut system = system(model, &motion.at, step_s)?;
    system.noise = noise(diagnosis, series, &off)?;
    choose_drive(&mut system, &off)?;
    let smoothed = system.smooth(&off);

    let ends = ends(model, &motion.at)?;
    let n = model.dof_count();
    let across = |state: &[f64], first: usize| -> f64 {
        let value = |node: Node| -> f64 { node.terms().map(|(i, w)| w * state[first + i]).sum() };
        value(ends[0]) - value(ends[1])
    };
    let skip = (ENDS * smoothed.len() as f64) as usize;
    let kept = skip..smoothed.len() - skip;
    let at = |k: usize| range.start + k;
    Some(MissingForce {
        displacement: kept
            .clone()
            .map(|k| motion.displacement[at(k)] + across(&smoothed[k], 0))
            .collect(),
        velocity: kept
            .clone()
            .map(|k| motion.velocity[at(k)] + across(&smoothed[k], n))
            .collect(),
        force: kept.map(|k| smoothed[k][2 * n]).collect(),
    })
    .filter(|found| {
        let all = [&found.displacement, &found.velocity, &found.force];
        all.iter().all(|list| list.iter().all(|v| v.is_finite()))
    })
}

/// The samples used: all, or the stretch of a long record with the largest discrepancy.
fn stretch(series: &CheckSeries, off: &[Vec<f64>]) -> Option<std::ops::Range<usize>> {
    let n = off.iter().map(Vec::len).min()?.min(series.time_s.len());
    if n < FEWEST_SAMPLES {
        return None;
    }
    let len = n.min(MOST_SAMPLES);
    let mut sum = vec![0.0; n + 1];
    for i in 0..n {
        let here = off.iter().map(|d| d[i]).filter(|d| d.is_finite());
        sum[i + 1] = sum[i] + here.map(|d| d * d).sum::<f64>();
    }
    let start = (0..=n - len).fold(0, |best, i| {
        if sum[i + len] - sum[i] > sum[best + len] - sum[best] {
            i
        } else {
            best
        }
    });
    Some(start..start + len)
}

fn even_step(time_s: &[f64]) -> Option<f64> {
    let step = (time_s.last()? - time_s.first()?) / (time_s.len() - 1) as f64;
    let even = time_s
        .iter()
        .enumerate()
        .all(|(i, t)| (t - time_s[0] - i as f64 * step).abs() < EVEN * step * (1 + i) as f64);
    (step > 0.0 && step.is_finite() && even).then_some(step)
}

/// Variance of the noise of each channel.
fn noise(diagnosis: &Diagnosis, series: &CheckSeries, off: &[&[f64]]) -> Option<Vec<f64>> {
    let variance = |values: &[f64], about: f64| {
        let finite = || values.iter().filter(|v| v.is_finite());
        finite().map(|v| (v - about).powi(2)).sum::<f64>() / finite().count().max(1) as f64
    };
    let each = series.channels.iter().zip(off).map(|(c, off)| {
        let finite = || c.measured.iter().filter(|v| v.is_finite());
        let mean = finite().sum::<f64>() / finite().count().max(1) as f64;
        let gap = diagnosis.gap.channels.iter();
        let floor = gap
            .filter(|g| g.channel == c.channel)
            .map(|g| g.noise_floor);
        let floor = floor.fold(0.0, f64::max);
        let least = LEAST_NOISE.powi(2) * variance(off, 0.0);
        let distorted = Location::Channel(c.channel.clone());
        let named = diagnosis.verdict.effects.iter().any(|e| e.at == distorted);
        // What a faulty measurement does from sample to sample is no force.
        let jumps = match noise_std_by_differences(off, JUMPS) {
            Ok(std) if named => std * std,
            _ => 0.0,
        };
        (floor * floor * variance(&c.measured, mean))
            .max(least)
            .max(jumps)
    });
    let all: Vec<f64> = each.collect();
    all.iter().all(|v| v.is_finite() && *v > 0.0).then_some(all)
}

/// Sets the intensity of (2) and the variance at the start to what makes the records most likely.
fn choose_drive(system: &mut System, off: &[&[f64]]) -> Option<()> {
    let built = system.driven(BUILD_UP);
    let n = system.states;
    let mut guess = 0.0;
    for (row, off) in system.rows.iter().zip(off) {
        let seen: f64 = (0..n * n).map(|k| row[k / n] * built[k] * row[k % n]).sum();
        let finite = || off.iter().filter(|v| v.is_finite());
        let size = finite().map(|v| v * v).sum::<f64>() / finite().count().max(1) as f64;
        if seen > 0.0 {
            guess = f64::max(guess, size / seen);
        }
    }
    if !(guess > 0.0 && guess.is_finite()) {
        return None;
    }
    let mut best = (f64::INFINITY, 0.0);
    for power in POWERS {
        let drive = guess * 10f64.powi(power);
        set_drive(system, &built, drive);
        let misfit = system.misfit(off);
        if misfit < best.0 {
            best = (misfit, drive);
        }
    }
    set_drive(system, &built, best.1);
    best.0.is_finite().then_some(())
}

fn set_drive(system: &mut System, built: &[f64], drive: f64) {
    system.drive = drive;
    // The machine starts anywhere that such a force could have taken it.
    system.start = built.iter().map(|v| 10.0 * drive * v).collect();
}

fn ends(model: &Model, at: &Location) -> Option<[Node; 2]> {
    match at {
        Location::Between([a, b]) => Some([model.node(a)?, model.node(b)?]),
        Location::Mass(a) => Some([model.node(a)?, Node::Ground]),
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => None,
    }
}

/// (1) and (2) over one step of the record, and what the outputs see of it.
fn system(model: &Model, at: &Location, step_s: f64) -> Option<System> {
    let n = model.dof_count();
    if model.is_external() {
        return None;
    }
    let states = 2 * n + 1;
    let mut rate = Mat::<f64>::zeros(states, states);
    let structure = model.matrices().ok()?;
    if n > 0 {
        let own = state_matrix(&structure).ok()?;
        for i in 0..2 * n {
            for j in 0..2 * n {
                rate[(i, j)] = own[(i, j)];
            }
        }
        let pull = accelerations(&structure, &ends(model, at)?)?;
        for (i, value) in pull.iter().enumerate() {
            rate[(n + i, 2 * n)] = -value;
        }
    }
    let transition =
        matrix_exponential(&Mat::from_fn(states, states, |i, j| rate[(i, j)] * step_s));
    let rows: Option<Vec<Vec<f64>>> = model
        .outputs
        .iter()
        .map(|output| row(model, output, at, &rate))
        .collect();
    Some(System {
        states,
        transition: (0..states * states)
            .map(|k| transition[(k / states, k % states)])
            .collect(),
        rows: rows?,
        noise: vec![],
        drive: 0.0,
        start: vec![],
    })
}

/// M⁻¹ b.
fn accelerations(structure: &StructuralMatrices, ends: &[Node; 2]) -> Option<Vec<f64>> {
    let n = structure.dof_count();
    // With C set to 1 at one column, the state matrix holds −M⁻¹ of it.
    let mut unit = structure.clone();
    unit.damping_matrix = Mat::from_fn(n, n, |i, j| {
        let weight = |node: Node| -> f64 {
            let here = node.terms().filter(|(dof, _)| *dof == i);
            here.map(|(_, weight)| weight).sum()
        };
        if j == 0 {
            weight(ends[0]) - weight(ends[1])
        } else {
            0.0
        }
    });
    let state = state_matrix(&unit).ok()?;
    Some((0..n).map(|i| -state[(n + i, n)]).collect())
}

/// What an output sees of e, ė and f.
fn row(model: &Model, output: &Output, at: &Location, rate: &Mat<f64>) -> Option<Vec<f64>> {
    let n = model.dof_count();
    let mut row = vec![0.0; 2 * n + 1];
    let reading = model.reading(output).ok()?;
    let mut add = |offset: usize, value: f64| {
        for (node, sign) in reading.nodes.iter().zip([1.0, -1.0]) {
            for (i, weight) in node.terms() {
                row[offset + i] += sign * weight * value;
            }
        }
    };
    if let Form::Members { stiffness, damping } = reading.form {
        let pair = output.between.as_ref()?;
        add(0, stiffness);
        add(n, damping);
        if let Location::Between(place) = at
            && same_pair(place, pair)
        {
            row[2 * n] = if place == pair { 1.0 } else { -1.0 };
        }
        return Some(row);
    }
    let [node, _] = reading.nodes;
    if matches!(node, Node::Ground | Node::Base(_) | Node::Port(_)) {
        return None;
    }
    match reading.form {
        Form::Displacement => add(0, 1.0),
        Form::Velocity => add(n, 1.0),
        Form::Rate { scale, .. } => add(n, scale),
        Form::Acceleration => {
            for (i, weight) in node.terms() {
                for (j, value) in row.iter_mut().enumerate() {
                    *value += weight * rate[(n + i, j)];
                }
            }
        }
        Form::Members { .. } | Form::Orifice { .. } | Form::Signal => return None,
    }
    Some(row)
}

#[cfg(test)]
mod tests;
