//! The result of a diagnosis, as `diagnosis.json` holds it (schema `simgap-diagnosis/1`).
//!
//! Shares are between 0 and 1. Numbers that are not finite (an interval along a direction the data
//! do not see) are written as null.

use serde::Serialize;
use simgap_effects::unit_of_rotation;
use simgap_model::Location;

use crate::units::turns;

/// The whole result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diagnosis {
    /// `simgap-diagnosis/1`.
    pub schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// How large the gap is, before and after.
    pub gap: Gap,
    /// Where it lies.
    pub r#where: Where,
    /// Which effect causes it.
    pub verdict: Verdict,
    /// Nodes that turn: forces on them are torques in N m, their displacements angles in rad, their masses inertias in kg m^2.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub turning: Vec<String>,
    /// The single effects that fit best, at most twelve, by probability and then by gap.
    pub candidates: Vec<CandidateResult>,
    /// The experiment that would tell the rivals apart, if there are any.
    pub next_experiment: Option<String>,
    /// Whether the search ended before it was done, by the limit it was given.
    pub stopped_early: bool,
    /// What a reader must know: how records were held back, units converted, defects seen.
    pub notes: Vec<String>,
}

impl Diagnosis {
    /// The unit of a quantity at a place: as given along a line, of a rotation where the place turns.
    #[must_use]
    pub fn unit_at(&self, unit: &str, at: &Location) -> String {
        match turns(&self.turning, at) {
            true => unit_of_rotation(unit),
            false => unit.to_string(),
        }
    }
}

/// The gap on the check records.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gap {
    /// `nrmse`.
    pub metric: &'static str,
    /// With the model as given.
    pub nominal: f64,
    /// With its nominal parameters re-estimated.
    pub recalibrated: f64,
    /// With the named effects.
    pub corrected: f64,
    /// What white measurement noise alone would leave.
    pub noise_floor: f64,
    /// What the noise that is seen on the inputs does besides: even the true model, driven by the inputs as they
    /// were measured, leaves it.
    pub input_noise: f64,
    /// 1 − sqrt(max(corrected² − floor², 0) / max(nominal² − floor², tiny)).
    pub closed: f64,
    /// Channel by channel.
    pub channels: Vec<ChannelGap>,
}

/// The gap of one channel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelGap {
    /// Output channel.
    pub channel: String,
    /// As in [`Gap`].
    pub nominal: f64,
    /// As in [`Gap`].
    pub recalibrated: f64,
    /// As in [`Gap`].
    pub corrected: f64,
    /// As in [`Gap`].
    pub noise_floor: f64,
    /// As in [`Gap`].
    pub input_noise: f64,
}

/// Where the discrepancy of the nominal model lies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Where {
    /// Over the output channels.
    pub channels: Vec<ChannelShare>,
    /// Over the places of the model: where the named effects and their rivals sit, each by its
    /// probability and by what it explains.
    pub locations: Vec<LocationShare>,
    /// Over frequency.
    pub bands: Vec<BandShare>,
    /// Over time.
    pub times: Vec<TimeShare>,
    /// Over the state of motion.
    pub states: Vec<StateShare>,
    /// Over the records.
    pub records: Vec<RecordShare>,
}

/// Share of one channel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelShare {
    /// Output channel.
    pub channel: String,
    /// Of the normalised squared discrepancy.
    pub share: f64,
}

/// Share of one place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LocationShare {
    /// The place.
    pub at: Location,
    /// Of the squared discrepancy, relative to the other places.
    pub share: f64,
}

/// Share of one frequency band.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BandShare {
    /// Hz.
    pub from_hz: f64,
    /// Hz.
    pub to_hz: f64,
    /// What the band is, in words.
    pub label: String,
    /// Of the squared discrepancy.
    pub share: f64,
}

/// Share of one stretch of time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimeShare {
    /// Record.
    pub record: String,
    /// s.
    pub from_s: f64,
    /// s.
    pub to_s: f64,
    /// Of the squared discrepancy of all records.
    pub share: f64,
}

/// Share of one region of motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateShare {
    /// What the region is, in words.
    pub label: String,
    /// `displacement` or `velocity`.
    pub variable: &'static str,
    /// The mass, or the two nodes `a to b`.
    pub at: String,
    /// SI.
    pub from: f64,
    /// SI.
    pub to: f64,
    /// Of the squared discrepancy.
    pub share: f64,
    /// Of the time; a share far above it marks the region.
    pub occupancy: f64,
}

/// Share of one record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordShare {
    /// Record.
    pub record: String,
    /// Of the squared discrepancy.
    pub share: f64,
}

/// What kind of answer the data allow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The gap is noise.
    None,
    /// Re-estimating nominal parameters closes it.
    Parameters,
    /// One or more effects are named.
    Effect,
    /// There is structure that no catalogue entry explains.
    Unknown,
}

/// The answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Kind of answer.
    pub status: Status,
    /// What is left of the check records is no more than noise and the accuracy of the simulation.
    pub complete: bool,
    /// What is left of them.
    pub unexplained: Unexplained,
    /// The check records contradict what the training records say.
    pub refuted: bool,
    /// The main cause may be a law that the catalogue lacks.
    pub other: OtherCause,
    /// The named effects; empty for `none` and `unknown`.
    pub effects: Vec<NamedEffect>,
    /// For `unknown`: the best set of the catalogue all the same.
    pub leading: Vec<NamedEffect>,
    /// For `unknown`: what the remaining structure looks like. One sentence each.
    pub description: Vec<String>,
}

impl Default for Verdict {
    /// Nothing but noise.
    fn default() -> Verdict {
        Verdict {
            status: Status::None,
            complete: true,
            unexplained: Unexplained::default(),
            refuted: false,
            other: OtherCause::default(),
            effects: vec![],
            leading: vec![],
            description: vec![],
        }
    }
}

/// What an answer leaves of the gap on the check records.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Unexplained {
    /// rms of what is left above noise, over the rms of the gap of the model as given.
    pub share: f64,
    /// `gap`: what the share is of.
    pub of: &'static str,
    /// The same of each channel, of the gap of all.
    pub channels: Vec<ChannelShare>,
    /// In words; empty where nothing is left.
    pub looks_like: String,
}

/// A cause that is not in the catalogue.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct OtherCause {
    /// That it is the main cause.
    pub probability: f64,
    /// The place where a free law closes most; `None` where none was sought.
    pub at: Option<Location>,
    /// Share of the gap of the training records that a free law there closes.
    pub closed: Option<f64>,
}

/// A named effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NamedEffect {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Probability that it, or one of `indistinguishable`, is part of the cause.
    pub probability: f64,
    /// Estimated values.
    pub parameters: Vec<NamedParameter>,
    /// What this data cannot tell from it.
    pub indistinguishable: Vec<Rival>,
    /// Why it is named, one sentence each.
    pub evidence: Vec<String>,
}

/// An estimated value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NamedParameter {
    /// Name with the unit in it, as the model file has it: that of a motion along a line.
    pub name: String,
    /// Unit, SI: `N m` for a force where the place turns, that of the channel in a channel, that of a law of the
    /// model file as stated there; empty for a pure number.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// What the data cannot tell from a named effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rival {
    /// Catalogue name.
    pub kind: String,
    /// Where it would act.
    pub at: Location,
    /// Why not.
    pub because: String,
}

/// A single effect that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CandidateResult {
    /// Catalogue name.
    pub kind: String,
    /// Where it would act.
    pub at: Location,
    /// Its nrmse on the check records.
    pub held_back_gap: f64,
    /// Probability that it belongs to the cause.
    pub probability: f64,
}

/// One check record with its predictions, in the units of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckSeries {
    /// File name of the record.
    pub record: String,
    /// The record's own time stamps, s.
    pub time_s: Vec<f64>,
    /// One entry for each output of the model.
    pub channels: Vec<ChannelSeries>,
}

/// One output of a check record.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelSeries {
    /// Output channel.
    pub channel: String,
    /// Unit of the model, such as `m`.
    pub unit: &'static str,
    /// As measured.
    pub measured: Vec<f64>,
    /// Predicted by the model as given.
    pub nominal: Vec<f64>,
    /// Predicted with the named effects.
    pub corrected: Vec<f64>,
}

/// The motion across one place along a check record, as the model as given predicts it.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceMotion {
    /// File name of the record.
    pub record: String,
    /// The place.
    pub at: Location,
    /// One value for each sample, m.
    pub displacement: Vec<f64>,
    /// One value for each sample, m/s.
    pub velocity: Vec<f64>,
}
