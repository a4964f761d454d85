//! The kinds that are drawn: where they can sit, and values of a size.

use std::f64::consts::PI;

use crate::plant::{Node, Place, Plant};
use crate::rng::Rng;
pub use crate::size::{Scale, Template, Values};

/// Kinds of the catalogue but for the nominal parameters.
pub const EFFECTS: [&str; 34] = [
    "viscous_damping",
    "linear_stiffness",
    "coulomb_friction",
    "stribeck_friction",
    "presliding_friction",
    "quadratic_damping",
    "asymmetric_damping",
    "cubic_stiffness",
    "quadratic_stiffness",
    "backlash",
    "end_stop",
    "bilinear_stiffness",
    "hysteresis",
    "constant_force",
    "harmonic_force",
    "position_periodic_force",
    "time_varying_stiffness",
    "attached_mode",
    "flexible_support",
    "input_lag",
    "input_delay",
    "sensor_bias",
    "sensor_gain",
    "sensor_drift",
    "sensor_delay",
    "sensor_lag",
    "clipping",
    "quantisation",
    "alternating_timing",
    "alternating_gain",
    "tone_pickup",
    "dropouts",
    "outliers",
    "clock_skew",
];

/// Nominal parameters.
pub const PARAMETERS: [&str; 4] = [
    "mass_error",
    "stiffness_error",
    "damping_error",
    "input_gain",
];

/// Laws that the catalogue lacks.
pub const FOREIGN: [&str; 8] = [
    "foreign_cubic_damping",
    "foreign_power_spring",
    "foreign_root_damping",
    "foreign_place_damping",
    "foreign_play_slider",
    "foreign_varying_delay",
    "foreign_fading_gain",
    "foreign_sensor_curve",
];

/// Kinds of which a pair holds one at the most: they stand in for each other.
#[must_use]
pub fn group(kind: &str) -> &'static str {
    match kind {
        "constant_force" | "sensor_bias" | "sensor_drift" => "constant",
        "harmonic_force" | "tone_pickup" => "tone",
        "input_lag" | "input_delay" | "sensor_delay" | "sensor_lag" | "clock_skew" => "late",
        "coulomb_friction" | "stribeck_friction" | "presliding_friction" | "hysteresis" => "dry",
        "clipping"
        | "end_stop"
        | "bilinear_stiffness"
        | "backlash"
        | "quadratic_stiffness"
        | "cubic_stiffness" => "spring",
        "dropouts" | "outliers" | "quantisation" => "samples",
        "viscous_damping" | "quadratic_damping" | "asymmetric_damping" => "damping",
        "alternating_timing" | "alternating_gain" => "alternating",
        "attached_mode" | "flexible_support" => "mode",
        "linear_stiffness" => "linear",
        "sensor_gain" => "gain",
        _ => "other",
    }
}

/// Where a kind can sit in a plant.
#[must_use]
pub fn sites(plant: &Plant, kind: &str) -> Vec<Place> {
    let masses = plant.masses.len();
    let grounded = || (0..masses).map(|i| (Node::Mass(i), Node::Ground));
    let members = plant.member_pairs();
    let mut any = members.clone();
    for pair in grounded() {
        if !members.iter().any(|m| crate::plant::same_pair(*m, pair)) {
            any.push(pair);
        }
    }
    let between = |pairs: Vec<(Node, Node)>| {
        let to_place = |(a, b)| Place::Between(a, b);
        pairs.into_iter().map(to_place).collect()
    };
    let keep = |list: Vec<(Node, Node)>, f: &dyn Fn(Node, Node) -> bool| {
        list.into_iter().filter(|p| f(p.0, p.1)).collect()
    };
    match kind {
        "viscous_damping" => between(keep(any, &|a, b| !plant.has_damper(a, b))),
        "linear_stiffness" => between(keep(any, &|a, b| !plant.has_spring(a, b))),
        "stiffness_error" | "backlash" | "bilinear_stiffness" | "time_varying_stiffness" => {
            between(keep(members, &|a, b| plant.has_spring(a, b)))
        }
        "damping_error" => between(keep(members, &|a, b| plant.has_damper(a, b))),
        "flexible_support" => between(keep(members, &|a, b| {
            plant.has_spring(a, b) && matches!((a, b), (Node::Mass(_), Node::Ground))
        })),
        "mass_error" | "constant_force" | "harmonic_force" | "attached_mode" => {
            (0..masses).map(Place::Mass).collect()
        }
        "input_lag" | "input_delay" | "foreign_varying_delay" if plant.control.is_some() => vec![],
        "foreign_fading_gain" => {
            let forced = |i: &usize| matches!(plant.inputs[*i].at, Node::Mass(_));
            let inputs = (0..plant.inputs.len()).filter(forced);
            inputs.map(Place::Input).collect()
        }
        "input_gain" | "input_lag" | "input_delay" | "foreign_varying_delay" => {
            (0..plant.inputs.len()).map(Place::Input).collect()
        }
        _ if at_channel(kind) => (0..plant.outputs.len()).map(Place::Channel).collect(),
        _ => between(any),
    }
}

/// Whether a kind sits in the path of an output.
#[must_use]
pub fn at_channel(kind: &str) -> bool {
    let chain = EFFECTS.iter().skip_while(|k| **k != "sensor_bias");
    chain.clone().any(|k| *k == kind)
        || matches!(kind, "foreign_sensor_curve" | "sensor_not_connected")
}

/// Draws the shape of an effect and leaves its size open.
#[must_use]
pub fn template(kind: &'static str, scale: &Scale, rng: &mut Rng) -> Template {
    match kind {
        _ if kind.starts_with("foreign_") => crate::foreign::template(kind, scale, rng),
        _ if at_channel(kind) => crate::faults::template(kind, scale, rng),
        "attached_mode" | "flexible_support" | "constant_force" | "harmonic_force"
        | "input_lag" | "input_delay" => at_mass(kind, *scale, rng),
        _ => member_law(kind, *scale, rng),
    }
}

fn at_mass(kind: &'static str, s: Scale, rng: &mut Rng) -> Template {
    let sign = rng.sign();
    let frequency = rng.log_uniform(s.band_hz.0, s.band_hz.1);
    let ratio = rng.log_uniform(0.01, 0.1);
    let share = rng.uniform(0.1, 0.8);
    match kind {
        "constant_force" => Box::new(move |z| vec![("force_n", sign * z * s.force)]),
        "harmonic_force" => {
            Box::new(move |z| vec![("amplitude_n", z * s.force), ("frequency_hz", frequency)])
        }
        "attached_mode" => Box::new(move |z| {
            vec![
                ("attached_mass_kg", z.min(2.0) * s.mass),
                ("natural_freq_hz", frequency),
                ("damping_ratio", ratio),
            ]
        }),
        "flexible_support" => Box::new(move |z| {
            vec![
                ("support_stiffness_n_per_m", s.stiffness / z.max(1e-3)),
                ("support_mass_kg", share * s.mass),
                ("support_damping_ratio", 2.0 * ratio),
            ]
        }),
        "input_lag" => Box::new(move |z| vec![("time_constant_s", z * s.rms / s.rate)]),
        _ => Box::new(move |z| vec![("delay_s", z * s.rms / s.rate)]),
    }
}

fn member_law(kind: &'static str, s: Scale, rng: &mut Rng) -> Template {
    let per_d = s.force / s.rms;
    let per_v = s.force / s.rate;
    let late = s.rms / s.rate;
    match kind {
        "viscous_damping" => Box::new(move |z| vec![("damping_n_s_per_m", z * per_v)]),
        "linear_stiffness" => Box::new(move |z| vec![("stiffness_n_per_m", z * per_d)]),
        "coulomb_friction" => Box::new(move |z| vec![("friction_force_n", z * s.force)]),
        "quadratic_damping" => {
            Box::new(move |z| vec![("quadratic_damping_n_s2_per_m2", z * per_v / s.rate)])
        }
        "stribeck_friction" => {
            let (more, speed) = (rng.uniform(1.4, 2.5), rng.uniform(0.15, 0.6) * s.rate);
            Box::new(move |z| {
                vec![
                    ("friction_force_n", z * s.force),
                    ("breakaway_force_n", more * z * s.force),
                    ("stribeck_velocity_m_per_s", speed),
                ]
            })
        }
        "presliding_friction" => {
            let dp = rng.log_uniform(0.05, 0.5) * s.rms;
            let tau = if rng.chance(0.5) {
                rng.uniform(0.05, 0.3) * late
            } else {
                0.0
            };
            Box::new(move |z| {
                vec![
                    ("friction_force_n", z * s.force),
                    ("presliding_displacement_m", dp),
                    ("damping_time_s", tau),
                ]
            })
        }
        "asymmetric_damping" => {
            let other = *rng.pick(&[0.0, -0.4, 0.35]);
            let forward = rng.chance(0.5);
            Box::new(move |z| {
                let (f, b) = if forward { (1.0, other) } else { (other, 1.0) };
                vec![
                    ("damping_forward_n_s_per_m", f * z * per_v),
                    ("damping_backward_n_s_per_m", b * z * per_v),
                ]
            })
        }
        "hysteresis" => {
            let (uy, beta) = (rng.uniform(0.2, 0.8) * s.rms, rng.uniform(0.3, 0.85));
            let n = *rng.pick(&[1.0, 2.0, 2.0, 3.0]);
            Box::new(move |z| {
                vec![
                    ("hysteretic_stiffness_n_per_m", z * per_d),
                    ("yield_displacement_m", uy),
                    ("loop_share", beta),
                    ("exponent", n),
                ]
            })
        }
        "position_periodic_force" => {
            let (sin, cos) = (2.0 * PI * rng.unit()).sin_cos();
            let period = (s.range.1 - s.range.0) / rng.uniform(2.0, 10.0);
            Box::new(move |z| {
                vec![
                    ("sine_n", z * s.force * sin),
                    ("cosine_n", z * s.force * cos),
                    ("period_m", period),
                ]
            })
        }
        _ => spring_law(kind, s, rng),
    }
}

fn spring_law(kind: &'static str, s: Scale, rng: &mut Rng) -> Template {
    let per_d = s.force / s.rms;
    let sign = if rng.chance(0.7) { 1.0 } else { -1.0 };
    let (upper, lower) = *rng.pick(&[(true, true), (true, false), (false, true)]);
    match kind {
        "cubic_stiffness" => Box::new(move |z| {
            vec![(
                "cubic_stiffness_n_per_m3",
                sign * z * per_d / (s.rms * s.rms),
            )]
        }),
        "quadratic_stiffness" => {
            Box::new(move |z| vec![("quadratic_stiffness_n_per_m2", sign * z * per_d / s.rms)])
        }
        "backlash" => Box::new(move |z| vec![("gap_m", z * s.rms)]),
        "time_varying_stiffness" => {
            let frequency = rng.log_uniform(0.3 * s.band_hz.0, s.band_hz.1);
            Box::new(move |z| {
                vec![
                    ("stiffness_amplitude_n_per_m", z.min(0.95) * s.stiffness),
                    ("frequency_hz", frequency),
                ]
            })
        }
        "end_stop" => {
            let stiff = rng.log_uniform(2.0, 20.0) * per_d;
            let tau = if rng.chance(0.5) {
                rng.uniform(0.05, 0.3) * s.rms / s.rate
            } else {
                0.0
            };
            Box::new(move |z| {
                let inside = 1.0 - z.min(0.9);
                let mut values = vec![
                    ("contact_stiffness_n_per_m", stiff),
                    ("contact_damping_time_s", tau),
                ];
                if upper {
                    values.push(("upper_stop_m", (s.range.1 * inside).max(0.0)));
                }
                if lower {
                    values.push(("lower_stop_m", (-s.range.0 * inside).max(0.0)));
                }
                values
            })
        }
        _ => {
            let at = [0.0, rng.uniform(0.1, 0.8)][rng.below(2)] * s.rms;
            let beyond = rng.uniform(0.3, 0.9) * s.rms;
            Box::new(move |z| {
                let mut values = vec![("stiffness_change_n_per_m", sign * z * per_d)];
                if upper {
                    values.push(("upper_change_m", at));
                }
                if lower {
                    values.push(("lower_change_m", if upper { beyond } else { at }));
                }
                values
            })
        }
    }
}
