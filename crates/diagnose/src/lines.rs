//! Biases and tones of several sensors that one force would explain, and forces that are a fault of one sensor.
//!
//! What a sensor adds and what a force pushes with, whatever moves, are lines of a frequency, at 0 Hz constants. With the
//! response H of the outputs to forces on the masses, lines a of sensors and A of forces at one frequency have one cause where
//!
//! ```text
//! |H_cj A − a_c| ≤ ε |a_c|  on every channel c with a line,  |H_cj A| ≤ σ_c  on all others      (1)
//! |Σ_j H_cj A_j| ≤ min(ε Σ_j |H_cj A_j|, σ_c)                on every channel but one           (2)
//! ```
//!
//! for a mass j and some A, ε a twentieth (a fifth where f > 0), since H is that of a model, and σ_c what is left of channel c. Of (1) that is a force
//! on the mass, of (2) a fault of the sensor. Where the catalogue holds this cause it has been tried alone, and is not better:
//! then something like it is at work.

use std::f64::consts::TAU;

use faer::{Mat, c64};
use simgap_effects::{Line, Placed};
use simgap_estimate::Problem;
use simgap_model::{Location, Model, Node};
use simgap_simulate::Run;

use crate::outcome::corrected_model;
use crate::pipeline::Answer;

/// ε of constants, which agree in one number, and of tones, which agree in two: the response of a model is off by some
/// percent, by more between resonances.
const ALIKE: [f64; 2] = [0.05, 0.2];
/// Frequencies are the same where the lines part by less than this of a turn over a record.
const SAME_TURNS: f64 = 0.25;

/// Where a line is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Index of the channel.
    Sensor(usize),
    /// Index of the mass.
    Mass(usize),
}

type Lines = Vec<(Place, Line)>;
/// A line as A e^(iφ), and where it is added.
type Phasor = (Place, c64);

/// Why the lines that an answer names have another cause; `None` where they have none in common.
pub(crate) fn one_cause(problem: &Problem, answer: &Answer) -> Option<String> {
    if problem.is_whitened() {
        // What is left is filtered, and lines are not.
        return None;
    }
    let estimate = &answer.estimate.estimate;
    let of_run = |record: usize| -> Lines {
        let placed = estimate.effects.iter().map(|e| e.in_record(record));
        let middle_s = problem.runs[record].middle_s();
        placed
            .filter_map(|placed| line(&problem.model, &placed, middle_s))
            .collect()
    };
    let runs: Vec<Lines> = (0..problem.runs.len()).map(of_run).collect();
    let noise: Vec<f64> = answer.estimate.variance.iter().map(|v| v.sqrt()).collect();
    let durations = problem.runs.iter().map(Run::duration_s);
    let longest = durations.fold(0.0, f64::max);
    let model = corrected_model(&problem.model, &answer.placed());
    common(&model, &runs, &noise, SAME_TURNS / longest)
}

/// A line with its phase at a time: far from there frequencies that are a little off turn it.
fn line(model: &Model, placed: &Placed, time_s: f64) -> Option<(Place, Line)> {
    let line = placed.effect.line(&placed.values)?;
    let line = Line {
        phase_rad: line.phase_rad + TAU * line.frequency_hz * time_s,
        ..line
    };
    let place = match &placed.at {
        Location::Channel(name) => Place::Sensor(model.output_index(name)?),
        Location::Mass(name) => match model.node(name)? {
            Node::Dof(mass) => Place::Mass(mass),
            Node::Ground | Node::Base(_) => return None,
        },
        Location::Between(_) | Location::Input(_) => return None,
    };
    Some((place, line))
}

/// The cause that lines have in common in every run, by (1) or (2). Frequencies that differ by less than `same_hz` are
/// the same.
fn common(model: &Model, runs: &[Lines], noise: &[f64], same_hz: f64) -> Option<String> {
    let first = runs.first()?;
    let is_sensor = |place: &Place| matches!(place, Place::Sensor(_));
    let together = |(place, line): &(Place, Line), (other, its): &(Place, Line)| {
        is_sensor(other) == is_sensor(place)
            && (its.frequency_hz == 0.0) == (line.frequency_hz == 0.0)
            && (its.frequency_hz - line.frequency_hz).abs() < same_hz
    };
    first.iter().enumerate().find_map(|(leader, own)| {
        let (place, frequency) = (&own.0, own.1.frequency_hz);
        let members: Vec<usize> = (0..first.len())
            .filter(|&i| together(own, &first[i]))
            .collect();
        if members.len() < 2 || members[0] < leader {
            return None;
        }
        let plant = Plant {
            response: model.output_response(frequency).ok()?,
            noise,
            alike: ALIKE[usize::from(frequency > 0.0)],
        };
        let in_all = |is_so: &dyn Fn(&[Phasor]) -> bool| {
            runs.iter().all(|lines| {
                let own = members.iter().map(|&i| (lines[i].0, phasor(&lines[i].1)));
                is_so(&own.collect::<Vec<_>>())
            })
        };
        if is_sensor(place) {
            let mut masses = 0..model.masses.len();
            let mass = masses.find(|&mass| in_all(&|lines| plant.shows_force(mass, lines)))?;
            let name = &model.masses[mass].name;
            return Some(format!(
                "what several sensors are said to add is what one force on {name} would show on them"
            ));
        }
        let mut channels = 0..model.outputs.len();
        let channel = channels.find(|&channel| in_all(&|lines| plant.hides_forces(channel, lines)))?;
        let name = &model.outputs[channel].channel;
        Some(format!(
            "forces that cancel on every channel but {name} are a fault of its sensor"
        ))
    })
}

fn phasor(line: &Line) -> c64 {
    c64::new(
        line.amplitude * line.phase_rad.cos(),
        line.amplitude * line.phase_rad.sin(),
    )
}

/// What lines of one frequency are held against.
struct Plant<'a> {
    /// H.
    response: Mat<c64>,
    /// σ.
    noise: &'a [f64],
    /// ε.
    alike: f64,
}

impl Plant<'_> {
    /// Whether the lines of sensors are what some force on a mass shows, (1).
    fn shows_force(&self, mass: usize, lines: &[Phasor]) -> bool {
        let on = |channel: usize| {
            let mut own = lines.iter();
            own.find_map(|(place, line)| (*place == Place::Sensor(channel)).then_some(*line))
        };
        let over_noise = |c: usize| on(c).map_or(0.0, |line| line.norm() / self.noise[c]);
        let channels = 0..self.noise.len();
        let clearest = channels
            .clone()
            .max_by(|a, b| over_noise(*a).total_cmp(&over_noise(*b)));
        let known = clearest.and_then(|c| Some((on(c)?, self.response[(c, mass)])));
        let Some((line, moved)) = known.filter(|(_, moved)| moved.norm() > 0.0) else {
            return false;
        };
        let force = line / moved;
        channels.into_iter().all(|channel| {
            let shown = self.response[(channel, mass)] * force;
            match on(channel) {
                Some(line) => (shown - line).norm() <= self.alike * line.norm(),
                None => shown.norm() <= self.noise[channel],
            }
        })
    }

    /// Whether forces cancel on every channel but one, (2).
    fn hides_forces(&self, channel: usize, lines: &[Phasor]) -> bool {
        let shown = |c: usize| {
            lines.iter().filter_map(move |&(place, force)| match place {
                Place::Mass(mass) => Some(self.response[(c, mass)] * force),
                Place::Sensor(_) => None,
            })
        };
        let sum = |c: usize| {
            let all = shown(c).fold(c64::new(0.0, 0.0), |sum, line| sum + line);
            all.norm()
        };
        let sizes = |c: usize| shown(c).map(|line| line.norm()).sum::<f64>();
        let cancel = |c: usize| sum(c) <= f64::min(self.alike * sizes(c), self.noise[c]);
        let others = (0..self.noise.len()).filter(|c| *c != channel);
        sum(channel) > 0.0
            && others.clone().any(|c| sizes(c) > 0.0)
            && others.into_iter().all(cancel)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const CHAIN: &str = r#"schema = "simgap-model/1"
name = "chain"
mass = [{ name = "a", value = 2.0 }, { name = "b", value = 3.0 }]
spring = [
  { name = "k1", between = ["a", "ground"], stiffness = 800.0 },
  { name = "k2", between = ["b", "a"], stiffness = 500.0 },
]
damper = [{ name = "c", between = ["b", "a"], damping = 4.0 }]
output = [
  { channel = "xa", kind = "displacement", at = "a" },
  { channel = "xb", kind = "displacement", at = "b" },
]
"#;
    const NOISE: [f64; 2] = [1e-5, 1e-5];
    const SAME_HZ: f64 = 0.01;

    fn found(lines: &[(Place, Line)]) -> Option<String> {
        let model = Model::from_toml(CHAIN).unwrap();
        common(&model, &[lines.to_vec()], &NOISE, SAME_HZ)
    }

    /// 10 N on b: 10/800 m on a, 10/500 m more on b.
    #[test]
    fn biases_that_one_force_explains_are_not_of_the_sensors() {
        let biases = |a: f64, b: f64| {
            found(&[
                (Place::Sensor(0), Line::constant(a)),
                (Place::Sensor(1), Line::constant(b)),
            ])
        };
        assert!(biases(0.0125, 0.0325).unwrap().contains("one force on b"));
        assert!(biases(0.0125, 0.0125).unwrap().contains("one force on a"));
        assert_eq!(biases(0.0125, -0.0325), None);
        assert_eq!(biases(0.0125, 0.0500), None);
        assert_eq!(found(&[(Place::Sensor(0), Line::constant(0.01))]), None);
    }

    #[test]
    fn tones_have_one_cause_where_they_have_one_frequency() {
        let model = Model::from_toml(CHAIN).unwrap();
        let response = model.output_response(3.1).unwrap();
        let tone = |channel: usize, frequency_hz: f64, turned: f64| {
            let shown = response[(channel, 0)] * c64::new(7.0, 0.0);
            let line = Line {
                frequency_hz,
                amplitude: shown.norm(),
                phase_rad: shown.im.atan2(shown.re) + turned,
            };
            (Place::Sensor(channel), line)
        };
        let of_force = found(&[tone(0, 3.1, 0.4), tone(1, 3.1, 0.4)]);
        assert!(of_force.unwrap().contains("one force on a"));
        assert_eq!(found(&[tone(0, 3.1, 0.4), tone(1, 3.1, 0.9)]), None);
        assert_eq!(found(&[tone(0, 3.1, 0.4), tone(1, 3.3, 0.4)]), None);
        // Whatever the order, a third line of the same frequency belongs to them.
        let third = (Place::Sensor(1), Line::constant(1.0));
        let beside = found(&[third, tone(0, 3.1, 0.4), tone(1, 3.1, 0.4)]);
        assert!(beside.unwrap().contains("one force on a"));
    }

    /// Forces that hold a where it is move b alone.
    #[test]
    fn forces_that_show_on_one_channel_are_a_fault_of_its_sensor() {
        let forces = |a: f64, b: f64| {
            found(&[
                (Place::Mass(0), Line::constant(a)),
                (Place::Mass(1), Line::constant(b)),
            ])
        };
        assert!(forces(-5.0, 5.0).unwrap().contains("every channel but xb"));
        assert_eq!(forces(5.0, 5.0), None);
        assert_eq!(forces(0.0, 5.0), None);
        // They cancel but for a tenth, far above the noise of xa.
        assert_eq!(forces(-5.0, 5.5), None);
    }
}
