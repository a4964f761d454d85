//! What makes a law one that can be evaluated.

use super::expression::FUNCTIONS;
use super::parse::parse;
use super::text::BadExpression;
use super::{Expression, Law, LawParameter};
use crate::refuse::{check_uncertainty, item, unique};
use crate::{Model, ModelError};

/// Names that an expression or an `[[effect]]` has another meaning for.
const TAKEN: [&str; 12] = [
    "d",
    "v",
    "t",
    "pi",
    "min",
    "max",
    "kind",
    "between",
    "mass",
    "input",
    "channel",
    "parameter",
];

impl Law {
    /// The expression of the force as a tree; its parameters are places in [`Law::parameters`].
    ///
    /// # Errors
    /// [`ModelError::Shape`] with the character of the text, from 1, at which it is no expression of the parameters; other
    /// variants for names, units and priors of parameters that cannot be.
    pub fn expression(&self) -> Result<Expression, ModelError> {
        self.check_names()?;
        self.parsed().map_err(|bad| ModelError::Shape {
            place: format!("{}: force, character {}", self.place(), bad.character),
            found: bad.found,
            needed: bad.needed,
        })
    }

    pub(super) fn parsed(&self) -> Result<Expression, BadExpression> {
        let names = self.parameters.iter().map(|one| one.name.as_str());
        parse(&self.force, &names.collect::<Vec<_>>())
    }

    /// Table and item, as messages name it.
    pub(super) fn place(&self) -> String {
        item("law", &self.name)
    }

    pub(super) fn check_names(&self) -> Result<(), ModelError> {
        let is_of_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let begins = self.name.starts_with(|c: char| c.is_ascii_lowercase());
        if !(begins && self.name.chars().all(is_of_name)) {
            return Err(ModelError::BadName {
                place: self.place(),
                found: self.name.clone(),
                needed: "needed is a lower-case letter, then lower-case letters, digits and _",
            });
        }
        if self.parameters.is_empty() {
            return Err(ModelError::Shape {
                place: self.place(),
                found: "no [[law.parameter]]".into(),
                needed: "at least one parameter to fit".into(),
            });
        }
        for (place, one) in self.parameters.iter().enumerate() {
            one.check(self)?;
            if self.parameters[..place]
                .iter()
                .any(|other| other.name == one.name)
            {
                return Err(ModelError::DuplicateName {
                    place: one.place(self),
                });
            }
        }
        Ok(())
    }

    fn check(&self, model: &Model) -> Result<(), ModelError> {
        self.expression()?;
        self.between
            .iter()
            .try_for_each(|pair| model.check_pair(pair, &self.place()))
    }
}

impl LawParameter {
    fn place(&self, law: &Law) -> String {
        format!("{} parameter \"{}\"", law.place(), self.name)
    }

    fn check(&self, law: &Law) -> Result<(), ModelError> {
        let place = self.place(law);
        let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = self.name.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_taken = TAKEN.contains(&self.name.as_str());
        if is_taken || FUNCTIONS.contains(&self.name.as_str()) {
            return Err(ModelError::BadName {
                place,
                found: self.name.clone(),
                needed: "it has a meaning of its own in a force or in an [[effect]]",
            });
        }
        if !(begins && self.name.chars().all(is_of_name)) {
            return Err(ModelError::BadName {
                place,
                found: self.name.clone(),
                needed: "needed is a letter, then letters, digits and _",
            });
        }
        if self.unit.trim().is_empty() {
            return Err(ModelError::Shape {
                place,
                found: "an empty unit".into(),
                needed: "the unit of the value, \"1\" for a pure number".into(),
            });
        }
        self.check_known(&place)
    }

    fn check_known(&self, place: &str) -> Result<(), ModelError> {
        let has = |key: &Option<f64>| key.is_some();
        let keys = [
            ("usual", has(&self.usual)),
            ("value", has(&self.value)),
            ("uncertainty", has(&self.uncertainty)),
            ("lower", has(&self.lower)),
            ("upper", has(&self.upper)),
        ];
        let is_known = match (self.usual, self.value, self.uncertainty) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => true,
            (None, None, None) => has(&self.lower) && has(&self.upper),
            _ => false,
        };
        if !is_known {
            let given = keys.iter().filter(|(_, given)| *given);
            let given: Vec<&str> = given.map(|(key, _)| *key).collect();
            return Err(ModelError::Shape {
                place: place.into(),
                found: match given.is_empty() {
                    true => "nothing of what is known of it".into(),
                    false => given.join(" and "),
                },
                needed: "usual, or value and uncertainty, or lower and upper".into(),
            });
        }
        let value = |quantity: &str, found: f64, needed: &'static str| ModelError::Value {
            place: place.into(),
            quantity: quantity.into(),
            found,
            needed,
        };
        check_uncertainty(place, self.uncertainty)?;
        let centres = [("usual", self.usual), ("value", self.value)];
        for (quantity, centre) in centres {
            if let Some(centre) = centre.filter(|c| !c.is_finite() || *c == 0.0) {
                return Err(value(quantity, centre, "a finite number that is not zero"));
            }
        }
        let [lower, upper] = self.range();
        // Not a number is below nothing.
        let is_ordered = lower < upper;
        if !is_ordered {
            return Err(value("lower", lower, "a number below upper"));
        }
        let is_bounded = lower.is_finite() && upper.is_finite();
        if self.usual.or(self.value).is_none() && !is_bounded {
            let (quantity, found) = match lower.is_finite() {
                true => ("upper", upper),
                false => ("lower", lower),
            };
            return Err(value(quantity, found, "a finite number"));
        }
        for (quantity, centre) in centres {
            if let Some(centre) = centre.filter(|c| !(lower..=upper).contains(c)) {
                return Err(value(quantity, centre, "a value between lower and upper"));
            }
        }
        Ok(())
    }
}

impl Model {
    /// The law of a name.
    #[must_use]
    pub fn law(&self, name: &str) -> Option<&Law> {
        self.laws.iter().find(|law| law.name == name)
    }

    pub(crate) fn check_laws(&self) -> Result<(), ModelError> {
        unique("law", self.laws.iter().map(|law| law.name.as_str()))?;
        self.laws.iter().try_for_each(|law| law.check(self))
    }
}
