//! The stretch of a record that tells most, and its like.

/// A stretch shows about this many swings.
const SWINGS: f64 = 8.0;
/// Shortest and longest stretch, relative to the record.
const SHORTEST: f64 = 0.005;
const LONGEST: f64 = 0.3;
/// A record with fewer samples is shown whole.
const FEW_SAMPLES: usize = 200;

/// First and one-past-last sample of the stretch where `off` carries the largest sum of squares,
/// long enough to show several swings of `signal`. `None` for a record that is short anyway.
pub(crate) fn telling_stretch(signal: &[f64], off: &[f64]) -> Option<(usize, usize)> {
    let n = signal.len().min(off.len());
    if n < FEW_SAMPLES {
        return None;
    }
    let swings = (crossings(&signal[..n]) / 2).max(1);
    let share = (SWINGS / swings as f64).clamp(SHORTEST, LONGEST);
    let len = ((share * n as f64).ceil() as usize).clamp(FEW_SAMPLES / 2, n);
    let mut sum = vec![0.0; n + 1];
    for i in 0..n {
        let d = if off[i].is_finite() { off[i] } else { 0.0 };
        sum[i + 1] = sum[i] + d * d;
    }
    let worst = (0..=n - len).fold(0, |best, i| {
        if sum[i + len] - sum[i] > sum[best + len] - sum[best] {
            i
        } else {
            best
        }
    });
    Some((worst, worst + len))
}

/// How often a signal passes through its mean, small ripples left aside.
fn crossings(signal: &[f64]) -> usize {
    let finite = || signal.iter().copied().filter(|v| v.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    let band = 0.3 * (finite().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
    let mut side = 0;
    let mut passed = 0;
    for v in finite() {
        let now = if v > mean + band {
            1
        } else if v < mean - band {
            -1
        } else {
            side
        };
        if side != 0 && now != side {
            passed += 1;
        }
        side = now;
    }
    passed
}

/// The longest run of finite values: first and one-past-last index.
pub(crate) fn longest_finite_run(values: &[f64]) -> (usize, usize) {
    let (mut best, mut start) = ((0, 0), 0);
    for (i, v) in values.iter().enumerate() {
        if !v.is_finite() {
            start = i + 1;
        } else if i + 1 - start > best.1 - best.0 {
            best = (start, i + 1);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_stretch_covers_the_burst() {
        let signal: Vec<f64> = (0..10_000).map(|n| (f64::from(n) * 0.05).sin()).collect();
        let off: Vec<f64> = (0..10_000)
            .map(|n| if (7000..7200).contains(&n) { 1.0 } else { 0.01 })
            .collect();
        let (from, to) = telling_stretch(&signal, &off).expect("a long record");
        assert!(from <= 7000 && to >= 7200, "{from} {to}");
        // 8 swings of 126 samples.
        assert!((900..1150).contains(&(to - from)), "{}", to - from);
    }

    #[test]
    fn verify_odd_records_have_a_stretch_or_none() {
        assert_eq!(telling_stretch(&[], &[]), None);
        assert_eq!(telling_stretch(&[1.0; 199], &[1.0; 199]), None);
        let nan = vec![f64::NAN; 1000];
        assert_eq!(telling_stretch(&nan, &nan), Some((0, 300)));
        assert_eq!(longest_finite_run(&[1.0, f64::NAN, 1.0, 2.0]), (2, 4));
        assert_eq!(longest_finite_run(&nan), (0, 0));
    }
}
