//! From data to the unit interval, and round numbers for the ticks.

/// Beyond this a number is treated as not finite: differences would overflow.
const LARGEST: f64 = 1e150;
/// A span below this fraction of its values is shown as constant: tick labels could not differ.
const LEAST_RELATIVE_SPAN: f64 = 1e-10;
/// Room left free at both ends of an automatic linear axis, relative to its span.
const PADDING: f64 = 0.04;
/// Decades that a logarithmic axis shows below its largest value when the data would reach lower.
const MOST_DECADES: f64 = 12.0;

/// A drawn axis: how values map to 0..1 and where the ticks lie.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// Ends, log10 of the value on a logarithmic axis.
    lo: f64,
    hi: f64,
    log: bool,
    /// Labelled positions, 0..1.
    pub(crate) ticks: Vec<(f64, String)>,
    /// Further grid lines without a label, 0..1.
    pub(crate) minor: Vec<f64>,
    /// Power of ten taken out of the labels; 0 for none.
    pub(crate) exponent: i32,
}

/// Whether an axis of that kind can show `value`.
pub(crate) fn shows(value: f64, log: bool) -> bool {
    value.abs() <= LARGEST && (!log || value >= 1.0 / LARGEST)
}

/// Smallest and largest of the values the axis can show.
pub(crate) fn extent(values: impl Iterator<Item = f64>, log: bool) -> Option<[f64; 2]> {
    values.filter(|v| shows(*v, log)).fold(None, |e, v| {
        Some(e.map_or([v, v], |[lo, hi]: [f64; 2]| [lo.min(v), hi.max(v)]))
    })
}

impl Axis {
    /// An axis over `extent` with room at its ends; about `tick_count` ticks.
    pub(crate) fn around(
        extent: Option<[f64; 2]>,
        log: bool,
        padded: bool,
        tick_count: usize,
    ) -> Self {
        let Some([lo, hi]) = extent else {
            return Self::exactly(if log { [0.1, 1.0] } else { [0.0, 1.0] }, log, tick_count);
        };
        if log {
            let (lo, hi) = (lo.log10(), hi.log10());
            let lo = lo.max(hi - MOST_DECADES);
            let pad = if hi - lo < 0.3 {
                0.5
            } else {
                PADDING * (hi - lo) * f64::from(u8::from(padded))
            };
            return Self::logarithmic(lo - pad, hi + pad, tick_count);
        }
        let size = lo.abs().max(hi.abs());
        let (lo, hi) = if hi - lo > LEAST_RELATIVE_SPAN * size && hi - lo > 1.0 / LARGEST {
            let pad = if padded { PADDING * (hi - lo) } else { 0.0 };
            (lo - pad, hi + pad)
        } else if size > 1.0 / LARGEST {
            (lo - 0.1 * size, hi + 0.1 * size)
        } else {
            (-1.0, 1.0)
        };
        Self::linear(lo, hi, tick_count)
    }

    /// An axis from `range[0]` to `range[1]`, which the caller has checked.
    pub(crate) fn exactly(range: [f64; 2], log: bool, tick_count: usize) -> Self {
        if log {
            Self::logarithmic(range[0].log10(), range[1].log10(), tick_count)
        } else {
            Self::linear(range[0], range[1], tick_count)
        }
    }

    fn linear(lo: f64, hi: f64, tick_count: usize) -> Self {
        let place = |step: f64| -> Vec<f64> {
            let first = (lo / step - 1e-9).ceil();
            (0..=4 * tick_count)
                .map(|k| (first + k as f64) * step)
                .take_while(|v| *v <= hi + 1e-9 * step)
                .collect()
        };
        let mut step = nice_step((hi - lo) / tick_count.max(2) as f64);
        let mut values = place(step);
        if values.len() < 3 {
            // Rounding up has taken too many away.
            step = nice_step((hi - lo) / (2 * tick_count.max(2)) as f64);
            values = place(step);
        }
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let exponent = common_exponent(largest);
        let scale = 10f64.powi(-exponent);
        let decimals = decimals_for(step * scale);
        let mut axis = Self {
            lo,
            hi,
            log: false,
            ticks: Vec::new(),
            minor: Vec::new(),
            exponent,
        };
        axis.ticks = values
            .iter()
            .map(|v| (axis.position(*v), plain(v * scale, decimals)))
            .collect();
        axis
    }

    fn logarithmic(lo: f64, hi: f64, tick_count: usize) -> Self {
        let mut axis = Self {
            lo,
            hi,
            log: true,
            ticks: Vec::new(),
            minor: Vec::new(),
            exponent: 0,
        };
        let within = |e: f64| (lo - 1e-9..=hi + 1e-9).contains(&e);
        let decades: Vec<i32> = (lo.floor() as i32..=hi.ceil() as i32).collect();
        let stride = (decades.len() / tick_count.max(2)).max(1) as i32;
        let plain_labels = lo >= -3.01 && hi <= 4.01;
        let few = hi - lo < 2.0;
        for &decade in &decades {
            for digit in 1..10 {
                let e = f64::from(decade) + f64::from(digit).log10();
                if !within(e) {
                    continue;
                }
                let at = (e - lo) / (hi - lo);
                let labelled = (digit == 1 && decade.rem_euclid(stride) == 0)
                    || (few && (digit == 2 || digit == 5))
                    || hi - lo < 0.5;
                if labelled {
                    axis.ticks
                        .push((at, log_label(digit, decade, plain_labels)));
                } else if decades.len() < 8 || digit == 1 {
                    axis.minor.push(at);
                }
            }
        }
        axis
    }

    /// What the axis shows, with the power of ten that its numbers leave out.
    pub(crate) fn name(&self, label: &str) -> String {
        if label.is_empty() || self.exponent == 0 {
            return label.to_owned();
        }
        let power = format!("10{}", superscript(self.exponent));
        // A pure number is counted in that power.
        match label.strip_suffix("[1]") {
            Some(of) => format!("{of}[{power}]"),
            None => format!("{label} (×{power})"),
        }
    }

    /// Position of a value that [`shows`], 0 at the lower end and 1 at the upper.
    pub(crate) fn position(&self, value: f64) -> f64 {
        let v = if self.log { value.log10() } else { value };
        (v - self.lo) / (self.hi - self.lo)
    }
}

/// The next of 1, 2, 5 times a power of ten at or above `step`.
fn nice_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let digit = step / power;
    let nice = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|n| digit <= n * (1.0 + 1e-9));
    nice.unwrap_or(10.0) * power
}

/// A multiple of three to take out of labels that would otherwise be long.
fn common_exponent(largest: f64) -> i32 {
    if largest == 0.0 || (1e-2..1e5).contains(&largest) {
        return 0;
    }
    // Powers up to LARGEST fit an i32.
    (largest.log10() / 3.0).floor() as i32 * 3
}

fn decimals_for(step: f64) -> usize {
    (-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize
}

/// Fixed decimals with a true minus sign, and no sign on zero.
fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

fn log_label(digit: i32, decade: i32, plain_label: bool) -> String {
    if plain_label {
        let decimals = usize::try_from(-decade).unwrap_or(0);
        return plain(f64::from(digit) * 10f64.powi(decade), decimals);
    }
    let power = format!("10{}", superscript(decade));
    if digit == 1 {
        power
    } else {
        format!("{digit}·{power}")
    }
}

/// An integer in superscript digits.
pub(crate) fn superscript(n: i32) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            _ => '⁰',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn verify_linear_ticks_are_round() {
        let axis = Axis::exactly([-0.31, 0.52], false, 5);
        assert_eq!(labels(&axis), ["−0.2", "0.0", "0.2", "0.4"]);
        let axis = Axis::exactly([0.0, 60.0], false, 6);
        assert_eq!(labels(&axis), ["0", "10", "20", "30", "40", "50", "60"]);
    }

    #[test]
    fn verify_small_and_large_values_share_a_power_of_a_thousand() {
        let axis = Axis::exactly([0.0, 4.2e-5], false, 4);
        assert_eq!((axis.exponent, labels(&axis)), (-6, vec!["0", "20", "40"]));
        assert_eq!(axis.name("gap [1]"), "gap [10⁻⁶]");
        assert_eq!(axis.name("y [kN]"), "y [kN] (×10⁻⁶)");
        assert_eq!(axis.name(""), "");
        let axis = Axis::exactly([0.0, 3e6], false, 3);
        assert_eq!(
            (axis.exponent, labels(&axis)),
            (6, vec!["0", "1", "2", "3"])
        );
    }

    #[test]
    fn verify_log_ticks_are_decades() {
        let axis = Axis::exactly([1e-9, 1e-3], true, 7);
        assert_eq!(labels(&axis)[0], "10⁻⁹");
        assert_eq!(axis.ticks.len(), 7);
        let axis = Axis::exactly([0.1, 10.0], true, 5);
        assert_eq!(labels(&axis), ["0.1", "1", "10"]);
        let axis = Axis::exactly([1.0, 50.0], true, 5);
        assert_eq!(labels(&axis), ["1", "2", "5", "10", "20", "50"]);
    }

    #[test]
    fn verify_constant_and_absent_data_have_an_axis() {
        for value in [0.0, 3.0, -1e140, 1e-200] {
            let axis = Axis::around(extent([value].into_iter(), false), false, true, 5);
            assert!(axis.ticks.len() >= 2, "{value}");
            assert!((axis.position(value) - 0.5).abs() < 1e-9, "{value}");
        }
        assert!(Axis::around(None, true, true, 5).ticks.len() >= 2);
    }

    proptest! {
        #[test]
        fn prop_positions_and_ticks_lie_inside(a in -1e9..1e9f64, span in 1e-6..1e9f64, log: bool) {
            let values = if log { [span, span * 10.0] } else { [a, a + span] };
            let axis = Axis::around(extent(values.into_iter(), log), log, true, 6);
            let inside = -1e-9..=1.0 + 1e-9;
            prop_assert!(values.iter().all(|v| inside.contains(&axis.position(*v))));
            prop_assert!(axis.ticks.iter().all(|(p, _)| inside.contains(p)));
            prop_assert!((2..=13).contains(&axis.ticks.len()));
        }
    }
}
