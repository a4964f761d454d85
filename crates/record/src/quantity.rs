//! The quantities that a model asks for.

use std::fmt;

use crate::unit::UnitKind;

/// What a model takes from a channel. A model does not say whether it is translational or
/// rotational, so each quantity accepts the units of both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Length or angle.
    Displacement,
    /// Velocity or angular velocity.
    Velocity,
    /// Acceleration or angular acceleration.
    Acceleration,
    /// Force or torque.
    Force,
    /// Pressure.
    Pressure,
    /// Volume flow.
    Flow,
    /// Angle alone: the roll of a body.
    Angle,
    /// A share of a whole: what has no unit of a motion, a force, a pressure or a flow.
    Share,
    /// A number of any unit but that of a time: a command, a set point.
    Number,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Quantity; 9] = [
        Quantity::Displacement,
        Quantity::Velocity,
        Quantity::Acceleration,
        Quantity::Force,
        Quantity::Pressure,
        Quantity::Flow,
        Quantity::Angle,
        Quantity::Share,
        Quantity::Number,
    ];

    /// The kinds of its units for translation and for rotation; `None` for a number or a share.
    fn kinds(self) -> Option<[UnitKind; 2]> {
        match self {
            Quantity::Displacement => Some([UnitKind::Length, UnitKind::Angle]),
            Quantity::Velocity => Some([UnitKind::Velocity, UnitKind::AngularVelocity]),
            Quantity::Acceleration => Some([UnitKind::Acceleration, UnitKind::AngularAcceleration]),
            Quantity::Force => Some([UnitKind::Force, UnitKind::Torque]),
            Quantity::Pressure => Some([UnitKind::Pressure; 2]),
            Quantity::Flow => Some([UnitKind::Flow; 2]),
            Quantity::Angle => Some([UnitKind::Angle; 2]),
            Quantity::Share | Quantity::Number => None,
        }
    }

    /// Whether a unit of this kind measures the quantity.
    #[must_use]
    pub fn accepts(self, kind: UnitKind) -> bool {
        match self.kinds() {
            Some(kinds) => kinds.contains(&kind),
            None if self == Quantity::Share => kind == UnitKind::Other,
            None => kind != UnitKind::Time,
        }
    }

    /// The first quantity that an SI symbol measures; [`Quantity::Number`] for `1` and what no model measures.
    ///
    /// ```
    /// use simgap_record::Quantity;
    /// assert_eq!(Quantity::of_si_symbol("rad/s"), Quantity::Velocity);
    /// assert_eq!(Quantity::of_si_symbol("1"), Quantity::Number);
    /// ```
    #[must_use]
    pub fn of_si_symbol(symbol: &str) -> Quantity {
        let measured = |quantity: &Quantity| {
            let mut kinds = quantity.kinds().into_iter().flatten();
            kinds.any(|kind| kind.si_symbol() == symbol)
        };
        let found = Quantity::ALL.into_iter().find(measured);
        found.unwrap_or(Quantity::Number)
    }

    /// Its SI symbol where the model rotates; `1` for a number.
    #[must_use]
    pub fn rotational_symbol(self) -> &'static str {
        self.kinds().map_or("1", |[_, kind]| kind.si_symbol())
    }

    /// Some accepted symbols, for error messages.
    #[must_use]
    pub fn examples(self) -> &'static str {
        match self {
            Quantity::Displacement => "m, mm, um, rad or deg",
            Quantity::Velocity => "m/s, mm/s, rad/s, deg/s or rpm",
            Quantity::Acceleration => "m/s^2, mm/s^2, g, rad/s^2 or deg/s^2",
            Quantity::Force => "N, kN, lbf or N m",
            Quantity::Pressure => "Pa, bar, MPa or psi",
            Quantity::Flow => "m^3/s, l/s or l/min",
            Quantity::Angle => "rad or deg",
            Quantity::Share => "1 or none",
            Quantity::Number => "1, V or m",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Quantity::Displacement => "a displacement",
            Quantity::Velocity => "a velocity",
            Quantity::Acceleration => "an acceleration",
            Quantity::Force => "a force",
            Quantity::Pressure => "a pressure",
            Quantity::Flow => "a flow",
            Quantity::Angle => "an angle",
            Quantity::Share => "a share",
            Quantity::Number => "a number",
        })
    }
}
