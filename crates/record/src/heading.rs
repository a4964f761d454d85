//! Name and unit of a column, as its file has them.

use crate::{Unit, UnitKind};

/// A column of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Heading {
    pub(crate) name: String,
    /// Empty if the file has none.
    pub(crate) unit: String,
}

impl Heading {
    /// Control characters become spaces, so that a name never breaks a message.
    pub(crate) fn new(name: &str, unit: &str) -> Heading {
        let plain = |text: &str| text.trim().replace(char::is_control, " ");
        Heading {
            name: plain(name),
            unit: plain(unit),
        }
    }
}

/// `y [mm]`, and where the unit is known also `y (mm)`, `y / mm` and `y in mm`.
pub(crate) fn heading(cell: &str) -> Heading {
    let cell = cell.trim();
    // The time of a Rohde & Schwarz oscilloscope has a unit alone.
    if let Some(unit) = cell.strip_prefix("in ")
        && Unit::parse(unit).kind() == UnitKind::Time
    {
        return Heading::new(cell, unit);
    }
    if let Some((name, unit)) = cell
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once('['))
        && !name.trim().is_empty()
    {
        return Heading::new(name, unit);
    }
    let round = cell
        .strip_suffix(')')
        .and_then(|rest| rest.rsplit_once('('));
    let others = [round, cell.rsplit_once(" / "), cell.rsplit_once(" in ")];
    for (name, unit) in others.into_iter().flatten() {
        if !name.trim().is_empty() && is_unit(unit.trim()) {
            return Heading::new(name, unit);
        }
    }
    Heading::new(cell, "")
}

/// Units of no motion or force that loggers write.
pub(crate) fn is_unit(symbol: &str) -> bool {
    const OTHERS: [&str; 32] = [
        "VDC", "VAC", "Volt", "Volts", "volt", "Amp", "Ampere", "counts", "V", "mV", "uV", "µV",
        "A", "mA", "W", "kW", "%", "°C", "degC", "K", "°F", "Hz", "kHz", "Ohm", "1", "l/min", "kg",
        "kg/s", "J", "µm/m", "um/m", "mV/V",
    ];
    Unit::parse(symbol).kind() != UnitKind::Other || OTHERS.contains(&symbol)
}
