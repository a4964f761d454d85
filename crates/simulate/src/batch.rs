//! Many simulations at once: those of one structure in the lanes of the vector registers.

use simgap_integrate::exact::Excitation;
use simgap_integrate::exact::lanes::{Batch, LANES, LaneObserver, LaneSet, LaneSnapshot, Pack};

use crate::outputs::{LaneBase, OutputPlan};
use crate::prepare::{Prepared, Workshop};
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
    let mut workshop = Workshop::default();
    let prepared: Vec<Result<Prepared, SimulateError>> = jobs
        .iter()
        .map(|job| workshop.prepare(job.simulator, job.run, job.initial))
        .collect();
    let mut raw: Vec<Option<Vec<Vec<f64>>>> = jobs.iter().map(|_| None).collect();
    for group in groups(jobs, &prepared) {
        if let [alone] = group[..] {
            if let Ok(ready) = &prepared[alone] {
                raw[alone] = Some(jobs[alone].simulator.predict_raw(jobs[alone].run, ready));
            }
            continue;
        }
        for (index, signals) in group.iter().zip(march(jobs, &prepared, &group)) {
            raw[*index] = Some(signals);
        }
    }
    let finish = |((job, prepared), raw): ((&Job<'_>, Result<Prepared, _>), Option<_>)| {
        prepared.map(|ready| {
            let keep = |map: &dyn simgap_effects::SignalMap| !(job.smooth && map.is_stepped());
            job.simulator
                .deliver(job.run, &ready, raw.unwrap_or_default(), keep)
        })
    };
    jobs.iter().zip(prepared).zip(raw).map(finish).collect()
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

/// Jobs that can share lanes, in their order; those that cannot be run are in no group.
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
    groups
}

/// Marches a group; signals before the maps of the outputs, job by job.
fn march(
    jobs: &[Job<'_>],
    prepared: &[Result<Prepared, SimulateError>],
    group: &[usize],
) -> Vec<Vec<Vec<f64>>> {
    let ready: Vec<&Prepared> = group
        .iter()
        .filter_map(|&i| prepared[i].as_ref().ok())
        .collect();
    let members: Vec<&Job<'_>> = group.iter().map(|&i| &jobs[i]).collect();
    let sets = members.iter().zip(&ready).map(|(job, r)| lane_set(job, r));
    let plans = &members[0].simulator.outputs;
    let mut recorder = Recorder {
        plans,
        accelerated: plans.iter().any(OutputPlan::needs_acceleration),
        members: group
            .chunks(LANES)
            .zip(ready.chunks(LANES))
            .map(|(group, ready)| Member::new(jobs, group, ready, plans.len()))
            .collect(),
        signals: members
            .iter()
            .map(|job| vec![vec![0.0; job.run.len]; plans.len()])
            .collect(),
    };
    if let Some(batch) = Batch::new(sets.collect()) {
        batch.march(&mut recorder);
    }
    recorder.finish()
}

/// Samples that are kept in lanes before they go to the signals.
const CHUNK: usize = 64;

/// Writes down the outputs of a group.
struct Recorder<'a> {
    plans: &'a [OutputPlan],
    accelerated: bool,
    members: Vec<Member<'a>>,
    signals: Vec<Vec<Vec<f64>>>,
}

/// Eight jobs of a group.
struct Member<'a> {
    /// Stiffness and damping of the members each output sees.
    coefficients: Vec<[Pack; 2]>,
    ready: [&'a Prepared; LANES],
    /// Values of the present chunk, output by output.
    buffer: Vec<[Pack; CHUNK]>,
    /// Samples seen.
    seen: usize,
}

impl<'a> Member<'a> {
    fn new(
        jobs: &[Job<'_>],
        group: &[usize],
        ready: &[&'a Prepared],
        outputs: usize,
    ) -> Member<'a> {
        let lane = |l: usize| l.min(group.len() - 1);
        let plan = |l: usize, k: usize| &jobs[group[lane(l)]].simulator.outputs[k];
        Member {
            coefficients: (0..outputs)
                .map(|k| {
                    [
                        Pack::of(|l| plan(l, k).stiffness),
                        Pack::of(|l| plan(l, k).damping),
                    ]
                })
                .collect(),
            ready: std::array::from_fn(|l| ready[lane(l)]),
            buffer: vec![[Pack::ZERO; CHUNK]; outputs],
            seen: 0,
        }
    }
}

impl LaneObserver for Recorder<'_> {
    fn needs_acceleration(&self) -> bool {
        self.accelerated
    }

    #[inline(always)]
    fn observe(&mut self, at: &LaneSnapshot<'_>) {
        let block = at.first_set / LANES;
        let member = &mut self.members[block];
        let slot = at.sample % CHUNK;
        for (k, plan) in self.plans.iter().enumerate() {
            let base = LaneBase {
                sample: at.sample,
                ready: &member.ready,
            };
            member.buffer[k][slot] = plan.read_lanes(at, &base, &member.coefficients[k]);
        }
        member.seen = at.sample + 1;
        if slot + 1 == CHUNK {
            self.flush(block);
        }
    }
}

impl Recorder<'_> {
    /// Moves the present chunk of eight jobs to their signals.
    fn flush(&mut self, block: usize) {
        let member = &self.members[block];
        let Some(last) = member.seen.checked_sub(1) else {
            return;
        };
        let first = last / CHUNK * CHUNK;
        let jobs = self.signals.iter_mut().skip(block * LANES).take(LANES);
        for (lane, signals) in jobs.enumerate() {
            for (signal, buffer) in signals.iter_mut().zip(&member.buffer) {
                // A job whose run is over keeps what it has.
                let end = signal.len().min(member.seen);
                let values = signal.get_mut(first..end).unwrap_or_default();
                for (value, pack) in values.iter_mut().zip(buffer) {
                    *value = pack.0[lane];
                }
            }
        }
    }

    fn finish(mut self) -> Vec<Vec<Vec<f64>>> {
        for block in 0..self.members.len() {
            if !self.members[block].seen.is_multiple_of(CHUNK) {
                self.flush(block);
            }
        }
        self.signals
    }
}
