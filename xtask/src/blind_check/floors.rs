//! What a campaign must reach at least to pass.

use simgap_blind::{Share, Totals};

/// Lowest figures that pass.
struct Floors {
    /// One effect: its kind, or one that no data tell from it, is named first.
    first_or_same: f64,
    /// Noise alone: nothing blamed.
    clean: f64,
    /// Stated closing within 0.05 of the true one.
    stated: f64,
}

const FLOORS: Floors = Floors {
    first_or_same: 0.5,
    clean: 0.5,
    stated: 0.5,
};

/// One line for each figure that is too low; a figure over no cases holds nothing back.
pub(super) fn below(totals: &Totals, failed: usize) -> Vec<String> {
    let mut faults = vec![];
    let mut hold = |what: &str, share: Share, least: f64| {
        if share.value() < least {
            let Share { hits, of } = share;
            faults.push(format!(
                "{what}: {hits} of {of}, needed is a share of {least}"
            ));
        }
    };
    hold(
        "true kind named first",
        totals.first_or_same,
        FLOORS.first_or_same,
    );
    hold("nothing blamed for noise", totals.clean(), FLOORS.clean);
    hold("stated against true closing", totals.stated, FLOORS.stated);
    if failed > 0 {
        faults.push(format!("{failed} cases could not be diagnosed"));
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_figures_below_their_floors_are_faults() {
        let nothing = Totals::of(&[]);
        assert!(below(&nothing, 0).is_empty());
        assert_eq!(below(&nothing, 2), ["2 cases could not be diagnosed"]);
        let poor = Totals {
            first_or_same: Share { hits: 1, of: 9 },
            exact: Share { hits: 0, of: 1 },
            stated: Share { hits: 1, of: 10 },
            ..nothing
        };
        let faults = below(&poor, 0);
        assert_eq!(faults.len(), 3);
        assert!(faults[0].starts_with("true kind named first: 1 of 9"));
    }
}
