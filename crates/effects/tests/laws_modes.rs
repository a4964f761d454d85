//! Hidden masses: what an attached mode and a flexible support do to the dynamic stiffness.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::common::{MODEL, effect, model, scale};
use simgap_effects::{Action, SiteScale};
use simgap_model::{GROUND, Location, Model};

/// Rounding in the elimination of one mass, relative.
const ROUNDING: f64 = 1e-12;

/// A complex number as (re, im).
type Complex = (f64, f64);

fn add(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}

fn sub(a: Complex, b: Complex) -> Complex {
    (a.0 - b.0, a.1 - b.1)
}

fn mul(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn div(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    let (re, im) = mul(a, (b.0, -b.1));
    (re / square, im / square)
}

/// K + iωC − ω²M of the two masses of the model, with a third eliminated: D − d dᵀ / D₃₃.
fn dynamic_stiffness(model: &Model, omega: f64) -> [[Complex; 2]; 2] {
    let matrices = model.matrices().unwrap();
    let entry = |i: usize, j: usize| -> Complex {
        let (m, c, k) = (
            matrices.mass_matrix[(i, j)],
            matrices.damping_matrix[(i, j)],
            matrices.stiffness_matrix[(i, j)],
        );
        (k - omega * omega * m, omega * c)
    };
    let reduced = |i, j| match model.dof_count() {
        2 => entry(i, j),
        _ => sub(entry(i, j), div(mul(entry(i, 2), entry(2, j)), entry(2, 2))),
    };
    [
        [reduced(0, 0), reduced(0, 1)],
        [reduced(1, 0), reduced(1, 1)],
    ]
}

/// The model with the hidden mass of an effect, and how that mass begins.
fn with_mode(kind: &str, values: &[f64], at: &Location, model: &Model) -> (Model, [f64; 2]) {
    let mut changed = model.clone();
    match effect(kind).action(values) {
        Action::Mode { change, start } => {
            change(&mut changed, at);
            (changed, start)
        }
        _ => panic!("{kind} adds no mass"),
    }
}

/// Asserts that a hidden mass adds `needed(ω)` to the first mass's own entry and nothing else.
fn assert_adds(before: &Model, after: &Model, needed: impl Fn(f64) -> Complex) {
    assert_eq!(after.dof_count(), before.dof_count() + 1);
    for freq_hz in [0.0, 0.7, 4.9, 5.1, 8.0, 300.0] {
        let omega = TAU * freq_hz;
        let (old, new) = (
            dynamic_stiffness(before, omega),
            dynamic_stiffness(after, omega),
        );
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let added = if (i, j) == (0, 0) {
                needed(omega)
            } else {
                (0.0, 0.0)
            };
            let error = sub(new[i][j], add(old[i][j], added));
            let size = old[i][j].0.hypot(old[i][j].1) + added.0.hypot(added.1);
            assert!(
                error.0.hypot(error.1) <= ROUNDING * size,
                "({i}, {j}) at {freq_hz} Hz: {error:?} off"
            );
        }
    }
}

fn mass(name: &str) -> Location {
    Location::Mass(name.into())
}

/// −ω² m (k + iωc) / (k + iωc − ω² m) at its host, with k = m (2πf)² and c = 2 ζ m 2πf.
#[test]
fn verify_attached_mode_at_its_host() {
    let (attached, freq_hz, ratio) = (0.4, 5.0, 0.03);
    let values = [attached, freq_hz, ratio, 1e-4, -0.02];
    let (changed, start) = with_mode("attached_mode", &values, &mass("carriage"), &model());
    assert_eq!(start, [1e-4, -0.02]);
    assert_adds(&model(), &changed, |omega| {
        let own = TAU * freq_hz;
        let member = (attached * own * own, 2.0 * ratio * attached * own * omega);
        let inertia = (-omega * omega * attached, 0.0);
        div(mul(inertia, member), add(member, inertia))
    });
    // The host keeps its mass; far below the natural frequency it carries both.
    let before = model().matrices().unwrap().mass_matrix[(0, 0)];
    assert_eq!(changed.matrices().unwrap().mass_matrix[(0, 0)], before);
}

/// A fit may take the mass to nothing and the start kilometres off: that is no hidden mass.
#[test]
fn verify_an_attached_mass_of_nothing_is_no_hypothesis() {
    let keeps = |share: f64| {
        let mass_kg = share * scale().mass_kg;
        effect("attached_mode").has_support(&[mass_kg, 12.0, 0.01, 0.0, 0.0], &scale())
    };
    assert!(keeps(0.5) && keeps(1e-4));
    assert!(!keeps(1e-6) && !keeps(0.0));
}

#[test]
fn verify_attached_mode_without_mass_is_none() {
    let values = [0.0, 5.0, 0.03, 1e-4, 0.2];
    let (changed, _) = with_mode("attached_mode", &values, &mass("load"), &model());
    assert_eq!(changed, model());
}

/// Two hidden masses, and one of a file that has such a name already, are told apart.
#[test]
fn verify_hidden_masses_have_names_of_their_own() {
    let values = [0.1, 5.0, 0.03, 0.0, 0.0];
    let mut changed = model();
    for host in ["carriage", "carriage", "load"] {
        changed = with_mode("attached_mode", &values, &mass(host), &changed).0;
    }
    let mut names: Vec<&str> = changed.masses.iter().map(|m| m.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 5);
    assert!(
        changed
            .to_toml()
            .is_ok_and(|text| Model::from_toml(&text).is_ok())
    );
}

#[test]
fn verify_attached_mode_starts_at_lines_and_about_the_motion() {
    let starts = |scale: &SiteScale| effect("attached_mode").starts(scale);
    let has = |starts: &[Vec<f64>], freq_hz: f64| {
        starts.iter().any(|s| (s[1] / freq_hz - 1.0).abs() < 1e-9)
    };
    let found = starts(&scale());
    for freq_hz in [3.1, 12.7, 1.5 * 2.3] {
        assert!(has(&found, freq_hz), "{freq_hz} Hz: {found:?}");
    }
    // A free decay may leave no line and the motion none: the usual speed says where to look.
    let silent = SiteScale {
        lines_hz: [0.0; 4],
        motion_hz: [0.0; 4],
        ..scale()
    };
    let usual = 0.03 / 0.002 / TAU;
    assert!(has(&starts(&silent), 1.5 * usual));
    // None that the samples cannot show.
    let coarse = SiteScale {
        time_step_s: 0.1,
        ..scale()
    };
    assert!(starts(&coarse).iter().all(|s| s[1] < 5.0));
}

/// The spring of [`MODEL`] between carriage and ground, and a damper beside it.
fn grounded() -> Model {
    let damper =
        "[[damper]]\nname = \"leak\"\nbetween = [\"ground\", \"carriage\"]\ndamping = 11.0\n";
    Model::from_toml(&format!("{MODEL}\n{damper}")).unwrap()
}

/// The member g = k + iωc and the support h = kₛ + iωcₛ − ω² mₛ in series: −g + g h / (g + h).
#[test]
fn verify_flexible_support_is_in_series_with_its_members() {
    let (stiffness, support_mass, ratio) = (60_000.0, 1.5, 0.05);
    let values = [stiffness, support_mass, ratio, 2e-5, 0.001];
    for pair in [["carriage", GROUND], [GROUND, "carriage"]] {
        let at = Location::Between(pair.map(String::from));
        let (changed, start) = with_mode("flexible_support", &values, &at, &grounded());
        assert_eq!(start, [2e-5, 0.001]);
        assert_adds(&grounded(), &changed, |omega| {
            let member = (4000.0, 11.0 * omega);
            let damping = 2.0 * ratio * (stiffness * support_mass).sqrt();
            let support = (stiffness - omega * omega * support_mass, damping * omega);
            sub(div(mul(member, support), add(member, support)), member)
        });
    }
}

#[test]
fn verify_a_rigid_support_is_the_ground() {
    let at = Location::Between(["carriage".into(), GROUND.into()]);
    let rigid = [f64::INFINITY, 1.5, 0.05, 0.0, 0.0];
    let (changed, _) = with_mode("flexible_support", &rigid, &at, &grounded());
    assert_eq!(changed, grounded());
    // Members that do not stand on the ground have no support.
    let hanging = Location::Between(["carriage".into(), "load".into()]);
    let soft = [1e4, 1.5, 0.05, 0.0, 0.0];
    let (changed, _) = with_mode("flexible_support", &soft, &hanging, &grounded());
    assert_eq!(changed, grounded());
}

/// A support whose own mode is at a line: √((kₛ + k) / mₛ) = 2π f, with the mass it stands under held.
#[test]
fn verify_flexible_support_starts_at_lines() {
    let starts = effect("flexible_support").starts(&scale());
    for line_hz in [3.1, 12.7] {
        let at_line = |s: &&Vec<f64>| {
            let own = ((s[0] + scale().stiffness_n_per_m) / s[1]).sqrt() / TAU;
            (own / line_hz - 1.0).abs() < 1e-9
        };
        assert!(starts.iter().any(|s| at_line(&s)), "{line_hz}: {starts:?}");
    }
}

/// The lines of both modes of a mass on a spring and a hidden mode of it tell that one: a mass on the mass, or a support under the spring.
#[test]
fn verify_two_lines_tell_a_hidden_mode() {
    let (mass, stiffness) = (2.0, 808.0);
    let lines = |sum: f64, product: f64| {
        let root = (0.25 * sum * sum - product).sqrt();
        [0.5 * sum + root, 0.5 * sum - root].map(|square| square.sqrt() / TAU)
    };
    let told = |kind: &str, [high, low]: [f64; 2], wanted: [f64; 2]| {
        let sizes = SiteScale {
            mass_kg: mass,
            stiffness_n_per_m: stiffness,
            // Between them a line of something else.
            lines_hz: [high, 0.5 * (low + high), low, 0.0],
            ..scale()
        };
        let starts = effect(kind).starts(&sizes);
        let is_told = |values: &Vec<f64>| {
            let mut pairs = values.iter().zip(wanted);
            pairs.all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-9)
        };
        assert!(starts.iter().any(is_told), "{kind}: {starts:?}");
    };
    let own = stiffness / mass;
    let (heavier, freq) = (0.07, 3.4);
    let hidden = (TAU * freq).powi(2);
    let modes = lines(own + hidden * (1.0 + heavier), own * hidden);
    told("attached_mode", modes, [heavier * mass, freq]);
    let support = [24_250.0, 47.6];
    let hidden = support[0] / support[1];
    let modes = lines(own + hidden + stiffness / support[1], own * hidden);
    told("flexible_support", modes, support);
}

/// What swings by less than a period in a record is a stiffness that is off, or drifts.
#[test]
fn verify_a_stiffness_that_hardly_moves_does_not_swing() {
    let keeps = |periods: f64| {
        let freq_hz = periods / scale().duration_s;
        effect("time_varying_stiffness").has_support(&[100.0, freq_hz, 1.0], &scale())
    };
    assert!(keeps(20.0) && keeps(1.01));
    assert!(!keeps(0.9));
}

/// What rings on through a record looks like a force at one frequency; the mass or the support that it grows into rings there.
#[test]
fn verify_a_force_at_one_frequency_grows_into_a_mode_there() {
    let freq = 3.7;
    let grown = |kind: &str| {
        let modes = effect(kind).grown_from("harmonic_force", &[0.2, freq, 1.0], &scale());
        assert!(!modes.is_empty(), "{kind}");
        modes
    };
    // So heavy that the carriage hardly moves them.
    let heavy = grown("attached_mode").pop().unwrap();
    assert_eq!(heavy[1], freq);
    for values in grown("flexible_support") {
        let [stiffness, mass] = [values[0], values[1]];
        let own = ((stiffness + scale().stiffness_n_per_m) / mass).sqrt() / TAU;
        assert!((own / freq - 1.0).abs() < ROUNDING, "{values:?}");
        // It dies away by a factor of e over the longest record.
        let ages = values[2] * TAU * freq * scale().duration_s;
        assert!((ages - 1.0).abs() < ROUNDING, "{values:?}");
    }
}

/// A hidden mass or a support that nothing damps is a tone, but where nothing damps the machine either.
#[test]
fn verify_a_mode_that_does_not_die_away_is_none() {
    let omega = TAU * 6.3;
    let keeps = |kind: &str, ratio: f64, scale: &SiteScale| {
        let values = match kind {
            "attached_mode" => vec![scale.mass_kg, omega / TAU, ratio, 0.0, 0.0],
            _ => vec![omega * omega, 1.0, ratio, 0.0, 0.0],
        };
        effect(kind).has_support(&values, scale)
    };
    let free = SiteScale {
        damping_n_s_per_m: 1e-3,
        ..scale()
    };
    for kind in ["attached_mode", "flexible_support"] {
        let losing = |share: f64| share / (omega * scale().duration_s);
        assert!(keeps(kind, losing(1.0), &scale()), "{kind}");
        assert!(!keeps(kind, losing(0.01), &scale()), "{kind}");
        assert!(keeps(kind, losing(0.01), &free), "{kind}");
        assert!(!keeps(kind, losing(1e-4), &free), "{kind}");
        // It swings back, or it creeps.
        assert!(
            keeps(kind, 0.9, &scale()) && !keeps(kind, 1.1, &scale()),
            "{kind}"
        );
    }
}
