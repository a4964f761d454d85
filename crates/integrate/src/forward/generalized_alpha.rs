//! Newmark's family and its generalisation with averaged equilibrium.

use super::balance::{Balance, Instant};
use super::implicit::{Coefficients, Implicit, Predictor};
use super::start::{check_finite_motion, start_motion};
use crate::error::{IntegrateError, Result};
use crate::motion::Solution;
use crate::problem::{Problem, TimeGrid};

/// Parameters of Newmark's method.
///
/// | member | β | γ | stability |
/// |---|---|---|---|
/// | [`Newmark::TRAPEZOIDAL`] (constant average acceleration) | 1/4 | 1/2 | unconditional, spectral radius 1 |
/// | [`Newmark::LINEAR_ACCELERATION`] | 1/6 | 1/2 | ω h ≤ √12 |
/// | [`Newmark::FOX_GOODWIN`] | 1/12 | 1/2 | ω h ≤ √6, order 4 without damping and force |
/// | [`Newmark::CENTRAL_DIFFERENCE`] | 0 | 1/2 | ω h ≤ 2 |
///
/// Unconditionally stable for 2β ≥ γ ≥ 1/2; of order two only for γ = 1/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newmark {
    beta: f64,
    gamma: f64,
}

impl Newmark {
    /// β = 1/4, γ = 1/2.
    pub const TRAPEZOIDAL: Self = Self {
        beta: 0.25,
        gamma: 0.5,
    };
    /// β = 1/6, γ = 1/2.
    pub const LINEAR_ACCELERATION: Self = Self {
        beta: 1.0 / 6.0,
        gamma: 0.5,
    };
    /// β = 1/12, γ = 1/2.
    pub const FOX_GOODWIN: Self = Self {
        beta: 1.0 / 12.0,
        gamma: 0.5,
    };
    /// β = 0, γ = 1/2: explicit when C is diagonal.
    pub const CENTRAL_DIFFERENCE: Self = Self {
        beta: 0.0,
        gamma: 0.5,
    };

    /// β and γ, each from 0 to 1.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`].
    ///
    /// ```
    /// use simgap_integrate::Newmark;
    /// assert_eq!(Newmark::new(0.25, 0.5)?, Newmark::TRAPEZOIDAL);
    /// assert!(Newmark::new(-0.1, 0.5).is_err());
    /// # Ok::<(), simgap_integrate::IntegrateError>(())
    /// ```
    pub fn new(beta: f64, gamma: f64) -> Result<Self> {
        check_between("beta", beta, 0.0..=1.0, "between 0 and 1")?;
        check_between("gamma", gamma, 0.0..=1.0, "between 0 and 1")?;
        Ok(Self { beta, gamma })
    }
}

/// Parameters of the generalized-alpha method.
///
/// Equilibrium holds between the two ends of the step, inertia at 1 − α_m and the other forces at
/// 1 − α_f of the way; displacement and velocity advance as in Newmark's method.
///
/// ```text
/// M a_(n+1−α_m) + C v_(n+1−α_f) + K x_(n+1−α_f) + g = f(t_(n+1−α_f))
/// q_(n+1−α) = (1 − α) q_(n+1) + α q_n
/// γ = 1/2 − α_m + α_f          β = (1 − α_m + α_f)² / 4
/// ```
///
/// References: Chung and Hulbert 1993 (`chung1993`); Hilber, Hughes and Taylor 1977 (`hilber1977`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneralizedAlpha {
    pub(super) alpha_m: f64,
    pub(super) alpha_f: f64,
    pub(super) beta: f64,
    pub(super) gamma: f64,
}

impl GeneralizedAlpha {
    /// By the spectral radius ρ∞ at infinite frequency, 0 (annihilates in one step) to 1 (keeps):
    /// α_m = (2ρ∞ − 1)/(ρ∞ + 1), α_f = ρ∞/(ρ∞ + 1).
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`].
    ///
    /// ```
    /// assert!(simgap_integrate::GeneralizedAlpha::from_rho_infinity(0.8).is_ok());
    /// assert!(simgap_integrate::GeneralizedAlpha::from_rho_infinity(1.1).is_err());
    /// ```
    pub fn from_rho_infinity(rho_infinity: f64) -> Result<Self> {
        check_between("rho_infinity", rho_infinity, 0.0..=1.0, "between 0 and 1")?;
        Ok(Self::balanced(
            (2.0 * rho_infinity - 1.0) / (rho_infinity + 1.0),
            rho_infinity / (rho_infinity + 1.0),
        ))
    }

    /// The method of Hilber, Hughes and Taylor: α_m = 0, α_f = `alpha` from 0 (trapezoidal rule) to
    /// 1/3. Their own α is the negative of this one.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`].
    ///
    /// ```
    /// assert!(simgap_integrate::GeneralizedAlpha::hilber_hughes_taylor(0.1).is_ok());
    /// assert!(simgap_integrate::GeneralizedAlpha::hilber_hughes_taylor(0.5).is_err());
    /// ```
    pub fn hilber_hughes_taylor(alpha: f64) -> Result<Self> {
        check_between("alpha", alpha, 0.0..=1.0 / 3.0, "between 0 and 1/3")?;
        Ok(Self::balanced(0.0, alpha))
    }

    /// γ for order two, β for the most dissipation at high frequency.
    fn balanced(alpha_m: f64, alpha_f: f64) -> Self {
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2),
            gamma: 0.5 - alpha_m + alpha_f,
        }
    }
}

impl From<Newmark> for GeneralizedAlpha {
    fn from(newmark: Newmark) -> Self {
        Self {
            alpha_m: 0.0,
            alpha_f: 0.0,
            beta: newmark.beta,
            gamma: newmark.gamma,
        }
    }
}

/// Newmark's method.
///
/// ```text
/// x_(n+1) = x_n + h v_n + h² ((1/2 − β) a_n + β a_(n+1))                            (1)
/// v_(n+1) = v_n + h ((1 − γ) a_n + γ a_(n+1))                                       (2)
/// M a_(n+1) + C v_(n+1) + K x_(n+1) + g = f(t_(n+1))                                (3)
/// ```
///
/// # Errors
///
/// [`IntegrateError::Shape`] when the sampled force does not fit the grid,
/// [`IntegrateError::Singular`], [`IntegrateError::NotConverged`], [`IntegrateError::Unstable`].
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{Newmark, Problem, TimeGrid, newmark};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.0]], stiffness_matrix: mat![[1.0]],
/// # };
/// let problem = Problem::new(&matrices)?.with_initial_state(&[1.0], &[0.0])?;
/// let solution = newmark(&problem, &TimeGrid::new(0.0, 0.1, 500)?, Newmark::TRAPEZOIDAL)?;
/// let last = solution.motion.displacement[(0, 499)].hypot(solution.motion.velocity[(0, 499)]);
/// assert!((last - 1.0).abs() < 1e-12); // the trapezoidal rule keeps the energy
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// Reference: Newmark 1959 (`newmark1959`).
pub fn newmark(problem: &Problem<'_>, grid: &TimeGrid, parameters: Newmark) -> Result<Solution> {
    generalized_alpha(problem, grid, parameters.into())
}

/// The generalized-alpha method, [`GeneralizedAlpha`].
///
/// The acceleration reported at each sample is the one that satisfies the equation of motion there.
/// The method's own acceleration variable belongs to an instant (α_f − α_m) h earlier and is only
/// of order one at the sample (Erlicher, Bonaventura and Bursi 2002, `erlicher2002`).
///
/// # Errors
///
/// As [`newmark`].
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{GeneralizedAlpha, Problem, TimeGrid, generalized_alpha};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.0]], stiffness_matrix: mat![[1e6]],
/// # };
/// let problem = Problem::new(&matrices)?.with_initial_state(&[1.0], &[0.0])?;
/// let parameters = GeneralizedAlpha::from_rho_infinity(0.5)?;
/// let solution = generalized_alpha(&problem, &TimeGrid::new(0.0, 1.0, 60)?, parameters)?;
/// assert!(solution.motion.displacement[(0, 59)].abs() < 1e-12); // unresolved, hence damped out
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn generalized_alpha(
    problem: &Problem<'_>,
    grid: &TimeGrid,
    parameters: GeneralizedAlpha,
) -> Result<Solution> {
    let mut balance = Balance::new(problem, grid)?;
    let (mut motion, mut state) = start_motion(&mut balance, grid);
    let mut stepper = Stepper::new(&mut balance, grid, parameters)?;
    let balanced = parameters.alpha_m == 0.0 && parameters.alpha_f == 0.0;
    let mut reported = vec![0.0; problem.dof_count()];
    for step in 0..grid.substeps * (grid.sample_count - 1) {
        stepper.advance(&mut balance, grid, step, &mut state)?;
        balance.work.steps += 1;
        if (step + 1) % grid.substeps == 0 {
            let sample = (step + 1) / grid.substeps;
            check_finite_motion(grid, sample, &state)?;
            if balanced {
                motion.record(sample, &state.x, &state.v, &state.a);
            } else {
                let at = Instant::new(grid, sample, 0.0);
                balance.acceleration(at, &state.x, &state.v, &mut reported);
                motion.record(sample, &state.x, &state.v, &reported);
            }
        }
    }
    Ok(Solution {
        motion,
        work: balance.work,
    })
}

/// Advances x, v, a by one step.
pub(super) struct Stepper {
    parameters: GeneralizedAlpha,
    time_step_s: f64,
    implicit: Implicit,
    predictor: Predictor,
    unknown: Vec<f64>,
}

impl Stepper {
    pub(super) fn new(
        balance: &mut Balance<'_, '_>,
        grid: &TimeGrid,
        parameters: GeneralizedAlpha,
    ) -> Result<Self> {
        let n = balance.problem.dof_count();
        let h = grid.time_step_s / grid.substeps as f64;
        // The unknown is a_(n+1); what it adds to x, v, a where equilibrium holds.
        let coefficients = Coefficients {
            displacement: (1.0 - parameters.alpha_f) * h * h * parameters.beta,
            velocity: (1.0 - parameters.alpha_f) * h * parameters.gamma,
            acceleration: 1.0 - parameters.alpha_m,
        };
        Ok(Self {
            parameters,
            time_step_s: h,
            implicit: Implicit::new(balance, coefficients, grid.start_s)?,
            predictor: Predictor::zeros(n),
            unknown: vec![0.0; n],
        })
    }

    pub(super) fn advance(
        &mut self,
        balance: &mut Balance<'_, '_>,
        grid: &TimeGrid,
        step: usize,
        state: &mut Predictor,
    ) -> Result<()> {
        let h = self.time_step_s;
        let GeneralizedAlpha {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.parameters;
        for i in 0..state.x.len() {
            let (x, v, a) = (state.x[i], state.v[i], state.a[i]);
            // Equations (1) and (2) without a_(n+1).
            state.x[i] = x + h * v + h * h * (0.5 - beta) * a;
            state.v[i] = v + h * (1.0 - gamma) * a;
            self.predictor.x[i] = (1.0 - alpha_f) * state.x[i] + alpha_f * x;
            self.predictor.v[i] = (1.0 - alpha_f) * state.v[i] + alpha_f * v;
            self.predictor.a[i] = alpha_m * a;
            self.unknown[i] = a;
        }
        let at = Instant::in_step(grid, step, 1.0 - alpha_f);
        self.implicit
            .solve(balance, at, &self.predictor, &mut self.unknown)?;
        for i in 0..state.x.len() {
            state.a[i] = self.unknown[i];
            state.x[i] += h * h * beta * state.a[i];
            state.v[i] += h * gamma * state.a[i];
        }
        Ok(())
    }
}

fn check_between(
    name: &'static str,
    found: f64,
    range: std::ops::RangeInclusive<f64>,
    needed: &'static str,
) -> Result<()> {
    if range.contains(&found) {
        Ok(())
    } else {
        Err(IntegrateError::Parameter {
            name,
            found,
            needed,
        })
    }
}
