//! A signal on a fine grid, and its values in between.

/// Evenly spaced values; times are counted in samples of the record.
#[derive(Debug, Clone)]
pub struct Grid {
    /// The values.
    pub values: Vec<f64>,
    /// Time of the first value.
    pub start: f64,
    /// Values per sample.
    pub per: f64,
    /// Each value holds until the next one.
    pub hold: bool,
}

/// Coefficients of the Lagrange polynomials of six points, −2 … 3, at s in [0, 1).
fn lagrange(s: f64) -> [f64; 6] {
    let d = [s + 2.0, s + 1.0, s, s - 1.0, s - 2.0, s - 3.0];
    const SCALE: [f64; 6] = [-120.0, 24.0, -12.0, 12.0, -24.0, 120.0];
    let mut before = [1.0; 6];
    let mut after = [1.0; 6];
    for i in 1..6 {
        before[i] = before[i - 1] * d[i - 1];
        after[5 - i] = after[6 - i] * d[6 - i];
    }
    std::array::from_fn(|i| before[i] * after[i] / SCALE[i])
}

impl Grid {
    /// The value at a time; beyond the ends the last value.
    ///
    /// `side` tells which interval the time belongs to where values are held.
    #[must_use]
    pub fn at(&self, time: f64, side: f64) -> f64 {
        let last = self.values.len() as f64 - 1.0;
        if self.hold {
            let place = ((side - self.start) * self.per + 1e-6).floor();
            return self.values[place.clamp(0.0, last) as usize];
        }
        let place = ((time - self.start) * self.per).clamp(0.0, last);
        let whole = place.floor();
        let s = place - whole;
        let k = whole as usize;
        if s == 0.0 {
            return self.values[k];
        }
        if k < 2 || k + 3 >= self.values.len() {
            let next = self.values[(k + 1).min(self.values.len() - 1)];
            return self.values[k] * (1.0 - s) + next * s;
        }
        let w = lagrange(s);
        (0..6).map(|i| w[i] * self.values[k + i - 2]).sum()
    }

    /// The value at a time of a smooth signal.
    #[must_use]
    pub fn smooth(&self, time: f64) -> f64 {
        self.at(time, time)
    }

    /// The rate of change per second, by differences of sixth order.
    #[must_use]
    pub fn rate(&self, step_s: f64) -> Grid {
        let n = self.values.len() as isize;
        let h = step_s / self.per;
        let v = |k: isize| self.values[k.clamp(0, n - 1) as usize];
        let values = (0..n)
            .map(|k| {
                let (a, b, c) = (
                    v(k + 1) - v(k - 1),
                    v(k + 2) - v(k - 2),
                    v(k + 3) - v(k - 3),
                );
                (45.0 * a - 9.0 * b + c) / (60.0 * h)
            })
            .collect();
        Grid {
            values,
            ..self.clone()
        }
    }

    /// The signal behind a first-order lag, tau y' + y = u, started settled.
    #[must_use]
    pub fn lagged(&self, time_constant_s: f64, step_s: f64) -> Grid {
        let x = step_s / self.per / time_constant_s;
        let parts = (4.0 * x).ceil().max(1.0) as usize;
        let h = x / parts as f64;
        let mut y = self.values[0];
        let mut values = vec![y];
        for k in 1..self.values.len() {
            let from = self.start + (k as f64 - 1.0) / self.per;
            for p in 0..parts {
                let u = |share: f64| {
                    let into = (p as f64 + share) / parts as f64 / self.per;
                    self.at(from + into, from)
                };
                let (u0, u1, u2) = (u(0.0), u(0.5), u(1.0));
                let k1 = u0 - y;
                let k2 = u1 - (y + 0.5 * h * k1);
                let k3 = u1 - (y + 0.5 * h * k2);
                let k4 = u2 - (y + h * k3);
                y += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            }
            values.push(y);
        }
        Grid {
            values,
            hold: false,
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(per: f64) -> Grid {
        let values = (0..(200.0 * per) as usize)
            .map(|k| (0.3 * k as f64 / per).sin())
            .collect();
        Grid {
            values,
            start: 0.0,
            per,
            hold: false,
        }
    }

    #[test]
    fn verify_values_between_are_those_of_the_sine() {
        let grid = sine(4.0);
        for k in 10..1000 {
            let t = 0.137 * f64::from(k);
            // The rest term of six points 0.075 rad apart is below 1e-8.
            assert!((grid.smooth(t) - (0.3 * t).sin()).abs() < 1e-8);
        }
        let rate = grid.rate(0.01);
        assert!((rate.smooth(50.1) - 30.0 * (15.03_f64).cos()).abs() < 1e-4);
    }

    #[test]
    fn verify_a_lag_turns_a_sine_as_its_formula_says() {
        // tau = 4 samples of 1 s: gain 1/√(1 + (0.3·4)²), phase −atan(1.2).
        let lagged = sine(4.0).lagged(4.0, 1.0);
        let (gain, phase) = (1.0 / (1.0_f64 + 1.44).sqrt(), 1.2_f64.atan());
        for k in 400..700 {
            let t = f64::from(k) / 4.0;
            let wanted = gain * (0.3 * t - phase).sin();
            assert!((lagged.values[k as usize] - wanted).abs() < 1e-6);
        }
    }
}
