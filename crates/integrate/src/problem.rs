//! The problem: what is to be integrated. It knows no method and holds no moving state.

use faer::{Mat, MatRef};
use simgap_model::StructuralMatrices;

use crate::error::{IntegrateError, Result, check_length, check_time_step};

/// A force of the motion, written to the left side of the equation of motion.
///
/// Any closure `Fn(time_s, displacement, velocity, force)` is one. The slice `force` arrives
/// filled with zeros and takes g(x, ẋ, t), N, one entry per degree of freedom.
pub trait NonlinearForce {
    /// Writes g(x, ẋ, t).
    fn force(&self, time_s: f64, displacement: &[f64], velocity: &[f64], force: &mut [f64]);

    /// Writes ∂g/∂x and ∂g/∂ẋ into `tangent` (zeros on arrival) and returns true; or returns
    /// false, and the implicit methods take finite differences.
    fn tangent(
        &self,
        _time_s: f64,
        _displacement: &[f64],
        _velocity: &[f64],
        _tangent: &mut Tangent,
    ) -> bool {
        false
    }
}

impl<F: Fn(f64, &[f64], &[f64], &mut [f64])> NonlinearForce for F {
    fn force(&self, time_s: f64, displacement: &[f64], velocity: &[f64], force: &mut [f64]) {
        self(time_s, displacement, velocity, force);
    }
}

/// Derivatives of a [`NonlinearForce`].
#[derive(Debug, Clone, PartialEq)]
pub struct Tangent {
    /// ∂g/∂x, N/m, n × n.
    pub stiffness: Mat<f64>,
    /// ∂g/∂ẋ, N s/m, n × n.
    pub damping: Mat<f64>,
}

/// The force f(t) on the degrees of freedom.
#[derive(Clone, Copy)]
pub enum Excitation<'a> {
    /// No force.
    None,
    /// One column per sample of the time grid, N; straight lines in between (first-order hold).
    Sampled(MatRef<'a, f64>),
    /// A function of time that writes every entry of the slice, N.
    Function(&'a dyn Fn(f64, &mut [f64])),
}

/// M ẍ + C ẋ + K x + g(x, ẋ, t) = f(t) with x(t₀) and ẋ(t₀).
///
/// | symbol | given by | unit | shape |
/// |---|---|---|---|
/// | M, C, K | [`Problem::new`] | kg, N s/m, N/m | n × n |
/// | x(t₀), ẋ(t₀) | [`Problem::with_initial_state`], else zero | m, m/s | n |
/// | f | [`Problem::with_excitation`], else zero | N | n |
/// | g | [`Problem::with_nonlinear_force`], else zero | N | n |
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{Method, Problem, TimeGrid, simulate};
/// use simgap_model::StructuralMatrices;
///
/// let matrices = StructuralMatrices {
///     mass_matrix: mat![[2.0]],
///     damping_matrix: mat![[0.0]],
///     stiffness_matrix: mat![[8.0]],
/// };
/// let problem = Problem::new(&matrices)?.with_initial_state(&[1.0], &[0.0])?;
/// let grid = TimeGrid::new(0.0, 0.01, 101)?;
/// let solution = simulate(&problem, &grid, Method::RungeKutta4)?;
/// assert!((solution.motion.displacement[(0, 100)] - 2.0_f64.cos()).abs() < 1e-8);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
#[derive(Clone)]
pub struct Problem<'a> {
    dof_count: usize,
    // Row by row, which is how the products run.
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    excitation: Excitation<'a>,
    nonlinear_force: Option<&'a dyn NonlinearForce>,
    initial_displacement: Vec<f64>,
    initial_velocity: Vec<f64>,
}

impl<'a> Problem<'a> {
    /// Free motion of a linear structure from rest.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::TooFewSamples`] for no degree of freedom, [`IntegrateError::Shape`] unless
    /// all three are n × n, [`IntegrateError::EntryNotFinite`].
    pub fn new(matrices: &StructuralMatrices) -> Result<Self> {
        let n = matrices.dof_count();
        check_length("the list of degrees of freedom", n, 1)?;
        Ok(Self {
            dof_count: n,
            mass: row_major("the mass matrix", &matrices.mass_matrix, n)?,
            damping: row_major("the damping matrix", &matrices.damping_matrix, n)?,
            stiffness: row_major("the stiffness matrix", &matrices.stiffness_matrix, n)?,
            excitation: Excitation::None,
            nonlinear_force: None,
            initial_displacement: vec![0.0; n],
            initial_velocity: vec![0.0; n],
        })
    }

    /// The same problem from another initial state, m and m/s.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Shape`], [`IntegrateError::EntryNotFinite`].
    pub fn with_initial_state(mut self, displacement: &[f64], velocity: &[f64]) -> Result<Self> {
        for (what, values) in [
            ("the initial displacement", displacement),
            ("the initial velocity", velocity),
        ] {
            check_shape(what, (values.len(), 1), (self.dof_count, 1))?;
            check_entries(what, values, 1)?;
        }
        self.initial_displacement.copy_from_slice(displacement);
        self.initial_velocity.copy_from_slice(velocity);
        Ok(self)
    }

    /// The same problem under a force. A sampled force is checked against the time grid when the
    /// simulation starts.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Shape`], [`IntegrateError::NotFinite`].
    pub fn with_excitation(mut self, excitation: Excitation<'a>) -> Result<Self> {
        if let Excitation::Sampled(samples) = excitation {
            let found = (samples.nrows(), samples.ncols());
            check_shape("the sampled force", found, (self.dof_count, found.1))?;
            for k in 0..samples.ncols() {
                for i in 0..samples.nrows() {
                    if !samples[(i, k)].is_finite() {
                        return Err(IntegrateError::NotFinite {
                            what: "the sampled force",
                            sample: k,
                            found: samples[(i, k)],
                        });
                    }
                }
            }
        }
        self.excitation = excitation;
        Ok(self)
    }

    /// The same problem with a force of the motion on the left side.
    #[must_use]
    pub fn with_nonlinear_force(mut self, nonlinear_force: &'a dyn NonlinearForce) -> Self {
        self.nonlinear_force = Some(nonlinear_force);
        self
    }

    /// Number of degrees of freedom n.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.dof_count
    }

    /// x(t₀), m.
    #[must_use]
    pub fn initial_displacement(&self) -> &[f64] {
        &self.initial_displacement
    }

    /// ẋ(t₀), m/s.
    #[must_use]
    pub fn initial_velocity(&self) -> &[f64] {
        &self.initial_velocity
    }

    /// f(t).
    #[must_use]
    pub fn excitation(&self) -> Excitation<'a> {
        self.excitation
    }

    /// g, if there is one.
    #[must_use]
    pub fn nonlinear_force(&self) -> Option<&'a dyn NonlinearForce> {
        self.nonlinear_force
    }

    /// M row by row.
    pub(crate) fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// C row by row.
    pub(crate) fn damping(&self) -> &[f64] {
        &self.damping
    }

    /// K row by row.
    pub(crate) fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    /// Refuses a sampled force with another number of samples than the grid.
    pub(crate) fn check_grid(&self, grid: &TimeGrid) -> Result<()> {
        if let Excitation::Sampled(samples) = self.excitation {
            let found = (samples.nrows(), samples.ncols());
            check_shape(
                "the sampled force",
                found,
                (self.dof_count, grid.sample_count),
            )?;
        }
        Ok(())
    }
}

/// When the motion is wanted: samples k = 0 .. N−1 at t₀ + k h, each interval cut into equal
/// integration steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeGrid {
    pub(crate) start_s: f64,
    pub(crate) time_step_s: f64,
    pub(crate) sample_count: usize,
    pub(crate) substeps: usize,
}

impl TimeGrid {
    /// One integration step per sample.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::TimeStep`], [`IntegrateError::TooFewSamples`] for none at all,
    /// [`IntegrateError::Parameter`] for a start that is not finite.
    pub fn new(start_s: f64, time_step_s: f64, sample_count: usize) -> Result<Self> {
        check_time_step(time_step_s)?;
        check_length("the time grid", sample_count, 1)?;
        if !start_s.is_finite() {
            return Err(IntegrateError::Parameter {
                name: "start_s",
                found: start_s,
                needed: "finite",
            });
        }
        Ok(Self {
            start_s,
            time_step_s,
            sample_count,
            substeps: 1,
        })
    }

    /// The same samples with several fixed integration steps in each interval. The adaptive method
    /// chooses its own steps and ignores this.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`] for zero.
    pub fn with_substeps(mut self, substeps: usize) -> Result<Self> {
        if substeps == 0 {
            return Err(IntegrateError::Parameter {
                name: "substeps",
                found: 0.0,
                needed: "1 or more",
            });
        }
        self.substeps = substeps;
        Ok(self)
    }

    /// Time of sample k, s.
    #[must_use]
    pub fn time_s(&self, sample: usize) -> f64 {
        self.start_s + self.time_step_s * sample as f64
    }

    /// Interval between samples, s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }

    /// Number of samples N.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.sample_count
    }

    /// Integration steps per interval.
    #[must_use]
    pub fn substeps(&self) -> usize {
        self.substeps
    }
}

fn check_shape(what: &'static str, found: (usize, usize), needed: (usize, usize)) -> Result<()> {
    if found == needed {
        return Ok(());
    }
    Err(IntegrateError::Shape {
        what,
        found_rows: found.0,
        found_cols: found.1,
        needed_rows: needed.0,
        needed_cols: needed.1,
    })
}

fn row_major(what: &'static str, matrix: &Mat<f64>, n: usize) -> Result<Vec<f64>> {
    check_shape(what, (matrix.nrows(), matrix.ncols()), (n, n))?;
    let flat: Vec<f64> = (0..n * n).map(|at| matrix[(at / n, at % n)]).collect();
    check_entries(what, &flat, n)?;
    Ok(flat)
}

/// Refuses an entry that is not finite; `columns` of them make a row.
fn check_entries(what: &'static str, entries: &[f64], columns: usize) -> Result<()> {
    match entries.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(IntegrateError::EntryNotFinite {
            what,
            row: at / columns,
            column: at % columns,
            found: entries[at],
        }),
    }
}
