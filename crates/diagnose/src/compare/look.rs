//! What a discrepancy looks like: constant, linear, harmonic, broadband, growing with the motion.
//!
//! ```text
//! d = measured − simulated, about its mean
//! linear share    Σ γ² S_dd / Σ S_dd,   γ² of d with the simulated trace, its bias taken out   (1)
//! harmonic share  Σ_{k ≥ 2} A_k²/2 / ms(d),   A_k of d at k times the main line                (2)
//! power p         rms(d) ~ rms(simulated)^p over stretches of the record                       (3)
//! ```
//!
//! (1) is the part of the discrepancy that some linear filter of the simulated trace explains: a
//! gain, a delay, a shifted resonance. Reference: \[BendatPiersol2010\], chapter 6.

use simgap_signal::correlation::autocorrelation;
use simgap_signal::frf::frf;
use simgap_signal::noise::white_noise_std;
use simgap_signal::orders::fit_harmonics;
use simgap_signal::peaks::{PeakOptions, find_peaks};
use simgap_signal::spectrum::spectrum;
use simgap_signal::welch::{WelchOptions, welch};
use simgap_signal::{Trend, Window};
use simgap_simulate::MemberPath;

use super::comparison::Look;
use super::pair::Trace;

/// Segments that the coherence of (1) is averaged over, before they overlap.
const SEGMENTS: usize = 12;
/// Harmonics of (2).
const HARMONICS: usize = 10;
/// A line carries the motion when it has more than this of its mean square.
const CARRIES: f64 = 0.5;
/// Stretches of (3), the fewest that can be used, and the span of amplitudes they need.
const STRETCHES: usize = 24;
const FEWEST_STRETCHES: usize = 8;
const SPAN: f64 = 2.0;
/// Squares of discrepancies this far above that of the noise are known to a tenth and better.
const CLEAR: f64 = 4.0;
/// A power is told where it explains this much of the scatter.
const TOLD: f64 = 0.6;
/// Shares from which something is worth a sentence.
const MOST: f64 = 0.8;
const MUCH: f64 = 0.2;
/// Leakage of lines takes a few percent off the linear share of what is linear.
const LEFT: f64 = 0.1;

/// The line that carries more than half of a signal, Hz.
pub(super) fn main_line(signal: &[f64], sample_rate_hz: f64) -> Option<f64> {
    let lines = spectrum(signal, sample_rate_hz, Window::Hann, Trend::Linear).ok()?;
    let peaks = find_peaks(&lines, &PeakOptions::default()).ok()?;
    let strongest = peaks
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))?;
    let power = 0.5 * strongest.amplitude * strongest.amplitude;
    (power > CARRIES * mean_square(&centred(signal))).then_some(strongest.freq_hz)
}

/// What the discrepancy of a trace looks like. `motion` is the measured one, where it is a motion.
pub(super) fn look(trace: &Trace, time_step_s: f64, motion: Option<&MemberPath>) -> Look {
    let rate = 1.0 / time_step_s;
    let pairs = trace.measured.iter().zip(&trace.simulated);
    let raw: Vec<f64> = pairs.map(|(m, s)| m - s).collect();
    let discrepancy = centred(&raw);
    let (all, about_mean) = (mean_square(&raw), mean_square(&discrepancy));
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let noise = white_noise_std(&discrepancy).map_or(0.0, |noise| noise.std);
    let main = main_line(&trace.measured, rate);
    let mut look = Look {
        channel: trace.channel.clone(),
        main_line_hz: main,
        constant_share: share(all - about_mean, all),
        linear_share: linear_share(&trace.simulated, &discrepancy, rate).unwrap_or(0.0),
        harmonic_share: main
            .and_then(|line| harmonic_power(&discrepancy, time_step_s, line))
            .map(|power| share(power, about_mean).min(1.0)),
        noise_share: share(noise * noise, about_mean).min(1.0),
        neighbour_correlation: autocorrelation(&discrepancy, 1)
            .ok()
            .and_then(|rho| rho.get(1).copied())
            .unwrap_or(0.0),
        amplitude_power: amplitude_power(
            &trace.simulated,
            &discrepancy,
            noise,
            main.map(|line| 1.0 / (line * time_step_s)),
        ),
        sentences: vec![],
    };
    look.sentences = sentences(&look);
    if let (Some(path), true) = (motion, about_mean > 0.0) {
        let place = format!("of the measured {}", trace.channel);
        let more = crate::structure::describe(&trace.channel, &discrepancy, path, &place, rate);
        look.sentences.extend(more);
    }
    look
}

/// (1).
fn linear_share(simulated: &[f64], discrepancy: &[f64], rate: f64) -> Option<f64> {
    let segment = (simulated.len() / SEGMENTS).max(16).min(simulated.len());
    let options = WelchOptions::new(segment);
    let filter = frf(simulated, discrepancy, rate, &options).ok()?;
    let density = welch(discrepancy, rate, &options).ok()?.density;
    // Of K averages, noise alone has a coherence of 1/K.
    let bias = 1.0 / filter.effective_averages.max(1.0);
    let unbiased = |c: f64| ((c - bias) / (1.0 - bias)).clamp(0.0, 1.0);
    let linear = filter.coherence.iter().zip(&density);
    let linear: f64 = linear.map(|(c, d)| unbiased(*c) * d).sum();
    let total: f64 = density.iter().sum();
    (total > 0.0 && bias < 1.0).then(|| linear / total)
}

/// The mean square of the lines of (2).
fn harmonic_power(discrepancy: &[f64], time_step_s: f64, line_hz: f64) -> Option<f64> {
    let count = HARMONICS.min((0.5 / time_step_s / line_hz) as usize);
    if count < 2 {
        return None;
    }
    let time_s: Vec<f64> = (0..discrepancy.len())
        .map(|i| i as f64 * time_step_s)
        .collect();
    let fit = fit_harmonics(&time_s, discrepancy, line_hz, count).ok()?;
    let squares = fit
        .lines
        .iter()
        .skip(1)
        .map(|l| 0.5 * l.amplitude * l.amplitude);
    Some(squares.sum())
}

/// (3), where the amplitude varies by [`SPAN`] and the power explains the scatter. Stretches are whole
/// periods of the main line, of `period` samples, where there is one.
fn amplitude_power(
    simulated: &[f64],
    discrepancy: &[f64],
    noise: f64,
    period: Option<f64>,
) -> Option<f64> {
    let least = simulated.len().div_ceil(STRETCHES).max(4) as f64;
    let whole = period.map_or(least, |period| (least / period).ceil() * period);
    let len = whole.round() as usize;
    let motion = centred(simulated);
    let stretches = motion.chunks_exact(len).zip(discrepancy.chunks_exact(len));
    let points: Vec<(f64, f64)> = stretches
        .filter_map(|(m, d)| {
            let (size, off) = (mean_square(m), mean_square(d) - noise * noise);
            // What drowns in noise says nothing of a power.
            (size > 0.0 && off > CLEAR * noise * noise).then(|| (0.5 * size.ln(), 0.5 * off.ln()))
        })
        .collect();
    let largest = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
    let smallest = points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    if points.len() < FEWEST_STRETCHES || largest - smallest < SPAN.ln() {
        return None;
    }
    let (sizes, offs): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    let (sizes, offs) = (centred(&sizes), centred(&offs));
    let product: f64 = sizes.iter().zip(&offs).map(|(a, b)| a * b).sum();
    let square: f64 = sizes.iter().map(|a| a * a).sum();
    let power = product / square;
    let left: f64 = sizes
        .iter()
        .zip(&offs)
        .map(|(a, b)| (b - power * a).powi(2))
        .sum();
    let scatter: f64 = offs.iter().map(|b| b * b).sum();
    // A flat line explains nothing of the scatter, and is an answer where there is little of it.
    let flat = scatter < 0.05 * square;
    (flat || left < (1.0 - TOLD) * scatter).then_some(power)
}

fn sentences(look: &Look) -> Vec<String> {
    let name = &look.channel;
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut said = Vec::new();
    if look.constant_share > MUCH {
        let share = percent(look.constant_share);
        said.push(format!(
            "{share} of the square of the discrepancy of {name} is a constant"
        ));
    }
    if look.noise_share > MOST {
        let share = percent(look.noise_share);
        said.push(format!(
            "{share} of the discrepancy of {name} about its mean is white noise"
        ));
        return said;
    }
    if look.linear_share > MOST {
        said.push(format!(
            "linear look: a linear filter of the simulated {name} explains {} of it (a gain, a delay \
             or another frequency response, of the plant or of the chain)",
            percent(look.linear_share)
        ));
    }
    let rest = 1.0 - look.linear_share - look.noise_share;
    if look.linear_share > MOST && rest > LEFT {
        said.push(format!(
            "the other {} is more than noise: a nonlinearity, or what does not come from the motion",
            percent(rest)
        ));
    }
    let line = look.main_line_hz.unwrap_or(0.0);
    match look.harmonic_share {
        Some(share) if share > MUCH => said.push(format!(
            "harmonic look: {} of it lies at multiples of the main line of {name}, {line:.4} Hz, as a \
             nonlinearity leaves them",
            percent(share)
        )),
        _ if look.linear_share < 1.0 - MOST => said.push(format!(
            "broadband look: no linear filter of the simulated {name} explains more than {} of it, \
             and no harmonics stand out",
            percent(look.linear_share)
        )),
        _ => {}
    }
    if let Some(power) = look.amplitude_power {
        let like = match power {
            p if p < 0.4 => "as noise, a tone or dry friction do",
            p if p < 1.5 => "as whatever is linear does",
            p if p < 2.5 => "as a quadratic law does",
            _ => "as a cubic law or an end of the range do",
        };
        said.push(format!(
            "where the simulated {name} is larger, it grows with the power {power:.1} of the amplitude, {like}"
        ));
    }
    said
}

pub(super) fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64
}
