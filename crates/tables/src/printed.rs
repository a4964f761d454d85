//! A number as the paper prints it.

use std::fmt;

use crate::TableError;

/// A unit the paper prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// 1, no unit.
    One,
    /// Hz.
    Hertz,
    /// N.
    Newton,
    /// N/m.
    NewtonPerMetre,
    /// The paper's "ton" or "tons", 1000 kg.
    Ton,
    /// mm.
    Millimetre,
    /// s.
    Second,
}

impl Unit {
    /// Reads the symbol used in the fixtures; `None` for a unit the paper does not use.
    #[must_use]
    pub fn from_symbol(symbol: &str) -> Option<Self> {
        Some(match symbol {
            "1" => Self::One,
            "Hz" => Self::Hertz,
            "N" => Self::Newton,
            "N/m" => Self::NewtonPerMetre,
            "ton" => Self::Ton,
            "mm" => Self::Millimetre,
            "s" => Self::Second,
            _ => return None,
        })
    }

    /// Symbol as in the fixtures.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::Hertz => "Hz",
            Self::Newton => "N",
            Self::NewtonPerMetre => "N/m",
            Self::Ton => "ton",
            Self::Millimetre => "mm",
            Self::Second => "s",
        }
    }

    /// How many SI units one printed unit is: kg per ton, m per mm, 1 for the others.
    #[must_use]
    pub fn si_factor(self) -> f64 {
        match self {
            Self::Ton => 1e3,
            Self::Millimetre => 1e-3,
            Self::One | Self::Hertz | Self::Newton | Self::NewtonPerMetre | Self::Second => 1.0,
        }
    }
}

/// Where a number stands in the paper. The text at hand has no page numbers; sections are given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A cell of a table.
    Table {
        /// Table number.
        table: u8,
        /// Section that discusses the table.
        section: String,
        /// Row label.
        row: String,
        /// Column label.
        column: String,
    },
    /// A statement in the text.
    Text {
        /// Section.
        section: String,
        /// What the statement is about.
        meaning: String,
    },
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table {
                table,
                section,
                row,
                column,
            } => {
                write!(
                    f,
                    "Table {table}, row {row}, column {column} (section {section})"
                )
            }
            Self::Text { section, meaning } => write!(f, "section {section}: {meaning}"),
        }
    }
}

/// One number: the string as printed, its value in the printed unit, and its source.
#[derive(Debug, Clone, PartialEq)]
pub struct PrintedValue {
    printed: String,
    value: f64,
    unit: Unit,
    source: Source,
}

impl PrintedValue {
    /// Reads the digits of `printed`; commas group thousands.
    ///
    /// # Errors
    /// [`TableError::NotANumber`] if they are not a finite number.
    pub fn new(printed: &str, unit: Unit, source: Source) -> Result<Self, TableError> {
        let value = number(printed, &source)?;
        Ok(Self {
            printed: printed.to_owned(),
            value,
            unit,
            source,
        })
    }

    /// The string as printed, every digit and comma.
    #[must_use]
    pub fn printed(&self) -> &str {
        &self.printed
    }

    /// The value in the printed unit.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The value in SI units.
    #[must_use]
    pub fn si(&self) -> f64 {
        self.value * self.unit.si_factor()
    }

    /// The printed unit.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.unit
    }

    /// Where it stands.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }
}

/// A list of spectral lines as printed, such as `1/3/5/7/9/11...`.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicList {
    printed: String,
    lines_hz: Vec<f64>,
    open: bool,
    source: Source,
}

impl HarmonicList {
    /// Reads lines separated by `/`; a trailing `...` means the list goes on.
    ///
    /// # Errors
    /// [`TableError::NotANumber`] if an entry is not a finite number.
    pub fn new(printed: &str, source: Source) -> Result<Self, TableError> {
        let text = printed.trim_end();
        let open = text.ends_with("...");
        let lines_hz = text
            .trim_end_matches('.')
            .split('/')
            .map(|entry| number(entry.trim(), &source))
            .collect::<Result<Vec<f64>, TableError>>()?;
        Ok(Self {
            printed: printed.to_owned(),
            lines_hz,
            open,
            source,
        })
    }

    /// The string as printed.
    #[must_use]
    pub fn printed(&self) -> &str {
        &self.printed
    }

    /// The lines printed, Hz.
    #[must_use]
    pub fn lines_hz(&self) -> &[f64] {
        &self.lines_hz
    }

    /// Whether the paper lets the list go on.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        self.open
    }

    /// Where it stands.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }
}

fn number(printed: &str, source: &Source) -> Result<f64, TableError> {
    printed
        .replace(',', "")
        .parse::<f64>()
        .ok()
        .filter(|value| value.is_finite())
        .ok_or_else(|| TableError::NotANumber {
            place: source.to_string(),
            printed: printed.to_owned(),
        })
}
