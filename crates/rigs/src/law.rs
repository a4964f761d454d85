//! Forces of members beyond springs and dampers.

/// A force over displacement d, velocity v, time t, and a state z of its own.
#[derive(Debug, Clone, Copy)]
pub enum Law {
    /// q |v| v.
    QuadraticDamping(f64),
    /// k3 d³.
    CubicStiffness(f64),
    /// k2 d².
    QuadraticStiffness(f64),
    /// c_f v forwards, c_b v backwards.
    AsymmetricDamping(f64, f64),
    /// −k clamp(d, −g/2, g/2): what play g takes off a spring k.
    Backlash(f64, f64),
    /// Δk beyond b_u and below −b_l.
    Bilinear(f64, f64, f64),
    /// Contact beyond s_u and below −s_l: s_u, s_l, k, tau.
    EndStop(f64, f64, f64, f64),
    /// a sin(2π d/p) + b cos(2π d/p).
    Periodic(f64, f64, f64),
    /// k_a sin(2π f t + φ) d.
    VaryingStiffness(f64, f64, f64),
    /// Bouc and Wen: k, u_y, beta, n; z is the displacement of the loop.
    Hysteresis(f64, f64, f64, f64),
    /// Dahl with a damper beside it: F_c, d_p, tau; z is the elastic force.
    Presliding(f64, f64, f64),
    /// Foreign: c3 v³.
    CubicDamping(f64),
    /// Foreign: k sgn(d) |d|^p.
    PowerSpring(f64, f64),
    /// Foreign: c sgn(v) |v|^½, straight below a small speed.
    RootDamping(f64, f64),
    /// Foreign: c d² v.
    PlaceDamping(f64),
    /// Foreign: a slider of friction F_c behind a spring k with play g; z is the place of the slider.
    PlaySlider(f64, f64, f64),
}

use std::f64::consts::PI;

impl Law {
    /// Whether the law has a state of its own.
    #[must_use]
    pub fn has_state(&self) -> bool {
        matches!(
            self,
            Law::Hysteresis(..) | Law::Presliding(..) | Law::PlaySlider(..)
        )
    }

    /// The force that resists a positive displacement.
    #[must_use]
    pub fn force(&self, d: f64, v: f64, t: f64, z: f64) -> f64 {
        match *self {
            Law::QuadraticDamping(q) => q * v.abs() * v,
            Law::CubicStiffness(k) => k * d * d * d,
            Law::QuadraticStiffness(k) => k * d * d,
            Law::AsymmetricDamping(f, b) => (if v > 0.0 { f } else { b }) * v,
            Law::Backlash(k, g) => -k * d.clamp(-0.5 * g, 0.5 * g),
            Law::Bilinear(k, u, l) => k * (d - u).max(0.0) + k * (d + l).min(0.0),
            Law::EndStop(u, _, k, tau) if d > u => k * (d - u + tau * v).max(0.0),
            Law::EndStop(_, l, k, tau) if d < -l => k * (d + l + tau * v).min(0.0),
            Law::EndStop(..) => 0.0,
            Law::Periodic(a, b, p) => {
                let (sin, cos) = (2.0 * PI * d / p).sin_cos();
                a * sin + b * cos
            }
            Law::VaryingStiffness(k, f, phase) => k * (2.0 * PI * f * t + phase).sin() * d,
            Law::Hysteresis(k, ..) => k * z,
            Law::Presliding(_, _, tau) => z + tau * self.state_rate(d, v, z),
            Law::CubicDamping(c) => c * v * v * v,
            Law::PowerSpring(k, p) => k * d.signum() * d.abs().powf(p),
            Law::RootDamping(c, small) => c * v / (v.abs() + small).sqrt(),
            Law::PlaceDamping(c) => c * d * d * v,
            Law::PlaySlider(_, k, g) => {
                let e = d - z;
                k * (e - e.clamp(-0.5 * g, 0.5 * g))
            }
        }
    }

    /// The rate of the state.
    #[must_use]
    pub fn state_rate(&self, d: f64, v: f64, z: f64) -> f64 {
        match *self {
            Law::Hysteresis(_, uy, beta, n) => {
                let way = beta * (z * v).signum() + 1.0 - beta;
                v * (1.0 - way * (z / uy).abs().powf(n))
            }
            Law::Presliding(fc, dp, _) => fc / dp * (v - z / fc * v.abs()),
            Law::PlaySlider(fc, ..) => {
                let f = self.force(d, v, 0.0, z);
                if f.abs() >= fc && f * v > 0.0 { v } else { 0.0 }
            }
            _ => 0.0,
        }
    }
}
