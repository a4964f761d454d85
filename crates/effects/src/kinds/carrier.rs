//! Frequencies at which a carrier may swing what is in proportion to the motion.

use crate::effect::SiteScale;

/// A motion at one frequency times a carrier at another leaves lines at their sum and difference: the lines that
/// are left, and these with the two strongest of the motion added and taken away, Hz. A motion of many frequencies leaves
/// no line; what is left times the motion has one at the carrier. None is nearer to another than half of what a record
/// resolves, and none is at half the sample rate or above.
pub(super) fn carriers_hz(scale: &SiteScale) -> Vec<f64> {
    let nyquist = 0.5 / scale.time_step_s;
    let resolution = 1.0 / scale.duration_s;
    let lines = scale.lines_hz.into_iter().filter(|line| *line > 0.0);
    let of_lines = lines.flat_map(|line| {
        let motions = scale.motion_hz.into_iter().take(2).filter(|m| *m > 0.0);
        let sums = motions.flat_map(move |motion| [line + motion, (line - motion).abs()]);
        std::iter::once(line).chain(sums)
    });
    let mut found: Vec<f64> = vec![];
    for freq in scale.carriers_hz.into_iter().chain(of_lines) {
        let known = found.iter().any(|f| (f - freq).abs() < 0.5 * resolution);
        if !known && freq > resolution && freq < nyquist {
            found.push(freq);
        }
    }
    found
}
