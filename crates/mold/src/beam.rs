//! A leaf spring as an Euler-Bernoulli beam: closed forms and finite elements.

use std::f64::consts::{PI, TAU};

use faer::Mat;
use simgap_model::{StructuralMatrices, undamped_modes};

use crate::MoldError;
use crate::error::{finite, positive};

/// How the two ends of a beam are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum BeamEnds {
    /// Both ends built in.
    Clamped,
    /// One end built in, the other moves across without turning: a leaf spring on a moving mold.
    ClampedGuided,
    /// One end built in, the other free.
    ClampedFree,
    /// Both ends on pins.
    Pinned,
}

/// A leaf spring: a straight beam of rectangular section that bends across its thickness.
///
/// | symbol | argument | unit |
/// |---|---|---|
/// | L, b, h | length, width, thickness | m |
/// | E | Young's modulus | Pa |
/// | ρ | density | kg/m³ |
/// | N | axial force, positive when it pulls | N |
///
/// Valid for h ≪ L (no shear, no rotary inertia) and small deflections.
///
/// ```
/// use simgap_mold::{BeamEnds, LeafSpring};
/// // 10 mm of steel over 1.06 m: near the 47 Hz of the paper's finite element model.
/// let leaf = LeafSpring::steel(1.06, 0.2, 0.010)?;
/// let first = leaf.natural_freq_hz(BeamEnds::Clamped, 1)?;
/// assert!((first - 47.3).abs() < 0.1);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
///
/// Reference: `blevins1979`, chapter 8.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LeafSpring {
    length_m: f64,
    width_m: f64,
    thickness_m: f64,
    youngs_modulus_pa: f64,
    density: f64,
    axial_force_n: f64,
}

/// Young's modulus of steel, Pa, and its density, kg/m³ (`blevins1979`).
const STEEL: [f64; 2] = [2.1e11, 7850.0];

impl LeafSpring {
    /// Length, width and thickness in m, Young's modulus in Pa, density in kg/m³.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a value that is not positive.
    pub fn new(
        dimensions_m: [f64; 3],
        youngs_modulus_pa: f64,
        density: f64,
    ) -> Result<Self, MoldError> {
        Ok(Self {
            length_m: positive("length of the leaf spring", dimensions_m[0])?,
            width_m: positive("width of the leaf spring", dimensions_m[1])?,
            thickness_m: positive("thickness of the leaf spring", dimensions_m[2])?,
            youngs_modulus_pa: positive("Young's modulus", youngs_modulus_pa)?,
            density: positive("density", density)?,
            axial_force_n: 0.0,
        })
    }

    /// A leaf spring of steel (210 GPa, 7850 kg/m³).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn steel(length_m: f64, width_m: f64, thickness_m: f64) -> Result<Self, MoldError> {
        Self::new([length_m, width_m, thickness_m], STEEL[0], STEEL[1])
    }

    /// The same under an axial force, N, positive when it pulls.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a force that is not finite.
    pub fn with_axial_force(mut self, axial_force_n: f64) -> Result<Self, MoldError> {
        self.axial_force_n = finite("axial force", axial_force_n)?;
        Ok(self)
    }

    /// L, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// h, m.
    #[must_use]
    pub fn thickness_m(&self) -> f64 {
        self.thickness_m
    }

    /// E I, N m²: I = b h³/12.
    #[must_use]
    pub fn bending_stiffness(&self) -> f64 {
        self.youngs_modulus_pa * self.width_m * self.thickness_m.powi(3) / 12.0
    }

    /// ρ b h, kg/m.
    #[must_use]
    pub fn mass_per_length(&self) -> f64 {
        self.density * self.width_m * self.thickness_m
    }

    /// Force per displacement of a guided end, 12 E I/L³, N/m, without axial force.
    #[must_use]
    pub fn guided_stiffness(&self) -> f64 {
        12.0 * self.bending_stiffness() / self.length_m.powi(3)
    }

    /// Natural frequency of a mode (from 1) in closed form,
    ///
    /// ```text
    /// f_n = x_n²/(2π L²) √(E I/(ρ b h))                                    (1)
    /// clamped          cos x = 1/cosh x                                    (2)
    /// clamped, guided  tan x = −tanh x                                     (3)
    /// clamped, free    cos x = −1/cosh x                                   (4)
    /// pinned           x_n = n π,  f_n times √(1 + N L²/(n²π² E I))        (5)
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for mode 0, for an axial force unless both ends are pinned (there is
    /// no closed form then), and for a thrust beyond the buckling load.
    ///
    /// Reference: `blevins1979`, chapter 8.
    pub fn natural_freq_hz(&self, ends: BeamEnds, mode: u32) -> Result<f64, MoldError> {
        let order = positive("mode of a beam", f64::from(mode))?;
        let root = characteristic_root(ends, order);
        let scale = (self.bending_stiffness() / self.mass_per_length()).sqrt();
        let bare = root * root / (TAU * self.length_m * self.length_m) * scale; // (1)
        if self.axial_force_n == 0.0 {
            return Ok(bare);
        }
        if ends != BeamEnds::Pinned {
            return Err(MoldError::Parameter {
                name: "axial force",
                found: self.axial_force_n,
                needed: "zero unless both ends are pinned; finite elements take any",
            });
        }
        let tension =
            self.axial_force_n * self.length_m.powi(2) / (root * root * self.bending_stiffness());
        Ok(bare * positive("1 + N L²/(n²π² E I)", 1.0 + tension)?.sqrt()) // (5)
    }

    /// Mass and stiffness matrix of equal finite elements with cubic shape functions, the ends held;
    /// the coordinates are deflection and slope of one node after the other, those held left out.
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for fewer than 2 elements.
    ///
    /// Reference: `cook2002`, chapters 2 and 11.
    pub fn finite_elements(
        &self,
        ends: BeamEnds,
        elements: usize,
    ) -> Result<StructuralMatrices, MoldError> {
        let last = 2 * elements;
        let held: &[usize] = match ends {
            BeamEnds::Clamped => &[0, 1, last, last + 1],
            BeamEnds::ClampedGuided => &[0, 1, last + 1],
            BeamEnds::ClampedFree => &[0, 1],
            BeamEnds::Pinned => &[0, last],
        };
        let [mass, stiffness] = self.assembled(elements)?;
        let free: Vec<usize> = (0..2 * elements + 2)
            .filter(|i| !held.contains(i))
            .collect();
        let part =
            |m: &Mat<f64>| Mat::from_fn(free.len(), free.len(), |i, j| m[(free[i], free[j])]);
        Ok(StructuralMatrices {
            mass_matrix: part(&mass),
            damping_matrix: Mat::zeros(free.len(), free.len()),
            stiffness_matrix: part(&stiffness),
        })
    }

    /// M and K of all nodes, none held.
    pub(crate) fn assembled(&self, elements: usize) -> Result<[Mat<f64>; 2], MoldError> {
        if elements < 2 {
            return Err(MoldError::Parameter {
                name: "number of elements",
                found: elements as f64,
                needed: "2 or more",
            });
        }
        let size = 2 * elements + 2;
        let (mut mass, mut stiffness) = (Mat::zeros(size, size), Mat::zeros(size, size));
        let l = self.length_m / elements as f64;
        let inertia = self.mass_per_length() * l / 420.0;
        let bending = self.bending_stiffness() / l.powi(3);
        let tension = self.axial_force_n / (30.0 * l);
        for at in (0..elements).map(|e| 2 * e) {
            for i in 0..4 {
                for j in 0..4 {
                    // Slopes are in units of 1/l: each slope brings a factor l.
                    let slope = l.powi((i % 2 + j % 2) as i32);
                    mass[(at + i, at + j)] += inertia * slope * MASS[i][j];
                    stiffness[(at + i, at + j)] +=
                        slope * (bending * BENDING[i][j] + tension * TENSION[i][j]);
                }
            }
        }
        Ok([mass, stiffness])
    }

    /// Natural frequencies of the finite elements, lowest first, Hz.
    ///
    /// # Errors
    /// As [`finite_elements`](Self::finite_elements); [`MoldError::Model`] if the eigenvalues are not
    /// found.
    pub fn element_freqs_hz(&self, ends: BeamEnds, elements: usize) -> Result<Vec<f64>, MoldError> {
        Ok(undamped_modes(&self.finite_elements(ends, elements)?)?.natural_freq_hz)
    }
}

/// Consistent mass matrix of an element over ρ b h l/420 (`cook2002`, chapter 11).
const MASS: [[f64; 4]; 4] = [
    [156.0, 22.0, 54.0, -13.0],
    [22.0, 4.0, 13.0, -3.0],
    [54.0, 13.0, 156.0, -22.0],
    [-13.0, -3.0, -22.0, 4.0],
];

/// Stiffness matrix of an element over E I/l³ (`cook2002`, chapter 2).
const BENDING: [[f64; 4]; 4] = [
    [12.0, 6.0, -12.0, 6.0],
    [6.0, 4.0, -6.0, 2.0],
    [-12.0, -6.0, 12.0, -6.0],
    [6.0, 2.0, -6.0, 4.0],
];

/// Stiffness of the axial force, over N/(30 l) (`cook2002`, chapter 18).
const TENSION: [[f64; 4]; 4] = [
    [36.0, 3.0, -36.0, 3.0],
    [3.0, 4.0, -3.0, -1.0],
    [-36.0, -3.0, 36.0, -3.0],
    [3.0, -1.0, -3.0, 4.0],
];

/// The n-th root x of (2) to (5), by bisection about its limit for high modes.
fn characteristic_root(ends: BeamEnds, order: f64) -> f64 {
    let about = match ends {
        BeamEnds::Pinned => return order * PI,
        BeamEnds::Clamped => (order + 0.5) * PI,
        BeamEnds::ClampedGuided => (order - 0.25) * PI,
        BeamEnds::ClampedFree => (order - 0.5) * PI,
    };
    let value = |x: f64| match ends {
        BeamEnds::Clamped => x.cos() - x.cosh().recip(),
        BeamEnds::ClampedFree => x.cos() + x.cosh().recip(),
        BeamEnds::ClampedGuided | BeamEnds::Pinned => x.sin() + x.cos() * x.tanh(),
    };
    let (mut low, mut high) = (about - 0.5, about + 0.5);
    let rises = value(low) < 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (value(middle) < 0.0) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
