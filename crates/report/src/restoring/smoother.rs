//! A fixed-interval smoother for small linear systems driven by an unknown force.
//!
//! ```text
//! s_k = Φ s_(k−1) + w_k,   w of variance Q                          (1)
//! d_k = H s_k + v_k,       v of variance R, diagonal                (2)
//! forward, one measurement after the other:
//! ν = d − H s,  S = H P Hᵀ + R,  K = P Hᵀ / S                       (3)
//! s ← s + K ν,  P ← P − K H P                                       (4)
//! backward, λ = 0 after the last:
//! λ ← λ − Hᵀ (ν / S + Kᵀ λ),  then  λ ← Φᵀ λ                        (5)
//! smoothed s = s − P λ, with λ as it is after the measurements of k  (6)
//! ```
//!
//! The backward pass (5) needs no inverse of P, which is singular where the force is the only noise
//! (modified Bryson-Frazier form).

/// A system (1), (2); matrices row by row.
pub(super) struct System {
    /// Number of states N.
    pub(super) states: usize,
    /// Φ, N × N.
    pub(super) transition: Vec<f64>,
    /// One row of H for each channel.
    pub(super) rows: Vec<Vec<f64>>,
    /// Variance of the noise of each channel.
    pub(super) noise: Vec<f64>,
    /// Variance that the last state, the force, gains in a step.
    pub(super) drive: f64,
    /// Variance at the start, N × N.
    pub(super) start: Vec<f64>,
}

/// One scalar measurement as the forward pass took it.
struct Update {
    channel: usize,
    innovation: f64,
    variance: f64,
    gain: Vec<f64>,
}

/// What the forward pass leaves of one sample.
struct Step {
    state: Vec<f64>,
    variance: Vec<f64>,
    updates: Vec<Update>,
}

impl System {
    /// Twice the negative logarithm of the likelihood of the measurements, a constant left out;
    /// values that are not finite are passed over.
    pub(super) fn misfit(&self, measured: &[&[f64]]) -> f64 {
        let mut sum = 0.0;
        self.forward(measured, |step| {
            for u in &step.updates {
                sum += u.innovation * u.innovation / u.variance + u.variance.ln();
            }
        });
        sum
    }

    /// The smoothed states, sample after sample.
    pub(super) fn smooth(&self, measured: &[&[f64]]) -> Vec<Vec<f64>> {
        let n = self.states;
        let mut steps = Vec::new();
        self.forward(measured, |step| steps.push(step));
        let mut adjoint = vec![0.0; n];
        let mut out = Vec::with_capacity(steps.len());
        for step in steps.iter().rev() {
            // (6)
            let smoothed = (0..n).map(|i| {
                let row = &step.variance[i * n..(i + 1) * n];
                step.state[i] - dot(row, &adjoint)
            });
            out.push(smoothed.collect::<Vec<f64>>());
            // (5)
            for u in step.updates.iter().rev() {
                let pull = u.innovation / u.variance + dot(&u.gain, &adjoint);
                for (a, h) in adjoint.iter_mut().zip(&self.rows[u.channel]) {
                    *a -= h * pull;
                }
            }
            adjoint = (0..n)
                .map(|j| {
                    (0..n)
                        .map(|i| self.transition[i * n + j] * adjoint[i])
                        .sum()
                })
                .collect();
        }
        out.reverse();
        out
    }

    /// Variance of the states that the drive alone, of unit size, builds up from rest in `steps`.
    pub(super) fn driven(&self, steps: usize) -> Vec<f64> {
        let n = self.states;
        let mut variance = vec![0.0; n * n];
        for _ in 0..steps {
            variance = self.carried(&variance);
            variance[n * n - 1] += 1.0;
        }
        variance
    }

    fn forward(&self, measured: &[&[f64]], mut each: impl FnMut(Step)) {
        let n = self.states;
        let samples = measured.iter().map(|m| m.len()).min().unwrap_or(0);
        let mut state = vec![0.0; n];
        let mut variance = self.start.clone();
        for k in 0..samples {
            if k > 0 {
                // (1)
                state = (0..n)
                    .map(|i| dot(&self.transition[i * n..(i + 1) * n], &state))
                    .collect();
                variance = self.carried(&variance);
                variance[n * n - 1] += self.drive;
            }
            let mut updates = Vec::with_capacity(self.rows.len());
            for (channel, values) in measured.iter().enumerate() {
                let value = values[k];
                if value.is_finite() {
                    updates.push(self.update(channel, value, &mut state, &mut variance));
                }
            }
            each(Step {
                state: state.clone(),
                variance: variance.clone(),
                updates,
            });
        }
    }

    /// (3) and (4) for one channel.
    fn update(
        &self,
        channel: usize,
        value: f64,
        state: &mut [f64],
        variance: &mut [f64],
    ) -> Update {
        let n = self.states;
        let row = &self.rows[channel];
        let seen: Vec<f64> = (0..n)
            .map(|i| dot(&variance[i * n..(i + 1) * n], row))
            .collect();
        let total = dot(&seen, row) + self.noise[channel];
        let innovation = value - dot(row, state);
        let gain: Vec<f64> = seen.iter().map(|s| s / total).collect();
        for i in 0..n {
            state[i] += gain[i] * innovation;
            for j in 0..n {
                variance[i * n + j] -= gain[i] * seen[j];
            }
        }
        Update {
            channel,
            innovation,
            variance: total,
            gain,
        }
    }

    /// Φ P Φᵀ, symmetric to the last bit.
    fn carried(&self, variance: &[f64]) -> Vec<f64> {
        let n = self.states;
        let mut half = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                half[i * n + j] = (0..n)
                    .map(|k| self.transition[i * n + k] * variance[k * n + j])
                    .sum();
            }
        }
        let mut out = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let sum = dot(
                    &half[i * n..(i + 1) * n],
                    &self.transition[j * n..(j + 1) * n],
                );
                out[i * n + j] = sum;
                out[j * n + i] = sum;
            }
        }
        out
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A random walk seen with noise.
    fn walk() -> System {
        System {
            states: 1,
            transition: vec![1.0],
            rows: vec![vec![1.0]],
            noise: vec![2.0],
            drive: 1.0,
            start: vec![5.0],
        }
    }

    /// The smoothed walk minimises s₀²/5 + Σ (s_k − s_(k−1))² + Σ (d_k − s_k)²/2: its gradient
    /// vanishes.
    #[test]
    fn verify_the_smoothed_walk_is_the_least_squares_solution() {
        let d = [1.0, -2.0, 0.5, 3.0, f64::NAN, 2.0];
        let s: Vec<f64> = walk().smooth(&[&d]).concat();
        for k in 0..d.len() {
            let mut gradient = if k == 0 { s[0] / 5.0 } else { s[k] - s[k - 1] };
            if k + 1 < d.len() {
                gradient -= s[k + 1] - s[k];
            }
            if d[k].is_finite() {
                gradient -= (d[k] - s[k]) / 2.0;
            }
            assert!(gradient.abs() < 1e-12, "{k}: {gradient}");
        }
    }

    /// Two samples: the likelihood in closed form.
    #[test]
    fn verify_the_misfit_of_two_samples() {
        // Covariance [[7, 5], [5, 8]], determinant 31.
        let quadratic: f64 = (8.0 - 2.0 * 5.0 * 2.0 + 7.0 * 4.0) / 31.0;
        let expected = quadratic + 31f64.ln();
        assert!((walk().misfit(&[&[1.0, 2.0]]) - expected).abs() < 1e-12);
    }

    #[test]
    fn verify_the_drive_alone_builds_up_a_walk() {
        assert_eq!(walk().driven(7), [7.0]);
    }
}
