//! Agreement metrics against their closed forms.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, cosine};
use proptest::prelude::*;
use simgap_signal::metrics::{frac, nrmse, nrmse_over_channels, russell, sprague_geers};
use simgap_signal::{Complex64, SignalError};

/// Rounding of sums of a thousand products.
const ROUNDING: f64 = 1e-12;

/// A cosine over whole periods and the same shifted by an angle.
fn shifted(angle: f64) -> (Vec<f64>, Vec<f64>) {
    (
        cosine(1000, 1000.0, 5.0, 2.0, 0.0),
        cosine(1000, 1000.0, 5.0, 2.0, angle),
    )
}

#[test]
fn verify_nrmse_of_scale_shift_and_mean() {
    let (m, p) = shifted(0.6);
    // |1 - e^{iφ}| = 2 sin(φ/2)
    assert!((nrmse(&m, &p).unwrap() - 2.0 * 0.3f64.sin()).abs() < ROUNDING);
    let scaled: Vec<f64> = m.iter().map(|v| 1.2 * v).collect();
    assert!((nrmse(&m, &scaled).unwrap() - 0.2).abs() < ROUNDING);
    assert_eq!(nrmse(&m, &m).unwrap(), 0.0);
    let offset: Vec<f64> = m.iter().map(|v| v + 1.0).collect();
    // Standard deviation of the cosine is 2/√2.
    assert!((nrmse(&m, &offset).unwrap() - 0.5f64.sqrt()).abs() < ROUNDING);
    assert_eq!(
        nrmse(&[1.0, 1.0], &[1.0, 0.0]),
        Err(SignalError::Flat { what: "measured" })
    );
}

#[test]
fn verify_nrmse_over_channels_is_the_root_mean_square() {
    assert!((nrmse_over_channels(&[3.0, 4.0]).unwrap() - 12.5f64.sqrt()).abs() < ROUNDING);
    assert!(nrmse_over_channels(&[]).is_err());
}

#[test]
fn verify_sprague_geers_separates_scale_and_shift() {
    let (m, p) = shifted(0.2 * std::f64::consts::PI);
    let scaled: Vec<f64> = p.iter().map(|v| 1.3 * v).collect();
    let e = sprague_geers(&m, &scaled).unwrap();
    assert!((e.magnitude - 0.3).abs() < ROUNDING && (e.phase - 0.2).abs() < ROUNDING);
    assert!((e.comprehensive - 0.13f64.sqrt()).abs() < ROUNDING);
    let opposite: Vec<f64> = m.iter().map(|v| -v).collect();
    assert!((sprague_geers(&m, &opposite).unwrap().phase - 1.0).abs() < 1e-7);
}

#[test]
fn verify_russell_closed_form() {
    let (m, p) = shifted(0.2 * std::f64::consts::PI);
    let scaled: Vec<f64> = p.iter().map(|v| 1.2 * v).collect();
    let e = russell(&m, &scaled).unwrap();
    // (1.44 - 1)/1.2 = 0.3666…
    let magnitude = (1.0f64 + 0.44 / 1.2).log10();
    assert!((e.magnitude - magnitude).abs() < ROUNDING && (e.phase - 0.2).abs() < ROUNDING);
    let want = (std::f64::consts::FRAC_PI_4 * (magnitude * magnitude + 0.04)).sqrt();
    assert!((e.comprehensive - want).abs() < ROUNDING);
}

#[test]
fn verify_frac_is_the_squared_cosine() {
    // Two real vectors at an angle of 0.3 rad.
    let h = [Complex64::new(1.0, 0.0), Complex64::new(0.0, 0.0)];
    let g = [
        Complex64::new(0.3f64.cos(), 0.0),
        Complex64::new(0.0, 0.3f64.sin()),
    ];
    assert!((frac(&h, &g).unwrap() - 0.3f64.cos().powi(2)).abs() < ROUNDING);
    assert!((frac(&g, &g).unwrap() - 1.0).abs() < ROUNDING);
    assert_eq!(
        frac(&h, &g[..1]).unwrap_err().to_string(),
        "predicted has 1 entries, 2 are needed to match measured"
    );
}

proptest! {
    #[test]
    fn prop_russell_magnitude_is_antisymmetric(seed in 0u64..1000) {
        let mut noise = Noise::new(seed);
        let (m, p) = (noise.normals(50), noise.normals(50));
        let (a, b) = (russell(&m, &p).unwrap(), russell(&p, &m).unwrap());
        prop_assert!((a.magnitude + b.magnitude).abs() < ROUNDING);
        prop_assert!((a.phase - b.phase).abs() < ROUNDING);
    }

    #[test]
    fn prop_nrmse_ignores_common_offset_and_scale(seed in 0u64..1000, offset in -9.0..9.0f64, scale in 0.1..9.0f64) {
        let mut noise = Noise::new(seed);
        let (m, p) = (noise.normals(50), noise.normals(50));
        let map = |x: &[f64]| x.iter().map(|v| offset + scale * v).collect::<Vec<f64>>();
        let (a, b) = (nrmse(&m, &p).unwrap(), nrmse(&map(&m), &map(&p)).unwrap());
        prop_assert!((a / b - 1.0).abs() < 1e-11, "{} {}", a, b);
    }

    #[test]
    fn prop_phase_ignores_scale(seed in 0u64..1000, scale in 0.01..100.0f64) {
        let mut noise = Noise::new(seed);
        let (m, p) = (noise.normals(50), noise.normals(50));
        let q: Vec<f64> = p.iter().map(|v| scale * v).collect();
        let (a, b) = (sprague_geers(&m, &p).unwrap(), sprague_geers(&m, &q).unwrap());
        prop_assert!((a.phase - b.phase).abs() < ROUNDING);
    }

    #[test]
    fn prop_frac_between_zero_and_one(seed in 0u64..1000) {
        let mut noise = Noise::new(seed);
        let mut draw = || (0..20).map(|_| Complex64::new(noise.normal(), noise.normal())).collect();
        let (h, g): (Vec<Complex64>, Vec<Complex64>) = (draw(), draw());
        let value = frac(&h, &g).unwrap();
        prop_assert!((0.0..=1.0).contains(&value));
    }
}
