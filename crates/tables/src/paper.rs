//! Tables 1-5, typed.

use crate::raw::Cells;
use crate::{HarmonicList, PrintedValue, TableError};

pub(crate) const TABLE1: &str = include_str!("../fixtures/table1.toml");
pub(crate) const TABLE2: &str = include_str!("../fixtures/table2.toml");
pub(crate) const TABLE3: &str = include_str!("../fixtures/table3.toml");
pub(crate) const TABLE4: &str = include_str!("../fixtures/table4.toml");
pub(crate) const TABLE5: &str = include_str!("../fixtures/table5.toml");

/// Table 1, mold oscillator configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Table1 {
    /// M, ton.
    pub mass: PrintedValue,
    /// ζ, 1.
    pub damping_ratio: PrintedValue,
    /// K, N/m.
    pub stiffness: PrintedValue,
}

/// One row of Table 2: lines found in the spectra of one excitation.
#[derive(Debug, Clone, PartialEq)]
pub struct LineRow {
    /// Excitation frequency, Hz.
    pub excitation: PrintedValue,
    /// Lines of the pressure, Hz.
    pub pressure: HarmonicList,
    /// High line of the pressure, Hz; the paper prints a point (none) in every row.
    pub pressure_high: Option<PrintedValue>,
    /// Lines of the displacement, Hz.
    pub displacement: HarmonicList,
    /// High line of the displacement, Hz.
    pub displacement_high: Option<PrintedValue>,
}

/// Table 2, FFT of the pressure and displacement.
#[derive(Debug, Clone, PartialEq)]
pub struct Table2 {
    /// One row per excitation, 1 to 7 Hz.
    pub rows: Vec<LineRow>,
}

/// One row of Table 3: Fourier part of the unknown force.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierRow {
    /// Excitation frequency, Hz.
    pub excitation: PrintedValue,
    /// a₀, N.
    pub centre: PrintedValue,
    /// max(f) − min(f), N.
    pub peak_to_peak: PrintedValue,
    /// ω, Hz.
    pub base: PrintedValue,
}

/// Table 3, Fourier series for the unknown force.
#[derive(Debug, Clone, PartialEq)]
pub struct Table3 {
    /// One row per excitation, 1 to 6 Hz.
    pub rows: Vec<FourierRow>,
}

/// One row of Table 4: beat part of the unknown force, F₀ cos(δt/2) cos((ω+δ)t/2).
#[derive(Debug, Clone, PartialEq)]
pub struct BeatRow {
    /// Excitation frequency, Hz.
    pub excitation: PrintedValue,
    /// F₀, N.
    pub amplitude: PrintedValue,
    /// ω, Hz.
    pub base: PrintedValue,
    /// δ, Hz.
    pub split: PrintedValue,
}

/// Table 4, beat function for the unknown force.
#[derive(Debug, Clone, PartialEq)]
pub struct Table4 {
    /// One row per excitation, 1 to 6 Hz.
    pub rows: Vec<BeatRow>,
}

/// One row of Table 5: stiffnesses of the two-mass model for one excitation.
#[derive(Debug, Clone, PartialEq)]
pub struct StiffnessRow {
    /// Excitation frequency, Hz.
    pub excitation: PrintedValue,
    /// k_leaf, N/m.
    pub leaf_stiffness: PrintedValue,
    /// k₂ (k₃ in Eq. (4)), N/m.
    pub support_stiffness: PrintedValue,
}

/// Table 5, leaf spring stiffness and internal deformation stiffness.
#[derive(Debug, Clone, PartialEq)]
pub struct Table5 {
    /// k₁, N/m, printed once for all rows.
    pub mold_stiffness: PrintedValue,
    /// One row per excitation, 1 to 6 Hz.
    pub rows: Vec<StiffnessRow>,
}

macro_rules! embedded {
    ($function:ident, $table:ident, $text:ident, $file:literal, $title:literal) => {
        #[doc = concat!("Reads ", $title, " from the embedded fixture.\n\n# Errors\n",
                                                "A [`TableError`] if the fixture was damaged.")]
        pub fn $function() -> Result<$table, TableError> {
            $table::parse($file, $text)
        }
    };
}

embedded!(table1, Table1, TABLE1, "table1.toml", "Table 1");
embedded!(table2, Table2, TABLE2, "table2.toml", "Table 2");
embedded!(table3, Table3, TABLE3, "table3.toml", "Table 3");
embedded!(table4, Table4, TABLE4, "table4.toml", "Table 4");
embedded!(table5, Table5, TABLE5, "table5.toml", "Table 5");

impl Table1 {
    /// Reads the table from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which cell is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let cells = Cells::parse(file, 1, text)?;
        Ok(Self {
            mass: cells.value("M: Mass", "Value")?,
            damping_ratio: cells.value("zeta: Damping ratio", "Value")?,
            stiffness: cells.value("K: Total stiffness", "Value")?,
        })
    }
}

/// Builds one value per row label.
fn rows<T>(
    cells: &Cells,
    build: impl Fn(&str) -> Result<T, TableError>,
) -> Result<Vec<T>, TableError> {
    cells
        .row_labels()
        .iter()
        .map(|label| build(label))
        .collect()
}

impl Table2 {
    /// Reads the table from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which cell is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let cells = Cells::parse(file, 2, text)?;
        let rows = rows(&cells, |row| {
            Ok(LineRow {
                excitation: cells.value(row, "Excitation frequency")?,
                pressure: cells.harmonics(row, "Pressure, excitation and harmonic terms")?,
                pressure_high: cells.value_or_point(row, "Pressure, high")?,
                displacement: cells
                    .harmonics(row, "Displacement, excitation and harmonic terms")?,
                displacement_high: cells.value_or_point(row, "Displacement, high")?,
            })
        })?;
        Ok(Self { rows })
    }
}

impl Table3 {
    /// Reads the table from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which cell is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let cells = Cells::parse(file, 3, text)?;
        let rows = rows(&cells, |row| {
            Ok(FourierRow {
                excitation: cells.value(row, "Frequency")?,
                centre: cells.value(row, "a0")?,
                peak_to_peak: cells.value(row, "max(f) - min(f)")?,
                base: cells.value(row, "omega")?,
            })
        })?;
        Ok(Self { rows })
    }
}

impl Table4 {
    /// Reads the table from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which cell is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let cells = Cells::parse(file, 4, text)?;
        let rows = rows(&cells, |row| {
            Ok(BeatRow {
                excitation: cells.value(row, "Frequency")?,
                amplitude: cells.value(row, "F0")?,
                base: cells.value(row, "omega")?,
                split: cells.value(row, "delta")?,
            })
        })?;
        Ok(Self { rows })
    }
}

impl Table5 {
    /// Reads the table from the text of a fixture; `file` names it in errors.
    ///
    /// # Errors
    /// A [`TableError`] saying which cell is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        let cells = Cells::parse(file, 5, text)?;
        let rows = rows(&cells, |row| {
            Ok(StiffnessRow {
                excitation: cells.value(row, "Frequency")?,
                leaf_stiffness: cells.value(row, "k_leaf")?,
                support_stiffness: cells.value(row, "k2")?,
            })
        })?;
        Ok(Self {
            mold_stiffness: cells.value("all", "k1")?,
            rows,
        })
    }
}
