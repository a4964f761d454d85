//! The same fault of every sensor is not one of the sensors.

use simgap_effects::{Action, Placed};
use simgap_estimate::{Interval, Problem};

use crate::difference::closes_more;
use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// Values within this share of each other are the same.
const ALIKE: f64 = 0.01;
/// What one effect may leave to take the place of the same effect of every sensor, as a multiple of the squared noise
/// or as a part of the gap beyond what the sensors leave: between the samples of an input nobody knows it, and what lies
/// before the plant is off by more.
const COMMON_LEAVES: f64 = 1.5;
const COMMON_MISSES: f64 = 0.03;

/// Whether a single effect takes the place of a set that names the same fault of every sensor.
pub(crate) fn is_common_cause(
    search: &Search<'_>,
    single: &Hypothesis,
    of_sensors: &Hypothesis,
) -> bool {
    let named = of_sensors.effects().iter();
    single.effects().len() == 1
        && on_every_channel(search.problem, named, &of_sensors.fit.intervals)
        && (search.leaves_less(single, COMMON_LEAVES)
            || !closes_more(search, of_sensors, single, COMMON_MISSES))
}

/// Whether the same effect of the measurement chain, with the same values, is named on every one of several
/// channels: its cause is common to them, and lies before the sensors. `intervals` are those of the values of each.
pub(crate) fn on_every_channel<'a>(
    problem: &Problem,
    named: impl Iterator<Item = &'a Placed>,
    intervals: &[Vec<Interval>],
) -> bool {
    let channels = problem.model.outputs.len();
    let named: Vec<(&Placed, &Vec<Interval>)> = named.zip(intervals).collect();
    let of_kind = |kind: &str| {
        let same = named
            .iter()
            .filter(|(placed, _)| placed.effect.kind() == kind);
        same.map(|(_, intervals)| *intervals).collect::<Vec<_>>()
    };
    let mut smooth = named
        .iter()
        .filter(|(placed, _)| matches!(placed.action(), Action::Output(_)));
    channels > 1
        && smooth.any(|(placed, _)| {
            let on = of_kind(placed.effect.kind());
            on.len() == channels && on.windows(2).all(|pair| agree(pair[0], pair[1]))
        })
}

/// Whether the values of two effects of a kind are the same, or may be.
fn agree(one: &[Interval], other: &[Interval]) -> bool {
    let mut both = one.iter().zip(other);
    both.all(|(a, b)| {
        let apart = (a.value - b.value).abs();
        apart <= ALIKE * a.value.abs() || a.ci95[0] <= b.ci95[1] && b.ci95[0] <= a.ci95[1]
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use simgap_effects::find;
    use simgap_model::{Location, Model};

    use super::*;

    const TWO_SENSORS: &str = r#"schema = "simgap-model/1"
name = "two sensors"
[[mass]]
name = "block"
value = 2.0
[[output]]
channel = "x"
kind = "displacement"
at = "block"
[[output]]
channel = "a"
kind = "acceleration"
at = "block"
"#;

    #[test]
    fn a_fault_is_common_where_every_sensor_has_it_with_the_same_values() {
        let model = Model::from_toml(TWO_SENSORS).unwrap();
        let problem = Problem::new(&model, vec![]).unwrap();
        let lag = |channel: &str, seconds: f64| {
            let at = Location::Channel(channel.into());
            let placed = Placed::new(find("sensor_lag").unwrap(), at, vec![seconds]);
            let ci95 = [0.995 * seconds, 1.005 * seconds];
            let interval = Interval {
                value: seconds,
                ci95,
            };
            (placed, vec![interval])
        };
        let is_common = |lags: &[(Placed, Vec<Interval>)]| {
            let (named, intervals): (Vec<_>, Vec<_>) = lags.iter().cloned().unzip();
            on_every_channel(&problem, named.iter(), &intervals)
        };
        assert!(is_common(&[lag("x", 0.0334), lag("a", 0.0335)]));
        assert!(!is_common(&[lag("x", 0.0334), lag("a", 0.0400)]), "two");
        assert!(!is_common(&[lag("x", 0.0334)]), "of one sensor");
    }
}
