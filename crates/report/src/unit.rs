//! Units out of parameter names, and prefixes that keep numbers short.

use simgap_diagnose::NamedParameter;
use simgap_effects::find;

use crate::number::{at_resolution, decimal_exponent};

/// A parameter name taken apart: `cubic_stiffness_n_per_m3` is "cubic stiffness" in N/m³.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Quantity {
    pub(crate) words: String,
    /// Empty for a pure number.
    pub(crate) unit: String,
}

/// Splits a parameter name at its unit: the longest tail of unit words that leaves a name.
pub(crate) fn quantity(name: &str) -> Quantity {
    let parts: Vec<&str> = name.split('_').collect();
    let mut start = parts.len();
    while start > 1 && (parts[start - 1] == "per" || unit_word(parts[start - 1]).is_some()) {
        start -= 1;
    }
    let mut unit = String::new();
    let mut divided = false;
    for part in &parts[start..] {
        match unit_word(part) {
            None if !divided => {
                unit.push_str(if unit.is_empty() { "1/" } else { "/" });
                divided = true;
            }
            None => unit.push('/'),
            Some(word) => {
                if !unit.is_empty() && !unit.ends_with('/') {
                    unit.push(' ');
                }
                unit.push_str(&word);
            }
        }
    }
    Quantity {
        words: parts[..start].join(" "),
        unit,
    }
}

/// What an estimated value is, and its unit: as stated beside it, else by its name.
pub(crate) fn quantity_of(parameter: &NamedParameter) -> Quantity {
    let Some(unit) = &parameter.unit else {
        return quantity(&parameter.name);
    };
    let powers = [("^2", "²"), ("^3", "³"), ("^4", "⁴"), ("^5", "⁵")];
    let unit = match unit.trim() {
        "1" => String::new(),
        unit => powers
            .iter()
            .fold(unit.to_owned(), |unit, (from, to)| unit.replace(from, to)),
    };
    Quantity {
        words: parameter.name.replace('_', " "),
        unit,
    }
}

/// `n` is N, `m3` is m³; `None` for a word that is no unit.
fn unit_word(part: &str) -> Option<String> {
    let (letters, power) = match part.strip_suffix(['2', '3', '4', '5']) {
        Some(letters) => (letters, part.chars().last()),
        None => (part, None),
    };
    let symbol = match letters {
        "n" => "N",
        "m" => "m",
        "s" => "s",
        "kg" => "kg",
        "hz" => "Hz",
        "rad" => "rad",
        "v" => "V",
        "pa" => "Pa",
        _ => return None,
    };
    let power = match power {
        Some('2') => "²",
        Some('3') => "³",
        Some('4') => "⁴",
        Some(_) => "⁵",
        None => "",
    };
    Some(format!("{symbol}{power}"))
}

/// A prefix before a unit, and the number of prefixed units in one unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Prefixed {
    pub(crate) unit: String,
    pub(crate) factor: f64,
}

/// Prefixes by power of ten.
const PREFIXES: [(i32, &str); 7] = [
    (-9, "n"),
    (-6, "µ"),
    (-3, "m"),
    (0, ""),
    (3, "k"),
    (6, "M"),
    (9, "G"),
];

/// The unit with the prefix in which `size` lies between 1 and 1000, as far as the unit is used
/// with such prefixes: mm but not km, kN/m but not m/ks.
pub(crate) fn prefixed(unit: &str, size: f64) -> Prefixed {
    let lead = unit.split([' ', '/']).next().unwrap_or("");
    let allowed = match lead {
        "N" | "Pa" => 0..=9,
        "V" => -6..=3,
        "m" | "s" | "rad" => -9..=0,
        "Hz" => 0..=6,
        _ => 0..=0,
    };
    let exponent = if size > 0.0 && size.is_finite() {
        (decimal_exponent(size).div_euclid(3) * 3).clamp(*allowed.start(), *allowed.end())
    } else {
        0
    };
    let prefix = PREFIXES
        .iter()
        .find(|p| p.0 == exponent)
        .map_or("", |p| p.1);
    Prefixed {
        unit: format!("{prefix}{unit}"),
        factor: 10f64.powi(-exponent),
    }
}

/// An estimate in words and figures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Estimate {
    /// What it is, such as "friction force".
    pub(crate) words: String,
    /// With its unit, such as "2.10\u{a0}kN".
    pub(crate) value: String,
    /// Such as "2.05 to 2.15\u{a0}kN", or that the data do not bound it, or that it was not fitted.
    pub(crate) interval: String,
    /// Such as "2.10\u{a0}±\u{a0}0.05\u{a0}kN"; the value alone where the interval has no end or is lopsided.
    pub(crate) plus_minus: String,
}

/// What the catalogue writes for the unit that the records give a channel.
const OF_THE_OUTPUT: &str = "unit of the output";

/// Unit of a parameter that is in the unit of the channel it acts on, or in that unit by the second.
fn unit_of_channel(kind: &str, parameter: &str, channel_unit: &str) -> Option<String> {
    let known = find(kind)?.parameters();
    let known = known.iter().find(|known| known.name == parameter)?;
    let per = known.unit.strip_prefix(OF_THE_OUTPUT)?;
    Some(match (channel_unit, per) {
        ("", per) if !per.is_empty() => format!("1{per}"),
        _ => format!("{channel_unit}{per}"),
    })
}

/// The estimate of a parameter of such an effect, to the two digits that its interval can carry. `channel_unit` is the unit
/// of the channel on which the effect acts, empty for an effect that acts on none.
pub(crate) fn estimate(kind: &str, parameter: &NamedParameter, channel_unit: &str) -> Estimate {
    let Quantity { words, unit } = quantity_of(parameter);
    let unit = unit_of_channel(kind, &parameter.name, channel_unit).unwrap_or(unit);
    let [low, high] = parameter.ci95;
    let Prefixed { unit, factor } = prefixed(&unit, parameter.value.abs());
    let half = 0.5 * (high - low) * factor;
    let value = parameter.value * factor;
    let finest = decimal_exponent(value) - 5;
    let resolution = if half.is_finite() && half > 0.0 {
        (decimal_exponent(half) - 1).max(finest)
    } else {
        decimal_exponent(value) - 2
    };
    let resolution = resolution.min(decimal_exponent(value) - 1);
    let space = if unit.is_empty() { "" } else { "\u{a0}" };
    let unit = unit.replace(' ', "\u{a0}");
    let figure = |v: f64| at_resolution(v * factor, resolution);
    let interval = match (low.is_finite(), high.is_finite()) {
        _ if !is_fitted(parameter) => "chosen, not fitted".to_owned(),
        (true, true) => format!("{} to {}{space}{unit}", figure(low), figure(high)),
        (true, false) => format!("above {}{space}{unit}", figure(low)),
        (false, true) => format!("below {}{space}{unit}", figure(high)),
        (false, false) => "not bounded by these data".to_owned(),
    };
    let text = format!("{}{space}{unit}", figure(parameter.value));
    let plus_minus = even_half(parameter).map_or_else(
        || text.clone(),
        |half| plus_minus(value, half * factor) + space + &unit,
    );
    Estimate {
        words,
        value: text,
        interval,
        plus_minus,
    }
}

/// Whether a value was fitted: one that was chosen among a few has no interval.
pub(crate) fn is_fitted(parameter: &NamedParameter) -> bool {
    parameter.ci95 != [parameter.value; 2]
}

/// Half the width of an interval that reaches about as far down as up.
fn even_half(parameter: &NamedParameter) -> Option<f64> {
    let [low, high] = parameter.ci95;
    let half = 0.5 * (high - low);
    let middle = 0.5 * (high + low);
    let even = (parameter.value - middle).abs() < 0.2 * half;
    (half.is_finite() && half > 0.0 && even).then_some(half)
}

/// "2.10\u{a0}±\u{a0}0.05": one digit of the uncertainty, two where it begins with 1.
fn plus_minus(value: f64, half: f64) -> String {
    let leading = decimal_exponent(half);
    let begins_with_1 = half < 1.95 * 10f64.powi(leading);
    let resolution = (leading - i32::from(begins_with_1)).max(decimal_exponent(value) - 5);
    format!(
        "{}\u{a0}±\u{a0}{}",
        at_resolution(value, resolution),
        at_resolution(half, resolution)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_units_of_names() {
        let cases = [
            ("friction_force_n", "friction force", "N"),
            ("cubic_stiffness_n_per_m3", "cubic stiffness", "N/m³"),
            (
                "quadratic_damping_n_s2_per_m2",
                "quadratic damping",
                "N s²/m²",
            ),
            ("stribeck_velocity_m_per_s", "stribeck velocity", "m/s"),
            ("delay_s", "delay", "s"),
            ("mass_factor", "mass factor", ""),
            ("drift_per_s", "drift", "1/s"),
            ("n", "n", ""),
            ("", "", ""),
        ];
        for (name, words, unit) in cases {
            let q = quantity(name);
            assert_eq!((q.words.as_str(), q.unit.as_str()), (words, unit), "{name}");
        }
    }

    fn shown(name: &str, value: f64, ci95: [f64; 2]) -> (String, String) {
        let parameter = NamedParameter {
            name: name.to_owned(),
            value,
            ci95,
            unit: None,
        };
        let e = estimate("coulomb_friction", &parameter, "");
        (e.value, e.interval)
    }

    #[test]
    fn verify_uncertainty_has_one_digit_or_two() {
        let shown = |value, low, high| {
            let name = "friction_force_n".to_owned();
            let ci95 = [low, high];
            estimate(
                "coulomb_friction",
                &NamedParameter {
                    name,
                    value,
                    ci95,
                    unit: None,
                },
                "",
            )
            .plus_minus
        };
        assert_eq!(
            shown(2104.3, 2051.0, 2157.6),
            "2.10\u{a0}±\u{a0}0.05\u{a0}kN"
        );
        assert_eq!(shown(20.43, 20.31, 20.55), "20.43\u{a0}±\u{a0}0.12\u{a0}N");
        assert_eq!(shown(20.43, 20.0, f64::INFINITY), "20.4\u{a0}N");
        // Lopsided: the two ends are told elsewhere.
        assert_eq!(shown(20.43, 20.0, 25.0), "20.4\u{a0}N");
    }

    #[test]
    fn verify_only_what_is_in_the_unit_of_a_channel_takes_it() {
        let shown = |kind: &str, name: &str, value: f64, unit: &str| {
            let name = name.to_owned();
            let ci95 = [0.9 * value, 1.1 * value];
            let parameter = NamedParameter {
                name,
                value,
                ci95,
                unit: None,
            };
            estimate(kind, &parameter, unit).value
        };
        assert_eq!(shown("sensor_bias", "bias", 0.0012, "m"), "1.20\u{a0}mm");
        assert_eq!(shown("sensor_bias", "bias", 0.0012, ""), "0.00120");
        let drift = |unit| shown("sensor_drift", "drift_rate_per_s", 0.0012, unit);
        assert_eq!(drift("m"), "1.20\u{a0}mm/s");
        assert_eq!(drift(""), "0.00120\u{a0}1/s");
        let pure = [
            ("alternating_timing", "even_share"),
            ("alternating_gain", "gain_difference"),
            ("sensor_gain", "gain_factor"),
        ];
        for (kind, name) in pure {
            assert!(find(kind).is_some_and(|e| e.parameters().iter().any(|p| p.name == name)));
            assert_eq!(shown(kind, name, 0.52, "m"), "0.520", "{kind}");
        }
        assert_eq!(shown("sensor_delay", "delay_s", 0.002, "m"), "2.00\u{a0}ms");
    }

    #[test]
    fn verify_estimates_carry_the_digits_of_their_interval() {
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(
            shown("friction_force_n", 2100.0, [2050.0, 2150.0]),
            pair("2.100\u{a0}kN", "2.050 to 2.150\u{a0}kN")
        );
        assert_eq!(
            shown("gap_m", 1.234e-4, [1.1e-4, 1.36e-4]),
            pair("123\u{a0}µm", "110 to 136\u{a0}µm")
        );
        assert_eq!(
            shown("mass_factor", 0.9312, [0.92, 0.943]),
            pair("0.931", "0.920 to 0.943")
        );
        assert_eq!(
            shown("cubic_stiffness_n_per_m3", 4.2e13, [3.0e13, 5.4e13]),
            pair("42000\u{a0}GN/m³", "30000 to 54000\u{a0}GN/m³")
        );
        assert_eq!(
            shown("delay_s", 0.0, [-0.01, f64::INFINITY]),
            pair("0.00\u{a0}s", "above −0.01\u{a0}s")
        );
        assert_eq!(
            shown("delay_s", 2e-3, [f64::NEG_INFINITY, f64::INFINITY]),
            pair("2.00\u{a0}ms", "not bounded by these data")
        );
    }
}
