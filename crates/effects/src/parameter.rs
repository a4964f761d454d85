//! A parameter of an effect.

/// A unit where what moves along a line turns: a torque for a force, an angle for a length, an inertia for a mass.
///
/// ```
/// use simgap_effects::unit_of_rotation;
///
/// assert_eq!(unit_of_rotation("N s^2/m^2"), "N m s^2/rad^2");
/// assert_eq!(unit_of_rotation("kg"), "kg m^2");
/// assert_eq!(unit_of_rotation("Hz"), "Hz");
/// ```
#[must_use]
pub fn unit_of_rotation(unit: &str) -> String {
    let of_factor = |factor: &str| {
        let (symbol, power) = factor.split_at(factor.find('^').unwrap_or(factor.len()));
        match symbol {
            "N" => format!("N{power} m{power}"),
            "m" => format!("rad{power}"),
            "kg" => format!("kg{power} m^2"),
            _ => factor.to_string(),
        }
    };
    let of_product = |product: &str| {
        let factors: Vec<String> = product.split(' ').map(of_factor).collect();
        factors.join(" ")
    };
    let parts: Vec<String> = unit.split('/').map(of_product).collect();
    parts.join("/")
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
    /// Value at which the effect vanishes, infinite for a limit that is never reached; `None` for a
    /// parameter that only shapes it.
    pub neutral: Option<f64>,
    /// Whether every record has a value of its own: the phase of a clock, the state at the start.
    pub per_record: bool,
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
            per_record: false,
        }
    }

    /// A size: without effect at zero, of either sign unless bounded.
    #[must_use]
    pub const fn size(name: &'static str, unit: &'static str, lower: f64, upper: f64) -> Parameter {
        Parameter {
            name,
            unit,
            lower,
            upper,
            neutral: Some(0.0),
            per_record: false,
        }
    }

    /// A limit: without effect at infinity.
    #[must_use]
    pub const fn limit(name: &'static str, unit: &'static str) -> Parameter {
        Parameter {
            name,
            unit,
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(f64::INFINITY),
            per_record: false,
        }
    }

    /// A value that only shapes the effect.
    #[must_use]
    pub const fn shape(
        name: &'static str,
        unit: &'static str,
        lower: f64,
        upper: f64,
    ) -> Parameter {
        Parameter {
            name,
            unit,
            lower,
            upper,
            neutral: None,
            per_record: false,
        }
    }

    /// A value that every record has of its own.
    #[must_use]
    pub const fn of_record(self) -> Parameter {
        Parameter {
            per_record: true,
            ..self
        }
    }
}
