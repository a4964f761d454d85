//! Faults of the measurement chain by size.

use crate::rng::Rng;
use crate::size::{Scale, Template};

/// Draws the shape of a fault and leaves its size open.
pub(crate) fn template(kind: &'static str, scale: &Scale, rng: &mut Rng) -> Template {
    let s = *scale;
    let sign = rng.sign();
    let late = s.rms / s.rate;
    let even = *rng.pick(&[0.0, 0.5, 1.0]);
    match kind {
        "sensor_bias" => Box::new(move |z| vec![("bias", sign * z * s.rms)]),
        "sensor_gain" => Box::new(move |z| vec![("gain_factor", gain(sign, z))]),
        "sensor_drift" => {
            Box::new(move |z| vec![("drift_rate_per_s", sign * 3.4 * z * s.rms / s.duration_s)])
        }
        "sensor_delay" => Box::new(move |z| vec![("delay_s", z * late)]),
        "sensor_lag" => Box::new(move |z| vec![("time_constant_s", z * late)]),
        "alternating_timing" => {
            Box::new(move |z| vec![("timing_s", sign * z * late), ("even_share", even)])
        }
        "alternating_gain" => {
            Box::new(move |z| vec![("gain_difference", sign * z.min(0.9)), ("even_share", even)])
        }
        "clock_skew" => Box::new(move |z| {
            let skew = 1.7 * z * late / s.duration_s;
            vec![("skew", sign * skew.min(0.04))]
        }),
        _ => by_samples(kind, s, rng),
    }
}

fn gain(sign: f64, z: f64) -> f64 {
    if sign > 0.0 { 1.0 + z } else { 1.0 / (1.0 + z) }
}

fn by_samples(kind: &'static str, s: Scale, rng: &mut Rng) -> Template {
    let (upper, lower) = *rng.pick(&[(true, true), (true, false), (false, true)]);
    match kind {
        "clipping" => {
            let after = f64::from(u8::from(rng.chance(0.4)));
            Box::new(move |z| {
                let middle = 0.5 * (s.range.0 + s.range.1);
                let inside = 1.0 - z.min(0.9);
                let mut values = vec![("noise_after", after)];
                if upper {
                    values.push(("upper_level", middle + (s.range.1 - middle) * inside));
                }
                if lower {
                    values.push(("lower_level", middle + (s.range.0 - middle) * inside));
                }
                values
            })
        }
        "quantisation" => {
            let level = *rng.pick(&[0.0, 0.5]);
            Box::new(move |z| {
                let step = 3.46 * z * s.rms;
                vec![("step", step), ("level", level * step)]
            })
        }
        "tone_pickup" => {
            let half = 0.5 / s.step_s;
            let frequency = match rng.chance(0.35) {
                true => *rng.pick(&[50.0, 60.0, 100.0]),
                false => rng.log_uniform(0.7 * s.band_hz.0, 0.9 * half),
            };
            Box::new(move |z| vec![("amplitude", 1.41 * z * s.rms), ("frequency_hz", frequency)])
        }
        "dropouts" => {
            let longest = rng.whole(1, 6) as f64;
            let zero = f64::from(u8::from(rng.chance(0.4)));
            Box::new(move |z| {
                vec![
                    ("share", (0.3 * z * z).clamp(0.001, 0.08)),
                    ("longest", longest),
                    ("zero", zero),
                ]
            })
        }
        _ => {
            let share = rng.log_uniform(0.001, 0.008);
            Box::new(move |z| vec![("share", share), ("size", z * s.rms / share.sqrt())])
        }
    }
}
