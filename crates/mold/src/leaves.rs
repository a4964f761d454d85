//! The mold on its leaf springs, each a beam with modes of its own.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_model::{ModelError, StructuralMatrices, undamped_modes};

use crate::error::{not_negative, positive};
use crate::{BeamEnds, LeafSpring, MoldError};

/// A leaf spring condensed to the motion of its guided end and some modes (Craig and Bampton),
///
/// ```text
/// w = ψ u + Φ q,    ψ = −K_ii⁻¹ K_ib,    K_ii Φ = M_ii Φ Ω²,  Φᵀ M_ii Φ = 1          (1)
///
/// M = [ m  pᵀ ]     K = [ k  0  ]     m = M_bb + 2 M_bi ψ + ψᵀ M_ii ψ,   p = Φᵀ (M_ib + M_ii ψ)
///     [ p  1  ]         [ 0  Ω² ]     k = K_bb + K_bi ψ                             (2)
/// ```
///
/// u is the displacement of the guided end, i the coordinates between the ends, q those of the modes with
/// both ends clamped.
///
/// Reference: `craig-bampton1968`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CondensedLeaf {
    /// m, kg.
    pub end_mass_kg: f64,
    /// k, N/m.
    pub end_stiffness: f64,
    /// p, kg^½.
    pub coupling: Vec<f64>,
    /// Ω, rad/s, lowest first.
    pub natural_freq_rad: Vec<f64>,
}

impl LeafSpring {
    /// Condenses equal finite elements to the guided end and the lowest modes.
    ///
    /// ```
    /// let leaf = simgap_mold::LeafSpring::steel(1.06, 0.2, 0.010)?;
    /// let condensed = leaf.condensed(20, 3)?;
    /// assert!((condensed.end_stiffness / leaf.guided_stiffness() - 1.0).abs() < 1e-9);
    /// # Ok::<(), simgap_mold::MoldError>(())
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for fewer than 2 elements or more modes than coordinates,
    /// [`MoldError::Model`] for a leaf that has buckled.
    pub fn condensed(&self, elements: usize, modes: usize) -> Result<CondensedLeaf, MoldError> {
        let inner = self.finite_elements(BeamEnds::Clamped, elements)?;
        let count = inner.dof_count();
        if modes > count {
            return Err(MoldError::Parameter {
                name: "number of modes of a leaf spring",
                found: modes as f64,
                needed: "not above twice the elements less two",
            });
        }
        let [mass, stiffness] = self.assembled(elements)?;
        let end = 2 * elements;
        let to_end = |m: &Mat<f64>| Mat::from_fn(count, 1, |i, _| m[(2 + i, end)]);
        let (mass_end, stiffness_end) = (to_end(&mass), to_end(&stiffness));
        let factor = inner
            .stiffness_matrix
            .llt(Side::Lower)
            .map_err(|_| ModelError::Singular {
                matrix: "stiffness matrix",
                context: "leaf spring beyond its buckling load".into(),
            })?;
        let shape = -factor.solve(&stiffness_end); // (1) ψ
        let found = undamped_modes(&inner)?;
        let carried = &mass_end + &inner.mass_matrix * &shape; // M_ib + M_ii ψ
        let dot =
            |a: &Mat<f64>, b: &Mat<f64>| -> f64 { (0..count).map(|i| a[(i, 0)] * b[(i, 0)]).sum() };
        Ok(CondensedLeaf {
            end_mass_kg: mass[(end, end)] + dot(&mass_end, &shape) + dot(&shape, &carried), // (2)
            end_stiffness: stiffness[(end, end)] + dot(&stiffness_end, &shape),
            coupling: (0..modes)
                .map(|r| {
                    (0..count)
                        .map(|i| found.mode_shape[(i, r)] * carried[(i, 0)])
                        .sum()
                })
                .collect(),
            natural_freq_rad: found.natural_freq_rad[..modes].to_vec(),
        })
    }
}

/// The mold on a stiffness to ground and on leaf springs, in heave.
///
/// Coordinates: displacement of the mold, then the modes of one leaf spring after the other.
///
/// ```
/// use simgap_mold::{LeafSpring, MoldOnLeaves};
/// let leaf = LeafSpring::steel(1.06, 0.2, 0.010)?;
/// let mold = MoldOnLeaves::new(33_000.0, 8_287_639.0, vec![leaf; 4])?;
/// let freqs = mold.natural_freqs_hz()?;
/// // Heave, and one mode of each leaf spring near 47 Hz.
/// assert!(freqs[0] < 3.0 && freqs[1..5].iter().all(|freq| (freq - 47.3).abs() < 0.2));
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MoldOnLeaves {
    mass_kg: f64,
    stiffness: f64,
    leaves: Vec<LeafSpring>,
}

/// Elements of a leaf spring: its third mode is right to 4e-6.
const ELEMENTS: usize = 40;

/// Modes kept of a leaf spring: the third lies five times as high as the first.
const MODES: usize = 3;

impl MoldOnLeaves {
    /// Mass of the mold (kg), stiffness to ground beside the leaf springs (N/m), and the leaf springs.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a mass that is not positive or a negative stiffness.
    pub fn new(mass_kg: f64, stiffness: f64, leaves: Vec<LeafSpring>) -> Result<Self, MoldError> {
        Ok(Self {
            mass_kg: positive("mass", mass_kg)?,
            stiffness: not_negative("stiffness", stiffness)?,
            leaves,
        })
    }

    /// M and K; no damping.
    ///
    /// # Errors
    /// Those of [`LeafSpring::condensed`].
    pub fn matrices(&self) -> Result<StructuralMatrices, MoldError> {
        let count = 1 + MODES * self.leaves.len();
        let (mut mass, mut stiffness) = (Mat::zeros(count, count), Mat::zeros(count, count));
        mass[(0, 0)] = self.mass_kg;
        stiffness[(0, 0)] = self.stiffness;
        for (at, leaf) in (1..count).step_by(MODES).zip(&self.leaves) {
            let leaf = leaf.condensed(ELEMENTS, MODES)?;
            mass[(0, 0)] += leaf.end_mass_kg;
            stiffness[(0, 0)] += leaf.end_stiffness;
            let modes = leaf.coupling.iter().zip(&leaf.natural_freq_rad);
            for (i, (coupling, omega)) in (at..).zip(modes) {
                mass[(i, i)] = 1.0;
                mass[(0, i)] = *coupling;
                mass[(i, 0)] = *coupling;
                stiffness[(i, i)] = omega * omega;
            }
        }
        Ok(StructuralMatrices {
            mass_matrix: mass,
            damping_matrix: Mat::zeros(count, count),
            stiffness_matrix: stiffness,
        })
    }

    /// Natural frequencies, lowest first, Hz.
    ///
    /// # Errors
    /// As [`matrices`](Self::matrices); [`MoldError::Model`] if the eigenvalues are not found.
    pub fn natural_freqs_hz(&self) -> Result<Vec<f64>, MoldError> {
        Ok(undamped_modes(&self.matrices()?)?.natural_freq_hz)
    }
}
