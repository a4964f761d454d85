//! Records of machines that hold an effect, and a search without an end of its own.

use simgap_effects::Placed;
use simgap_estimate::{FitOptions, Problem, Start, fit};
use simgap_inference::{Budget, CandidateModel, ModelSpace, NoiseModel, Search};
use simgap_model::Model;
use simgap_simulate::{Mended, Run, Simulator};

/// What the one output of a model with an effect shows from rest under its one input, with a sequence of up to `noise` that no model of the
/// catalogue makes in the place of noise.
pub(crate) fn record(
    model: &Model,
    effect: Placed,
    time_step_s: f64,
    input: Vec<f64>,
    noise: f64,
) -> Run {
    let len = input.len();
    let mut run = Run {
        name: "run".into(),
        start_s: 0.0,
        time_step_s,
        len,
        first_index: 0,
        inputs: vec![input],
        measured: vec![None],
        mended: Mended::default(),
    };
    let simulator = Simulator::new(model, &[effect], 4).unwrap();
    let shown = simulator.predict(&run, &[0.0, 0.0]).unwrap();
    let sequence = (0..len as i64).map(|n| (n * n * 7919 % 1009) as f64 / 504.5 - 1.0);
    let seen = shown[0].iter().zip(sequence).map(|(a, e)| a + noise * e);
    run.measured = vec![Some(seen.collect())];
    run
}

pub(crate) fn without_end() -> Budget<'static> {
    Budget {
        progress: &|_| {},
        is_spent: &|| false,
    }
}

/// The sets that a search finds in a problem of one output, and in a part of it first where there is one; best first.
pub(crate) fn found(problem: &mut Problem, part: Option<&Problem>) -> Vec<CandidateModel> {
    let start = Start {
        effects: vec![],
        nominal: vec![],
        initial: problem.initial_guess(),
    };
    let baseline = fit(problem, &start, &FitOptions::white(1)).unwrap();
    let noise = NoiseModel::new(problem, &baseline, &baseline).unwrap();
    let space = ModelSpace::new(problem, &baseline, &[]).unwrap();
    space.put_priors(problem);
    let std = problem.output_std();
    let mut search = Search::new(problem, &noise, space, &std, without_end());
    search.find(&start, part).unwrap()
}
