//! Linearisation of a model about an operating point, and what its poles owe to each parameter.

use std::f64::consts::TAU;

use faer::{Mat, c64};

use crate::dense;
use crate::modes::balanced;
use crate::{
    Elements, Model, ModelError, Parameter, StructuralMatrices, frequency_response, state_matrix,
};

/// A pole, and its derivative with respect to each parameter in the order of [`Model::parameters`].
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PoleSensitivity {
    /// λ, rad/s, with Im λ ≥ 0.
    #[serde(with = "crate::serial::complex")]
    pub pole: c64,
    /// ∂λ/∂p, rad/s per unit of the parameter; `None` for a pole that is there more than once, which has no
    /// derivative.
    #[serde(with = "crate::serial::complex_list_or_none")]
    pub derivative: Option<Vec<c64>>,
}

/// How near two poles may come, relative to their size, before they count as one.
const REPEATED: f64 = 1e-7;

/// A pole below this share of the largest is zero.
const ZERO: f64 = 1e-13;

/// Steps of the search for rest, and the change at which it ends, relative.
const STEPS: usize = 100;
const AT_REST: f64 = 1e-13;

impl Model {
    /// Displacements at rest under the loads, moving bases at zero,
    ///
    /// ```text
    /// K x + Σ p sin x = loads                                                           (1)
    /// ```
    ///
    /// by Newton's method from zero. Effects of the file are left out.
    ///
    /// # Errors
    /// [`ModelError::Singular`] where a mass is free to move under a load, [`ModelError::Rest`] where no rest
    /// is found.
    pub fn equilibrium(&self) -> Result<Vec<f64>, ModelError> {
        let count = self.dof_count();
        let (linear, loads) = (self.matrices()?.stiffness_matrix, self.load_vector());
        let mut at = vec![0.0; count];
        for _ in 0..STEPS {
            let mut left: Vec<f64> = (0..count)
                .map(|i| loads[i] - (0..count).map(|j| linear[(i, j)] * at[j]).sum::<f64>())
                .collect();
            for pendulum in &self.pendulums {
                if let Some(node) = self.node(&pendulum.at) {
                    node.push(-pendulum.value * node.of(&at, &[]).sin(), &mut left);
                }
            }
            if left.iter().all(|force| *force == 0.0) {
                return Ok(at);
            }
            let tangent = self.linearise(&at)?.stiffness_matrix;
            let step = dense::solve(&tangent, &left).ok_or_else(|| ModelError::Singular {
                matrix: "stiffness matrix",
                context: "a mass is free to move under the loads".into(),
            })?;
            let size = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            at.iter_mut().zip(&step).for_each(|(x, dx)| *x += dx);
            if size(&step) <= AT_REST * size(&at) {
                return Ok(at);
            }
        }
        Err(ModelError::Rest { steps: STEPS })
    }

    /// M, C and K of small motions about given displacements: (1) of [`Model::equilibrium`] with the slope
    /// p cos x of each pendulum. Effects of the file are left out; they have no meaning in this crate.
    ///
    /// # Errors
    /// [`ModelError::Shape`] for a wrong number of displacements, [`ModelError::UnknownNode`].
    pub fn linearise(&self, displacements: &[f64]) -> Result<StructuralMatrices, ModelError> {
        self.check_count(displacements)?;
        let mut matrices = self.matrices()?;
        for pendulum in &self.pendulums {
            let Some(node) = self.node(&pendulum.at) else {
                continue;
            };
            let slope = pendulum.value * node.of(displacements, &[]).cos();
            for (i, of_i) in node.terms() {
                for (j, of_j) in node.terms() {
                    matrices.stiffness_matrix[(i, j)] += of_i * of_j * slope;
                }
            }
        }
        Ok(matrices)
    }

    fn check_count(&self, displacements: &[f64]) -> Result<(), ModelError> {
        if displacements.len() == self.dof_count() {
            return Ok(());
        }
        Err(ModelError::Shape {
            place: "operating point".into(),
            found: format!("{} displacements", displacements.len()),
            needed: format!("{} displacements, one for each mass", self.dof_count()),
        })
    }

    /// ∂M/∂p, ∂C/∂p and ∂K/∂p of [`Model::linearise`], the displacements held.
    ///
    /// # Errors
    /// As [`Model::linearise`]; [`ModelError::Shape`] for a parameter that the model does not have.
    pub fn parameter_matrices(
        &self,
        parameter: Parameter,
        displacements: &[f64],
    ) -> Result<StructuralMatrices, ModelError> {
        self.check_count(displacements)?;
        let missing = || ModelError::Shape {
            place: "parameter".into(),
            found: format!("{parameter:?}"),
            needed: "a part of the model".into(),
        };
        if let Parameter::Element(place) = parameter {
            return self.element_derivative(place)?.ok_or_else(missing);
        }
        // The matrices are linear in the other parameters: those of the part alone, with the value one.
        let mut part = Model {
            masses: self.masses.clone(),
            elements: Elements {
                bodies: self.elements.bodies.clone(),
                ..Elements::default()
            },
            inputs: self.inputs.clone(),
            ..Model::default()
        };
        match parameter {
            Parameter::Mass(_) | Parameter::Pendulum(_) | Parameter::Element(_) => (),
            Parameter::Spring(i) => {
                let mut spring = self.springs.get(i).ok_or_else(missing)?.clone();
                spring.stiffness = 1.0;
                part.springs = vec![spring];
            }
            Parameter::Damper(i) => {
                let mut damper = self.dampers.get(i).ok_or_else(missing)?.clone();
                damper.damping = 1.0;
                part.dampers = vec![damper];
            }
        }
        let mut matrices = part.matrices()?;
        matrices.mass_matrix = Mat::zeros(self.dof_count(), self.dof_count());
        match parameter {
            Parameter::Mass(i) if i < self.dof_count() => matrices.mass_matrix[(i, i)] = 1.0,
            Parameter::Mass(_) => return Err(missing()),
            Parameter::Pendulum(i) => {
                let mut only = self.pendulums.get(i).ok_or_else(missing)?.clone();
                only.value = 1.0;
                let mut alone = part.clone();
                alone.pendulums = vec![only];
                matrices.stiffness_matrix = alone.linearise(displacements)?.stiffness_matrix;
            }
            Parameter::Spring(_) | Parameter::Damper(_) | Parameter::Element(_) => (),
        }
        Ok(matrices)
    }

    /// Poles of small motions about given displacements, and their derivatives in closed form.
    ///
    /// ```
    /// use simgap_model::{Model, Parameter};
    /// let model = Model::from_toml(r#"
    /// schema = "simgap-model/1"
    /// name = "block"
    /// [[mass]]
    /// name = "block"
    /// value = 4.0
    /// [[spring]]
    /// name = "a"
    /// between = ["block", "ground"]
    /// stiffness = 100.0
    /// [[output]]
    /// channel = "y"
    /// kind = "displacement"
    /// at = "block"
    /// "#)?;
    /// let found = model.pole_sensitivities(&model.equilibrium()?)?;
    /// // λ = i √(k/m) = 5i: dλ/dk = λ/(2k), dλ/dm = −λ/(2m).
    /// let derivative = found[0].derivative.as_ref().unwrap();
    /// assert_eq!(model.parameters()[1], Parameter::Spring(0));
    /// assert!((derivative[1].im - 5.0 / 200.0).abs() < 1e-12);
    /// assert!((derivative[0].im + 5.0 / 8.0).abs() < 1e-12);
    /// # Ok::<(), simgap_model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Model::linearise`] and [`pole_sensitivities`].
    pub fn pole_sensitivities(
        &self,
        displacements: &[f64],
    ) -> Result<Vec<PoleSensitivity>, ModelError> {
        let derivatives = self
            .parameters()
            .into_iter()
            .map(|parameter| self.parameter_matrices(parameter, displacements))
            .collect::<Result<Vec<_>, _>>()?;
        let mut found = pole_sensitivities(&self.linearise(displacements)?, &derivatives)?;
        // The integrals of pressures and of states of blocks are no states of the plant: each has a pole at zero.
        let integrals = self.first_order().into_iter().filter(|is_first| *is_first);
        found.drain(..integrals.count().min(found.len()));
        Ok(found)
    }
}

/// Poles of a linear structure with Im λ ≥ 0, lowest |λ| first, and their derivatives for given derivatives of the
/// matrices,
///
/// ```text
/// Q(λ) = λ² M + λ C + K,    Q(λ) v = 0,    wᵀ Q(λ) = 0                                   (1)
/// ∂λ/∂p = − wᵀ (λ² ∂M/∂p + λ ∂C/∂p + ∂K/∂p) v / (wᵀ (2λ M + C) v)                          (2)
/// ```
///
/// The right and left vectors v and w come from the state matrix and its transpose, so that M, C and K need not be
/// symmetric. For an undamped structure (2) is ∂f/∂p = φᵀ (∂K/∂p − ω² ∂M/∂p) φ / (8π² f) with φᵀ M φ = 1.
///
/// # Errors
/// [`ModelError::Singular`] when M is singular, [`ModelError::Eigen`] when the iteration fails.
///
/// Reference: `lancaster1964`.
pub fn pole_sensitivities(
    structure: &StructuralMatrices,
    derivatives: &[StructuralMatrices],
) -> Result<Vec<PoleSensitivity>, ModelError> {
    let n = structure.dof_count();
    if n == 0 {
        return Ok(vec![]);
    }
    let state = balanced(&state_matrix(structure)?);
    let failed = |_| ModelError::Eigen {
        matrix: "damped structure",
    };
    let right = state.eigen().map_err(failed)?;
    let left = state.transpose().to_owned().eigen().map_err(failed)?;
    let mut poles: Vec<c64> = (0..2 * n).map(|r| right.S()[r]).collect();
    let largest = poles
        .iter()
        .fold(0.0_f64, |most, pole| most.max(pole.norm()));
    // What is zero but for rounding is zero.
    for pole in poles.iter_mut().filter(|pole| pole.norm() < ZERO * largest) {
        *pole = c64::new(0.0, 0.0);
    }
    let mut found = vec![];
    for (r, pole) in poles.iter().enumerate().filter(|(_, pole)| pole.im >= 0.0) {
        let room = REPEATED * largest.min(pole.norm() + REPEATED * largest);
        let alone = (0..2 * n).all(|other| other == r || (poles[other] - pole).norm() > room);
        let distance = |s: usize| (left.S()[s] - pole).norm();
        let nearest = (0..2 * n).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let derivative = nearest.filter(|_| alone).and_then(|s| {
            let v: Vec<c64> = (0..n).map(|i| right.U()[(i, r)]).collect();
            // The lower half of the left vector of the state is wᵀ M, but for a factor.
            let lower: Vec<c64> = (0..n).map(|i| left.U()[(n + i, s)]).collect();
            let w = left_vector(&structure.mass_matrix, &lower)?;
            derivatives_of(*pole, structure, derivatives, &v, &w)
        });
        found.push(PoleSensitivity {
            pole: *pole,
            derivative,
        });
    }
    found.sort_by(|a, b| {
        let size = a.pole.norm().total_cmp(&b.pole.norm());
        size.then(a.pole.re.total_cmp(&b.pole.re))
    });
    Ok(found)
}

/// w of Mᵀ w = y.
fn left_vector(mass: &Mat<f64>, y: &[c64]) -> Option<Vec<c64>> {
    let transposed = mass.transpose().to_owned();
    let part = |of: fn(&c64) -> f64| {
        let rhs: Vec<f64> = y.iter().map(of).collect();
        dense::solve(&transposed, &rhs)
    };
    let (re, im) = (part(|z| z.re)?, part(|z| z.im)?);
    Some(
        re.into_iter()
            .zip(im)
            .map(|(re, im)| c64::new(re, im))
            .collect(),
    )
}

/// (2) for every parameter; `None` where the denominator is none.
fn derivatives_of(
    pole: c64,
    structure: &StructuralMatrices,
    derivatives: &[StructuralMatrices],
    v: &[c64],
    w: &[c64],
) -> Option<Vec<c64>> {
    let form = |factors: [c64; 3], m: &StructuralMatrices| {
        let mut sum = c64::new(0.0, 0.0);
        for i in 0..w.len() {
            for j in 0..v.len() {
                let entry = factors[0] * m.mass_matrix[(i, j)]
                    + factors[1] * m.damping_matrix[(i, j)]
                    + factors[2] * m.stiffness_matrix[(i, j)];
                sum += w[i] * entry * v[j];
            }
        }
        sum
    };
    let (zero, one) = (c64::new(0.0, 0.0), c64::new(1.0, 0.0));
    let below = form([2.0 * pole, one, zero], structure);
    if below.norm() == 0.0 {
        return None;
    }
    let of = |m: &StructuralMatrices| -form([pole * pole, pole, one], m) / below;
    Some(derivatives.iter().map(of).collect())
}

impl PoleSensitivity {
    /// |λ|/2π, Hz.
    #[must_use]
    pub fn natural_freq_hz(&self) -> f64 {
        self.pole.norm() / TAU
    }

    /// −Re λ/|λ|; zero for λ = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        let size = self.pole.norm();
        if size > 0.0 {
            -self.pole.re / size
        } else {
            0.0
        }
    }

    /// Derivatives of the natural frequency (Hz) and of the damping ratio with respect to a parameter, by its place;
    /// `None` for a pole at zero or one that is there more than once.
    #[must_use]
    pub fn freq_and_damping_derivative(&self, parameter: usize) -> Option<[f64; 2]> {
        let derivative = *self.derivative.as_ref()?.get(parameter)?;
        let size = self.pole.norm();
        if size == 0.0 {
            return None;
        }
        // |λ|² = λ λ̄
        let grown = (self.pole.conj() * derivative).re / size;
        let ratio = (-derivative.re * size + self.pole.re * grown) / (size * size);
        Some([grown / TAU, ratio])
    }
}

/// Derivative of the receptance H = (K + iωC − ω²M)⁻¹ for given derivatives of the matrices,
///
/// ```text
/// ∂H/∂p = − H (∂K/∂p + iω ∂C/∂p − ω² ∂M/∂p) H
/// ```
///
/// m/N per unit of the parameter, n × n.
///
/// # Errors
/// Those of [`frequency_response`].
pub fn receptance_sensitivity(
    structure: &StructuralMatrices,
    derivative: &StructuralMatrices,
    freq_hz: f64,
) -> Result<Mat<c64>, ModelError> {
    let receptance = frequency_response(structure, freq_hz, crate::FrfKind::Receptance)?;
    let (n, omega) = (structure.dof_count(), TAU * freq_hz);
    let changed = Mat::from_fn(n, n, |i, j| {
        c64::new(
            derivative.stiffness_matrix[(i, j)] - omega * omega * derivative.mass_matrix[(i, j)],
            omega * derivative.damping_matrix[(i, j)],
        )
    });
    let product = &receptance * &changed * &receptance;
    Ok(Mat::from_fn(n, n, |i, j| -product[(i, j)]))
}
