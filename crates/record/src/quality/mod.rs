//! Defects a measurement chain leaves in a record, read off one channel at a time.
//!
//! A finding is a hint with a starting value, not a verdict: what looks like a defect may be
//! physics, and is judged later by the same evidence. Each check is tuned to stay silent on clean
//! data, so a mild defect may go unseen.

mod alternation;
mod edges;
mod finding;
mod lattice;
mod repeats;
mod spikes;
mod stamps;

pub use finding::{Defect, Edge, QualityFinding};

use crate::Record;

/// Looks for defects in the time base and in every channel, in the order of the record.
///
/// | Defect | Sign | Not judged |
/// |---|---|---|
/// | [`Defect::Flat`] | one value only | |
/// | [`Defect::Clipped`] | runs of 3 and more at the extreme value, exactly | fewer than 6 different values |
/// | [`Defect::Quantised`] | at least 98 % of the levels within 0.1 step of a lattice | more than 65 536 levels; ramps |
/// | [`Defect::Repeated`] | more equal neighbours than neighbours one or two levels apart | a lattice coarser than a quarter of the median change |
/// | [`Defect::Spikes`] | second differences in the ratio 1 : -2 : 1, ten robust deviations high | neighbouring outliers |
/// | [`Defect::Alternation`] | `(-1)^row` in 16 tapered parts, 8 standard errors | fewer than 256 rows; half a step of a lattice |
/// | [`Defect::TimeJitter`] | a stamp more than 0.02 of a step off the uniform grid | |
///
/// Filled samples are neither repeats nor spikes ([`Record::filled`]); in a record that was resampled
/// ([`Record::is_resampled`]) these and alternations are not sought.
///
/// ```
/// use simgap_record::{Channel, Defect, Record, quality};
///
/// let sine = (0..500).map(|k| (0.05 * f64::from(k)).sin().min(0.8)).collect();
/// let record = Record::from_uniform("A.csv", 0.0, 0.01, vec![Channel::new("y", "mm", sine)])?;
/// let findings = quality(&record);
/// assert!(matches!(findings[0].defect, Defect::Clipped { level: 0.8, .. }));
/// assert!(findings[0].to_string().starts_with("y is held at its largest value 0.8 mm"));
/// # Ok::<(), simgap_record::RecordError>(())
/// ```
#[must_use]
pub fn quality(record: &Record) -> Vec<QualityFinding> {
    let jitter =
        stamps::jitter(record.time_s(), record.time_step_s()).map(|defect| QualityFinding {
            channel: "t".to_owned(),
            unit: "s".to_owned(),
            defect,
        });
    let of_channels = record.channels().iter().flat_map(|channel| {
        let filled = record.filled(&channel.name).unwrap_or_default();
        let mut defects = defects(&channel.values, filled);
        // Of samples that stand between those taken, none is single.
        defects.retain(|defect| !(record.is_resampled() && is_of_single_samples(defect)));
        defects.into_iter().map(|defect| QualityFinding {
            channel: channel.name.clone(),
            unit: channel.unit.symbol().to_owned(),
            defect,
        })
    });
    jitter.into_iter().chain(of_channels).collect()
}

fn is_of_single_samples(defect: &Defect) -> bool {
    matches!(
        defect,
        Defect::Repeated { .. } | Defect::Spikes { .. } | Defect::Alternation { .. }
    )
}

/// The defects of one column of finite values, of which some may be filled.
fn defects(values: &[f64], filled: &[bool]) -> Vec<Defect> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let levels = lattice::distinct(&sorted);
    if let [(value, _)] = levels[..] {
        return vec![Defect::Flat { value }];
    }
    let lattice = lattice::lattice(values, &levels);
    let mut found = Vec::new();
    for edge in [Edge::Upper, Edge::Lower] {
        found.extend(edges::clipped(values, &levels, lattice, edge));
    }
    let held: Vec<f64> = found
        .iter()
        .filter_map(|defect| match defect {
            Defect::Clipped { level, .. } => Some(*level),
            _ => None,
        })
        .collect();
    found.extend(lattice.map(|l| Defect::Quantised {
        step: l.step,
        levels: l.levels,
    }));
    found.extend(repeats::repeated((values, filled), &levels, lattice, &held));
    found.extend(spikes::spikes((values, filled), lattice));
    found.extend(alternation::alternation(values, lattice));
    found
}
