//! Are the time stamps off their grid, and is rounding the reason?

use super::finding::Defect;
use crate::time_base::grid_deviations;

/// Largest deviation that is not worth telling, steps.
const UNTOLD_STEPS: f64 = 0.02;
/// Decimals of a second looked at.
const MOST_DECIMALS: i32 = 9;
/// A stamp is taken as rounded when it is this close to a whole number of units.
const WHOLE: f64 = 1e-4;
/// Rounding moves a stamp by half a unit; the fitted grid may move by a little more.
const ROUNDING_UNITS: f64 = 0.55;

/// The defect, if any.
pub(super) fn jitter(time_s: &[f64], time_step_s: f64) -> Option<Defect> {
    let (mut square, mut worst_steps) = (0.0, 0.0_f64);
    for deviation in grid_deviations(time_s, time_step_s) {
        square += deviation * deviation;
        worst_steps = worst_steps.max(deviation.abs());
    }
    if worst_steps <= UNTOLD_STEPS {
        return None;
    }
    let rounded = |unit: f64| {
        let whole = |t: &f64| (t / unit - (t / unit).round()).abs() < WHOLE;
        worst_steps * time_step_s <= ROUNDING_UNITS * unit && time_s.iter().all(whole)
    };
    let rounded_to_s = (0..=MOST_DECIMALS)
        .map(|decimals| 1.0 / 10f64.powi(decimals))
        .find(|&unit| rounded(unit));
    let rms_steps = (square / time_s.len() as f64).sqrt();
    Some(Defect::TimeJitter {
        rms_steps,
        worst_steps,
        rounded_to_s,
    })
}
