//! The machine whose signatures are drawn: one table on a spring and a damper, driven by a force.

use std::f64::consts::TAU;

use simgap_effects::{Effect, LINES, SiteScale, sites};
use simgap_model::{Location, Model, ModelError};
use simgap_simulate::{Run, SimulateError, Simulator};

/// Mass, kg.
const MASS: f64 = 10.0;
/// Spring, N/m: with the mass 3.2 Hz.
const STIFFNESS: f64 = 4000.0;
/// Damper, N s/m: a tenth of the critical damping.
const DAMPING: f64 = 40.0;
/// Known constant force, N.
const LOAD: f64 = -20.0;
/// Gravity on the table as on an arm, N/m at rest.
const PENDULUM: f64 = 4000.0;
/// Amplitude of the motion across a member, m.
pub(super) const AMPLITUDE_M: f64 = 0.01;
/// Sample rate of smooth signals, and of what is stored sample by sample, Hz.
const FINE_HZ: f64 = 200.0;
pub(super) const COARSENING: usize = 8;
/// Length of the signals, s.
pub(super) const DURATION_S: f64 = 2.0;

/// An effect at the place where its picture is drawn.
pub(super) struct Stage {
    pub(super) effect: &'static dyn Effect,
    pub(super) model: Model,
    pub(super) at: Location,
}

/// The table with the members of the text.
fn machine(members: &str) -> Result<Model, ModelError> {
    Model::from_toml(&format!(
        "schema = \"simgap-model/1\"\nname = \"table\"\n\n[[mass]]\nname = \"table\"\nvalue = {MASS}\n\n\
         {members}[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"table\"\n\n\
         [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"table\"\n"
    ))
}

impl Stage {
    /// The first place of the first machine that has one: some effects sit where a spring or a
    /// damper is, some where there is none.
    pub(super) fn of(effect: &'static dyn Effect) -> Result<Option<Stage>, ModelError> {
        let ends = "between = [\"table\", \"ground\"]";
        let spring = format!("[[spring]]\nname = \"leaf\"\n{ends}\nstiffness = {STIFFNESS}\n\n");
        let damper = format!("[[damper]]\nname = \"guide\"\n{ends}\ndamping = {DAMPING}\n\n");
        let both = spring.clone() + &damper;
        let at = "at = \"table\"";
        let loaded = format!("{both}[[load]]\n{at}\nvalue = {LOAD}\n\n");
        let arm = format!("{both}[[pendulum]]\n{at}\nvalue = {PENDULUM}\n\n");
        if effect.site().is_hydraulic() {
            let model = super::hydraulic::model()?;
            let at = sites(&model, effect.site()).into_iter().next();
            return Ok(at.map(|at| Stage { effect, model, at }));
        }
        for members in [both, damper, spring, loaded, arm] {
            let model = machine(&members)?;
            if let Some(at) = sites(&model, effect.site()).into_iter().next() {
                return Ok(Some(Stage { effect, model, at }));
            }
        }
        Ok(None)
    }

    /// Natural frequency of the table on its spring, Hz.
    pub(super) fn natural_hz() -> f64 {
        (STIFFNESS / MASS).sqrt() / TAU
    }

    /// Force of the members for a displacement and a velocity across them, N.
    pub(super) fn members_force(&self, displacement: f64, velocity: f64) -> f64 {
        let springs = self.model.springs.iter().map(|s| s.stiffness);
        let dampers = self.model.dampers.iter().map(|d| d.damping);
        springs.sum::<f64>() * displacement + dampers.sum::<f64>() * velocity
    }

    /// What is typical at the place.
    pub(super) fn scale(&self, signal: f64) -> SiteScale {
        let omega = TAU * Stage::natural_hz();
        let rms = AMPLITUDE_M / 2.0_f64.sqrt();
        let (mut lines_hz, mut motion_hz) = ([0.0; LINES], [0.0; LINES]);
        (lines_hz[0], motion_hz[0]) = (2.0 * Stage::natural_hz(), Stage::natural_hz());
        let mut scale = SiteScale::plain(rms, omega * rms, MASS * omega * omega * rms);
        scale.signal = signal;
        scale.signal_range = [-1.7 * signal, 1.7 * signal];
        scale.signal_step = 0.25 * signal;
        scale.time_step_s = COARSENING as f64 / FINE_HZ;
        scale.duration_s = DURATION_S;
        scale.displacement_range_m = [-AMPLITUDE_M, AMPLITUDE_M];
        scale.stiffness_n_per_m = STIFFNESS;
        scale.mass_kg = MASS;
        (scale.lines_hz, scale.motion_hz) = (lines_hz, motion_hz);
        scale
    }
}

/// Times of the smooth signals, s.
pub(super) fn times() -> Vec<f64> {
    let count = (DURATION_S * FINE_HZ) as usize;
    (0..count).map(|n| n as f64 / FINE_HZ).collect()
}

/// A force that goes back and forth in steps, N.
pub(super) fn pulses() -> Vec<f64> {
    let level = |t: &f64| match (t / 0.5) as usize % 4 {
        1 => 20.0,
        3 => -12.0,
        _ => 0.0,
    };
    times().iter().map(level).collect()
}

/// Displacement of the table under two sines, m.
pub(super) fn displacement() -> Result<Vec<f64>, SimulateError> {
    let force = |t: &f64| 16.0 * (TAU * t).sin() + 8.0 * (TAU * 2.3 * t).sin();
    let time = times();
    let ends = "between = [\"table\", \"ground\"]";
    let model = machine(&format!(
        "[[spring]]\nname = \"leaf\"\n{ends}\nstiffness = {STIFFNESS}\n\n\
         [[damper]]\nname = \"guide\"\n{ends}\ndamping = {DAMPING}\n\n"
    ))?;
    let run = Run {
        name: "two sines".into(),
        start_s: 0.0,
        time_step_s: 1.0 / FINE_HZ,
        len: time.len(),
        first_index: 0,
        mended: simgap_simulate::Mended::default(),
        inputs: vec![time.iter().map(force).collect()],
        measured: vec![None],
    };
    let mut outputs = Simulator::new(&model, &[], 1)?.predict(&run, &[])?;
    Ok(outputs.swap_remove(0))
}
