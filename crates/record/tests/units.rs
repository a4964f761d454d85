//! Every unit against its definition, every spelling against the others.

use std::f64::consts::PI;

use simgap_record::{Quantity, Unit, UnitKind};

/// Factors that are products of defined numbers may differ in the last rounding.
const FACTOR_REL_TOLERANCE: f64 = 4.0 * f64::EPSILON;

#[test]
fn verify_factors_and_kinds() {
    use UnitKind::*;
    let table: &[(&str, UnitKind, f64)] = &[
        ("s", Time, 1.0),
        ("ms", Time, 1e-3),
        ("us µs", Time, 1e-6),
        ("min", Time, 60.0),
        ("m", Length, 1.0),
        ("cm", Length, 0.01),
        ("mm", Length, 1e-3),
        ("µm μm um", Length, 1e-6),
        ("km", Length, 1e3),
        ("in", Length, 0.0254),
        ("ft", Length, 0.3048),
        ("m/s m·s^-1 m/sec", Velocity, 1.0),
        ("mm/s", Velocity, 1e-3),
        ("km/h", Velocity, 1.0 / 3.6),
        (
            "m/s^2 m/s2 m/s² m/s**2 m/s/s m·s^-2 m/(s^2)",
            Acceleration,
            1.0,
        ),
        ("mm/s^2", Acceleration, 1e-3),
        ("g", Acceleration, 9.80665),
        ("mg", Acceleration, 9.80665e-3),
        ("gal Gal cm/s^2", Acceleration, 0.01),
        ("N", Force, 1.0),
        ("mN", Force, 1e-3),
        ("kN", Force, 1e3),
        ("MN", Force, 1e6),
        ("kgf", Force, 9.80665),
        ("lbf", Force, 4.448_221_615_260_5),
        ("Pa", Pressure, 1.0),
        ("kPa", Pressure, 1e3),
        ("MPa", Pressure, 1e6),
        ("bar", Pressure, 1e5),
        ("psi", Pressure, 6_894.757_293_168_361),
        ("rad", Angle, 1.0),
        ("mrad", Angle, 1e-3),
        ("deg ° º", Angle, PI / 180.0),
        ("rev", Angle, 2.0 * PI),
        ("rad/s", AngularVelocity, 1.0),
        ("deg/s °/s", AngularVelocity, PI / 180.0),
        ("rpm rev/min", AngularVelocity, PI / 30.0),
        ("rad/s^2 rad/s²", AngularAcceleration, 1.0),
        ("deg/s^2", AngularAcceleration, PI / 180.0),
        ("Nm N*m N·m N.m", Torque, 1.0),
        ("mNm", Torque, 1e-3),
        ("kNm", Torque, 1e3),
        ("Nmm", Torque, 1e-3),
        ("lbf·ft", Torque, 1.355_817_948_331_400_4),
        ("V mV A mA 1 % - count M Deg Hz kg N/m", Other, 1.0),
    ];
    for &(symbols, kind, factor) in table {
        for symbol in symbols.split(' ') {
            let unit = Unit::parse(symbol);
            assert_eq!((unit.symbol(), unit.kind()), (symbol, kind));
            let relative = unit.si_factor() / factor - 1.0;
            assert!(
                relative.abs() <= FACTOR_REL_TOLERANCE,
                "{symbol}: {}",
                unit.si_factor()
            );
        }
    }
}

#[test]
fn verify_spaces_do_not_count() {
    for (spaced, tight) in [
        ("N m", "Nm"),
        ("kN m", "kNm"),
        ("m / s ^ 2", "m/s^2"),
        (" mm ", "mm"),
    ] {
        let (spaced, tight) = (Unit::parse(spaced), Unit::parse(tight));
        assert_eq!(
            (spaced.kind(), spaced.si_factor()),
            (tight.kind(), tight.si_factor())
        );
    }
}

/// `m`, `mm` and `min` hide in each other, as do milliseconds, newton metres and micrometres.
#[test]
fn verify_look_alikes_are_told_apart() {
    let kinds = [
        ("ms", UnitKind::Time),
        ("m/s", UnitKind::Velocity),
        ("min", UnitKind::Time),
        ("nm", UnitKind::Length),
        ("Nm", UnitKind::Torque),
        ("mN", UnitKind::Force),
        ("mNm", UnitKind::Torque),
        ("MN", UnitKind::Force),
        ("N/m", UnitKind::Other),
        ("Ns/m", UnitKind::Other),
    ];
    for (symbol, kind) in kinds {
        assert_eq!(Unit::parse(symbol).kind(), kind, "{symbol}");
    }
}

/// Multiplied by the double next to 0.001, many would miss it.
#[test]
fn verify_whole_millimetres_become_the_nearest_double() {
    for millimetres in 0..10_000 {
        let nearest: f64 = format!("{millimetres}e-3").parse().unwrap_or(f64::NAN);
        assert_eq!(Unit::parse("mm").to_si(f64::from(millimetres)), nearest);
    }
}

#[test]
fn verify_a_quantity_accepts_translation_and_rotation_and_nothing_else() {
    let fits = [
        (Quantity::Displacement, ["mm", "deg"]),
        (Quantity::Velocity, ["mm/s", "rpm"]),
        (Quantity::Acceleration, ["g", "rad/s^2"]),
        (Quantity::Force, ["kN", "N m"]),
    ];
    for (quantity, _) in fits {
        for (other, symbols) in fits {
            for symbol in symbols {
                let accepted = quantity.accepts(Unit::parse(symbol).kind());
                assert_eq!(accepted, quantity == other, "{quantity} in {symbol}");
            }
        }
        assert!(
            ["bar", "V", "s", "-"]
                .iter()
                .all(|s| !quantity.accepts(Unit::parse(s).kind()))
        );
    }
}
