//! Where the discrepancy of the nominal model lies: channels, records, frequencies, times and
//! states of motion.

use simgap_estimate::{EstimateError, Problem};
use simgap_model::{Location, undamped_modes};
use simgap_signal::spectrum::Psd;
use simgap_signal::welch::welch;

use crate::diagnosis::{BandShare, ChannelShare, PlaceMotion, RecordShare, StateShare, TimeShare};
use crate::gap::Prediction;
use crate::structure::welch_options;

/// Stretches a record is divided into.
const STRETCHES: usize = 20;
/// Entries of a list below this share are left out.
const SMALLEST_SHARE: f64 = 0.02;
/// The square of a gap below this multiple of that of the noise floor is hidden by it.
const HIDES: f64 = 1.5;
/// Entries of a list at the most.
const MOST_ENTRIES: usize = 6;

/// The gap of the nominal model that is to be shared out, and the noise in it.
///
/// Noise is everywhere alike, so it says nothing of where the gap lies: what is shared out is the
/// square of the gap less that of the noise floor. Where the floor hides the gap, the square of all
/// of it is.
pub(crate) struct Located<'a> {
    check: &'a Problem,
    prediction: &'a Prediction,
    /// Square of the noise floor of each channel, over the variance of the channel.
    floor: Vec<f64>,
    /// Whether the floor hides where the gap lies.
    pub(crate) is_hidden: bool,
    /// Squared discrepancy over the variance of the measured channel less that of its noise, summed
    /// over the channels, for each sample of each run. A sum over samples that is negative is none.
    pub(crate) energy: Vec<Vec<f64>>,
}

impl<'a> Located<'a> {
    /// `floor` is the noise of each channel over its standard deviation.
    pub(crate) fn new(check: &'a Problem, prediction: &'a Prediction, floor: &[f64]) -> Self {
        let square = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
        let is_hidden = square(&prediction.nrmse) < HIDES * square(floor);
        let floor = floor.iter().map(|f| if is_hidden { 0.0 } else { f * f });
        let floor: Vec<f64> = floor.collect();
        Located {
            energy: energy(prediction, &check.output_std(), floor.iter().sum()),
            check,
            prediction,
            floor,
            is_hidden,
        }
    }
}

fn energy(prediction: &Prediction, std: &[f64], noise: f64) -> Vec<Vec<f64>> {
    let of_run = |run: &Vec<Vec<f64>>| {
        let len = run.first().map_or(0, Vec::len);
        let square = |i: usize| {
            let each = run.iter().zip(std);
            each.map(|(signal, s)| (signal[i] / s).powi(2)).sum::<f64>() - noise
        };
        (0..len).map(square).collect()
    };
    prediction.discrepancy.iter().map(of_run).collect()
}

fn shares(values: &[f64]) -> Vec<f64> {
    let total: f64 = values.iter().sum();
    values
        .iter()
        .map(|v| if total > 0.0 { v / total } else { 0.0 })
        .collect()
}

pub(crate) fn channels(located: &Located<'_>) -> Vec<ChannelShare> {
    let gaps = located.prediction.nrmse.iter().zip(&located.floor);
    let squares: Vec<f64> = gaps.map(|(e, floor)| (e * e - floor).max(0.0)).collect();
    let outputs = &located.check.model.outputs;
    let named = outputs.iter().zip(shares(&squares));
    named
        .map(|(output, share)| ChannelShare {
            channel: output.channel.clone(),
            share,
        })
        .collect()
}

pub(crate) fn records(located: &Located<'_>) -> Vec<RecordShare> {
    let sums: Vec<f64> = located
        .energy
        .iter()
        .map(|run| run.iter().sum::<f64>().max(0.0))
        .collect();
    let named = located.check.runs.iter().zip(shares(&sums));
    named
        .map(|(run, share)| RecordShare {
            record: run.name.clone(),
            share,
        })
        .collect()
}

pub(crate) fn times(located: &Located<'_>) -> Vec<TimeShare> {
    let mut list = Vec::new();
    for (run, energy) in located.check.runs.iter().zip(&located.energy) {
        let len = energy.len().div_ceil(STRETCHES).max(1);
        for (k, stretch) in energy.chunks(len).enumerate() {
            let from = k * len;
            list.push(TimeShare {
                record: run.name.clone(),
                from_s: run.start_s + from as f64 * run.time_step_s,
                to_s: run.start_s + (from + stretch.len()) as f64 * run.time_step_s,
                share: stretch.iter().sum::<f64>().max(0.0),
            });
        }
    }
    let total: f64 = list.iter().map(|entry| entry.share).sum();
    for entry in &mut list {
        entry.share = if total > 0.0 {
            entry.share / total
        } else {
            0.0
        };
    }
    trim(&mut list, |entry| entry.share);
    list
}

fn trim<T>(list: &mut Vec<T>, share: impl Fn(&T) -> f64) {
    list.sort_by(|a, b| share(b).total_cmp(&share(a)));
    let mut kept = 0;
    list.retain(|entry| {
        kept += 1;
        kept <= MOST_ENTRIES && share(entry) >= SMALLEST_SHARE
    });
}

/// Bands of the longest check record: the constant part, and the peaks of the spectrum of the rest.
pub(crate) fn bands(located: &Located<'_>) -> Vec<BandShare> {
    bands_marked(located, |run| marks(located.check, run))
}

/// As [`bands`], named by the marks of the record that is looked at.
pub(crate) fn bands_marked(
    located: &Located<'_>,
    marks: impl Fn(usize) -> Marks,
) -> Vec<BandShare> {
    let (check, prediction) = (located.check, located.prediction);
    let std = check.output_std();
    let Some(run) = (0..check.runs.len()).max_by_key(|&r| check.runs[r].len) else {
        return vec![];
    };
    let fs = 1.0 / check.runs[run].time_step_s;
    let options = welch_options(check.runs[run].len);
    let spectrum = |values: &[f64]| welch(values, fs, &options).ok();
    let mut density: Vec<f64> = Vec::new();
    let mut freq_hz = Vec::new();
    for (signal, s) in prediction.discrepancy[run].iter().zip(&std) {
        let Some(psd) = spectrum(signal) else {
            continue;
        };
        density.resize(psd.density.len(), 0.0);
        density
            .iter_mut()
            .zip(&psd.density)
            .for_each(|(sum, d)| *sum += d / (s * s));
        freq_hz = psd.freq_hz;
    }
    // White noise is as strong at every frequency.
    let noise = located.floor.iter().sum::<f64>() * 2.0 / fs;
    density.iter_mut().for_each(|d| *d = (*d - noise).max(0.0));
    let marks = marks(run);
    let total: f64 = density.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let half_bin = freq_hz.get(1).map_or(0.0, |f| 0.5 * f);
    let constant = constant_share(&prediction.discrepancy[run], &std, &located.floor);
    let mut list = vec![BandShare {
        from_hz: 0.0,
        to_hz: half_bin,
        label: "constant".into(),
        share: constant,
    }];
    let mut left = density.clone();
    for _ in 0..2 * MOST_ENTRIES {
        let Some((peak, &height)) = left.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))
        else {
            break;
        };
        if height <= 0.0 {
            break;
        }
        // A band reaches down to a tenth of its peak on both sides.
        let low = (0..peak)
            .rev()
            .take_while(|&i| left[i] > 0.1 * height)
            .last()
            .unwrap_or(peak);
        let high = (peak + 1..left.len())
            .take_while(|&i| left[i] > 0.1 * height)
            .last()
            .unwrap_or(peak);
        let share = (1.0 - constant) * left[low..=high].iter().sum::<f64>() / total;
        left[low..=high].fill(0.0);
        let (from_hz, to_hz) = (
            (freq_hz[low] - half_bin).max(0.0),
            (freq_hz[high] + half_bin).min(0.5 * fs),
        );
        list.push(BandShare {
            from_hz,
            to_hz,
            label: label(&marks, freq_hz[peak], half_bin),
            share,
        });
    }
    trim(&mut list, |band| band.share);
    list
}

/// Share of the means in the squared discrepancy above the noise; the spectrum is taken about them.
fn constant_share(signals: &[Vec<f64>], std: &[f64], noise: &[f64]) -> f64 {
    let (mut constant, mut all) = (0.0, -noise.iter().sum::<f64>());
    for (signal, s) in signals.iter().zip(std) {
        let count = signal.len().max(1) as f64;
        let mean = signal.iter().sum::<f64>() / count;
        constant += (mean / s).powi(2);
        all += signal.iter().map(|d| (d / s).powi(2)).sum::<f64>() / count;
    }
    let all = all.max(constant);
    if all > 0.0 { constant / all } else { 0.0 }
}

/// Frequencies worth a name.
pub(crate) struct Marks {
    /// The line that others are multiples of, and what it is called.
    pub(crate) main: Option<(f64, &'static str)>,
    pub(crate) natural_hz: Vec<f64>,
    pub(crate) sample_rate_hz: f64,
}

fn marks(check: &Problem, run: usize) -> Marks {
    let signals = &check.runs[run];
    let options = welch_options(signals.len);
    let rate = 1.0 / signals.time_step_s;
    let spectrum = |values: &[f64]| -> Option<Psd> { welch(values, rate, &options).ok() };
    // A single line that carries most of an input is the excitation; free decays have none.
    let excitation_hz = signals.inputs.iter().find_map(|u| {
        let psd = spectrum(u)?;
        let total: f64 = psd.density.iter().sum();
        let (peak, _) = psd
            .density
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(b.1))?;
        let around = peak.saturating_sub(2)..(peak + 3).min(psd.density.len());
        let weights = &psd.density[around.clone()];
        let power: f64 = weights.iter().sum();
        let mean: f64 = psd.freq_hz[around]
            .iter()
            .zip(weights)
            .map(|(f, w)| f * w)
            .sum();
        (power > 0.7 * total && peak > 0).then(|| mean / power)
    });
    let natural_hz = check
        .model
        .tangent_matrices()
        .and_then(|matrices| undamped_modes(&matrices))
        .map(|modes| modes.natural_freq_hz)
        .unwrap_or_default();
    Marks {
        main: excitation_hz.map(|f| (f, "the excitation")),
        natural_hz,
        sample_rate_hz: rate,
    }
}

fn label(marks: &Marks, freq_hz: f64, half_bin: f64) -> String {
    let near = |a: f64, b: f64| (a - b).abs() <= (2.0 * half_bin).max(0.01 * b);
    if freq_hz <= half_bin {
        return "slow drift".into();
    }
    let nyquist = 0.5 * marks.sample_rate_hz;
    if let Some((f, main)) = marks.main {
        if near(freq_hz, f) {
            return format!("{main} at {f:.4} Hz");
        }
        let order = (freq_hz / f).round();
        if (2.0..30.0).contains(&order) && near(freq_hz, order * f) {
            return format!("harmonic {order} of {main} at {f:.4} Hz");
        }
        let image = ((nyquist - freq_hz) / f).round();
        if (1.0..6.0).contains(&image) && near(freq_hz, nyquist - image * f) {
            return format!("half the sample rate ({nyquist:.4} Hz) minus {image} times {f:.4} Hz");
        }
    }
    if let Some(natural) = marks
        .natural_hz
        .iter()
        .find(|&&n| n > 0.0 && (freq_hz / n - 1.0).abs() < 0.1)
    {
        return format!("near the natural frequency {natural:.4} Hz");
    }
    if near(freq_hz, nyquist) {
        return format!("half the sample rate ({nyquist:.4} Hz)");
    }
    format!("around {freq_hz:.4} Hz")
}

/// The nominal motion across each place along each check record, the places in turn.
pub(crate) fn motions(
    check: &Problem,
    prediction: &Prediction,
    places: &[Location],
) -> Result<Vec<PlaceMotion>, EstimateError> {
    let simulator = check.simulator(&[], 0)?;
    let mut list = Vec::new();
    for place in places {
        for (run, initial) in check.runs.iter().zip(&prediction.initial) {
            let path = simulator.path(run, initial, place)?;
            list.push(PlaceMotion {
                record: run.name.clone(),
                at: place.clone(),
                displacement: path.displacement,
                velocity: path.velocity,
            });
        }
    }
    Ok(list)
}

/// Regions of motion where the discrepancy gathers, over the nominal motion across each place.
pub(crate) fn states(located: &Located<'_>, motions: &[PlaceMotion]) -> Vec<StateShare> {
    let flat: Vec<f64> = located.energy.concat();
    let mut list = Vec::new();
    for group in motions.chunk_by(|a, b| a.at == b.at) {
        let place = &group[0].at;
        let join = |of: fn(&PlaceMotion) -> &Vec<f64>| -> Vec<f64> {
            group.iter().flat_map(of).copied().collect()
        };
        let displacement = join(|motion| &motion.displacement);
        let velocity = join(|motion| &motion.velocity);
        let name = match place {
            Location::Between([a, b]) if b == simgap_model::GROUND => a.clone(),
            Location::Between([a, b]) if a == simgap_model::GROUND => b.clone(),
            Location::Between([a, b]) => format!("{a} to {b}"),
            Location::Mass(name)
            | Location::Input(name)
            | Location::Channel(name)
            | Location::Parameter(name) => name.clone(),
        };
        list.extend(regions(&flat, "velocity", &velocity, &name));
        list.extend(regions(&flat, "displacement", &displacement, &name));
    }
    ranked(list)
}

/// What gathers where the motion seldom is comes first.
pub(crate) fn ranked(mut list: Vec<StateShare>) -> Vec<StateShare> {
    list.sort_by(|a, b| (b.share - b.occupancy).total_cmp(&(a.share - a.occupancy)));
    list.truncate(MOST_ENTRIES);
    list
}

/// Shares of the regions of one variable: about its middle and at its ends.
pub(crate) fn regions(
    energy: &[f64],
    variable: &'static str,
    values: &[f64],
    at: &str,
) -> Vec<StateShare> {
    let total: f64 = energy.iter().sum();
    let travel = variable == "displacement";
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| {
            (low.min(v), high.max(v))
        });
    // Displacement turns about the middle of the travel, velocity and all else about zero.
    let (centre, reach) = if travel {
        (0.5 * (low + high), 0.5 * (high - low))
    } else {
        (0.0, high.abs().max(low.abs()))
    };
    if !(reach > 0.0 && total > 0.0) {
        return vec![];
    }
    let low = match variable {
        "velocity" => "velocity reversal",
        "displacement" => "middle of the travel",
        _ => "sign change",
    };
    let regions = [
        (low, centre - 0.1 * reach, centre + 0.1 * reach),
        ("large positive", centre + 0.5 * reach, centre + reach),
        ("large negative", centre - reach, centre - 0.5 * reach),
    ];
    regions
        .into_iter()
        .map(|(label, from, to)| {
            let inside = |v: f64| (from..=to).contains(&v);
            let hit: f64 = energy
                .iter()
                .zip(values)
                .filter(|(_, v)| inside(**v))
                .map(|(e, _)| e)
                .sum();
            let count = values.iter().filter(|v| inside(**v)).count();
            let label = if label == low {
                format!("{label} of {at}")
            } else {
                format!("{label} {variable} of {at}")
            };
            StateShare {
                label,
                variable,
                at: at.to_string(),
                from,
                to,
                share: (hit.max(0.0) / total).min(1.0),
                occupancy: count as f64 / values.len().max(1) as f64,
            }
        })
        .collect()
}
