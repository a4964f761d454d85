//! Linear plants against closed forms: moving bases, force and acceleration outputs, loads.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{
    base_input, between, force_input, force_output, largest_difference, model, oscillator, output,
    placed, predict, run, sampled,
};
use proptest::prelude::*;
use simgap_effects::Placed;
use simgap_model::Location;

/// A base that moves as B sin ωt: X/B = (k + icω) / (k − mω² + icω).
struct Transmission {
    omega: f64,
    /// X as a complex number.
    re: f64,
    im: f64,
}

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 800.0;
const DAMPING: f64 = 6.0;
const BASE: f64 = 0.01;

impl Transmission {
    fn at(ratio: f64) -> Transmission {
        let omega = ratio * (STIFFNESS / MASS).sqrt();
        let (nr, ni) = (STIFFNESS, DAMPING * omega);
        let (dr, di) = (STIFFNESS - MASS * omega * omega, DAMPING * omega);
        let square = dr * dr + di * di;
        Transmission {
            omega,
            re: BASE * (nr * dr + ni * di) / square,
            im: BASE * (ni * dr - nr * di) / square,
        }
    }

    /// Im(X e^{iωt})
    fn displacement(&self, t: f64) -> f64 {
        self.re * (self.omega * t).sin() + self.im * (self.omega * t).cos()
    }

    fn velocity(&self, t: f64) -> f64 {
        self.omega * (self.re * (self.omega * t).cos() - self.im * (self.omega * t).sin())
    }

    fn base(&self, t: f64) -> f64 {
        BASE * (self.omega * t).sin()
    }

    fn base_velocity(&self, t: f64) -> f64 {
        self.omega * BASE * (self.omega * t).cos()
    }
}

/// Largest errors of displacement, mass and base acceleration and strut force, each relative to
/// its amplitude, over two seconds that start in the steady state.
fn base_errors(ratio: f64, step: f64) -> [f64; 4] {
    let exact = Transmission::at(ratio);
    let model = model(
        &[
            oscillator(MASS, STIFFNESS, DAMPING, "floor"),
            base_input("floor"),
            output("x", "displacement", "block"),
            output("a", "acceleration", "block"),
            output("ab", "acceleration", "floor"),
            force_output("F", "block", "floor"),
        ]
        .concat(),
    );
    let len = (2.0 / step) as usize;
    let run = run(step, len, vec![sampled(step, len, |t| exact.base(t))]);
    let predicted = predict(
        &model,
        &[],
        1,
        &run,
        &[exact.displacement(0.0), exact.velocity(0.0)],
    );
    let square = exact.omega * exact.omega;
    let wanted: [Box<dyn Fn(f64) -> f64>; 4] = [
        Box::new(|t| exact.displacement(t)),
        Box::new(|t| -square * exact.displacement(t)),
        Box::new(|t| -square * exact.base(t)),
        Box::new(|t| {
            STIFFNESS * (exact.displacement(t) - exact.base(t))
                + DAMPING * (exact.velocity(t) - exact.base_velocity(t))
        }),
    ];
    std::array::from_fn(|i| {
        let wanted = sampled(step, len, &wanted[i]);
        let size = wanted.iter().fold(0.0, |top: f64, v| top.max(v.abs()));
        largest_difference(&predicted[i], &wanted) / size
    })
}

#[test]
fn verify_a_base_excited_mass_moves_as_its_transmissibility_says() {
    // The excitation is interpolated linearly between samples: its sine is (ωh)²/12 too small,
    // 2.4e-6 at most here, and a lightly damped plant shows several times as much.
    const INTERPOLATION: f64 = 2e-5;
    for ratio in [0.4, 0.9, 1.1, 2.7] {
        let errors = base_errors(ratio, 1e-4);
        for (name, error) in ["x", "a", "ab", "F"].iter().zip(errors) {
            assert!(error < INTERPOLATION, "{name} at r = {ratio}: {error:e}");
        }
    }
}

#[test]
fn order_base_excitation_is_interpolated_to_fourth_order() {
    // The velocity of the base is differenced to that order; the samples at the ends start a transient.
    let (coarse, fine) = (base_errors(0.9, 4e-3), base_errors(0.9, 2e-3));
    for i in [0, 1, 3] {
        let order = (coarse[i] / fine[i]).log2();
        assert!(order > 3.0, "output {i}: order {order:.2}");
    }
}

#[test]
fn verify_a_damper_alone_carries_c_v() {
    // Five-point differences of a sine: (ωh)⁴/30, and six times that at the two ends.
    let (step, len, omega) = (1e-3, 1500, TAU * 3.0);
    let differences = (omega * step).powi(4) / 5.0;
    let damper = "[[damper]]\nname = \"c\"\nbetween = [\"rod\", \"ground\"]\ndamping = 1500.0\n";
    let model = model(
        &[
            damper,
            &base_input("rod"),
            &force_output("F", "rod", "ground"),
            &force_output("back", "ground", "rod"),
            &output("v", "velocity", "rod"),
        ]
        .concat(),
    );
    let travel = sampled(step, len, |t| 0.02 * (omega * t).sin());
    let predicted = predict(&model, &[], 1, &run(step, len, vec![travel]), &[]);
    let velocity = sampled(step, len, |t| 0.02 * omega * (omega * t).cos());
    let force: Vec<f64> = velocity.iter().map(|v| 1500.0 * v).collect();
    let scale = 0.02 * omega;
    assert!(largest_difference(&predicted[0], &force) < 1500.0 * scale * differences);
    assert!(largest_difference(&predicted[2], &velocity) < scale * differences);
    let reversed: Vec<f64> = predicted[1].iter().map(|f| -f).collect();
    assert_eq!(
        predicted[0], reversed,
        "the same force, named from the other end"
    );
}

/// The contract: positive when a is displaced from b in the positive direction.
#[test]
fn verify_the_sign_of_a_force_output_follows_the_order_of_its_nodes() {
    let spring = |between: &str| {
        format!("[[spring]]\nname = \"k\"\nbetween = {between}\nstiffness = 50.0\n")
    };
    for written in [r#"["a", "ground"]"#, r#"["ground", "a"]"#] {
        let text = [
            "[[mass]]\nname = \"a\"\nvalue = 1.0\n",
            &spring(written),
            &force_output("F", "a", "ground"),
            &force_output("G", "ground", "a"),
        ]
        .concat();
        let predicted = predict(&model(&text), &[], 1, &run(1e-3, 8, vec![]), &[0.2, 0.0]);
        assert!((predicted[0][0] - 10.0).abs() < 1e-12, "{written}");
        assert!((predicted[1][0] + 10.0).abs() < 1e-12, "{written}");
    }
}

/// Members in parallel add up, members elsewhere do not count.
#[test]
fn verify_a_force_output_takes_all_members_between_its_nodes_and_no_others() {
    let text = r#"
[[mass]]
name = "a"
value = 1.0
[[mass]]
name = "b"
value = 3.0
[[spring]]
name = "1"
between = ["a", "b"]
stiffness = 50.0
[[spring]]
name = "2"
between = ["b", "a"]
stiffness = 7.0
[[spring]]
name = "3"
between = ["b", "ground"]
stiffness = 1000.0
[[damper]]
name = "1"
between = ["b", "a"]
damping = 4.0
"#;
    let text = [text, &force_output("F", "a", "b")].concat();
    let predicted = predict(
        &model(&text),
        &[],
        1,
        &run(1e-3, 8, vec![]),
        &[0.3, 0.1, 2.0, -1.0],
    );
    let wanted = 57.0 * (0.3 - 0.1) + 4.0 * (2.0 + 1.0);
    assert!(
        (predicted[0][0] - wanted).abs() < 1e-12,
        "{}",
        predicted[0][0]
    );
}

#[test]
fn verify_free_decay_on_all_three_motion_outputs() {
    /// The propagation is exact; what is left is rounding over 2000 steps.
    const ROUNDING: f64 = 1e-10;
    let (mass, stiffness, damping) = (2.0, 800.0, 8.0);
    let text = [
        oscillator(mass, stiffness, damping, "ground"),
        output("x", "displacement", "block"),
        output("v", "velocity", "block"),
        output("a", "acceleration", "block"),
    ]
    .concat();
    let (x0, v0, step, len) = (0.01, -0.2, 5e-3, 2000);
    let predicted = predict(&model(&text), &[], 1, &run(step, len, vec![]), &[x0, v0]);
    let decay = damping / (2.0 * mass);
    let damped = (stiffness / mass - decay * decay).sqrt();
    let slope = (v0 + decay * x0) / damped;
    let x = |t: f64| (-decay * t).exp() * (x0 * (damped * t).cos() + slope * (damped * t).sin());
    let v = |t: f64| {
        let turn = (-decay * t).exp() * damped;
        turn * (slope * (damped * t).cos() - x0 * (damped * t).sin()) - decay * x(t)
    };
    let a = |t: f64| -(damping * v(t) + stiffness * x(t)) / mass;
    for (signal, wanted) in predicted.iter().zip([
        sampled(step, len, x),
        sampled(step, len, v),
        sampled(step, len, a),
    ]) {
        let size = wanted.iter().fold(0.0, |top: f64, v| top.max(v.abs()));
        assert!(largest_difference(signal, &wanted) < ROUNDING * size);
    }
}

#[test]
fn verify_a_load_deflects_as_statics_say() {
    let load = "[[load]]\nat = \"block\"\nvalue = -40.0\n";
    let text = [
        &oscillator(2.0, 800.0, 60.0, "ground"),
        load,
        &output("x", "displacement", "block"),
        &force_output("F", "block", "ground"),
    ]
    .concat();
    let model = model(&text);
    let rest = model.static_deflection(&model.load_vector()).unwrap()[0];
    assert!((rest + 0.05).abs() < 1e-12);
    let still = predict(&model, &[], 1, &run(0.01, 300, vec![]), &[rest, 0.0]);
    assert!(
        still[0].iter().all(|x| (x - rest).abs() < 1e-12),
        "it stays there"
    );
    assert!(
        still[1].iter().all(|f| (f + 40.0).abs() < 1e-9),
        "the spring carries the load"
    );
    let dropped = predict(&model, &[], 1, &run(0.01, 300, vec![]), &[]);
    // e^(−15 · 3 s) of the step is left.
    assert!((dropped[0][299] - rest).abs() < 1e-12, "it settles there");
}

/// Two masses in a row with random members.
fn chain() -> impl Strategy<Value = [f64; 6]> {
    [
        0.5..5.0,
        0.5..5.0,
        10.0..5000.0,
        10.0..5000.0,
        0.0..20.0,
        0.0..20.0_f64,
    ]
}

fn chain_model([m1, m2, k1, k2, c1, c2]: [f64; 6]) -> simgap_model::Model {
    let text = format!(
        r#"
[[mass]]
name = "a"
value = {m1:?}
[[mass]]
name = "b"
value = {m2:?}
[[spring]]
name = "1"
between = ["a", "floor"]
stiffness = {k1:?}
[[spring]]
name = "2"
between = ["a", "b"]
stiffness = {k2:?}
[[damper]]
name = "1"
between = ["a", "floor"]
damping = {c1:?}
[[damper]]
name = "2"
between = ["a", "b"]
damping = {c2:?}
"#
    );
    model(
        &[
            text,
            force_input("b"),
            base_input("floor"),
            output("xa", "displacement", "a"),
            output("ab", "acceleration", "b"),
            force_output("F", "a", "floor"),
        ]
        .concat(),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// What two excitations do together is the sum of what each does, initial states included.
    #[test]
    fn prop_linear_models_superpose(
        parameters in chain(),
        one in prop::collection::vec(-1.0..1.0_f64, 124),
        two in prop::collection::vec(-1.0..1.0_f64, 124),
        (p, q) in (-3.0..3.0_f64, -3.0..3.0_f64),
    ) {
        /// Relative to the largest value; sums of at most 60 steps with contracting modes.
        const ROUNDING: f64 = 1e-9;
        let model = chain_model(parameters);
        let predicted = |signal: &[f64]| {
            let run = run(0.01, 60, vec![signal[..60].to_vec(), signal[60..120].to_vec()]);
            predict(&model, &[], 1, &run, &signal[120..])
        };
        let both: Vec<f64> = one.iter().zip(&two).map(|(a, b)| p * a + q * b).collect();
        let (a, b, sum) = (predicted(&one), predicted(&two), predicted(&both));
        for c in 0..3 {
            let wanted: Vec<f64> = a[c].iter().zip(&b[c]).map(|(x, y)| p * x + q * y).collect();
            let size = a[c].iter().chain(&b[c]).fold(0.0, |top: f64, v| top.max(v.abs()));
            prop_assert!(largest_difference(&sum[c], &wanted) <= ROUNDING * size);
        }
    }

    /// Substeps are for nonlinear forces; without any they change nothing.
    #[test]
    fn prop_substeps_leave_linear_models_alone(
        parameters in chain(),
        signal in prop::collection::vec(-1.0..1.0_f64, 120),
    ) {
        let model = chain_model(parameters);
        let run = run(0.01, 60, vec![signal[..60].to_vec(), signal[60..].to_vec()]);
        prop_assert_eq!(predict(&model, &[], 1, &run, &[]), predict(&model, &[], 7, &run, &[]));
    }
}

/// The start of a lag is taken from what was measured, which is what the whole chain delivers: it goes last,
/// in whatever order a chain was found.
#[test]
fn verify_the_order_of_a_chain_with_a_lag_does_not_matter() {
    let text = [
        oscillator(2.0, 800.0, 3.0, "ground"),
        output("y", "displacement", "block"),
    ]
    .concat();
    let (text, channel) = (model(&text), Location::Channel("y".into()));
    let lag = placed("sensor_lag", channel.clone(), &[0.05]);
    let bias = placed("sensor_bias", channel, &[0.03]);
    let mut run = run(0.01, 400, vec![]);
    let still = predict(&text, &[bias.clone(), lag.clone()], 1, &run, &[0.01, 0.0]);
    run.measured = vec![Some(still[0].clone())];
    let orders = [[bias.clone(), lag.clone()], [lag, bias]];
    let [one, other] = orders.map(|chain| predict(&text, &chain, 1, &run, &[0.01, 0.0]));
    assert_eq!(one, other);
    // The record begins where the filter was at rest: no transient is made up.
    assert!(largest_difference(&one[0], &still[0]) < 1e-15);
}

/// A support takes its members with their errors, wherever in the list they are.
#[test]
fn verify_a_support_takes_members_as_errors_leave_them() {
    let of = |stiffness: f64, damping: f64| {
        let parts = [
            oscillator(2.0, stiffness, damping, "ground"),
            force_input("block"),
            output("y", "displacement", "block"),
            force_output("leg", "block", "ground"),
        ];
        model(&parts.concat())
    };
    let (nominal, leg) = (of(800.0, 3.0), between("block", "ground"));
    let support = placed("flexible_support", leg.clone(), &[5e3, 0.4, 0.05, 0.0, 0.0]);
    let softer = placed("stiffness_error", leg.clone(), &[0.8]);
    let damped = placed("damping_error", leg, &[1.5]);
    let force = sampled(0.002, 500, |t| (TAU * 4.0 * t).sin());
    let run = run(0.002, 500, vec![force]);
    let predicted = |effects: &[Placed]| predict(&nominal, effects, 1, &run, &[0.0, 0.0]);
    let last = predicted(&[support.clone(), softer.clone(), damped.clone()]);
    assert_eq!(last, predicted(&[softer, damped, support.clone()]));
    let errors_in_the_file = predict(&of(640.0, 4.5), &[support], 1, &run, &[0.0, 0.0]);
    for (one, other) in last.iter().zip(&errors_in_the_file) {
        let size = other.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        assert!(largest_difference(one, other) < 1e-9 * size);
    }
}

/// The force in a member that stands on a support that hardly gives way is the one it carries on the ground.
#[test]
fn verify_a_force_is_measured_in_members_on_a_support() {
    let text = [
        oscillator(2.0, 800.0, 3.0, "ground"),
        force_input("block"),
        force_output("leg", "block", "ground"),
    ]
    .concat();
    let (nominal, leg) = (model(&text), between("block", "ground"));
    let stiff = placed("flexible_support", leg, &[8e8, 0.4, 0.05, 0.0, 0.0]);
    let force = sampled(0.002, 500, |t| (TAU * 4.0 * t).sin());
    let run = run(0.002, 500, vec![force]);
    let predicted = |effects: &[Placed]| predict(&nominal, effects, 1, &run, &[0.0, 0.0]).remove(0);
    let (on_ground, on_support) = (predicted(&[]), predicted(&[stiff]));
    let size = on_ground.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    assert!(size > 0.5);
    assert!(largest_difference(&on_ground, &on_support) < 1e-4 * size);
}
