//! What every effect says of itself.

use simgap_integrate::exact::ForceLaw;
use simgap_model::{Location, Model};

use crate::SignalMap;

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

/// What an effect is attached to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SiteKind {
    /// Two nodes that a member joins, or a mass and the ground.
    Member,
    /// Two nodes that a spring joins.
    Spring,
    /// Two nodes that a damper joins.
    Damper,
    /// A member, or a mass and the ground, without a spring.
    NoSpring,
    /// A member, or a mass and the ground, without a damper.
    NoDamper,
    /// One mass.
    Mass,
    /// An input channel.
    Input,
    /// An output channel.
    Channel,
}

/// A parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files, with the unit in it.
    pub name: &'static str,
    /// Unit, SI.
    pub unit: &'static str,
    /// Smallest physical value.
    pub lower: f64,
    /// Largest physical value.
    pub upper: f64,
    /// Value at which the effect vanishes; `None` for a parameter that only shapes it.
    pub neutral: Option<f64>,
}

impl Parameter {
    /// A factor on a nominal value: not negative, without effect at one.
    #[must_use]
    pub const fn factor(name: &'static str) -> Parameter {
        Parameter {
            name,
            unit: "1",
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(1.0),
        }
    }
}

/// Typical sizes at a site, from which an effect takes its starting values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiteScale {
    /// rms of the displacement across the site about its mean, m.
    pub displacement_m: f64,
    /// rms of the velocity across the site about its mean, m/s.
    pub velocity_m_per_s: f64,
    /// Typical force at the site, N: rms of what accelerates the masses it joins.
    pub force_n: f64,
    /// rms of the channel about its mean, in model units (input and output sites).
    pub signal: f64,
    /// Sampling interval, s.
    pub time_step_s: f64,
    /// Length of the longest record, s.
    pub duration_s: f64,
}

/// Changes the linear model at a place.
pub type ModelChange = Box<dyn Fn(&mut Model, &Location) + Send + Sync>;

/// What an effect does, with its parameters filled in.
pub enum Action {
    /// Changes the linear model.
    Model(ModelChange),
    /// Adds a force between two nodes, or between a mass and the ground.
    Force(Box<dyn ForceLaw>),
    /// Changes an input before it reaches the plant.
    Input(Box<dyn SignalMap>),
    /// Changes an output before it is sampled: sensor, filter, cable.
    Output(Box<dyn SignalMap>),
    /// Changes an output as it is sampled and stored; acts after every [`Action::Output`].
    Sampling(Box<dyn SignalMap>),
}

/// An entry of the catalogue.
pub trait Effect: Sync + Send {
    /// Catalogue name, such as `coulomb_friction`.
    fn kind(&self) -> &'static str;

    /// Machine or measurement chain.
    fn family(&self) -> Family;

    /// Where it can sit.
    fn site(&self) -> SiteKind;

    /// One sentence for an engineer.
    fn summary(&self) -> &'static str;

    /// The equation, in the letters of the parameters' documentation.
    fn equation(&self) -> &'static str;

    /// The parameters, in the order of the value vectors.
    fn parameters(&self) -> &'static [Parameter];

    /// Starting values for a fit: one vector or, where the shape matters, several. Each is a small
    /// but visible instance of the effect at this site.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>>;

    /// Kinds that are special cases of this one, whose parameters come first among its own: at one
    /// place only one of them makes sense.
    fn contains(&self) -> &'static [&'static str] {
        &[]
    }

    /// Starting values that grow out of the fitted values of a special case ([`Effect::contains`]).
    fn grown_from(&self, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        let _ = (values, scale);
        vec![]
    }

    /// Moves values to the nearest physical ones.
    fn make_physical(&self, values: &mut [f64]) {
        for (value, parameter) in values.iter_mut().zip(self.parameters()) {
            *value = value.clamp(parameter.lower, parameter.upper);
        }
    }

    /// What the effect does with these parameter values (as many as [`Effect::parameters`]).
    fn action(&self, values: &[f64]) -> Action;

    /// The experiment that shows this effect best against its rivals.
    fn experiment(&self) -> &'static str;
}
