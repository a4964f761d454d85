//! Units of channels.

use std::f64::consts::PI;
use std::fmt;

/// Standard acceleration of gravity, m/s^2 (CGPM 1901; exact by definition).
const STANDARD_GRAVITY: f64 = 9.806_65;
/// International avoirdupois pound, kg (1959 agreement; exact by definition).
const POUND_KG: f64 = 0.453_592_37;
/// International inch, m (1959 agreement; exact by definition).
const INCH_M: f64 = 0.0254;

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UnitKind {
    /// Time; SI unit s.
    Time,
    /// Length; SI unit m.
    Length,
    /// Angle; SI unit rad.
    Angle,
    /// Velocity; SI unit m/s.
    Velocity,
    /// Angular velocity; SI unit rad/s.
    AngularVelocity,
    /// Acceleration; SI unit m/s^2.
    Acceleration,
    /// Angular acceleration; SI unit rad/s^2.
    AngularAcceleration,
    /// Force; SI unit N.
    Force,
    /// Torque; SI unit N m.
    Torque,
    /// Pressure; SI unit Pa.
    Pressure,
    /// Volume flow; SI unit m^3/s.
    Flow,
    /// Anything else (V, A, %, ...). No quantity of a model: such a channel needs a gain.
    Other,
}

impl UnitKind {
    /// Symbol of the SI unit of this kind, empty for [`UnitKind::Other`].
    #[must_use]
    pub fn si_symbol(self) -> &'static str {
        match self {
            UnitKind::Time => "s",
            UnitKind::Length => "m",
            UnitKind::Angle => "rad",
            UnitKind::Velocity => "m/s",
            UnitKind::AngularVelocity => "rad/s",
            UnitKind::Acceleration => "m/s^2",
            UnitKind::AngularAcceleration => "rad/s^2",
            UnitKind::Force => "N",
            UnitKind::Torque => "N m",
            UnitKind::Pressure => "Pa",
            UnitKind::Flow => "m^3/s",
            UnitKind::Other => "",
        }
    }
}

impl fmt::Display for UnitKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            UnitKind::Time => "a time",
            UnitKind::Length => "a length",
            UnitKind::Angle => "an angle",
            UnitKind::Velocity => "a velocity",
            UnitKind::AngularVelocity => "an angular velocity",
            UnitKind::Acceleration => "an acceleration",
            UnitKind::AngularAcceleration => "an angular acceleration",
            UnitKind::Force => "a force",
            UnitKind::Torque => "a torque",
            UnitKind::Pressure => "a pressure",
            UnitKind::Flow => "a flow",
            UnitKind::Other => "neither a motion nor a force",
        })
    }
}

/// A unit as written in a header: symbol, kind and factor to SI.
///
/// ```
/// use simgap_record::{Quantity, Unit, UnitKind};
///
/// let unit = Unit::parse("mm/s²");
/// assert_eq!(unit.kind(), UnitKind::Acceleration);
/// assert_eq!(unit.to_si(250.0), 0.25);
/// assert!(Quantity::Acceleration.accepts(unit.kind()));
/// assert_eq!(Unit::parse("V").kind(), UnitKind::Other);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    symbol: String,
    kind: UnitKind,
    si_factor: f64,
}

impl Unit {
    /// Reads a unit symbol. Never fails: what is not in the list is [`UnitKind::Other`] with
    /// factor 1, and is refused only where a quantity is asked for.
    ///
    /// Case counts (`mN` is not `MN`). Spaces, product signs and `^` do not: `N m`, `Nm`, `N*m`
    /// and `N·m` are one unit, as are `m/s^2`, `m/s2` and `m/s²`.
    #[must_use]
    pub fn parse(symbol: &str) -> Unit {
        let symbol = symbol.trim();
        let (kind, si_factor) = lookup(&normalised(symbol)).unwrap_or((UnitKind::Other, 1.0));
        Unit {
            symbol: symbol.to_owned(),
            kind,
            si_factor,
        }
    }

    /// The symbol as written.
    #[must_use]
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// What the unit measures.
    #[must_use]
    pub fn kind(&self) -> UnitKind {
        self.kind
    }

    /// Whether another unit measures the same: it is of this kind or, where the kind is none of those known, the same symbol.
    ///
    /// ```
    /// use simgap_record::Unit;
    /// let of = |one: &str, other: &str| Unit::parse(one).measures_as(&Unit::parse(other));
    /// assert!(of("mm", "m") && of("V", "V"));
    /// assert!(!of("mm", "deg") && !of("V", "mV"));
    /// ```
    #[must_use]
    pub fn measures_as(&self, other: &Unit) -> bool {
        self.kind == other.kind && (self.kind != UnitKind::Other || self.symbol == other.symbol)
    }

    /// SI units per unit; 1 for [`UnitKind::Other`].
    #[must_use]
    pub fn si_factor(&self) -> f64 {
        self.si_factor
    }

    /// One value in SI units.
    ///
    /// Divides where the inverse factor is a whole number: one rounding instead of two (10^-3 is
    /// not a double, 10^3 is), so that 9 mm becomes the double nearest to 0.009.
    #[must_use]
    pub fn to_si(&self, value: f64) -> f64 {
        match whole_inverse(self.si_factor) {
            Some(inverse) => value / inverse,
            None => value * self.si_factor,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.symbol)
    }
}

/// The whole number whose reciprocal is the factor, for factors below one.
fn whole_inverse(factor: f64) -> Option<f64> {
    let inverse = (1.0 / factor).round();
    (factor < 1.0 && 1.0 / inverse == factor).then_some(inverse)
}

/// One spelling for the many ways to write the same unit.
fn normalised(symbol: &str) -> String {
    symbol
        .chars()
        .filter(|c| !c.is_whitespace() && !matches!(c, '*' | '·' | '⋅' | '.' | '^'))
        .map(|c| match c {
            'µ' | 'μ' => 'u',
            '²' => '2',
            'º' => '°',
            other => other,
        })
        .collect()
}

fn lookup(symbol: &str) -> Option<(UnitKind, f64)> {
    time(symbol)
        .or_else(|| translation(symbol))
        .or_else(|| rotation(symbol))
        .or_else(|| load(symbol))
}

fn time(symbol: &str) -> Option<(UnitKind, f64)> {
    let factor = match symbol {
        "s" | "sec" | "S" | "Sec" => 1.0,
        "ms" | "msec" => 1e-3,
        "us" | "usec" => 1e-6,
        "ns" | "nsec" => 1e-9,
        "min" => 60.0,
        "h" => 3600.0,
        "d" => 86_400.0,
        word => match word.to_ascii_lowercase().as_str() {
            "second" | "seconds" | "sekunde" | "sekunden" => 1.0,
            "millisecond" | "milliseconds" => 1e-3,
            "microsecond" | "microseconds" => 1e-6,
            "minute" | "minutes" => 60.0,
            "hour" | "hours" => 3600.0,
            "day" | "days" => 86_400.0,
            _ => return None,
        },
    };
    Some((UnitKind::Time, factor))
}

fn length(symbol: &str) -> Option<f64> {
    Some(match symbol {
        "m" => 1.0,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "um" => 1e-6,
        "nm" => 1e-9,
        "km" => 1e3,
        "in" => INCH_M,
        "ft" => 12.0 * INCH_M,
        _ => return None,
    })
}

fn translation(symbol: &str) -> Option<(UnitKind, f64)> {
    if let Some(factor) = length(symbol) {
        return Some((UnitKind::Length, factor));
    }
    match symbol {
        "km/h" => return Some((UnitKind::Velocity, 1.0 / 3.6)),
        "g" => return Some((UnitKind::Acceleration, STANDARD_GRAVITY)),
        "mg" => return Some((UnitKind::Acceleration, 1e-3 * STANDARD_GRAVITY)),
        "ug" => return Some((UnitKind::Acceleration, 1e-6 * STANDARD_GRAVITY)),
        "gal" | "Gal" => return Some((UnitKind::Acceleration, 1e-2)),
        _ => {}
    }
    per_second(symbol, length, UnitKind::Velocity, UnitKind::Acceleration)
}

fn angle(symbol: &str) -> Option<f64> {
    Some(match symbol {
        "rad" => 1.0,
        "mrad" => 1e-3,
        "urad" => 1e-6,
        "deg" | "°" => PI / 180.0,
        "rev" => 2.0 * PI,
        _ => return None,
    })
}

fn rotation(symbol: &str) -> Option<(UnitKind, f64)> {
    if let Some(factor) = angle(symbol) {
        return Some((UnitKind::Angle, factor));
    }
    if matches!(symbol, "rpm" | "rev/min" | "r/min") {
        return Some((UnitKind::AngularVelocity, 2.0 * PI / 60.0));
    }
    per_second(
        symbol,
        angle,
        UnitKind::AngularVelocity,
        UnitKind::AngularAcceleration,
    )
}

/// `base/s`, `base/s2` and the same with negative exponents.
fn per_second(
    symbol: &str,
    base: fn(&str) -> Option<f64>,
    once: UnitKind,
    twice: UnitKind,
) -> Option<(UnitKind, f64)> {
    const ENDINGS: [(&str, bool); 7] = [
        ("/s2", true),
        ("/s/s", true),
        ("/(s2)", true),
        ("s-2", true),
        ("/s", false),
        ("/sec", false),
        ("s-1", false),
    ];
    ENDINGS.iter().find_map(|&(ending, squared)| {
        let factor = base(symbol.strip_suffix(ending)?)?;
        Some((if squared { twice } else { once }, factor))
    })
}

fn load(symbol: &str) -> Option<(UnitKind, f64)> {
    let force = |symbol: &str| {
        Some(match symbol {
            "N" => 1.0,
            "mN" => 1e-3,
            "kN" => 1e3,
            "MN" => 1e6,
            "kgf" | "kp" => STANDARD_GRAVITY,
            "lbf" => POUND_KG * STANDARD_GRAVITY,
            _ => return None,
        })
    };
    if let Some(factor) = force(symbol) {
        return Some((UnitKind::Force, factor));
    }
    let flow = match symbol {
        "m^3/s" | "m3/s" => Some(1.0),
        "l/s" | "L/s" => Some(1e-3),
        "l/min" | "L/min" => Some(1e-3 / 60.0),
        _ => None,
    };
    if let Some(factor) = flow {
        return Some((UnitKind::Flow, factor));
    }
    let pressure = match symbol {
        "Pa" => Some(1.0),
        "hPa" | "mbar" => Some(1e2),
        "kPa" => Some(1e3),
        "MPa" => Some(1e6),
        "bar" => Some(1e5),
        "psi" => Some(POUND_KG * STANDARD_GRAVITY / (INCH_M * INCH_M)),
        _ => None,
    };
    if let Some(factor) = pressure {
        return Some((UnitKind::Pressure, factor));
    }
    // Torque is a force times a length in either order of writing (`Nm`, `lbfft`); an energy
    // has the same dimension and is not told apart.
    ["mm", "cm", "m", "in", "ft"].iter().find_map(|&arm| {
        let factor = force(symbol.strip_suffix(arm)?)? * length(arm)?;
        Some((UnitKind::Torque, factor))
    })
}
