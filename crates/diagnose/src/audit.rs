//! What is odd about records against a model, before any physics is asked: clocks, sizes, signs,
//! shifts, channels that nothing moves.
//!
//! The model as given is simulated once, from the initial states that fit best, and compared with what
//! was measured, p with m, about their straight lines. Means over blocks of one period of the slowest
//! vibration hold the quasi-static part, in which masses and dampers hardly count:
//!
//! ```text
//! g = Σ p m / Σ p²,   γ² = (Σ p m)² / (Σ p² Σ m²)                              (1)
//! ```
//!
//! A wrong sign is g < 0, a wrong unit g near a power of ten or far from 1, as long as γ² says that the
//! two have to do with each other. These are hints: nothing is changed, and the diagnosis does not
//! hang on them.

use simgap_estimate::{FitOptions, Problem, fit_initial_states};
use simgap_model::{Model, Output, undamped_modes};
use simgap_record::{AuditFinding, AuditTopic, Record};
use simgap_signal::correlation::autocorrelation;
use simgap_simulate::Run;

use crate::DiagnoseError;

/// Samples of a record that are looked at: what is this odd shows in its first part.
const MOST_SAMPLES: usize = 20_000;
/// Fewest blocks, and least share of the predicted power in their means, that make a quasi-static part.
const FEWEST_BLOCKS: usize = 16;
const LEAST_SLOW: f64 = 0.01;
/// γ² of (1) from which slow parts, or whole signals, have to do with each other.
const RELATED: f64 = 0.6;
const RELATED_AS_A_WHOLE: f64 = 0.8;
/// Factors within this share of a known one are that one; others are told beyond `FAR`.
const NEAR: f64 = 0.2;
const FAR: f64 = 5.0;
/// Without any relation only sizes beyond this factor are told.
const VERY_FAR: f64 = 100.0;
/// A mean is off if it is this many standard deviations of the channel from the predicted one.
const MEAN_OFF: f64 = 5.0;
/// A shift is told where it raises a correlation below the first of these above the second, and no other
/// shift comes near it.
const UNSHIFTED: f64 = 0.7;
const SHIFTED: f64 = 0.93;
const NEXT_BEST: f64 = 0.85;
/// Longest shift that is sought, share of the record.
const LONGEST_SHIFT: f64 = 0.05;
/// A channel that moves by less than this share of its mean stands still.
const STILL: f64 = 1e-12;
/// Fewest samples, lags and standard errors by which noise is known to be white.
const FEWEST_OF_NOISE: usize = 256;
const LAGS_OF_NOISE: usize = 8;
const STANDARD_ERRORS: f64 = 4.0;

/// Units that are taken for each other: how many times too large a value is, and what it then looks like.
const UNITS: [(f64, &str); 8] = [
    (1e3, "a thousandth of its unit (mm for m, N for kN)"),
    (1e-3, "a thousand times its unit (m for mm, kN for N)"),
    (1e6, "a millionth of its unit (um for m)"),
    (1e-6, "a million times its unit"),
    (180.0 / std::f64::consts::PI, "degrees for radians"),
    (std::f64::consts::PI / 180.0, "radians for degrees"),
    (9.806_65, "m/s^2 for g, or N for kg"),
    (1.0 / 9.806_65, "g for m/s^2, or kg for N"),
];

/// Looks at records against a model; those of [`simgap_record::audit`] come first.
///
/// # Errors
/// [`DiagnoseError`] when a record does not fit the model or the model cannot be simulated.
pub fn audit(model: &Model, records: &[&Record]) -> Result<Vec<AuditFinding>, DiagnoseError> {
    let mut found = simgap_record::audit(records);
    let clock = Clock::of(model);
    for record in records {
        let run = Run::with_outputs(model, record)?;
        let mut add = |topic, text| {
            found.push(AuditFinding {
                record: record.name().to_string(),
                topic,
                text,
            });
        };
        clock
            .look(&run)
            .into_iter()
            .for_each(|text| add(AuditTopic::Clock, text));
        let run = run.slice(0..MOST_SAMPLES);
        let problem = Problem::new(model, vec![run])?;
        let weights = FitOptions::white(model.outputs.len());
        let fit = fit_initial_states(&problem, &[], &weights)?;
        let run = &problem.runs[0];
        let simulator = problem.simulator(&[], 0)?;
        let from_rest = simulator.predict(run, &[])?;
        for (k, output) in model.outputs.iter().enumerate() {
            let (Some(measured), Some(left)) = (&run.measured[k], fit.discrepancy[0].get(k)) else {
                continue;
            };
            let predicted = measured.iter().zip(left).map(|(m, left)| m - left);
            let pair = Pair {
                channel: &output.channel,
                measured,
                predicted: &predicted.collect::<Vec<f64>>(),
                from_rest: &from_rest[k],
                period: clock.slowest_s.map(|period| period / run.time_step_s),
                step_s: run.time_step_s,
            };
            for (topic, text) in pair.look(is_driven(model, output)) {
                add(topic, text);
            }
        }
    }
    Ok(found)
}

/// What the model says of time.
struct Clock {
    /// Period of the slowest vibration, s; `None` where nothing vibrates.
    slowest_s: Option<f64>,
}

impl Clock {
    fn of(model: &Model) -> Clock {
        let modes = model.tangent_matrices().and_then(|m| undamped_modes(&m));
        let freqs = modes.map(|modes| modes.natural_freq_hz).unwrap_or_default();
        let highest = freqs.iter().copied().fold(0.0, f64::max);
        // A mode without a spring has a frequency of rounding.
        let vibrates = freqs.into_iter().filter(|f| *f > 1e-6 * highest);
        let slowest = vibrates.reduce(f64::min);
        Clock {
            slowest_s: slowest.map(|freq_hz| 1.0 / freq_hz),
        }
    }

    fn look(&self, run: &Run) -> Option<String> {
        let period = self.slowest_s?;
        let told = |what: &str| {
            Some(format!(
                "{what} the slowest vibration of the model has a period of {} s: is the time in another unit?",
                figure(period)
            ))
        };
        if run.duration_s() < 0.25 * period {
            return told(&format!("it lasts {} s, and", figure(run.duration_s())));
        }
        if run.time_step_s > 0.5 * period {
            return told(&format!("its step is {} s, and", figure(run.time_step_s)));
        }
        None
    }
}

/// A measured and a predicted signal.
struct Pair<'a> {
    channel: &'a str,
    measured: &'a [f64],
    predicted: &'a [f64],
    /// The prediction from rest: the initial states that fit a wrong unit best hide what is forced.
    from_rest: &'a [f64],
    /// The period of the slowest vibration, samples.
    period: Option<f64>,
    step_s: f64,
}

impl Pair<'_> {
    fn look(&self, is_driven: bool) -> Vec<(AuditTopic, String)> {
        let channel = self.channel;
        let (measured, predicted) = (detrended(self.measured), detrended(self.predicted));
        let whole = Relation::of(&predicted, &measured);
        if !is_driven {
            let text = format!("nothing in the model drives '{channel}'");
            return vec![(AuditTopic::Unmoved, text)];
        }
        // Rounding of the mean is all that a value that stands still leaves.
        let mean_size = mean(self.measured).abs();
        if rms(&measured) <= STILL * mean_size || rms(&measured) == 0.0 {
            let text = format!("'{channel}' stands still: is the sensor connected?");
            return vec![(AuditTopic::Unmoved, text)];
        }
        if is_white(self.measured) && whole.squared < RELATED * RELATED {
            let text = format!(
                "'{channel}' looks like noise: no sample says anything of the next; is the sensor connected?"
            );
            return vec![(AuditTopic::Unmoved, text)];
        }
        let from_rest = detrended(self.from_rest);
        let relation = |p: &[f64]| self.relation(p, &measured);
        let mut told = vec![];
        match relation(&predicted).or_else(|| relation(&from_rest)) {
            Some((gain, which)) => {
                if gain < 0.0 {
                    let text = format!(
                        "'{channel}' goes the other way than the model in {which}motion: is the sign of the channel, or of an input, reversed?"
                    );
                    told.push((AuditTopic::Sign, text));
                }
                told.extend(units(channel, gain.abs(), FAR));
            }
            None => told.extend(units(channel, rms(&measured) / rms(&from_rest), VERY_FAR)),
        }
        if told.is_empty() {
            told.extend(self.shift(&predicted, &measured));
            told.extend(self.mean_off(&measured));
        }
        told
    }

    /// The gain of the slow part where that is related, else of the whole.
    fn relation(&self, predicted: &[f64], measured: &[f64]) -> Option<(f64, &'static str)> {
        let slow = self.slow(predicted, measured);
        let slow = slow.filter(|slow| slow.squared > RELATED);
        let whole = Relation::of(predicted, measured);
        let is_related = whole.squared > RELATED_AS_A_WHOLE;
        slow.map(|slow| (slow.gain, "slow "))
            .or(is_related.then_some((whole.gain, "")))
    }

    /// The relation of means over blocks of one period, where these hold enough of the prediction.
    fn slow(&self, predicted: &[f64], measured: &[f64]) -> Option<Relation> {
        let block = self
            .period
            .map_or(predicted.len() / 64, |p| p.round() as usize);
        let block = block.max(1);
        if predicted.len() / block < FEWEST_BLOCKS {
            return None;
        }
        let means = |signal: &[f64]| -> Vec<f64> {
            let blocks = signal.chunks_exact(block);
            blocks
                .map(|b| b.iter().sum::<f64>() / block as f64)
                .collect()
        };
        let (p, m) = (means(predicted), means(measured));
        let share = (rms(&p) / rms(predicted)).powi(2);
        (share > LEAST_SLOW).then(|| Relation::of(&p, &m))
    }

    /// A shift that brings the two together.
    fn shift(&self, predicted: &[f64], measured: &[f64]) -> Option<(AuditTopic, String)> {
        let longest = (LONGEST_SHIFT * measured.len() as f64) as usize;
        let scale = rms(predicted) * rms(measured) * measured.len() as f64;
        let at = |shift: isize| {
            let late = shift.max(0) as usize;
            let early = (-shift).max(0) as usize;
            let pairs = measured[late..].iter().zip(&predicted[early..]);
            pairs.map(|(m, p)| m * p).sum::<f64>() / scale
        };
        if at(0) > UNSHIFTED || scale == 0.0 {
            return None;
        }
        let longest = isize::try_from(longest).unwrap_or(0);
        let all: Vec<f64> = (-longest..=longest).map(at).collect();
        let best = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b]))?;
        // Elsewhere, behind the next valley, the two must not come together again: a sine does.
        let valley = |step: isize| {
            let mut k = best as isize;
            while all
                .get((k + step) as usize)
                .is_some_and(|next| *next < all[k as usize])
            {
                k += step;
            }
            k
        };
        let (left, right) = (valley(-1), valley(1));
        let outside = all.iter().enumerate().filter(|(k, _)| {
            let k = *k as isize;
            k < left || k > right
        });
        let next = outside.map(|(_, c)| *c).fold(0.0, f64::max);
        if all[best] < SHIFTED || next > NEXT_BEST * all[best] {
            return None;
        }
        let shift_s = (best as isize - longest) as f64 * self.step_s;
        let way = if shift_s > 0.0 { "later" } else { "earlier" };
        let text = format!(
            "'{}' comes {} s {way} than the inputs let expect: are the clocks of the channels the same?",
            self.channel,
            figure(shift_s.abs())
        );
        Some((AuditTopic::Offset, text))
    }

    /// A mean far from the predicted one.
    fn mean_off(&self, measured: &[f64]) -> Option<(AuditTopic, String)> {
        self.period?;
        let [m, p] = [self.measured, self.predicted].map(mean);
        ((m - p).abs() > MEAN_OFF * rms(measured)).then(|| {
            let text = format!(
                "'{}' has a mean of {} where the model has {}, in SI units: is the zero of the sensor, or a weight, left out?",
                self.channel,
                figure(m),
                figure(p)
            );
            (AuditTopic::Offset, text)
        })
    }
}

/// How two signals about zero have to do with each other, (1).
#[derive(Clone, Copy)]
struct Relation {
    gain: f64,
    squared: f64,
}

impl Relation {
    fn of(predicted: &[f64], measured: &[f64]) -> Relation {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (pm, pp, mm) = (
            dot(predicted, measured),
            dot(predicted, predicted),
            dot(measured, measured),
        );
        let squared = pm * pm / (pp * mm);
        Relation {
            gain: pm / pp,
            squared: if squared.is_finite() { squared } else { 0.0 },
        }
    }
}

/// Whether a size tells of another unit.
fn units(channel: &str, factor: f64, far: f64) -> Option<(AuditTopic, String)> {
    if !(factor.is_finite() && factor > 0.0) {
        return None;
    }
    let near = |known: f64| (factor / known - 1.0).abs() < NEAR;
    let known = UNITS.iter().find(|(known, _)| near(*known));
    let is_far = !(1.0 / far..=far).contains(&factor);
    if !is_far {
        return None;
    }
    let looks = known.map_or(String::new(), |(_, looks)| format!(", as {looks} would be"));
    let size = if factor > 1.0 {
        format!("{} times larger", figure(factor))
    } else {
        format!("{} times smaller", figure(1.0 / factor))
    };
    let text = format!(
        "'{channel}' is {size} than the model predicts{looks}: are the units of the column and of the model right?"
    );
    Some((AuditTopic::Units, text))
}

/// Whether something drives what an output sees: an input or a load on what is joined to it. Without any input all
/// motion is free.
fn is_driven(model: &Model, output: &Output) -> bool {
    if model.inputs.is_empty() {
        return true;
    }
    let ends = output.at.iter().chain(output.between.iter().flatten());
    let mut reached: Vec<&str> = ends.map(String::as_str).collect();
    let members = model.joined();
    loop {
        let joined = members.iter().find_map(|pair| {
            let [a, b] = [pair[0].as_str(), pair[1].as_str()];
            // Motion does not pass through the ground.
            let inside = |node: &str| node != simgap_model::GROUND && reached.contains(&node);
            let next = |from: &str, to: &str| inside(from) && !reached.contains(&to);
            match (next(a, b), next(b, a)) {
                (true, _) => Some(b),
                (_, true) => Some(a),
                _ => None,
            }
        });
        match joined {
            Some(node) => reached.push(node),
            None => break,
        }
    }
    model
        .inputs
        .iter()
        .any(|input| reached.contains(&input.at.as_str()))
}

/// Whether no sample says anything of the next ones.
fn is_white(values: &[f64]) -> bool {
    let bound = STANDARD_ERRORS / (values.len() as f64).sqrt();
    values.len() >= FEWEST_OF_NOISE
        && autocorrelation(values, LAGS_OF_NOISE)
            .is_ok_and(|rho| rho[1..].iter().all(|rho| rho.abs() < bound))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// The values about their straight line.
fn detrended(values: &[f64]) -> Vec<f64> {
    let (mean, middle) = (mean(values), (values.len() as f64 - 1.0) / 2.0);
    let (mut product, mut square) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let from_middle = k as f64 - middle;
        product += from_middle * (value - mean);
        square += from_middle * from_middle;
    }
    let slope = if square > 0.0 { product / square } else { 0.0 };
    let line = |k: usize| mean + slope * (k as f64 - middle);
    values
        .iter()
        .enumerate()
        .map(|(k, v)| v - line(k))
        .collect()
}

/// Three digits are enough.
fn figure(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
