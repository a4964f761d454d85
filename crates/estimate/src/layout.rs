//! Which numbers a fit may change, and in which order they stand.

use std::f64::consts::TAU;

use simgap_effects::{Parameter, Placed, Prior};
use simgap_simulate::Run;

use crate::problem::Problem;
use crate::states::state_scale;

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

impl Start {
    /// Everything that is put on the nominal model: the effects, then the nominal parameters.
    pub fn placed(&self) -> impl Iterator<Item = &Placed> {
        self.effects.iter().chain(&self.nominal)
    }
}

/// What a fit may do with the start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Freedom {
    /// Standard deviation of the prior on every nominal parameter, instead of the stated ones.
    pub(crate) nominal_std: Option<f64>,
    /// Whether values that all records share stay as they are.
    pub(crate) shared_held: bool,
}

/// Factor within which a fit moves a parameter that only shapes an effect.
const SHAPE_REACH: f64 = 10.0;

/// The vector θ: values of the effects that all records share, then the nominal parameters; then,
/// run by run, the effects' values of its own and its initial state.
///
/// A phase φ at time zero stands in it as that in the middle of its run, φ + 2π f t: a record that begins an hour
/// after zero says next to nothing of the one without the other, and all it can of these two.
pub(crate) struct Layout {
    effects: Vec<Placed>,
    nominal: Vec<Placed>,
    /// Effect and place of each shared value of the effects.
    shared_values: Vec<(usize, usize)>,
    /// Effect and place of each value that a run has of its own.
    own_values: Vec<(usize, usize)>,
    /// Phases among the values of a run's own: which they are, with the entry of their frequency.
    phases: Vec<(usize, usize)>,
    state_len: usize,
    /// The middle of each run, s.
    middle_s: Vec<f64>,
    /// Typical size of each entry of θ.
    pub(crate) scale: Vec<f64>,
    /// Prior standard deviation about the neutral value; infinite where free.
    pub(crate) prior_std: Vec<f64>,
    pub(crate) prior_mean: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
    /// Whether an entry is a size or a factor, shared by all records.
    pub(crate) is_size: Vec<bool>,
    /// Whether an entry is a limit, at one infinity or the other without effect.
    pub(crate) is_limit: Vec<bool>,
    /// Prior of each entry that is a value of an effect, where sizes of its place are known.
    priors: Vec<Option<(Prior, Parameter)>>,
}

/// An effect without what records have of their own.
fn of_all_records(placed: &Placed) -> Placed {
    Placed::new(placed.effect, placed.at.clone(), placed.values.clone())
}

impl Layout {
    pub(crate) fn new(start: &Start, problem: &Problem, freedom: Freedom) -> Layout {
        let (runs, state_scale) = (&problem.runs, state_scale(problem));
        let places = |own: bool| -> Vec<(usize, usize)> {
            let effects = start.effects.iter().enumerate();
            effects
                .flat_map(|(e, placed)| {
                    let parameters = placed.effect.parameters().iter().enumerate();
                    parameters.filter_map(move |(i, p)| (p.per_record == own).then_some((e, i)))
                })
                .collect()
        };
        let mut layout = Layout {
            effects: start.effects.iter().map(of_all_records).collect(),
            nominal: start.nominal.clone(),
            shared_values: places(false),
            own_values: places(true),
            phases: vec![],
            state_len: state_scale.len(),
            middle_s: runs.iter().map(Run::middle_s).collect(),
            scale: vec![],
            prior_std: vec![],
            prior_mean: vec![],
            lower: vec![],
            upper: vec![],
            is_size: vec![],
            is_limit: vec![],
            priors: vec![],
        };
        let physical: Vec<Vec<f64>> = start
            .effects
            .iter()
            .map(|placed| {
                let mut values = placed.values.clone();
                placed.effect.make_physical(&mut values);
                values
            })
            .collect();
        let turns = |placed: &Placed| problem.drift(placed.effect, &placed.at);
        for &(e, i) in &layout.shared_values.clone() {
            let value = physical[e][i];
            let parameter = &start.effects[e].effect.parameters()[i];
            layout.push_parameter(parameter, value, f64::INFINITY);
            let placed = &start.effects[e];
            layout.set_prior(problem.prior(placed, i), parameter);
            if freedom.shared_held
                || placed.effect.is_chosen(i)
                || turns(placed).is_some_and(|drift| drift.wave.cosine == i)
            {
                layout.hold_last(value);
            }
        }
        for placed in &start.nominal {
            let stated = || problem.stated_std(placed);
            let std = freedom.nominal_std.unwrap_or_else(stated);
            for (parameter, &value) in placed.effect.parameters().iter().zip(&placed.values) {
                layout.push_parameter(parameter, value.max(parameter.lower), std);
            }
        }
        layout.phases = layout.phases_of_clocks();
        let first_order = problem.model.first_order();
        let state_std = |i: usize| problem.state_std.get(i).copied().unwrap_or(f64::INFINITY);
        for run in 0..layout.middle_s.len() {
            for (own, (e, i)) in layout.own_values.clone().into_iter().enumerate() {
                if layout.phases.iter().any(|(phase, _)| *phase == own) {
                    layout.push(1.0, f64::INFINITY, [f64::NEG_INFINITY, f64::INFINITY]);
                    continue;
                }
                let value = start.effects[e].in_record(run).values[i];
                let parameter = &start.effects[e].effect.parameters()[i];
                layout.push_parameter(parameter, value, f64::INFINITY);
                layout.set_prior(problem.prior(&start.effects[e], i), parameter);
            }
            for (i, &scale) in state_scale.iter().enumerate() {
                layout.push(scale, state_std(i), [f64::NEG_INFINITY, f64::INFINITY]);
                // The integral of a pressure enters no equation.
                if first_order.get(i) == Some(&true) {
                    layout.hold_last(0.0);
                }
            }
        }
        layout
    }

    fn phases_of_clocks(&self) -> Vec<(usize, usize)> {
        let own = self.own_values.iter().enumerate();
        let phases = own.filter_map(|(own, &(e, i))| {
            let clock = self.effects[e].effect.clock()?;
            let key = (e, clock.frequency);
            let frequency = self.shared_values.iter().position(|known| *known == key)?;
            (clock.phase == i).then_some((own, frequency))
        });
        phases.collect()
    }

    /// What a phase in the middle of a run is ahead of that at time zero, rad.
    fn ahead(&self, run: usize, own: usize, theta: &[f64]) -> f64 {
        let phase = self.phases.iter().find(|(phase, _)| *phase == own);
        phase.map_or(0.0, |&(_, frequency)| {
            TAU * theta[frequency] * self.middle_s[run]
        })
    }

    fn push(&mut self, scale: f64, prior_std: f64, [lower, upper]: [f64; 2]) {
        self.scale.push(scale);
        self.prior_std.push(prior_std);
        self.prior_mean.push(0.0);
        self.lower.push(lower);
        self.upper.push(upper);
        self.is_size.push(false);
        self.is_limit.push(false);
        self.priors.push(None);
    }

    fn set_prior(&mut self, prior: Option<Prior>, parameter: &Parameter) {
        if let Some(last) = self.priors.last_mut() {
            *last = prior.map(|prior| (prior, *parameter));
        }
    }

    /// −ln of the prior of an entry at a value, but for a constant, with its derivative and curvature in the value.
    pub(crate) fn prior_at(&self, entry: usize, value: f64) -> [f64; 3] {
        if self.is_held(entry) {
            return [0.0; 3];
        }
        let Some((prior, parameter)) = &self.priors[entry] else {
            let deviation = (value - self.prior_mean[entry]) / self.prior_std[entry];
            let slope = deviation / self.prior_std[entry];
            return [
                0.5 * deviation.powi(2),
                slope,
                self.prior_std[entry].powi(-2),
            ];
        };
        let local = prior.local(value, parameter);
        let deviation = (local.coordinate - local.mean) / local.std;
        let neutral = parameter.neutral.filter(|n| n.is_finite()).unwrap_or(0.0);
        let sign = match prior {
            Prior::Size { .. } if value < neutral => -1.0,
            Prior::Factor { .. } if value < 0.0 => -1.0,
            _ => 1.0,
        };
        // du/dv.
        let per_value = sign / (local.slope * local.std);
        let constant = local.std.ln() - local.log_weight;
        [
            0.5 * deviation.powi(2) + constant,
            deviation * per_value,
            per_value.powi(2),
        ]
    }

    fn push_parameter(&mut self, parameter: &Parameter, value: f64, std: f64) {
        // A limit at infinity is no point to measure a distance from.
        let neutral = parameter.neutral.filter(|n| n.is_finite()).unwrap_or(0.0);
        // Near the neutral value the distance to it is no scale any more.
        let size = (value - neutral).abs().max(0.02 * neutral.abs());
        // A fit looks for a shape around the one it starts from; others have starts of their own.
        let shape = parameter.neutral.is_none() && value > 0.0 && !parameter.per_record;
        let (least, most) = if shape {
            (value / SHAPE_REACH, value * SHAPE_REACH)
        } else {
            (f64::NEG_INFINITY, f64::INFINITY)
        };
        let is_scale = size > 0.0 && size.is_finite();
        let bounds = [parameter.lower.max(least), parameter.upper.min(most)];
        self.push(if is_scale { size } else { 1.0 }, std, bounds);
        if let Some(mean) = self.prior_mean.last_mut() {
            *mean = neutral;
        }
        if let (Some(size), Some(limit)) = (self.is_size.last_mut(), self.is_limit.last_mut()) {
            *size = parameter.neutral.is_some_and(f64::is_finite) && !parameter.per_record;
            *limit = parameter.neutral.is_some_and(f64::is_infinite);
        }
    }

    fn hold_last(&mut self, value: f64) {
        if let (Some(lower), Some(upper)) = (self.lower.last_mut(), self.upper.last_mut()) {
            (*lower, *upper) = (value, value);
        }
    }

    /// Whether an entry cannot move.
    pub(crate) fn is_held(&self, entry: usize) -> bool {
        self.lower[entry] == self.upper[entry]
    }

    /// Number of entries that every run depends on.
    pub(crate) fn shared_len(&self) -> usize {
        self.effect_len() + self.nominal.iter().map(|p| p.values.len()).sum::<usize>()
    }

    /// Number of shared entries that belong to the effects.
    pub(crate) fn effect_len(&self) -> usize {
        self.shared_values.len()
    }

    /// Number of entries of a run that belong to the effects.
    pub(crate) fn own_len(&self) -> usize {
        self.own_values.len()
    }

    pub(crate) fn len(&self) -> usize {
        self.scale.len()
    }

    /// First entry that belongs to a run alone.
    fn run_offset(&self, run: usize) -> usize {
        self.shared_len() + run * (self.own_len() + self.state_len)
    }

    /// Entries a run depends on: the shared ones, then its own.
    pub(crate) fn entries(&self, run: usize) -> impl Iterator<Item = usize> + use<> {
        let own = self.run_offset(run)..self.run_offset(run + 1);
        (0..self.shared_len()).chain(own)
    }

    /// Whether a place in the list of [`Layout::entries`] is a nominal parameter or belongs to the
    /// initial state.
    pub(crate) fn is_nuisance(&self, place: usize) -> bool {
        (self.effect_len()..self.shared_len()).contains(&place)
            || place >= self.shared_len() + self.own_len()
    }

    /// For each shared entry, the effect or nominal parameter it belongs to and which of its
    /// values it is.
    pub(crate) fn shared(&self) -> impl Iterator<Item = (&Placed, usize)> {
        let effects = self.shared_values.iter();
        let nominal = self.nominal.iter();
        effects
            .map(|&(e, i)| (&self.effects[e], i))
            .chain(nominal.flat_map(|p| (0..p.values.len()).map(move |i| (p, i))))
    }

    /// The entry of a value of an effect, of a value of a record that of the first.
    pub(crate) fn entry(&self, effect: usize, place: usize) -> Option<usize> {
        let at = |list: &[(usize, usize)]| list.iter().position(|&key| key == (effect, place));
        at(&self.shared_values).or_else(|| at(&self.own_values).map(|own| self.run_offset(0) + own))
    }

    /// Variance of a value that an entry stands for, from that of each entry in units of its scale. In the middle of
    /// a run a phase has next to nothing to do with the frequency.
    pub(crate) fn variance(&self, entry: usize, spread: &[f64]) -> f64 {
        let own = |entry: usize| spread[entry] * self.scale[entry].powi(2);
        let first = self.run_offset(0);
        let phase = self.phases.iter().find(|(own, _)| first + own == entry);
        let turned = phase.map_or(0.0, |&(_, frequency)| {
            own(frequency) * (TAU * self.middle_s[0]).powi(2)
        });
        own(entry) + turned
    }

    /// What each entry is a value of.
    pub(crate) fn owners(&self) -> Vec<Owner> {
        let of_effect = |&(e, i): &(usize, usize)| Owner::Effect(e, i);
        let mut owners: Vec<Owner> = self.shared_values.iter().map(of_effect).collect();
        let nominal = self.nominal.iter().enumerate();
        owners.extend(
            nominal.flat_map(|(n, p)| (0..p.values.len()).map(move |i| Owner::Nominal(n, i))),
        );
        for _ in &self.middle_s {
            owners.extend(self.own_values.iter().map(of_effect));
            owners.extend((0..self.state_len).map(|_| Owner::State));
        }
        owners
    }

    pub(crate) fn pack(&self, start: &Start) -> Vec<f64> {
        let effects = &start.effects;
        let shared = self.shared_values.iter();
        let mut theta: Vec<f64> = shared.map(|&(e, i)| effects[e].values[i]).collect();
        theta.extend(start.nominal.iter().flat_map(|p| p.values.iter().copied()));
        for (run, initial) in start.initial.iter().enumerate() {
            for (own, &(e, i)) in self.own_values.iter().enumerate() {
                let value = effects[e].in_record(run).values[i];
                theta.push(value + self.ahead(run, own, &theta));
            }
            theta.extend(initial);
        }
        theta
    }

    pub(crate) fn unpack(&self, theta: &[f64]) -> Start {
        let mut effects = self.placed_in(theta, 0);
        let nominal = effects.split_off(self.effects.len());
        let runs = 0..self.middle_s.len();
        for (own, &(e, _)) in self.own_values.iter().enumerate() {
            effects[e].of_record.resize(runs.len(), vec![]);
            for (run, values) in effects[e].of_record.iter_mut().enumerate() {
                values.push(self.own_value(theta, run, own));
            }
        }
        Start {
            effects,
            nominal,
            initial: runs.map(|run| self.state(theta, run).to_vec()).collect(),
        }
    }

    /// Effects and nominal parameters as they are in one run.
    pub(crate) fn placed_in(&self, theta: &[f64], run: usize) -> Vec<Placed> {
        let mut placed: Vec<Placed> = self.effects.iter().chain(&self.nominal).cloned().collect();
        for (&(e, i), &value) in self.shared_values.iter().zip(theta) {
            placed[e].values[i] = value;
        }
        for (own, &(e, i)) in self.own_values.iter().enumerate() {
            placed[e].values[i] = self.own_value(theta, run, own);
        }
        let nominal = placed[self.effects.len()..].iter_mut();
        let values = nominal.flat_map(|placed| &mut placed.values);
        for (value, &next) in values.zip(&theta[self.effect_len()..]) {
            *value = next;
        }
        placed
    }

    /// A value that a run has of its own, by its place among these.
    fn own_value(&self, theta: &[f64], run: usize, own: usize) -> f64 {
        theta[self.run_offset(run) + own] - self.ahead(run, own, theta)
    }

    pub(crate) fn state<'a>(&self, theta: &'a [f64], run: usize) -> &'a [f64] {
        let offset = self.run_offset(run) + self.own_len();
        &theta[offset..offset + self.state_len]
    }

    /// Every entry of a packed vector that the effects and nominal parameters of a run come from.
    pub(crate) fn values_in(&self, theta: &[f64], run: usize) -> impl Iterator<Item = f64> {
        let own = &theta[self.run_offset(run)..][..self.own_len()];
        let shared = theta[..self.shared_len()].iter();
        shared.chain(own).copied()
    }

    /// Moves the values of the effects and nominal parameters to the nearest physical ones.
    pub(crate) fn make_physical(&self, theta: &mut [f64]) {
        let mut effects = self.placed_in(theta, 0);
        let nominal = effects.split_off(self.effects.len());
        for (e, mut placed) in effects.into_iter().enumerate() {
            placed.effect.make_physical(&mut placed.values);
            for (entry, key) in self.shared_values.iter().enumerate() {
                if key.0 == e {
                    theta[entry] = placed.values[key.1];
                }
            }
        }
        let mut entry = self.effect_len();
        for mut placed in nominal {
            placed.effect.make_physical(&mut placed.values);
            for value in placed.values {
                theta[entry] = value;
                entry += 1;
            }
        }
        let bounds = self.lower.iter().zip(&self.upper);
        for (value, (lower, upper)) in theta.iter_mut().zip(bounds) {
            *value = value.clamp(*lower, *upper);
        }
    }
}

/// What a coordinate of a fit is a value of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// Of the i-th effect, the k-th parameter; of one record where records have values of their own.
    Effect(usize, usize),
    /// Of the i-th nominal parameter, the k-th value.
    Nominal(usize, usize),
    /// The initial state of a record.
    State,
}
