//! Removal of the mean or of a straight line before a transform.

/// What to take out of a record (or of each segment) before it is windowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
        let n = values.len() as f64;
        if self == Trend::Keep || values.is_empty() {
            return;
        }
        let mean = values.iter().sum::<f64>() / n;
        let mid = 0.5 * (n - 1.0);
        let slope = if self == Trend::Linear && values.len() > 1 {
            let moment: f64 = values
                .iter()
                .enumerate()
                .map(|(i, v)| (i as f64 - mid) * (v - mean))
                .sum();
            moment * 12.0 / (n * (n * n - 1.0))
        } else {
            0.0
        };
        for (i, v) in values.iter_mut().enumerate() {
            *v -= mean + slope * (i as f64 - mid);
        }
    }
}
