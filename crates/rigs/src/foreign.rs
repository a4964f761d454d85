//! Laws that the catalogue lacks, by size.

use crate::rng::Rng;
use crate::size::{Scale, Template};

/// Draws the shape of a law and leaves its size open.
pub(crate) fn template(kind: &'static str, scale: &Scale, rng: &mut Rng) -> Template {
    let s = *scale;
    let per_d = s.force / s.rms;
    match kind {
        "foreign_cubic_damping" => {
            Box::new(move |z| vec![("coefficient", z * s.force / s.rate.powi(3))])
        }
        "foreign_power_spring" => {
            let power = *rng.pick(&[0.4, 0.5, 0.6, 1.5, 1.7]);
            Box::new(move |z| {
                vec![
                    ("coefficient", z * s.force / s.rms.powf(power)),
                    ("power", power),
                ]
            })
        }
        "foreign_root_damping" => Box::new(move |z| {
            vec![
                ("coefficient", z * s.force / s.rate.sqrt()),
                ("small_speed", 0.002 * s.rate),
            ]
        }),
        "foreign_place_damping" => {
            Box::new(move |z| vec![("coefficient", z * s.force / (s.rate * s.rms * s.rms))])
        }
        "foreign_play_slider" => {
            let (stiff, gap) = (rng.uniform(1.0, 4.0) * per_d, rng.uniform(0.5, 1.5) * s.rms);
            Box::new(move |z| {
                vec![
                    ("friction", z * s.force),
                    ("stiffness", stiff),
                    ("gap", gap),
                ]
            })
        }
        "foreign_varying_delay" => {
            let frequency = rng.log_uniform(0.05, 0.4) * s.band_hz.0;
            Box::new(move |z| {
                let delay = z * s.rms / s.rate;
                vec![
                    ("delay_s", delay),
                    ("swing_s", 0.9 * delay),
                    ("frequency_hz", frequency),
                ]
            })
        }
        "foreign_fading_gain" => Box::new(move |z| vec![("speed", s.rate / z.sqrt())]),
        _ => Box::new(move |z| vec![("coefficient", z / s.rms)]),
    }
}
