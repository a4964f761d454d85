//! How well two traces agree, by the metrics that are in use.

use simgap_signal::metrics::{Grade, iso18571, nrmse, russell, sprague_geers};

use super::comparison::{Agreement, MagnitudePhase, Rating};
use super::pair::Trace;
use crate::structure::correlation;

/// Samples that ISO/TS 18571 is computed on at the most: its time warping costs 0.2 N².
const RATED: usize = 10_000;

/// All metrics of one channel; those that need a signal which is not there are `None`.
pub(super) fn agreement(trace: &Trace) -> Agreement {
    let (measured, simulated) = (&trace.measured, &trace.simulated);
    let off = || measured.iter().zip(simulated).map(|(m, s)| m - s);
    let count = measured.len().max(1) as f64;
    let rms = (off().map(|d| d * d).sum::<f64>() / count).sqrt();
    let nrmse = nrmse(measured, simulated).unwrap_or(0.0);
    let both = |magnitude, phase, comprehensive| MagnitudePhase {
        magnitude,
        phase,
        comprehensive,
    };
    let sprague_geers = sprague_geers(measured, simulated).ok();
    let russell = russell(measured, simulated).ok();
    Agreement {
        channel: trace.channel.clone(),
        simulated: trace.simulated_channel.clone(),
        unit: trace.unit.clone(),
        nrmse,
        r_squared: 1.0 - nrmse * nrmse,
        correlation: correlation(measured, simulated),
        rms,
        largest: off().map(f64::abs).fold(0.0, f64::max),
        sprague_geers: sprague_geers.map(|m| both(m.magnitude, m.phase, m.comprehensive)),
        russell: russell.map(|m| both(m.magnitude, m.phase, m.comprehensive)),
        iso18571: rating(measured, simulated),
    }
}

fn rating(measured: &[f64], simulated: &[f64]) -> Option<Rating> {
    let every = measured.len().div_ceil(RATED);
    let thin = |values: &[f64]| -> Vec<f64> { values.iter().step_by(every).copied().collect() };
    let rated = iso18571(&thin(measured), &thin(simulated)).ok()?;
    Some(Rating {
        corridor: rated.corridor,
        phase: rated.phase,
        magnitude: rated.magnitude,
        slope: rated.slope,
        total: rated.total,
        grade: match rated.grade() {
            Grade::Excellent => "excellent",
            Grade::Good => "good",
            Grade::Fair => "fair",
            Grade::Poor => "poor",
        },
        every,
    })
}
