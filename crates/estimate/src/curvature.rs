//! How the data curve the log-likelihood about an estimate.

use faer::Mat;

use crate::layout::Layout;

/// What a coordinate of a fit is a value of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// Of the i-th effect, the k-th parameter; of one record where records have values of their own.
    Effect(usize, usize),
    /// Of the i-th nominal parameter, the k-th value.
    Nominal(usize, usize),
    /// The initial state of a record.
    State,
}

/// One number that a fit adjusts.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinate {
    /// What it is a value of.
    pub owner: Owner,
    /// Its value at the estimate.
    pub value: f64,
    /// Typical size, in units of which the curvature is told.
    pub scale: f64,
    /// Standard deviation of the prior that the fit put on it; infinite where it is free.
    pub prior_std: f64,
    /// No fit moves it.
    pub is_held: bool,
}

/// H = JᵀWJ, the curvature of minus the log-likelihood, in units of the scales and without any prior.
#[derive(Debug, Clone)]
pub struct Curvature {
    /// H, one row and column for each coordinate.
    pub hessian: Mat<f64>,
    /// The coordinates.
    pub coordinates: Vec<Coordinate>,
}

impl Curvature {
    /// From the normal equations of a step, which hold the prior.
    pub(crate) fn of(layout: &Layout, theta: &[f64], with_prior: &Mat<f64>) -> Curvature {
        let mut hessian = with_prior.clone();
        let coordinates = layout.owners().into_iter().enumerate();
        let coordinates = coordinates.map(|(i, owner)| {
            let (scale, prior_std) = (layout.scale[i], layout.prior_std[i]);
            let precision = (scale / prior_std).powi(2);
            hessian[(i, i)] = (hessian[(i, i)] - precision).max(0.0);
            Coordinate {
                owner,
                value: theta[i],
                scale,
                prior_std,
                is_held: layout.is_held(i),
            }
        });
        Curvature {
            coordinates: coordinates.collect(),
            hessian,
        }
    }
}
