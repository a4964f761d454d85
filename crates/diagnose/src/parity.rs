//! Which samples of a record are the even ones of the converter.
//!
//! An alternation (every other sample late, or too large) has a clock of its own: a record may begin
//! with either half of it. Where two records show one, their halves are put on the same side before
//! anything is estimated; this is the phase that may be taken from a check record.
//!
//! ```text
//! e_n = y_n − (y_(n−1) + y_(n+1)) / 2        the neighbours are of the other half         (1)
//! timing:  e_n ≈ 2 (−1)ⁿ τ ẏ_n               correlated with (y_(n+1) − y_(n−1)) / 2      (2)
//! gain:    e_n ≈ 2 (−1)ⁿ g y_n               correlated with (y_(n−1) + y_(n+1)) / 2      (3)
//! ```

use simgap_simulate::Run;

/// A correlation above this many standard errors is an alternation.
const SURE: f64 = 6.0;

/// Correlations (2) and (3) of the alternating part of a signal, in standard errors.
fn alternation(signal: &[f64], first_index: usize) -> [f64; 2] {
    let (mut sum, mut square) = ([0.0; 2], [0.0; 2]);
    for (n, w) in signal.windows(3).enumerate() {
        let sign = if (first_index + n + 1).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let e = sign * (w[1] - 0.5 * (w[0] + w[2]));
        let partners = [0.5 * (w[2] - w[0]), 0.5 * (w[0] + w[2])];
        for (k, partner) in partners.into_iter().enumerate() {
            sum[k] += e * partner;
            square[k] += (e * partner) * (e * partner);
        }
    }
    [0, 1].map(|k| {
        if square[k] > 0.0 {
            sum[k] / square[k].sqrt()
        } else {
            0.0
        }
    })
}

/// Puts the even samples of every run on the side of those of the first that shows an alternation.
pub(crate) fn align(train: &mut [Run], check: &mut [Run]) {
    let channels = train.first().map_or(0, |run| run.measured.len());
    let mut known: Vec<[f64; 2]> = vec![[0.0; 2]; channels];
    for run in train.iter_mut().chain(check) {
        let shown: Vec<[f64; 2]> = run
            .measured
            .iter()
            .map(|signal| alternation(signal.as_deref().unwrap_or_default(), run.first_index))
            .collect();
        // The surest agreement or disagreement decides for the whole record: one converter.
        let pairs = known.iter().flatten().zip(shown.iter().flatten());
        let sure = pairs
            .filter(|(a, b)| a.abs() > SURE && b.abs() > SURE)
            .max_by(|a, b| (a.0 * a.1).abs().total_cmp(&(b.0 * b.1).abs()));
        let flip = sure.is_some_and(|(a, b)| a * b < 0.0);
        if flip {
            run.first_index += 1;
        }
        for (known, shown) in known.iter_mut().flatten().zip(shown.iter().flatten()) {
            let shown = if flip { -shown } else { *shown };
            if shown.abs() > known.abs() {
                *known = shown;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(first: usize, timing: f64) -> Run {
        let y = |n: usize| {
            let sign = if (n + first).is_multiple_of(2) {
                timing
            } else {
                -timing
            };
            (0.2 * (n as f64 + sign)).sin()
        };
        Run {
            name: "x".into(),
            start_s: 0.0,
            time_step_s: 1.0,
            len: 400,
            first_index: 0,
            inputs: vec![],
            measured: vec![Some((0..400).map(y).collect())],
            mended: simgap_simulate::Mended::default(),
        }
    }

    #[test]
    fn verify_records_of_either_parity_are_put_on_one_side() {
        let mut train = vec![run(0, 0.1), run(1, 0.1)];
        let mut check = vec![run(1, 0.1), run(0, 0.1), run(0, 0.0)];
        align(&mut train, &mut check);
        let sides: Vec<usize> = train
            .iter()
            .chain(&check)
            .map(|r| r.first_index % 2)
            .collect();
        assert_eq!(sides, [0, 1, 1, 0, 0]);
    }
}
