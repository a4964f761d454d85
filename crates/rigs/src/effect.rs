//! Effects with their values, and the machine that has them.

use crate::chain::Chain;
use crate::law::Law;
use crate::machine::{Dry, LawAt, Machine};
use crate::plant::{Node, Place, Plant, Quantity, same_pair};

/// The slip of an input that was recorded with the other sign: the machine itself has no effect.
pub(crate) const FLIPPED: &str = "slip_sign_input";

/// An effect at its place.
#[derive(Debug, Clone)]
pub struct Effect {
    /// Kind of the catalogue, or the name of a foreign law.
    pub kind: &'static str,
    /// Where it sits.
    pub at: Place,
    /// Values by name, SI.
    pub values: Vec<(&'static str, f64)>,
    /// Phase of each record, where the effect has a clock of its own.
    pub phases: Vec<f64>,
}

impl Effect {
    /// The value of a parameter; zero where it has none.
    #[must_use]
    pub fn get(&self, name: &str) -> f64 {
        self.given(name).unwrap_or(0.0)
    }

    fn given(&self, name: &str) -> Option<f64> {
        let found = self.values.iter().find(|(n, _)| *n == name);
        found.map(|(_, value)| *value)
    }

    fn limit(&self, name: &str) -> f64 {
        self.given(name).unwrap_or(f64::INFINITY)
    }

    fn phase(&self, record: usize) -> f64 {
        self.phases.get(record).copied().unwrap_or(0.0)
    }
}

/// What becomes of an input on its way to the plant.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// Factor.
    pub gain: f64,
    /// s; zero for none.
    pub lag_s: f64,
    /// s.
    pub delay_s: f64,
    /// Foreign: the delay swings by this share at this frequency.
    pub swing: (f64, f64),
}

/// The machine in one record, the paths of its inputs and the chains of its sensors.
#[derive(Debug, Clone)]
pub struct Assembly {
    /// Equations of motion.
    pub machine: Machine,
    /// Per input.
    pub paths: Vec<Path>,
    /// Per output.
    pub chains: Vec<Chain>,
}

/// The plant without effects.
#[must_use]
pub fn bare(plant: &Plant) -> Assembly {
    let members =
        |list: &[crate::plant::Member]| list.iter().map(|m| (m.a, m.b, m.value)).collect();
    let path = Path {
        gain: 1.0,
        lag_s: 0.0,
        delay_s: 0.0,
        swing: (0.0, 0.0),
    };
    Assembly {
        machine: Machine {
            masses: plant.masses.clone(),
            springs: members(&plant.springs),
            dampers: members(&plant.dampers),
            pendulum: plant.pendulum.clone(),
            input_at: plant.inputs.iter().map(|i| i.at).collect(),
            gains: vec![1.0; plant.inputs.len()],
            control: plant.control,
            outputs: plant.outputs.clone(),
            ..Machine::default()
        },
        paths: vec![path; plant.inputs.len()],
        chains: vec![Chain::default(); plant.outputs.len()],
    }
}

/// The plant with effects, as it is in a record.
#[must_use]
pub fn assemble(plant: &Plant, effects: &[Effect], record: usize) -> Assembly {
    let mut whole = bare(plant);
    // A support takes along what sits at its place, so it comes last.
    let late = |e: &&Effect| e.kind == "flexible_support";
    for effect in effects.iter().filter(|e| !late(e)) {
        add(&mut whole, plant, effect, record);
    }
    for effect in effects.iter().filter(late) {
        add_support(&mut whole.machine, effect);
    }
    whole
}

fn add(whole: &mut Assembly, plant: &Plant, effect: &Effect, record: usize) {
    match effect.at {
        Place::Between(a, b) => add_between(&mut whole.machine, plant, effect, (a, b), record),
        Place::Mass(mass) => add_at_mass(&mut whole.machine, effect, mass, record),
        Place::Input(i) => add_at_input(whole, effect, i),
        Place::Channel(i) => add_at_channel(&mut whole.chains[i], effect, record),
    }
}

fn law_of(plant: &Plant, e: &Effect, (a, b): (Node, Node), record: usize) -> Option<Law> {
    Some(match e.kind {
        "quadratic_damping" => Law::QuadraticDamping(e.get("quadratic_damping_n_s2_per_m2")),
        "cubic_stiffness" => Law::CubicStiffness(e.get("cubic_stiffness_n_per_m3")),
        "quadratic_stiffness" => Law::QuadraticStiffness(e.get("quadratic_stiffness_n_per_m2")),
        "asymmetric_damping" => Law::AsymmetricDamping(
            e.get("damping_forward_n_s_per_m"),
            e.get("damping_backward_n_s_per_m"),
        ),
        "backlash" => Law::Backlash(plant.stiffness(a, b), e.get("gap_m")),
        "bilinear_stiffness" => Law::Bilinear(
            e.get("stiffness_change_n_per_m"),
            e.limit("upper_change_m"),
            e.limit("lower_change_m"),
        ),
        "end_stop" => Law::EndStop(
            e.limit("upper_stop_m"),
            e.limit("lower_stop_m"),
            e.get("contact_stiffness_n_per_m"),
            e.get("contact_damping_time_s"),
        ),
        "position_periodic_force" => {
            Law::Periodic(e.get("sine_n"), e.get("cosine_n"), e.get("period_m"))
        }
        "time_varying_stiffness" => Law::VaryingStiffness(
            e.get("stiffness_amplitude_n_per_m"),
            e.get("frequency_hz"),
            e.phase(record),
        ),
        "hysteresis" => Law::Hysteresis(
            e.get("hysteretic_stiffness_n_per_m"),
            e.get("yield_displacement_m"),
            e.get("loop_share"),
            e.get("exponent"),
        ),
        "presliding_friction" => Law::Presliding(
            e.get("friction_force_n"),
            e.get("presliding_displacement_m"),
            e.get("damping_time_s"),
        ),
        "foreign_cubic_damping" => Law::CubicDamping(e.get("coefficient")),
        "foreign_power_spring" => Law::PowerSpring(e.get("coefficient"), e.get("power")),
        "foreign_root_damping" => Law::RootDamping(e.get("coefficient"), e.get("small_speed")),
        "foreign_place_damping" => Law::PlaceDamping(e.get("coefficient")),
        "foreign_play_slider" => {
            Law::PlaySlider(e.get("friction"), e.get("stiffness"), e.get("gap"))
        }
        _ => return None,
    })
}

fn add_between(
    machine: &mut Machine,
    plant: &Plant,
    e: &Effect,
    (a, b): (Node, Node),
    record: usize,
) {
    match e.kind {
        "viscous_damping" => machine.dampers.push((a, b, e.get("damping_n_s_per_m"))),
        "linear_stiffness" => machine.springs.push((a, b, e.get("stiffness_n_per_m"))),
        "coulomb_friction" | "stribeck_friction" => {
            let sliding = e.get("friction_force_n");
            let rest = e.get("breakaway_force_n").max(sliding);
            let speed = e.get("stribeck_velocity_m_per_s").max(1e-12);
            machine.dry = Some(Dry {
                a,
                b,
                sliding,
                rest,
                speed,
            });
        }
        _ => {
            if let Some(law) = law_of(plant, e, (a, b), record) {
                machine.laws.push(LawAt { a, b, law });
            }
        }
    }
}

fn add_at_mass(machine: &mut Machine, e: &Effect, mass: usize, record: usize) {
    match e.kind {
        "constant_force" => machine.constant.push((mass, e.get("force_n"))),
        "harmonic_force" => machine.tones.push((
            mass,
            e.get("amplitude_n"),
            e.get("frequency_hz"),
            e.phase(record),
        )),
        "attached_mode" => {
            let m = e.get("attached_mass_kg");
            let w = 2.0 * std::f64::consts::PI * e.get("natural_freq_hz");
            let hidden = Node::Mass(machine.masses.len());
            machine.masses.push(m);
            machine.springs.push((hidden, Node::Mass(mass), m * w * w));
            let c = 2.0 * e.get("damping_ratio") * m * w;
            machine.dampers.push((hidden, Node::Mass(mass), c));
        }
        _ => {}
    }
}

fn add_support(machine: &mut Machine, e: &Effect) {
    let Place::Between(a, b) = e.at else {
        return;
    };
    let support = Node::Mass(machine.masses.len());
    let moved = |x: &mut Node, y: &mut Node| {
        if same_pair((*x, *y), (a, b)) {
            if *x == Node::Ground {
                *x = support;
            } else {
                *y = support;
            }
        }
    };
    let members = machine.springs.iter_mut().chain(&mut machine.dampers);
    members.for_each(|(x, y, _)| moved(x, y));
    machine
        .laws
        .iter_mut()
        .for_each(|law| moved(&mut law.a, &mut law.b));
    if let Some(dry) = &mut machine.dry {
        moved(&mut dry.a, &mut dry.b);
    }
    for output in &mut machine.outputs {
        if output.quantity == Quantity::Force {
            moved(&mut output.a, &mut output.b);
        }
    }
    let (m, k) = (e.get("support_mass_kg"), e.get("support_stiffness_n_per_m"));
    machine.masses.push(m);
    machine.springs.push((support, Node::Ground, k));
    let c = 2.0 * e.get("support_damping_ratio") * (k * m).sqrt();
    machine.dampers.push((support, Node::Ground, c));
}

fn add_at_input(whole: &mut Assembly, e: &Effect, i: usize) {
    let path = &mut whole.paths[i];
    match e.kind {
        "input_gain" => path.gain *= e.get("gain_factor"),
        "input_lag" => path.lag_s = e.get("time_constant_s"),
        "input_delay" => path.delay_s = e.get("delay_s"),
        "foreign_varying_delay" => {
            path.delay_s = e.get("delay_s");
            path.swing = (e.get("swing_s"), e.get("frequency_hz"));
        }
        "foreign_fading_gain" => whole.machine.fading = Some(e.get("speed")),
        _ => {}
    }
}

fn add_at_channel(chain: &mut Chain, e: &Effect, record: usize) {
    match e.kind {
        "sensor_bias" => chain.bias = e.get("bias"),
        "sensor_gain" => chain.gain = Some(e.get("gain_factor")),
        "sensor_drift" => chain.drift = e.get("drift_rate_per_s"),
        "sensor_delay" => chain.delay_s = e.get("delay_s"),
        "sensor_lag" => chain.lag_s = Some(e.get("time_constant_s")),
        "clipping" => {
            let low = e.given("lower_level").unwrap_or(f64::NEG_INFINITY);
            chain.clip = Some((low, e.limit("upper_level"), e.get("noise_after") > 0.5));
        }
        "quantisation" => chain.steps = Some((e.get("step"), e.get("level"))),
        "alternating_timing" => {
            chain.alternating_timing = Some((e.get("timing_s"), e.get("even_share")));
        }
        "alternating_gain" => {
            chain.alternating_gain = Some((e.get("gain_difference"), e.get("even_share")));
        }
        "tone_pickup" => {
            let tone = (e.get("amplitude"), e.get("frequency_hz"), e.phase(record));
            chain.tones.push(tone);
        }
        "dropouts" => {
            let longest = e.get("longest") as usize;
            chain.losses = Some((e.get("share"), longest, e.get("zero") > 0.5));
        }
        "outliers" => chain.spikes = Some((e.get("share"), e.get("size"))),
        "clock_skew" => chain.skew = e.get("skew"),
        "foreign_sensor_curve" => chain.curve = Some(e.get("coefficient")),
        "sensor_not_connected" => chain.dead = true,
        _ => {}
    }
}
