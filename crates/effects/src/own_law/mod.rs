//! A law of the user's as an effect: what a `[[law]]` of the model file says, in the terms of the catalogue.
//!
//! An effect lives as long as the process ([`Effect`] is used as `&'static dyn Effect` everywhere), and so does a law: it is
//! made once for each different `[[law]]` that the process reads, and kept. What it holds, a few hundred bytes, is never
//! given back; a process that reads the same models again and again needs no more.

mod program;
mod proportion;

use std::sync::{Mutex, PoisonError};

use simgap_model::{Known, Law, LawParameter, Location, Model, Symbol};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::{Prior, SIZE_LOG_STD};
use crate::{EffectError, catalogue, find_law};

use program::{Program, reads};
use proportion::{MOST_PARAMETERS, sizes};

/// A start pushes with this share of the typical force.
const START: f64 = 0.05;

/// Share of a range at which a start lies, and between the ends of it.
const WITHIN: [f64; 3] = [0.5, 0.2, 0.8];

/// Motions about rest at which a force has to be finite, m and m/s: nearer than any record tells.
const ABOUT_REST: [f64; 3] = [0.0, 1e-9, -1e-9];

/// A law of the user's.
struct OwnLaw {
    kind: &'static str,
    summary: &'static str,
    equation: &'static str,
    parameters: &'static [Parameter],
    known: Vec<Known>,
    places: Vec<Location>,
    program: &'static Program,
    is_loss_term: bool,
}

/// Every law that was read.
static READ: Mutex<Vec<(Law, &'static OwnLaw)>> = Mutex::new(vec![]);

/// The laws of a model, in the order of the file.
///
/// # Errors
/// [`EffectError`] for a law with the name of a kind of the catalogue, a force that is in proportion to no parameter, and one
/// that is not finite at rest.
pub fn own_laws(model: &Model) -> Result<Vec<&'static dyn Effect>, EffectError> {
    let laws = model.laws.iter();
    laws.map(|law| effect_of(law).map(|effect| effect as &dyn Effect))
        .collect()
}

/// Every effect that a model may have: the catalogue, and after it the laws of the model. None of these where
/// [`own_laws`] refuses one.
///
/// ```
/// use simgap_effects::{catalogue, catalogue_of};
/// use simgap_model::{Law, LawParameter, Model};
///
/// let law = Law {
///     name: "grease".into(),
///     summary: None,
///     between: vec![],
///     force: "c * tanh(v / v0)".into(),
///     parameters: vec![
///         LawParameter::of_size("c", "N", 20.0),
///         LawParameter::of_size("v0", "m/s", 0.05),
///     ],
/// };
/// let model = Model { laws: vec![law], ..Model::default() };
/// let all = catalogue_of(&model);
/// assert_eq!(all.len(), catalogue().len() + 1);
/// assert_eq!(all[catalogue().len()].kind(), "grease");
/// ```
#[must_use]
pub fn catalogue_of(model: &Model) -> Vec<&'static dyn Effect> {
    let mut all = catalogue().to_vec();
    all.extend(own_laws(model).unwrap_or_default());
    all
}

/// The effect of a name in a model: of the catalogue, or a law of the model.
#[must_use]
pub fn find_of(model: &Model, kind: &str) -> Option<&'static dyn Effect> {
    let mut all = catalogue_of(model).into_iter();
    all.find(|effect| effect.kind() == kind)
}

/// The effect of a name that a model file may hold at a place: one of [`find_of`], or a free law.
#[must_use]
pub fn find_in(model: &Model, kind: &str, at: &Location) -> Option<&'static dyn Effect> {
    find_law(kind, at).or_else(|| find_of(model, kind))
}

/// The law as an effect, made when it is first met.
fn effect_of(law: &Law) -> Result<&'static OwnLaw, EffectError> {
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, known)) = read.iter().find(|(known, _)| known == law) {
        return Ok(known);
    }
    let made: &'static OwnLaw = Box::leak(Box::new(OwnLaw::of(law)?));
    read.push((law.clone(), made));
    Ok(made)
}

/// A text that lives as long as the process.
fn kept(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

/// The value of a parameter `spreads` standard deviations of its prior from its usual value, not zero where that can be.
fn value(known: Known, [lower, upper]: [f64; 2], spreads: f64) -> f64 {
    let value = match known {
        Known::Usual(usual) => usual * (SIZE_LOG_STD * spreads).exp(),
        Known::Value { mean, std } => mean + spreads * std,
        Known::Range => {
            let share = match spreads {
                s if s < 0.0 => WITHIN[1],
                s if s > 0.0 => WITHIN[2],
                _ => WITHIN[0],
            };
            let value = lower + share * (upper - lower);
            // A fit takes the scale of a value from where it starts.
            if value == 0.0 {
                0.25 * (upper - lower)
            } else {
                value
            }
        }
    };
    value.clamp(lower, upper)
}

impl OwnLaw {
    fn of(law: &Law) -> Result<OwnLaw, EffectError> {
        let of_law = |found: String, needed: &'static str| EffectError::Law {
            law: law.name.clone(),
            found,
            needed,
        };
        // At a place of no kind a free law is met by its name.
        if find_law(&law.name, &Location::Mass(String::new())).is_some() {
            return Err(of_law(
                "the name of a kind of the catalogue".into(),
                "another name",
            ));
        }
        let count = law.parameters.len();
        if count > MOST_PARAMETERS {
            return Err(of_law(format!("{count} parameters"), "at the most 8"));
        }
        let expression = law.expression()?;
        let sizes = sizes(&expression, count).ok_or_else(|| {
            of_law(
                "a force that is in proportion to none of its parameters".into(),
                "a parameter that scales the whole force, such as c in c * tanh(v / v0)",
            )
        })?;
        let program = Program::of(&expression);
        let usual = law.parameters.iter();
        let usual = usual.map(|one| value(one.known(), one.range(), 0.0));
        let usual: Vec<f64> = usual.collect();
        for displacement in ABOUT_REST {
            for velocity in ABOUT_REST {
                let force = program.force(&usual, [displacement, velocity, 0.0]);
                if !force.is_finite() {
                    return Err(of_law(
                        format!(
                            "a force of {force} at d = {displacement} and v = {velocity} with the usual values of its parameters"
                        ),
                        "a finite force about rest",
                    ));
                }
            }
        }
        let reads_only_velocity = !reads(&expression, &|symbol| {
            matches!(symbol, Symbol::Displacement | Symbol::Time)
        });
        let opposes = |v: f64| program.force(&usual, [0.0, v, 0.0]) * v > 0.0;
        let is_positive = law.parameters.iter().all(|one| one.range()[0] >= 0.0);
        let is_loss_term =
            count == 1 && is_positive && reads_only_velocity && opposes(1.0) && opposes(-1.0);
        let parameters = law.parameters.iter().enumerate().map(|(place, one)| {
            let [lower, upper] = one.range();
            let (name, unit) = (kept(&one.name), kept(&one.unit));
            match sizes.contains(&place) {
                true => Parameter::size(name, unit, lower, upper),
                false => Parameter::shape(name, unit, lower, upper),
            }
        });
        let places = law.between.iter().cloned().map(Location::Between);
        Ok(OwnLaw {
            kind: kept(&law.name),
            summary: kept(law.summary.as_deref().unwrap_or("a law of the model file")),
            equation: kept(&format!("F = {}", law.force.trim())),
            parameters: Box::leak(parameters.collect()),
            known: law.parameters.iter().map(LawParameter::known).collect(),
            places: places.collect(),
            program: Box::leak(Box::new(program)),
            is_loss_term,
        })
    }

    fn value(&self, place: usize, spreads: f64) -> f64 {
        let Parameter { lower, upper, .. } = self.parameters[place];
        value(self.known[place], [lower, upper], spreads)
    }

    /// Values whose force is visible at a place: the sizes of which no value is stated are scaled for that.
    fn made_visible(&self, mut values: Vec<f64>, scale: &SiteScale) -> Vec<f64> {
        let [low, high] = scale.displacement_range_m;
        let mut largest = 0.0_f64;
        for displacement in [low, 0.0, high] {
            for speed in [-1.4, -0.7, 0.0, 0.7, 1.4] {
                for time in [0.0, 0.3, 0.7] {
                    let motion = [
                        displacement,
                        speed * scale.velocity_m_per_s,
                        time * scale.duration_s,
                    ];
                    let force = self.program.force(&values, motion);
                    largest = largest.max(force.abs());
                }
            }
        }
        let factor = START * scale.force_n / largest;
        if factor > 0.0 && factor.is_finite() {
            for (place, parameter) in self.parameters.iter().enumerate() {
                let is_stated = matches!(self.known[place], Known::Value { .. });
                if parameter.neutral.is_some() && !is_stated {
                    values[place] *= factor;
                }
            }
        }
        self.make_physical(&mut values);
        values
    }
}

impl Effect for OwnLaw {
    fn kind(&self) -> &'static str {
        self.kind
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn stated_places(&self) -> &[Location] {
        &self.places
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn equation(&self) -> &'static str {
        self.equation
    }

    fn parameters(&self) -> &'static [Parameter] {
        self.parameters
    }

    fn names_hold_units(&self) -> bool {
        false
    }

    /// The usual shape, and each value of the shape one standard deviation of its prior to either side; all visible.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let usual: Vec<f64> = (0..self.known.len()).map(|k| self.value(k, 0.0)).collect();
        let mut starts = vec![usual.clone()];
        for (place, parameter) in self.parameters.iter().enumerate() {
            let moved = [-1.0, 1.0].map(|spreads| self.value(place, spreads));
            for value in moved.into_iter().filter(|_| parameter.neutral.is_none()) {
                let mut start = usual.clone();
                start[place] = value;
                starts.push(start);
            }
        }
        let visible = starts
            .into_iter()
            .map(|start| self.made_visible(start, scale));
        visible.collect()
    }

    /// As the model file states them.
    fn usual(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![(0..self.known.len()).map(|k| self.value(k, 0.0)).collect()]
    }

    /// As the model file states it, whatever moves at the place.
    fn prior(&self, place: usize, _: &SiteScale) -> Prior {
        let Parameter { lower, upper, .. } = self.parameters[place];
        match self.known[place] {
            Known::Usual(usual) => Prior::size(usual.abs()),
            Known::Value { mean, std } => Prior::Normal { mean, std },
            Known::Range => Prior::Uniform {
                width: upper - lower,
            },
        }
    }

    fn is_loss_term(&self) -> bool {
        self.is_loss_term
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(self.program.with(values)))
    }

    fn experiment(&self) -> &'static str {
        "the same motion at a third and at three times the amplitude, and at a third and at three times the speed: the force \
         has to follow the law in each"
    }
}
