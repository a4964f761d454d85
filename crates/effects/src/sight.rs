//! Values that records do not show.

use crate::SiteScale;

/// A value whose interval spans more than this factor is not seen.
const UNSEEN: f64 = 10.0;

/// Whether records hardly show a value, by its interval: it spans more than a factor of ten, or zero.
#[must_use]
pub fn is_unseen([low, high]: [f64; 2]) -> bool {
    !(low.is_finite() && high.is_finite()) || low <= 0.0 && high > 0.0 || high / low > UNSEEN
}

/// Whether a displacement from which a spring yields is out of sight, and beyond the motion by all that is known of it.
pub(crate) fn is_beyond_motion(interval: [f64; 2], scale: &SiteScale) -> bool {
    let [low, high] = interval;
    let [least, most] = scale.displacement_range_m;
    is_unseen(interval) && (low.max(0.0) * high).sqrt() > 0.5 * (most - least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_yields_beyond_the_motion_is_out_of_sight() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        assert!(is_beyond_motion([2e-3, 0.2], &scale));
        // Seen, or within the motion.
        assert!(!is_beyond_motion([0.1, 0.2], &scale));
        assert!(!is_beyond_motion([1e-6, 1e-4], &scale));
        assert!(!is_beyond_motion([0.0, 0.2], &scale));
    }
}
