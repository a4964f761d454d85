//! The result: motion on the time grid, and the work it took.

use faer::Mat;

use crate::problem::TimeGrid;

/// Motion of every degree of freedom at every sample.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motion {
    /// Time of each sample, s.
    pub time_s: Vec<f64>,
    /// m, n × samples.
    #[cfg_attr(feature = "serde", serde(with = "simgap_model::serial::rows"))]
    pub displacement: Mat<f64>,
    /// m/s, n × samples.
    #[cfg_attr(feature = "serde", serde(with = "simgap_model::serial::rows"))]
    pub velocity: Mat<f64>,
    /// m/s², n × samples.
    #[cfg_attr(feature = "serde", serde(with = "simgap_model::serial::rows"))]
    pub acceleration: Mat<f64>,
}

impl Motion {
    /// Zeros on a grid.
    pub(crate) fn zeros(dof_count: usize, grid: &TimeGrid) -> Self {
        let samples = grid.sample_count();
        Self {
            time_s: (0..samples).map(|k| grid.time_s(k)).collect(),
            displacement: Mat::zeros(dof_count, samples),
            velocity: Mat::zeros(dof_count, samples),
            acceleration: Mat::zeros(dof_count, samples),
        }
    }

    /// Writes one sample.
    pub(crate) fn record(&mut self, sample: usize, x: &[f64], v: &[f64], a: &[f64]) {
        self.displacement
            .col_as_slice_mut(sample)
            .copy_from_slice(x);
        self.velocity.col_as_slice_mut(sample).copy_from_slice(v);
        self.acceleration
            .col_as_slice_mut(sample)
            .copy_from_slice(a);
    }
}

/// What a simulation cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Work {
    /// Steps that were taken.
    pub steps: usize,
    /// Steps that were tried and refused (adaptive method only).
    pub rejected_steps: usize,
    /// Evaluations of the forces of the equation of motion.
    pub right_hand_sides: usize,
    /// Factorisations of a matrix.
    pub factorisations: usize,
    /// Corrections by Newton's method (implicit methods with a nonlinear force).
    pub newton_iterations: usize,
}

/// Motion and work.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution {
    /// The motion.
    pub motion: Motion,
    /// What it cost.
    pub work: Work,
}
