//! Long lines thinned to what a screen can show.

/// Columns whose samples are reduced to their extremes are this wide, px.
const COLUMN_PX: f64 = 2.0;
/// Samples a column may hold untouched.
const FREE_SAMPLES: usize = 2;

/// A path in pixels, with every run of consecutive samples in one column reduced to its lowest
/// and highest in the order they came.
///
/// A rising abscissa (a time record) leaves at most two points per column. Where the abscissa
/// turns back (a hysteresis loop), the first and last sample of a run are kept too, so that the
/// path enters and leaves the column where the data do.
pub(crate) fn thin(path: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let rising = path.windows(2).all(|w| w[0].0 <= w[1].0);
    let column = |p: &(f64, f64)| (p.0 / COLUMN_PX).floor();
    let mut out = Vec::with_capacity(path.len().min(4096));
    let mut start = 0;
    while start < path.len() {
        let here = column(&path[start]);
        let end = path[start..]
            .iter()
            .position(|p| column(p) != here)
            .map_or(path.len(), |n| start + n);
        keep_extremes(&path[start..end], rising, &mut out);
        start = end;
    }
    out
}

fn keep_extremes(run: &[(f64, f64)], rising: bool, out: &mut Vec<(f64, f64)>) {
    if run.len() <= FREE_SAMPLES {
        out.extend_from_slice(run);
        return;
    }
    let (mut low, mut high) = (0, 0);
    for (i, p) in run.iter().enumerate() {
        if p.1 < run[low].1 {
            low = i;
        }
        if p.1 > run[high].1 {
            high = i;
        }
    }
    let mut kept = vec![low, high];
    if !rising {
        kept.extend([0, run.len() - 1]);
    }
    kept.sort_unstable();
    kept.dedup();
    out.extend(kept.into_iter().map(|i| run[i]));
}

/// About `budget` indices at which series over a common rising abscissa are worth keeping: in each
/// of many equal runs of samples those where a series is lowest or highest. Half of the budget goes
/// to the samples inside `home`.
pub(crate) fn telling(
    x: &[f64],
    series: &[&[f64]],
    budget: usize,
    home: Option<[f64; 2]>,
) -> Vec<usize> {
    let n = x.len();
    if n <= budget {
        return (0..n).collect();
    }
    let Some([from, to]) = home else {
        return extremes(0..n, series, budget);
    };
    let first = x.partition_point(|v| *v < from);
    let last = x.partition_point(|v| *v <= to).max(first);
    let mut kept = extremes(0..n, series, budget / 2);
    kept.extend(extremes(first..last, series, budget / 2));
    kept.sort_unstable();
    kept.dedup();
    kept
}

fn extremes(range: std::ops::Range<usize>, series: &[&[f64]], budget: usize) -> Vec<usize> {
    if range.len() <= budget {
        return range.collect();
    }
    let runs = (budget / (2 * series.len().max(1))).max(1);
    let len = range.len().div_ceil(runs).max(1);
    let mut out = vec![range.start, range.end - 1];
    for start in range.clone().step_by(len) {
        let run = start..(start + len).min(range.end);
        for y in series {
            out.extend(lowest_and_highest(y, run.clone()));
        }
    }
    out.sort_unstable();
    out.dedup();
    out
}

/// Where the finite values of a run are lowest and highest.
fn lowest_and_highest(y: &[f64], run: std::ops::Range<usize>) -> impl Iterator<Item = usize> {
    let (mut low, mut high) = ((f64::INFINITY, None), (f64::NEG_INFINITY, None));
    for (i, &v) in run.clone().zip(y.get(run).unwrap_or_default()) {
        if v < low.0 {
            low = (v, Some(i));
        }
        if v > high.0 && v < f64::INFINITY {
            high = (v, Some(i));
        }
    }
    low.1
        .filter(|_| low.0 > f64::NEG_INFINITY)
        .into_iter()
        .chain(high.1)
}

/// Points of which at most one lies in each square pixel, in the order they came.
pub(crate) fn thin_points(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut seen = std::collections::BTreeSet::new();
    points
        .iter()
        .copied()
        .filter(|p| seen.insert((p.0.round() as i32, p.1.round() as i32)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn verify_a_long_record_becomes_two_points_per_column() {
        let path: Vec<(f64, f64)> = (0..60_000)
            .map(|n| (f64::from(n) / 100.0, f64::from(n).sin()))
            .collect();
        assert_eq!(thin(&path).len(), 600);
    }

    #[test]
    fn verify_a_loop_keeps_its_ends() {
        let path: Vec<(f64, f64)> = (0..1000)
            .map(|n| {
                let a = f64::from(n) * 0.02;
                (100.0 * a.cos(), 100.0 * a.sin())
            })
            .collect();
        let thinned = thin(&path);
        assert_eq!(thinned.first(), path.first());
        assert_eq!(thinned.last(), path.last());
    }

    #[test]
    fn verify_what_tells_is_kept_within_the_budget() {
        let x: Vec<f64> = (0..100_000).map(|n| f64::from(n) * 1e-3).collect();
        let mut y: Vec<f64> = x.iter().map(|x| x.sin()).collect();
        y[70_001] = 9.0;
        let kept = telling(&x, &[&y], 1000, Some([20.0, 20.3]));
        assert!((700..=1010).contains(&kept.len()), "{}", kept.len());
        assert!(kept.contains(&70_001) && kept.contains(&0) && kept.contains(&99_999));
        // Every sample of the home stretch.
        assert!((20_001..20_300).all(|i| kept.contains(&i)));
        assert_eq!(telling(&x[..5], &[&y[..5]], 10, None), [0, 1, 2, 3, 4]);
    }

    proptest! {
        #[test]
        fn prop_extremes_survive(ys in prop::collection::vec(-1e3..1e3f64, 1..2000)) {
            let path: Vec<(f64, f64)> = ys.iter().enumerate().map(|(i, y)| (i as f64 / 50.0, *y)).collect();
            let thinned = thin(&path);
            let fold = |p: &[(f64, f64)]| p.iter().fold([f64::MAX, f64::MIN], |[a, b], p| [a.min(p.1), b.max(p.1)]);
            prop_assert_eq!(fold(&path), fold(&thinned));
            prop_assert!(thinned.iter().all(|p| path.contains(p)));
            prop_assert!(thinned.windows(2).all(|w| w[0].0 <= w[1].0));
        }
    }
}
