//! What a discrepancy that no effect explains looks like, in words.

use simgap_signal::correlation::autocorrelation;
use simgap_signal::welch::{WelchOptions, welch};
use simgap_simulate::MemberPath;

/// A correlation of the discrepancy with the motion above this is worth a sentence.
const VISIBLE: f64 = 0.3;

/// Sentences on the discrepancy of one channel over the motion across one place ("of mold", "between mold and
/// ground").
pub(crate) fn describe(
    channel: &str,
    discrepancy: &[f64],
    path: &MemberPath,
    place: &str,
    sample_rate_hz: f64,
) -> Vec<String> {
    let mut sentences = Vec::new();
    let shapes: [(&str, Vec<f64>); 5] = [
        ("the displacement", path.displacement.clone()),
        ("the velocity", path.velocity.clone()),
        ("the acceleration", path.acceleration.clone()),
        (
            "the size of the displacement",
            path.displacement.iter().map(|d| d.abs()).collect(),
        ),
        (
            "the size of the velocity",
            path.velocity.iter().map(|v| v.abs()).collect(),
        ),
    ];
    for (name, shape) in &shapes {
        let correlation = correlation(discrepancy, shape);
        if correlation.abs() > VISIBLE {
            sentences.push(format!(
                "the discrepancy of {channel} follows {name} {place} (correlation {correlation:.2})"
            ));
        }
    }
    if let Some((freq_hz, share)) = dominant_line(discrepancy, sample_rate_hz) {
        sentences.push(format!(
            "{:.0} % of the discrepancy of {channel} lies within one bin of {freq_hz:.3} Hz",
            100.0 * share
        ));
    }
    if let Ok(rho) = autocorrelation(discrepancy, 1) {
        let one = rho.get(1).copied().unwrap_or(0.0);
        let colour = if one > 0.9 {
            "slow"
        } else if one < -0.5 {
            "alternating from sample to sample"
        } else if one.abs() < 0.1 {
            "white"
        } else {
            "coloured"
        };
        sentences.push(format!(
            "the discrepancy of {channel} is {colour} (correlation of neighbours {one:.2})"
        ));
    }
    sentences
}

/// Correlation coefficient; zero where one of the two does not vary.
pub(crate) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len()).max(1) as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / n;
    let (ma, mb) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        ab += (x - ma) * (y - mb);
        aa += (x - ma) * (x - ma);
        bb += (y - mb) * (y - mb);
    }
    if aa > 0.0 && bb > 0.0 {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}

/// The strongest line of a Welch spectrum and its share, when it holds a fifth of the power.
fn dominant_line(signal: &[f64], sample_rate_hz: f64) -> Option<(f64, f64)> {
    let psd = welch(signal, sample_rate_hz, &welch_options(signal.len())).ok()?;
    let total: f64 = psd.density.iter().sum();
    let (peak, _) = psd
        .density
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(b.1))?;
    let around = peak.saturating_sub(1)..(peak + 2).min(psd.density.len());
    let share = psd.density[around].iter().sum::<f64>() / total;
    (share > 0.2 && psd.freq_hz[peak] > 0.0).then(|| (psd.freq_hz[peak], share))
}

/// Hann segments of a quarter of the record, half overlapping.
pub(crate) fn welch_options(len: usize) -> WelchOptions {
    WelchOptions::new((len / 4).max(16).min(len))
}
