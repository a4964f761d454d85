//! Records as files.

use crate::bench::{Bench, deviation};
use crate::chain::Noise;
use crate::draft::Draft;
use crate::effect::{Effect, FLIPPED};
use crate::march::KEPT;
use crate::rng::Rng;

/// Noise of every channel, SI: a share of the deviation of its reading in the first record.
pub(crate) fn noise_levels(bench: &Bench, effects: &[Effect], share: f64) -> Option<Vec<f64>> {
    let (_, run) = bench.run(&bench.plant, effects, 0, 8)?;
    let before = bench.setups[0].before * KEPT;
    Some(
        run.outputs
            .iter()
            .map(|y| share * deviation(&y[before..]))
            .collect(),
    )
}

/// Factor on the recorded values of an input by a slip: what is written is not what acted.
fn misrecorded(draft: &Draft, input: usize) -> f64 {
    let slips = draft.effects.iter().filter(|e| match e.at {
        crate::plant::Place::Input(i) => i == input,
        _ => false,
    });
    let factor = |e: &Effect| match e.kind {
        FLIPPED => -1.0,
        _ => 1.0,
    };
    slips.map(factor).product()
}

/// One record with its noise, as text.
pub(crate) fn csv(
    draft: &Draft,
    record: usize,
    substeps: usize,
    noise: &[Noise],
    input_noise: f64,
    rng: &mut Rng,
) -> Option<String> {
    let bench = &draft.bench;
    let setup = &bench.setups[record];
    let all: Vec<Effect> = draft.effects.iter().chain(&draft.wrong).cloned().collect();
    let (assembly, run) = bench.run(&bench.plant, &all, record, substeps)?;
    let hiss: Vec<Vec<f64>> = noise
        .iter()
        .zip(&bench.plant.outputs)
        .map(|(n, _)| n.draw(rng, setup.samples))
        .collect();
    let outputs = bench.noisy(&assembly, &run, record, &hiss);
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    for (i, input) in bench.plant.inputs.iter().enumerate() {
        let from = setup.before * KEPT;
        let clean: Vec<f64> = run.inputs[i][from..]
            .iter()
            .step_by(KEPT)
            .copied()
            .collect();
        let rms = (clean.iter().map(|v| v * v).sum::<f64>() / clean.len() as f64).sqrt();
        let factor = misrecorded(draft, i) / input.unit.1;
        let values = clean
            .iter()
            .map(|v| factor * (v + input_noise * rms * rng.normal()));
        columns.push((
            format!("{} [{}]", input.channel, input.unit.0),
            values.collect(),
        ));
    }
    for (output, values) in bench.plant.outputs.iter().zip(outputs) {
        let values = values.iter().map(|v| v / output.unit.1).collect();
        columns.push((format!("{} [{}]", output.channel, output.unit.0), values));
    }
    let mut text = String::from("t [s]");
    columns.iter().for_each(|(head, _)| {
        text.push(',');
        text.push_str(head);
    });
    text.push('\n');
    for k in 0..setup.samples {
        text += &format!("{:.6}", k as f64 * setup.step_s);
        for (_, values) in &columns {
            text += &format!(",{:.9e}", values[k]);
        }
        text.push('\n');
    }
    Some(text)
}
