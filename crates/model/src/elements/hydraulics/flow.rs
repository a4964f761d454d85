//! The flow through the edges of a valve, from numbers alone and without branches: eight of them are computed side by
//! side.

/// Pressure drop below which an orifice is laminar, Pa: the square root has no slope at zero, a real orifice has one.
const LAMINAR_PA: f64 = 5e4;

/// √Δ of either sign, with a finite slope at zero, and its slope.
///
/// ```text
/// r = Δ/(Δ² + δ²)^¼,   r' = (1 − ½ Δ²/(Δ² + δ²))/(Δ² + δ²)^¼
/// ```
#[inline(always)]
pub(super) fn root(drop: f64) -> [f64; 2] {
    // One division: g = (Δ² + δ²)^-¼, and g⁴ is that of the slope.
    let square = drop * drop + LAMINAR_PA * LAMINAR_PA;
    let g = 1.0 / square.sqrt().sqrt();
    let share = drop * (g * g);
    [drop * g, (1.0 - 0.5 * (share * share)) * g]
}

/// The two edges of a valve at one chamber: what [`crate::Valve::flow`] computes with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edges {
    /// Q_N/√Δp_N, m³/(s √Pa).
    pub flow_gain: f64,
    /// Share of the opening.
    pub overlap: f64,
    /// Share by which the flow is larger for a positive spool, of either sign.
    pub asymmetry: f64,
    /// Pa.
    pub supply: f64,
    /// Pa.
    pub tank: f64,
    /// R, Pa s/m³.
    pub supply_droop: f64,
    /// 1 where a positive spool fills the chamber, −1 where it empties it.
    pub fills: f64,
}

impl Edges {
    /// Flow into the chamber, m³/s, at a spool position and a pressure of the chamber, Pa; and its slope over that
    /// pressure, m³/(s Pa).
    ///
    /// From a supply whose pressure falls by R Q it is that of Q² = w² (Δ − R Q), w the width of the opening.
    #[inline(always)]
    #[must_use]
    pub fn flow(&self, spool: f64, pressure: f64) -> [f64; 2] {
        self.flow_from::<true>(spool, pressure)
    }

    /// As [`Edges::flow`], for a supply of which is known whether it droops: `false` stands for R = 0 and leaves its root out.
    #[inline(always)]
    #[must_use]
    pub fn flow_from<const DROOPS: bool>(&self, spool: f64, pressure: f64) -> [f64; 2] {
        let side = if spool > 0.0 { 1.0 } else { -1.0 };
        let open = (spool.abs() - self.overlap).clamp(0.0, 1.0);
        let width = self.flow_gain * open * (1.0 + side * self.asymmetry);
        let is_filling = side == self.fills;
        let drop = if is_filling {
            self.supply - pressure
        } else {
            pressure - self.tank
        };
        let [root, slope] = root(drop);
        let (flow, per_drop) = (width * root, width * slope);
        let sign = if is_filling { 1.0 } else { -1.0 };
        if !DROOPS {
            return [sign * flow, -per_drop];
        }
        let droop = width * width * self.supply_droop;
        let sum = (droop * droop + 4.0 * flow * flow).sqrt();
        let is_drooping = is_filling & (droop != 0.0) & (flow > 0.0);
        let drawn = if is_drooping {
            2.0 * flow * flow / (droop + sum)
        } else {
            flow
        };
        let per_flow = if is_drooping { 2.0 * flow / sum } else { 1.0 };
        [sign * drawn, -per_flow * per_drop]
    }
}
