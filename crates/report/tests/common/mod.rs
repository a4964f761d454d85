//! Diagnoses built by hand, one for each status, with a check record to show.
#![allow(dead_code, missing_docs, unreachable_pub)]

use std::f64::consts::TAU;

use simgap_diagnose::{
    BandShare, CandidateResult, ChannelGap, ChannelSeries, ChannelShare, CheckSeries, Diagnosis,
    Gap, LocationShare, NamedEffect, NamedParameter, RecordShare, Rival, StateShare, Status,
    TimeShare, Verdict, Where,
};
use simgap_model::Location;
use simgap_report::page::ReportContext;

pub fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

pub fn context() -> ReportContext {
    ReportContext {
        program_version: "0.1.0".into(),
        model_file: "mold-2dof.toml".into(),
        train_records: vec!["sweep-1.csv".into(), "sweep-2.csv".into()],
        check_records: vec!["production.csv".into()],
        command_line: "simgap diagnose mold-2dof.toml --train sweep-1.csv --train sweep-2.csv --check production.csv --out report".into(),
        seed: 0,
    }
}

/// A sum of 12 uniform numbers of a congruential generator: nearly normal, the same everywhere.
pub fn noise(n: usize, std: f64, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..n)
        .map(|_| std * (0..12).map(|_| uniform()).sum::<f64>())
        .collect()
}

/// 60 s at 200 Hz: a slow swing with a faster one that grows in the middle. The model as given
/// misses friction-like flats and the third harmonic.
pub fn series() -> Vec<CheckSeries> {
    let n = 12_000;
    let time_s: Vec<f64> = (0..n).map(|i| i as f64 / 200.0).collect();
    let channel = |name: &str, unit, size: f64, seed| {
        let ideal = |t: f64| {
            size * (0.6 + 0.4 * (-((t - 38.0) / 8.0).powi(2)).exp()) * (TAU * 1.0 * t).sin()
        };
        let extra = |t: f64| {
            0.25 * ideal(t).abs() * (TAU * 3.0 * t + 0.4).sin()
                + 0.1 * size * (TAU * t).cos().signum()
        };
        let corrected: Vec<f64> = time_s.iter().map(|t| ideal(*t) + extra(*t)).collect();
        ChannelSeries {
            channel: name.into(),
            unit,
            measured: corrected
                .iter()
                .zip(noise(n, 0.015 * size, seed))
                .map(|(a, b)| a + b)
                .collect(),
            nominal: time_s.iter().map(|t| 1.15 * ideal(*t + 0.02)).collect(),
            corrected,
        }
    };
    vec![CheckSeries {
        record: "production.csv".into(),
        channels: vec![
            channel("y1", "m", 3.0e-3, 1),
            channel("F_cylinder", "N", 5.2e4, 2),
        ],
        time_s: time_s.clone(),
    }]
}

/// The same record predicted as the verdict says: at once by the model as given if the gap is
/// noise, never quite if its cause is unknown.
pub fn series_of(status: Status) -> Vec<CheckSeries> {
    let mut all = series();
    for c in all.iter_mut().flat_map(|r| &mut r.channels) {
        match status {
            Status::None => c.nominal.clone_from(&c.corrected),
            Status::Unknown => c.corrected = c.nominal.iter().map(|v| 0.88 * v).collect(),
            Status::Parameters | Status::Effect => {}
        }
    }
    all
}

pub fn effect() -> Diagnosis {
    Diagnosis {
        stopped_early: false,
        schema: "simgap-diagnosis/1",
        model: "mold-2dof".into(),
        gap: Gap {
            metric: "nrmse",
            nominal: 0.412,
            recalibrated: 0.301,
            corrected: 0.0212,
            noise_floor: 0.018, input_noise: 0.0,
            closed: 0.973,
            channels: vec![
                ChannelGap { channel: "y1".into(), nominal: 0.47, recalibrated: 0.33, corrected: 0.0215, noise_floor: 0.019, input_noise: 0.0 },
                ChannelGap { channel: "F_cylinder".into(), nominal: 0.34, recalibrated: 0.27, corrected: 0.0209, noise_floor: 0.017, input_noise: 0.0 },
            ],
        },
        r#where: shares(),
        verdict: Verdict {
            status: Status::Effect,
            effects: vec![friction()],
            description: vec![],
            ..Verdict::default()
        },
        candidates: candidates(),
        next_experiment: Some("drive the mold with a slow ramp of 1 mm/s through standstill: Coulomb and Stribeck friction differ most there".into()),
        notes: vec![
            "column p [bar] was converted to Pa".into(),
            "the time base of sweep-1.csv has 3 gaps, the longest 12 ms at 4.21 s".into(),
        ],
    }
}

fn friction() -> NamedEffect {
    NamedEffect {
        kind: "coulomb_friction".into(),
        at: between("mold", "ground"),
        probability: 0.974,
        parameters: vec![NamedParameter { name: "friction_force_n".into(), value: 2104.3, ci95: [2051.0, 2157.6], unit: None }],
        indistinguishable: vec![Rival {
            kind: "stribeck_friction".into(),
            at: between("mold", "ground"),
            because: "the records hold no speed low enough for the Stribeck rise to show".into(),
        }],
        evidence: vec![
            "the force needed to explain the discrepancy changes sign with the velocity and keeps its size".into(),
            "log evidence falls by 5210.4 without it".into(),
            "the squared discrepancy of the training records is 98.7 % lower with it".into(),
        ],
    }
}

fn shares() -> Where {
    let location = |at, share| LocationShare { at, share };
    let band = |from_hz, to_hz, label: &str, share| BandShare {
        from_hz,
        to_hz,
        label: label.into(),
        share,
    };
    let time = |k: u32| TimeShare {
        record: "production.csv".into(),
        from_s: f64::from(6 * k),
        to_s: f64::from(6 * k + 6),
        share: [0.05, 0.05, 0.06, 0.06, 0.07, 0.14, 0.26, 0.19, 0.07, 0.05][k as usize],
    };
    Where {
        channels: vec![
            ChannelShare {
                channel: "y1".into(),
                share: 0.66,
            },
            ChannelShare {
                channel: "F_cylinder".into(),
                share: 0.34,
            },
        ],
        locations: vec![
            location(between("mold", "ground"), 0.81),
            location(between("mold", "frame"), 0.12),
            location(Location::Mass("mold".into()), 0.05),
            location(Location::Channel("y1".into()), 0.02),
        ],
        bands: vec![
            band(0.0, 0.5, "below the drive", 0.02),
            band(0.9, 1.1, "drive, 1 Hz", 0.41),
            band(2.9, 3.1, "3rd harmonic of 1 Hz", 0.37),
            band(4.9, 5.1, "5th harmonic of 1 Hz", 0.08),
            band(8.0, 100.0, "broad band", 0.12),
        ],
        times: (0..10).map(time).collect(),
        states: vec![
            StateShare {
                label: "velocity reversal of mold".into(),
                variable: "velocity",
                at: "mold".into(),
                from: -0.001,
                to: 0.001,
                share: 0.58,
                occupancy: 0.12,
            },
            StateShare {
                label: "mold far from rest".into(),
                variable: "displacement",
                at: "mold".into(),
                from: 0.002,
                to: 0.003,
                share: 0.22,
                occupancy: 0.25,
            },
        ],
        records: vec![RecordShare {
            record: "production.csv".into(),
            share: 1.0,
        }],
    }
}

fn candidates() -> Vec<CandidateResult> {
    let one = |kind: &str, at, held_back_gap, probability| CandidateResult {
        kind: kind.into(),
        at,
        held_back_gap,
        probability,
    };
    let mut all = vec![
        one("coulomb_friction", between("mold", "ground"), 0.0212, 0.974),
        one(
            "stribeck_friction",
            between("mold", "ground"),
            0.0213,
            0.021,
        ),
        one(
            "quadratic_damping",
            between("mold", "ground"),
            0.118,
            0.0004,
        ),
        one("coulomb_friction", between("mold", "frame"), 0.164, 1e-9),
        one("sensor_delay", Location::Channel("y1".into()), 0.22, 0.0),
    ];
    for k in 1..9 {
        all.push(one(
            "harmonic_force",
            Location::Mass(format!("m{k}")),
            0.25 + 0.01 * f64::from(k),
            0.0,
        ));
    }
    all
}

pub fn parameters() -> Diagnosis {
    let mut d = effect();
    d.verdict.status = Status::Parameters;
    d.verdict.effects = vec![NamedEffect {
        kind: "stiffness_error".into(),
        at: between("mold", "ground"),
        probability: 0.93,
        parameters: vec![NamedParameter {
            name: "stiffness_factor".into(),
            value: 0.9312,
            ci95: [0.9204, 0.9431],
            unit: None,
        }],
        indistinguishable: vec![],
        evidence: vec!["Re-estimating it alone lowers the gap to the noise.".into()],
    }];
    d.gap.recalibrated = 0.0212;
    d.next_experiment = None;
    d
}

pub fn unknown() -> Diagnosis {
    let mut d = effect();
    d.verdict = Verdict {
        status: Status::Unknown,
        effects: vec![],
        description: vec![
            "what is left of y1 repeats every 2.50 s whatever the motion does".into(),
            "it is largest where the mold is near 1.2 mm".into(),
        ],
        ..Verdict::default()
    };
    d.gap.corrected = 0.301;
    d.gap.closed = 0.271;
    d
}

pub fn none() -> Diagnosis {
    let mut d = effect();
    d.verdict = Verdict {
        status: Status::None,
        effects: vec![],
        description: vec![],
        ..Verdict::default()
    };
    d.gap = Gap {
        metric: "nrmse",
        nominal: 0.0183,
        recalibrated: 0.0182,
        corrected: 0.0182,
        noise_floor: 0.018,
        input_noise: 0.0,
        closed: 0.02,
        channels: vec![],
    };
    for c in &mut d.candidates {
        c.held_back_gap = 0.0183;
        c.probability = 0.02;
    }
    d.next_experiment = None;
    d.notes.clear();
    d
}

/// Two effects at once, one of them in a sensor whose parameter has the unit of its channel.
pub fn two_effects() -> Diagnosis {
    let mut d = effect();
    d.verdict.effects[0].probability = 0.71;
    d.verdict.effects.push(NamedEffect {
        kind: "sensor_bias".into(),
        at: Location::Channel("y1".into()),
        probability: 0.88,
        parameters: vec![NamedParameter {
            name: "bias".into(),
            value: -1.2e-4,
            ci95: [f64::NEG_INFINITY, f64::INFINITY],
            unit: None,
        }],
        indistinguishable: vec![],
        evidence: vec![],
    });
    d
}

/// Nothing in any list.
pub fn bare(status: Status) -> Diagnosis {
    let mut d = none();
    d.verdict.status = status;
    d.r#where = Where {
        channels: vec![],
        locations: vec![],
        bands: vec![],
        times: vec![],
        states: vec![],
        records: vec![],
    };
    d.candidates.clear();
    d
}
