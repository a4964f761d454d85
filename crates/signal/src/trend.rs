//! Removal of the mean or of a straight line before a transform.

/// What to take out of a record (or of each segment) before it is windowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Trend {
    /// Nothing.
    Keep,
    /// The mean.
    #[default]
    Mean,
    /// The straight line of least squares.
    Linear,
}

impl Trend {
    /// Subtracts the trend in place.
    ///
    /// ```text
    /// Mean:    x_n - x̄
    /// Linear:  x_n - x̄ - b (n - n̄),   b = Σ (n - n̄) x_n / Σ (n - n̄)²,   Σ (n - n̄)² = N (N² - 1) / 12
    /// ```
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_signal::Trend;
    /// let mut ramp = [1.0, 3.0, 5.0, 7.0];
    /// Trend::Linear.remove(&mut ramp);
    /// assert!(ramp.iter().all(|v| v.abs() < 1e-12));
    /// ```
    pub fn remove(self, values: &mut [f64]) {
        let (mean, slope) = self.line(values);
        let mid = 0.5 * (values.len() as f64 - 1.0);
        for (i, v) in values.iter_mut().enumerate() {
            *v -= mean + slope * (i as f64 - mid);
        }
    }

    /// Value in the middle and slope per sample of what [`remove`](Self::remove) subtracts.
    pub(crate) fn line(self, values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        if self == Trend::Keep || values.is_empty() {
            return (0.0, 0.0);
        }
        let mean = sum(values) / n;
        if self == Trend::Mean || values.len() == 1 {
            return (mean, 0.0);
        }
        let mid = 0.5 * (n - 1.0);
        let moment: f64 = values
            .iter()
            .enumerate()
            .map(|(i, v)| (i as f64 - mid) * (v - mean))
            .sum();
        (mean, moment * 12.0 / (n * (n * n - 1.0)))
    }
}

/// Sum in eight lanes: one chain of additions would wait for itself.
fn sum(values: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let chunks = values.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for (lane, v) in lanes.iter_mut().zip(chunk) {
            *lane += v;
        }
    }
    lanes.iter().sum::<f64>() + rest
}
