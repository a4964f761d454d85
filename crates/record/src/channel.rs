//! One column of a record.

use std::borrow::Cow;
use std::fmt;

use crate::{Quantity, RecordError, Unit};

/// One measured column: a name, a unit and the values in that unit, as written.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name in the header, without the unit.
    pub name: String,
    /// Unit in the header.
    pub unit: Unit,
    /// Values in that unit, one per time stamp.
    pub values: Vec<f64>,
}

impl Channel {
    /// A channel from its name, the symbol of its unit and its values.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: &str, values: Vec<f64>) -> Channel {
        Channel {
            name: name.into(),
            unit: Unit::parse(unit),
            values,
        }
    }

    /// The values in SI units of the wanted quantity; borrowed when nothing has to be converted.
    ///
    /// # Errors
    ///
    /// [`RecordError::UnitMismatch`] when the unit does not measure that quantity. With a `gain`
    /// in the model, [`Channel::values`] is used as it is instead.
    pub fn si_values(&self, wanted: Quantity) -> Result<Cow<'_, [f64]>, RecordError> {
        if !wanted.accepts(self.unit.kind()) {
            return Err(RecordError::UnitMismatch {
                channel: self.name.clone(),
                unit: self.unit.symbol().to_owned(),
                kind: self.unit.kind(),
                wanted,
            });
        }
        Ok(if self.unit.si_factor() == 1.0 {
            Cow::Borrowed(&self.values)
        } else {
            Cow::Owned(
                self.values
                    .iter()
                    .map(|&value| self.unit.to_si(value))
                    .collect(),
            )
        })
    }

    /// The conversion [`Channel::si_values`] applies; `None` when the unit is SI already or does
    /// not fit the quantity.
    #[must_use]
    pub fn conversion(&self, wanted: Quantity) -> Option<Conversion> {
        if wanted.accepts(self.unit.kind()) {
            Conversion::of(&self.name, &self.unit)
        } else {
            None
        }
    }
}

/// A conversion of a column to SI, for the reader of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// Column that is converted.
    pub channel: String,
    /// Unit symbol in the header.
    pub from: String,
    /// Symbol of the SI unit.
    pub to: &'static str,
    /// SI units per unit of the header.
    pub factor: f64,
}

impl Conversion {
    /// The conversion of a column of that unit to SI; `None` when there is nothing to convert.
    pub(crate) fn of(channel: &str, unit: &Unit) -> Option<Conversion> {
        (unit.si_factor() != 1.0).then(|| Conversion {
            channel: channel.to_owned(),
            from: unit.symbol().to_owned(),
            to: unit.kind().si_symbol(),
            factor: unit.si_factor(),
        })
    }
}

impl fmt::Display for Conversion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Conversion {
            channel,
            from,
            to,
            factor,
        } = self;
        write!(
            f,
            "column '{channel}' converted from {from} to {to}, factor {factor}"
        )
    }
}
