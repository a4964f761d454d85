//! Signs that a named effect only stands in for a law that the catalogue does not have.

use simgap_effects::{Action, Family, Parameter, Placed, Sampled, is_unseen};

use crate::Gap;
use crate::evidence::is_nominal;
use crate::pipeline::Answer;
use crate::unexplained::smooth_set_leaves;

/// A value this near to the end of its range, relative to it, is at the end.
const AT_THE_END: f64 = 1e-3;
/// Factors are the same when their logarithms differ by less than this share: nominal parameters are off by
/// some percent besides.
const SAME_FACTOR: f64 = 0.25;
/// Share of what is left that a law of any shape at the place of the effect may explain.
const MISFITS: f64 = 0.3;

/// Why the i-th named effect may be a stand-in; empty for one that shows no sign of it.
pub(crate) fn doubts(answer: &Answer, gap: &Gap, i: usize) -> Vec<String> {
    let judged = &answer.judged[i];
    let placed = &judged.placed;
    if is_nominal(placed) {
        let all = same_factor(answer, i);
        return all.into_iter().map(str::to_owned).collect();
    }
    let mut doubts = Vec::new();
    if let Some(other) = company(answer, i) {
        doubts.push(format!(
            "{} is named at the same place, and two effects together can imitate a third",
            other.effect.kind()
        ));
    }
    if matches!(placed.action(), Action::Sampling(_)) {
        // A converter, a lost sample: values at the end of a range are what they look like.
        return doubts;
    }
    if smooth_set_leaves(answer, gap) {
        doubts.push(
            "what is named leaves more than noise, and without a force the true effects would not"
                .into(),
        );
    }
    let fitted = answer.estimate.estimate.effects.get(i);
    let values = fitted.map_or(&placed.values, |fitted| &fitted.values);
    // A law may do without what earlier ones of its name did not have.
    let is_optional = |parameter: &Parameter| placed.effect.left_out(parameter.name).is_some();
    let parameters = placed.effect.parameters().iter().zip(values);
    let shapes = parameters.filter(|(parameter, _)| !parameter.per_record);
    for (parameter, &value) in shapes {
        if !is_optional(parameter)
            && ends(parameter).any(|end| (value - end).abs() <= AT_THE_END * end.abs())
        {
            doubts.push(format!(
                "{} is at the end of its range, {value}",
                parameter.name
            ));
        }
    }
    let parameters = placed.effect.parameters().iter();
    for (parameter, interval) in parameters.zip(answer.intervals(i)) {
        let shapes = parameter.neutral.is_none() && !parameter.per_record;
        if shapes && !is_optional(parameter) && is_unseen(interval.ci95) {
            doubts.push(format!("these records hardly show its {}", parameter.name));
        }
    }
    if let Some(scale) = &judged.scale {
        let own = placed.effect.doubt(&ci95(answer, i), scale);
        doubts.extend(own.map(str::to_owned));
        if !placed.effect.keeps_its_meaning(values, scale) {
            doubts.push("its values have left what its name means".into());
        }
    }
    if let Some(law) = &answer.remainder.law
        && law.at == placed.at
        && law.share > MISFITS
    {
        doubts.push(format!(
            "a law of another shape at its place explains {:.0} % of what it leaves above the noise",
            100.0 * law.share
        ));
    }
    doubts
}

/// Why the values of the i-th named effect belie its name.
pub(crate) fn misnomer(answer: &Answer, i: usize) -> Option<&'static str> {
    let judged = &answer.judged[i];
    let scale = judged.scale.as_ref()?;
    judged.placed.effect.misnomer(&ci95(answer, i), scale)
}

fn ci95(answer: &Answer, i: usize) -> Vec<[f64; 2]> {
    let intervals = answer.intervals(i).iter();
    intervals.map(|interval| interval.ci95).collect()
}

/// Another effect at the place of the i-th that together with it may imitate a third: of the machine, or a
/// parameter of it, where one of the two is a law; or two filters of one channel.
pub(crate) fn company(answer: &Answer, i: usize) -> Option<&Placed> {
    let own = &answer.judged[i].placed;
    let mut others = answer.named().enumerate().filter(|(j, _)| *j != i);
    let other = others.find(|(_, other)| other.at == own.at && may_imitate(own, other));
    other.map(|(_, other)| other)
}

fn may_imitate(one: &Placed, other: &Placed) -> bool {
    let both = |is: fn(&Placed) -> bool| is(one) && is(other);
    let is_law = |placed: &Placed| placed.effect.family().is_law();
    both(|placed| placed.effect.family() != Family::Measurement) && (is_law(one) || is_law(other))
        || both(is_filter)
}

/// Whether an effect passes a channel on in proportion: a gain, a delay, a lag; what it adds would be seen on its
/// own.
fn is_filter(placed: &Placed) -> bool {
    const SILENCE: [f64; 16] = [0.0; 16];
    match placed.action() {
        Action::Output(map) => {
            let passed = map.apply(Sampled::from_start(&SILENCE, 1e-3));
            passed.iter().all(|value| *value == 0.0)
        }
        _ => false,
    }
}

/// Said of a nominal parameter that is off by the same factor as two others at least, or by its inverse: the
/// equations of motion may be multiplied by any number.
fn same_factor(answer: &Answer, i: usize) -> Option<&'static str> {
    let factor = |placed: &Placed| {
        let value = *placed.values.first()?;
        (is_nominal(placed) && value > 0.0).then(|| value.ln().abs())
    };
    let own = factor(&answer.judged[i].placed)?;
    let all = answer.named().filter_map(factor);
    let alike = all.filter(|other| (other - own).abs() < SAME_FACTOR * own.max(*other));
    (alike.count() >= 3).then_some(
        "three parameters are off by the same factor: one that is not among them would do the same",
    )
}

/// The ends of the range of a parameter that are neither zero nor infinite.
fn ends(parameter: &Parameter) -> impl Iterator<Item = f64> + use<> {
    let ends = [parameter.lower, parameter.upper].into_iter();
    ends.filter(|end| end.is_finite() && *end != 0.0)
}

#[cfg(test)]
mod tests {
    use simgap_effects::{SiteScale, find};
    use simgap_model::Location;

    use super::*;

    #[test]
    fn filters_pass_a_channel_on_in_proportion() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        let filters = |kind: &str| {
            let values = find(kind).map(|effect| (effect, effect.starts(&scale)));
            let mut placed = values.into_iter().flat_map(|(effect, starts)| {
                let at = Location::Channel("y".into());
                let placed = move |values| Placed::new(effect, at.clone(), values);
                starts.into_iter().map(placed)
            });
            placed.all(|placed| is_filter(&placed))
        };
        for kind in ["sensor_gain", "sensor_delay", "sensor_lag"] {
            assert!(filters(kind), "{kind}");
        }
        for kind in ["sensor_bias", "sensor_drift", "tone_pickup", "clipping"] {
            assert!(!filters(kind), "{kind}");
        }
    }
}
