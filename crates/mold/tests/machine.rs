//! Beams, two cylinders, oil, and the split springs and dampers of Eq. (1) and (4), against closed forms.
#![allow(clippy::unwrap_used)]

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use simgap_model::{damped_modes, undamped_modes};
use simgap_mold::{
    BeamEnds, Cylinder, HeaveRoll, LEAF_CHANNEL, LeafEnd, LeafSpring, LockedCylinder, MoldOnLeaves,
    OneDof, TwoDof, published_sweep, rebuild_sweep,
};

/// Relative error of a frequency by cubic elements, (x/n)⁴/1440 for a root x and n elements: 7e-7 for the fourth
/// mode and 80 elements. Rounding of a mesh that fine stays below 1e-8.
const ELEMENT_ERROR: f64 = 1e-6;

/// Elements for that error.
const ELEMENTS: usize = 80;

const ENDS: [BeamEnds; 4] = [
    BeamEnds::Clamped,
    BeamEnds::ClampedGuided,
    BeamEnds::ClampedFree,
    BeamEnds::Pinned,
];

fn leaf() -> LeafSpring {
    LeafSpring::steel(1.06, 0.2, 0.010).unwrap()
}

/// First roots as printed in every table of beam modes.
#[test]
fn val_blevins_roots() {
    let printed = [
        (BeamEnds::Clamped, [4.73004, 7.85320, 10.9956]),
        (BeamEnds::ClampedGuided, [2.36502, 5.49780, 8.63938]),
        (BeamEnds::ClampedFree, [1.87510, 4.69409, 7.85476]),
        (BeamEnds::Pinned, [PI, 2.0 * PI, 3.0 * PI]),
    ];
    let leaf = leaf();
    let scale =
        (leaf.bending_stiffness() / leaf.mass_per_length()).sqrt() / leaf.length_m().powi(2);
    for (ends, roots) in printed {
        for (mode, root) in (1..).zip(roots) {
            let found = (TAU * leaf.natural_freq_hz(ends, mode).unwrap() / scale).sqrt();
            assert!(
                (found / root - 1.0).abs() < 1e-5,
                "{ends:?} {mode}: {found}"
            );
        }
    }
}

#[test]
fn verify_elements_against_closed_forms() {
    let leaf = leaf();
    for ends in ENDS {
        let freqs = leaf.element_freqs_hz(ends, ELEMENTS).unwrap();
        for mode in 1..=4_u32 {
            let closed = leaf.natural_freq_hz(ends, mode).unwrap();
            let off = freqs[mode as usize - 1] / closed - 1.0;
            assert!(off.abs() < ELEMENT_ERROR, "{ends:?} {mode}: {off:e}");
        }
    }
}

/// The frequencies of cubic elements converge with the fourth power of their length.
#[test]
fn order_of_the_elements() {
    let leaf = leaf();
    let closed = leaf.natural_freq_hz(BeamEnds::Clamped, 2).unwrap();
    let off =
        |elements| leaf.element_freqs_hz(BeamEnds::Clamped, elements).unwrap()[1] / closed - 1.0;
    let order = (off(8) / off(16)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

#[test]
fn verify_axial_force() {
    let buckling = PI * PI * leaf().bending_stiffness() / leaf().length_m().powi(2);
    for share in [-0.5, 0.5, 3.0] {
        let leaf = leaf().with_axial_force(share * buckling).unwrap();
        let freqs = leaf.element_freqs_hz(BeamEnds::Pinned, 50).unwrap();
        for mode in 1..=2_u32 {
            let closed = leaf.natural_freq_hz(BeamEnds::Pinned, mode).unwrap();
            assert!((freqs[mode as usize - 1] / closed - 1.0).abs() < ELEMENT_ERROR);
        }
    }
    let pulled = leaf().with_axial_force(1.0).unwrap();
    assert!(pulled.natural_freq_hz(BeamEnds::Clamped, 1).is_err());
    let thrust = leaf().with_axial_force(-1.1 * buckling).unwrap();
    assert!(thrust.natural_freq_hz(BeamEnds::Pinned, 1).is_err());
    let buckled = leaf().with_axial_force(-5.0 * buckling).unwrap();
    assert!(buckled.condensed(20, 2).is_err());
}

/// The condensed leaf has the stiffness of a guided end, and with a mass it has the modes of the whole mesh.
#[test]
fn verify_condensed_leaf() {
    let leaf = leaf();
    let condensed = leaf.condensed(ELEMENTS, 3).unwrap();
    assert!((condensed.end_stiffness / leaf.guided_stiffness() - 1.0).abs() < 1e-9);
    // A guided end moves as 3 s² − 2 s³: 13/35 of the mass of the leaf.
    let share = condensed.end_mass_kg / (leaf.mass_per_length() * leaf.length_m());
    assert!((share - 13.0 / 35.0).abs() < ELEMENT_ERROR, "{share}");
    for (mode, omega) in (1..).zip(&condensed.natural_freq_rad) {
        let closed = leaf.natural_freq_hz(BeamEnds::Clamped, mode).unwrap();
        assert!((omega / TAU / closed - 1.0).abs() < ELEMENT_ERROR);
    }
    // Without a mold, but for a mass as good as none, it is a clamped and guided beam.
    let bare = MoldOnLeaves::new(1e-9, 0.0, vec![leaf]).unwrap();
    let first = bare.natural_freqs_hz().unwrap()[0];
    let closed = leaf.natural_freq_hz(BeamEnds::ClampedGuided, 1).unwrap();
    // Three modes are kept: what is left out raises the frequency by less than this.
    assert!((first / closed - 1.0).abs() < 1e-4, "{first} {closed}");
    // The whole mesh with the mass of a mold on its guided end.
    let mut whole = leaf.finite_elements(BeamEnds::ClampedGuided, 40).unwrap();
    let end = whole.dof_count() - 1;
    whole.mass_matrix[(end, end)] += 500.0;
    whole.stiffness_matrix[(end, end)] += 1e6;
    let all = undamped_modes(&whole).unwrap().natural_freq_hz;
    let mold = MoldOnLeaves::new(500.0, 1e6, vec![leaf]).unwrap();
    let kept = mold.natural_freqs_hz().unwrap();
    for (kept, all) in kept.iter().zip(&all).take(2) {
        assert!((kept / all - 1.0).abs() < ELEMENT_ERROR, "{kept} {all}");
    }
}

#[test]
fn verify_four_leaves_cluster() {
    let mold = MoldOnLeaves::new(33_000.0, 8_287_639.0, vec![leaf(); 4]).unwrap();
    let freqs = mold.natural_freqs_hz().unwrap();
    let clamped = leaf().element_freqs_hz(BeamEnds::Clamped, 40).unwrap()[0];
    // Three combinations leave the mold at rest.
    let still = freqs[1..5]
        .iter()
        .filter(|freq| (*freq / clamped - 1.0).abs() < ELEMENT_ERROR);
    assert_eq!(still.count(), 3, "{freqs:?}");
}

#[test]
fn verify_heave_and_roll() {
    let (mass, radius, span) = (33_000.0, 1.1, 1.7);
    let mold = HeaveRoll::symmetric(mass, radius, [8.0e6, 3.0e5], span).unwrap();
    let modes = undamped_modes(&mold.matrices()).unwrap().natural_freq_hz;
    assert!((modes[0] / mold.heave_freq_hz() - 1.0).abs() < 1e-12);
    assert!((modes[1] / mold.roll_freq_hz() - 1.0).abs() < 1e-12);
    assert!((mold.roll_freq_hz() / mold.heave_freq_hz() - span / radius).abs() < 1e-12);
    let damped = damped_modes(&mold.matrices()).unwrap();
    assert!((damped[1].damping_ratio - mold.roll_damping_ratio()).abs() < 1e-12);
    assert_eq!(mold.unknown_force_per_heave(5.0).unwrap().norm(), 0.0);
    // One cylinder alone, the other with nothing: a mass on a spring at its lever.
    let single = mold.with_mismatch(1.0).unwrap();
    let roots = undamped_modes(&single.matrices()).unwrap().natural_freq_hz;
    let effective = 1.0 / (1.0 / mass + span * span / (mass * radius * radius));
    assert!((roots[1] - (8.0e6 / effective).sqrt() / TAU).abs() < 1e-9);
    assert!(roots[0] < 1e-6 && mold.with_mismatch(1.1).is_err());
}

proptest! {
    /// The force that heave alone lacks is what elimination of the roll leaves.
    #[test]
    fn prop_unknown_force_of_the_roll(
        stiffness in proptest::array::uniform2(1e5_f64..1e7),
        damping in proptest::array::uniform2(1e3_f64..1e5),
        offset in proptest::array::uniform2(-2.0_f64..2.0),
        freq in 0.1_f64..20.0,
    ) {
        let cylinder = |i: usize| Cylinder {
            offset_m: offset[i],
            stiffness: stiffness[i],
            damping: damping[i],
        };
        let mold = HeaveRoll::new(3.0e4, 2.0e4, [cylinder(0), cylinder(1)]).unwrap();
        let receptance = simgap_model::frequency_response(
            &mold.matrices(), freq, simgap_model::FrfKind::Receptance).unwrap();
        let matrices = mold.matrices();
        let omega = TAU * freq;
        let heave = faer::c64::new(
            matrices.stiffness_matrix[(0, 0)] - omega * omega * 3.0e4,
            omega * matrices.damping_matrix[(0, 0)],
        );
        // y = F/(D₁₁ − α/y)
        let lacking = heave - faer::c64::new(1.0, 0.0) / receptance[(0, 0)];
        let found = mold.unknown_force_per_heave(freq).unwrap();
        prop_assert!((found - lacking).norm() < 1e-8 * (heave.norm() + found.norm()));
    }

    /// Shut oil is softest with the piston in the middle.
    #[test]
    fn prop_oil_is_softest_in_the_middle(at in -0.039_f64..0.039) {
        let middle = LockedCylinder::centred(0.02, 0.08).unwrap();
        let least = middle.stiffness(1.4e9).unwrap();
        let moved = middle.moved(at).unwrap().stiffness(1.4e9).unwrap();
        prop_assert!(moved >= least);
        // 2 β A/L over 1 − (2 x/L)²
        let closed = least / (1.0 - (at / 0.04).powi(2));
        prop_assert!((moved / closed - 1.0).abs() < 1e-12);
    }
}

#[test]
fn verify_oil_runs_out() {
    let middle = LockedCylinder::centred(0.02, 0.08).unwrap();
    assert!(middle.moved(0.04).is_err() && LockedCylinder::centred(0.0, 0.08).is_err());
    assert_eq!(middle.stiffness(0.0).unwrap(), 0.0);
}

#[test]
fn verify_split_of_eq_1() {
    let mold = OneDof::published().unwrap();
    let whole = mold.model().unwrap().matrices().unwrap();
    let split = mold.with_leaf(2.0e6, LeafEnd::Moving).unwrap();
    let model = split.model().unwrap();
    assert_eq!(model.matrices().unwrap(), whole);
    assert_eq!(model.inputs[1].channel, LEAF_CHANNEL);
    // −k_leaf y_leaf of Eq. (1): the coupling of the moving end.
    let pair = ["mold".to_owned(), model.inputs[1].at.clone()];
    assert_eq!(model.stiffness_and_damping(&pair), [2.0e6, 0.0]);
    let fixed = mold
        .with_leaf(2.0e6, LeafEnd::Fixed)
        .unwrap()
        .model()
        .unwrap();
    assert_eq!((fixed.inputs.len(), fixed.springs.len()), (1, 2));
    assert!(mold.with_leaf(9.0e6, LeafEnd::Fixed).is_err());
    let damped = mold.with_damping(2.0 * mold.damping()).unwrap();
    assert!(
        (damped.damping_ratio() - 0.6).abs() < 1e-12 && damped.damping() == 2.0 * mold.damping()
    );
    let again = simgap_model::Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(again, model);
}

#[test]
fn verify_dampers_of_eq_4() {
    let bare = TwoDof::published(1.0).unwrap();
    assert!(bare.model().unwrap().dampers.is_empty());
    let [c1, leaf, c3] = [3.0e4, 2.0e3, 5.0e3];
    let mold = bare.with_damping([c1, leaf, c3]).unwrap();
    let matrix = mold.model().unwrap().matrices().unwrap().damping_matrix;
    assert_eq!(matrix, faer::mat![[c1 + leaf, -leaf], [-leaf, leaf + c3]]);
    assert_eq!(
        mold.restored(49.0, 51.0).unwrap().dampings(),
        [c1, leaf, c3]
    );
    assert!(bare.with_damping([-1.0, 0.0, 0.0]).is_err());
}

/// The force of the sweep balances its motion: central differences of a sweep without fault.
#[test]
fn verify_sweep_balances() {
    let mold = OneDof::published().unwrap();
    let mut plan = published_sweep(1000.0, 0.0).unwrap();
    (plan.centre_force, plan.stroke_force) = (0.0, vec![[1.0, 0.0]]);
    plan.duration_s = 10.0;
    let sweep = rebuild_sweep(&mold, &plan).unwrap();
    let values = |channel: &str| sweep.record.require(channel).unwrap().values.clone();
    let (y, force) = (values("y"), values("F_pressure"));
    let step = 1e-3;
    for n in (1..y.len() - 1).step_by(97) {
        let velocity = (y[n + 1] - y[n - 1]) / (2.0 * step);
        let acceleration = (y[n + 1] - 2.0 * y[n] + y[n - 1]) / (step * step);
        let needed = mold.mass_kg() * (acceleration + simgap_mold::STANDARD_GRAVITY)
            + mold.damping() * velocity
            + mold.stiffness() * y[n];
        // (ωh)²/6 of the largest force, 110 kN at 7 Hz.
        assert!(
            (force[n] - needed).abs() < 40.0,
            "{n}: {} {needed}",
            force[n]
        );
    }
}

/// What the machine is made of is written with its values under their names.
#[cfg(feature = "serde")]
#[test]
fn verify_models_are_written_with_their_values() {
    let mold = simgap_mold::OneDof::published().unwrap();
    let written = serde_json::to_value(mold).unwrap();
    assert_eq!(written["mass_kg"], mold.mass_kg());
    assert_eq!(written["stiffness"], mold.stiffness());
    let leaf = simgap_mold::LeafSpring::steel(1.06, 0.2, 0.010).unwrap();
    let written = serde_json::to_value(leaf).unwrap();
    assert_eq!(written["thickness_m"], 0.010);
}
