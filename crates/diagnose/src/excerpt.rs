//! The part of long records that is searched in, and a smaller one that is searched in first.
//!
//! Where every input and everything that re-estimated parameters leave is smooth from sample to sample, every few samples
//! say as much as all of them: the whole of each record is searched in, at a lower rate. Elsewhere the stretch of most
//! energy of each record is.

use simgap_simulate::Run;

/// Samples the search may use; more make it slower, not wiser.
const SEARCH_SAMPLES: usize = 12_000;
/// The same of the search that comes first where records are longer than that.
const FIRST_SAMPLES: usize = 3000;
/// Of more channels than these it is the values of all channels that count.
const FEW_CHANNELS: usize = 3;
/// What straight lines between the samples of a lower rate may miss, rms: of an input over its motion, and of what is left.
const MISSED: [f64; 2] = [0.01, 0.1];

/// The runs to search in, given what re-estimated parameters leave of each channel of each.
pub(crate) fn excerpts(runs: &[Run], left: &[Vec<Vec<f64>>]) -> Vec<Run> {
    match is_long(runs) {
        true => shortened(runs, left, SEARCH_SAMPLES),
        false => runs.to_vec(),
    }
}

/// The runs to search in first, where there are any.
pub(crate) fn first_excerpts(runs: &[Run], left: &[Vec<Vec<f64>>]) -> Option<Vec<Run>> {
    is_long(runs).then(|| shortened(runs, left, FIRST_SAMPLES))
}

fn is_long(runs: &[Run]) -> bool {
    total(runs) > most(runs, SEARCH_SAMPLES)
}

fn total(runs: &[Run]) -> usize {
    runs.iter().map(|run| run.len).sum()
}

/// Samples that hold no more values than so many samples of few channels.
fn most(runs: &[Run], samples: usize) -> usize {
    let channels = runs.iter().map(|run| run.measured.len()).max();
    samples * FEW_CHANNELS / channels.unwrap_or(1).max(FEW_CHANNELS)
}

/// Runs of no more than so many samples of few channels.
fn shortened(runs: &[Run], left: &[Vec<Vec<f64>>], samples: usize) -> Vec<Run> {
    let (total, most) = (total(runs), most(runs, samples));
    // An odd number of samples: even and odd ones still alternate.
    let stride = total.div_ceil(most) | 1;
    let is_smooth = |run: &Run, left: &Vec<Vec<f64>>| {
        let [of_input, of_rest] = MISSED;
        run.inputs
            .iter()
            .all(|input| missed(input, stride) < of_input)
            && left.iter().all(|rest| missed(rest, stride) < of_rest)
    };
    if runs
        .iter()
        .zip(left)
        .all(|(run, left)| is_smooth(run, left))
    {
        return runs.iter().map(|run| run.thinned(stride)).collect();
    }
    let share = most as f64 / total as f64;
    runs.iter()
        .map(|run| {
            let len = ((run.len as f64 * share) as usize).clamp(1, run.len);
            let start = most_energetic(run, len);
            run.slice(start..start + len)
        })
        .collect()
}

/// What straight lines between every few samples miss of a signal, rms, over the rms about its mean.
fn missed(signal: &[f64], stride: usize) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let (mut apart, mut all) = (0.0, 0.0);
    for part in signal.windows(stride + 1).step_by(stride) {
        let (first, last) = (part[0], part[stride]);
        for (k, value) in part.iter().take(stride).enumerate() {
            let line = first + (last - first) * k as f64 / stride as f64;
            apart += (value - line).powi(2);
            all += (value - mean).powi(2);
        }
    }
    if all > 0.0 { (apart / all).sqrt() } else { 0.0 }
}

fn most_energetic(run: &Run, len: usize) -> usize {
    let mut energy = vec![0.0; run.len];
    for values in run.measured.iter().flatten() {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let scale: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        for (sum, value) in energy.iter_mut().zip(values) {
            *sum += (value - mean) * (value - mean) / scale;
        }
    }
    let mut window: f64 = energy[..len].iter().sum();
    let (mut best, mut at) = (window, 0);
    for start in 1..=(run.len - len) {
        window += energy[start + len - 1] - energy[start - 1];
        if window > best {
            (best, at) = (window, start);
        }
    }
    at
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn run(len: usize, value: impl Fn(f64) -> f64) -> Run {
        Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: 0.001,
            len,
            first_index: 0,
            mended: simgap_simulate::Mended::default(),
            inputs: vec![],
            measured: vec![Some((0..len).map(|n| value(0.001 * n as f64)).collect())],
        }
    }

    fn found(run: &Run, left: impl Fn(f64) -> f64) -> Run {
        let left = (0..run.len).map(|n| left(0.001 * n as f64)).collect();
        excerpts(std::slice::from_ref(run), &[vec![left]]).swap_remove(0)
    }

    #[test]
    fn what_is_smooth_is_searched_whole_at_a_lower_rate() {
        let decay = run(30_000, |t| (-0.1 * t).exp() * (7.0 * t).sin());
        let smooth = found(&decay, |t| 0.1 * (7.0 * t).cos());
        assert_eq!((smooth.len, smooth.time_step_s), (10_000, 0.003));
        // A line near half the sample rate is lost at a lower one.
        let rough = found(&decay, |t| 0.1 * (3000.0 * t).cos());
        assert_eq!((rough.len, rough.time_step_s), (12_000, 0.001));
        let short = run(2000, |t| t.sin());
        assert_eq!(found(&short, |t| t).len, 2000);
    }

    #[test]
    fn long_records_are_searched_in_fewer_samples_first() {
        let first =
            |run: &Run| first_excerpts(std::slice::from_ref(run), &[vec![vec![0.0; run.len]]]);
        let decay = run(30_000, |t| (-0.1 * t).exp() * (7.0 * t).sin());
        let part = first(&decay).unwrap().swap_remove(0);
        assert_eq!((part.len, part.time_step_s), (2728, 0.011));
        assert!(first(&run(12_000, |t| t.sin())).is_none());
    }
}
