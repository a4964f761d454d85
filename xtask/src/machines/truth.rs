//! What is known of a machine, and whether an answer says so.

use serde::Deserialize;
use simgap_rigs::Answer;

/// `truth.json`.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Truth {
    /// The kinds of which one named first is right, the best first; none where there is nothing to name.
    pub(super) accepted: Vec<String>,
    /// Whether wrong nominal values are a right answer.
    #[serde(default)]
    pub(super) parameters_ok: bool,
    /// Whether the catalogue has no honest name for the cause.
    #[serde(default)]
    pub(super) unknown_ok: bool,
    /// Whether its stamps are uneven, so that the records are resampled.
    #[serde(default)]
    pub(super) mend: bool,
    /// What it is, and how it is known.
    pub(super) cause: String,
    /// What a fit by hand reaches on the check record.
    #[serde(default)]
    pub(super) by_hand: Option<ByHand>,
    /// Repository and files.
    pub(super) source: String,
    /// Of the measurements.
    pub(super) licence: String,
}

/// rms(measured − predicted) / std(measured) of a fit by hand, on the check record.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct ByHand {
    /// With nominal parameters re-estimated.
    #[serde(default)]
    pub(super) recalibrated: Option<f64>,
    /// With the cause.
    #[serde(default)]
    pub(super) with_cause: Option<f64>,
}

/// An answer beside the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judged {
    /// The cause is named first, or nothing is blamed where there is nothing.
    Right,
    /// The cause is among what cannot be told from the kind named first.
    Declared,
    /// `unknown` where there is a name, or nothing said where there is a cause.
    Unnamed,
    /// Another cause is named first.
    Wrong,
    /// The program gave no answer.
    Failed,
}

impl Judged {
    pub(super) fn name(self) -> &'static str {
        match self {
            Judged::Right => "right",
            Judged::Declared => "declared",
            Judged::Unnamed => "not named",
            Judged::Wrong => "wrong",
            Judged::Failed => "no answer",
        }
    }
}

impl Truth {
    pub(super) fn judge(&self, answer: &Answer) -> Judged {
        let Some(diagnosis) = &answer.diagnosis else {
            return Judged::Failed;
        };
        let verdict = &diagnosis.verdict;
        let is_accepted = |kind: &str| self.accepted.iter().any(|known| known == kind);
        let is_control = self.accepted.is_empty();
        let Some(first) = verdict.effects.first() else {
            let is_open = verdict.status == "unknown" && self.unknown_ok;
            return if is_control || is_open {
                Judged::Right
            } else {
                Judged::Unnamed
            };
        };
        let of_parameters = verdict.status == "parameters";
        if is_accepted(&first.kind) || (of_parameters && (self.parameters_ok || is_control)) {
            Judged::Right
        } else if first.indistinguishable.iter().any(|o| is_accepted(&o.kind)) {
            Judged::Declared
        } else {
            Judged::Wrong
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(accepted: &[&str]) -> Truth {
        Truth {
            accepted: accepted.iter().map(|kind| (*kind).into()).collect(),
            parameters_ok: false,
            unknown_ok: false,
            mend: false,
            cause: String::new(),
            by_hand: None,
            source: String::new(),
            licence: String::new(),
        }
    }

    fn answer(verdict: &str) -> Answer {
        Answer {
            diagnosis: serde_json::from_str(&format!("{{\"verdict\": {verdict}}}")).unwrap(),
            failure: String::new(),
            seconds: 1.0,
        }
    }

    #[test]
    fn verify_answers_are_judged_by_what_is_named_first() {
        let friction = truth(&["coulomb_friction", "presliding_friction"]);
        let effect = |kind: &str, other: &str| {
            let other = format!("{{\"kind\": \"{other}\", \"at\": {{}}}}");
            answer(&format!(
                "{{\"status\": \"effect\", \"effects\": [{{\"kind\": \"{kind}\", \"at\": {{}}, \
                 \"indistinguishable\": [{other}]}}]}}"
            ))
        };
        let judged = |kind, other| friction.judge(&effect(kind, other));
        assert_eq!(judged("presliding_friction", "backlash"), Judged::Right);
        assert_eq!(judged("backlash", "coulomb_friction"), Judged::Declared);
        assert_eq!(judged("backlash", "end_stop"), Judged::Wrong);
        let unknown = answer("{\"status\": \"unknown\"}");
        assert_eq!(friction.judge(&unknown), Judged::Unnamed);
        let open = Truth {
            unknown_ok: true,
            ..friction.clone()
        };
        assert_eq!(open.judge(&unknown), Judged::Right);
        assert_eq!(truth(&[]).judge(&unknown), Judged::Right);
        let parameters = answer(
            "{\"status\": \"parameters\", \"effects\": [{\"kind\": \"mass_error\", \"at\": {}}]}",
        );
        assert_eq!(friction.judge(&parameters), Judged::Wrong);
        assert_eq!(truth(&[]).judge(&parameters), Judged::Right);
        assert_eq!(
            truth(&[]).judge(&effect("backlash", "end_stop")),
            Judged::Wrong
        );
        assert_eq!(
            truth(&[]).judge(&answer("{\"status\": \"none\"}")),
            Judged::Right
        );
        assert_eq!(
            friction.judge(&answer("{\"status\": \"none\"}")),
            Judged::Unnamed
        );
        let failed = Answer {
            diagnosis: None,
            ..unknown
        };
        assert_eq!(friction.judge(&failed), Judged::Failed);
    }
}
