//! How the data curve the log-likelihood about an estimate.

use faer::Mat;

use crate::layout::{Layout, Owner};

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
    /// H with the normal priors that a fit puts on nominal parameters: what intervals of the effects are taken from, which
    /// turn infinite along directions that the data do not see.
    pub(crate) fn with_fixed_priors(&self) -> Mat<f64> {
        let mut hessian = self.hessian.clone();
        for (i, coordinate) in self.coordinates.iter().enumerate() {
            hessian[(i, i)] += (coordinate.scale / coordinate.prior_std).powi(2);
        }
        hessian
    }

    /// From the normal equations of a step, which hold the prior.
    pub(crate) fn of(layout: &Layout, theta: &[f64], with_prior: &Mat<f64>) -> Curvature {
        let mut hessian = with_prior.clone();
        let coordinates = layout.owners().into_iter().enumerate();
        let coordinates = coordinates.map(|(i, owner)| {
            let (scale, prior_std) = (layout.scale[i], layout.prior_std[i]);
            let [_, _, of_prior] = layout.prior_at(i, theta[i]);
            hessian[(i, i)] = (hessian[(i, i)] - of_prior * scale.powi(2)).max(0.0);
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
