//! Input noise integrated by a plant with a rigid-body mode.
//!
//! A slide without a spring integrates the noise of its drive: over a record the true model parts from the machine by many
//! times what the sensor adds, and a spring that does not exist or a mass that is wrong keeps it nearer. There the residuals
//! that effects are judged by are [whitened](simgap_estimate::Whitening): what counts is what every sample adds to those before
//! it. The filters come from what is known of the noise alone, that seen on the inputs, simulated, and that of the
//! sensors; not from the discrepancy, which holds the effect. Where a converter's steps are coarse, what it rounds away is no noise
//! that a filter could know.

use simgap_estimate::{EstimateError, Fit, FitOptions, Problem, Whitening};
use simgap_simulate::Run;

use super::input_noise::{draws, square_sum};
use super::sensor::noise_variance;

/// A channel wanders that the noise of the inputs moves by more than this multiple of what its sensor adds, rms, and by more
/// than this share of its motion.
const WANDERS: f64 = 2.0;
const MUCH: f64 = 0.01;
/// Samples that a filter looks back.
const ORDER: usize = 32;

/// Steps between samples that differ by less than this share are the same.
const SAME_STEP: f64 = 1e-6;
/// Samples of a run at the least, as a multiple of those that say nothing for want of others before them.
const LONG: usize = 32;

/// The filters of a problem in which some channel wanders, from what the noise of its inputs does and what the fit of the model
/// as given leaves of white noise; `None` where none does, where a channel is stored in coarse steps, and where runs of the
/// problem or those that it is to be judged by (`check`) are short or of several sample rates.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn whitening(
    problem: &Problem,
    check: &[Run],
    fit: &Fit,
    weights: &FitOptions,
) -> Result<Option<Whitening>, EstimateError> {
    let channels = 0..problem.model.outputs.len();
    let mut runs = problem.runs.iter().chain(check);
    let step_s = problem.runs.first().map_or(1.0, |run| run.time_step_s);
    let is_apart = |run: &Run| (run.time_step_s / step_s - 1.0).abs() > SAME_STEP;
    if runs.any(|run| run.len < LONG * ORDER || is_apart(run))
        || channels.clone().any(|c| problem.lattice_of(c).is_some())
    {
        return Ok(None);
    }
    let drawn = draws(problem, &[], weights, &[])?;
    let sensors = noise_variance(&fit.discrepancy, &vec![false; channels.len()]);
    let coloured: Vec<Vec<&[f64]>> = channels
        .map(|c| {
            let draws = drawn.iter().flat_map(|run| &run.left);
            draws.map(|draw| draw[c].as_slice()).collect()
        })
        .collect();
    let finite = coloured
        .iter()
        .flatten()
        .all(|signal| signal.iter().all(|r| r.is_finite()));
    let wanders = coloured.iter().zip(&sensors).zip(problem.motion_std());
    let mut wanders = wanders.map(|((signals, sensor), std)| {
        let count: usize = signals.iter().map(|signal| signal.len()).sum();
        let square: f64 = signals.iter().map(|signal| square_sum(signal)).sum();
        let rms = (square / count.max(1) as f64).sqrt();
        rms > WANDERS * sensor.sqrt() && rms > MUCH * std
    });
    let is_led_away = finite && wanders.any(|wanders| wanders);
    Ok(is_led_away.then(|| Whitening::of_noise(&coloured, &sensors, ORDER)))
}

#[cfg(test)]
mod tests {
    use simgap_estimate::fit_initial_states;
    use simgap_model::Model;

    use super::*;

    const SLIDE: &str = "schema = \"simgap-model/1\"\nname = \"slide\"\n\
        [[mass]]\nname = \"m\"\nvalue = 2.0\n\
        [[damper]]\nname = \"c\"\nbetween = [\"m\", \"ground\"]\ndamping = 1.0\n\
        [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"m\"\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"m\"\n";

    /// A run of a slide whose drive and sensor have noise.
    fn run(model: &Model, len: usize, time_step_s: f64) -> Run {
        let mut word = 3_u64;
        let mut noise = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let drive = |n: usize| (3.0 * n as f64 * time_step_s).sin();
        let mut run = Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s,
            len,
            first_index: 0,
            mended: simgap_simulate::Mended::default(),
            inputs: vec![(0..len).map(drive).collect()],
            measured: vec![None],
        };
        let problem = Problem::new(model, vec![]).unwrap();
        let simulator = problem.simulator(&[], 0).unwrap();
        let mut moved = simulator.predict(&run, &[0.0, 0.0]).unwrap().swap_remove(0);
        moved.iter_mut().for_each(|y| *y += 1e-4 * noise());
        run.measured = vec![Some(moved)];
        run.inputs[0].iter_mut().for_each(|u| *u += 0.1 * noise());
        run
    }

    fn is_filtered(run: impl Fn(&Model) -> Run, check: impl Fn(&Model) -> Run) -> bool {
        let model = Model::from_toml(SLIDE).unwrap();
        let problem = Problem::new(&model, vec![run(&model)]).unwrap();
        let weights = FitOptions::white(1);
        let fit = fit_initial_states(&problem, &[], &weights).unwrap();
        let found = whitening(&problem, &[check(&model)], &fit, &weights).unwrap();
        found.is_some_and(|filters| filters.order(0) == ORDER)
    }

    #[test]
    fn noise_of_a_drive_is_filtered_where_a_filter_can_know_it() {
        let long = |model: &Model| run(model, 4000, 0.01);
        assert!(is_filtered(long, long));
        assert!(!is_filtered(long, |model| run(model, 900, 0.01)));
        assert!(!is_filtered(long, |model| run(model, 4000, 0.02)));
        let coarse = |model: &Model| {
            let mut run = long(model);
            let values = run.measured[0].iter_mut().flatten();
            values.for_each(|y| *y = 0.01 * (*y / 0.01).round());
            run
        };
        assert!(!is_filtered(coarse, long));
        // Without noise on the drive nothing wanders.
        let clean = |model: &Model| {
            let mut run = long(model);
            run.inputs[0] = (0..4000).map(|n| (0.03 * f64::from(n)).sin()).collect();
            run
        };
        assert!(!is_filtered(clean, long));
    }
}
