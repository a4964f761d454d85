//! Frequency bands as they are told: neighbours of one name together, names without idle digits.

use simgap_diagnose::BandShare;

use crate::number::{fewer_digits, range};

/// A band whose ends are further apart than this factor has no frequency of its own.
const SPREAD: f64 = 10.0;
const SPREAD_LABEL: &str = "spread over";

/// One band, ready to be told.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Band {
    pub(crate) from_hz: f64,
    pub(crate) to_hz: f64,
    /// What it is, such as "near the natural frequency 68.33 Hz"; empty if it has no name.
    pub(crate) label: String,
    pub(crate) share: f64,
}

impl Band {
    /// Its name with its ends: "the excitation at 2 Hz (1.7–2.3 Hz)".
    pub(crate) fn name(&self) -> String {
        let range = range(self.from_hz, self.to_hz, "Hz");
        if self.label.is_empty() {
            range
        } else if self.is_spread() {
            format!("{} {range}", self.label)
        } else {
            format!("{} ({range})", self.label)
        }
    }

    /// Whether it has no frequency of its own.
    pub(crate) fn is_spread(&self) -> bool {
        self.label == SPREAD_LABEL
    }
}

/// The bands, the strongest first. Neighbours of one name that lie no further apart than they are
/// wide become one.
pub(crate) fn told(bands: &[BandShare]) -> Vec<Band> {
    let mut rising: Vec<Band> = bands.iter().map(band).collect();
    rising.sort_by(|a, b| a.from_hz.total_cmp(&b.from_hz));
    let mut out: Vec<Band> = Vec::new();
    for band in rising {
        let width = band.to_hz - band.from_hz;
        match out.iter_mut().rev().find(|last| last.label == band.label) {
            Some(last) if band.from_hz - last.to_hz <= width.max(last.to_hz - last.from_hz) => {
                last.to_hz = last.to_hz.max(band.to_hz);
                last.share += band.share;
            }
            _ => out.push(band),
        }
    }
    out.sort_by(|a, b| b.share.total_cmp(&a.share));
    out
}

fn band(band: &BandShare) -> Band {
    let spread = band.from_hz > 0.0 && band.to_hz > SPREAD * band.from_hz;
    let label = if spread && band.label.starts_with("around ") {
        SPREAD_LABEL.to_owned()
    } else {
        fewer_digits(&band.label)
    };
    Band {
        from_hz: band.from_hz,
        to_hz: band.to_hz,
        label,
        share: band.share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(from_hz: f64, to_hz: f64, label: &str, share: f64) -> BandShare {
        BandShare {
            from_hz,
            to_hz,
            label: label.into(),
            share,
        }
    }

    #[test]
    fn verify_neighbours_of_one_name_become_one() {
        let mode = "near the natural frequency 68.3301 Hz";
        let bands = [
            share(66.6, 69.2, mode, 0.31),
            share(0.0, 0.03, "constant", 0.4),
            share(71.0, 72.1, mode, 0.11),
            share(69.2, 71.0, mode, 0.23),
            share(300.0, 301.0, mode, 0.02),
        ];
        let found = told(&bands);
        assert_eq!(found.len(), 3);
        assert_eq!(
            found[0].name(),
            "near the natural frequency 68.33 Hz (66.6–72.1\u{a0}Hz)"
        );
        assert!((found[0].share - 0.65).abs() < 1e-12);
        // Far away it is another one.
        assert!((found[2].share - 0.02).abs() < 1e-12);
    }

    #[test]
    fn verify_a_band_over_all_frequencies_has_no_frequency() {
        let found = told(&[share(0.1, 49.9, "around 23.4000 Hz", 1.0)]);
        assert_eq!(found[0].name(), "spread over 0.1–49.9\u{a0}Hz");
    }
}
