//! Values stated in the text, outside the tables.

use serde::Deserialize;

use crate::{PrintedValue, Source, TableError, Unit};

pub(crate) const STATED: &str = include_str!("../fixtures/stated.toml");
const FILE: &str = "stated.toml";
const SCHEMA: &str = "simgap-paper-stated/1";

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawStated {
    schema: String,
    values: Vec<RawValue>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawValue {
    name: String,
    section: String,
    unit: String,
    printed: String,
    meaning: String,
}

/// A value named in the fixture.
#[derive(Debug, Clone, PartialEq)]
pub struct StatedValue {
    /// Name in the fixture, such as `first_natural_freq`.
    pub name: String,
    /// The value.
    pub value: PrintedValue,
}

/// The two lines of the 2-DOF model that section 3.2 states for one excitation.
#[derive(Debug, Clone, PartialEq)]
pub struct StatedLines {
    /// Excitation, Hz.
    pub excitation_hz: f64,
    /// Lower line, 50 − f.
    pub lower: PrintedValue,
    /// Upper line, 50 + f.
    pub upper: PrintedValue,
}

/// Excitations for which section 3.2 states lines, Hz.
const LINES_OF: [u8; 6] = [1, 2, 3, 4, 5, 6];

/// Values the text states. The fields are those other crates use; [`Self::all`] has every one.
#[derive(Debug, Clone, PartialEq)]
pub struct StatedValues {
    /// First natural frequency in the pressure spectrum, 2.499 Hz.
    pub first_natural_freq: PrintedValue,
    /// Weight equivalent of the centre value a₀, 1.0355 ton.
    pub weight_equivalent: PrintedValue,
    /// Amplitude of the sine sweep, 2 mm.
    pub amplitude: PrintedValue,
    /// Sampling step, 0.01 s.
    pub time_step: PrintedValue,
    /// Moving mass m₁, 33 ton.
    pub mold_mass: PrintedValue,
    /// Support mass m₂, 7 ton.
    pub support_mass: PrintedValue,
    /// The 50 Hz of "50 − f".
    pub image_base: PrintedValue,
    /// Beat period at 1 Hz, 0.5 s.
    pub beat_period: PrintedValue,
    /// Torsional mode blamed for 5 Hz.
    pub torsional_mode: PrintedValue,
    /// Leaf-spring modes of the finite element model, near 47 Hz.
    pub leaf_modes: PrintedValue,
    /// Lines of the 2-DOF model, for 1 to 6 Hz (Fig. 15 and its text).
    pub lines: Vec<StatedLines>,
    all: Vec<StatedValue>,
}

impl StatedValues {
    /// Every value of the fixture, in its order.
    #[must_use]
    pub fn all(&self) -> &[StatedValue] {
        &self.all
    }

    /// Reads the values from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which value is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let raw: RawStated = toml::from_str(text).map_err(|error| TableError::Layout {
            file: file.to_owned(),
            reason: error.message().to_owned(),
        })?;
        if raw.schema != SCHEMA {
            return Err(TableError::Schema {
                file: file.to_owned(),
                found: raw.schema,
                needed: SCHEMA,
            });
        }
        let all = raw
            .values
            .into_iter()
            .map(read)
            .collect::<Result<Vec<_>, _>>()?;
        let find = |name: &str| {
            let mut named = all.iter().filter(|value| value.name == name);
            let first = named.next().ok_or_else(|| TableError::Missing {
                file: file.to_owned(),
                place: name.to_owned(),
            })?;
            match named.next() {
                None => Ok(first.value.clone()),
                Some(_) => Err(TableError::Duplicate {
                    file: file.to_owned(),
                    place: name.to_owned(),
                }),
            }
        };
        let lines = LINES_OF.iter().map(|hz| {
            Ok(StatedLines {
                excitation_hz: f64::from(*hz),
                lower: find(&format!("lower_line_{hz}hz"))?,
                upper: find(&format!("upper_line_{hz}hz"))?,
            })
        });
        Ok(Self {
            lines: lines.collect::<Result<_, TableError>>()?,
            first_natural_freq: find("first_natural_freq")?,
            weight_equivalent: find("weight_equivalent")?,
            amplitude: find("amplitude")?,
            time_step: find("time_step")?,
            mold_mass: find("m1")?,
            support_mass: find("m2")?,
            image_base: find("image_base")?,
            beat_period: find("beat_period")?,
            torsional_mode: find("torsional_mode")?,
            leaf_modes: find("leaf_modes")?,
            all,
        })
    }
}

fn read(raw: RawValue) -> Result<StatedValue, TableError> {
    let source = Source::Text {
        section: raw.section,
        meaning: raw.meaning,
    };
    let unit = Unit::from_symbol(&raw.unit).ok_or_else(|| TableError::Unit {
        place: source.to_string(),
        unit: raw.unit.clone(),
    })?;
    let value = PrintedValue::new(&raw.printed, unit, source)?;
    Ok(StatedValue {
        name: raw.name,
        value,
    })
}

/// Reads the stated values from the embedded fixture.
///
/// ```
/// let stated = simgap_tables::stated_values()?;
/// assert_eq!(stated.first_natural_freq.si(), 2.499);
/// assert_eq!(stated.amplitude.si(), 0.002);
/// # Ok::<(), simgap_tables::TableError>(())
/// ```
///
/// # Errors
/// A [`TableError`] if the fixture was damaged.
pub fn stated_values() -> Result<StatedValues, TableError> {
    StatedValues::parse(FILE, STATED)
}
