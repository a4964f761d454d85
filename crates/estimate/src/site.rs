//! Typical sizes at a place, from which the effects take their starting values.

use std::f64::consts::TAU;

use simgap_effects::{LINES, SiteScale};
use simgap_model::{InputKind, Location, Model, OutputKind, same_pair};
use simgap_signal::peaks::{PeakOptions, find_peaks};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};
use simgap_simulate::{MemberPath, Run};

use crate::problem::{rms_about_mean, rms_about_means};
use crate::products::dot;
use crate::{EstimateError, Fit, Problem};

/// More levels than this are how numbers are printed, not what a converter does.
const MOST_LEVELS: usize = 4096;
/// A level may be this share of a step off, and this share of the values off the lattice.
const OFF_LATTICE: f64 = 0.05;
const OFF_SHARE: f64 = 0.02;

/// Delays, in samples, that are taken off what is left where carriers of an input are looked for: halves of holds.
const MOST_LATE: usize = 25;

impl Problem {
    /// Typical sizes at a place, from the motion that a fit predicts there and what it leaves.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn site_scale(&self, fit: &Fit, at: &Location) -> Result<SiteScale, EstimateError> {
        let mut path = MemberPath::default();
        let mut at_port = None;
        for (r, run) in self.runs.iter().enumerate() {
            let simulator = self.simulator(&fit.estimate.nominal, r)?;
            let one = simulator.path(run, &fit.estimate.initial[r], at)?;
            if at_port.is_none() {
                at_port = simulator.port_inertia(run, at)?;
            }
            path.displacement.extend(one.displacement);
            path.velocity.extend(one.velocity);
            path.acceleration.extend(one.acceleration);
        }
        let channel = self.channel_at(at);
        let acceleration = rms_about_mean(|| path.acceleration.iter());
        let inertia = match at_port {
            Some(mass) => mass * acceleration,
            None => self.force_scale(at, acceleration),
        };
        let input = self.input_at(at);
        let sent = |i: usize| self.runs.iter().flat_map(move |run| run.inputs[i].iter());
        let (signal, signal_range) = match (channel, input) {
            (Some(i), _) => (
                self.motion_std()[i],
                range(self.measured(i).flatten().copied()),
            ),
            (None, Some(i)) => (rms_about_mean(|| sent(i)), range(sent(i).copied())),
            (None, None) => (0.0, [-1.0, 1.0]),
        };
        let displacement_m = positive(match self.model.is_level_free(at) {
            true => rms_about_means(runs_of(&path.displacement, &self.runs)),
            false => rms_about_mean(|| path.displacement.iter()),
        });
        let velocity_m_per_s = positive(rms_about_mean(|| path.velocity.iter()));
        let stiffness = stiffness_at(&self.model, at);
        let damping = damping_at(&self.model, at);
        let carried = [stiffness * displacement_m, damping * velocity_m_per_s];
        let drives = self.model.inputs.iter().enumerate();
        let driven = drives
            .filter(|(_, input)| input.kind == InputKind::Force && is_node_at(&input.at, at))
            .map(|(i, _)| rms_about_mean(|| sent(i)));
        let forces = driven.chain(carried);
        let force_n = positive(forces.fold(inertia, f64::max));
        let longest = self.runs.iter().map(Run::duration_s).fold(0.0, f64::max);
        let first = self.runs.first();
        let step = first.map_or(1.0, |run| run.time_step_s);
        let (signal_step, signal_level) = channel
            .and_then(|i| self.lattice_of(i))
            .unwrap_or((0.0, 0.0));
        let moved = path.displacement.get(..first.map_or(0, |run| run.len));
        Ok(SiteScale {
            signal: positive(signal),
            time_step_s: step,
            duration_s: positive(longest),
            displacement_range_m: range(path.displacement.iter().copied()),
            travel_m: runs_of(&path.displacement, &self.runs)
                .map(|own| range(own.iter().copied()))
                .map(|[low, high]| high - low)
                .fold(0.0, f64::max),
            signal_range,
            signal_step,
            signal_level,
            mass_kg: at_port.or(mass_at(&self.model, at)).unwrap_or(1.0),
            lines_hz: self.lines_left(fit, at),
            carriers_hz: self.carriers_left(fit, at),
            late_s: self.late(fit, at),
            motion_hz: lines(&[moved.unwrap_or_default()], step),
            ..SiteScale::plain(displacement_m, velocity_m_per_s, force_n)
                .with_members(stiffness, damping)
        })
    }

    /// The step in which the values of a channel are stored and its level nearest to zero, in its unit; `None` where they lie
    /// on no coarse lattice.
    #[must_use]
    pub fn lattice_of(&self, channel: usize) -> Option<(f64, f64)> {
        lattice(self.measured(channel).flatten().copied().collect())
    }

    /// Strongest lines of what a fit leaves of the longest run, Hz: of the channel at the place, of
    /// all channels elsewhere.
    #[must_use]
    pub fn lines_left(&self, fit: &Fit, at: &Location) -> [f64; LINES] {
        let Some((run, left)) = self.longest(fit) else {
            return [0.0; LINES];
        };
        let signals: Vec<&[f64]> = match self.channel_at(at) {
            Some(i) => vec![&left[i]],
            None => left.iter().map(Vec::as_slice).collect(),
        };
        lines(&signals, run.time_step_s)
    }

    /// Strongest lines of what a fit leaves of a channel in the longest run, times the signal and times its rate, Hz: a carrier
    /// c(t) of the signal leaves c(t) y, and c(t) y · y has a line at the frequency of c whatever the motion is. At an input u, of what it
    /// leaves of each channel beyond a gain and a delay of it, times du/dt: a hold of period T leaves a saw-tooth times du/dt.
    #[must_use]
    pub fn carriers_left(&self, fit: &Fit, at: &Location) -> [f64; LINES] {
        let Some((run, left)) = self.longest(fit) else {
            return [0.0; LINES];
        };
        let measured = |i: usize| run.measured.get(i).and_then(Option::as_ref);
        let products: Vec<Vec<f64>> = match (self.channel_at(at), self.input_at(at)) {
            (Some(i), _) => measured(i).map_or_else(Vec::new, |signal| {
                vec![product(&left[i], signal), product(&left[i], &rate(signal))]
            }),
            (None, Some(input)) => {
                let driven = rate(&run.inputs[input]);
                let channels = left.iter().enumerate();
                let beyond = channels
                    .filter_map(|(i, left)| Some(beyond_gain_and_delay(measured(i)?, left)));
                beyond.map(|beyond| product(&beyond, &driven)).collect()
            }
            (None, None) => vec![],
        };
        let products: Vec<&[f64]> = products.iter().map(Vec::as_slice).collect();
        // Nearly every maximum: in few periods of a product a carrier does not stand out of the rest, and is the largest all the same.
        let any = PeakOptions {
            false_alarm_probability: 0.999,
            ..PeakOptions::default()
        };
        lines_of(&products, run.time_step_s, &any)
    }

    /// The longest run, and what a fit leaves of each of its channels.
    fn longest<'a>(&'a self, fit: &'a Fit) -> Option<(&'a Run, &'a Vec<Vec<f64>>)> {
        let runs = self.runs.iter().zip(&fit.discrepancy);
        runs.max_by(|(a, _), (b, _)| a.duration_s().total_cmp(&b.duration_s()))
    }

    fn channel_at(&self, at: &Location) -> Option<usize> {
        match at {
            Location::Channel(name) => self.model.output_index(name),
            _ => None,
        }
    }

    fn input_at(&self, at: &Location) -> Option<usize> {
        match at {
            Location::Input(name) => self.model.inputs.iter().position(|i| &i.channel == name),
            _ => None,
        }
    }

    /// Inertia of the masses that a place joins, N; the measured forces where it joins none.
    fn force_scale(&self, at: &Location, acceleration: f64) -> f64 {
        let inertia = masses_at(&self.model, at).fold(0.0, f64::max) * acceleration;
        if inertia > 0.0 {
            return inertia;
        }
        let forces = self
            .model
            .outputs
            .iter()
            .zip(self.motion_std())
            .filter(|(output, _)| output.kind == OutputKind::Force)
            .map(|(_, std)| std);
        forces.fold(0.0, f64::max)
    }
}

/// What belongs to each run of a signal over all of them.
fn runs_of<'a>(signal: &'a [f64], runs: &'a [Run]) -> impl Iterator<Item = &'a [f64]> {
    let mut rest = signal;
    runs.iter().map(move |run| {
        let (own, after) = rest.split_at(run.len.min(rest.len()));
        rest = after;
        own
    })
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// Change of a signal over two samples.
fn rate(signal: &[f64]) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    let change = |k: usize| signal[(k + 1).min(last)] - signal[k.saturating_sub(1)];
    (0..signal.len()).map(change).collect()
}

/// What is left of a measured signal y beyond a gain and a delay of what is predicted of it, ŷ:
///
/// ```text
/// y(t) − a ŷ(t − n Δt) − b ŷ′(t − n Δt),   a, b by least squares, the n that leaves least
/// ```
///
/// Empty where the prediction does not move.
fn beyond_gain_and_delay(measured: &[f64], left: &[f64]) -> Vec<f64> {
    let predicted: Vec<f64> = measured.iter().zip(left).map(|(y, e)| y - e).collect();
    let rate = rate(&predicted);
    let late = |samples: usize| {
        let shown = measured.get(samples..)?;
        let [y, r] = [&predicted, &rate].map(|signal| &signal[..shown.len()]);
        let [yy, yr, rr] = [dot(y, y), dot(y, r), dot(r, r)];
        let [my, mr] = [dot(shown, y), dot(shown, r)];
        let determinant = yy * rr - yr * yr;
        let a = (my * rr - mr * yr) / determinant;
        let b = (mr * yy - my * yr) / determinant;
        let signals = shown.iter().zip(y.iter().zip(r));
        let beyond: Vec<f64> = signals.map(|(m, (y, r))| m - a * y - b * r).collect();
        let mean_square = dot(&beyond, &beyond) / beyond.len() as f64;
        mean_square
            .is_finite()
            .then_some((mean_square, samples, beyond))
    };
    let least = (0..=MOST_LATE)
        .filter_map(late)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    least.map_or_else(Vec::new, |(_, samples, beyond)| {
        // On the clock of the record.
        let before = std::iter::repeat_n(0.0, samples);
        before.chain(beyond).collect()
    })
}

/// A site that does not move in the nominal model still gets finite starting values.
fn positive(value: f64) -> f64 {
    if value > 0.0 && value.is_finite() {
        value
    } else {
        1.0
    }
}

fn masses_at<'a>(model: &'a Model, at: &'a Location) -> impl Iterator<Item = f64> + 'a {
    let masses = model.masses.iter();
    masses
        .filter(move |mass| is_node_at(&mass.name, at))
        .map(|mass| mass.value)
}

/// Whether a node is one of those of a place.
fn is_node_at(node: &String, at: &Location) -> bool {
    match at {
        Location::Between(pair) => pair.contains(node),
        Location::Mass(mass) => mass == node,
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => false,
    }
}

fn mass_at(model: &Model, at: &Location) -> Option<f64> {
    masses_at(model, at).min_by(f64::total_cmp)
}

fn stiffness_at(model: &Model, at: &Location) -> f64 {
    let springs = model.springs.iter();
    let springs = springs.filter(|spring| is_member_at(&spring.between, at));
    springs.map(|spring| spring.stiffness).sum()
}

fn damping_at(model: &Model, at: &Location) -> f64 {
    let dampers = model.dampers.iter();
    let dampers = dampers.filter(|damper| is_member_at(&damper.between, at));
    dampers.map(|damper| damper.damping).sum()
}

/// Whether a member joins the two nodes of a place, or the mass of one to any node.
fn is_member_at(between: &[String; 2], at: &Location) -> bool {
    match at {
        Location::Between(pair) => same_pair(between, pair),
        Location::Mass(mass) => between.contains(mass),
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => false,
    }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = values.fold(start, |[low, high], v| [low.min(v), high.max(v)]);
    if low < high { [low, high] } else { [-1.0, 1.0] }
}

/// The strongest lines of several signals together that noise would hardly show, strongest first.
fn lines(signals: &[&[f64]], step: f64) -> [f64; LINES] {
    lines_of(signals, step, &PeakOptions::default())
}

/// The strongest lines of several signals together, strongest first, each signal counted by the
/// share of its own power.
fn lines_of(signals: &[&[f64]], step: f64, options: &PeakOptions) -> [f64; LINES] {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for signal in signals {
        let Ok(spectrum) = spectrum(signal, 1.0 / step, Window::Hann, Trend::Linear) else {
            continue;
        };
        let Ok(peaks) = find_peaks(&spectrum, options) else {
            continue;
        };
        let size = positive(rms_about_mean(|| signal.iter()));
        for peak in peaks {
            let near = |known: &&mut (f64, f64)| {
                (known.0 - peak.freq_hz).abs() < 2.0 * spectrum.bin_width_hz()
            };
            match found.iter_mut().find(near) {
                Some(known) => known.1 += peak.amplitude / size,
                None => found.push((peak.freq_hz, peak.amplitude / size)),
            }
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    let mut lines = [0.0; LINES];
    for (line, (freq_hz, _)) in lines.iter_mut().zip(found) {
        *line = freq_hz;
    }
    lines
}

/// The step of values that lie on a coarse lattice, and its level nearest to zero.
fn lattice(mut values: Vec<f64>) -> Option<(f64, f64)> {
    let count = values.len();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 3 || values.len() > MOST_LEVELS || values.len() * 2 > count {
        return None;
    }
    let span = values[values.len() - 1] - values[0];
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let mut gaps: Vec<f64> = gaps.filter(|gap| *gap > 1e-9 * span).collect();
    gaps.sort_by(f64::total_cmp);
    // Beside a value off the lattice lie gaps shorter than a step; where levels are rare, most gaps are longer.
    let candidates = [gaps.get(gaps.len() / 2), gaps.first()];
    candidates.into_iter().flatten().find_map(|gap| {
        // The span says the step more finely than a printed gap does.
        let step = span / (span / gap).round();
        let level = level_near_zero(&values, step);
        let off = |value: &&f64| {
            let turn = (**value - level) / step;
            (turn - turn.round()).abs() > OFF_LATTICE
        };
        let strays = values.iter().filter(off).count();
        (strays as f64 <= OFF_SHARE * values.len() as f64).then_some((step, level))
    })
}

/// The level nearest to zero of values on a lattice, by their mean place between levels: some are strays. Zero itself
/// where it is a level.
fn level_near_zero(values: &[f64], step: f64) -> f64 {
    let turns = values.iter().map(|value| TAU * value / step);
    let (sin, cos) = turns.fold((0.0, 0.0), |(sin, cos), turn| {
        (sin + turn.sin(), cos + turn.cos())
    });
    let share = sin.atan2(cos) / TAU;
    if share.abs() > OFF_LATTICE {
        share * step
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_lattice_is_found_and_smooth_values_have_none() {
        let smooth: Vec<f64> = (0..2000).map(|i| (f64::from(i) * 0.01).sin()).collect();
        let coarse: Vec<f64> = smooth.iter().map(|v| (v / 0.02).round() * 0.02).collect();
        let (step, level) = lattice(coarse).unwrap();
        assert!((step - 0.02).abs() < 1e-12 && level == 0.0, "{step}");
        // Zero between two levels, and a first sample that lies on none.
        let between = smooth.iter().map(|v| (v / 0.02).floor() * 0.02 + 0.01);
        let mut between: Vec<f64> = between.collect();
        between[0] += 0.004;
        let (step, level) = lattice(between).unwrap();
        assert!((step - 0.02).abs() < 1e-12, "{step}");
        assert!((level.abs() - 0.01).abs() < 1e-3, "{level}");
        assert_eq!(lattice(smooth), None);
    }

    #[test]
    fn verify_the_strongest_lines_come_first() {
        let tone = |f: f64, t: f64| (std::f64::consts::TAU * f * t).sin();
        let signal: Vec<f64> = (0..4000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|t| 0.2 * tone(7.3, t) + 0.5 * tone(41.1, t))
            .collect();
        let found = lines(&[&signal], 1e-3);
        assert!((found[0] - 41.1).abs() < 0.02 && (found[1] - 7.3).abs() < 0.02);
    }
}
