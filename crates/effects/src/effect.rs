//! What every effect says of itself.

use simgap_integrate::exact::ForceLaw;
use simgap_model::{Location, Model, NominalQuantity};

pub use crate::parameter::{Parameter, unit_of_rotation};
use crate::prior::{Prior, SIZE_LOG_STD};
pub use crate::scale::{LINES, SiteScale};
use crate::{Line, SignalMap, Wave};

/// A wrong nominal value is met as often as this many kinds of the catalogue together.
const EVERYDAY: f64 = 3.0;

/// Which part of the world an effect belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// A nominal parameter has another value.
    NominalParameter,
    /// A force the model lacks.
    Force,
    /// Dynamics the model lacks.
    Dynamics,
    /// The measurement chain, not the machine.
    Measurement,
}

impl Family {
    /// Whether an effect is something the model of the machine lacks, not a value that is off.
    #[must_use]
    pub fn is_law(self) -> bool {
        matches!(self, Family::Force | Family::Dynamics)
    }
}

/// What an effect is attached to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SiteKind {
    /// Two nodes that a member joins, or a mass and the ground.
    Member,
    /// Two nodes that a spring joins.
    Spring,
    /// A node and the ground that a spring joins.
    GroundSpring,
    /// Two nodes that a damper joins.
    Damper,
    /// Any two nodes, joined or not, without a spring.
    NoSpring,
    /// Any two nodes, joined or not, without a damper.
    NoDamper,
    /// One mass.
    Mass,
    /// A mass on which gravity acts as on an arm.
    Pendulum,
    /// A mass with a known constant force.
    Load,
    /// The two chambers of a cylinder.
    Chambers,
    /// The spool of a valve.
    Spool,
    /// An input channel.
    Input,
    /// An output channel.
    Channel,
    /// A parameter of a simulator.
    Parameter,
}

/// An effect with a clock of its own: it is proportional to `amplitude · sin(2π f t + phase)`, each
/// record with a phase of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clock {
    /// Place of the amplitude among the parameters.
    pub amplitude: usize,
    /// Place of the frequency f, Hz.
    pub frequency: usize,
    /// Place of the phase, rad.
    pub phase: usize,
}

impl Clock {
    /// The line of an effect that is that swing and nothing else, for its values.
    #[must_use]
    pub fn line(self, values: &[f64]) -> Line {
        Line {
            frequency_hz: values[self.frequency],
            amplitude: values[self.amplitude],
            phase_rad: values[self.phase],
        }
    }
}

/// Changes the linear model at a place.
pub type ModelChange = Box<dyn Fn(&mut Model, &Location) + Send + Sync>;

/// Makes a force law that depends on the members of the model at its place.
pub type LawOfModel = Box<dyn Fn(&Model, &Location) -> Box<dyn ForceLaw> + Send + Sync>;

/// What an effect does, with its parameters filled in.
pub enum Action {
    /// Changes the linear model.
    Model(ModelChange),
    /// Adds one mass and its members to the linear model.
    Mode {
        /// Appends the mass.
        change: ModelChange,
        /// Displacement (m) and velocity (m/s) of the mass at the first sample, beyond those with
        /// which it would follow the others at rest.
        start: [f64; 2],
    },
    /// Adds a force that depends on the members at the place, all changes of the model made.
    Member(LawOfModel),
    /// Adds a force between two nodes, or between a mass and the ground.
    Force(Box<dyn ForceLaw>),
    /// Changes an input before it reaches the plant.
    Input(Box<dyn SignalMap>),
    /// Changes an output before it is sampled: sensor, filter, cable.
    Output(Box<dyn SignalMap>),
    /// Changes an output as it is sampled and stored; acts after every [`Action::Output`].
    Sampling(Box<dyn SignalMap>),
}

impl Action {
    /// Whether it adds a mass to the model, with a mode of its own.
    #[must_use]
    pub fn adds_mass(&self) -> bool {
        matches!(self, Action::Mode { .. })
    }

    /// Whether it is a force law with a dry part: one that can hold a member still, and jumps when the motion turns.
    #[must_use]
    pub fn is_dry(&self) -> bool {
        matches!(self, Action::Force(law) if law.dry_level(0.0).is_some())
    }

    /// Whether it moves a signal in steps, so that it has no derivative to go by.
    #[must_use]
    pub fn is_stepped(&self) -> bool {
        match self {
            Action::Input(map) | Action::Output(map) | Action::Sampling(map) => map.is_stepped(),
            Action::Model(_) | Action::Mode { .. } | Action::Member(_) | Action::Force(_) => false,
        }
    }
}

/// An entry of the catalogue.
pub trait Effect: Sync + Send {
    /// Catalogue name, such as `coulomb_friction`.
    fn kind(&self) -> &'static str;

    /// Machine or measurement chain.
    fn family(&self) -> Family;

    /// Where it can sit.
    fn site(&self) -> SiteKind;

    /// The only places where it can sit; empty where these are all of [`Effect::site`].
    fn stated_places(&self) -> &[Location] {
        &[]
    }

    /// One sentence for an engineer.
    fn summary(&self) -> &'static str;

    /// The equation, in the letters of the parameters' documentation.
    fn equation(&self) -> &'static str;

    /// Where the law is taken from: a key of `docs/references.md` and the place there. `None` for
    /// what needs no source.
    fn reference(&self) -> Option<&'static str> {
        None
    }

    /// The parameters, in the order of the value vectors.
    fn parameters(&self) -> &'static [Parameter];

    /// Whether the names of its parameters end in their units, so that a reader of a name knows the unit.
    fn names_hold_units(&self) -> bool {
        true
    }

    /// Starting values for a fit: one vector or, where the shape matters, several. Each is a small
    /// but visible instance of the effect at this site.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>>;

    /// Values as they are met with, for pictures and generated cases: the starts, unless these are close to each other
    /// only to be followed by a fit.
    fn usual(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        self.starts(scale)
    }

    /// Starting values over the range of a clock that may leave no line to start from. They are tried where no single
    /// effect leaves only noise.
    fn sweep(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![]
    }

    /// Values that the records point at, too far from where the effect vanishes to be seen from there. They are scored by the whole of what
    /// the effect does.
    fn pointed_at(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![]
    }

    /// Kinds that are special cases of this one, whose parameters come first among its own: at one
    /// place only one of them makes sense.
    fn contains(&self) -> &'static [&'static str] {
        &[]
    }

    /// Kinds at the same place that this one turns into where its dynamics are out of sight, or the motion does not reach where it
    /// yields: each is found in the other's stead as long as a fit does not start near the right one.
    fn turns_into(&self) -> &'static [&'static str] {
        &[]
    }

    /// Kinds whose force on a mass has the same form in frequency, or is the same as long as what the effect hides is not moved by the
    /// mass, at the mass itself or at its spring to the ground; or that do the same to a channel as a slow plant sees it; or that take as
    /// much of a force in its channel as between the mass that it drives and the ground. Where one fits, the other may fit as well from the
    /// values that move the mass alike.
    fn resembles(&self) -> &'static [&'static str] {
        &[]
    }

    /// Starting values that grow out of the fitted values of a special case ([`Effect::contains`]), of what it
    /// turns into ([`Effect::turns_into`]) or of what it resembles ([`Effect::resembles`]), by its kind; none
    /// where these values are out of reach. The sizes are those of its own place, or of the spring to the
    /// ground of what it resembles.
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        let _ = (kind, values, scale);
        vec![]
    }

    /// Values of a special case ([`Effect::contains`]) or of what the effect turns into ([`Effect::turns_into`]), by its kind, at
    /// which it acts as these values do or comes nearest; `None` for the first of them in a special case, and for none otherwise. Those
    /// of a wrong nominal value are meant from the model as given.
    fn shrunk_to(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Option<Vec<f64>> {
        let _ = (kind, values, scale);
        None
    }

    /// What is known of the parameter at a place of [`Effect::parameters`] before any data, where things are of these
    /// sizes.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        usual_prior(self, place, scale)
    }

    /// How much likelier the kind is than one of the catalogue is on average, before any data.
    fn prior_weight(&self) -> f64 {
        match self.family() {
            Family::NominalParameter => EVERYDAY,
            _ => 1.0,
        }
    }

    /// The nominal value that the effect changes by a factor, whose stated uncertainty is
    /// [`Model::stated_uncertainty`] at its place; `None` for what no nominal value stands for.
    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        None
    }

    /// Whether the prior of the kind has any density at these values, at a place of these sizes. What has a clock swings:
    /// the longest record holds a whole period of it; what does not is off, or drifts.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        let clock = self.clock();
        clock.is_none_or(|clock| values[clock.frequency] * scale.duration_s >= 1.0)
    }

    /// Density of the prior of the kind at these values over that of its parameters one by one: less than one where machines hardly are.
    fn weight(&self, values: &[f64], scale: &SiteScale) -> f64 {
        let _ = (values, scale);
        1.0
    }

    /// Whether it is one of the terms that the loss of a machine is usually made of: a force against the velocity, in
    /// proportion to its only value. Such terms stand for each other, and may be found only together.
    fn is_loss_term(&self) -> bool {
        false
    }

    /// Two values that make the law another one where they agree: an asymmetry whose two sides are one.
    fn coincidence(&self) -> Option<[usize; 2]> {
        None
    }

    /// Makes the events of an effect that strikes at random (lost samples, spikes), for generated
    /// cases: the signal with its events, from numbers evenly drawn in 0 to 1. `None` for an effect
    /// that its [`Effect::action`] describes in full.
    fn strike(
        &self,
        values: &[f64],
        signal: &[f64],
        random: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<f64>> {
        let _ = (values, signal, random);
        None
    }

    /// Whether what the effect does grows about in proportion to its sizes from nothing to a start.
    fn grows_in_proportion(&self) -> bool {
        true
    }

    /// Values with those that each record has of its own where a search for these begins: as given, but where they begin anywhere within
    /// something that repeats itself.
    fn own_starts(&self, values: &[f64]) -> Vec<Vec<f64>> {
        vec![values.to_vec()]
    }

    /// The clock of an effect that has one of its own.
    fn clock(&self) -> Option<Clock> {
        None
    }

    /// What makes an effect a wave along the travel.
    fn wave(&self) -> Option<Wave> {
        None
    }

    /// The line of an effect that does the same whatever moves, for its values.
    fn line(&self, values: &[f64]) -> Option<Line> {
        let _ = values;
        None
    }

    /// Moves values to the nearest physical ones.
    fn make_physical(&self, values: &mut [f64]) {
        for (value, parameter) in values.iter_mut().zip(self.parameters()) {
            *value = value.clamp(parameter.lower, parameter.upper);
        }
    }

    /// Whether the value of the i-th parameter is that of the best start: no fit moves it, and it has no interval.
    fn is_chosen(&self, place: usize) -> bool {
        let _ = place;
        false
    }

    /// The value of a parameter that a model file may leave out.
    fn left_out(&self, parameter: &str) -> Option<f64> {
        let _ = parameter;
        None
    }

    /// What the effect does with these parameter values (as many as [`Effect::parameters`]).
    fn action(&self, values: &[f64]) -> Action;

    /// Kinds that this one is easily mistaken for, and why.
    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// The experiment that shows this effect best against its rivals.
    fn experiment(&self) -> &'static str;
}

/// The prior of a parameter that follows from what the effect says of itself: a factor about one; a value of a record's
/// own as large as the motion; a share even over its range; a size or a shape about its usual values.
#[must_use]
pub fn usual_prior(effect: &(impl Effect + ?Sized), place: usize, scale: &SiteScale) -> Prior {
    let Some(parameter) = effect.parameters().get(place) else {
        return Prior::size(1.0);
    };
    let is_positive = |value: f64| value > 0.0 && value.is_finite();
    if parameter.per_record {
        let Some(neutral) = parameter.neutral else {
            return Prior::Uniform {
                width: std::f64::consts::TAU,
            };
        };
        let std = match parameter.unit {
            "m" => scale.displacement_m,
            "m/s" => scale.velocity_m_per_s,
            _ => 1.0,
        };
        let std = if is_positive(std) { std } else { 1.0 };
        return Prior::Normal { mean: neutral, std };
    }
    if parameter.neutral == Some(1.0) {
        return Prior::factor();
    }
    let width = parameter.upper - parameter.lower;
    if width.is_finite()
        && (parameter.lower == 0.0 || parameter.lower < 0.0 && parameter.neutral.is_none())
    {
        return Prior::Uniform { width };
    }
    let has_no_sign =
        parameter.lower == f64::NEG_INFINITY && parameter.neutral.is_none_or(f64::is_infinite);
    if has_no_sign {
        let [low, high] = scale.signal_range;
        return Prior::Normal {
            mean: 0.5 * (low + high),
            std: (high - low).max(f64::MIN_POSITIVE),
        };
    }
    let neutral = parameter.neutral.filter(|n| n.is_finite()).unwrap_or(0.0);
    let usual = effect.usual(scale);
    let logs = usual.iter().filter_map(|values| values.get(place));
    let logs: Vec<f64> = logs
        .map(|value| (value - neutral).abs())
        .filter(|distance| is_positive(*distance))
        .map(f64::ln)
        .collect();
    let count = logs.len().max(1) as f64;
    let mean = logs.iter().sum::<f64>() / count;
    let spread = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / count;
    Prior::Size {
        median: mean.exp(),
        log_std: SIZE_LOG_STD.hypot(spread.sqrt()),
    }
}
