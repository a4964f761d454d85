//! Parts of models, written shortly.

use simgap_model::{Damper, Input, InputKind, Mass, Output, OutputKind, Spring};

use crate::random::Random;

pub(super) fn pair(a: &str, b: &str) -> [String; 2] {
    [a.to_string(), b.to_string()]
}

pub(super) fn mass(name: &str, value: f64) -> Mass {
    Mass {
        name: name.to_string(),
        value,
        uncertainty: None,
    }
}

pub(super) fn spring(a: &str, b: &str, stiffness: f64) -> Spring {
    Spring {
        name: format!("{a} {b}"),
        between: pair(a, b),
        stiffness,
        uncertainty: None,
    }
}

pub(super) fn dashpot(a: &str, b: &str, damping: f64) -> Damper {
    Damper {
        name: format!("{a} {b}"),
        between: pair(a, b),
        damping,
        uncertainty: None,
    }
}

pub(super) fn input(kind: InputKind, at: &str) -> Input {
    Input {
        channel: "u".to_string(),
        kind,
        at: at.to_string(),
        gain: None,
        uncertainty: None,
        between_samples: None,
    }
}

pub(super) fn output(number: usize, kind: OutputKind, at: &str) -> Output {
    Output {
        channel: format!("y{number}"),
        kind,
        at: Some(at.to_string()),
        between: None,
        gain: None,
        uncertainty: None,
    }
}

/// Displacement most often, acceleration, velocity.
pub(super) fn output_kind(random: &mut Random) -> OutputKind {
    match random.below(20) {
        0..=10 => OutputKind::Displacement,
        11..=13 => OutputKind::Velocity,
        _ => OutputKind::Acceleration,
    }
}

/// A load cell: what the members between two nodes carry.
pub(super) fn load_cell(number: usize, a: &str, b: &str) -> Output {
    Output {
        channel: format!("y{number}"),
        kind: OutputKind::Force,
        at: None,
        between: Some(pair(a, b)),
        gain: None,
        uncertainty: None,
    }
}
