//! Which numbers a fit may change, and in which order they stand.

use simgap_effects::{Effect, Parameter, Placed};
use simgap_model::Location;

/// A catalogue entry at a place, without values.
#[derive(Clone)]
pub struct Candidate {
    /// The entry.
    pub effect: &'static dyn Effect,
    /// The place.
    pub at: Location,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.effect.kind() == other.effect.kind() && self.at == other.at
    }
}

impl std::fmt::Debug for Candidate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.effect.kind(), self.at)
    }
}

/// Where a fit starts.
#[derive(Clone)]
pub struct Start {
    /// The effects to estimate, with starting values.
    pub effects: Vec<Placed>,
    /// Nominal parameters held near their values, with starting values.
    pub nominal: Vec<Placed>,
    /// Initial state of each run.
    pub initial: Vec<Vec<f64>>,
}

/// Factor within which a fit moves a parameter that only shapes an effect.
const SHAPE_REACH: f64 = 10.0;

/// The vector θ: values of the effects, then of the nominal parameters, then the initial states.
pub(crate) struct Layout {
    effects: Vec<Placed>,
    nominal: Vec<Placed>,
    state_len: usize,
    run_count: usize,
    /// Typical size of each entry of θ.
    pub(crate) scale: Vec<f64>,
    /// Prior standard deviation about the neutral value; infinite where free.
    pub(crate) prior_std: Vec<f64>,
    pub(crate) prior_mean: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
}

impl Layout {
    pub(crate) fn new(start: &Start, state_scale: &[f64], prior: f64) -> Layout {
        let mut layout = Layout {
            effects: start.effects.clone(),
            nominal: start.nominal.clone(),
            state_len: state_scale.len(),
            run_count: start.initial.len(),
            scale: vec![],
            prior_std: vec![],
            prior_mean: vec![],
            lower: vec![],
            upper: vec![],
        };
        for (placed, std) in start
            .effects
            .iter()
            .map(|p| (p, f64::INFINITY))
            .chain(start.nominal.iter().map(|p| (p, prior)))
        {
            let mut values = placed.values.clone();
            placed.effect.make_physical(&mut values);
            for (parameter, &value) in placed.effect.parameters().iter().zip(&values) {
                layout.push_parameter(parameter, value, std);
            }
        }
        for _ in 0..layout.run_count {
            for &scale in state_scale {
                layout.scale.push(scale);
                layout.prior_std.push(f64::INFINITY);
                layout.prior_mean.push(0.0);
                layout.lower.push(f64::NEG_INFINITY);
                layout.upper.push(f64::INFINITY);
            }
        }
        layout
    }

    fn push_parameter(&mut self, parameter: &Parameter, value: f64, std: f64) {
        let neutral = parameter.neutral.unwrap_or(0.0);
        // Near the neutral value the distance to it is no scale any more.
        let size = (value - neutral).abs().max(0.02 * neutral.abs());
        self.scale.push(if size > 0.0 { size } else { 1.0 });
        self.prior_std.push(std);
        self.prior_mean.push(neutral);
        // A fit looks for a shape around the one it starts from; others have starts of their own.
        let shape = parameter.neutral.is_none() && value > 0.0;
        let (least, most) = if shape {
            (value / SHAPE_REACH, value * SHAPE_REACH)
        } else {
            (f64::NEG_INFINITY, f64::INFINITY)
        };
        self.lower.push(parameter.lower.max(least));
        self.upper.push(parameter.upper.min(most));
    }

    /// Number of entries that every run depends on.
    pub(crate) fn shared_len(&self) -> usize {
        self.effect_len() + self.nominal.iter().map(|p| p.values.len()).sum::<usize>()
    }

    /// Number of entries that belong to the effects.
    pub(crate) fn effect_len(&self) -> usize {
        self.effects.iter().map(|p| p.values.len()).sum()
    }

    pub(crate) fn len(&self) -> usize {
        self.scale.len()
    }

    /// First entry of the initial state of a run.
    pub(crate) fn state_offset(&self, run: usize) -> usize {
        self.shared_len() + run * self.state_len
    }

    /// Entries a run depends on: the shared ones, then its own initial state.
    pub(crate) fn entries(&self, run: usize) -> impl Iterator<Item = usize> + use<> {
        let own = self.state_offset(run)..self.state_offset(run) + self.state_len;
        (0..self.shared_len()).chain(own)
    }

    /// For each shared entry, the effect or nominal parameter it belongs to and which of its
    /// values it is.
    pub(crate) fn shared(&self) -> impl Iterator<Item = (&Placed, usize)> {
        let placed = self.effects.iter().chain(&self.nominal);
        placed.flat_map(|p| (0..p.values.len()).map(move |i| (p, i)))
    }

    pub(crate) fn pack(&self, start: &Start) -> Vec<f64> {
        let placed = start.effects.iter().chain(&start.nominal);
        let mut theta: Vec<f64> = placed.flat_map(|p| p.values.iter().copied()).collect();
        theta.extend(start.initial.iter().flatten());
        theta
    }

    pub(crate) fn unpack(&self, theta: &[f64]) -> Start {
        let mut next = theta.iter().copied();
        let mut fill = |placed: &Placed| Placed {
            values: placed.values.iter().filter_map(|_| next.next()).collect(),
            ..placed.clone()
        };
        let effects: Vec<Placed> = self.effects.iter().map(&mut fill).collect();
        let nominal: Vec<Placed> = self.nominal.iter().map(&mut fill).collect();
        let initial = (0..self.run_count)
            .map(|run| self.state(theta, run).to_vec())
            .collect();
        Start {
            effects,
            nominal,
            initial,
        }
    }

    pub(crate) fn state<'a>(&self, theta: &'a [f64], run: usize) -> &'a [f64] {
        let offset = self.state_offset(run);
        &theta[offset..offset + self.state_len]
    }

    /// Moves the values of the effects and nominal parameters to the nearest physical ones.
    pub(crate) fn make_physical(&self, theta: &mut [f64]) {
        let mut rest = &mut *theta;
        for placed in self.effects.iter().chain(&self.nominal) {
            let (own, next) = rest.split_at_mut(placed.values.len());
            placed.effect.make_physical(own);
            rest = next;
        }
        let shared = self.shared_len();
        for (value, (lower, upper)) in theta
            .iter_mut()
            .zip(self.lower.iter().zip(&self.upper))
            .take(shared)
        {
            *value = value.clamp(*lower, *upper);
        }
    }
}
