//! Many simulations at once: those of one structure in the lanes of the vector registers.

use std::collections::HashMap;
use std::sync::Arc;

use rayon::prelude::*;
use simgap_integrate::exact::Excitation;
use simgap_integrate::exact::lanes::{Batch, LANES, LaneObserver, LaneSamples, LaneSet, Pack};

use crate::outputs::OutputPlan;
use crate::prepare::Workshop;
use crate::prepared::Prepared;
use crate::{Run, SimulateError, Simulator};

/// One simulation of many.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// The model with its effects.
    pub simulator: &'a Simulator,
    /// The run it is driven by.
    pub run: &'a Run,
    /// Displacements, then velocities at the first sample.
    pub initial: &'a [f64],
    /// Whether maps that move in steps are left out, as in [`Simulator::predict_smooth`].
    pub smooth: bool,
}

/// Predicted outputs, one signal each, or why there are none.
pub type Prediction = Result<Vec<Vec<f64>>, SimulateError>;

/// Predicts the outputs of every job as [`Simulator::predict`] does, to the last bit, several times
/// faster where jobs differ in values, states and runs only.
#[must_use]
pub fn predict_all(jobs: &[Job<'_>]) -> Vec<Prediction> {
    // A simulator of the user's has no lanes.
    if jobs.iter().any(|job| job.simulator.outside.is_some()) {
        let each = jobs.par_iter().map(|job| match job.smooth {
            true => job.simulator.predict_smooth(job.run, job.initial),
            false => job.simulator.predict(job.run, job.initial),
        });
        return each.collect();
    }
    let mut workshop = Workshop::default();
    let prepared: Vec<Result<Prepared, SimulateError>> = jobs
        .iter()
        .map(|job| workshop.prepare(job.simulator, job.run, job.initial))
        .collect();
    let groups = groups(jobs, &prepared);
    let packs: Vec<&[usize]> = groups
        .iter()
        .flat_map(|group| group.chunks(LANES))
        .collect();
    let marched = packs
        .par_iter()
        .map(|pack| match (pack, &prepared[pack[0]]) {
            ([alone], Ok(ready)) => {
                vec![jobs[*alone].simulator.predict_raw(jobs[*alone].run, ready)]
            }
            _ => march(jobs, &prepared, pack),
        });
    let mut raw: Vec<Vec<Vec<f64>>> = vec![vec![]; jobs.len()];
    for (pack, signals) in packs.iter().zip(marched.collect::<Vec<_>>()) {
        for (index, signals) in pack.iter().zip(signals) {
            raw[*index] = signals;
        }
    }
    let finish = |((job, prepared), raw): ((&Job<'_>, Result<Prepared, _>), _)| {
        prepared.map(|ready| {
            let keep = |map: &dyn simgap_effects::SignalMap| !(job.smooth && map.is_stepped());
            job.simulator.deliver(job.run, &ready, raw, keep)
        })
    };
    let all = jobs.par_iter().zip(prepared).zip(raw);
    all.map(finish).collect()
}

fn lane_set<'a>(job: &Job<'a>, ready: &'a Prepared) -> LaneSet<'a> {
    LaneSet {
        propagator: &ready.propagator,
        elements: &job.simulator.elements,
        excitation: excitation(job.simulator, job.run, ready),
        displacement: &ready.displacement,
        velocity: &ready.velocity,
    }
}

/// What drives a prepared simulation.
pub(crate) fn excitation<'a>(
    simulator: &Simulator,
    run: &Run,
    ready: &'a Prepared,
) -> Excitation<'a> {
    Excitation {
        dof_force: &ready.drive.dof_force,
        base_displacement: &ready.drive.base_displacement,
        base_velocity: &ready.drive.base_velocity,
        base_count: ready.drive.base_count,
        sample_count: run.len,
        start_s: run.start_s,
        substeps: simulator.substeps,
    }
}

/// Jobs that can share lanes, those with one drive beside each other; those that cannot be run are
/// in no group.
fn groups(jobs: &[Job<'_>], prepared: &[Result<Prepared, SimulateError>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, ready) in prepared.iter().enumerate() {
        let Ok(ready) = ready else {
            continue;
        };
        let set = lane_set(&jobs[i], ready);
        let fits = |group: &&mut Vec<usize>| match prepared[group[0]].as_ref() {
            Ok(first) => {
                let (one, other) = (jobs[group[0]].simulator, jobs[i].simulator);
                lane_set(&jobs[group[0]], first).is_alike(&set)
                    && one.outputs.len() == other.outputs.len()
                    && one
                        .outputs
                        .iter()
                        .zip(&other.outputs)
                        .all(|(a, b)| a.is_alike(b))
            }
            Err(_) => false,
        };
        match groups.iter_mut().find(fits) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    for group in &mut groups {
        by_drive(group, prepared);
    }
    groups
}

/// Puts jobs with one drive beside each other, the drives in the order of their first jobs: lanes
/// that are driven alike are filled at once.
fn by_drive(group: &mut [usize], prepared: &[Result<Prepared, SimulateError>]) {
    let drive = |i: usize| {
        let ready = prepared[i].as_ref().ok();
        ready.map(|ready| Arc::as_ptr(&ready.drive))
    };
    let mut first = HashMap::new();
    for (place, &i) in group.iter().enumerate() {
        first.entry(drive(i)).or_insert(place);
    }
    group.sort_by_key(|&i| first.get(&drive(i)));
}

/// Marches the jobs of a pack; signals before the maps of the outputs, job by job.
fn march(
    jobs: &[Job<'_>],
    prepared: &[Result<Prepared, SimulateError>],
    pack: &[usize],
) -> Vec<Vec<Vec<f64>>> {
    let ready: Vec<&Prepared> = pack
        .iter()
        .filter_map(|&i| prepared[i].as_ref().ok())
        .collect();
    let jobs: Vec<&Job<'_>> = pack.iter().map(|&i| &jobs[i]).collect();
    let sets = jobs.iter().zip(&ready).map(|(job, r)| lane_set(job, r));
    let plans = &jobs[0].simulator.outputs;
    let lane = |l: usize| l.min(jobs.len() - 1);
    let plan = |l: usize, k: usize| &jobs[lane(l)].simulator.outputs[k];
    let mut recorder = Recorder {
        plans,
        coefficients: (0..plans.len())
            .map(|k| {
                [
                    Pack::of(|l| plan(l, k).stiffness),
                    Pack::of(|l| plan(l, k).damping),
                ]
            })
            .collect(),
        ready: std::array::from_fn(|l| ready[lane(l)]),
        values: vec![],
        signals: jobs
            .iter()
            .map(|job| vec![vec![0.0; job.run.len]; plans.len()])
            .collect(),
    };
    if let Some(batch) = Batch::new(sets.collect()) {
        batch.march(&mut recorder);
    }
    recorder.signals
}

/// Writes down the outputs of up to eight jobs.
struct Recorder<'a> {
    plans: &'a [OutputPlan],
    /// Stiffness and damping of the members each output sees.
    coefficients: Vec<[Pack; 2]>,
    ready: [&'a Prepared; LANES],
    /// Room for the values of an output at the samples that are shown.
    values: Vec<Pack>,
    signals: Vec<Vec<Vec<f64>>>,
}

impl LaneObserver for Recorder<'_> {
    fn reads_acceleration(&self, coordinate: usize) -> bool {
        let mut plans = self.plans.iter();
        plans.any(|plan| plan.reads_acceleration(coordinate))
    }

    fn reads_displacement(&self, coordinate: usize) -> bool {
        let mut each = self.plans.iter().zip(&self.coefficients);
        each.any(|(plan, [stiffness, _])| {
            let is_member = stiffness.0.iter().any(|value| *value != 0.0);
            plan.reads_displacement(coordinate, is_member)
        })
    }

    fn reads_forces(&self) -> bool {
        self.plans.iter().any(OutputPlan::reads_forces)
    }

    #[inline(always)]
    fn observe(&mut self, samples: &LaneSamples<'_>) {
        for (k, plan) in self.plans.iter().enumerate() {
            self.values.resize(samples.count, Pack::ZERO);
            for (i, value) in self.values.iter_mut().enumerate() {
                *value = plan.read_lanes((samples, i), &self.ready, &self.coefficients[k]);
            }
            for (lane, signals) in self.signals.iter_mut().enumerate() {
                // A job whose run is over keeps what it has.
                let end = signals[k].len().min(samples.first + samples.count);
                let signal = signals[k].get_mut(samples.first..end).unwrap_or_default();
                for (value, pack) in signal.iter_mut().zip(&self.values) {
                    *value = pack.0[lane];
                }
            }
        }
    }
}
