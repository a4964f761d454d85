//! How large an effect must be to matter.

use simgap_effects::{Effect, SiteScale};
use simgap_model::{Location, Model, OutputKind};
use simgap_simulate::Simulator;

use crate::BlindError;
use crate::bench::Bench;
use crate::gap::{mean, std};
use crate::random::Random;

/// Typical sizes at a place while the nominal plant moves on a bench.
pub(crate) fn site_scale(
    model: &Model,
    bench: &Bench,
    at: &Location,
) -> Result<SiteScale, BlindError> {
    let simulator = Simulator::new(model, &[], 1)?;
    let run = bench.fine_run(model);
    let path = simulator.path(&run, &bench.state(&simulator), at)?;
    let outputs = bench.outputs(model, &[], 1, None)?;
    let names: Vec<&String> = match at {
        Location::Between(pair) => pair.iter().collect(),
        Location::Mass(mass) => vec![mass],
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => vec![],
    };
    let masses = || {
        let here = model.masses.iter();
        here.filter(|mass| names.contains(&&mass.name))
            .map(|mass| mass.value)
    };
    let largest = masses().fold(0.0, f64::max);
    let lightest = masses().min_by(f64::total_cmp).unwrap_or(1.0);
    let measured_force = model
        .outputs
        .iter()
        .zip(&outputs)
        .filter(|(output, _)| output.kind == OutputKind::Force)
        .map(|(_, signal)| std(signal))
        .fold(0.0, f64::max);
    let inertia = largest * std(&path.acceleration);
    let input = match at {
        Location::Input(name) => {
            let mut inputs = model.inputs.iter();
            inputs.position(|input| &input.channel == name)
        }
        _ => None,
    };
    let signal = match at {
        Location::Channel(name) => model.output_index(name).map_or(0.0, |i| std(&outputs[i])),
        Location::Input(_) => input.map_or(0.0, |i| std(&run.inputs[i])),
        Location::Between(_) | Location::Mass(_) | Location::Parameter(_) => 0.0,
    };
    let positive = |value: f64| if value > 0.0 { value } else { 1.0 };
    let channel = match at {
        Location::Channel(name) => model.output_index(name),
        _ => None,
    };
    let [stiffness, damping] = match at {
        Location::Between(pair) => model.stiffness_and_damping(pair),
        _ => [0.0; 2],
    };
    let force_n = positive(if inertia > 0.0 {
        inertia
    } else {
        measured_force
    });
    let [low, high] = range(&path.displacement);
    Ok(SiteScale {
        signal: positive(signal),
        time_step_s: bench.time_step_s,
        duration_s: bench.len as f64 * bench.time_step_s,
        displacement_range_m: [low, high],
        travel_m: high - low,
        signal_range: match (channel, input) {
            (Some(i), _) => range(&outputs[i]),
            (None, Some(i)) => range(&run.inputs[i]),
            (None, None) => [-1.0, 1.0],
        },
        signal_step: 0.1 * positive(signal),
        mass_kg: lightest,
        ..SiteScale::plain(
            positive(std(&path.displacement)),
            positive(std(&path.velocity)),
            force_n,
        )
        .with_members(stiffness, damping)
    })
}

fn range(values: &[f64]) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    values
        .iter()
        .fold(start, |[low, high], &v| [low.min(v), high.max(v)])
}

/// Parameter values of a random instance: one of the effect's usual ones with its proportions and
/// shape moved, so that no search begins at the truth.
pub(crate) fn instance(random: &mut Random, effect: &dyn Effect, scale: &SiteScale) -> Vec<f64> {
    let usual = effect.usual(scale);
    let Some(start) = random.pick(&usual).cloned() else {
        return vec![];
    };
    let flip = random.sign();
    let mut values: Vec<f64> = effect
        .parameters()
        .iter()
        .zip(start)
        .enumerate()
        .map(|(i, (parameter, value))| match parameter.neutral {
            _ if parameter.per_record => value,
            None if effect.is_chosen(i) => value,
            Some(neutral) if neutral.is_infinite() => value * random.uniform(0.8, 1.25),
            None => value * random.log_uniform(0.6, 1.6),
            Some(neutral) => {
                let sign = if parameter.lower < neutral { flip } else { 1.0 };
                neutral + sign * (value - neutral) * random.uniform(0.8, 1.25)
            }
        })
        .collect();
    if effect.kind() == "stribeck_friction" {
        // With equal levels it would be Coulomb's.
        values[1] = values[0] * random.uniform(1.4, 2.2);
    }
    within_bounds(effect, values)
}

/// The instance made larger or smaller, its shape kept.
pub(crate) fn scaled(effect: &dyn Effect, instance: &[f64], factor: f64) -> Vec<f64> {
    let values = effect
        .parameters()
        .iter()
        .zip(instance)
        .map(|(parameter, &value)| match parameter.neutral {
            None => value,
            _ if parameter.per_record => value,
            // A limit that vanishes at infinity comes closer as the effect grows.
            Some(neutral) if neutral.is_infinite() => value / factor,
            Some(neutral) => neutral + factor * (value - neutral),
        })
        .collect();
    within_bounds(effect, values)
}

fn within_bounds(effect: &dyn Effect, mut values: Vec<f64>) -> Vec<f64> {
    effect.make_physical(&mut values);
    values
}

/// Relative accuracy of the size: a case needs a gap of about the size drawn, no more.
const CLOSE: f64 = 0.1;

/// Finds the factor at which a gap reaches a target, by growing or shrinking from 1 until it is
/// crossed and then halving the logarithm. `None` when it is not reached, or jumps across.
pub(crate) fn factor_for(
    target: f64,
    mut gap: impl FnMut(f64) -> Result<f64, BlindError>,
) -> Result<Option<f64>, BlindError> {
    let beyond = |value: f64| value.is_nan() || value > target;
    let close = |value: f64| (value / target - 1.0).abs() < CLOSE;
    let first = gap(1.0)?;
    if close(first) {
        return Ok(Some(1.0));
    }
    let step = if beyond(first) { 0.2 } else { 5.0 };
    let (mut here, mut there) = (1.0, step);
    let mut crossed = false;
    for _ in 0..7 {
        let value = gap(there)?;
        if close(value) {
            return Ok(Some(there));
        }
        if beyond(value) != beyond(first) {
            crossed = true;
            break;
        }
        (here, there) = (there, there * step);
    }
    if !crossed {
        return Ok(None);
    }
    let (mut low, mut high) = (f64::min(here, there), f64::max(here, there));
    for _ in 0..12 {
        let middle = (low * high).sqrt();
        let value = gap(middle)?;
        if close(value) {
            return Ok(Some(middle));
        }
        if beyond(value) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(None)
}

/// Root mean square.
pub(crate) fn rms(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values.iter().map(|v| v * v).collect();
    mean(&squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_factor_for_a_monotone_gap() -> Result<(), BlindError> {
        for target in [1e-3, 0.4, 7.0] {
            let gap = |s: f64| 0.3 * s.powf(1.5);
            let factor = factor_for(target, |s| Ok(gap(s)))?.unwrap_or(f64::NAN);
            assert!((gap(factor) / target - 1.0).abs() < CLOSE, "{target}");
        }
        Ok(())
    }

    #[test]
    fn verify_unreachable_gap_is_none() -> Result<(), BlindError> {
        assert_eq!(factor_for(0.5, |_| Ok(0.1))?, None);
        let jumps = |s: f64| if s > 3.0 { 1.0 } else { 0.01 };
        assert_eq!(factor_for(0.5, |s| Ok(jumps(s)))?, None);
        Ok(())
    }

    #[test]
    fn prop_an_effect_scaled_to_nothing_is_neutral() {
        let scale = SiteScale {
            signal: 2.0,
            signal_step: 0.2,
            duration_s: 10.0,
            lines_hz: [3.0; simgap_effects::LINES],
            motion_hz: [2.0; simgap_effects::LINES],
            ..SiteScale::plain(1e-3, 0.1, 50.0)
        };
        for &effect in simgap_effects::catalogue() {
            for seed in 0..10 {
                let values = instance(&mut Random::new(seed), effect, &scale);
                assert_eq!(values.len(), effect.parameters().len());
                for (parameter, value) in
                    effect.parameters().iter().zip(scaled(effect, &values, 0.0))
                {
                    assert!((parameter.lower..=parameter.upper).contains(&value));
                    if let Some(neutral) = parameter.neutral.filter(|_| !parameter.per_record) {
                        assert_eq!(value, neutral, "{} {}", effect.kind(), parameter.name);
                    }
                }
            }
        }
    }
}
