//! A beam of unit length, stiffness and mass, condensed to its ends.

use faer::Mat;

use crate::{ModelError, StructuralMatrices, undamped_modes};

/// A beam with L = EI = ρA = 1 condensed to the displacements of its two ends and to the first modes with both held.
///
/// ```text
/// w(s) = ψ_a(s) u_a + ψ_b(s) u_b + Σ φ_i(s) q_i                                                     (1)
/// K = k_s (u_a − u_b)² + Σ λ_i m_i q_i²,    M = [M_ee  M_eq; M_qe  diag m_i]                         (2)
/// ```
///
/// ψ are the static shapes under unit displacement of an end, φ_i the modes with both ends held, the largest
/// displacement of each scaled to 1: q_i is in metres.
///
/// Reference: `craig-bampton1968`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct UnitBeam {
    /// k_s: 12 with both ends clamped, 3 with one free to turn.
    pub(crate) stiffness: f64,
    /// M_ee.
    pub(crate) end_mass: [[f64; 2]; 2],
    /// The modes, lowest first.
    pub(crate) modes: Vec<UnitMode>,
}

/// A mode of a unit beam with its ends held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnitMode {
    /// m_i.
    pub(crate) mass: f64,
    /// λ_i m_i, with λ_i = ω² ρA L⁴ / (EI).
    pub(crate) stiffness: f64,
    /// M_eq: coupling to the acceleration of the two ends.
    pub(crate) coupling: [f64; 2],
}

/// Stiffness and mass of an element over EI/l³ and ρA l, rows and columns w_a, l θ_a, w_b, l θ_b: cubic shapes.
///
/// Reference: `cook2002`, chapters 2 and 11.
const STIFFNESS: [[f64; 4]; 4] = [
    [12.0, 6.0, -12.0, 6.0],
    [6.0, 4.0, -6.0, 2.0],
    [-12.0, -6.0, 12.0, -6.0],
    [6.0, 2.0, -6.0, 4.0],
];
const MASS: [[f64; 4]; 4] = [
    [156.0, 22.0, 54.0, -13.0],
    [22.0, 4.0, 13.0, -3.0],
    [54.0, 13.0, 156.0, -22.0],
    [-13.0, -3.0, -22.0, 4.0],
];
const MASS_DIVISOR: f64 = 420.0;

impl UnitBeam {
    /// Condenses a beam of so many elements; `turns` says of each end whether it is free to turn, else its slope is
    /// held at zero. At least one end must be held, or `None` is what comes of the static shapes.
    ///
    /// # Errors
    /// [`ModelError::Eigen`] when the modes are not found, [`ModelError::Singular`] when nothing holds the beam.
    pub(crate) fn new(
        elements: usize,
        kept: usize,
        turns: [bool; 2],
    ) -> Result<UnitBeam, ModelError> {
        let (stiffness, mass) = assembled(elements);
        let last = 2 * elements;
        let ends = [0, last];
        let inner: Vec<usize> = (0..last + 2)
            .filter(|&i| match i {
                i if ends.contains(&i) => false,
                1 => turns[0],
                i if i == last + 1 => turns[1],
                _ => true,
            })
            .collect();
        let part = |matrix: &Mat<f64>| {
            Mat::from_fn(inner.len(), inner.len(), |i, j| {
                matrix[(inner[i], inner[j])]
            })
        };
        let held = StructuralMatrices {
            mass_matrix: part(&mass),
            damping_matrix: Mat::zeros(inner.len(), inner.len()),
            stiffness_matrix: part(&stiffness),
        };
        // The whole shapes: displacements of all coordinates.
        let shape = |end: usize| -> Result<Vec<f64>, ModelError> {
            let pull: Vec<f64> = inner.iter().map(|&i| -stiffness[(i, ends[end])]).collect();
            let follows = crate::dense::solve(&held.stiffness_matrix, &pull);
            let follows = follows.ok_or_else(|| ModelError::Singular {
                matrix: "stiffness matrix",
                context: "a beam between its ends".into(),
            })?;
            let mut whole = vec![0.0; last + 2];
            whole[ends[end]] = 1.0;
            inner.iter().zip(follows).for_each(|(&i, w)| whole[i] = w);
            Ok(whole)
        };
        let statics = [shape(0)?, shape(1)?];
        let of = |matrix: &Mat<f64>, a: &[f64], b: &[f64]| -> f64 {
            let row = |i: usize| (0..b.len()).map(|j| matrix[(i, j)] * b[j]).sum::<f64>();
            a.iter().enumerate().map(|(i, a)| a * row(i)).sum()
        };
        let modes = undamped_modes(&held)?;
        let mode =
            |r: usize| {
                let mut whole = vec![0.0; last + 2];
                for (k, &i) in inner.iter().enumerate() {
                    whole[i] = modes.mode_shape[(k, r)];
                }
                let largest = whole.iter().step_by(2).fold(0.0_f64, |most, w| {
                    if w.abs() > most.abs() { *w } else { most }
                });
                whole.iter_mut().for_each(|w| *w /= largest);
                UnitMode {
                    mass: of(&mass, &whole, &whole),
                    stiffness: of(&stiffness, &whole, &whole),
                    coupling: [0, 1].map(|end| of(&mass, &statics[end], &whole)),
                }
            };
        Ok(UnitBeam {
            stiffness: of(&stiffness, &statics[0], &statics[0]),
            end_mass: [0, 1].map(|a| [0, 1].map(|b| of(&mass, &statics[a], &statics[b]))),
            modes: (0..kept.min(inner.len())).map(mode).collect(),
        })
    }
}

/// Stiffness and mass of all coordinates w₀, l θ₀, w₁, ... of a unit beam.
fn assembled(elements: usize) -> (Mat<f64>, Mat<f64>) {
    let (size, count) = (2 * elements + 2, elements as f64);
    let (mut stiffness, mut mass) = (Mat::zeros(size, size), Mat::zeros(size, size));
    for element in 0..elements {
        for i in 0..4 {
            for j in 0..4 {
                let at = (2 * element + i, 2 * element + j);
                stiffness[at] += count.powi(3) * STIFFNESS[i][j];
                mass[at] += MASS[i][j] / (MASS_DIVISOR * count);
            }
        }
    }
    (stiffness, mass)
}
