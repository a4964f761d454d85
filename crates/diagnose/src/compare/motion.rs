//! The motion that a measured trace shows, for the states in which a discrepancy gathers.

use simgap_record::UnitKind;
use simgap_simulate::MemberPath;

use super::look::main_line;
use super::pair::Trace;
use crate::diagnosis::StateShare;
use crate::locate::regions;

/// A slope is taken over this part of a period of the main line on each side.
const REACH: f64 = 1.0 / 24.0;
/// Where no line carries the motion, over so many samples on each side.
const FEW: usize = 3;

/// Slope of the straight line through 2 m + 1 samples, which averages noise and follows the motion.
///
/// ```text
/// ẏ_n = Σ_{k=−m}^{m} k y_{n+k} / (Δt Σ k²)
/// ```
///
/// At the ends the line goes through what is there.
fn slope(values: &[f64], reach: usize, time_step_s: f64) -> Vec<f64> {
    (0..values.len())
        .map(|n| {
            let from = n.saturating_sub(reach);
            let part = &values[from..(n + reach + 1).min(values.len())];
            let middle = 0.5 * (part.len() as f64 - 1.0);
            let (mut product, mut square) = (0.0, 0.0);
            for (k, value) in part.iter().enumerate() {
                let k = k as f64 - middle;
                product += k * (value - values[n]);
                square += k * k;
            }
            if square > 0.0 {
                product / (square * time_step_s)
            } else {
                0.0
            }
        })
        .collect()
}

/// Samples on each side that a slope is taken over.
fn reach(values: &[f64], time_step_s: f64) -> usize {
    let line = main_line(values, 1.0 / time_step_s);
    let samples = line.map(|line| REACH / (line * time_step_s));
    samples.map_or(FEW, |samples| (samples as usize).clamp(1, 50))
}

/// The measured motion of a displacement.
pub(super) fn motion(trace: &Trace, time_step_s: f64) -> Option<MemberPath> {
    if !matches!(trace.kind, UnitKind::Length | UnitKind::Angle) {
        return None;
    }
    let reach = reach(&trace.measured, time_step_s);
    let velocity = slope(&trace.measured, reach, time_step_s);
    let acceleration = slope(&velocity, reach, time_step_s);
    Some(MemberPath {
        displacement: trace.measured.clone(),
        velocity,
        acceleration,
    })
}

/// Where in the motion of one trace the squared discrepancy of all gathers.
pub(super) fn states(
    trace: &Trace,
    motion: Option<&MemberPath>,
    energy: &[f64],
) -> Vec<StateShare> {
    let name = &trace.channel;
    if let Some(path) = motion {
        let mut list = regions(energy, "velocity", &path.velocity, name);
        list.extend(regions(energy, "displacement", &path.displacement, name));
        return list;
    }
    let variable = match trace.kind {
        UnitKind::Velocity | UnitKind::AngularVelocity => "velocity",
        UnitKind::Acceleration | UnitKind::AngularAcceleration => "acceleration",
        UnitKind::Force | UnitKind::Torque => "force",
        _ => "value",
    };
    regions(energy, variable, &trace.measured, name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_slopes_are_exact_on_straight_lines_and_near_on_sines() {
        let line: Vec<f64> = (0..40).map(|i| 3.0 - 0.5 * f64::from(i)).collect();
        assert!(slope(&line, 4, 0.1).iter().all(|v| (v + 5.0).abs() < 1e-12));
        // Σ k⁴ / (6 Σ k²) over ± m: the slope of a sine of phase w is too small by so much of w².
        let (m, w) = (4, 0.05);
        let sine: Vec<f64> = (0..400).map(|i| (w * f64::from(i)).sin()).collect();
        let found = slope(&sine, m, 1.0);
        let k = m as f64;
        let bound = (3.0 * k * k + 3.0 * k - 1.0) / 30.0 * w * w;
        for (i, v) in found.iter().enumerate().skip(m).take(400 - 2 * m) {
            let truth = w * (w * i as f64).cos();
            assert!((v - truth).abs() < bound * w, "{i}: {v} {truth}");
        }
    }
}
