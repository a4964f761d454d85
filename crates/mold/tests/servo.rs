//! The mold on two servo cylinders: closed forms against the model file, limits, the stability of the loop.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use simgap_model::{FrfKind, Model, frequency_response};
use simgap_mold::{Controller, MoldError, SET_POINT_CHANNEL, ServoDrive, ServoMold};

/// Two inversions of matrices of up to eleven rows whose entries span six decades.
const ROUNDING: f64 = 1e-9;

/// Left and right differ in everything that they can differ in.
fn uneven() -> ServoMold {
    let left = ServoDrive::assumed(-1.5);
    let right = ServoDrive {
        offset_m: 1.2,
        area_m2: 0.018,
        oil_length_m: 0.1,
        bulk_modulus_pa: 1.0e9,
        leakage: 3e-11,
        rated_flow: 2.5e-3,
        spool_freq_hz: 45.0,
        controller: Controller {
            gain_per_m: 40.0,
            integral_time_s: Some(0.4),
        },
        ..left
    };
    ServoMold::new([33_000.0, 19_000.0], [1.4e5, 3.0e5], [left, right]).unwrap()
}

fn even(change: impl Fn(&mut ServoDrive)) -> [ServoDrive; 2] {
    [-1.5, 1.5].map(|offset| {
        let mut drive = ServoDrive::assumed(offset);
        change(&mut drive);
        drive
    })
}

#[test]
fn verify_closed_forms_against_the_model_file() {
    let mold = uneven();
    let model = mold.model().unwrap();
    let matrices = model.matrices().unwrap();
    let at = |name: &str| {
        let mut masses = model.masses.iter();
        masses.position(|mass| mass.name == name).unwrap()
    };
    let rows = [at("mold"), at("mold.roll")];
    let set_point = model
        .inputs
        .iter()
        .position(|input| input.channel == SET_POINT_CHANNEL)
        .unwrap();
    for freq in [0.05, 0.7, 2.5, 11.0, 46.0, 200.0] {
        let receptance = frequency_response(&matrices, freq, FrfKind::Receptance).unwrap();
        let force = mold.response_to_force(freq).unwrap();
        let follows = mold.response_to_set_point(freq).unwrap();
        let size = [force, follows].map(|pair| pair[0].norm().max(pair[1].norm()));
        for (k, row) in rows.into_iter().enumerate() {
            let whole = receptance[(row, rows[0])];
            assert!(
                (force[k] - whole).norm() < ROUNDING * size[0],
                "{freq} {k}: {} {whole}",
                force[k]
            );
            let terms = model.input_terms(set_point).unwrap().into_iter();
            let whole: faer::c64 = terms.map(|(i, weight)| receptance[(row, i)] * weight).sum();
            assert!(
                (follows[k] - whole).norm() < ROUNDING * size[1],
                "{freq} {k}: {} {whole}",
                follows[k]
            );
        }
    }
}

/// At rest a proportional loop gives 2 A K_q G/C_l; fast, the oil is all there is.
#[test]
fn verify_stiffness_at_rest_and_at_speed() {
    let drives = even(|_| ());
    let mold = ServoMold::new([33_000.0, 19_000.0], [0.0, 3.0e5], drives).unwrap();
    let [load, _] = mold.loads();
    let drive = drives[0];
    let gain = drive.flow_gain(load).unwrap() * drive.controller.gain_per_m;
    let rest = 2.0 * drive.area_m2 * gain / drive.leakage;
    // The corner of the leak lies at 35 rad/s, the frequency at 6e-4 rad/s: the square of their ratio, and of K_v.
    let found = mold.drive_stiffness(1e-4).unwrap();
    assert!((found.re / rest - 1.0).abs() < 1e-4, "{} {rest}", found.re);
    // Leak and valve are down by their corners over 2 kHz: 35 rad/s, squared, and 17 rad/s times (60 Hz/2 kHz)².
    let fast = mold.drive_stiffness(2000.0).unwrap().norm();
    assert!((fast / mold.oil_stiffness() - 1.0).abs() < 2e-5, "{fast}");
    assert!((mold.oil_stiffness() - 2.8e9).abs() < 1.0);
}

#[test]
fn verify_an_integrator_holds_against_a_force() {
    let drives = even(|drive| drive.controller.integral_time_s = Some(0.5));
    let mold = ServoMold::new([33_000.0, 19_000.0], [1.4e5, 3.0e5], drives).unwrap();
    // With it the give falls with the frequency, without it it stays.
    let give = |freq: f64| mold.response_to_force(freq).unwrap()[0].norm();
    assert!((give(2e-4) / give(1e-4) - 2.0).abs() < 1e-3);
    let bare = ServoMold::new([33_000.0, 19_000.0], [1.4e5, 3.0e5], even(|_| ())).unwrap();
    let give = |freq: f64| bare.response_to_force(freq).unwrap()[0].norm();
    assert!((give(2e-4) / give(1e-4) - 1.0).abs() < 1e-3);
    let follows = mold.response_to_set_point(1e-4).unwrap()[0];
    assert!((follows - 1.0).norm() < 1e-3, "{follows}");
}

/// Routh's rule for heave without guide and with a spool that is fast: stable for K_v < 2 β C_l/V.
#[test]
fn verify_the_limit_of_the_velocity_gain() {
    let largest = |share: f64| {
        let drives = even(|drive| {
            (drive.spool_freq_hz, drive.spool_damping_ratio) = (2e3, 0.02);
            let limit = 2.0 * drive.bulk_modulus_pa * drive.leakage / drive.volume_m3();
            // Half the weight on each.
            let load = 0.5 * 33_000.0 * simgap_mold::STANDARD_GRAVITY;
            let unit = drive.velocity_gain(load).unwrap() / drive.controller.gain_per_m;
            drive.controller.gain_per_m = share * limit / unit;
        });
        // With J = m r² the roll has the poles of the heave.
        let mold = ServoMold::new([33_000.0, 33_000.0 * 2.25], [0.0, 0.0], drives).unwrap();
        let modes = mold.modes().unwrap();
        let parts = modes.iter().map(|mode| mode.eigenvalue.re);
        parts.fold(f64::NEG_INFINITY, f64::max)
    };
    // The spool lags by 2ζ ω/ω₀ = 9e-4 at the 46 Hz of the oil, whose own damping ratio of 0.06 makes 0.8 % of it.
    assert!(largest(0.97) < 0.0, "{}", largest(0.97));
    assert!(largest(1.03) > 0.0, "{}", largest(1.03));
}

#[test]
fn verify_equal_cylinders_leave_the_roll_alone() {
    let mold = ServoMold::new([33_000.0, 19_000.0], [0.0, 3.0e5], even(|_| ())).unwrap();
    let [heave, roll] = mold.response_to_set_point(5.0).unwrap();
    assert!(roll.norm() < 1e-12 * heave.norm());
    let [_, rolls] = uneven().response_to_set_point(5.0).unwrap();
    assert!(rolls.norm() > 1e-3);
}

#[test]
fn verify_the_model_file_is_read_as_it_is_written() {
    let model = uneven().model().unwrap();
    let again = Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(again, model);
    // Pressures at the start carry the weight without a roll.
    let forces: Vec<f64> = model
        .elements
        .cylinders
        .iter()
        .map(|c| c.areas[0] * c.pressures[0] - c.areas[1] * c.pressures[1])
        .collect();
    assert!((forces[0] + forces[1] + model.loads[0].value).abs() < 1e-6);
    assert!((-1.5 * forces[0] + 1.2 * forces[1]).abs() < 1e-6);
}

/// The slowest pole of a loop with an integral valve is near its velocity gain.
#[test]
fn verify_the_loop_closes_at_the_velocity_gain() {
    let drives = even(|drive| drive.controller.gain_per_m = 10.0);
    let mold = ServoMold::new([33_000.0, 19_000.0], [0.0, 3.0e5], drives).unwrap();
    let gain = drives[0].velocity_gain(mold.loads()[0]).unwrap();
    let slow = mold.modes().unwrap()[0].eigenvalue;
    // The guide's damper against the leak takes c C_l/(2 A²), 0.4 %, and the spool K_v 2ζ/ω₀, 1.2 %.
    assert!((-slow.re / gain - 1.0).abs() < 0.02, "{slow} {gain}");
    assert!(slow.im.abs() < 1e-9 * TAU);
}

#[test]
fn verify_what_is_refused() {
    let weak = even(|drive| drive.supply_pa = 5e6);
    let found = ServoMold::new([33_000.0, 19_000.0], [0.0, 0.0], weak).unwrap_err();
    assert!(
        matches!(&found, MoldError::Parameter { name, .. } if name.contains("supply")),
        "{found}"
    );
    let drive = ServoDrive::assumed(1.0);
    assert!(ServoMold::new([33_000.0, 19_000.0], [0.0, 0.0], [drive; 2]).is_err());
    let loose = even(|drive| drive.leakage = -1.0);
    assert!(ServoMold::new([33_000.0, 19_000.0], [0.0, 0.0], loose).is_err());
    let still = even(|drive| drive.controller.integral_time_s = Some(0.0));
    assert!(ServoMold::new([33_000.0, 19_000.0], [0.0, 0.0], still).is_err());
}
